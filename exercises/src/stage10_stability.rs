//! Stage 10 · stability: intersection tests of earlier stages, for inputs where rounding errors
//! decide the answer.
//!
//! Slides: `slides/stage10.md`. Sources: Woop, Benthin and Wald 2013; Ize 2013; Pharr, Jakob and
//! Humphreys, "Physically Based Rendering", 4th edition, section 6.8.
//!
//! Your functions of earlier stages may already be good enough.
//! `cargo run --release -- gauntlet --kit exercises` shows what they cost and where they fail.
//!
//! A hit with a triangle or a sphere counts if `ray.contains(t)`, that is `t_min < t < t_max`: both
//! ends are open.
//!
//! Your pictures use [`watertight`], [`conservative_slab`], [`offset_origin`] and
//! [`safe_normalize`] as soon as they are written; before, triangles use `triangle_choice` of stage
//! 2, boxes `slab` of stage 3, and shadow rays and secondary rays start where `shadow_ray` of stage
//! 4 and `spawn_ray` of stage 5 put them. Scenes with `sphere_method = "stable_roots"` or
//! `precision = "double"` use [`stable_roots`] or the last two functions.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::kit::TriangleHit;
use raykata::ray::Ray;
use raykata::rounding::exact_sum;
use raykata::shape::Triangle;

/// The real roots of `a t² + b t + c = 0`, whose product is `c / a`. The usual formula gives 0 for
/// one root of `t² - 10000 t + 1`: why?
///
/// Exactly:
///
/// 1. The smaller root comes first, for every sign of `a` and `b`.
/// 2. A double root is returned twice; for `b = c = 0` both roots are 0.
/// 3. `None` if there is no real root, if `a` is 0, or if a coefficient is NaN or infinite.
///
/// Source: "Ray-Sphere Intersection".
pub fn stable_roots(a: f32, b: f32, c: f32) -> Option<[f32; 2]> {
    todo!("avoid the difference of two nearly equal numbers: q first, then q / a and c / q")
}

/// Intersects a ray with a triangle so that no ray escapes from a closed mesh. If the ray is the z
/// axis, the sign of `e(p, q) = p_x q_y - p_y q_x` tells on which side of the edge `pq` it passes,
/// and the neighbour gets the same number with the opposite sign. What if rounding errors decide
/// the sign? [`exact_sum`] makes none.
///
/// Exactly:
///
/// 1. No ray escapes at a shared edge or corner, at any size and place.
/// 2. None escapes through a triangle seen edge-on.
/// 3. Points on edges belong to the triangle, but a ray in its plane may miss it.
/// 4. Scaling by a power of two changes no answer, unless a number over- or underflows.
/// 5. `t` is accurate also on triangles a million times as long as wide. β and γ are right to
///    1e-3 well inside.
/// 6. NaN or infinity gives `None` or a finite hit.
///
/// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013; Shewchuk,
/// "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997.
#[inline]
pub fn watertight(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    todo!("transform the triangle to the ray's coordinates, and decide each edge by its two ends only")
}

/// The slab test of stage 3, with the same results, but it misses no box. Each `t` of a plane has
/// three rounding errors, together at most `γ₃ |t|`. At a corner entry and exit are equal: which is
/// larger after rounding? And which way is "later" at a negative `t`?
///
/// Coordinates and directions are below 1e37 in size, and a `t` that is not 0 is above 1e-30.
///
/// Exactly:
///
/// 1. No box that the ray meets gives `None`: at corners, along faces, flat boxes, far away.
/// 2. The same in every range, also at negative `t`.
/// 3. The same in every direction, also -0.0, and where `1/d` overflows.
/// 4. A box with a hit at `t` is entered at `t` or before.
/// 5. The entry is right up to 64 roundings, where the ray clearly meets the box.
/// 6. A box passed by at more than 64 roundings gives `None`.
///
/// Source: Ize, "Robust BVH Ray Traversal", JCGT 2013.
pub fn conservative_slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)> {
    todo!("compare so that NaN changes nothing; then widen the interval at both ends, on both sides of 0")
}

/// The origin of a ray that leaves a surface and must not hit it again (shadow acne).
///
/// ```text
///    • origin
/// ┌──┼──┐
/// │  •  │ point ± error
/// └─────┘
/// ```
///
/// The true surface lies within `error` of `point` along each axis, so along the unit `normal` n at
/// most `h = e_x |n_x| + e_y |n_y| + e_z |n_z|` away. Which fixed distance suits scenes of size
/// 0.001 and of size 1000?
///
/// Exactly:
///
/// 1. The origin is at least h above `point`, also after rounding.
/// 2. It is on the side to which `direction` goes, or on that of `normal` if both are
///    perpendicular.
/// 3. Its height is at most 4 h plus 64 rounding steps of the largest coordinate.
///
/// Source: Pharr, Jakob and Humphreys, section 6.8.
pub fn offset_origin(point: Vec3, error: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    todo!("move the point along the normal by its error, then each coordinate by one float outwards")
}

/// The unit vector in the direction of `v`: `v / |v|`. What is the square of 1e-30 in single
/// precision, and of 1e30?
///
/// The result has length 1 up to rounding for every finite `v` except 0, however short or long. It
/// is `None` for the zero vector (also with -0.0) and for a vector with a coordinate that is NaN or
/// infinite.
///
/// Source: "Numerical precision".
pub fn safe_normalize(v: Vec3) -> Option<Vec3> {
    todo!("scale by the largest coordinate first")
}

/// Intersects a ray with a triangle in double precision: solves
/// `o + t d = a + β (b - a) + γ (c - a)`, by Cramer's rule or any other method. How many right
/// digits has `(a - b).as_dvec3()`? Which epsilon suits determinants of every size?
///
/// Exactly:
///
/// 1. Every number is an `f64`, and only the results are rounded: `t` is at most one unit in the
///    last place off; β and γ, well inside, two roundings.
/// 2. Points on edges belong to the triangle, if no product of three numbers is rounded.
/// 3. The range of the ray contains the rounded `t`.
/// 4. `None` for a determinant of 0. Every hit is finite.
///
/// Source: "Cramer's Rule".
pub fn triangle_in_double(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    todo!("convert all five vectors first, then solve for t, β and γ; round them last")
}

/// Intersects a ray with a sphere in double precision, by any method. What is the error of
/// `(o - c).as_dvec3()` for a sphere 100,000 radii away?
///
/// Returns the `t` of the nearest hit within the range of the ray, rounded to `f32` last.
///
/// Exactly:
///
/// 1. A ray that starts inside hits the far side; one that touches the sphere hits it.
/// 2. `t` is at most one unit in the last place off, if the ray starts a millionth of the radius
///    or more away from the sphere.
///
/// Source: "Ray-Sphere Intersection".
pub fn sphere_in_double(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    todo!("convert origin, direction, centre and radius first, then use any method of stage 1")
}
