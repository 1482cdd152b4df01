//! Stage 1 · shapes: where does a ray meet a sphere, or a plane?
//!
//! Slides: "Ray-Sphere Intersection" I and II, "Ray-plane intersection", "Negate Normal Vector".
//!
//! Given: [`Ray`] with `origin`, `direction`, and `ray.contains(t)`, which says whether a hit at `t` counts.
//! Asked: the `t` of the nearest hit that counts, or `None`. `direction` is not always of unit length: `t` counts lengths
//! of `direction`. Start with [`nearest_root`], because both sphere tests end with it.

use glam::Vec3;
use raykata::ray::Ray;

/// The smaller of two roots that counts for `ray`, if one does. The roots come in any order, and either may be NaN.
///
/// A ray that starts inside a sphere has one root behind it, so the smaller root is not always the one to return.
pub fn nearest_root(roots: [f32; 2], ray: &Ray) -> Option<f32> {
    todo!("return the smaller of the two roots for which ray.contains(t) holds")
}

/// Ray against sphere, the algebraic way: put `o + t d` into `|p - c|² = r²` and solve `a t² - 2 b t + c = 0` with
/// `a = d·d`, `b = -(o - c)·d` and `c = |o - c|² - r²`.
///
/// Where the formula lies: `b² - a c` subtracts two huge numbers when the sphere is far or small. At distance 100,000
/// from a unit sphere it loses 24 of 100 true hits.
pub fn sphere_algebraic(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    todo!("solve the quadratic for t and return the nearest root that counts")
}

/// Ray against sphere, the geometric way: go along the ray to the point nearest to the centre (`t_ca`), then back and
/// forth by half a chord (`t_hc`).
///
/// Where the formula lies: the slide gives up when `t_ca < 0`, but a ray that starts inside and looks away from the
/// centre still leaves the sphere; and `d² = L·L - t_ca²` cancels, besides being true for unit directions only.
pub fn sphere_geometric(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    todo!("find t_ca and t_hc, and return the nearest of t_ca - t_hc and t_ca + t_hc that counts")
}

/// The unit normal of a sphere at `point`, which lies on it: away from the centre.
pub fn sphere_normal(center: Vec3, point: Vec3) -> Vec3 {
    todo!("return the unit vector from the centre to the point")
}

/// Ray against an infinite plane through `point`: `n·(o + t d - p₀) = 0`.
///
/// Where the formula lies: a ray along the plane divides by `n·d = 0`. The result is infinite or NaN and must not be
/// taken for a hit. The form `t = -(D + n·o) / n·d` is the same on paper but cancels far from the origin.
pub fn plane(ray: &Ray, point: Vec3, normal: Vec3) -> Option<f32> {
    todo!("solve n·(o + t d - p0) = 0 for t and return it if it counts")
}

/// `normal`, turned so that it points to the side from which a ray of direction `direction` comes.
pub fn face_forward(normal: Vec3, direction: Vec3) -> Vec3 {
    todo!("negate the normal if it points the way the ray goes")
}
