//! `collapse`.

use super::trees::{Fault, broken_by, drawn_tree, drawn_trees, from_leaves};
use checks::Trial;
use checks::broken::{Broken, CheckResult, all_hold};
use checks::judge::{compare, compare_formulas};
use checks::tree::half_area;
use glam::Vec3;
use oracle::splitmix::Random;
use proptest::strategy::Strategy;
use raykata::aabb::Aabb;
use raykata::wide::{BLOCK, Child, ChildContents, FlatTree, NO_PRIMITIVE, WideTree};

/// For each node of a flat tree its parent; the root is its own.
fn parents(tree: &FlatTree) -> Vec<usize> {
    let mut parents = vec![0; tree.nodes.len()];
    for (index, node) in tree.nodes.iter().enumerate().filter(|(_, node)| !node.is_leaf()) {
        parents[node.first as usize] = index;
        parents[node.first as usize + 1] = index;
    }
    parents
}

/// For each node of a flat tree the number of leaves below it, or 1 for a leaf.
fn n_leaves(tree: &FlatTree) -> Vec<usize> {
    from_leaves(tree, |_, _| 1, |_, left, right| left + right)
}

/// The nodes of the flat tree that the children of each wide node stand for.
type Meaning = Vec<Vec<usize>>;

const SPLIT_LEAF: &str = "a leaf of the binary tree must become one leaf of the wide tree, whatever its size";

