//! The radiance in an empty box by radiosity: the faces are divided into patches, whose light is a linear system. The box is
//! convex, so each patch sees all others, and the share of a patch in the view of a point is Lambert's formula.
//!
//! Source: Goral, Torrance, Greenberg and Battaile, "Modeling the Interaction of Light Between Diffuse Surfaces" (1984).

use glam::DVec3;
use std::f64::consts::TAU;

/// A square patch of a face.
struct Patch {
    /// The corners in order around the patch.
    corners: [DVec3; 4],
    center: DVec3,
    /// The unit normal, into the box.
    normal: DVec3,
    albedo: f64,
    emission: f64,
}

/// The unit cube seen in one colour: the albedo of each face, in the order -x, +x, -y, +y, -z, +z, and a square light in the
/// middle of the face +y, with half of its side.
pub struct EmptyBox {
    /// The albedo of each face.
    pub albedo: [f64; 6],
    /// The albedo of the light.
    pub light_albedo: f64,
    /// The radiance of the light.
    pub emission: f64,
}

/// The share of a patch in the view of a point: the fraction of directions with density `cos θ / π` that meet it. It is
/// Lambert's formula for the irradiance by a polygon, divided by π. The whole patch is above the horizon, or in its plane.
fn share(point: DVec3, normal: DVec3, patch: &Patch) -> f64 {
    let corners = patch.corners.map(|corner| corner - point);
    // A point sees nothing of a patch in its own plane, where the formula gives the whole view.
    if corners[0].dot(patch.normal).abs() < 1e-12 {
        return 0.0;
    }
    let edge = |index: usize| {
        let (v, w) = (corners[index], corners[(index + 1) % 4]);
        v.angle_between(w) * v.cross(w).normalize().dot(normal)
    };
    (0..4).map(edge).sum::<f64>().abs() / TAU
}

impl EmptyBox {
    /// The patches, with `n` by `n` per face; `n` is a multiple of 4, so that the light consists of whole patches.
    fn patches(&self, n: usize) -> Vec<Patch> {
        let mut patches = Vec::new();
        for (face, albedo) in self.albedo.iter().enumerate() {
            let (axis, is_upper) = (face / 2, face % 2 == 1);
            let normal = DVec3::AXES[axis] * if is_upper { -1.0 } else { 1.0 };
            let (first, second) = (DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]);
            let origin = if is_upper { DVec3::AXES[axis] } else { DVec3::ZERO };
            let step = 1.0 / n as f64;
            for row in 0..n {
                for column in 0..n {
                    let at = |s: f64, t: f64| {
                        origin + (column as f64 + s) * step * first + (row as f64 + t) * step * second
                    };
                    let is_light =
                        face == 3 && [row, column].iter().all(|index| (n / 4..3 * n / 4).contains(index));
                    patches.push(Patch {
                        corners: [at(0.0, 0.0), at(0.0, 1.0), at(1.0, 1.0), at(1.0, 0.0)],
                        center: at(0.5, 0.5),
                        normal,
                        albedo: if is_light { self.light_albedo } else { *albedo },
                        emission: if is_light { self.emission } else { 0.0 },
                    });
                }
            }
        }
        patches
    }

    /// The mean radiance that arrives at a point of the box over directions with density `cos θ / π`, with `n` by `n` patches
    /// per face.
    fn arriving_with(&self, point: DVec3, normal: DVec3, n: usize) -> f64 {
        let patches = self.patches(n);
        let shares: Vec<Vec<f64>> = patches
            .iter()
            .map(|patch| patches.iter().map(|other| share(patch.center, patch.normal, other)).collect())
            .collect();
        // Solve B = E + ρ F B by Gauss–Seidel iteration. It converges because each row of F sums to 1 and ρ is below 1.
        let mut radiance: Vec<f64> = patches.iter().map(|patch| patch.emission).collect();
        loop {
            let mut change = 0.0f64;
            for (index, patch) in patches.iter().enumerate() {
                let arriving: f64 =
                    shares[index].iter().zip(&radiance).map(|(share, light)| share * light).sum();
                let new = patch.emission + patch.albedo * arriving;
                change = change.max((new - radiance[index]).abs());
                radiance[index] = new;
            }
            if change <= 1e-12 * self.emission {
                break;
            }
        }
        patches.iter().zip(&radiance).map(|(patch, light)| share(point, normal, patch) * light).sum()
    }

    /// The mean radiance that arrives at a point. The error of a division is of second order in the size of the patches, so two
    /// divisions give the limit up to 1e-4 of the emission; the test below compares it with a known limit.
    pub fn arriving(&self, point: DVec3, normal: DVec3) -> f64 {
        let (coarse, fine) = (self.arriving_with(point, normal, 4), self.arriving_with(point, normal, 8));
        fine + (fine - coarse) / 3.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::dvec3;

    const BOX: EmptyBox =
        EmptyBox { albedo: [0.3, 0.7, 0.7, 0.7, 0.7, 0.7], light_albedo: 0.0, emission: 1.0 };

    #[test]
    fn the_shares_of_all_patches_sum_to_one() {
        let patches = BOX.patches(8);
        for patch in &patches {
            let sum: f64 = patches.iter().map(|other| share(patch.center, patch.normal, other)).sum();
            assert!((sum - 1.0).abs() < 1e-12, "{sum}");
        }
    }

    #[test]
    fn an_empty_box_has_its_known_light() {
        // The limit for patches without size was computed with 20 by 20 patches per face, by another program.
        let arriving = BOX.arriving(dvec3(0.5, 0.0, 0.5), DVec3::Y);
        assert!((arriving - 0.134_253).abs() < 5e-5, "{arriving}");
    }

    #[test]
    fn two_divisions_give_the_limit_for_bright_walls_too() {
        let bright = EmptyBox { albedo: [0.2, 0.75, 0.75, 0.75, 0.75, 0.75], light_albedo: 0.75, ..BOX };
        let point = dvec3(0.5, 0.0, 0.5);
        let (coarse, fine) =
            (bright.arriving_with(point, DVec3::Y, 8), bright.arriving_with(point, DVec3::Y, 16));
        let limit = fine + (fine - coarse) / 3.0;
        let arriving = bright.arriving(point, DVec3::Y);
        println!("{arriving} {limit}");
        assert!((arriving - limit).abs() < 1e-4, "{arriving} {limit}");
    }
}
