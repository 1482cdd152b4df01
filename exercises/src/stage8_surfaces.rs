//! Stage 8 · curved surfaces: surfaces without a simple formula for ray hits are approximated by triangles.
//!
//! Slides: "Ray-tracing other primitives" (surfaces by subdivision); Loop, "Smooth Subdivision Surfaces Based on
//! Triangles", 1987; Hoppe et al. 1994 for its borders.

use glam::{Vec2, Vec3};
use raykata::mesh::Mesh;
use raykata::shape::BezierPatch;
use std::collections::HashMap;

/// Computes a point of a bicubic Bézier patch by de Casteljau's algorithm, which is repeated linear interpolation.
///
/// `u` runs along the rows and `v` along the columns, both in `0..=1`. For `u` and `v` of 0 or 1 the result is exactly
/// the corner of the control net: (0, 0) gives `rows[0][0]`, (1, 0) gives `rows[0][3]` and (0, 1) gives `rows[3][0]`.
///
/// Pitfall: `p + t (q - p)` is not always exactly `q` at t = 1, and then neighbouring patches have gaps. Use
/// `(1 - t) p + t q`.
pub fn bezier_point(patch: &BezierPatch, uv: Vec2) -> Vec3 {
    todo!("interpolate three times along each row with u, then the four results with v")
}

/// One step of Loop subdivision: each triangle becomes four, and the vertices move towards their neighbours, so that the mesh
/// becomes smoother with each step. What happens where the mesh ends?
///
/// Exactly:
///
/// - An edge `p q` between two triangles, whose third corners are `r` and `s`, gets the vertex `3/8 (p + q) + 1/8 (r + s)`. An
///   edge with one triangle (a border) gets `1/2 (p + q)`.
/// - An old vertex `p` with `n` neighbours `pᵢ` moves to `(1 - n β) p + β Σ pᵢ`. β is `3/16` for `n = 3` and else
///   `3 / (8 n)` (Warren), or Loop's own `(5/8 - (3/8 + cos(2π/n)/4)²) / n`.
/// - On a border, whose two neighbours along it are `p₁` and `p₂`, it moves to `3/4 p + 1/8 (p₁ + p₂)`. A vertex of no
///   triangle stays.
/// - All formulas use the old positions.
/// - Old vertices keep their numbers. The new ones follow, one per edge, in any order.
/// - The triangles, in any order, have the order of corners and the material of the old one.
/// - Texture coordinates of an old vertex stay; a new vertex has the mean of the ends of its edge. Without them, or without
///   materials, the result has none. It has no normals.
///
/// No edge has more than two triangles, and no vertex more than two borders.
///
/// Loop 1987; Warren 1995; Hoppe et al. 1994 (borders).
pub fn loop_subdivide(mesh: &Mesh) -> Mesh {
    todo!("find the edges, place a vertex on each, move the old vertices, make four triangles of each")
}
