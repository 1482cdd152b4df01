//! Stage 2 · triangles: three methods of ray-triangle intersection, three inside tests, and the
//! normals of meshes.
//!
//! Slides: `slides/stage02.md`.
//!
//! A hit is `(t, β, γ)` with `o + t d = a + β (b - a) + γ (c - a)`, where `β ≥ 0`, `γ ≥ 0` and
//! `β + γ ≤ 1`. With `α = 1 - β - γ`, the numbers `(α, β, γ)` are the barycentric coordinates of
//! the hit for the corners a, b and c.
//!
//! The contract of the three intersection functions. Exactly:
//!
//! - A hit counts if `ray.contains(t)`: the range is open. `t` counts lengths of `direction`, which
//!   need not be a unit vector.
//! - Points on an edge belong to the triangle. (In single precision that is certain only if nothing
//!   is rounded: otherwise a point of an edge may come out beside it. Stage 10 decides exactly.)
//! - The triangle is hit from the front and from the back, so the order of the corners does not
//!   matter.
//! - The triangle may have any size, so no fixed epsilon is right.
//! - Hits stay accurate far from the world's origin.
//! - `None` for a ray along the plane of the triangle, a triangle without area, a direction of 0,
//!   and a NaN anywhere.
//! - If products of the sizes overflow or underflow single precision, as those of edges above 1e12
//!   or below 1e-15 do, a hit and a miss are both right, but no part of a hit is NaN or infinite.

use glam::Vec3;
use raykata::bvh::{PrimitiveHit, Probe};
use raykata::kit::{GramScalars, TriangleHit};
use raykata::mesh::Mesh;
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// The ray meets the triangle where `o + t d = a + β (b - a) + γ (c - a)`. These are three
/// equations, for x, y and z:
///
/// ```text
/// β (a - b) + γ (a - c) + t d = a - o
/// ```
///
/// Cramer's rule solves them. The determinant `D` on the slide contains `a - o`, so it depends on
/// where the ray starts. Can that be right?
///
/// The contract is at the top of this file.
pub fn triangle_cramer(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    todo!("solve the three equations for β, γ and t by Cramer's rule")
}

/// The Gram method needs only four numbers of a triangle, with `u = b - a` and `v = c - a`: `u·v`,
/// `v·v`, `u·u` and the determinant `D = (u·v)² - (u·u)(v·v)`. What is left of this difference for
/// a thin triangle?
///
/// `D` is 0 for a triangle without area and negative otherwise. It is never positive, however thin
/// the triangle is.
pub fn gram_scalars(triangle: &Triangle) -> GramScalars {
    todo!("compute u·v, v·v, u·u and D for u = b - a and v = c - a")
}

/// First intersect the plane, which gives `t` and the point P. Then solve for the coordinates of
/// `I = P - a = s u + t v` (this s is our β, this t our γ):
///
/// ```text
/// I·u = s u·u + t u·v
/// I·v = s u·v + t v·v
/// ```
///
/// Is P inside if `0 ≤ s + t ≤ 1`? How exact is P far from the world's origin?
///
/// `scalars` are the [`gram_scalars`] of `triangle`. The contract is at the top of this file.
pub fn triangle_gram(ray: &Ray, triangle: &Triangle, scalars: &GramScalars) -> Option<TriangleHit> {
    todo!("find t from the plane of the triangle, then β and γ from the Gram scalars")
}

/// A method of your choice. Pictures use it until you write `watertight` in stage 10. Many
/// published versions compare the determinant with an epsilon, or reject a negative one: which hits
/// do they lose?
///
/// The contract is at the top of this file.
///
/// Source: Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997 (the method
/// of the reference).
pub fn triangle_choice(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    todo!("any method that you like: Möller–Trumbore, Plücker, watertight …")
}

