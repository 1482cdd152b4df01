//! Stage 2 in plain data.

use crate::ray::Ray;
use crate::shape::Triangle;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Where does `ray` meet `triangle`?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TriangleQuery {
    /// The ray.
    pub ray: Ray,
    /// The triangle.
    pub triangle: Triangle,
}

/// A point of a triangle on a ray: `o + t d = (1 - β - γ) a + β b + γ c`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TriangleHit {
    /// Distance along the ray, in lengths of its direction.
    pub t: f32,
    /// Weight of corner `b`.
    pub beta: f32,
    /// Weight of corner `c`.
    pub gamma: f32,
}

/// The four numbers of a triangle that the Gram method computes once, for `u = b - a` and `v = c - a`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GramScalars {
    /// `u · v`.
    pub uv: f32,
    /// `v · v`.
    pub vv: f32,
    /// `u · u`.
    pub uu: f32,
    /// `(u · v)² - (u · u)(v · v)`, which is `-|u × v|²`: never above zero.
    pub d: f32,
}

/// Does `point`, which lies in the plane of `triangle` on the way of `ray`, lie inside the triangle?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct InsideQuery {
    /// The ray whose plane hit is asked about.
    pub ray: Ray,
    /// The hit in the plane.
    pub point: Vec3,
    /// The triangle.
    pub triangle: Triangle,
}

/// What is the value at weights `(α, β, γ)` between three corners?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct InterpolateQuery {
    /// `(α, β, γ)`; they add up to 1.
    pub weights: Vec3,
    /// Values at the corners.
    pub corners: [Vec3; 3],
}
