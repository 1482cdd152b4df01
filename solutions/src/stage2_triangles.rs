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
    // <solution>
    // Name the columns of the equations as the slide does: a e i | b f j | c g k | d h l.
    let [a, e, i] = (triangle.a - triangle.b).to_array();
    let [b, f, j] = (triangle.a - triangle.c).to_array();
    let [c, g, k] = ray.direction.to_array();
    let [d, h, l] = (triangle.a - ray.origin).to_array();

    // Compute the determinant of the columns (a e i), (b f j), (c g k). The slide wrongly prints
    // (gl - hk) instead of (gi - ek) and (hj - fl) instead of (ej - fi).
    let determinant = a * (f * k - g * j) + b * (g * i - e * k) + c * (e * j - f * i);
    // Reject rays along the plane and triangles without area.
    if determinant == 0.0 {
        return None;
    }
    // Replace one column after the other by the right side (d h l), and divide by the determinant.
    let beta = (d * (f * k - g * j) + b * (g * l - h * k) + c * (h * j - f * l)) / determinant;
    let gamma = (a * (h * k - g * l) + d * (g * i - e * k) + c * (e * l - h * i)) / determinant;
    let t = (a * (f * l - h * j) + b * (h * i - e * l) + d * (e * j - f * i)) / determinant;

    // Reject points outside the triangle and hits outside the ray's range. NaN makes each
    // comparison false.
    let inside = beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0;
    (inside && ray.contains(t)).then_some(TriangleHit { t, beta, gamma })
    // <stub> todo!("solve the three equations for β, γ and t by Cramer's rule")
    // </solution>
}

/// The Gram method needs only four numbers of a triangle, with `u = b - a` and `v = c - a`: `u·v`,
/// `v·v`, `u·u` and the determinant `D = (u·v)² - (u·u)(v·v)`. What is left of this difference for
/// a thin triangle?
///
/// `D` is 0 for a triangle without area and negative otherwise. It is never positive, however thin
/// the triangle is.
pub fn gram_scalars(triangle: &Triangle) -> GramScalars {
    // <solution>
    let u = triangle.b - triangle.a;
    let v = triangle.c - triangle.a;
    // Compute D as -|u × v|², which equals (u·v)² - (u·u)(v·v) and is never positive. For a thin
    // triangle that difference of nearly equal numbers would be rounding errors, and its sign as
    // well.
    GramScalars { uv: u.dot(v), vv: v.dot(v), uu: u.dot(u), d: -u.cross(v).length_squared() }
    // <stub> todo!("compute u·v, v·v, u·u and D for u = b - a and v = c - a")
    // </solution>
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
    // <solution>
    let u = triangle.b - triangle.a;
    let v = triangle.c - triangle.a;
    // Compute the t at which the ray hits the plane of the triangle.
    let normal = u.cross(v);
    let to_a = triangle.a - ray.origin;
    let t = to_a.dot(normal) / ray.direction.dot(normal);

    // Compute I = o + t d - a as t d - (a - o), because adding o to t d would round at the size of
    // o.
    let point = t * ray.direction - to_a;
    // Solve the two equations I·u = s u·u + t u·v and I·v = s u·v + t v·v.
    let (point_u, point_v) = (point.dot(u), point.dot(v));
    let beta = (scalars.uv * point_v - scalars.vv * point_u) / scalars.d;
    let gamma = (scalars.uv * point_u - scalars.uu * point_v) / scalars.d;

    // Reject points outside the triangle and hits outside the ray's range. Each comparison is false
    // for NaN, so this also rejects rays along the plane and triangles without area.
    let inside = beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0;
    (inside && ray.contains(t)).then_some(TriangleHit { t, beta, gamma })
    // <stub> todo!("find t from the plane of the triangle, then β and γ from the Gram scalars")
    // </solution>
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
    // <solution>
    // Solve o + t d = a + β edge1 + γ edge2 by Cramer's rule, with scalar triple products as
    // determinants.
    let edge1 = triangle.b - triangle.a;
    let edge2 = triangle.c - triangle.a;
    // Compute the determinant, and reject rays along the plane and triangles without area.
    let pvec = ray.direction.cross(edge2);
    let determinant = edge1.dot(pvec);
    if determinant == 0.0 {
        return None;
    }
    // Compute β from the vector from corner a to the ray's origin. Most rays miss, and most misses
    // end here. NaN makes each comparison false.
    let tvec = ray.origin - triangle.a;
    let beta = tvec.dot(pvec) / determinant;
    if !(0.0..=1.0).contains(&beta) {
        return None;
    }
    // Compute γ and t, which share a second cross product.
    let qvec = tvec.cross(edge1);
    let gamma = ray.direction.dot(qvec) / determinant;
    if !(gamma >= 0.0 && beta + gamma <= 1.0) {
        return None;
    }
    let t = edge2.dot(qvec) / determinant;
    ray.contains(t).then_some(TriangleHit { t, beta, gamma })
    // <stub> todo!("any method that you like: Möller–Trumbore, Plücker, watertight …")
    // </solution>
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
    // <solution>
    let to_point = point - ray.origin;
    // Do not normalize the normals: that changes no sign, and it turns a normal of 0 into NaN.
    let side = |from: Vec3, to: Vec3| (from - ray.origin).cross(to - ray.origin).dot(to_point);
    same_side([side(triangle.a, triangle.b), side(triangle.b, triangle.c), side(triangle.c, triangle.a)])
    // <stub> todo!("test on which side of the plane through ray.origin and each side the point lies")
    // </solution>
}

