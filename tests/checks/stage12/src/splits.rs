//! `block_cost` and `cheapest_split`.

use super::bins::{Rounding, bin_of, n_bins, union};
use checks::prelude::*;
use checks::tree::half_area;
use glam::Vec3A;
use raykata::wide::{BLOCK, BLOCK_COST, Bin, BinGrid, BinSplit, Bins, BoxA, PrimitiveBox};

/// The number of blocks, computed in a wrong way.
fn wrong_blocks(n: u32) -> [(u32, &'static str); 4] {
    let block = BLOCK as u32;
    let rounded_down =
        "the number of blocks is rounded down: a block that is not full costs as much as a full one";
    [
        (n / block, rounded_down),
        ((n / block).max(1), rounded_down),
        (n / block + 1, "a full block is followed by an empty one: a leaf of eight has one block"),
        (n, "the cost is that of single primitives: eight are tested at once"),
    ]
}

pub(super) fn block_cost_counts_whole_blocks(trial: &Trial<'_>) -> CheckResult {
    // Numbers beside multiples of eight, small and large.
    let numbers =
        prop_oneof![0..=40u32, (1..=22u32, 0..=2u32).prop_map(|(exponent, more)| (1 << exponent) + more - 1)];
    trial.forall_and(&[1, 8, 9, 16, (1 << 24) - 7, 1 << 24], 200, numbers, |numbers| {
        let judge = |n: &u32, yours: f32| {
            // Exact: BLOCK_COST times a whole number below 2²⁴.
            let expected = BLOCK_COST * n.div_ceil(BLOCK as u32) as f32;
            if yours == expected {
                return Ok(());
            }
            Err(Broken::new(format!("block_cost({n})"), yours, expected, "the definition"))
        };
        compare_formulas(numbers, trial.kit.block_cost(numbers), judge, |n, yours| {
            wrong_blocks(*n).map(|(blocks, text)| (*yours == BLOCK_COST * blocks as f32, text)).to_vec()
        })
    })
}

/// A primitive in the bins: its box, and its bin on each axis.
type Placed = (Aabb, [u8; 3]);

/// The bins of `placed`, `n_bins` per axis.
fn bins_of(placed: &[Placed], n_bins: u32) -> BinSplitQuery {
    let mut bins = Box::new(Bins::EMPTY);
    for (bounds, places) in placed {
        for (axis, place) in places.iter().enumerate() {
            let bin = &mut bins.0[axis][usize::from(*place) % n_bins as usize];
            bin.bounds = union(bin.bounds, BoxA { low: bounds.min.into(), high: bounds.max.into() });
            bin.count += 1;
        }
    }
    BinSplitQuery { bins, n_bins }
}

fn placed() -> impl Strategy<Value = Placed> + Clone {
    // Some boxes are flat, and some have no area.
    let size =
        (0..=4i32, 0..=4i32, 0..=4i32).prop_map(|(x, y, z)| Vec3::new(x as f32, y as f32, z as f32) * 0.5);
    (checks::generate::point(6), size, any::<[u8; 3]>())
        .prop_map(|(low, size, places)| (Aabb::new(low, low + size), places))
}

fn queries() -> impl Strategy<Value = BinSplitQuery> + Clone {
    (prop::collection::vec(placed(), 0..30), n_bins()).prop_map(|(placed, n_bins)| bins_of(&placed, n_bins))
}

/// One side of a split: the box around some bins, and the number of their primitives.
fn side(bins: &[Bin]) -> (BoxA, u32) {
    (bins.iter().map(|bin| bin.bounds).fold(BoxA::EMPTY, union), bins.iter().map(|bin| bin.count).sum())
}

/// Half of the surface area in double precision; 0 for the empty box.
fn area(bounds: &BoxA) -> f64 {
    half_area(&Aabb::new(bounds.low.into(), bounds.high.into()))
}

fn volume(bounds: &BoxA) -> f64 {
    let [x, y, z] = (bounds.high - bounds.low).max(Vec3A::ZERO).to_array().map(f64::from);
    x * y * z
}

/// The number of whole blocks of a side.
fn blocks((_, n): &(BoxA, u32)) -> f64 {
    f64::from(n.div_ceil(BLOCK as u32))
}

/// All splits that leave no side without primitives: axis, bin and both sides.
fn splits(query: &BinSplitQuery) -> Vec<(BinSplit, [(BoxA, u32); 2])> {
    let mut splits = Vec::new();
    for axis in 0..3 {
        let bins = &query.bins.0[axis][..query.n_bins as usize];
        for bin in 1..bins.len() {
            let sides = [side(&bins[..bin]), side(&bins[bin..])];
            if sides[0].1 > 0 && sides[1].1 > 0 {
                splits.push((BinSplit { axis: axis as u32, bin: bin as u32, cost: 0.0 }, sides));
            }
        }
    }
    splits
}

/// Both sides of a split; `None` if one has no primitives.
fn sides_of(query: &BinSplitQuery, one: &BinSplit) -> Option<[(BoxA, u32); 2]> {
    let found = splits(query).into_iter().find(|(split, _)| (split.axis, split.bin) == (one.axis, one.bin));
    found.map(|(_, sides)| sides)
}

type Cost = fn(&[(BoxA, u32); 2]) -> f64;

fn right_cost(sides: &[(BoxA, u32); 2]) -> f64 {
    sides.iter().map(|side| area(&side.0) * blocks(side)).sum()
}

const WRONG_COSTS: [(Cost, &str); 9] = named![
    |sides| area(&sides[0].0) * blocks(&sides[0]) => "only the left side is counted in the cost",
    |sides| area(&sides[1].0) * blocks(&sides[1]) => "only the right side is counted in the cost",
    |sides| sides.iter().map(|(bounds, n)| area(bounds) * f64::from(n / BLOCK as u32)).sum() =>
        "the number of blocks is rounded down: a block that is not full costs as much as a full one",
    |sides| (area(&sides[0].0) + area(&sides[1].0)) * (blocks(&sides[0]) + blocks(&sides[1])) =>
        "the sum of the areas is multiplied by the sum of the costs: each side has a product of its own",
    |sides| sides.iter().map(|(bounds, n)| area(bounds) * f64::from(*n)).sum() =>
        "the sides count single primitives: a leaf pays for whole blocks, block_cost",
    |sides| sides.iter().map(|(bounds, _)| area(bounds)).sum() => "the counts are left out of the cost",
    |sides| sides.iter().map(blocks).sum() => "the areas are left out of the cost",
    |sides| sides.iter().map(|side| volume(&side.0) * blocks(side)).sum() => "the cost has volumes in place of surface areas",
    |sides| area(&sides[0].0) * blocks(&sides[1]) + area(&sides[1].0) * blocks(&sides[0]) =>
        "each area is multiplied by the cost of the other side",
];

/// Two costs are the same if they differ by less than the rounding errors of sums of 16 areas.
const SAME: f64 = 1e-5;

fn is_same(yours: f64, expected: f64) -> bool {
    expected.is_finite() && (yours - expected).abs() <= SAME * expected
}

/// Whether `yours` is the cheapest of the splits that `may` be chosen, by this cost.
fn is_cheapest(query: &BinSplitQuery, yours: &BinSplit, cost: Cost, may: impl Fn(&BinSplit) -> bool) -> bool {
    let splits: Vec<_> = splits(query).into_iter().filter(|(split, _)| may(split)).collect();
    let least = splits.iter().map(|(_, sides)| cost(sides)).fold(f64::INFINITY, f64::min);
    splits.iter().any(|(split, sides)| {
        (split.axis, split.bin) == (yours.axis, yours.bin) && cost(sides) <= least * (1.0 + SAME)
    })
}

/// The splits of each axis up to the first that costs more than the cheapest one before it, of all axes or of its own, or as much.
/// Those that leave the left side without primitives are skipped, or end the axis as well.
fn up_to_a_minimum(query: &BinSplitQuery, of_all: bool, skips: bool, at_equal: bool) -> Vec<(u32, u32)> {
    let (mut tried, mut best) = (Vec::new(), f64::INFINITY);
    let all = splits(query);
    for axis in 0..3 {
        best = if of_all { best } else { f64::INFINITY };
        for bin in 1..query.n_bins {
            let found = all.iter().find(|(split, _)| (split.axis, split.bin) == (axis, bin));
            let cost = found.map_or(f64::INFINITY, |(_, sides)| right_cost(sides));
            if cost > best || at_equal && cost == best && !(skips && cost == f64::INFINITY) {
                break;
            }
            best = cost;
            tried.push((axis, bin));
        }
    }
    tried
}

/// The cost of the cheapest split of primitives between the bins of a grid.
pub(super) fn least_between_bins(primitives: &[PrimitiveBox], grid: &BinGrid) -> f64 {
    let bounds = |one: &PrimitiveBox| Aabb::new(one.low().into(), one.high().into());
    let place = |one: &PrimitiveBox, axis| bin_of(one, grid, axis, Rounding::Right) as u8;
    let placed = primitives.iter().map(|one| (bounds(one), [0, 1, 2].map(|axis| place(one, axis))));
    let query = bins_of(&placed.collect::<Vec<_>>(), grid.n_bins);
    splits(&query).iter().map(|(_, sides)| right_cost(sides)).fold(f64::INFINITY, f64::min)
}

fn mistakes(query: &BinSplitQuery, yours: &Option<BinSplit>) -> Vec<(bool, &'static str)> {
    let is_of = |cost: Cost, may: &dyn Fn(&BinSplit) -> bool| match yours {
        Some(yours) => is_cheapest(query, yours, cost, may),
        None => !splits(query).iter().any(|(split, _)| may(split)),
    };
    let last = query.n_bins - 1;
    let of_fewer = |may: &dyn Fn(&BinSplit) -> bool| is_of(right_cost, may);
    let mut mistakes = vec![
        (of_fewer(&|split| split.axis == 0), "only the axis x is tried"),
        (of_fewer(&|split| split.axis == 1), "only the axis y is tried"),
        (of_fewer(&|split| split.axis == 2), "only the axis z is tried"),
        (of_fewer(&|split| split.bin > 1), "the split behind the first bin is not tried"),
        (of_fewer(&|split| split.bin < last), "the split before the last bin is not tried"),
    ];
    for n in 0..8 {
        let [of_all, skips, at_equal] = [1, 2, 4].map(|bit| n & bit > 0);
        let tried = up_to_a_minimum(query, of_all, skips, at_equal);
        let text = "the search ends at the first split that costs more than the one before: a later one may cost less";
        mistakes.push((of_fewer(&|split| tried.contains(&(split.axis, split.bin))), text));
    }
    let next = yours.as_ref().map(|yours| BinSplit { bin: yours.bin + 1, ..*yours });
    mistakes.push((
        next.map_or_else(|| of_fewer(&|_| true), |next| is_cheapest(query, &next, right_cost, |_| true)),
        "the bin is the last one of the left side: return the first one of the right side",
    ));
    mistakes.push((is_of(|sides| 1.0 / right_cost(sides), &|_| true), "the most expensive split is chosen"));
    // A returned cost that is known shows by which cost the split was chosen.
    let found = yours.as_ref().and_then(|yours| Some((f64::from(yours.cost), sides_of(query, yours)?)));
    let returns = |cost: Cost| found.is_some_and(|(yours, sides)| is_same(yours, cost(&sides)));
    let is_known = returns(right_cost) || WRONG_COSTS.iter().any(|(cost, _)| returns(*cost));
    let may = |cost: Cost| !is_known || returns(cost);
    mistakes.extend(WRONG_COSTS.map(|(cost, text)| (may(cost) && is_of(cost, &|_| true), text)));
    mistakes
}

fn input(query: &BinSplitQuery) -> String {
    let n = query.n_bins as usize;
    let axis = |bins: &[Bin]| bins[..n].iter().map(|bin| bin.count.to_string()).collect::<Vec<_>>().join(" ");
    let [x, y, z] = [0, 1, 2].map(|i| axis(&query.bins.0[i]));
    format!("cheapest_split of {n} bins with these counts: x: {x}, y: {y}, z: {z}")
}

fn describe(split: &Option<BinSplit>) -> String {
    match split {
        Some(split) => format!("axis {}, bin {}, cost {}", split.axis, split.bin, split.cost),
        None => "None".into(),
    }
}

fn judge_choice(query: &BinSplitQuery, yours: &Option<BinSplit>) -> CheckResult {
    let all = splits(query);
    let best = all.iter().min_by(|(_, p), (_, q)| right_cost(p).total_cmp(&right_cost(q)));
    let expected = match (yours, best) {
        (None, None) => return Ok(()),
        (Some(_), None) => "None: every split leaves one side without primitives".into(),
        (Some(split), Some(_)) if is_cheapest(query, split, right_cost, |_| true) => return Ok(()),
        (_, Some((split, sides))) => {
            format!("axis {}, bin {}, cost {}", split.axis, split.bin, right_cost(sides))
        }
    };
    let is_inside = |split: &BinSplit| split.axis < 3 && (1..query.n_bins).contains(&split.bin);
    let is_free = best.is_some_and(|(_, sides)| right_cost(sides) == 0.0);
    let mistakes = [
        "a side without primitives is no side: leave such splits out"
            .when(yours.as_ref().is_some_and(|split| is_inside(split) && sides_of(query, split).is_none())),
        (is_free && yours.is_none(), "boxes without area have the cost 0, which is a cost like any other"),
    ];
    Err(Broken::with_texts(input(query), describe(yours), expected, "each split").explained_by(mistakes))
}

fn judge_choices(trial: &Trial<'_>, queries: &[BinSplitQuery]) -> Vec<CheckResult> {
    let answers = trial.kit.cheapest_split(queries);
    compare_formulas(queries, answers, |query, yours| judge_choice(query, &yours), mistakes)
}

pub(super) fn cheapest_split_is_the_cheapest(trial: &Trial<'_>) -> CheckResult {
    trial.forall(250, queries(), |queries| judge_choices(trial, queries))
}

pub(super) fn cheapest_split_returns_its_cost(trial: &Trial<'_>) -> CheckResult {
    trial.forall(200, queries(), |queries| {
        let judge = |query: &BinSplitQuery, yours: Option<BinSplit>| {
            let Some(split) = yours else {
                // Whether there is a split is decided by other checks, but `None` has no cost to judge.
                let none = splits(query).is_empty();
                let broken = || Broken::with_texts(input(query), "None", "a split", "each split");
                return if none { Ok(()) } else { Err(broken()) };
            };
            let expected = sides_of(query, &split).map_or(f64::INFINITY, |sides| right_cost(&sides));
            if is_same(split.cost.into(), expected) {
                return Ok(());
            }
            let expected = format!("the cost {expected} of this split");
            Err(Broken::with_texts(input(query), describe(&yours), expected, "double precision"))
        };
        let formulas = |query: &BinSplitQuery, yours: &Option<BinSplit>| {
            let sides = yours.as_ref().and_then(|split| sides_of(query, split));
            let gives = |factor: f64, cost: Cost| match (yours, &sides) {
                (Some(split), Some(sides)) => is_same(split.cost.into(), factor * cost(sides)),
                _ => yours.is_none(),
            };
            let mut mistakes = vec![(
                gives(2.0, right_cost),
                "the areas are whole surface areas: half of them is enough, and is what is asked for",
            )];
            mistakes.extend(WRONG_COSTS.map(|(cost, text)| (gives(1.0, cost), text)));
            mistakes
        };
        compare_formulas(queries, trial.kit.cheapest_split(queries), judge, formulas)
    })
}

pub(super) fn cheapest_split_leaves_no_side_empty(trial: &Trial<'_>) -> CheckResult {
    // Few bins contain primitives: on some axes only one, on some none but the first or the last.
    let crowded = (placed(), 0..6u8).prop_map(|((bounds, places), kind)| {
        let few = match kind {
            0 => [0, 0, 0],
            1 => [places[0] % 2 * 15, 0, 0],
            2 => [0, places[1] % 2, 3],
            3 => [5, 5, places[2] % 2 * 4],
            _ => [2, 2, 2],
        };
        (bounds, few)
    });
    let few = prop::collection::vec(crowded, 0..5).prop_map(|placed| bins_of(&placed, 16));
    // Two equal points in the first and in the last bin: the cost is 0.
    let point = Aabb::new(Vec3::ONE, Vec3::ONE);
    let apart = bins_of(&[(point, [0; 3]), (point, [15; 3])], 16);
    let together = bins_of(&[(point, [7; 3]), (point, [7; 3])], 16);
    trial.forall_and(&[apart, together], 200, few, |queries| judge_choices(trial, queries))
}
