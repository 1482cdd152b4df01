//! What the tests of rays with shapes answer.

use crate::message;
use glam::Vec3;

/// A hit of a ray with a triangle, in barycentric coordinates: `o + t d = (1 - β - γ) a + β b + γ c`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriangleHit {
    /// The ray parameter of the hit: the distance along the ray, in lengths of its direction.
    pub t: f32,
    /// The barycentric coordinate β of corner `b`, `0..=1`.
    pub beta: f32,
    /// The barycentric coordinate γ of corner `c`, `0..=1`; `β + γ <= 1`.
    pub gamma: f32,
}

message! { TriangleHit { t, beta, gamma } }

/// The four numbers of a triangle that the Gram method computes once, for `u = b - a` and `v = c - a`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GramScalars {
    /// The dot product `u · v`, in square world units.
    pub uv: f32,
    /// The dot product `v · v`, in square world units.
    pub vv: f32,
    /// The dot product `u · u`, in square world units.
    pub uu: f32,
    /// The determinant `(u · v)² - (u · u)(v · v)`, which is `-|u × v|²` and so never above 0.
    pub d: f32,
}

message! { GramScalars { uv, vv, uu, d } }

/// A hit of a ray with the surface of a solid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SolidHit {
    /// The ray parameter of the hit: the distance along the ray, in lengths of its direction.
    pub t: f32,
    /// The unit normal of the surface at the hit, which points out of the solid. For a disk it has the
    /// direction of the disk's normal; for a polygon it points to the side from which the corners run
    /// anticlockwise.
    pub normal: Vec3,
}

message! { SolidHit { t, normal } }
