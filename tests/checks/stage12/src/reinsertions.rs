//! `reinsert`: the leaves, the boxes and the cost of an improved tree.

use super::bars::reinserted_cost;
use super::scenes::scenes;
use super::trees::{cost, drawn_tree, drawn_trees, fault, in_morton_order, tree_in_order};
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::compare;
use checks::tree::around;
use glam::{Vec3, vec3};
use proptest::prelude::*;
use raykata::aabb::Aabb;
use raykata::kit::{KitError, ReinsertQuery, kit_error};
use raykata::wide::FlatTree;
use std::collections::BTreeSet;

/// A tree over boxes, and the largest number of moves.
#[derive(Clone, Debug)]
pub(super) struct Case {
    pub boxes: Vec<Aabb>,
    pub query: ReinsertQuery,
}

impl Case {
    pub fn new(boxes: Vec<Aabb>, tree: FlatTree, most_moves: u32) -> Case {
        Case { boxes, query: ReinsertQuery { tree, most_moves } }
    }

    fn describe(&self) -> String {
        let leaves = self.query.tree.nodes.iter().filter(|node| node.is_leaf()).count();
        let moves = self.query.most_moves;
        format!(
            "reinsert of a tree of {leaves} leaves over {} boxes, {moves} moves at most",
            self.boxes.len()
        )
    }

    pub fn broken(&self, yours: String, expected: impl Into<String>, source: &'static str) -> Broken {
        Broken::with_texts(self.describe(), yours, expected, source)
    }
}

pub(super) fn ask(trial: &Trial<'_>, cases: &[Case]) -> Vec<FlatTree> {
    let queries: Vec<ReinsertQuery> = cases.iter().map(|case| case.query.clone()).collect();
    trial.kit.reinsert(&queries)
}

fn cases(most: usize) -> impl Strategy<Value = Case> + Clone {
    (drawn_trees(most), 0..4u32).prop_map(|((boxes, tree), few)| {
        let most_moves = if few == 0 { 3 } else { tree.nodes.len() as u32 };
        Case::new(boxes, tree, most_moves)
    })
}

/// The leaves of a tree without faults: the primitives of each.
fn leaves(tree: &FlatTree) -> BTreeSet<&[u32]> {
    let of = |first: u32, count: u32| &tree.order[first as usize..(first + count) as usize];
    tree.nodes.iter().filter(|node| node.is_leaf()).map(|node| of(node.first, node.count)).collect()
}

/// Judges the layout of a tree, and its leaves.
pub(super) fn judge_leaves(case: &Case, yours: &FlatTree) -> CheckResult {
    if let Some((yours, expected, cause)) = fault(yours, &case.boxes) {
        let broken = case.broken(yours, expected, "the layout of FlatTree");
        return Err(broken.explained_by(cause.map(|text| (true, text))));
    }
    let (mine, expected) = (leaves(yours), leaves(&case.query.tree));
    let Some(stray) = mine.difference(&expected).next() else { return Ok(()) };
    let mut sorted = stray.to_vec();
    sorted.sort_unstable();
    let same = expected.iter().any(|leaf| {
        let mut leaf = leaf.to_vec();
        leaf.sort_unstable();
        leaf == sorted
    });
    Err(case
        .broken(format!("a leaf of {stray:?}"), "the leaves of the tree that was given", "the given tree")
        .explained_by([(same, "a leaf lists its primitives in another order: copy them as they are")]))
}

/// Two pairs of neighbours, of which the tree joins the wrong ones. One move makes it cheaper.
fn crossed(trial: &Trial<'_>) -> Case {
    let x = trial.varied(8.0, 2.0..64f32);
    let cube = |at: f32| Aabb::new(vec3(at, 0.0, 0.0), vec3(at + 1.0, 1.0, 1.0));
    let boxes = vec![cube(0.0), cube(4.0 * x), cube(1.0), cube(4.0 * x + 1.0)];
    let tree = tree_in_order(&boxes, vec![0, 1, 2, 3], 1, &[]);
    Case::new(boxes, tree, 4)
}

/// Demands that an obvious move is made. A function that returns the tree as it is keeps all leaves, and improves nothing.
pub(super) fn moves_something(trial: &Trial<'_>) -> CheckResult {
    let case = crossed(trial);
    let yours = ask(trial, std::slice::from_ref(&case)).remove(0);
    judge_leaves(&case, &yours)?;
    let (mine, before) = (cost(&yours), cost(&case.query.tree));
    if mine < before {
        return Ok(());
    }
    let input =
        "reinsert of two pairs of neighbours, of which the tree joins the wrong ones, 4 moves at most";
    let (mine, expected) = (format!("cost {mine:.3}"), format!("less than {before:.3}"));
    let broken = Broken::with_texts(input, mine, expected, "the surface areas");
    Err(broken.explained_by([(yours == case.query.tree, "no subtree is moved")]))
}

