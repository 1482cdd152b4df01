//! Surfaces that emit light, as data (stage 11).
//!
//! An [`AreaEmitter`] has a shape that rays can hit, so its light is found in two ways: a ray happens to hit it, or a point
//! of it is sampled. A [`Light`](crate::material::Light) of a scene, in contrast, can only be sampled.

use crate::message;
use crate::shape::{Sphere, Triangle};
use glam::Vec3;

/// The shape of an area emitter, in world units. Each shape has a front.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EmitterShape {
    /// A sphere, whose front is the outside.
    Sphere(Sphere),
    /// A triangle, whose front is the side to which `(b - a) × (c - a)` points.
    Triangle(Triangle),
    /// All points `corner + s edges.0 + t edges.1` with `s` and `t` in `0..=1`. The front is the side to which
    /// `edges.0 × edges.1` points.
    Parallelogram {
        /// A corner, in world units.
        corner: Vec3,
        /// The two edges from that corner, in world units. They need not be at right angles.
        edges: (Vec3, Vec3),
    },
}

message! { enum EmitterShape { Sphere(a), Triangle(a), Parallelogram { corner, edges } } }

/// A surface that emits the same radiance from each of its points in all directions on its front, and also on its back if
/// it is two-sided.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AreaEmitter {
    /// The shape.
    pub shape: EmitterShape,
    /// The emitted radiance, red, green and blue in linear light, at least 0.
    pub radiance: Vec3,
    /// Whether the back emits light, too.
    pub two_sided: bool,
}

message! { AreaEmitter { shape, radiance, two_sided } }

/// A point of an emitter as it is seen from another point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmitterSample {
    /// The direction to the point of the emitter, of unit length.
    pub direction: Vec3,
    /// The distance to the point of the emitter, in world units.
    pub distance: f32,
    /// The radiance that the emitter sends back along this direction.
    pub radiance: Vec3,
    /// The probability density of the direction, per steradian: above 0 and finite.
    pub pdf: f32,
}

message! { EmitterSample { direction, distance, radiance, pdf } }
