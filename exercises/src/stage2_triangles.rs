//! Stage 2 · triangles: three methods of ray-triangle intersection, three inside tests, and the normals of meshes.
//!
//! Slides: "Finding the intersection", "Cramer's Rule", "Ray-triangle intersection precomputations",
//! "Ray-Triangle Intersection" I, II, III, "Smooth Shading", "Normals of Vertices".
//!
//! A hit is `(t, β, γ)` with `o + t d = a + β (b - a) + γ (c - a)`, where `β ≥ 0`, `γ ≥ 0` and `β + γ ≤ 1`. With
//! `α = 1 - β - γ`, the numbers `(α, β, γ)` are the barycentric coordinates of the hit for the corners a, b and c.
//!
//! The contract of the three intersection functions: points on an edge belong to the triangle. (In single precision that is
//! certain only if nothing is rounded: otherwise a point of an edge may come out beside it. Stage 10 decides exactly.) The
//! triangle is hit
//! from the front and from the back, so the order of the corners does not matter. `t` counts lengths of `direction`,
//! which need not be a unit vector. A hit counts if `ray.contains(t)`: the range is open. The triangle may have any
//! size, so no fixed epsilon is right. The result is `None` for a ray along the plane of the triangle, a triangle
//! without area, a direction of 0, and a NaN anywhere. If products of the sizes overflow or underflow single precision, as
//! those of edges above 1e12 or below 1e-15 do, a hit and a miss are both right, but no part of a hit is NaN or infinite.

use glam::Vec3;
use raykata::bvh::{PrimitiveHit, Probe};
use raykata::kit::{GramScalars, TriangleHit};
use raykata::mesh::Mesh;
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// Ray-triangle intersection by Cramer's rule: solve `β (a - b) + γ (a - c) + t d = a - o`, which is three equations
/// (x, y and z) with three unknowns.
///
/// Points on an edge belong to the triangle, and both of its sides can be hit. `t` counts lengths of `direction`, and a
/// hit counts if `ray.contains(t)`. The result is `None` for a ray along the plane, a triangle without area, and a NaN.
/// No fixed epsilon is right. The full contract is at the top of this file.
///
/// Pitfall: the determinant `D` on the slide is wrong, because it repeats terms of the numerator of x. It is right
/// for triangles along the axes and loses more than half of the hits of all others. The method itself has a weakness,
/// too: two triangles that share an edge round differently, so one in ten rays that are aimed at the edge hits neither.
pub fn triangle_cramer(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    todo!("solve the three equations for β, γ and t by Cramer's rule")
}

/// The four numbers of a triangle that the Gram method needs, computed once per triangle: `u·v`, `v·v`, `u·u` and
/// `D = (u·v)² - (u·u)(v·v)` for `u = b - a`, `v = c - a`.
///
/// All are in world units: squared for the dot products, to the fourth power for `D`. `D` is 0 for a triangle without
/// area and negative otherwise.
///
/// Pitfall: for a thin triangle `D` is the difference of two nearly equal numbers, so this formula gives zero or even
/// a positive number. `D` is equal to `-|u × v|²`, which is never positive.
pub fn gram_scalars(triangle: &Triangle) -> GramScalars {
    todo!("compute u·v, v·v, u·u and D for u = b - a and v = c - a")
}

/// Ray-triangle intersection by the Gram matrix: first the `t` at which the ray hits the plane of the triangle, then
/// the barycentric coordinates `s` (here β) and `t` (here γ) of the point `I = P - a = s u + t v`.
///
/// `scalars` are the [`gram_scalars`] of `triangle`.
///
/// Points on an edge belong to the triangle, and both of its sides can be hit. `t` counts lengths of `direction`, and a
/// hit counts if `ray.contains(t)`. The result is `None` for a ray along the plane, a triangle without area, and a NaN.
/// No fixed epsilon is right. The full contract is at the top of this file.
///
/// Pitfall: "0 ≤ s + t ≤ 1" alone accepts points with a negative coordinate. Test `s ≥ 0` and `t ≥ 0` as well. The
/// method itself has a weakness, too: it rounds the point before the test, so far from the origin that error decides.
pub fn triangle_gram(ray: &Ray, triangle: &Triangle, scalars: &GramScalars) -> Option<TriangleHit> {
    todo!("find t from the plane of the triangle, then β and γ from the Gram scalars")
}

/// Ray-triangle intersection by a method of your choice. Your pictures use this function until you write `watertight`
/// in stage 10.
///
/// Points on an edge belong to the triangle, and both of its sides can be hit. `t` counts lengths of `direction`, and a
/// hit counts if `ray.contains(t)`. The result is `None` for a ray along the plane, a triangle without area, and a NaN.
/// No fixed epsilon is right. The full contract is at the top of this file.
///
/// Pitfall: many published versions compare the determinant with an epsilon, which loses small triangles, or reject a
/// negative determinant, which loses all hits from behind.
///
/// The reference is the method of Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997.
pub fn triangle_choice(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    todo!("any method that you like: Möller–Trumbore, Plücker, watertight …")
}

