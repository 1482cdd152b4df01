//! `partition_bins`.

use super::bins::{ROUNDINGS, Rounding, bin_of, grid_over, grids, n_bins, primitives};
use checks::prelude::*;
use raykata::wide::{BinGrid, BinSplit, PrimitiveBox};

fn query(boxes: &[Aabb], kind: u8, n_bins: u32, axis: u32, bin: u32) -> PartitionQuery {
    let primitives = primitives(boxes);
    let grid = if kind == 0 { grid_over(&primitives, n_bins) } else { grids(&primitives, kind, n_bins) };
    PartitionQuery { primitives, grid, split: BinSplit { axis, bin: 1 + bin % (n_bins - 1), cost: 1.0 } }
}

fn cubes(rough: bool) -> impl Strategy<Value = Vec<Aabb>> + Clone {
    let cube = |(low, size): (Vec3, i32)| Aabb::new(low, low + size as f32 / 4.0);
    let low = if rough { rough_point(6.0).boxed() } else { nasty::lattice(6).boxed() };
    prop::collection::vec((low, 1..=4i32).prop_map(cube), 0..24)
}

pub(super) fn queries(
    rough: bool,
    kinds: std::ops::RangeInclusive<u8>,
) -> impl Strategy<Value = PartitionQuery> + Clone {
    (cubes(rough), kinds, n_bins(), 0..3u32, any::<u8>())
        .prop_map(|(boxes, kind, n_bins, axis, bin)| query(&boxes, kind, n_bins, axis, u32::from(bin)))
}

/// The numbers of the primitives on the left side, sorted.
fn left_side(query: &PartitionQuery, is_left: impl Fn(&PrimitiveBox) -> bool) -> Vec<u32> {
    let left = query.primitives.iter().filter(|primitive| is_left(primitive));
    sorted(&left.map(PrimitiveBox::id).collect::<Vec<_>>())
}

fn sorted(ids: &[u32]) -> Vec<u32> {
    let mut ids = ids.to_vec();
    ids.sort_unstable();
    ids
}

/// The bin of a primitive on the axis of the split.
fn bin(query: &PartitionQuery, primitive: &PrimitiveBox, rounding: Rounding) -> usize {
    bin_of(primitive, &query.grid, query.split.axis as usize, rounding)
}

/// The numbers of the primitives before the bin of the split.
fn before_split(query: &PartitionQuery, rounding: Rounding) -> Vec<u32> {
    left_side(query, |primitive| bin(query, primitive, rounding) < query.split.bin as usize)
}

/// The length of the left side of an answer, which has no more than all primitives.
fn middle(yours: &SplitAnswer) -> usize {
    yours.middle.unwrap_or(usize::MAX).min(yours.order.len())
}

fn judge(query: &PartitionQuery, yours: &SplitAnswer) -> CheckResult {
    let split = &query.split;
    let left = before_split(query, Rounding::Right);
    let input = format!("partition_bins before bin {} of axis {}", split.bin, split.axis);
    let (first, second) = yours.order.split_at(middle(yours));
    let text = format!("{first:?} and {second:?}");
    if sorted(&yours.order) != left_side(query, |_| true) {
        let broken = Broken::with_texts(input, text, "each primitive once", "the given primitives");
        return Err(broken.because("a primitive is lost or copied: only swap"));
    }
    if sorted(first) == left && yours.middle == Some(left.len()) {
        return Ok(());
    }
    let expected = format!("{left:?} in any order, and then the others");
    Err(Broken::with_texts(input, text, expected, "the bins of fill_bins"))
}