pub(super) fn reinsert_keeps_every_leaf(trial: &Trial<'_>) -> CheckResult {
    moves_something(trial)?;
    trial.forall(200, cases(60), |cases| {
        compare(cases, ask(trial, cases), |case, yours| judge_leaves(case, &yours))
    })
}

/// Judges the boxes: each is the smallest one around the boxes of both children.
fn judge_boxes(case: &Case, yours: &FlatTree) -> CheckResult {
    judge_leaves(case, yours)?;
    for (index, node) in yours.nodes.iter().enumerate() {
        let bounds = node.bounds();
        let expected = if node.is_leaf() {
            let of_leaf = &yours.order[node.first as usize..(node.first + node.count) as usize];
            around(of_leaf.iter().map(|&id| &case.boxes[id as usize]).filter(|bounds| !bounds.is_empty()))
        } else {
            let [left, right] =
                [node.first, node.first + 1].map(|child| yours.nodes[child as usize].bounds());
            around([&left, &right])
        };
        if bounds == expected || bounds.is_empty() && expected.is_empty() {
            continue;
        }
        let of = |bounds: &Aabb| format!("{:?}..{:?} for node {index}", bounds.min, bounds.max);
        let is_larger = bounds.contains_box(&expected);
        let broken = case.broken(of(&bounds), of(&expected), "the boxes of both children");
        return Err(broken.explained_by([(
            is_larger && !node.is_leaf(),
            "a box is larger than those of its children: fit the boxes above the old place of a subtree as well",
        )]));
    }
    Ok(())
}

pub(super) fn reinsert_fits_the_boxes(trial: &Trial<'_>) -> CheckResult {
    moves_something(trial)?;
    trial.forall(200, cases(40), |cases| {
        compare(cases, ask(trial, cases), |case, yours| judge_boxes(case, &yours))
    })
}

/// Areas in single precision have a relative error of about 2⁻²², and a student may add them in single precision.
const ROUNDING: f64 = 1e-6;

/// Judges the cost: it does not grow.
fn judge_cost(case: &Case, yours: &FlatTree) -> CheckResult {
    judge_leaves(case, yours)?;
    let (mine, before) = (cost(yours), cost(&case.query.tree));
    // The cost of a tree whose root has no area is not a number.
    if mine <= before * (1.0 + ROUNDING) || !before.is_finite() {
        return Ok(());
    }
    let broken = case.broken(
        format!("cost {mine:.6}"),
        format!("at most {before:.6}, as before"),
        "the surface areas",
    );
    Err(broken.explained_by([]))
}

pub(super) fn reinsert_never_costs_more(trial: &Trial<'_>) -> CheckResult {
    moves_something(trial)?;
    trial.forall(300, cases(60), |cases| {
        compare(cases, ask(trial, cases), |case, yours| judge_cost(case, &yours))
    })
}

/// The trees over the scenes in Morton order, with the names of the scenes and as many moves as the tree has nodes.
pub fn morton_trees() -> Vec<(&'static str, ReinsertQuery)> {
    let of_scene = |(name, boxes): (&'static str, Vec<Aabb>)| {
        let tree = in_morton_order(&boxes, 4);
        let most_moves = tree.nodes.len() as u32;
        (name, ReinsertQuery { tree, most_moves })
    };
    scenes().into_iter().map(of_scene).collect()
}

/// Judges what the moves save in the scenes, on average: at least `percent` of what the reference saves.
fn judge_saving(trial: &Trial<'_>, percent: f64) -> CheckResult {
    let (mut mine, mut expected, mut shown) = (0.0, 0.0, Vec::new());
    let cases: Vec<_> = scenes().into_iter().zip(morton_trees()).collect();
    let n = cases.len() as f64;
    for ((_, boxes), (name, query)) in cases {
        let before = cost(&query.tree);
        let case = Case { boxes, query };
        let yours = ask(trial, std::slice::from_ref(&case)).remove(0);
        judge_leaves(&case, &yours)?;
        // In percent of the cost, as a mean over six scenes.
        let saved = |after: f64| 100.0 * (1.0 - after / before);
        let of_scene = saved(cost(&yours));
        mine += of_scene / n;
        expected += saved(reinserted_cost(name)) / n;
        shown.push(format!("{name} {of_scene:.1} %"));
    }
    let least = percent / 100.0 * expected;
    if mine >= least {
        return Ok(());
    }
    let input = "reinsert, trees over six scenes in Morton order, as many moves as nodes";
    let yours = format!("{mine:.1} % of the cost are saved: {}", shown.join(", "));
    let expected = format!("at least {least:.1} %, {percent} % of what the reference saves");
    let broken = Broken::with_texts(input, yours, expected, "the surface areas");
    Err(broken.explained_by([(mine == 0.0, "no subtree is moved")]))
}

