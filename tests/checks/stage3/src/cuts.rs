//! The cheapest cut of the surface area heuristic, and the mistakes that give a more expensive one.

use super::divided::{Fault, boxes, divided, is_as_given, judge_splits};
use checks::prelude::*;
use checks::tree;
use raykata::bvh::{INTERSECTION_COST, PrimitiveRef, TRAVERSAL_COST};
use raykata::scene::Split;

pub(super) fn surface_area_heuristic_finds_the_cheapest_cut(trial: &Trial<'_>) -> CheckResult {
    let judge = |sets: &[Vec<Aabb>]| judge_splits(trial, Split::SurfaceArea, sets, cheapest, formulas);
    // Three large boxes on top of each other, for which a leaf is cheaper than any cut.
    let corners = [Vec3::ZERO, vec3(0.1, 0.2, 0.3), vec3(0.2, 0.1, 0.4)];
    let heap = corners.map(|corner| Aabb::new(corner, corner + 9.0)).to_vec();
    trial.forall_and(&[heap], 1000, boxes(16), judge)
}

/// The most calls of `union` per primitive, as the doc comment of the exercise states it. A pass from each side along each axis takes
/// 6, and halving the primitives again and again takes 33 for 2,000 of them.
const MOST_UNIONS: u64 = 64;

pub(super) fn surface_area_heuristic_joins_no_side_again(trial: &Trial<'_>) -> CheckResult {
    // Two heaps far apart, each of which is a side of the cheapest cut.
    let n_near = trial.varied(700, 400..600_usize);
    let spread = |i: usize, step: f32| 10.0 * (i as f32 * step).fract();
    let cube = |i: usize| {
        let x = if i < n_near { 0.0 } else { 1000.0 };
        let corner = vec3(x + spread(i, 0.618), spread(i, 0.414), spread(i, 0.732));
        Aabb::new(corner, corner + 0.1)
    };
    let [half, all] = [1000, 2000].map(|n| {
        let boxes: Vec<Aabb> = (0..n).map(cube).collect();
        trial.kit.split_surface_area(&[tree::references(&boxes)]).remove(0)
    });
    let input = format!("split_surface_area of 2,000 cubes, {n_near} of them far from the others");
    // A split that is not the cheapest one may be cheap to find.
    let is_near = |id: &u32| (*id as usize) < n_near;
    let (left, right) = all.order.split_at(all.middle.unwrap_or(0).min(all.order.len()));
    if left.is_empty() || left.iter().any(is_near) == right.iter().any(is_near) {
        let (yours, expected) = (format!("a cut before {:?}", all.middle), "a cut between the two heaps");
        return Err(Broken::with_texts(input, yours, expected, "the definition"));
    }
    let most = MOST_UNIONS * 2000;
    if all.unions <= most {
        return Ok(());
    }
    let [yours, expected] = [format!("{} calls of union", all.unions), format!("at most {most}")];
    // Twice as many primitives make four times as many calls if each cut takes a number of calls that grows with them.
    Err(Broken::with_texts(input, yours, expected, "counted")
        .explained_by(["the calls grow with the square of the number of primitives: your loop over the cuts joins a side again for each cut"
            .when(10 * all.unions >= 35 * half.unions)]))
}

const AXES: [usize; 3] = [0, 1, 2];

const ONLY_ONE: &str = "only one axis is tried: the best cut is along another";
const ONLY_Y: &str = "only one axis is tried, y: the best cut is along another";
const ONLY_Z: &str = "only one axis is tried, z: the best cut is along another";
const WITHOUT: [&str; 3] = [
    "one axis is left out, x: try the cuts along all three",
    "one axis is left out, y: try the cuts along all three",
    "one axis is left out, z: try the cuts along all three",
];
const ONLY_LONGEST: &str = "only one axis is tried, the longest: the best cut is along another";

