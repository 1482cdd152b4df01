//! `fill_bins`, and the bin of a primitive.

use checks::prelude::*;
use glam::Vec3A;
use raykata::wide::{BinGrid, Bins, BoxA, MAX_BINS, PrimitiveBox};

/// The ways in which the bin of a primitive is computed wrongly.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Rounding {
    Right,
    Nearest,
    Up,
    OfCentroid,
    OfLow,
    OfAxis(usize),
    WithoutLow,
    TwoProducts,
    NegativeLast,
    FloorLast,
    MostBins,
    Again,
    Mirrored,
}

pub(super) const ROUNDINGS: [(Rounding, &str); 12] = named![
    Rounding::Nearest => "the bin is rounded to the nearest one: round down",
    Rounding::Up => "the bin is rounded up: round down",
    Rounding::OfCentroid => "the grid is that of twice the centroids: do not halve them",
    Rounding::OfLow => "the bin is that of the low corner of the box: take twice the centroid",
    Rounding::OfAxis(0) => "the same coordinate is used on all axes",
    Rounding::WithoutLow => "grid.low is left out: the first bin begins there",
    Rounding::TwoProducts => "the place is a difference of two products, which rounds otherwise: (c - low) · scale",
    Rounding::NegativeLast => "a bin below 0 becomes the last one: it counts as bin 0",
    Rounding::FloorLast => "a bin below 0 becomes the last one: it counts as bin 0",
    Rounding::Mirrored => "a bin below 0 loses its sign: it counts as bin 0",
    Rounding::MostBins => "the last bin is that of MAX_BINS: only grid.n_bins are in use",
    Rounding::Again => "beyond the last bin you begin again at bin 0: it counts as the last one",
];

/// The number of the bin along an axis, by the definition or by a wrong one.
pub(super) fn bin_of(primitive: &PrimitiveBox, grid: &BinGrid, axis: usize, rounding: Rounding) -> usize {
    let from = if let Rounding::OfAxis(axis) = rounding { axis } else { axis };
    let (low, scale) = (grid.low[from], grid.scale[from]);
    let at = match rounding {
        Rounding::OfCentroid => 0.5 * primitive.twice_centroid()[from],
        Rounding::OfLow => primitive.low()[from],
        _ => primitive.twice_centroid()[from],
    };
    let place = match rounding {
        Rounding::Nearest => ((at - low) * scale).round(),
        Rounding::Up => ((at - low) * scale).ceil(),
        Rounding::WithoutLow => at * scale,
        Rounding::TwoProducts => at * scale - low * scale,
        Rounding::FloorLast => ((at - low) * scale).floor(),
        Rounding::Mirrored => ((at - low) * scale).abs(),
        _ => (at - low) * scale,
    };
    let last = if rounding == Rounding::MostBins { MAX_BINS } else { grid.n_bins as usize } - 1;
    let is_wrapped = matches!(rounding, Rounding::NegativeLast | Rounding::FloorLast) && place <= -1.0;
    if rounding == Rounding::Again && place > last as f32 {
        return place as usize % (last + 1);
    }
    if is_wrapped || place >= last as f32 { last } else { place.max(0.0) as usize }
}

/// Boxes: of whole eighths, with full mantissas, and empty.
fn any_box() -> impl Strategy<Value = Aabb> + Clone {
    let cube = |low: Vec3, size: f32| Aabb::new(low, low + size);
    prop_oneof![
        4 => (nasty::lattice(6), 0..=3i32).prop_map(move |(low, size)| cube(low, size as f32)),
        4 => (rough_point(6.0), 0..=3i32).prop_map(move |(low, size)| cube(low, size as f32 / 3.0)),
        1 => Just(Aabb::EMPTY),
    ]
}

/// The primitives with these boxes. Their numbers are not their places.
pub(super) fn primitives(boxes: &[Aabb]) -> Vec<PrimitiveBox> {
    let n = boxes.len() as u32;
    (0..n).zip(boxes).map(|(i, bounds)| PrimitiveBox::new(3 * n - 2 * i, bounds)).collect()
}

/// The grid over the centroids of ordinary primitives; all in one bin if there are none.
pub(super) fn grid_over(primitives: &[PrimitiveBox], n_bins: u32) -> BinGrid {
    let all = |fold: fn(f32, f32) -> f32, start: f32| {
        Vec3::from_array([0, 1, 2].map(|axis| {
            primitives.iter().map(|p| p.twice_centroid()[axis]).filter(|at| at.is_finite()).fold(start, fold)
        }))
    };
    let (low, high) = (all(f32::min, f32::INFINITY), all(f32::max, f32::NEG_INFINITY));
    let scale = (high - low).map(|extent| if extent > 0.0 { 0.999_99 * n_bins as f32 / extent } else { 0.0 });
    let low = low.map(|low| if low.is_finite() { low } else { 0.0 });
    BinGrid { low: low.into(), scale: scale.into(), n_bins }
}

