//! The effect of transforms on planes, normals and sizes.

use glam::{Affine3A, Mat3A, Vec3};

/// `v / |v|` for any finite length but zero: in single precision, squares below 1e-19 underflow and above 1e19 overflow.
pub(super) fn unit(v: Vec3) -> Vec3 {
    v.as_dvec3().normalize().as_vec3()
}

/// Two unit vectors `u` and `v` along a plane, at right angles to each other, with `u × v` along `normal`,
/// which may be of any length but zero. On the floor they are x and -z, so that an image is upright for a
/// viewer who looks along -z.
pub(super) fn plane_axes(normal: Vec3) -> (Vec3, Vec3) {
    let normal = unit(normal);
    // Start from an axis far from the normal: x for floors and ceilings, y for walls.
    let u = if normal.y.abs() > 0.5 { Vec3::X } else { Vec3::Y.cross(normal).normalize() };
    let u = (u - u.dot(normal) * normal).normalize();
    (u, normal.cross(u))
}

/// The matrix that takes normals to the world, the inverse transpose of `to_world`. It is not scaled by the
/// determinant, so that a normal stays outside under a transform that mirrors.
pub(super) fn normal_matrix(to_world: &Affine3A) -> Mat3A {
    to_world.matrix3.inverse().transpose()
}

/// The factor by which a transform scales lengths; `None` if it scales some directions differently, by more
/// than a few roundings.
pub(super) fn uniform_scale(to_world: &Affine3A) -> Option<f32> {
    let gram = to_world.matrix3.transpose() * to_world.matrix3;
    let squared = gram.x_axis.x;
    // Each entry is a sum of three rounded products: 1e-5 accepts rounded rotations and excludes visible stretching.
    let alike = (gram - Mat3A::from_diagonal(Vec3::splat(squared))).to_cols_array();
    alike.iter().all(|entry| entry.abs() <= 1e-5 * squared).then(|| squared.sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::blend;

    #[test]
    fn the_axes_of_a_plane_stand_at_right_angles() {
        for normal in [Vec3::Y, Vec3::NEG_Y, Vec3::X, Vec3::Z, Vec3::new(1.0, 2.0, -3.0)] {
            let (u, v) = plane_axes(normal);
            assert!((u.cross(v) - normal.normalize()).length() < 1e-6, "{normal}");
        }
        assert_eq!(plane_axes(Vec3::Y), (Vec3::X, Vec3::NEG_Z));
    }

    #[test]
    fn a_turning_sphere_is_no_sphere_halfway() {
        let blended = Affine3A::from_rotation_y(2.0);
        assert!(uniform_scale(&blended).is_some());
        let half = uniform_scale(&blend(&Affine3A::IDENTITY, &blended, 0.5));
        assert!(half.is_none_or(|scale| scale < 0.9), "{half:?}");
    }
}
