//! Stage 1 · shapes: the `t` at which a ray hits a sphere or a plane.
//!
//! Slides: "Ray-Sphere Intersection" I and II, "Ray-plane intersection", "Negate Normal Vector".
//!
//! Given: [`Ray`] with `origin`, `direction` and `ray.contains(t)`. A hit at `t` counts if `ray.contains(t)` is true,
//! which means `t_min < t < t_max`. Both ends are open, and NaN never counts.
//! Asked: the `t` of the nearest hit that counts, or `None`. `t` counts lengths of `direction`, which need not be a
//! unit vector. Start with [`nearest_root`], because both sphere functions end with it.

use glam::Vec3;
use raykata::ray::Ray;

/// The smaller one of the roots that count (`ray.contains(t)` is true), or `None` if neither of them counts.
///
/// The roots come in any order. Each of them may be NaN or infinite. A root that is NaN does not count, but the other
/// root still may.
///
/// Pitfall: a ray that starts inside a sphere has one root behind its origin, so the smaller root may not be the hit.
pub fn nearest_root(roots: [f32; 2], ray: &Ray) -> Option<f32> {
    todo!("return the smaller of the two roots for which ray.contains(t) is true")
}

/// Ray-sphere intersection by algebra: put `o + t d` into `|p - center|² = r²` and solve `a t² - 2 b t + c = 0` with
/// `a = d·d`, `b = -(o - center)·d` and `c = |o - center|² - r²`.
///
/// Returns the nearest root that counts, in lengths of `direction`, which need not be a unit vector. A tangent ray
/// (discriminant exactly 0) hits. A ray that starts on the sphere has a root `t = 0`, which does not count. The
/// result is `None` for a radius of 0, a negative radius, a direction of 0, an infinite origin, and a NaN anywhere.
///
/// Pitfall: `b² - a c` subtracts two huge numbers when the sphere is distant or small. At distance 100,000 from a
/// unit sphere it loses 24 of 100 true hits. The checks accept an error of a few roundings, also for near spheres. So
/// use the equal form `a (r² - |f⊥|²)` with `f = o - center` and `f⊥ = f + (b / a) d`, which does not cancel.
///
/// Sizes are between 1e-6 and 1e6 in the checks. Where they are below 1e-9 or above 1e9, products of four lengths do not
/// fit single precision: the reference computes them in double precision.
#[inline]
pub fn sphere_algebraic(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    todo!("solve the quadratic for t and return the nearest root that counts")
}

/// Ray-sphere intersection by geometry: `t_ca` is the `t` of the ray's point nearest to the centre, and `t_hc` is
/// half of the chord. The two roots are `t_ca - t_hc` and `t_ca + t_hc`.
///
/// The contract is that of [`sphere_algebraic`]: the nearest root that counts, in lengths of `direction`. A tangent
/// ray hits. The result is `None` for a radius of 0, a negative radius, a direction of 0, an infinite origin, and a
/// NaN anywhere.
///
/// Pitfall: the slide returns no hit when `t_ca < 0`, but a ray that starts inside and points away from the centre
/// hits the far side. The slide's `d² = L·L - t_ca²` cancels for a distant sphere and needs a unit direction.
pub fn sphere_geometric(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    todo!("find t_ca and t_hc, and return the nearest of t_ca - t_hc and t_ca + t_hc that counts")
}

/// The unit normal of a sphere at `point`: the direction from the centre to `point`.
///
/// `point` lies on the sphere up to rounding. The result has length 1 up to rounding. If `point` is the centre, any
/// unit vector is right.
pub fn sphere_normal(center: Vec3, point: Vec3) -> Vec3 {
    todo!("return the unit vector from the centre to the point")
}

/// Ray-plane intersection: solve `n·(o + t d - p₀) = 0` for `t`. The plane is infinite and contains `point` = `p₀`.
///
/// Returns `t` in lengths of `direction` if it counts. Neither `direction` nor `normal` need be a unit vector. The
/// plane can be hit from both sides. The result is `None` for a ray parallel to the plane (`n·d = 0` exactly), a ray
/// that starts in the plane, a normal of 0, and a NaN anywhere.
///
/// Pitfall: for a ray along the plane the division by `n·d = 0` gives infinity or NaN, which is not a hit. The form
/// `t = -(D + n·o) / n·d` is equal on paper but cancels far from the origin.
pub fn plane(ray: &Ray, point: Vec3, normal: Vec3) -> Option<f32> {
    todo!("solve n·(o + t d - p0) = 0 for t and return it if ray.contains(t)")
}

/// Ray-plane intersection with the plane as an equation: put `o + t v` into `A x + B y + C z + D = 0` and solve for `t`.
/// With `normal` = n = (A, B, C), `d` = D and the direction v of the ray, `t = (-D - n·o) / (n·v)`.
///
/// Returns `t` in lengths of `direction` if it counts. Neither `direction` nor `normal` need be a unit vector: all four
/// coefficients times the same factor, positive or negative, give the same plane and so the same `t`. The plane can be
/// hit from both sides, and [`face_forward`] turns its normal to the ray. The result is `None` for a ray parallel to the
/// plane (`n·v = 0` exactly), a ray that starts in the plane, a normal of 0, and a NaN anywhere.
///
/// Pitfall: far from the origin D and n·o are large and cancel. `t` must keep its digits there, up to a few roundings,
/// for the plane that the coefficients give: add D and n·o in double precision, in which the product of two `f32` is
/// exact. Factors are between 1e-12 and 1e12 in the checks.
///
/// Slide: "Ray-plane intersection".
pub fn plane_by_coefficients(ray: &Ray, normal: Vec3, d: f32) -> Option<f32> {
    todo!("solve n·(o + t v) + D = 0 for t and return it if ray.contains(t)")
}

/// `normal` or `-normal`: the one that points to the side from which a ray along `direction` comes, so that
/// `n·d ≤ 0`.
///
/// Neither vector need be a unit vector. The length of the normal does not change. If `n·d` is 0, either is right.
pub fn face_forward(normal: Vec3, direction: Vec3) -> Vec3 {
    todo!("negate the normal if n·d > 0")
}