/// A grid over the centroids, or one that leaves centroids outside, or on the bounds between bins.
pub(super) fn grids(primitives: &[PrimitiveBox], kind: u8, n_bins: u32) -> BinGrid {
    let over = grid_over(primitives, n_bins);
    match kind {
        0 | 1 => over,
        2 => BinGrid { low: Vec3::ZERO.into(), scale: Vec3::ONE.into(), n_bins },
        3 => {
            BinGrid { low: Vec3::new(-2.0, 0.0, 2.0).into(), scale: Vec3::new(0.5, 1.0, 0.25).into(), n_bins }
        }
        4 => BinGrid { scale: Vec3::new(over.scale.x, 0.0, over.scale.z).into(), ..over },
        _ => BinGrid { scale: over.scale * 3.0, ..over },
    }
}

pub(super) fn n_bins() -> impl Strategy<Value = u32> + Clone {
    prop::sample::select(vec![16u32, 2, 3, 5, 8, 13])
}

/// Boxes that are not empty.
fn ordinary() -> impl Strategy<Value = BinsQuery> + Clone {
    let one = (rough_point(6.0), 1..=8i32).prop_map(|(low, size)| Aabb::new(low, low + size as f32 / 3.0));
    (prop::collection::vec(one, 0..24), n_bins()).prop_map(|(boxes, n_bins)| {
        let primitives = primitives(&boxes);
        BinsQuery { grid: grid_over(&primitives, n_bins), primitives }
    })
}

fn special() -> impl Strategy<Value = BinsQuery> + Clone {
    (prop::collection::vec(any_box(), 0..24), n_bins(), 0..=5u8).prop_map(|(boxes, n_bins, kind)| {
        let primitives = primitives(&boxes);
        BinsQuery { grid: grids(&primitives, kind, n_bins), primitives }
    })
}

/// The primitives in one bin.
fn members(query: &BinsQuery, axis: usize, bin: usize, rounding: Rounding) -> Vec<&PrimitiveBox> {
    let is_in = |primitive: &&PrimitiveBox| bin_of(primitive, &query.grid, axis, rounding) == bin;
    query.primitives.iter().filter(is_in).collect()
}

/// The smallest box around two boxes.
pub(super) fn union(p: BoxA, q: BoxA) -> BoxA {
    BoxA { low: p.low.min(q.low), high: p.high.max(q.high) }
}

fn box_of(primitive: &PrimitiveBox) -> BoxA {
    BoxA { low: primitive.low(), high: primitive.high() }
}

/// The box around some primitives.
fn around(members: &[&PrimitiveBox]) -> BoxA {
    members.iter().map(|one| box_of(one)).fold(BoxA::EMPTY, union)
}

/// All bins by axis and number.
fn all_bins() -> impl Iterator<Item = (usize, usize)> {
    (0..3).flat_map(|axis| (0..MAX_BINS).map(move |bin| (axis, bin)))
}

fn input(query: &BinsQuery) -> String {
    format!("fill_bins of {} boxes, {} bins", query.primitives.len(), query.grid.n_bins)
}

/// The mistakes of a bin's number that give exactly these counts.
fn wrong_numbers(query: &BinsQuery, yours: &Bins) -> Vec<(bool, &'static str)> {
    let gives = |rounding| {
        all_bins()
            .all(|(axis, bin)| yours.0[axis][bin].count as usize == members(query, axis, bin, rounding).len())
    };
    let once = all_bins().all(|(axis, bin)| axis == 0 || yours.0[axis][bin].count == 0);
    let mut mistakes: Vec<_> = ROUNDINGS.map(|(rounding, text)| (gives(rounding), text)).to_vec();
    mistakes.push((once, "the bins of the axes y and z stay empty"));
    let n_bins = query.grid.n_bins as f32;
    let those = |is_counted: &dyn Fn(f32) -> bool| {
        let is_inside = |primitive: &PrimitiveBox, axis: usize| {
            is_counted((primitive.twice_centroid()[axis] - query.grid.low[axis]) * query.grid.scale[axis])
        };
        all_bins().all(|(axis, bin)| {
            let members = members(query, axis, bin, Rounding::Right);
            let inside = members.iter().filter(|primitive| is_inside(primitive, axis));
            yours.0[axis][bin].count as usize == inside.count()
        })
    };
    let with_a_box = all_bins().all(|(axis, bin)| {
        let members = members(query, axis, bin, Rounding::Right);
        let with_a_box = members.iter().filter(|one| one.low().cmple(one.high()).all());
        yours.0[axis][bin].count as usize == with_a_box.count()
    });
    mistakes.extend(named![
        those(&|place| !(place >= n_bins)) => "centroids beyond the last bin are left out: they count in it",
        those(&|place| (0.0..n_bins).contains(&place)) => "centroids outside of the bins are left out: they count in the first or the last bin",
        with_a_box => "a primitive with the empty box is left out: it is counted all the same",
    ]);
    mistakes
}