/// The leaves and places of a wide tree over `tree`, or the first fault.
fn meaning(tree: &FlatTree, wide: &WideTree) -> Result<Meaning, Fault> {
    let wrong = |yours: String, expected: &str| Err((yours, expected.to_owned(), None));
    if tree.nodes.is_empty() || wide.nodes.is_empty() {
        let yours = format!("{} wide nodes for {} nodes", wide.nodes.len(), tree.nodes.len());
        let same = tree.nodes.is_empty() && wide.nodes.is_empty();
        return if same { Ok(Vec::new()) } else { wrong(yours, "nodes for nodes, and none for none") };
    }
    // Find the leaf of each primitive.
    let mut leaf_of = vec![0; tree.order.len()];
    for (index, leaf) in tree.nodes.iter().enumerate().filter(|(_, node)| node.is_leaf()) {
        let range = leaf.first as usize..(leaf.first + leaf.count) as usize;
        tree.order[range].iter().for_each(|&id| leaf_of[id as usize] = index);
    }
    let (parents, n_leaves) = (parents(tree), n_leaves(tree));
    let mut meaning = vec![Vec::new(); wide.nodes.len()];
    let mut times = vec![0; tree.nodes.len()];
    let (mut reached, mut used) = (vec![0; wide.nodes.len()], vec![0; wide.blocks.len()]);
    reached[0] = 1;
    // A parent precedes its children, so in reverse order the meaning of each child is known.
    for (index, node) in wide.nodes.iter().enumerate().rev() {
        let n = node.children.iter().position(|child| *child == Child::EMPTY).unwrap_or(8);
        if node.children[n..].iter().any(|child| *child != Child::EMPTY)
            || node.occupied != (1 << n) - 1
            || n == 0
        {
            let yours = format!(
                "node {index} has the children {:?}, occupied {:#010b}",
                node.children, node.occupied
            );
            return wrong(yours, "the children first, each put in by WideNode::set, then the empty places");
        }
        for place in 0..n {
            let (stands_for, bounds) = match node.children[place].contents() {
                ChildContents::Inner(below) => {
                    let below = below as usize;
                    if below <= index || below >= wide.nodes.len() {
                        let yours =
                            format!("a child of node {index} is node {below} of {}", wide.nodes.len());
                        return wrong(yours, "a parent has a smaller index than its children");
                    }
                    reached[below] += 1;
                    let Some(top) = common(&parents, &meaning[below]) else { continue };
                    if meaning[below].iter().map(|&one| n_leaves[one]).sum::<usize>() != n_leaves[top] {
                        let yours = format!("node {below} holds leaves of different parts of the tree");
                        return wrong(yours, "everything below one node of the binary tree");
                    }
                    (top, tree.nodes[top].bounds())
                }
                ChildContents::Leaf { block, count } => {
                    let blocks = block as usize..block as usize + (count as usize).div_ceil(BLOCK);
                    let Some(lanes) = wide.blocks.get(blocks.clone()) else {
                        let yours = format!("a leaf with the blocks {blocks:?} of {}", wide.blocks.len());
                        return wrong(yours, "blocks that exist");
                    };
                    used[blocks].iter_mut().for_each(|used| *used += 1);
                    let lanes: Vec<u32> = lanes.iter().flatten().copied().collect();
                    let (ids, free) = lanes.split_at(count as usize);
                    let Some(&leaf) = ids.first().and_then(|id| leaf_of.get(*id as usize)) else {
                        return wrong(format!("a leaf of {ids:?}"), "primitives that exist");
                    };
                    let node = &tree.nodes[leaf];
                    let expected = &tree.order[node.first as usize..(node.first + node.count) as usize];
                    if ids != expected || free.iter().any(|&id| id != NO_PRIMITIVE) {
                        let is_part = ids.len() < expected.len() && expected.starts_with(ids);
                        let expected = format!("{expected:?}, and NO_PRIMITIVE in the free lanes");
                        let yours = format!("a leaf with the lanes {lanes:?}");
                        return Err((yours, expected, is_part.then_some(SPLIT_LEAF)));
                    }
                    times[leaf] += 1;
                    (leaf, node.bounds())
                }
            };
            let yours = node.child_bounds(place);
            if yours != bounds {
                let of = |bounds: &Aabb| {
                    format!("{:?}..{:?} for place {place} of node {index}", bounds.min, bounds.max)
                };
                let is_of_root = yours == tree.nodes[0].bounds();
                let cause =
                    is_of_root.then_some("a place has the box of the root: it needs the box of its child");
                return Err((of(&yours), of(&bounds), cause));
            }
            meaning[index].push(stands_for);
        }
    }
    let lost = (0..tree.nodes.len()).find(|&leaf| tree.nodes[leaf].is_leaf() && times[leaf] != 1);
    if let Some(leaf) = lost {
        return wrong(format!("the leaf {leaf} of the binary tree appears {} times", times[leaf]), "once");
    }
    if reached.iter().chain(&used).any(|&times| times != 1) {
        return wrong("a node or a block that is not in use, or used twice".into(), "each exactly once");
    }
    Ok(meaning)
}

/// The deepest node of the flat tree above all of `nodes`.
fn common(parents: &[usize], nodes: &[usize]) -> Option<usize> {
    // An ancestor has a smaller index than its descendants.
    nodes.iter().copied().reduce(|mut p, mut q| {
        while p != q {
            if p > q { p = parents[p] } else { q = parents[q] }
        }
        p
    })
}

fn describe(tree: &FlatTree) -> String {
    let leaves = tree.nodes.iter().filter(|node| node.is_leaf()).count();
    format!("collapse of a tree with {leaves} leaves over {} primitives", tree.order.len())
}

fn judge_leaves(tree: &FlatTree, wide: &WideTree) -> CheckResult {
    let meaning = meaning(tree, wide);
    meaning.map_or_else(|fault| Err(broken_by(fault, describe(tree), "the binary tree")), |_| Ok(()))
}

fn trees_only(most: usize) -> impl Strategy<Value = FlatTree> + Clone {
    drawn_trees(most).prop_map(|(_, tree)| tree)
}

/// Trees with an inner node: another check judges those with one leaf or none.
fn divided_trees(most: usize) -> impl Strategy<Value = FlatTree> + Clone {
    trees_only(most).prop_filter("an inner node", |tree| tree.nodes.len() > 1)
}

