//! Stage 9 · partitions: space divided into cells, each with a list of what reaches into it. Here is what all of them need;
//! the grid, the octree, the kd-tree, the BSP tree and the coherence of rays have a file each.
//!
//! Slides: "Kd-Trees", "Uniform Grid", "Octree", "Binary Space Partition (BSP) Tree".
//!
//! Given: [`Cells`] with `visit` (call it for each node or cell that the search comes to) and `hit` (where the ray hits a
//! primitive); [`Cell`], a box in double precision, with its octants and halves. Of two hits at the same `t` the smaller
//! primitive number wins, as in stage 3.

use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells};
use raykata::ray::Ray;

/// The `t` of a hit and that of a cell come from different formulas, so neither is before or behind the other unless by
/// more than this share: 16 times `u = 2⁻²⁴`, where three roundings make 3 u and a grazing triangle some more. Where lists
/// are tight, nothing else keeps a hit on a face. It costs next to nothing, a cell more for about one ray in 10,000, as
/// `room_for_rounding_costs_next_to_no_visits` counts (solutions/tests/partitions.rs).
pub const ROUNDING: f64 = 16.0 * (f32::EPSILON as f64) / 2.0;

/// Boxes as builders take them: with room around each.
pub struct Widened {
    /// The box around all.
    pub around: Aabb,
    /// Number and box of each primitive that can be met.
    pub boxes: Vec<(u32, Aabb)>,
}

/// The boxes that are no nonsense, each with a little room on all sides, so that a hit that rounding puts just outside of
/// its box is still in a cell that lists it. What is not a number, or empty, is left out: no ray meets it.
///
/// Room is 2⁻¹⁸ of the largest extent, because a test in single precision is off by some 2⁻²³ of the distance to the
/// ray's origin, and cameras stand within 32 extents; but at least 2⁻²² of the largest coordinate, which is some steps.
pub fn widened(bounds: &[Aabb]) -> Widened {
    // <solution>
    let usable = |(_, one): &(usize, &Aabb)| !one.is_empty();
    let around = |boxes: &mut dyn Iterator<Item = &Aabb>| {
        boxes.fold(Aabb::EMPTY, |all, one| Aabb::new(all.min.min(one.min), all.max.max(one.max)))
    };
    let all = around(&mut bounds.iter().enumerate().filter(usable).map(|(_, one)| one));

    // In double, for the extent of huge boxes overflows.
    let (min, max) = (all.min.as_dvec3(), all.max.as_dvec3());
    let extent = (max - min).max_element() * (-18f64).exp2();
    let step = min.abs().max_element().max(max.abs().max_element()) * (-22f64).exp2();
    let room = extent.max(step).min(f64::from(f32::MAX)) as f32;
    let widen = |one: &Aabb| {
        // Infinite corners would make cells without a middle.
        Aabb::new((one.min - room).map(|x| x.max(f32::MIN)), (one.max + room).map(|x| x.min(f32::MAX)))
    };
    let boxes: Vec<(u32, Aabb)> =
        bounds.iter().enumerate().filter(usable).map(|(id, one)| (id as u32, widen(one))).collect();
    Widened { around: around(&mut boxes.iter().map(|(_, one)| one)), boxes }
    // <stub> todo!("leave out what is empty or not a number, and give every other box a little room")
    // </solution>
}

/// The part of `t..=t'` in which `ray` is at height 0 or more above a plane, where its height is `height + rate · t`:
/// one side of a cut. `room` is how far below still counts. A ray along the plane, `rate = 0`, is above it for ever or
/// never; one within it is on both sides.
///
/// Where the formula lies: `tHit <= t → snd` leaves out the side of a ray that starts in the plane, and
/// `direction = 0: origin <= value → left` that of one that stays in it.
#[inline]
pub fn part_above(height: f64, rate: f64, room: f64, (t, t_end): (f64, f64)) -> Option<(f64, f64)> {
    // <solution>
    if rate == 0.0 {
        return (height >= -room).then_some((t, t_end));
    }
    let crossing = (-room - height) / rate;
    let (t, t_end) = if rate > 0.0 { (t.max(crossing), t_end) } else { (t, t_end.min(crossing)) };
    (t <= t_end).then_some((t, t_end))
    // <stub> todo!("cut the interval where the ray crosses the plane; mind a ray along it")
    // </solution>
}

/// Where `ray` enters and leaves a cell, in double precision and within its own range: the part that is above all six
/// faces. The cell is closed, and range and faces have [`ROUNDING`] as room, so nothing is lost that single precision
/// would find. `None` for an empty cell.
#[inline]
pub fn span(ray: &Ray, cell: &Cell) -> Option<(f64, f64)> {
    // <solution>
    if !cell.min.cmple(cell.max).all() {
        return None;
    }
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
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

/// The range of a ray, with room for rounding at both ends.
pub fn range(ray: &Ray) -> (f64, f64) {
    let [t_min, t_max] = [ray.t_min, ray.t_max].map(f64::from);
    (t_min - ROUNDING * t_min.abs(), t_max + ROUNDING * t_max.abs())
}

/// Tests the primitives of a cell: keeps the closest hit in `best`, and shortens the ray by it. A hit counts wherever it
/// lies, for the cell does not end the primitive; and a primitive that reaches into several cells may be tested again,
/// which changes nothing.
#[inline]
pub fn look_into(primitives: &[u32], probe: &mut impl Cells, ray: &mut Ray, best: &mut Option<PrimitiveHit>) {
    // <solution>
    for &primitive in primitives {
        let Some(t) = probe.hit(primitive, ray) else { continue };
        if best.is_none_or(|best| (t, primitive) < (best.t, best.primitive)) {
            *best = Some(PrimitiveHit { t, primitive });
        }
        // One step beyond t, so that another primitive at the very same t is still heard.
        ray.t_max = t.next_up().min(ray.t_max);
    }
    // <stub> todo!("ask probe.hit about each primitive, and keep the closest; at one t the smaller number")
    // </solution>
}

/// Whether the search may stop before a cell that the ray enters at `entry`: the best hit lies before it, and by more
/// than [`ROUNDING`].
///
/// Where the formula lies: `hit.distance < t'` throws a hit away that lies on the far face of its cell, and takes `t` and
/// `t'` from two formulas for comparable.
#[inline]
pub fn settled(best: &Option<PrimitiveHit>, entry: f64) -> bool {
    // <solution>
    best.is_some_and(|best| {
        let t = f64::from(best.t);
        t + ROUNDING * t.abs() < entry
    })
    // <stub> todo!("compare the best hit with the entry; leave room for rounding")
    // </solution>
}
