//! Stage 2, triangles and meshes: queries and answers.

use crate::ray::Ray;
use crate::shape::Triangle;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Asks where `ray` hits `triangle`; the answer is a [`TriangleHit`] if there is a hit that counts.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TriangleQuery {
    /// The ray; its range says which hits count.
    pub ray: Ray,
    /// The triangle that is intersected.
    pub triangle: Triangle,
}

/// A hit of a ray with a triangle, in barycentric coordinates: `o + t d = (1 - β - γ) a + β b + γ c`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TriangleHit {
    /// The ray parameter of the hit: the distance along the ray, in lengths of its direction.
    pub t: f32,
    /// The barycentric coordinate β of corner `b`, `0..=1`.
    pub beta: f32,
    /// The barycentric coordinate γ of corner `c`, `0..=1`; `β + γ <= 1`.
    pub gamma: f32,
}

/// The four numbers of a triangle that the Gram method computes once, for `u = b - a` and `v = c - a`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
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
