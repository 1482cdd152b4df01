//! Stage 3 · bounding boxes: the box around a shape, and where a ray enters and leaves it.
//!
//! Slides: `slides/stage03.md`.
//!
//! Given: [`gamma`], the bound γₙ on the relative error of `n` roundings.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::ray::Ray;
use raykata::rounding::gamma;
use raykata::shape::{Sphere, Triangle};

/// The smallest box around a triangle: each side is exactly a coordinate of a corner. Boxes are
/// closed, so a flat box needs no padding.
pub fn triangle_bounds(triangle: &Triangle) -> Aabb {
    todo!("take the smallest and the largest coordinate on each axis")
}

/// The box around a sphere, from `center - radius` to `center + radius` on each axis.
///
/// Each side may be off by the rounding of this sum or difference, and may lie up to two more
/// floats outwards.
pub fn sphere_bounds(sphere: &Sphere) -> Aabb {
    todo!("go one radius from the centre on each axis")
}

/// The smallest box around two boxes: the smaller minima and the larger maxima. Which box changes
/// no other one?
///
/// The union of a box and [`Aabb::EMPTY`] is the box.
pub fn union(first: &Aabb, second: &Aabb) -> Aabb {
    todo!("take the smaller min and the larger max")
}

/// The middle of a box, which is the average of its corners.
pub fn centroid(bounds: &Aabb) -> Vec3 {
    todo!("return the middle of the box")
}

/// The surface area of a box: the sum of its six faces, in square world units. It is 0 for the
/// empty box.
pub fn surface_area(bounds: &Aabb) -> f32 {
    todo!("add up the six faces; return 0 for an empty box")
}

/// A ray is inside a box while it is between the two planes of each axis, from `(b⁻ - o) / d` to
/// `(b⁺ - o) / d`: `t_b = t_x ∩ t_y ∩ t_z`. What if it starts inside? What if d is 0 or -0.0?
///
/// Returns the `t` of entry and exit. `inverse_direction` is `1 / ray.direction`, infinite where d
/// is 0 (with the sign of the zero) and where `1/d` overflows (below 2.9e-39).
///
/// Exactly:
///
/// 1. Both lie in `ray.t_min..=ray.t_max`, whose ends count here. A ray that starts inside enters
///    at `t_min`.
/// 2. The box is closed: a ray that touches a face, an edge or a corner, or runs within a face,
///    hits it. A box may have no thickness.
/// 3. For `ray.t_min >= 0`, a ray aimed exactly at a corner does not miss by rounding. The interval
///    may be a few roundings too wide.
/// 4. `None` if the ray misses the box within its range, or for [`Aabb::EMPTY`].
#[inline]
pub fn slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)> {
    todo!("intersect the intervals of the three axes with the range of the ray")
}