fn mistakes(query: &PartitionQuery, yours: &SplitAnswer) -> Vec<(bool, &'static str)> {
    let PartitionQuery { primitives, grid, split } = query;
    let (axis, last_left) = (split.axis as usize, split.bin as usize);
    let middle = middle(yours);
    // An answer that lost a primitive follows none of these formulas.
    let is_complete = sorted(&yours.order) == left_side(query, |_| true);
    let is = |side: Vec<u32>| yours.middle == Some(middle) && sorted(&yours.order[..middle]) == side;
    let right = |primitive: &PrimitiveBox| bin(query, primitive, Rounding::Right);
    let left = before_split(query, Rounding::Right);
    let plane = grid.low[axis] + split.bin as f32 / grid.scale[axis];
    let mut mistakes = vec![
        "the first bin of the right side goes to the left: bins before `bin` are left"
            .when(is(left_side(query, |primitive| right(primitive) <= last_left))),
        (is(left_side(query, |primitive| right(primitive) >= last_left)), "the sides are exchanged"),
        "you return one more than the number of the left side"
            .when(yours.middle == Some((left.len() + 1).min(primitives.len()))),
        "the centroid is compared with a plane, which rounds otherwise than the bin does: compute the bin as fill_bins does"
            .when(is(left_side(query, |primitive| primitive.twice_centroid()[axis] < plane))),
        "the number of the left side is right, but the primitives stay as they come"
            .when(yours.order.iter().copied().eq(primitives.iter().map(PrimitiveBox::id)) && middle == left.len()),
        "you return the number of the right side"
            .when(yours.middle == Some(primitives.len() - left.len())
                && yours.order.get(..left.len()).is_some_and(|first| sorted(first) == left)
            ),
    ];
    mistakes.extend(ROUNDINGS.map(|(rounding, text)| (is(before_split(query, rounding)), text)));
    mistakes.into_iter().map(|(gives, text)| (gives && is_complete, text)).collect()
}

pub(super) fn judge_all(
    trial: &Trial<'_>,
    chosen: &[PartitionQuery],
    drawn: impl Strategy<Value = PartitionQuery> + Clone,
) -> CheckResult {
    trial.forall_and(chosen, 400, drawn, |queries| {
        let answers = trial.kit.partition_bins(queries);
        compare_formulas(queries, answers, |query, yours| judge(query, &yours), mistakes)
    })
}

pub(super) fn partition_bins_agrees_with_the_bins(trial: &Trial<'_>) -> CheckResult {
    // Centroids on the bounds between bins, where a formula that rounds in another way puts them into another bin. An axis
    // with the scale 0 has one bin.
    let edges = (
        prop::collection::vec((1..=15i32, 0..=2i32), 1..12),
        n_bins(),
        1..=40i32,
        0..3u32,
        any::<u8>(),
        0..3i32,
    )
        .prop_map(|(places, n_bins, extent, axis, bin, low)| {
            // Boxes at about the places k/n_bins of an extent: their bounds are rounded.
            let (extent, low) = (extent as f32 / 7.0, low as f32 / 3.0);
            let at = |(k, ulps): (i32, i32)| {
                let mut at = low + extent * k as f32 / n_bins as f32;
                for _ in 0..ulps {
                    at = at.next_up();
                }
                Aabb::new(Vec3::splat(at), Vec3::splat(at))
            };
            let mut boxes: Vec<Aabb> = places.into_iter().map(at).collect();
            boxes.extend([
                Aabb::new(Vec3::splat(low), Vec3::splat(low)),
                Aabb::new(Vec3::splat(low + extent), Vec3::splat(low + extent)),
            ]);
            let mut query = query(&boxes, 0, n_bins, axis, u32::from(bin));
            // The grid has twice the centroids: bounds between its bins are at twice those places.
            let scale = Vec3::splat(n_bins as f32 / (2.0 * extent));
            query.grid = BinGrid { low: Vec3::splat(2.0 * low).into(), scale: scale.into(), n_bins };
            query
        });
    judge_all(trial, &[], prop_oneof![3 => edges, 1 => queries(false, 1..=5)])
}

pub(super) fn partition_bins_of_one_side(trial: &Trial<'_>) -> CheckResult {
    // All primitives in one bin, none at all, and empty boxes, which are in bin 0.
    let cube = |x: f32| Aabb::new(Vec3::splat(x), Vec3::splat(x + 1.0));
    let place = |boxes: &[Aabb], bin: u32| {
        let mut query = query(boxes, 2, 8, 0, 0);
        query.split.bin = bin;
        query
    };
    let chosen = [
        place(&[cube(0.0), cube(2.0)], 3),
        place(&[cube(0.0), cube(0.0), cube(0.0)], 4),
        place(&[cube(2.0), cube(2.0), cube(2.0)], 1),
        place(&[], 1),
        place(&[cube(3.0), Aabb::EMPTY, cube(0.0)], 2),
    ];
    judge_all(trial, &chosen, queries(false, 2..=3))
}
