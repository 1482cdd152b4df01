//! Stage 10 · stability: intersection tests of earlier stages, for inputs where rounding errors decide the answer.
//!
//! Slides: "Ray-Sphere Intersection", "Inside Test", "Numerical precision", "Bounding Volumes"; Woop, Benthin and Wald
//! 2013; Ize 2013; Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th edition, section 6.8.
//!
//! Your functions of earlier stages may already be good enough. `cargo run --release -- gauntlet --kit exercises` shows
//! what they cost and where they fail.
//!
//! A hit with a triangle or a sphere counts if `ray.contains(t)`, that is `t_min < t < t_max`: both ends are open.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::kit::TriangleHit;
use raykata::ray::Ray;
use raykata::rounding::exact_sum;
use raykata::shape::Triangle;

/// Computes the real roots of `a t² + b t + c = 0` without cancellation.
///
/// Returns the smaller root first, for every sign of `a` and `b`. A double root is returned twice, and for `b = c = 0`
/// both roots are 0. Returns `None` if there is no real root, if `a` is 0, or if a coefficient is NaN or infinite. No
/// root is NaN; a root too large for `f32` is infinite.
///
/// Pitfall: `-b + √(b² - 4ac)` cancels if b is large: one root of `t² - 10000 t + 1` becomes 0. Add numbers of the same
/// sign instead, `q = -(b + sign(b) √(b² - 4ac)) / 2`: one root is `q / a`, the other `c / q`.
///
/// Scenes with `sphere_method = "stable_roots"` are rendered with this function.
///
/// Slide: "Ray-Sphere Intersection".
pub fn stable_roots(a: f32, b: f32, c: f32) -> Option<[f32; 2]> {
    todo!("avoid the difference of two nearly equal numbers: q first, then q / a and c / q")
}

/// Intersects a ray with a triangle such that no ray escapes from a closed mesh: neither between two triangles that share
/// an edge or a corner, nor through a triangle that is seen edge-on, at any size and at any place.
///
/// Returns `t` and the barycentric coordinates β and γ of the hit. Points on edges belong to the triangle. A ray that lies
/// in the plane of the triangle misses it. Scaling ray and triangle by a power of two changes no answer, unless a number
/// over- or underflows. `t` is accurate also on triangles a million times as long as wide. NaN or infinite inputs give
/// `None` or a finite hit.
///
/// Pitfall: each triangle has its own rounding errors, so a ray at a shared edge may miss both. Decide on which side of
/// an edge the ray passes by a computation that uses only the two ends of the edge: the neighbour repeats it exactly.
///
/// Pitfall: where the triangle is seen edge-on, or the ray starts next to it, rounding errors may give `t` the wrong sign.
/// Where rounding errors may decide, compute the determinants with [`exact_sum`], which loses no digit.
///
/// Your pictures use this function for triangles as soon as it is written; before, they use `triangle_choice` of stage 2.
///
/// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013; Shewchuk, "Adaptive Precision
/// Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997.
#[inline]
pub fn watertight(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    todo!("transform the triangle to the ray's coordinates, and decide each edge by its two ends only")
}

/// Computes the `t` at which `ray` enters and leaves `bounds`, as in stage 3, but never returns `None` for a box that
/// the ray meets.
///
/// This holds for every range, also for negative `t`, and for every direction: at corners, for flat boxes, far away,
/// along faces, for a direction of -0.0, and where `inverse_direction` is infinite because `1/d` overflows. A box with a
/// hit at `t` is entered at `t` or before. A box that the ray passes by at more than 64 roundings gives `None`, and so
/// does the empty box. Neither result is ever NaN. Coordinates and directions are below 1e37 in size, and a `t` that is
/// not 0 is above 1e-30.
///
/// Pitfall: widening boxes by 1e-5 has no effect at coordinates of 1000 and more. Move the exit later by `2 γ₃ |t|`,
/// the bound on its own three rounding errors, and the entry earlier by as much, because a search compares the entry
/// with the `t` of hits, which are rounded differently. A factor of `1 + 2 γ₃` moves a negative exit the wrong way.
///
/// Your pictures use this function for boxes as soon as it is written; before, they use `slab` of stage 3.
///
/// Source: Ize, "Robust BVH Ray Traversal", JCGT 2013.
pub fn conservative_slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)> {
    todo!("compare so that NaN changes nothing; then widen the interval at both ends, on both sides of 0")
}

