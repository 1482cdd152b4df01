//! Stage 8 · curved surfaces: surfaces without a simple formula for ray hits are approximated by
//! triangles.
//!
//! Slides: `slides/stage08.md`. Sources: Loop, "Smooth Subdivision Surfaces Based on Triangles",
//! 1987; Hoppe et al. 1994 for its borders.

use glam::{Vec2, Vec3};
use raykata::mesh::Mesh;
use raykata::shape::BezierPatch;
use std::collections::HashMap;

/// A point of a bicubic Bézier patch by de Casteljau's algorithm, which is repeated linear
/// interpolation. `u` runs along the rows and `v` along the columns, both in `0..=1`. Is
/// `p + t (q - p)` exactly `q` at t = 1?
///
/// For `u` and `v` of 0 or 1 the result is exactly the corner of the net: (0, 0) gives
/// `rows[0][0]`, (1, 0) `rows[0][3]` and (0, 1) `rows[3][0]`.
pub fn bezier_point(patch: &BezierPatch, uv: Vec2) -> Vec3 {
    todo!("interpolate three times along each row with u, then the four results with v")
}

/// Each triangle becomes four, and vertices move towards their neighbours. What happens at a
/// border? An edge has at most two triangles, a vertex at most two borders.
///
/// Exactly:
///
/// 1. An edge `p q` with third corners `r` and `s` gets the vertex `3/8 (p+q) + 1/8 (r+s)`, a
///    border edge `1/2 (p+q)`.
/// 2. An old vertex `p` with `n` neighbours `pᵢ` moves to `(1 - nβ) p + β Σ pᵢ`. β is `3/16` for
///    `n = 3`, else `3/(8n)` (Warren), or Loop's `(5/8 - (3/8 + cos(2π/n)/4)²)/n`.
/// 3. On a border it moves to `3/4 p + 1/8 (p₁+p₂)` (neighbours on it). A vertex of no
///    triangle stays.
/// 4. All formulas use the old positions.
/// 5. Old vertices keep their numbers; new ones follow, one per edge, in any order.
/// 6. Triangles, in any order, keep the old order of corners and material.
/// 7. Old texture coordinates stay; a new vertex has the mean of its edge's ends. Without
///    them, or without materials, the result has none. It has no normals.
///
/// Source: Loop 1987; Warren 1995; Hoppe 1994.
pub fn loop_subdivide(mesh: &Mesh) -> Mesh {
    todo!("find the edges, place a vertex on each, move the old vertices, make four triangles of each")
}
