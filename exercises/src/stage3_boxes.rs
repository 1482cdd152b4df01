//! Stage 3 · bounding boxes: the box around a shape, and where a ray enters and leaves it.
//!
//! Slides: "Bounding Volume Hierarchy" and the box intersection with `t_b = t_x ∩ t_y ∩ t_z`.
//!
//! Given: [`gamma`], the bound γₙ on the relative error of `n` roundings.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::ray::Ray;
use raykata::rounding::gamma;
use raykata::shape::{Sphere, Triangle};

/// The smallest box around a triangle.
///
/// Each side is exactly a coordinate of a corner. Boxes are closed, so a flat box needs no padding.
pub fn triangle_bounds(triangle: &Triangle) -> Aabb {
    todo!("take the smallest and the largest coordinate on each axis")
}

/// The box around a sphere: from `center - radius` to `center + radius` on each axis.
///
/// Each side may be off by the rounding of the sum or difference, and may lie up to two more floats outwards.
pub fn sphere_bounds(sphere: &Sphere) -> Aabb {
    todo!("go one radius from the centre on each axis")
}

/// The smallest box around two boxes.
///
/// The union of a box and [`Aabb::EMPTY`] is the box. A coordinate that is NaN is ignored: the result has the
/// coordinate of the other box, so that a primitive with NaN does not change the boxes of other primitives.
///
/// Pitfall: `Vec3::min` and `Vec3::max` keep or drop a NaN depending on the order of the operands. `f32::min` and
/// `f32::max` always drop it.
pub fn union(first: &Aabb, second: &Aabb) -> Aabb {
    todo!("take the smaller min and the larger max")
}

/// The middle of a box, which is the average of its corners.
pub fn centroid(bounds: &Aabb) -> Vec3 {
    todo!("return the middle of the box")
}

/// The surface area of a box: the sum of its six faces, in square world units. It is 0 for the empty box.
pub fn surface_area(bounds: &Aabb) -> f32 {
    todo!("add up the six faces; return 0 for an empty box")
}

/// Ray-box intersection by slabs: the `t` at which `ray` enters `bounds` and the `t` at which it leaves. The ray is
/// inside the box while it is between the two planes of each of the three axes (`t_b = t_x ∩ t_y ∩ t_z`).
///
/// Both results lie in `ray.t_min..=ray.t_max`, whose ends count here. A ray that starts inside enters at `t_min`.
/// The result is `None` if the ray misses the box within that range, and always for [`Aabb::EMPTY`]. The box is
/// closed: a ray that touches a face, an edge or a corner hits it, also a ray that runs within a face, and a box
/// without thickness can be hit. A ray that is aimed exactly at a corner must not miss by rounding, so the result may
/// be wider than the exact interval by a few roundings. That holds for `ray.t_min >= 0`.
///
/// `inverse_direction` is `1 / ray.direction`, which the caller computes once for many boxes. It is infinite on an axis
/// along which the ray does not move, with the sign of the zero. It is also infinite where a component of the direction
/// is so small that `1/d` overflows (below 2.9e-39).
///
/// Pitfall: `t_b⁻ ≥ 0` rejects every box that the ray starts in. "Corner cases are covered by IEEE" is wrong for
/// `0 · ∞`, which is NaN, and for a direction of -0.0. `<` instead of `≤` loses flat boxes. Rounding loses 6 of 100
/// rays that are aimed at a corner.
#[inline]
pub fn slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)> {
    todo!("intersect the intervals of the three axes with the range of the ray")
}
