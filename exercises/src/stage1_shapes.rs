//! Stage 1 · shapes: the `t` at which a ray hits a sphere or a plane.
//!
//! Slides: `slides/stage01.md`.
//!
//! Given: [`Ray`] with `origin`, `direction` and `ray.contains(t)`. A hit at `t` counts if
//! `ray.contains(t)` is true, which means `t_min < t < t_max`. Both ends are open, and NaN never
//! counts.
//!
//! Asked: the `t` of the nearest hit that counts, or `None`. `t` counts lengths of `direction`,
//! which need not be a unit vector. Start with [`nearest_root`], because both sphere functions end
//! with it.

use glam::Vec3;
use raykata::ray::Ray;

/// A line meets a sphere at two values of `t`, and a ray sees the smaller one in its range. Which
/// one is that if it starts inside? And is 2 smaller than NaN?
///
/// Returns the smaller one of the roots that count, or `None` if neither does.
///
/// Exactly:
///
/// 1. The roots come in any order.
/// 2. A root that is NaN or infinite does not count, but the other root still may.
pub fn nearest_root(roots: [f32; 2], ray: &Ray) -> Option<f32> {
    todo!("return the smaller of the two roots for which ray.contains(t) is true")
}

/// A point `o + t d` of the ray lies on the sphere where `|o + t d - center|² = r²`. That is a
/// quadratic:
///
/// ```text
/// a t² + b t + c = 0
/// a = d·d,  b = 2 (o - center)·d,  c = |o - center|² - r²
/// ```
///
/// A line meets a sphere in two points: which one does the ray see? What is left of `b² - 4 a c`
/// when the sphere is far away?
///
/// Returns the nearest root that counts.
///
/// Exactly:
///
/// 1. A tangent ray (discriminant exactly 0) hits.
/// 2. A root `t = 0`, of a ray that starts on the sphere, does not count.
/// 3. Hits of near, distant and tiny spheres (sizes 1e-6 to 1e6) are right up to a few roundings of
///    the input.
#[inline]
pub fn sphere_algebraic(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    todo!("solve the quadratic for t and return the nearest root that counts")
}

/// `t_ca` leads to the ray's point nearest to the centre. From there, half of the chord, `t_hc`,
/// leads to the surface on both sides:
///
/// ```text
/// o ------ t_ca ------>+-- t_hc -->
///                      | d
///                    center
/// ```
///
/// The roots are `t_ca - t_hc` and `t_ca + t_hc`. Pythagoras gives `t_hc` from r and d. If
/// `t_ca < 0`, is the sphere always missed?
///
/// The contract is that of [`sphere_algebraic`].
pub fn sphere_geometric(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    todo!("find t_ca and t_hc, and return the nearest of t_ca - t_hc and t_ca + t_hc that counts")
}

/// The unit normal of a sphere points from its centre to the point of the surface:
/// `n = (p - c) / |p - c|`.
///
/// `point` lies on the sphere up to rounding. The result has length 1 up to rounding.
pub fn sphere_normal(center: Vec3, point: Vec3) -> Vec3 {
    todo!("return the unit vector from the centre to the point")
}

/// A point p lies in the plane if `n·(p - p₀) = 0`, where p₀ is `point`. Put `o + t d` for p and
/// solve for `t`. What if the ray runs along the plane? How large are `n·o` and `n·p₀` far from the
/// origin?
///
/// Returns `t` if it counts.
///
/// Exactly:
///
/// 1. The plane is infinite and is hit from both sides. `normal` need not be a unit vector.
/// 2. `None` for a ray parallel to the plane (`n·d = 0` exactly) or starting in it, and a normal of 0.
/// 3. `t` keeps its digits far from the origin.
pub fn plane(ray: &Ray, point: Vec3, normal: Vec3) -> Option<f32> {
    todo!("solve n·(o + t d - p0) = 0 for t and return it if ray.contains(t)")
}

/// Put `o + t v`, with the ray's direction v, into the plane `A x + B y + C z + D = 0`: with n =
/// (A, B, C), `t = (-D - n·o) / (n·v)`. How many digits are left where D and `n·o` are large?
///
/// `normal` is n, and `d` is D. Returns `t` if it counts.
///
/// Exactly:
///
/// 1. What [`plane`] demands.
/// 2. All four coefficients times the same factor (1e-12 to 1e12, or negative) give the same `t`.
/// 3. `t` is right up to a few roundings for the plane that the coefficients give, also far from
///    the origin.
///
/// Source: "Ray-plane intersection".
pub fn plane_by_coefficients(ray: &Ray, normal: Vec3, d: f32) -> Option<f32> {
    todo!("solve n·(o + t v) + D = 0 for t and return it if ray.contains(t)")
}

/// A ray with `n·d > 0` goes to the side to which the normal points, so it comes from behind.
///
/// Returns `normal` or `-normal`: the one with `n·d ≤ 0`, either if `n·d` is 0. Neither vector need
/// be a unit vector, and the length of the normal does not change.
pub fn face_forward(normal: Vec3, direction: Vec3) -> Vec3 {
    todo!("negate the normal if n·d > 0")
}
