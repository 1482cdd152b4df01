//! Stage 10 · stability: the same questions as before, asked so that roundings decide; and answers that survive it.
//!
//! Slides: "Ray-Sphere Intersection", "Inside Test", "Numerical precision", "Bounding Volumes"; Woop, Benthin and Wald
//! 2013; Ize 2013; Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th edition, section 6.8.
//!
//! What you wrote in earlier stages may do already. `cargo run --release -- gauntlet --kit exercises` shows what it
//! costs and where it fails.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::kit::TriangleHit;
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// The real roots of `a t² + b t + c = 0`, the smaller one first; a double root is there twice. `None` if there is none,
/// if `a` is 0, or if some number is not finite.
///
/// Where the formula lies: `-b + √(b² - 4ac)` cancels if b is large: one root of `t² - 10000 t + 1` comes out as 0. Add
/// numbers of the same sign, `q = -(b + sign(b) √(b² - 4ac)) / 2`: one root is `q / a`, the other `c / q`.
pub fn stable_roots(a: f32, b: f32, c: f32) -> Option<[f32; 2]> {
    todo!("never subtract what is nearly the same: q first, then q / a and c / q")
}

/// Ray against triangle such that no ray slips through between two triangles that share an edge or a corner, at any size
/// and any place; with the `t`, β and γ of the hit.
///
/// Where the formula lies: each triangle rounds for itself, and a ray at a shared edge is beside both. Decide on which
/// side of an edge the ray passes by one computation on its two ends, which the neighbour repeats.
pub fn watertight(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    todo!("see the triangle from the ray, and decide each edge by its two ends alone")
}

/// Where `ray` enters and leaves `bounds`, as in stage 3, but never `None` for a box that the ray meets: not at its
/// corners, not if it is flat, not far away, not along its faces, not for -0.0.
///
/// Where the formula lies: widening boxes by 1e-5 does nothing at 1000 and more. Make the way out longer by the error of
/// its own three roundings instead, `1 + 2 γ₃`, and the way in earlier by as much: a search compares it with the `t` of
/// hits, which are rounded in another way.
pub fn conservative_slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)> {
    todo!("compare so that NaN changes nothing, and let the way out be a little longer")
}

/// Where a ray along `direction` starts from a surface whose true place is within `error` of `point` along each axis:
/// off the surface, on the side to which it goes, and no farther than it must.
///
/// Where the formula lies: any fixed distance is too small somewhere and too large elsewhere: at a size of 0.001 a ray
/// that starts 0.0001 away misses what touches the surface.
pub fn offset_origin(point: Vec3, error: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    todo!("move the point along the normal by its error, and then by a step of the last digit")
}

/// `v / |v|` for every v that has a direction, however short or long; `None` for 0 and for what is not finite.
///
/// Where the formula lies: the squares of 1e-30 are 0 and those of 1e30 are infinite.
pub fn safe_normalize(v: Vec3) -> Option<Vec3> {
    todo!("scale by the largest coordinate first")
}

/// Ray against triangle by Cramer's rule as in stage 2, `β (a - b) + γ (a - c) + t d = a - o`, with every number in `f64`
/// and only the three results rounded. The range of the ray is asked about the rounded `t`. Scenes with
/// `precision = "double"` are rendered with this.
///
/// Where the formula lies: what was rounded before it was converted stays rounded, so `(a - b).as_dvec3()` buys nothing.
/// And in no precision has an epsilon on the determinant a meaning: it grows with the cube of the size.
pub fn triangle_in_double(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    todo!("convert all five vectors first, then Cramer's rule; round t, β and γ last")
}

/// Ray against sphere in the same way: the `t` of the nearest hit that counts, rounded once. A sphere without a radius
/// above 0 is never hit, and NaN is no hit.
///
/// Where the formula lies: `(o - c).as_dvec3()` is off by up to 3 thousandths of a radius for a sphere 100,000 radii
/// away, and all that follows is right for another sphere.
pub fn sphere_in_double(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    todo!("convert origin, direction, centre and radius first, then any way of stage 1")
}
