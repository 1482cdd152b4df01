//! From a point on a light to the light that arrives from there.

use crate::kit::LightSample;
use crate::material::{AreaShape, Emitter, Falloff, Light};
use crate::shape::Sphere;
use glam::{DVec3, Vec3};

impl Light {
    /// The light that would arrive at `point`, in world space, from the centre of this light if nothing stood
    /// in its way.
    ///
    /// A directional light is infinitely far away and does not weaken. The distance to a spherical light ends
    /// at its surface, so that a sphere that the scene shows in its place does not block it; from the centre
    /// of the sphere, the direction is +y.
    #[inline]
    pub fn sample_center(&self, point: Vec3) -> LightSample {
        match &self.emitter {
            Emitter::Point { position, .. } => {
                let sample = self.sample_at(*position, point);
                let share = self.cone.map_or(1.0, |cone| cone.share(-sample.direction));
                LightSample { radiance: share * sample.radiance, ..sample }
            }
            Emitter::Area { shape: AreaShape::Sphere(sphere), .. } => {
                let way = (sphere.center - point).as_dvec3();
                let direction = way.normalize_or(DVec3::Y).as_vec3();
                self.sample_toward_sphere(sphere, direction, point)
            }
            Emitter::Area { shape, .. } => self.sample_at(shape.center(), point),
            Emitter::Directional { direction } => {
                LightSample { direction: -*direction, distance: f32::INFINITY, radiance: self.radiance() }
            }
        }
    }

    /// The light that would arrive at `point` from the point `place` of this light, both in world space, if
    /// nothing stood in its way. By the inverse-square law it is divided by the square of their distance, if
    /// the light has that falloff.
    ///
    /// Where the two points are the same, the direction is +y, and a light with inverse-square falloff has
    /// infinite radiance (NaN in a channel that is 0).
    #[inline]
    pub fn sample_at(&self, place: Vec3, point: Vec3) -> LightSample {
        let way = place - point;
        // Squares of lengths below 1e-19 and above 1e19 do not fit single precision.
        let distance = way.as_dvec3().length() as f32;
        let direction = if distance > 0.0 { way / distance } else { Vec3::Y };
        self.arriving(direction, distance, distance)
    }

    /// The light that would arrive at `point` from the point of the spherical light `sphere` that it sees in
    /// the unit direction `direction`: the near side from outside of the sphere, the far side from inside.
    ///
    /// It weakens with the distance to the centre, as if all light came from there. A direction that just
    /// misses the sphere by a rounding error counts as touching it. At the centre, inverse-square falloff
    /// gives infinite radiance (NaN in a channel that is 0).
    pub fn sample_toward_sphere(&self, sphere: &Sphere, direction: Vec3, point: Vec3) -> LightSample {
        let distance = distance_to_sphere(sphere, direction, point);
        self.arriving(direction, distance, point.distance(sphere.center))
    }

    #[inline]
    fn arriving(&self, direction: Vec3, distance: f32, weakening_distance: f32) -> LightSample {
        let falloff = match &self.emitter {
            Emitter::Point { falloff, .. } | Emitter::Area { falloff, .. } => *falloff,
            Emitter::Directional { .. } => Falloff::None,
        };
        let weakened = match falloff {
            Falloff::None => 1.0,
            Falloff::InverseSquare => 1.0 / (weakening_distance * weakening_distance),
        };
        LightSample { direction, distance, radiance: weakened * self.radiance() }
    }
}

/// The distance along the unit vector `direction` to the sphere: to its near side from outside, to its far
/// side from inside. A direction that just misses the sphere by a rounding error counts as touching it.
fn distance_to_sphere(sphere: &Sphere, direction: Vec3, point: Vec3) -> f32 {
    // Use double precision, because 24 bits cannot hold the square of a small radius beside that of a long distance.
    let (to_center, direction) = (sphere.center.as_dvec3() - point.as_dvec3(), direction.as_dvec3());
    let radius = f64::from(sphere.radius);
    let middle = to_center.dot(direction);
    let half_chord = (radius * radius - (to_center - middle * direction).length_squared()).max(0.0).sqrt();
    let outside = to_center.length_squared() > radius * radius;
    (if outside { middle - half_chord } else { middle + half_chord }).max(0.0) as f32
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::Cone;

    #[test]
    fn the_way_to_a_sphere_ends_at_its_surface() {
        let sphere = Sphere { center: Vec3::new(0.0, 5.0, 0.0), radius: 2.0 };
        assert_eq!(distance_to_sphere(&sphere, Vec3::Y, Vec3::ZERO), 3.0);
        assert_eq!(distance_to_sphere(&sphere, Vec3::Y, Vec3::new(0.0, 4.0, 0.0)), 3.0); // from inside
        let touching = Vec3::new(2.0, 21f32.sqrt(), 0.0).normalize();
        assert!((distance_to_sphere(&sphere, touching, Vec3::ZERO) - 21f32.sqrt()).abs() < 2e-3);
    }

    #[test]
    fn a_spot_light_is_a_point_light_in_its_cone() {
        let emitter = Emitter::Point { position: 4.0 * Vec3::Y, falloff: Falloff::InverseSquare };
        let radiance = |(full, none), point| {
            let cone = Some(Cone { axis: Vec3::NEG_Y, full, none });
            let light =
                Light { emitter: emitter.clone(), color: Vec3::ONE, intensity: 8.0, shadows: true, cone };
            light.sample_center(point).radiance.x
        };
        let half = 60f32.to_radians().cos();
        assert_eq!(radiance((half, 0.0), Vec3::ZERO), 0.5);
        assert_eq!(radiance((half, 0.0), Vec3::new(0.0, 4.5, 0.0)), 0.0);
        // Halfway between the cosines 0.5 and 0 half of the light arrives.
        let halfway = Vec3::new(4.0 * 15f32.sqrt(), 0.0, 0.0);
        assert!((radiance((half, 0.0), halfway) - 0.5 * 8.0 / 256.0).abs() < 1e-6);
        // A sharp cone, and one that is the whole sphere.
        assert_eq!(radiance((half, half), halfway), 0.0);
        assert_eq!(radiance((f32::MIN, f32::MIN), Vec3::new(0.0, 5.0, 0.0)), 8.0);
    }

    #[test]
    fn light_weakens_with_the_square_of_the_way_to_its_place() {
        let light = Light {
            emitter: Emitter::Point { position: 4.0 * Vec3::Y, falloff: Falloff::InverseSquare },
            color: Vec3::ONE,
            intensity: 8.0,
            shadows: true,
            cone: None,
        };
        assert_eq!(light.sample_center(Vec3::ZERO).radiance, Vec3::splat(0.5));
        assert_eq!(light.sample_at(2.0 * Vec3::Y, Vec3::ZERO).radiance, Vec3::splat(2.0));
    }
}
