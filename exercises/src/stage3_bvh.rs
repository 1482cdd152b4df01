//! Stage 3 · bounding volume hierarchies: a tree of boxes, with which a ray tests only a small part of a scene.
//!
//! Slides: "Bounding Volume Hierarchy", "Object Median", "Spatial Median", "Surface Area Heuristic", the box
//! intersection with `t_b = t_x ∩ t_y ∩ t_z`, "Sort Bounding Volume Intersections".
//!
//! Given: [`Bvh`] with `add_node`, `set_leaf` and `set_children`; [`Probe`] with `open` (the contents of a node),
//! `enter` (the `t` at which the ray enters its box) and `hit` (the `t` at which the ray hits a primitive). The
//! searches take all boxes and hits from the probe, which also counts the calls.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, INTERSECTION_COST, PrimitiveHit, PrimitiveRef, Probe, TRAVERSAL_COST};
use raykata::ray::Ray;
use raykata::scene::Split;
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

/// Object median split: order the primitives by centroid along the longest axis of the box around all of them, and
/// put half of them on each side.
///
/// `primitives` has at least two elements. The function reorders them and returns an index: the primitives before it
/// go to the left side, the others to the right side. The sides hold n / 2 primitives each; if n is odd, either side
/// may hold one more. Neither side may be empty. Equal centroids may go to either side. A centroid may be NaN, so
/// sort with `total_cmp`.
pub fn split_object_median(primitives: &mut [PrimitiveRef]) -> usize {
    todo!("order the primitives by centroid along the longest axis and split in half")
}

/// Spatial median split: cut the box around all primitives in the middle of its longest axis. Each primitive goes to
/// the side on which its centroid lies.
///
/// Input and result are as for [`split_object_median`]: neither side may be empty. A centroid exactly on the cut may
/// go to either side.
///
/// Pitfall: if all centroids are on one side, that side is the whole problem again, and the recursion never ends. Use
/// another split then, for example the object median.
pub fn split_spatial_median(primitives: &mut [PrimitiveRef]) -> usize {
    todo!("cut the box in the middle of its longest axis; handle the case that all go to one side")
}

/// Surface area heuristic: sort the primitives by centroid along each of the three axes, try all n - 1 cuts of each
/// order, and take the cut with the smallest `A(L) n(L) + A(R) n(R)`. `A` is the surface area of the box around a
/// side, `n` the number of its primitives, and P the parent with all primitives.
///
/// Input and index are as for [`split_object_median`]. The function returns `None` for a leaf, if no cut is cheaper:
/// `TRAVERSAL_COST · A(P) + INTERSECTION_COST · (A(L) n(L) + A(R) n(R)) ≥ INTERSECTION_COST · A(P) n(P)`. Of cuts
/// with equal cost any one is right. For boxes without area all costs are 0, and both a leaf and any cut are right.
///
/// Pitfall: the slide divides by `A(P)`, which is 0 for primitives in a line, and 0/0 is NaN. Multiply the whole
/// comparison by `A(P)` instead. The slide also leaves out the two costs, without which no leaf is ever cheaper.
pub fn split_surface_area(primitives: &mut [PrimitiveRef]) -> Option<usize> {
    todo!("find the cut with the least A(L) n(L) + A(R) n(R) over all three axes")
}

/// Builds a hierarchy over the primitives with these boxes, from the top down: a node gets the box around its
/// primitives, and it becomes a leaf or its primitives are split in two.
///
/// Primitive `i` has the box `bounds[i]`. Each primitive is in exactly one leaf, and each box contains everything
/// below it. Each leaf holds at least 1 and at most `leaf_size` primitives. With both medians `leaf_size` primitives
/// or fewer become a leaf. With [`Split::SurfaceArea`] such a group is still split if that is cheaper than a leaf,
/// and a larger group for which no cut is cheaper is split by the object median. Without primitives the hierarchy has
/// no node. The build ends for any boxes, also if all centroids are equal. A box of NaN goes into some leaf and does
/// not change the boxes of other primitives.
///
/// Pitfall: the slide stops at `e - s < N_leaf`. With `N_leaf = 1` it splits a single primitive forever.
pub fn build(bounds: &[Aabb], split: Split, leaf_size: usize) -> Bvh {
    todo!("make a leaf if the primitives are few enough; otherwise split them and build both halves")
}

/// The closest hit by the simple search of the lecture: if the ray enters the box of a node, search both children and
/// keep the nearer hit.
///
/// The result is the hit with the smallest `t` in the ray's range, or `None`. Of two hits at the same `t` the smaller
/// primitive number wins. A node is opened only if the ray enters its box (`probe.enter` returns `Some`).
pub fn closest_hit_both(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("ask both children of every box that the ray enters, and keep the nearer hit")
}

/// The closest hit by the fast search: of two children search the nearer one first, and skip every box that begins
/// beyond the best hit so far.
///
/// The result is the same hit as that of [`closest_hit_both`], also for two hits at the same `t`. The search opens
/// far fewer nodes: it lowers `t_max` at each hit, and compares the farther child's entry with `t_max` again after it
/// has searched the nearer child. If the ray enters both children at the same `t`, either may be searched first.
///
/// Pitfall: boxes overlap, so a hit in the nearer child may lie behind a hit in the farther child. And if `t_max`
/// becomes exactly `t`, another hit at the same `t` is not reported, because the range is open.
pub fn closest_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("enter the nearer child first, and skip boxes beyond the best hit")
}

/// Whether any primitive is hit within the ray's range. A shadow ray needs no more than that.
///
/// The search stops at the first hit: after it, no further primitive is tested. A node is opened only if the ray
/// enters its box.
///
/// Pitfall: to enter a box is not yet a hit.
pub fn any_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> bool {
    todo!("like closest_hit_both, but stop at the first hit")
}
