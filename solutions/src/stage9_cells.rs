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

// <solution>
use crate::stage3_traversal::keep_closest;
use glam::Vec3;
use raykata::partition::CutPlane;
// </solution>

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
    // <solution>
    // Keep the boxes that a ray can hit.
    let usable = (0..).zip(bounds).filter(|(_, one)| !one.is_empty());
    let mut boxes: Vec<(u32, Aabb)> = usable.map(|(id, one)| (id, *one)).collect();

    // Compute the room in double precision, because the extent of huge boxes overflows in single
    // precision. A test in single precision has an error of about 2⁻²³ of the distance to the ray's
    // origin, and cameras are usually within 32 extents.
    let all = around(&boxes);
    let (min, max) = (all.min.as_dvec3(), all.max.as_dvec3());
    let extent = (max - min).max_element() * (-18f64).exp2();
    let step = min.abs().max_element().max(max.abs().max_element()) * (-22f64).exp2();
    let room = extent.max(step).min(f64::from(f32::MAX)) as f32;
    // Widen each box. Infinite corners would give cells without a middle.
    for (_, one) in &mut boxes {
        *one = Aabb::new((one.min - room).max(Vec3::MIN), (one.max + room).min(Vec3::MAX));
    }
    boxes
    // <stub> todo!("leave out empty boxes, and widen every other box a little")
    // </solution>
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
    // <solution>
    if rate == 0.0 {
        return (height >= -room).then_some((t, t_end));
    }
    let crossing = (-room - height) / rate;
    let (t, t_end) = if rate > 0.0 { (t.max(crossing), t_end) } else { (t, t_end.min(crossing)) };
    (t <= t_end).then_some((t, t_end))
    // <stub> todo!("cut the interval where the ray crosses the plane; treat a ray along the plane separately")
    // </solution>
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
    // <solution>
    // Refuse an empty cell, or one with NaN.
    if !cell.min.cmple(cell.max).all() {
        return None;
    }
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    // Cut the range of the ray at the lower and the upper face of each axis.
    let mut part = range(ray);
    for axis in 0..3 {
        for (height, rate) in [
            (origin[axis] - cell.min[axis], direction[axis]),
            (cell.max[axis] - origin[axis], -direction[axis]),
        ] {
            part = part_above(height, rate, ROUNDING * height.abs(), part)?;
        }
    }
    Some(part)
    // <stub> todo!("intersect the range of the ray with the parts above all six faces")
    // </solution>
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
    // <solution>
    for &primitive in primitives {
        let Some(t) = probe.hit(primitive, ray) else { continue };
        keep_closest(best, ray, PrimitiveHit { t, primitive });
    }
    // <stub> todo!("ask probe.hit about each primitive, and keep the closest; at one t the smaller number")
    // </solution>
}

/// Whether the search may stop before a cell that the ray enters at `entry`: the best hit lies
/// before the entry by more than [`ROUNDING`]. The slide compares `hit.distance < t'`. Which
/// formula does each of the two come from? `false` if there is no hit yet.
///
/// Source: "kd-Tree Traversal".
#[inline]
pub fn may_stop_before(best: &Option<PrimitiveHit>, entry: f64) -> bool {
    // <solution>
    best.is_some_and(|best| {
        let t = f64::from(best.t);
        t + ROUNDING * t.abs() < entry
    })
    // <stub> todo!("compare the best hit with the entry; leave room for rounding")
    // </solution>
}

// <solution>
/// A child of a node, with the part of the ray in it.
pub type Child = (u32, (f64, f64));

/// Finds the parts of a ray on the two sides of a plane, behind which is the node `back` and in
/// front of which is `front`. The first result is the side from which the ray comes; `None` if no
/// `t` of `part` is on a side. Both sides extend beyond the plane by `room`, in world units.
pub fn near_and_far(
    plane: &CutPlane,
    [back, front]: [u32; 2],
    room: f64,
    ray: &Ray,
    part: (f64, f64),
) -> [Option<Child>; 2] {
    // Compute the height of the origin above the plane, and its change per unit of t.
    let (height, rate) = (plane.distance(ray.origin), plane.normal.dot(ray.direction.as_dvec3()));
    // Bound the rounding error of the height, which is a difference of numbers of this size.
    let digits = plane.normal.abs().dot(ray.origin.as_dvec3().abs()) + plane.offset.abs();
    let room = room + ROUNDING * height.abs() + 4.0 * f64::EPSILON * digits;
    // Find the part of the ray on each side.
    let before = part_above(height, rate, room, part).map(|part| (front, part));
    let behind = part_above(-height, -rate, room, part).map(|part| (back, part));
    if rate > 0.0 { [behind, before] } else { [before, behind] }
}

/// The `t` at which a ray crosses the plane at a coordinate; infinite without a direction.
pub fn crossing(origin: f64, direction: f64, plane: f64) -> f64 {
    if direction == 0.0 { f64::INFINITY } else { (plane - origin) / direction }
}

/// The axis of the first of the planes that a ray crosses at `t[axis]`.
pub fn first_axis(t: [f64; 3]) -> usize {
    (1..3).fold(0, |first, axis| if t[axis] < t[first] { axis } else { first })
}
// </solution>
