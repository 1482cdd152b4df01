//! Stage 8 · curved surfaces: what no formula intersects is made of triangles first.
//!
//! Slides: "Ray-tracing other primitives" (surfaces by subdivision); Loop, "Smooth Subdivision Surfaces Based on
//! Triangles", 1987; Hoppe et al. 1994 for its borders.

use glam::{Vec2, Vec3};
use raykata::mesh::Mesh;
use raykata::shape::BezierPatch;
use std::collections::HashMap;

/// The point of a bicubic Bézier patch at `u` along its rows and `v` along its columns, both `0..=1`, by de Casteljau's
/// repeated blending. At the corners it is the corner of the control net, to the last bit.
pub fn bezier_point(patch: &BezierPatch, uv: Vec2) -> Vec3 {
    todo!("blend neighbours three times along each row, then the four results along the column")
}

/// One step of Loop's subdivision: every triangle becomes four. The vertices of `mesh` keep their numbers and move; behind
/// them comes one new vertex for each edge.
///
/// - New vertex of an edge `p q` between triangles with the third corners `r` and `s`: `3/8 (p + q) + 1/8 (r + s)`; of an
///   edge with a triangle on one side only: its middle.
/// - Old vertex with `n` neighbours `pᵢ`: `(1 - n β) p + β Σ pᵢ` with `β = 3/16` for `n = 3` and `3 / 8n` otherwise; on a
///   border, with the neighbours `p₁`, `p₂` along it: `3/4 p + 1/8 (p₁ + p₂)`. A vertex that belongs to no triangle stays.
///
/// Texture coordinates of new vertices are the mean of their edge's ends; materials of faces are passed on; normals are
/// dropped, because the surface is another one.
pub fn loop_subdivide(mesh: &Mesh) -> Mesh {
    todo!("find the edges, place a vertex on each, move the old ones, make four triangles of each")
}