pub(super) fn reinsert_saves_half_as_much_as_the_reference(trial: &Trial<'_>) -> CheckResult {
    judge_saving(trial, 50.0)
}

pub(super) fn reinsert_saves_nine_tenths_as_much_as_the_reference(trial: &Trial<'_>) -> CheckResult {
    judge_saving(trial, 90.0)
}

/// Improves a tree on which the search may never end.
fn improved(trial: &Trial<'_>, what: &str, boxes: Vec<Aabb>, tree: FlatTree) -> Result<FlatTree, Broken> {
    let case = Case::new(boxes, tree, u32::MAX);
    let input = format!("reinsert of {what}");
    let yours = match kit_error::catch(|| ask(trial, std::slice::from_ref(&case)).remove(0)) {
        Ok(tree) => tree,
        Err(KitError::Panicked { message, place }) => {
            let panic = format!("a panic at {place}: {message}");
            return Err(Broken::with_texts(input, panic, "a tree", "the definition").explained_by([]));
        }
        Err(error) => kit_error::unwind(error),
    };
    let judged = judge_boxes(&case, &yours).and_then(|()| judge_cost(&case, &yours));
    judged.map_err(|broken| Broken { input, ..broken })?;
    Ok(yours)
}

/// Every seventh box, again and again, so that neighbours in a drawn tree are no neighbours in space.
fn tree_over(boxes: &[Aabb]) -> FlatTree {
    drawn_tree(boxes, 1, &[])
}

pub(super) fn reinsert_ends_on_special_trees(trial: &Trial<'_>) -> CheckResult {
    moves_something(trial)?;
    let x = trial.varied(1.0, 0.25..8f32);
    let cube = |half: f32| Aabb::new(Vec3::splat(x - half), Vec3::splat(x + half));
    let line = |i: i32| Aabb::new(vec3(i as f32, x, x), vec3(i as f32 + x, x, x));
    let mut sets: Vec<(&str, Vec<Aabb>)> = vec![
        ("nothing", Vec::new()),
        ("one leaf", vec![cube(1.0)]),
        ("two leaves", vec![cube(1.0), cube(0.5)]),
        ("200 equal boxes", vec![cube(1.0); 200]),
        ("200 boxes around one point", (1..=200).map(|i| cube(i as f32)).collect()),
        ("200 equal points", vec![Aabb::new(Vec3::splat(x), Vec3::splat(x)); 200]),
        ("200 segments along a line", (0..200).map(line).collect()),
    ];
    // Some boxes are empty.
    let some = |i: i32| {
        if i % 5 == 0 {
            Aabb::EMPTY
        } else {
            Aabb::new(vec3(i as f32, 0.0, x), vec3(i as f32 + 1.0, x, 2.0 * x))
        }
    };
    sets.push(("100 boxes, of which 20 are empty", (0..100).map(some).collect()));
    for (what, boxes) in sets {
        let tree = tree_over(&boxes);
        improved(trial, what, boxes, tree)?;
    }
    // A chain of 300 inner nodes.
    let boxes: Vec<Aabb> = (0..300).map(line).collect();
    let chain = drawn_tree(&boxes, 1, &[0]);
    improved(trial, "a chain of 300 nodes", boxes, chain).map(drop)
}

pub(super) fn reinsert_of_any_size(trial: &Trial<'_>) -> CheckResult {
    moves_something(trial)?;
    let boxes: Vec<Aabb> = scenes().swap_remove(0).1.into_iter().take(200).collect();
    let x = trial.varied(1.0, 0.5..1f32);
    let mut first = None;
    for exponent in [0, 70, 110, -70, -110] {
        let scale = x * 2f32.powi(exponent);
        let scaled: Vec<Aabb> = boxes.iter().map(|one| Aabb::new(scale * one.min, scale * one.max)).collect();
        let tree = tree_over(&scaled);
        let before = cost(&tree);
        let mine = cost(&improved(trial, &format!("200 boxes of size 2^{exponent}"), scaled, tree)?);
        let share = mine / before;
        // Powers of two round nothing, so the same moves are cheapest at each size. One percent is a small part of what the moves save,
        // and leaves a function free to choose between moves that save nearly the same.
        let expected = *first.get_or_insert(share);
        if (share - expected).abs() > 0.01 {
            let input = format!("reinsert of 200 boxes of size 2^{exponent}");
            let of = |share: f64| format!("{:.1} % of the cost", 100.0 * share);
            return Err(Broken::with_texts(
                input,
                of(share),
                format!("{}, as at size 1", of(expected)),
                "your own tree",
            )
            .explained_by([(
                share == 1.0 && exponent > 0,
                "areas of this size leave the range of single precision: compute them in double precision",
            )]));
        }
    }
    Ok(())
}
