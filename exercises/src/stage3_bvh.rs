//! Stage 3 · bounding volume hierarchies: boxes in boxes, so that most of a scene is never tested.
//!
//! Slides: "Bounding Volume Hierarchy", "Object Median", "Spatial Median", "Surface Area Heuristic", the box
//! intersection with `t_b = t_x ∩ t_y ∩ t_z`, "Sort Bounding Volume Intersections". A stage is one file, however long.
//!
//! Given: [`Bvh`] with `add_node`, `set_leaf` and `set_children`; [`Probe`] with `open` (what a node holds), `enter`
//! (where the ray enters its box) and `hit` (where it hits a primitive). Searches ask the probe and nothing else.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, INTERSECTION_COST, PrimitiveHit, PrimitiveRef, Probe, TRAVERSAL_COST};
use raykata::ray::Ray;
use raykata::scene::Split;
use raykata::shape::{Sphere, Triangle};

/// The smallest box around a triangle. No padding: a flat box is a box.
pub fn triangle_bounds(triangle: &Triangle) -> Aabb {
    todo!("take the smallest and the largest coordinate on each axis")
}

/// A box around a sphere, tight to a rounding.
pub fn sphere_bounds(sphere: &Sphere) -> Aabb {
    todo!("go one radius from the centre on each axis")
}

/// The smallest box around two boxes. [`Aabb::EMPTY`] changes nothing.
pub fn union(first: &Aabb, second: &Aabb) -> Aabb {
    todo!("take the smaller min and the larger max")
}

/// The middle of a box.
pub fn centroid(bounds: &Aabb) -> Vec3 {
    todo!("return the middle of the box")
}

/// The area of all six faces of a box; 0 for the empty box.
pub fn surface_area(bounds: &Aabb) -> f32 {
    todo!("add up the six faces; an empty box has none")
}

/// Where `ray` enters and leaves `bounds`, both within `ray.t_min..=ray.t_max`; `None` if it does neither. A ray that
/// starts inside enters at `t_min`. The box is closed: to touch it is to hit it. `inverse_direction` is `1 / ray.direction`, which
/// the caller computes once for many boxes; it is infinite on an axis along which the ray does not move.
///
/// Where the formula lies: `t_b⁻ ≥ 0` rejects every box that the ray starts in; "corner cases are covered by IEEE"
/// is untrue for `0 · ∞`, which is NaN, and for a direction of -0.0; `<` in place of `≤` loses flat boxes; and rounding
/// loses 6 of 100 rays that are aimed at a corner.
#[inline]
pub fn slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)> {
    todo!("intersect the intervals of the three axes with the range of the ray")
}

/// Object median: sort along the longest axis of the box around all, and give each side half. Reorders `primitives`
/// so that those before the returned index go left. Two primitives or more; neither side may be empty.
pub fn split_object_median(primitives: &mut [PrimitiveRef]) -> usize {
    todo!("order the primitives by centroid along the longest axis and split in half")
}

/// Spatial median: cut the box around all in the middle of its longest axis; a primitive goes where its centroid is.
/// Reorders and returns as [`split_object_median`] does.
///
/// Where the formula lies: when all centroids are on one side, that side is the whole problem again, and the
/// recursion never ends. Fall back on something that divides.
pub fn split_spatial_median(primitives: &mut [PrimitiveRef]) -> usize {
    todo!("cut the box in the middle of its longest axis; mind the case that all go to one side")
}

/// Surface area heuristic: of all ways to cut the primitives, sorted along some axis, in two, the one with the least
/// `A(L) n(L) + A(R) n(R)`. `None` if a leaf is cheaper than the best cut:
/// `TRAVERSAL_COST · A(P) + INTERSECTION_COST · (A(L) n(L) + A(R) n(R)) ≥ INTERSECTION_COST · A(P) n(P)`.
///
/// Where the formula lies: the slide divides by `A(P)`, which is 0 for primitives in a line, and 0/0 is NaN. Multiply
/// the whole comparison by `A(P)` instead. The slide also leaves out the two costs, without which no leaf ever wins.
pub fn split_surface_area(primitives: &mut [PrimitiveRef]) -> Option<usize> {
    todo!("find the cut with the least A(L) n(L) + A(R) n(R) over all three axes")
}

/// Builds a hierarchy over primitives with these boxes, from the top down. No leaf holds more than `leaf_size`.
/// With [`Split::SurfaceArea`] a smaller group is still divided if that is cheaper than a leaf.
///
/// Where the formula lies: the slide stops at `e - s < N_leaf`, so with `N_leaf = 1` it divides single primitives for
/// ever.
pub fn build(bounds: &[Aabb], split: Split, leaf_size: usize) -> Bvh {
    todo!("make a leaf if the primitives are few enough; else split them and build both halves")
}

/// The closest hit, the way of the lecture: enter a box, ask both children, keep the nearer answer. Of two hits at the
/// same `t` the smaller primitive number wins.
pub fn closest_hit_both(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("ask both children of every box that the ray enters, and keep the nearer hit")
}

/// The closest hit, the fast way: of two children enter the nearer one first, and skip a box that begins beyond the
/// best hit so far. Finds the same hit as [`closest_hit_both`] with a fraction of the visits.
pub fn closest_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("enter the nearer child first, and skip boxes beyond the best hit")
}

/// Whether anything is hit within the ray's range: all that a shadow ray wants to know. Stops at the first hit.
pub fn any_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> bool {
    todo!("like closest_hit_both, but stop at the first hit")
}