pub(super) fn collapse_keeps_every_leaf(trial: &Trial<'_>) -> CheckResult {
    trial.forall(300, divided_trees(80), |trees| {
        compare(trees, trial.kit.collapse(trees), |tree, wide| judge_leaves(tree, &wide))
    })
}

pub(super) fn collapse_of_one_leaf_and_of_nothing(trial: &Trial<'_>) -> CheckResult {
    // Leaves of one primitive, of whole blocks, and of more.
    let leaf = |n: usize| drawn_tree(&vec![Aabb::new(Vec3::ZERO, Vec3::ONE); n], n, &[1]);
    let chosen: Vec<FlatTree> = [1, 4, 5, 8, 32, 0].into_iter().map(leaf).collect();
    trial.forall_and(&chosen, 60, trees_only(3), |trees| {
        compare(trees, trial.kit.collapse(trees), |tree, wide| judge_leaves(tree, &wide))
    })
}

/// Which inner child is opened next.
#[derive(Clone, Copy)]
enum Opens {
    First,
    Last,
    Smallest,
    MostLeaves,
    LargestVolume,
    GrandchildrenOnly,
}

const WRONG_RULES: [(Opens, &str); 6] = [
    (Opens::First, "the first inner child is opened, not the one with the largest surface area"),
    (Opens::Last, "the last inner child is opened, not the one with the largest surface area"),
    (Opens::Smallest, "the child with the smallest surface area is opened: take the largest"),
    (
        Opens::MostLeaves,
        "the child with the most leaves is opened, not the one with the largest surface area",
    ),
    (Opens::LargestVolume, "the child with the largest volume is opened: take the surface area"),
    (
        Opens::GrandchildrenOnly,
        "a node gets at most four children: open children until there are eight or only leaves",
    ),
];

/// The nodes that become the children of `top` by a wrong rule, sorted.
fn opened_by(tree: &FlatTree, top: usize, rule: Opens) -> Vec<usize> {
    let n_leaves = n_leaves(tree);
    let mut children = vec![top];
    let most = if matches!(rule, Opens::GrandchildrenOnly) { 4 } else { 8 };
    while children.len() < most {
        let inner = (0..children.len()).filter(|&place| !tree.nodes[children[place]].is_leaf());
        let key = |&place: &usize| {
            let bounds = tree.nodes[children[place]].bounds();
            let size = (bounds.max - bounds.min).as_dvec3();
            match rule {
                Opens::First => -(place as f64),
                Opens::Last => place as f64,
                Opens::Smallest => -half_area(&bounds),
                Opens::MostLeaves => n_leaves[children[place]] as f64,
                Opens::LargestVolume => size.x * size.y * size.z,
                Opens::GrandchildrenOnly => half_area(&bounds),
            }
        };
        let Some(place) = inner.max_by(|p, q| key(p).total_cmp(&key(q)).then(q.cmp(p))) else { break };
        let first = tree.nodes[children[place]].first as usize;
        children.splice(place..=place, [first, first + 1]);
    }
    children.sort_unstable();
    children
}

/// The first node whose children break the rule: the node of the flat tree, and yours and expected.
fn broken_rule(tree: &FlatTree, meaning: &Meaning) -> Option<(String, &'static str)> {
    let parents = parents(tree);
    let area = |node: usize| half_area(&tree.nodes[node].bounds());
    for children in meaning {
        let top = common(&parents, children)?;
        let waiting = children.iter().copied().filter(|&child| !tree.nodes[child].is_leaf());
        let largest = waiting.clone().map(area).fold(0.0, f64::max);
        if waiting.count() > 0 && children.len() < 8 {
            let yours = format!("{} children, of which some are inner nodes", children.len());
            return Some((yours, "eight children, or only leaves"));
        }
        // Every node that was opened must have at least the area of every inner node that was not.
        let mut least = f64::INFINITY;
        for &child in children {
            let mut above = child;
            while above != top && parents[above] != top {
                above = parents[above];
                least = least.min(area(above));
            }
        }
        // Areas in single precision have a relative error of about 2⁻²².
        if least < largest * (1.0 - 1e-6) {
            let yours = format!("a node of half area {least} was opened, and one of {largest} was not");
            return Some((yours, "the inner child with the largest surface area is opened first"));
        }
    }
    None
}