/// The fault of a cut, if it has one. A `middle` of 0 is a leaf.
fn cheapest(_: &[PrimitiveRef], ordered: &[PrimitiveRef], middle: usize) -> Option<Fault> {
    let best = tree::least_cost(ordered, &AXES, &tree::cut_cost);
    let leaf = tree::leaf_is_cheaper(ordered, best);
    if middle == 0 {
        let expected = format!("a cut of cost {best:.4}, cheaper than a leaf");
        let mistakes =
            vec![(ordered.len() <= 4, "you make a leaf of few primitives although a cut is cheaper")];
        return (leaf == Some(false)).then_some((String::new(), expected, mistakes));
    }
    if leaf == Some(true) {
        let mistakes = vec![(true, "you return a cut in any case, but a leaf may be cheaper")];
        let yours = format!("a cut before {middle}");
        return Some((yours, "None: a leaf is cheaper than any cut".into(), mistakes));
    }
    let yours = tree::cut_cost(&ordered[..middle], &ordered[middle..]);
    // Equal centroids may be sorted in any order, which changes the cost of the cuts between them. So the check judges
    // the cost only if all centroids differ.
    (yours > best * 1.0001 + 1e-6 && centroids_differ(ordered)).then(|| {
        let describe = format!("cost {yours:.4} (cut before {middle})");
        let is_best = |[left, right]: &[Vec<PrimitiveRef>; 2]| {
            left.len() == middle && tree::cut_cost(left, right) <= best * 1.0001
        };
        let mistakes = vec![(
            AXES.iter().any(|&axis| tree::cuts(ordered, axis).iter().any(is_best)),
            "sorted along another axis than that of the best cut: sort again along that axis",
        )];
        (describe, format!("cost {best:.4}"), mistakes)
    })
}

/// Whether a leaf is cheaper than each cut that leaves at least so many primitives on either side.
fn is_leaf_without(primitives: &[PrimitiveRef], fewest: [usize; 2]) -> bool {
    let cost = with_at_least(fewest, &tree::cut_cost);
    tree::leaf_is_cheaper(primitives, tree::least_cost(primitives, &AXES, &cost)) != Some(false)
}

type Cost<'a> = &'a dyn Fn(&[PrimitiveRef], &[PrimitiveRef]) -> f64;

/// The same cost of cuts that leave at least so many primitives on either side; infinite for the others.
fn with_at_least(fewest: [usize; 2], cost: Cost<'_>) -> impl Fn(&[PrimitiveRef], &[PrimitiveRef]) -> f64 {
    move |left, right| {
        if left.len() < fewest[0] || right.len() < fewest[1] { f64::INFINITY } else { cost(left, right) }
    }
}

/// Wrong costs of a cut, each with whether the search for the cheapest cut gives this one, or a leaf if `middle` is 0.
fn wrong_costs(ordered: &[PrimitiveRef], middle: usize) -> Vec<(bool, &'static str)> {
    let edges = |part: &[PrimitiveRef]| tree::around_all(part).max - tree::around_all(part).min;
    let area = |part: &[PrimitiveRef]| 2.0 * tree::half_area(&tree::around_all(part));
    let volume = |part: &[PrimitiveRef]| edges(part).as_dvec3().element_product();
    let n = |part: &[PrimitiveRef]| part.len() as f64;
    let size = |part: &[PrimitiveRef]| f64::from(edges(part).element_sum());
    let (traversal, intersection) = (f64::from(TRAVERSAL_COST), f64::from(INTERSECTION_COST));
    let gives = |cost: Cost<'_>| {
        let least = tree::least_cost(ordered, &AXES, &cost);
        let as_leaf = intersection * area(ordered) * n(ordered);
        let as_cut = traversal * area(ordered) + intersection * least;
        match middle {
            0 => as_cut >= as_leaf * 0.9999,
            _ => as_cut <= as_leaf * 1.0001 && cost(&ordered[..middle], &ordered[middle..]) <= least * 1.0001,
        }
    };
    named![
        gives(&|left, right| area(left) + area(right)) => "your cut is the best by areas alone: the counts are left out",
        gives(&|left, right| n(left).max(n(right))) => "your cut is the best by counts alone: the areas are left out",
        gives(&|left, right| volume(left) * n(left) + volume(right) * n(right)) =>
            "your cut is the best by volumes: take the surface areas",
        gives(&|left, right| area(left) * n(left).powi(2) + area(right) * n(right).powi(2)) =>
            "the counts are squared: each area is multiplied by its count once",
        gives(&|left, right| (area(left) + area(right)) * n(left).max(n(right))) =>
            "both areas have the larger count: each side has a product of its own",
        gives(&|left, _| area(left) * n(left)) => "only the left side is counted in the cost",
        gives(&|_, right| area(right) * n(right)) => "only the right side is counted in the cost",
        gives(&|left, right| size(left) * n(left) + size(right) * n(right)) =>
            "your cut is the best by the edges of the boxes: take the surface areas",
        gives(&|left, right| area(left) * n(right) + area(right) * n(left)) =>
            "each area is multiplied by the count of the other side",
    ].to_vec()
}

