//! `build_binned`.

use super::bars::sweep_cost;
use super::bins::{grid_over, primitives};
use super::scenes::scenes;
use super::splits::least_between_bins;
use super::trees::{boxes, broken_by, cost, fault, from_leaves, ranges};
use checks::prelude::*;
use checks::tree::{around, half_area};
use oracle::splitmix::Random;
use raykata::bvh::DEEPEST_SPLIT;
use raykata::wide::{FlatNode, FlatTree, PrimitiveBox};

pub(super) fn describe(boxes: &[Aabb]) -> String {
    format!("build_binned of {} boxes", boxes.len())
}

/// Judges a tree by its layout and its boxes.
pub(super) fn judge_tree(boxes: &[Aabb], tree: &FlatTree) -> CheckResult {
    fault(tree, boxes)
        .map_or(Ok(()), |fault| Err(broken_by(fault, describe(boxes), "the nodes of a tree without faults")))
}

pub(super) fn build_binned_holds_every_primitive_once(trial: &Trial<'_>) -> CheckResult {
    trial.each(300, boxes(60), <dyn Kit>::build_binned, |boxes, tree| judge_tree(boxes, &tree))
}

/// The boxes below each node of a tree without faults: the smallest box around the boxes of its primitives.
fn tight(boxes: &[Aabb], tree: &FlatTree) -> Vec<Aabb> {
    let leaf = |_, node: &FlatNode| {
        let ids = &tree.order[node.first as usize..(node.first + node.count) as usize];
        around(ids.iter().map(|&id| &boxes[id as usize]).filter(|bounds| !bounds.is_empty()))
    };
    from_leaves(tree, leaf, |_, left, right| around([&left, &right]))
}

fn judge_tight(boxes: &[Aabb], tree: &FlatTree) -> CheckResult {
    judge_tree(boxes, tree)?;
    let tight = tight(boxes, tree);
    for (index, (node, expected)) in tree.nodes.iter().zip(&tight).enumerate() {
        let yours = node.bounds();
        if yours == *expected || yours.is_empty() && expected.is_empty() {
            continue;
        }
        let has_origin = yours == around([expected, &Aabb::new(Vec3::ZERO, Vec3::ZERO)]);
        let of = |bounds: &Aabb| format!("{:?}..{:?} for node {index}", bounds.min, bounds.max);
        let broken =
            Broken::with_texts(describe(boxes), of(&yours), of(expected), "the box around its primitives");
        return Err(broken.explained_by([
            (has_origin, "the boxes contain the origin: start with the empty box, BoxA::EMPTY"),
            (index > 0 && yours == tree.nodes[0].bounds(), "every node has the box of the root"),
        ]));
    }
    Ok(())
}

pub(super) fn build_binned_boxes_are_tight(trial: &Trial<'_>) -> CheckResult {
    // Boxes away from the origin, of which some are flat.
    let moved = boxes(40).prop_map(|boxes| {
        let shift = Vec3::splat(20.0);
        boxes.iter().map(|one| Aabb::new(one.min + shift, one.max + shift)).collect::<Vec<_>>()
    });
    trial.each(200, moved, <dyn Kit>::build_binned, |boxes, tree| judge_tight(boxes, &tree))
}

