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

/// Computes one step of Loop subdivision, which replaces each triangle by four. The old vertices keep their numbers and
/// move; after them comes one new vertex per edge, which the triangles of the edge share.
///
/// Each edge belongs to one triangle (a border) or to two, and two borders meet at each vertex of a border.
///
/// - New vertex of an edge `p q` between two triangles with the third corners `r` and `s`: `3/8 (p + q) + 1/8 (r + s)`.
/// - New vertex of a border edge, which has one triangle only: its midpoint `1/2 (p + q)`.
/// - Old vertex `p` with `n` neighbours `pᵢ`: `(1 - n β) p + β Σ pᵢ` with `β = 3/16` for `n = 3` and `3 / (8 n)`
///   otherwise (Warren), or with Loop's own `β = (5/8 - (3/8 + cos(2π/n)/4)²) / n`. On a border, with the neighbours `p₁` and `p₂` along it: `3/4 p + 1/8 (p₁ + p₂)`. A vertex that belongs
///   to no triangle stays.
/// - The four triangles have their corners in the order of the old triangle, and its material. The new vertices and the
///   triangles may come in any order.
/// - The texture coordinates of an old vertex stay; those of a new vertex are the mean of the ends of its edge. A mesh
///   without texture coordinates or materials gets none. Normals are dropped, because the surface changes.
///
/// Pitfall: all formulas use positions from before the step. A border may depend only on its own vertices, or a gap opens
/// between two meshes that share it.
///
/// Source: Loop 1987; Warren 1995 for the simpler β; Hoppe et al. 1994 for the border.
pub fn loop_subdivide(mesh: &Mesh) -> Mesh {
    todo!("find the edges, place a vertex on each, move the old vertices, make four triangles of each")
}