/// Judges which children were opened.
fn judge_opened(tree: &FlatTree, wide: &WideTree) -> CheckResult {
    judge_leaves(tree, wide)?;
    let broken = meaning(tree, wide).ok().and_then(|meaning| broken_rule(tree, &meaning));
    let Some((yours, expected)) = broken else { return Ok(()) };
    Err(Broken::with_texts(describe(tree), yours, expected, "the areas of the nodes"))
}

pub(super) fn collapse_opens_the_largest_child(trial: &Trial<'_>) -> CheckResult {
    trial.forall(200, divided_trees(120), |trees| {
        let judge = |tree: &FlatTree, wide: WideTree| judge_opened(tree, &wide);
        let formulas = |tree: &FlatTree, wide: &WideTree| {
            let (meaning, parents) = (meaning(tree, wide).ok(), parents(tree));
            let follows = |rule: Opens, children: &Vec<usize>| {
                let mut sorted = children.clone();
                sorted.sort_unstable();
                let top = common(&parents, children).unwrap_or(0);
                tree.nodes[top].is_leaf() || sorted == opened_by(tree, top, rule)
            };
            let gives = |rule, all: &Meaning| all.iter().all(|children| follows(rule, children));
            WRONG_RULES
                .map(|(rule, text)| (meaning.as_ref().is_some_and(|all| gives(rule, all)), text))
                .to_vec()
        };
        compare_formulas(trees, trial.kit.collapse(trees), judge, formulas)
    })?;
    // No node has an area, so any of them may be opened next, until there are eight children.
    let point = Vec3::splat(trial.varied(1.0, 0.25..8f32));
    let trees = [drawn_tree(&[Aabb::new(point, point); 40], 1, &[])];
    all_hold(compare(&trees, trial.kit.collapse(&trees), |tree, wide| judge_opened(tree, &wide)))
}

/// A tree over boxes in a row whose nodes are divided in half down to leaves of four. A node is larger than all nodes of the
/// next level, so all wide nodes can be full if the number of leaves is a power of eight.
fn halved(seed: u64, n: usize) -> FlatTree {
    let mut random = Random::new(seed, 23);
    let mut order: Vec<Aabb> = (0..n)
        .map(|i| {
            let low = Vec3::new(i as f32, random.unit() / 8.0, random.unit() / 8.0);
            Aabb::new(low, low + 0.5)
        })
        .collect();
    // `drawn_tree` lists every seventh box, again and again.
    let given = order.clone();
    (0..n).for_each(|i| order[i * 7 % n] = given[i]);
    drawn_tree(&order, BLOCK, &[])
}

/// The mean number of children that a wide tree must have, of eight.
const MEAN_CHILDREN: f64 = 5.5;

pub(super) fn collapse_fills_its_nodes(trial: &Trial<'_>) -> CheckResult {
    let trees = [4 * 64, 4 * 512].map(|n| halved(trial.seed, n));
    all_hold(compare(&trees, trial.kit.collapse(&trees), |tree, wide| {
        judge_leaves(tree, &wide)?;
        let n: u32 = wide.nodes.iter().map(raykata::wide::WideNode::n_children).sum();
        let mean = f64::from(n) / wide.nodes.len() as f64;
        if mean >= MEAN_CHILDREN {
            return Ok(());
        }
        let expected = format!("at least {MEAN_CHILDREN}");
        Err(Broken::with_texts(describe(tree), format!("{mean:.2} children per node"), expected, "counted")
            .explained_by([(
                mean <= 4.0,
                "a node gets at most four children: open children until there are eight or only leaves",
            )]))
    }))
}