/// A name, a set of boxes, the sizes of the leaves that its tree must have, and those that each of [`KNOWN`] gives: the same (`=`),
/// more (`+`), fewer (`-`), or one leaf per half (`2`).
type Choice = (&'static str, Vec<Aabb>, Vec<u32>, [u8; KNOWN.len()]);

/// The known mistakes, the most specific one first.
const KNOWN: [&str; 8] = [
    "the costs count single primitives: a leaf pays for whole blocks, block_cost",
    "NODE_COST is left out: visiting a node costs something, too",
    "NODE_COST is not multiplied by the area of the node",
    "a node of at most BLOCK primitives becomes a leaf",
    "a node of at most BLOCK primitives is divided where a split is cheaper: it is a leaf at any cost",
    "a node of MAX_LEAF primitives is divided: only one of more than MAX_LEAF never is a leaf",
    "a node is split although a leaf is not more expensive",
    "a node becomes a leaf although a split is cheaper",
];

/// The number of [`KNOWN`] that are formulas.
const FORMULAS: usize = 6;

/// The cases in which a leaf, or a split, is cheaper by at least a hundredth of the cost of the leaf.
fn choices(random: &mut Random) -> Vec<Choice> {
    // Bars along x from 0 to `length`, or from 1 - `length` to 1, whose ends differ by up to a thousandth.
    let mut bars = |n: usize, length: f32, from_right: bool| -> Vec<Aabb> {
        let bar = |_| {
            let end = length - 1e-3 * random.unit();
            let (low, high) = if from_right { (1.0 - end, 1.0) } else { (0.0, end) };
            Aabb::new(vec3(low, 0.0, 0.0), vec3(high, 1.0, 1.0))
        };
        (0..n).map(bar).collect()
    };
    let mut pair = |n: usize, m: usize, length: f32| [bars(n, length, false), bars(m, length, true)].concat();
    let tie = |low: f32| Aabb::new(vec3(low, 0.0, 0.0), vec3(low + 14.0, 1.0, 0.0));
    let ties = [vec![tie(0.0); 6], vec![tie(2.0); 6]].concat();
    let bar = |length: f32| Aabb::new(Vec3::ZERO, vec3(length, 1.0, 1.0));
    let nine = [vec![bar(0.955); 9], vec![bar(1.0)]].concat();
    let apart = |x: f32| Aabb::new(Vec3::splat(9.0 * x), Vec3::splat(9.0 * x + 1.0));
    let eight = (0..8).map(|i| apart(i as f32)).collect();
    // Half the surface area of a bar is 1 + 2 · length, and that of all is 3.
    vec![
        ("two groups of eight that are far apart", pair(8, 8, 0.2), vec![8, 8], *b"===+===-"),
        ("eight boxes at one end and one at the other", pair(8, 1, 0.1), vec![1, 8], *b"===+===-"),
        // As a leaf 2 · 3; split 0.25 · 3 + 2 · 2.75. By primitives 12 · 3 and 0.25 · 3 + 12 · 2.75.
        ("two groups of six that overlap by three quarters", pair(6, 6, 0.875), vec![12], *b"222+==+="),
        // As a leaf 2 · 16; split 0.25 · 16 + 2 · 14: equal, and all of these numbers are exact.
        ("two groups of six flat boxes that overlap by six sevenths", ties, vec![12], *b"222+==+="),
        // As a leaf 2 · 3; split 0.25 · 3 + 2 · 2.85. By primitives 16 · 3 and 0.25 · 3 + 16 · 2.85.
        ("two groups of eight that overlap nearly", pair(8, 8, 0.925), vec![16], *b"222===+="),
        // As a leaf 2 · 3; split 0.25 · 3 + 2 · 2.93, or 0.25 + 2 · 2.93.
        ("two groups of eight that overlap even more", pair(8, 8, 0.965), vec![16], *b"22====+="),
        // As a leaf 4 · 3; split 0.25 · 3 + 4 · 2.99 at best.
        ("two groups of 16 that overlap but for a hundredth", pair(16, 16, 0.995), vec![32], *b"=+===++="),
        // As a leaf 2 · 3; split 0.25 · 3 + 2 · 2.91 + 3, because bins do not separate the nine.
        ("nine equal boxes in a larger one", nine, vec![10], *b"======+="),
        ("twenty equal boxes", vec![bar(1.0); 20], vec![20], *b"======+="),
        ("eight boxes that are far apart", eight, vec![8], *b"===++==="),
    ]
}

pub(super) fn build_binned_makes_leaves_that_pay(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 20);
    let choices = choices(&mut random);
    let sets: Vec<Vec<Aabb>> = choices.iter().map(|(_, boxes, ..)| boxes.clone()).collect();
    let answers = trial.kit.build_binned(&sets);
    all_hold(compare(&choices, answers, |(what, boxes, leaves, mistakes), tree| {
        judge_tree(boxes, &tree)?;
        let mut sizes: Vec<u32> =
            tree.nodes.iter().filter(|node| node.is_leaf()).map(|node| node.count).collect();
        sizes.sort_unstable();
        let gives = |mistake: u8| match mistake {
            b'+' => sizes.len() > leaves.len(),
            b'-' => sizes.len() < leaves.len(),
            b'2' => sizes == [boxes.len() as u32 / 2; 2],
            b'=' => sizes == *leaves,
            other => unreachable!("`{}` stands for no leaves", char::from(other)),
        };
        let [yours, expected] = [&sizes, leaves].map(|sizes| format!("leaves of {sizes:?}"));
        let given: Vec<_> = mistakes.map(gives).into_iter().zip(KNOWN).collect();
        let (formulas, shown) = given.split_at(FORMULAS);
        let input = format!("build_binned of {what}");
        let broken = || {
            Broken::with_texts(input, yours, expected, "NODE_COST and block_cost")
                .explained_by(shown.to_vec())
        };
        unless(sizes == *leaves, broken).formulas(formulas.to_vec())
    }))
}

