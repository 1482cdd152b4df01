//! Stage 2 · triangles: three ways to meet one, three ways to be inside, and what a mesh makes of it.
//!
//! Slides: "Finding the intersection", "Cramer's Rule", "Ray-triangle intersection precomputations",
//! "Ray-Triangle Intersection" I, II, III, "Smooth Shading", "Normals of Vertices".
//!
//! A hit is `(t, β, γ)` with `o + t d = a + β (b - a) + γ (c - a)`, where `β ≥ 0`, `γ ≥ 0` and `β + γ ≤ 1`: points on
//! an edge belong to the triangle, and either side can be hit. The ray's range decides which `t` count.

use glam::{DVec2, DVec3, Vec3};
use raykata::bvh::{PrimitiveHit, Probe};
use raykata::kit::{GramScalars, TriangleHit};
use raykata::mesh::Mesh;
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// Ray against triangle by Cramer's rule on `β (a - b) + γ (a - c) + t d = a - o`.
///
/// Where the formula lies: the slide's determinant `D` repeats terms of the numerator of x. It is right for triangles
/// along the axes and loses more than half of all others. Weakness of the method itself: neighbours that share an
/// edge round differently, so one ray in ten that is aimed at the edge slips between them.
pub fn triangle_cramer(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    todo!("solve the three equations for β, γ and t by Cramer's rule")
}

/// The four numbers of a triangle that the Gram method needs, computed once: `u·v`, `v·v`, `u·u` and
/// `D = (u·v)² - (u·u)(v·v)` for `u = b - a`, `v = c - a`.
///
/// Where the formula lies: for a thin triangle `D` is the difference of two nearly equal numbers, and comes out zero
/// or even positive. It is the same number as `-|u × v|²`.
pub fn gram_scalars(triangle: &Triangle) -> GramScalars {
    todo!("compute u·v, v·v, u·u and D for u = b - a and v = c - a")
}

/// Ray against triangle the other way: first its plane, then the weights `s` (here β) and `t` (here γ) of the point
/// `I = P - a` from the Gram matrix.
///
/// Where the formula lies: "0 ≤ s + t ≤ 1" alone lets points in with one weight below zero. Weakness of the method
/// itself: the point is rounded before it is tested, so far from the origin the error of `P` decides.
pub fn triangle_gram(ray: &Ray, triangle: &Triangle, scalars: &GramScalars) -> Option<TriangleHit> {
    todo!("meet the plane of the triangle, then find s and t from the Gram scalars")
}

/// Ray against triangle by a method of your choice. Your pictures are made with this one.
///
/// The reference is watertight: a ray aimed at a shared edge hits at least one of the two triangles, always (Woop,
/// Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013).
pub fn triangle_choice(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    todo!("any method that you like: Möller–Trumbore, Plücker, watertight …")
}

/// Inside test I: the plane through the ray's origin and a side of the triangle has `point` on its inner side, for
/// all three sides.
///
/// Where the formula lies: "distance < 0 → outside" holds for one winding only. Accept the point if it lies on the
/// same side of all three planes, whichever that is, and on a plane counts as inside. Normalising changes no sign.
pub fn inside_by_planes(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool {
    todo!("test on which side of the plane through ray.origin and each side the point lies")
}

/// Inside test II: seen along the ray, `point` lies on the same side of all three sides: the sign of
/// `d · ((T₂ - P) × (T₁ - P))`.
pub fn inside_by_direction(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool {
    todo!("test the sign of d · ((T2 - P) × (T1 - P)) for each side")
}

/// Inside test III: the weights `(α, β, γ)` of the corners a, b, c as shares of the area, if `point` is inside.
///
/// Where the formula lies: areas without a sign cannot tell (-0.2, -0.2) from (0.2, 0.2). Measure each area along the
/// normal of the triangle, so that it goes negative outside.
pub fn inside_by_areas(point: Vec3, triangle: &Triangle) -> Option<Vec3> {
    todo!("return the three signed areas over the area of the triangle, if none is below zero")
}

/// The value at weights `(α, β, γ)` between values at the three corners.
pub fn interpolate(weights: Vec3, corners: [Vec3; 3]) -> Vec3 {
    todo!("weigh the three corners")
}

/// The unit normal `u × v / |u × v|` of a triangle, `None` if it has no area.
///
/// Where the formula lies: for edges of 1e-11 the product of two lengths squared underflows, and the "unit" normal is
/// 1 % too long; for 1e-12 it is NaN. Scale the edges first: their lengths do not matter.
pub fn face_normal(triangle: &Triangle) -> Option<Vec3> {
    todo!("normalise u × v, and return None for a triangle without area")
}

/// One unit normal a vertex: the average of the normals of the triangles around it.
///
/// Where the formula lies: opposite normals average to zero, and zero cannot be normalised. Then take the normal of
/// one of the faces. A vertex that no proper face uses may have any unit normal.
pub fn vertex_normals(mesh: &Mesh) -> Vec<Vec3> {
    todo!("add up the face normals at each vertex and normalise")
}

/// The closest hit among primitives `0..n_primitives`: ask `probe.hit(primitive, ray)` for each. Of two hits at the
/// same `t` the primitive with the smaller number wins, so that every search agrees with every other.
pub fn brute_force(n_primitives: u32, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("ask every primitive, and keep the hit with the smallest t")
}