/// Wrong rules, each with whether it gives this cut, or a leaf if `middle` is 0.
fn formulas(given: &[PrimitiveRef], ordered: &[PrimitiveRef], middle: usize) -> Vec<(bool, &'static str)> {
    let best = tree::least_cost(ordered, &AXES, &tree::cut_cost);
    let bounds = tree::around_all(ordered);
    let is_leaf_along = |axes: &[usize]| {
        tree::leaf_is_cheaper(ordered, tree::least_cost(ordered, axes, &tree::cut_cost)) != Some(false)
    };
    let area = tree::half_area(&bounds);
    let as_leaf = f64::from(INTERSECTION_COST) * area * ordered.len() as f64;
    let mut mistakes = match middle {
        0 => named![
            2.0 * f64::from(TRAVERSAL_COST) * area + f64::from(INTERSECTION_COST) * best >= as_leaf =>
                "the leaf is taken too soon: compare C_t A(P) + C_i (A(L) n(L) + A(R) n(R)) with C_i A(P) n(P)",
            is_leaf_without(ordered, [2, 1]) =>
                "not every cut is tried: the one behind the first primitive is left out",
            is_leaf_without(ordered, [1, 2]) => "not every cut is tried: the one before the last primitive is left out",
            is_leaf_along(&[0]) => ONLY_ONE,
            is_leaf_along(&[1]) => ONLY_Y,
            is_leaf_along(&[2]) => ONLY_Z,
            is_leaf_along(&tree::longest_axes(&bounds)) => ONLY_LONGEST,
        ].to_vec(),
        _ => cut_mistakes(given, ordered, middle),
    };
    let without = match middle {
        0 => f64::from(INTERSECTION_COST) * best >= as_leaf * 0.9999,
        _ => {
            tree::cut_cost(&ordered[..middle], &ordered[middle..]) <= best * 1.0001
                && f64::from(INTERSECTION_COST) * best <= as_leaf * 1.0001
        }
    };
    // The cuts along two axes, and the most expensive cut.
    let yours = tree::cut_cost(&ordered[..middle], &ordered[middle..]);
    for (axes, text) in [[1, 2], [0, 2], [0, 1]].into_iter().zip(WITHOUT) {
        let least = tree::least_cost(ordered, &axes, &tree::cut_cost);
        let is_cut = yours <= least * 1.0001 && tree::leaf_is_cheaper(ordered, least) != Some(true);
        mistakes.push((if middle == 0 { is_leaf_along(&axes) } else { is_cut }, text));
    }
    let most = -tree::least_cost(ordered, &AXES, &|left, right| -tree::cut_cost(left, right));
    let is_dearest = match middle {
        0 => tree::leaf_is_cheaper(ordered, most) != Some(false) || !centroids_differ(ordered),
        _ => yours >= most * 0.9999,
    };
    mistakes.push((is_dearest, "you keep the cut of the highest cost: keep the one of the lowest"));
    mistakes.push((without, "TRAVERSAL_COST is left out, so a cut always looks cheaper"));
    mistakes.extend(wrong_costs(ordered, middle));
    // Equal centroids may be sorted in any order, so each rule may give such a cut.
    let open = middle > 0 && !centroids_differ(ordered) && tree::leaf_is_cheaper(ordered, best) != Some(true);
    mistakes.into_iter().map(|(gives, text)| (gives || open, text)).collect()
}