pub(super) fn build_binned_costs_little_more_than_a_sweep(trial: &Trial<'_>) -> CheckResult {
    for (name, boxes) in scenes() {
        let sweep = sweep_cost(name);
        let tree = trial.kit.build_binned(std::slice::from_ref(&boxes)).remove(0);
        judge_tree(&boxes, &tree)?;
        let yours = cost(&tree);
        if yours > 1.05 * sweep {
            let input = format!("build_binned of {} boxes: {name}", boxes.len());
            let most = format!("at most {:.3}, 1.05 times that of a sweep", 1.05 * sweep);
            let source = "the surface area heuristic";
            // The large nodes, and those of them that are divided in half.
            let ranges = ranges(&tree);
            let n = |node: u32| ranges[node as usize].1;
            let large = || tree.nodes.iter().enumerate().filter(|(index, _)| n(*index as u32) > 48);
            let halved = large().filter(|(_, node)| n(node.first).abs_diff(n(node.first + 1)) <= 1).count();
            let broken = Broken::with_texts(input, format!("cost {yours:.3}"), most, source);
            let is_by = |n: u32| is_divided_by_bins(&tree, &boxes, n);
            return Err(broken.explained_by([
                "every node is divided in half: divide it at the cheapest split between bins"
                    .when(halved == large().count()),
                "nodes are divided in half although a split is possible: the bins lie over the centroids of the node"
                    .when(2 * halved > large().count()),
                "the nodes are divided between few bins: use up to MAX_BINS at a large node"
                    .when([2, 3, 4, 5, 6, 8].into_iter().any(is_by)),
            ]));
        }
    }
    Ok(())
}

/// Whether the large nodes of a tree are divided at the cheapest split between `n` bins per axis. Rounding may put a centroid into
/// the bin beside its own, so one in ten may have another cost.
fn is_divided_by_bins(tree: &FlatTree, boxes: &[Aabb], n: u32) -> bool {
    let ranges = ranges(tree);
    let side = |index: usize| half_area(&tree.nodes[index].bounds()) * f64::from(ranges[index].1.div_ceil(8));
    let all = primitives(boxes);
    let (mut same, mut different) = (0, 0);
    for (index, node) in tree.nodes.iter().enumerate().filter(|&(index, _)| ranges[index].1 > 48) {
        let ids = &tree.order[ranges[index].0 as usize..][..ranges[index].1 as usize];
        let own: Vec<PrimitiveBox> = ids.iter().map(|&id| all[id as usize]).collect();
        let grid = grid_over(&own, n);
        let least = least_between_bins(&own, &grid);
        let yours = side(node.first as usize) + side(node.first as usize + 1);
        if least.is_finite() {
            *(if (yours - least).abs() <= 1e-5 * least { &mut same } else { &mut different }) += 1;
        }
    }
    same > 9 * different
}

/// The tree over boxes on which a builder may panic.
fn build(trial: &Trial<'_>, boxes: &[Aabb], input: String) -> Result<FlatTree, Broken> {
    match kit_error::catch(|| trial.kit.build_binned(&[boxes.to_vec()]).remove(0)) {
        Ok(tree) => Ok(tree),
        Err(KitError::Panicked { message, place }) => {
            let panic = format!("a panic at {place}: {message}");
            Err(Broken::with_texts(input, panic, "a tree", "the definition"))
        }
        Err(error) => kit_error::unwind(error),
    }
}

