//! Stage 9 · partitions: space is divided into cells, and each cell lists the primitives that
//! overlap it. This file has the functions that all partitions share. The grid, the octree, the
//! kd-tree, the BSP tree and the coherence of rays have a file each.
//!
//! Slides: `slides/stage09.md`.
//!
//! Given: [`Cells`] with `visit` (call it once per node or cell that the search visits) and `hit`
//! (the `t` at which the ray hits a primitive); [`Cell`], a closed box in double precision, with
//! its octants and halves. Of two hits at the same `t` the smaller primitive number wins, as in
//! stage 3.

use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells};
use raykata::ray::Ray;
use raykata::rounding::UNIT_ROUNDOFF;

/// The relative room for rounding when the `t` of a hit is compared with the `t` of a cell.
///
/// The two come from different formulas, so their order is certain only if they differ by more than
/// this fraction: 16 times `u = 2⁻²⁴`. Three roundings give an error of 3 u, and a grazing triangle
/// gives some more. If lists are tight, only this room keeps a hit on a face. It costs one more
/// cell for about one ray in 10,000, as the test `room_for_rounding_costs_next_to_no_visits` of the
/// reference counts.
pub const ROUNDING: f64 = 16.0 * UNIT_ROUNDOFF as f64;

/// Widens every box a little on all sides, so that a hit that rounding moves just outside its box
/// is still in a cell that lists it. Returns the number and the wider box of each primitive.
///
/// The room is 2⁻¹⁸ of the largest extent, and at least 2⁻²² of the largest coordinate.
///
/// Exactly:
///
/// 1. Empty boxes are left out.
pub fn padded_boxes(bounds: &[Aabb]) -> Vec<(u32, Aabb)> {
    todo!("leave out empty boxes, and widen every other box a little")
}

/// The box around boxes with numbers.
pub fn around(boxes: &[(u32, Aabb)]) -> Aabb {
    boxes.iter().fold(Aabb::EMPTY, |all, (_, one)| Aabb::new(all.min.min(one.min), all.max.max(one.max)))
}

/// The height of a ray above a plane is `height + rate · t`. It is at least `-room` from some `t`
/// on, up to some `t`, always or never. On which side is a ray that runs in the plane, or starts in
/// it?
///
/// Returns that part of the closed interval `t..=t_end`; it may be a single `t`.
///
/// Exactly:
///
/// 1. With `rate = 0` the result is the whole interval or `None`.
/// 2. A ray within the plane is on both sides.
/// 3. `None` if no `t` of the interval is above.
///
/// Source: "kd-Tree Traversal".
#[inline]
pub fn part_above(height: f64, rate: f64, room: f64, (t, t_end): (f64, f64)) -> Option<(f64, f64)> {
    todo!("cut the interval where the ray crosses the plane; treat a ray along the plane separately")
}

/// A ray is in a cell where it is above the planes of all six faces: each cuts its range
/// ([`part_above`]). What is `(face - o) / d` for a ray in the plane of a face?
///
/// Exactly:
///
/// 1. Returns the `t` of entry and exit. A ray that starts inside enters at `t_min`.
/// 2. Cells are closed: a ray along a face or through a corner is inside.
/// 3. The range and the faces have [`ROUNDING`] as room for hits in single precision.
/// 4. `None` if the ray misses the cell within its range, and for an empty cell.
///
/// Source: "kd-Tree Traversal".
#[inline]
pub fn span(ray: &Ray, cell: &Cell) -> Option<(f64, f64)> {
    todo!("intersect the range of the ray with the parts above all six faces")
}

/// The range of a ray, widened by [`ROUNDING`] at both ends.
pub fn range(ray: &Ray) -> (f64, f64) {
    let [t_min, t_max] = [ray.t_min, ray.t_max].map(f64::from);
    (t_min - ROUNDING * t_min.abs(), t_max + ROUNDING * t_max.abs())
}

/// Tests the primitives of a cell: keeps the closest hit in `best`, and shortens the ray to it. The
/// range of a ray is open. Is another primitive at the same `t` still reported?
///
/// Exactly:
///
/// 1. At equal `t` the smaller primitive number wins.
#[inline]
pub fn test_cell(primitives: &[u32], probe: &mut impl Cells, ray: &mut Ray, best: &mut Option<PrimitiveHit>) {
    todo!("ask probe.hit about each primitive, and keep the closest; at one t the smaller number")
}

/// Whether the search may stop before a cell that the ray enters at `entry`: the best hit lies
/// before the entry by more than [`ROUNDING`]. The slide compares `hit.distance < t'`. Which
/// formula does each of the two come from? `false` if there is no hit yet.
///
/// Source: "kd-Tree Traversal".
#[inline]
pub fn may_stop_before(best: &Option<PrimitiveHit>, entry: f64) -> bool {
    todo!("compare the best hit with the entry; leave room for rounding")
}