/// Inside test II: seen along the ray, P = `point` is inside if it lies on the same side of all
/// three edges. For the edge from T₁ to T₂ that is the sign of `d·((T₂ - P) × (T₁ - P))`. Which
/// sign is that from behind?
///
/// `point` lies in the plane of the triangle, up to rounding. The corners may have either order.
/// Points on an edge are inside.
pub fn inside_by_direction(ray: &Ray, point: Vec3, triangle: &Triangle) -> bool {
    // <solution>
    let side = |from: Vec3, to: Vec3| (to - point).cross(from - point).dot(ray.direction);
    same_side([side(triangle.a, triangle.b), side(triangle.b, triangle.c), side(triangle.c, triangle.a)])
    // <stub> todo!("test the sign of d · ((T2 - P) × (T1 - P)) for each side")
    // </solution>
}

// <solution>
/// Whether all values are `>= 0` or all values are `<= 0`. Zero fits both.
fn same_side(sides: [f32; 3]) -> bool {
    sides.iter().all(|&side| side >= 0.0) || sides.iter().all(|&side| side <= 0.0)
}
// </solution>

/// Inside test III: P = `point` divides the triangle into three, whose areas give its barycentric
/// coordinates: `α = Area(P b c) / Area(a b c)`, and so on for β (P c a) and γ (P a b). Which areas
/// has a point outside?
///
/// Returns `(α, β, γ)`, or `None` for a point outside or a triangle without area. `point` lies in
/// the plane of the triangle, up to rounding. Points on an edge are inside.
pub fn inside_by_areas(point: Vec3, triangle: &Triangle) -> Option<Vec3> {
    // <solution>
    let normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a);
    // Measure each area along the normal of the triangle, so that it is negative if the point lies
    // beyond the side.
    let area = |from: Vec3, to: Vec3| (from - point).cross(to - point).dot(normal);
    let barycentric =
        Vec3::new(area(triangle.b, triangle.c), area(triangle.c, triangle.a), area(triangle.a, triangle.b))
            / normal.length_squared();
    barycentric.cmpge(Vec3::ZERO).all().then_some(barycentric)
    // <stub> todo!("return the three signed areas, divided by the area of the triangle, if none is negative")
    // </solution>
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
    // <solution>
    // Compute in double precision, in which no product of three `f32` overflows or underflows.
    let [a, b, c, d] = [triangle.a, triangle.b, triangle.c, ray.direction].map(Vec3::as_dvec3);
    (b - a).cross(c - a).dot(d) > 0.0
    // <stub> todo!("return whether n·d > 0 for n = (b - a) × (c - a)")
    // </solution>
}

/// Interpolation with barycentric coordinates `(α, β, γ)`: `α A + β B + γ C` for the values A, B
/// and C at the corners. The result is not normalized.
pub fn interpolate(barycentric: Vec3, corners: [Vec3; 3]) -> Vec3 {
    // <solution>
    barycentric.x * corners[0] + barycentric.y * corners[1] + barycentric.z * corners[2]
    // <stub> todo!("return the sum of the three values, each times its barycentric coordinate")
    // </solution>
}

/// The unit normal of a triangle, `u × v / |u × v|` with `u = b - a` and `v = c - a`. How large is
/// `|u × v|²` if the edges are 1e-12 long?
///
/// The result has length 1 up to rounding for a triangle of any size. It is `None` for a triangle
/// without area.
pub fn face_normal(triangle: &Triangle) -> Option<Vec3> {
    // <solution>
    // Divide each edge by its largest component, so that no product underflows.
    let unit_sized = |edge: Vec3| edge / edge.abs().max_element();
    let normal = unit_sized(triangle.b - triangle.a).cross(unit_sized(triangle.c - triangle.a));
    // Return None for a cross product of zero or NaN.
    normal.try_normalize()
    // <stub> todo!("normalize u × v, and return None for a triangle without area")
    // </solution>
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
    // <solution>
    // Start with a sum of zero for each vertex, and with a normal to fall back on. The lecture
    // counts each triangle once, so the normal depends on how a face is cut into triangles; with
    // the angle at the vertex as weight it would not (Thürmer and Wüthrich 1998).
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    let mut of_one_face = vec![Vec3::Z; mesh.positions.len()];
    // Add the unit normal of each triangle that has an area to its three vertices.
    for corners in &mesh.triangles {
        let [a, b, c] = corners.map(|vertex| mesh.positions[vertex as usize]);
        let Some(normal) = face_normal(&Triangle { a, b, c }) else { continue };
        for &vertex in corners {
            sums[vertex as usize] += normal;
            of_one_face[vertex as usize] = normal;
        }
    }
    // Normalize each sum. A sum below this limit consists of rounding errors: take the normal of
    // one face.
    let cancelled = |sum: Vec3| sum.length_squared() < 1e-10;
    sums.iter()
        .zip(of_one_face)
        .map(|(&sum, face)| if cancelled(sum) { face } else { sum.normalize() })
        .collect()
    // <stub> todo!("add up the face normals at each vertex and normalize")
    // </solution>
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
    // <solution>
    let mut ray = *ray;
    let mut closest = None;
    // Ask each primitive, and end the ray at each hit: from then on only nearer hits count, and an
    // equal t does not.
    for primitive in 0..n_primitives {
        if let Some(t) = probe.hit(primitive, &ray) {
            closest = Some(PrimitiveHit { t, primitive });
            ray.t_max = t;
        }
    }
    closest
    // <stub> todo!("ask every primitive, and keep the hit with the smallest t")
    // </solution>
}
