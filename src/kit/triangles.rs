//! Stage 2, triangles and meshes: queries and answers.

use crate::ray::Ray;
use crate::shape::Triangle;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Asks where `ray` hits `triangle`; the answer is a [`TriangleHit`](super::TriangleHit) if there is a hit that
/// counts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TriangleQuery {
    /// The ray; its range says which hits count.
    pub ray: Ray,
    /// The triangle that is intersected.
    pub triangle: Triangle,
}

/// Asks whether `point`, where `ray` hits the plane of `triangle`, lies inside the triangle.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct InsideQuery {
    /// The ray that hits the plane at `point`.
    pub ray: Ray,
    /// The hit with the plane, rounded to single precision, in world units.
    pub point: Vec3,
    /// The triangle in whose plane the point lies.
    pub triangle: Triangle,
}

/// Asks which value is interpolated between three corners at the barycentric coordinates `(α, β, γ)`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct InterpolateQuery {
    /// The barycentric coordinates `(α, β, γ)`, whose sum is 1.
    pub barycentric: Vec3,
    /// The values at the corners `a`, `b` and `c`.
    pub corners: [Vec3; 3],
}