fn judge_counts(query: &BinsQuery, yours: &Bins) -> CheckResult {
    for (axis, bin) in all_bins() {
        let expected = members(query, axis, bin, Rounding::Right).len();
        let count = yours.0[axis][bin].count as usize;
        if count != expected {
            let of = |n: usize| format!("{n} primitives in bin {bin} of axis {axis}");
            return Err(Broken::with_texts(input(query), of(count), of(expected), "counted"));
        }
    }
    Ok(())
}

fn judge_boxes(query: &BinsQuery, yours: &Bins) -> CheckResult {
    for (axis, bin) in all_bins() {
        let expected = around(&members(query, axis, bin, Rounding::Right));
        let bounds = yours.0[axis][bin].bounds;
        if bounds != expected {
            let of = |one: BoxA| format!("{:?}..{:?} in bin {bin} of axis {axis}", one.low, one.high);
            let source = "the box around its primitives";
            return Err(Broken::with_texts(input(query), of(bounds), of(expected), source));
        }
    }
    Ok(())
}

/// The mistakes of a bin's box that give exactly these boxes.
fn wrong_boxes(query: &BinsQuery, yours: &Bins) -> Vec<(bool, &'static str)> {
    let gives = |bounds: &dyn Fn(&[&PrimitiveBox]) -> BoxA| {
        all_bins().all(|(axis, bin)| {
            yours.0[axis][bin].bounds == bounds(&members(query, axis, bin, Rounding::Right))
        })
    };
    let point = |at: Vec3A| BoxA { low: at, high: at };
    let last = |members: &[&PrimitiveBox]| members.last().map_or(BoxA::EMPTY, |last| box_of(last));
    let centroids = |members: &[&PrimitiveBox]| {
        members.iter().map(|one| point(one.twice_centroid())).fold(BoxA::EMPTY, union)
    };
    let from_origin = |members: &[&PrimitiveBox]| union(around(members), point(Vec3A::ZERO));
    vec![
        (gives(&last), "the box of a bin is that of its last primitive: take the union"),
        (gives(&centroids), "the box of a bin is that of the centroids: take the boxes of the primitives"),
        (gives(&from_origin), "the boxes start at the origin: start with the empty box, Bin::EMPTY"),
        (gives(&|_| BoxA::EMPTY), "the boxes stay empty"),
    ]
}

fn ask(trial: &Trial<'_>, queries: &[BinsQuery]) -> Vec<Bins> {
    trial.kit.fill_bins(queries).into_iter().map(|bins| *bins).collect()
}

pub(super) fn fill_bins_counts_every_primitive(trial: &Trial<'_>) -> CheckResult {
    trial.forall(300, ordinary(), |queries| {
        compare_formulas(
            queries,
            ask(trial, queries),
            |query, yours| judge_counts(query, &yours),
            wrong_numbers,
        )
    })
}

pub(super) fn fill_bins_boxes_hold_their_primitives(trial: &Trial<'_>) -> CheckResult {
    trial.forall(300, ordinary(), |queries| {
        compare_formulas(queries, ask(trial, queries), |query, yours| judge_boxes(query, &yours), wrong_boxes)
    })
}

pub(super) fn fill_bins_takes_special_numbers(trial: &Trial<'_>) -> CheckResult {
    // First test one ordinary primitive, so that no panic of a special one hides what is wrong.
    let one = primitives(&[Aabb::new(Vec3::ZERO, Vec3::ONE)]);
    let simple = [BinsQuery { grid: grid_over(&one, 4), primitives: one }];
    all_hold(compare(&simple, ask(trial, &simple), |query, yours| judge_counts(query, &yours)))?;
    trial.forall(400, special(), |queries| {
        let judge = |query: &BinsQuery, yours: Bins| {
            judge_counts(query, &yours).and_then(|()| judge_boxes(query, &yours))
        };
        // Where only a box is wrong, no number is.
        let mistakes = |query: &BinsQuery, yours: &Bins| {
            let of_boxes = judge_counts(query, yours).is_ok() && judge_boxes(query, yours).is_err();
            let numbers = wrong_numbers(query, yours).into_iter();
            let numbers = numbers.map(|(is_it, text)| (is_it && !of_boxes, text));
            numbers.chain(wrong_boxes(query, yours)).collect::<Vec<_>>()
        };
        compare_formulas(queries, ask(trial, queries), judge, mistakes)
    })
}