/// The mistakes that make this cut the best one.
fn cut_mistakes(
    given: &[PrimitiveRef],
    ordered: &[PrimitiveRef],
    middle: usize,
) -> Vec<(bool, &'static str)> {
    let right_cost: Cost<'_> = &tree::cut_cost;
    // Whether this cut is the best one along these axes by this cost, among the cuts that leave so many on either side.
    let is_least_of = |axes: &[usize], cost: Cost<'_>, fewest: [usize; 2]| {
        let counts = with_at_least(fewest, cost);
        let yours = counts(&ordered[..middle], &ordered[middle..]);
        yours <= tree::least_cost(ordered, axes, &counts) * 1.0001
    };
    let is_best_along =
        |axis: usize| divided(ordered, middle, axis) && is_least_of(&[axis], right_cost, [1, 1]);
    let longest = tree::longest_axes(&tree::around_all(ordered));
    // The least cost of the cuts between so many equal bins of centroids, along all axes.
    let binned = |n: f32| {
        let cost = |axis: usize, cut: f32| {
            let at = |p: &PrimitiveRef| p.centroid[axis];
            let (low, high) =
                ordered.iter().fold((f32::MAX, f32::MIN), |(l, h), p| (l.min(at(p)), h.max(at(p))));
            let is_left = |p: &PrimitiveRef| (n * (at(p) - low) / (high - low)).min(n - 1.0).floor() < cut;
            let (left, right): (Vec<_>, Vec<_>) = ordered.iter().copied().partition(is_left);
            if left.is_empty() || right.is_empty() { f64::INFINITY } else { tree::cut_cost(&left, &right) }
        };
        let cuts = AXES.iter().flat_map(|&axis| (1..n as u32).map(move |cut| (axis, cut as f32)));
        cuts.map(|(axis, cut)| cost(axis, cut)).fold(f64::INFINITY, f64::min)
    };
    let yours = tree::cut_cost(&ordered[..middle], &ordered[middle..]);
    let of_bins = [8.0, 12.0, 16.0, 32.0].map(|n| {
        "you try the cuts between some equal bins only: try each cut"
            .when((yours / binned(n) - 1.0).abs() < 1e-4)
    });
    let others = named![
        is_as_given(given, ordered) => "the primitives are not sorted: you cut them as they come",
        is_best_along(0) => ONLY_ONE,
        is_best_along(1) => ONLY_Y,
        is_best_along(2) => ONLY_Z,
        longest.into_iter().any(is_best_along) => ONLY_LONGEST,
        is_least_of(&AXES, right_cost, [2, 1]) =>
            "not every cut is tried: the one behind the first primitive is left out",
        is_least_of(&AXES, right_cost, [1, 2]) =>
            "not every cut is tried: the one before the last primitive is left out",
    ];
    others.into_iter().chain(of_bins).collect()
}

pub(super) fn centroids_differ(primitives: &[PrimitiveRef]) -> bool {
    (0..3).all(|axis| {
        let mut at: Vec<f32> = primitives.iter().map(|p| p.centroid[axis]).collect();
        at.sort_by(f32::total_cmp);
        at.windows(2).all(|pair| pair[0] < pair[1])
    })
}