/// Inside test I: the ray's origin and each side of the triangle span a plane, and `point` is inside if it lies on
/// the same side of all three planes.
///
/// `point` lies in the plane of the triangle, up to rounding. The corners may have either order, clockwise or
/// counterclockwise. A point on a plane lies on both of its sides, so points on an edge are inside, and the plane of
/// a side whose line contains the ray's origin (its normal is 0) accepts every point. A NaN gives `false`.
///
/// Pitfall: "distance < 0 → outside" is right for one order of the corners only. Do not normalize the normals, because
/// that changes no sign and turns a normal of 0 into NaN.
pub fn inside_by_planes(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool {
    todo!("test on which side of the plane through ray.origin and each side the point lies")
}

/// Inside test II: seen along the ray, `point` is inside if it lies on the same side of all three edges. The sign of
/// `d · ((T₂ - P) × (T₁ - P))` tells the side for the edge from `T₁` to `T₂`.
///
/// `point` lies in the plane of the triangle, up to rounding. The corners may have either order. Points on an edge
/// are inside. With a NaN the result is `false`.
pub fn inside_by_direction(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool {
    todo!("test the sign of d · ((T2 - P) × (T1 - P)) for each side")
}

/// Inside test III: the barycentric coordinates `(α, β, γ)` of `point`, each of which is the area of a triangle
/// between `point` and two corners, divided by the area of the whole triangle.
///
/// `point` lies in the plane of the triangle, up to rounding. α belongs to corner a and the area opposite of it, β to
/// b, and γ to c. Points on an edge are inside. The result is `None` if `point` is outside, if the triangle has no
/// area, or for a NaN.
///
/// Pitfall: areas without a sign cannot tell (-0.2, -0.2) from (0.2, 0.2). Measure each area along the normal of the
/// triangle, so that it is negative outside.
pub fn inside_by_areas(point: Vec3, triangle: &Triangle) -> Option<Vec3> {
    todo!("return the three signed areas, divided by the area of the triangle, if none is negative")
}

/// Backfacing test: whether the triangle turns its back to the ray. Its front is the side to which the normal
/// `n = (b - a) × (c - a)` points, the side from which its corners run anticlockwise. The ray comes from behind if
/// `n·d > 0`, with d the ray's direction.
///
/// Returns `false` for a triangle seen edge-on (`n·d = 0` exactly), for a triangle without area and for a NaN: the
/// intersection test decides about these. Whether the ray hits the triangle, and its range, do not matter. A renderer
/// skips the intersection test for triangles of one-sided meshes that turn their back to the ray.
///
/// Pitfall: the sign depends on this ray, not on the direction in which the camera looks, and not on a limit for the
/// cosine. The triangle may have any size: for edges of 1e-20 the products underflow in single precision, and every
/// triangle looks edge-on.
///
/// Slide: "Ray-Triangle Intersection III".
pub fn backfacing(ray: &Ray, triangle: &Triangle) -> bool {
    todo!("return whether n·d > 0 for n = (b - a) × (c - a)")
}

/// Interpolation with barycentric coordinates: `α A + β B + γ C` for `barycentric` = `(α, β, γ)` and the values A, B and
/// C at the corners a, b and c. The result is not normalized.
pub fn interpolate(barycentric: Vec3, corners: [Vec3; 3]) -> Vec3 {
    todo!("return the sum of the three values, each times its barycentric coordinate")
}

/// The unit normal `u × v / |u × v|` of a triangle, with `u = b - a` and `v = c - a`.
///
/// The result has length 1 up to rounding for a triangle of any size. It is `None` for a triangle without area and
/// for a NaN.
///
/// Pitfall: for edges of 1e-11 the square of `|u × v|` underflows, and the "unit" normal is 1 % too long. For edges
/// of 1e-12 it is NaN. Scale the edges first, because their lengths do not change the direction of the normal.
pub fn face_normal(triangle: &Triangle) -> Option<Vec3> {
    todo!("normalize u × v, and return None for a triangle without area")
}

/// One unit normal per vertex: the normalized sum of the unit normals of the triangles that use the vertex.
///
/// The result has as many normals as the mesh has positions, in the same order. Each triangle counts once, whatever
/// its area. A triangle without area does not count. A vertex that no triangle with an area uses gets any unit vector.
///
/// Pitfall: opposite normals add up to zero, or to rounding errors, and zero cannot be normalized. Then take the
/// normal of one of the triangles around the vertex.
pub fn vertex_normals(mesh: &Mesh) -> Vec<Vec3> {
    todo!("add up the face normals at each vertex and normalize")
}

/// The closest hit among primitives `0..n_primitives`: call `probe.hit(primitive, ray)` for each of them and keep the
/// hit with the smallest `t`.
///
/// Each primitive is asked exactly once. Only hits in the ray's range count, and `probe.hit` returns no others. Of
/// two hits at the same `t` the primitive with the smaller number wins, so that all search functions return the same
/// hit. The result is `None` if nothing is hit.
pub fn brute_force(n_primitives: u32, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("ask every primitive, and keep the hit with the smallest t")
}
