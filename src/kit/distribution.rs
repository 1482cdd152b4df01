//! Stage 6, distributed ray tracing: queries and answers.

use crate::camera::{Camera, Lens, Shutter};
use crate::ray::Ray;
use crate::shape::Sphere;
use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// The radius of the Gaussian pixel filter along x and along y, in pixels.
pub const FILTER_RADIUS: f32 = 1.5;

/// Asks which ray leaves a point of the lens.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LensQuery {
    /// The camera, whose `right` and `up` span the lens.
    pub camera: Camera,
    /// The ray through the centre of the lens, of unit direction.
    pub pinhole: Ray,
    /// The lens, with its aperture and focal distance in world units.
    pub lens: Lens,
    /// A point of the disk of radius 1, which stands for the aperture.
    pub on_lens: Vec2,
}

/// Asks which point of a rectangle two random numbers sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RectangleQuery {
    /// A corner, in world units.
    pub corner: Vec3,
    /// The two edges from that corner, in world units.
    pub edges: (Vec3, Vec3),
    /// Two random numbers, `0 <= u < 1` each.
    pub u: Vec2,
}

/// Asks which direction towards a sphere two random numbers sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SphereSampleQuery {
    /// The sphere to which the direction leads.
    pub sphere: Sphere,
    /// The point from which the sphere is seen, in world units.
    pub from: Vec3,
    /// Two random numbers, `0 <= u < 1` each.
    pub u: Vec2,
}

/// Asks which direction of a glossy reflection or refraction two random numbers sample.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PhongLobeQuery {
    /// The direction in which a perfectly smooth surface would send the ray, of unit length.
    pub ideal: Vec3,
    /// The unit normal on the side of the surface on which the secondary ray continues.
    pub normal: Vec3,
    /// The roughness of the surface, `0..=1`: 0 is perfectly smooth, 1 spreads the directions most.
    pub roughness: f32,
    /// Two random numbers, `0 <= u < 1` each.
    pub u: Vec2,
}

/// Asks at which time a ray is traced, while the shutter is open.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimeQuery {
    /// The interval of time in which the shutter is open.
    pub shutter: Shutter,
    /// The number of the time slot, `1..=slots`.
    pub slot: u32,
    /// The number of slots of equal length into which the interval is divided, at least 1.
    pub slots: u32,
    /// The position in the slot: a random number, `0 <= u < 1`.
    pub u: f32,
}