/// Inside test I: the ray's origin o and each side of the triangle span a plane. A point P inside
/// lies on the same side of all three. For the side from T₁ to T₂ that is the sign of `n₁·(P - o)`
/// with `n₁ = (T₂ - o) × (T₁ - o)`. Which sign means inside?
///
/// P = `point` lies in the plane of the triangle, up to rounding.
///
/// Exactly:
///
/// 1. The corners may have either order.
/// 2. Points on an edge are inside.
/// 3. A plane whose normal is 0, because o lies on the side's line, accepts every point.
pub fn inside_by_planes(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool {
    todo!("test on which side of the plane through ray.origin and each side the point lies")
}

/// Inside test II: seen along the ray, P = `point` is inside if it lies on the same side of all
/// three edges. For the edge from T₁ to T₂ that is the sign of `d·((T₂ - P) × (T₁ - P))`. Which
/// sign is that from behind?
///
/// `point` lies in the plane of the triangle, up to rounding. The corners may have either order.
/// Points on an edge are inside.
pub fn inside_by_direction(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool {
    todo!("test the sign of d · ((T2 - P) × (T1 - P)) for each side")
}

/// Inside test III: P = `point` divides the triangle into three, whose areas give its barycentric
/// coordinates: `α = Area(P b c) / Area(a b c)`, and so on for β (P c a) and γ (P a b). Which areas
/// has a point outside?
///
/// Returns `(α, β, γ)`, or `None` for a point outside or a triangle without area. `point` lies in
/// the plane of the triangle, up to rounding. Points on an edge are inside.
pub fn inside_by_areas(point: Vec3, triangle: &Triangle) -> Option<Vec3> {
    todo!("return the three signed areas, divided by the area of the triangle, if none is negative")
}

/// The front of a triangle is the side to which `n = (b - a) × (c - a)` points: from there, its
/// corners run anticlockwise. A ray comes from behind if `n·d > 0`. How large is n for a tiny
/// triangle?
///
/// Returns whether the ray comes from behind, whether or not it hits the triangle in its range.
///
/// Exactly:
///
/// 1. `false` for a triangle seen edge-on (`n·d = 0` exactly) and for one without area.
/// 2. The triangle may have any size.
///
/// Source: "Ray-Triangle Intersection III".
pub fn backfacing(ray: &Ray, triangle: &Triangle) -> bool {
    todo!("return whether n·d > 0 for n = (b - a) × (c - a)")
}

/// Interpolation with barycentric coordinates `(α, β, γ)`: `α A + β B + γ C` for the values A, B
/// and C at the corners. The result is not normalized.
pub fn interpolate(barycentric: Vec3, corners: [Vec3; 3]) -> Vec3 {
    todo!("return the sum of the three values, each times its barycentric coordinate")
}

/// The unit normal of a triangle, `u × v / |u × v|` with `u = b - a` and `v = c - a`. How large is
/// `|u × v|²` if the edges are 1e-12 long?
///
/// The result has length 1 up to rounding for a triangle of any size. It is `None` for a triangle
/// without area.
pub fn face_normal(triangle: &Triangle) -> Option<Vec3> {
    todo!("normalize u × v, and return None for a triangle without area")
}

/// A vertex normal is the normalized sum of the unit normals of the triangles around the vertex.
/// What is the sum of up and down?
///
/// Returns one unit normal per position of the mesh, in the same order.
///
/// Exactly:
///
/// 1. Each triangle with an area counts once, large or small.
/// 2. If the normals cancel, the vertex gets the normal of one of the triangles.
/// 3. A vertex without such a triangle gets any unit vector.
pub fn vertex_normals(mesh: &Mesh) -> Vec<Vec3> {
    todo!("add up the face normals at each vertex and normalize")
}

/// The closest hit has the smallest `t` of all primitives, `0..n_primitives`. Ask each with
/// `probe.hit(primitive, ray)`, which returns only hits in the ray's range.
///
/// The result is `None` if nothing is hit.
///
/// Exactly:
///
/// 1. Each primitive is asked exactly once.
/// 2. Of two hits at the same `t` the smaller number wins, as in all searches.
pub fn brute_force(n_primitives: u32, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("ask every primitive, and keep the hit with the smallest t")
}