/// Builds a tree over boxes on which a builder may never end.
fn build_of(trial: &Trial<'_>, what: &str, boxes: Vec<Aabb>) -> CheckResult {
    let input = format!("build_binned of {what}");
    let tree = build(trial, &boxes, input.clone())?;
    judge_tree(&boxes, &tree).map_err(|broken| Broken { input: input.clone(), ..broken })?;
    // From depth DEEPEST_SPLIT on, each inner node is halved. Parents stand before their children.
    let sizes = from_leaves(&tree, |_, node| node.count, |_, left, right| left + right);
    let mut depths = vec![0; tree.nodes.len()];
    for (node, index) in tree.nodes.iter().zip(0..).filter(|(node, _)| !node.is_leaf()) {
        let (left, depth): (usize, usize) = (node.first as usize, depths[index]);
        (depths[left], depths[left + 1]) = (depth + 1, depth + 1);
        if depth >= DEEPEST_SPLIT && sizes[left].abs_diff(sizes[left + 1]) > 1 {
            let yours =
                format!("{} and {} primitives below a node at depth {depth}", sizes[left], sizes[left + 1]);
            let broken = Broken::with_texts(input, yours, "halves".to_owned(), "counted");
            return Err(broken.because(
                "each level splits off few primitives: from depth DEEPEST_SPLIT on divide them in half",
            ));
        }
    }
    Ok(())
}

pub(super) fn build_binned_ends_where_centroids_are_equal(trial: &Trial<'_>) -> CheckResult {
    let x = trial.varied(1.0, 0.25..8f32);
    let cube = |half: f32| Aabb::new(Vec3::splat(x - half), Vec3::splat(x + half));
    let n = trial.about(1000);
    build_of(trial, &format!("{n} equal boxes"), vec![cube(1.0); n])?;
    build_of(trial, "33 equal boxes", vec![cube(1.0); 33])?;
    build_of(trial, "500 boxes around one point", (1..=500).map(|i| cube(i as f32)).collect())?;
    build_of(trial, "600 equal points", vec![Aabb::new(Vec3::splat(x), Vec3::splat(x)); 600])?;
    let line = (0..300).map(|i| Aabb::new(vec3(i as f32, x, x), vec3(i as f32 + x, x, x))).collect();
    build_of(trial, "300 segments along a line", line)
}

pub(super) fn build_binned_is_not_too_deep(trial: &Trial<'_>) -> CheckResult {
    let x = trial.varied(1.0, 0.25..8f32);
    // A split between equal bins separates the largest few of these boxes from the others.
    let corner = |i: i32| Aabb::new(Vec3::ZERO, Vec3::splat(x * 1.35f32.powi(i)));
    let what = "200 boxes with a common corner, each 1.35 times as large as the one before";
    build_of(trial, what, (0..200).map(corner).collect())?;
    // On the other side of the origin, the many points are the second side of each split.
    let points = points_on_axes(x);
    build_of(
        trial,
        "600 points on the three axes, each at half the distance of the one before",
        points.clone(),
    )?;
    build_of(trial, "these points on the other side of the origin", mirrored(&points))?;
    let [crowd, other] = crowds(x);
    build_of(trial, "540 of these points, and 4000 at the origin", crowd)?;
    build_of(trial, "4540 such points on the other side of the origin", other)
}

/// 600 points. A split across an axis separates four at most, because the next one has a sixteenth of the coordinate. Without a
/// limit, the tree has about 150 levels.
fn points_on_axes(x: f32) -> Vec<Aabb> {
    let at = |i: i32| x * 2f32.powi(60 - i / 3) * Vec3::AXES[i as usize % 3];
    (0..600).map(at).map(|at| Aabb::new(at, at)).collect()
}

fn mirrored(points: &[Aabb]) -> Vec<Aabb> {
    points.iter().map(|point| Aabb::new(-point.max, -point.min)).collect()
}

/// 540 of these points with 4000 at the origin, so that each of the splits is one of a large node, which a student may fork; and
/// their mirror images. All costs are finite: the largest 60 points are left out.
pub(super) fn crowds(x: f32) -> [Vec<Aabb>; 2] {
    let crowd = [&points_on_axes(x)[60..], &[Aabb::new(Vec3::ZERO, Vec3::ZERO); 4000]].concat();
    let other = mirrored(&crowd);
    [crowd, other]
}