/// Computes the origin of a ray along `direction` that leaves a surface, such that the ray does not hit the same
/// surface again (shadow acne).
///
/// The true surface lies within `error` of `point` along each axis. Move the point along the unit `normal` by
/// `error · |normal|`, to the side to which `direction` goes, and then each coordinate by one float outwards, because
/// the sum is rounded as well. If `direction` is perpendicular to the normal, take the side of the normal. The height
/// above `point` may be at most 4 times this bound plus 64 rounding steps of the largest coordinate.
///
/// Pitfall: any fixed distance is too small in one scene and too large in another. In a scene of size 0.001, a ray that
/// starts 0.0001 away misses objects that touch the surface.
///
/// In your pictures shadow rays and secondary rays start here as soon as this function is written; before, they start where
/// `shadow_ray` of stage 4 and `spawn_ray` of stage 5 put them.
///
/// Source: Pharr, Jakob and Humphreys, section 6.8.
pub fn offset_origin(point: Vec3, error: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    todo!("move the point along the normal by its error, then each coordinate by one float outwards")
}

/// Normalizes a vector: `v / |v|`, with length 1 up to rounding, for every finite `v` except 0, however short or long.
///
/// Returns `None` for the zero vector (also with -0.0) and for a vector with a coordinate that is NaN or infinite.
///
/// Pitfall: in single precision the square of 1e-30 is 0 and the square of 1e30 is infinite.
///
/// Your pictures normalize the directions of rays with this function as soon as it is written.
///
/// Slide: "Numerical precision".
pub fn safe_normalize(v: Vec3) -> Option<Vec3> {
    todo!("scale by the largest coordinate first")
}

/// Intersects a ray with a triangle in double precision: solves `o + t d = a + β (b - a) + γ (c - a)`.
///
/// Every number is an `f64`, and only the three results are rounded to `f32`. Any method is accepted. Points on edges
/// belong to the triangle: `β >= 0`, `γ >= 0` and `β + γ <= 1`. (That is certain only if no product of three numbers is
/// rounded, as for small integers: double precision leaks less than single precision, but it leaks.) A hit counts if the range of the ray contains the
/// rounded `t`. An input with NaN gives `None`, and so does a determinant of 0. Every hit is finite. Scenes with
/// `precision = "double"` are rendered with this function.
///
/// Pitfall: a number that was rounded before its conversion stays rounded, so `(a - b).as_dvec3()` gains nothing. Do
/// not compare the determinant with an epsilon, in any precision, because it grows with the cube of the size.
///
/// Slide: "Cramer's Rule". The reference is the method of Möller and Trumbore, as `triangle_choice` of stage 2.
pub fn triangle_in_double(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    todo!("convert all five vectors first, then solve for t, β and γ; round them last")
}

/// Intersects a ray with a sphere in double precision: the `t` of the nearest hit within the range of the ray, computed
/// in double precision and then rounded to `f32`.
///
/// A ray that starts inside hits the far side. A ray that touches the sphere hits it. `t` is within 0.51 units in the last
/// place of the exact one, if the ray starts at least a millionth of the radius away from the sphere: nearer to it, the
/// root near 0 loses digits. A sphere whose radius is 0, negative or NaN is never hit. An input with NaN gives `None`, and every `t` is finite.
///
/// Pitfall: `(o - c).as_dvec3()` has an error of up to 3 thousandths of a radius for a sphere 100,000 radii away. The
/// rest of the computation is then exact for a sphere at a wrong place.
///
/// Slide: "Ray-Sphere Intersection".
pub fn sphere_in_double(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    todo!("convert origin, direction, centre and radius first, then use any method of stage 1")
}
