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
    // <solution>
    Aabb::new(triangle.a.min(triangle.b).min(triangle.c), triangle.a.max(triangle.b).max(triangle.c))
    // <stub> todo!("take the smallest and the largest coordinate on each axis")
    // </solution>
}

/// The box around a sphere, from `center - radius` to `center + radius` on each axis.
///
/// Each side may be off by the rounding of this sum or difference, and may lie up to two more
/// floats outwards.
pub fn sphere_bounds(sphere: &Sphere) -> Aabb {
    // <solution>
    let (low, high) = (sphere.center - sphere.radius, sphere.center + sphere.radius);
    // Move each side one float outwards, because rounding to nearest may cut off a part of the
    // sphere.
    Aabb::new(low.map(f32::next_down), high.map(f32::next_up))
    // <stub> todo!("go one radius from the centre on each axis")
    // </solution>
}

/// The smallest box around two boxes: the smaller minima and the larger maxima. Which box changes
/// no other one?
///
/// The union of a box and [`Aabb::EMPTY`] is the box.
pub fn union(first: &Aabb, second: &Aabb) -> Aabb {
    // <solution>
    Aabb::new(first.min.min(second.min), first.max.max(second.max))
    // <stub> todo!("take the smaller min and the larger max")
    // </solution>
}

/// The middle of a box, which is the average of its corners.
pub fn centroid(bounds: &Aabb) -> Vec3 {
    // <solution>
    // Halve first, because the sum of two huge corners would overflow.
    0.5 * bounds.min + 0.5 * bounds.max
    // <stub> todo!("return the middle of the box")
    // </solution>
}

/// The surface area of a box: the sum of its six faces, in square world units. It is 0 for the
/// empty box.
pub fn surface_area(bounds: &Aabb) -> f32 {
    // <solution>
    if bounds.is_empty() {
        return 0.0;
    }
    let size = bounds.max - bounds.min;
    2.0 * (size.x * size.y + size.y * size.z + size.z * size.x)
    // <stub> todo!("add up the six faces; return 0 for an empty box")
    // </solution>
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
    // <solution>
    let (mut near, mut far) = (f32::NEG_INFINITY, f32::INFINITY);
    for axis in 0..3 {
        // Choose the plane that the ray passes first, by the sign bit and not by `< 0`: 1 / -0.0 is
        // -∞, and the planes must be swapped for it as well.
        let (first, last) = if inverse_direction[axis].is_sign_negative() {
            (bounds.max[axis], bounds.min[axis])
        } else {
            (bounds.min[axis], bounds.max[axis])
        };
        // Compute the t of both planes. Subtract first, because b/d - o/d would be ∞ - ∞ for d = 0.
        // Where 1/d overflows, divide instead: the quotient may be finite.
        let inverse = inverse_direction[axis];
        let t_at = |plane: f32| {
            let distance = plane - ray.origin[axis];
            if inverse.is_finite() { distance * inverse } else { distance / ray.direction[axis] }
        };
        let (enter, leave) = (t_at(first), t_at(last));
        // Intersect the intervals. A NaN means that the ray runs within the plane of a face, which
        // is inside: in this order the comparison is false for NaN and changes nothing.
        if enter > near {
            near = enter;
        }
        if leave < far {
            far = leave;
        }
    }
    // Move the exit later by its rounding errors, and intersect the interval with the ray's range.
    let (near, far) = (near.max(ray.t_min), (far * MORE).min(ray.t_max));
    (near <= far).then_some((near, far))
    // <stub> todo!("intersect the intervals of the three axes with the range of the ray")
    // </solution>
}

// <solution>
/// The factor by which `slab` moves the exit, which has three roundings: 1/d, the difference and
/// the product. If it is later by twice γ₃, rounding loses no box in front of the ray (Ize, "Robust
/// BVH Ray Traversal", JCGT 2013). Measured: without it 6 of 100 rays that are aimed at corners
/// miss. `conservative_slab` of stage 10 moves the entry as well.
const MORE: f32 = 1.0 + 2.0 * gamma(3);
// </solution>

// <solution>
/// The axis along which a box is longest; of equal ones the first.
pub fn longest_axis(bounds: &Aabb) -> usize {
    let size = bounds.max - bounds.min;
    if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    }
}
// </solution>
