//! `collapse`.

use super::trees::{Fault, broken_by, drawn_tree, drawn_trees, from_leaves, ranges};
use checks::prelude::*;
use checks::tree::half_area;
use oracle::splitmix::Random;
use raykata::wide::{
    BLOCK, Child, ChildContents, FlatNode, FlatTree, MAX_LEAF, NO_PRIMITIVE, WideNode, WideTree,
};
use std::collections::HashMap;
use std::ops::RangeInclusive;

/// For each node of a flat tree its parent; the root is its own.
fn parents(tree: &FlatTree) -> Vec<usize> {
    let mut parents = vec![0; tree.nodes.len()];
    for (index, node) in tree.nodes.iter().enumerate().filter(|(_, node)| !node.is_leaf()) {
        parents[node.first as usize] = index;
        parents[node.first as usize + 1] = index;
    }
    parents
}

/// The nodes of the flat tree that a wide tree is made of: those that its inner nodes stand for, without the root, and its leaves.
#[derive(Default)]
struct Meaning {
    inner: Vec<usize>,
    leaves: Vec<usize>,
}

const SPLIT_LEAF: &str = "a leaf of the binary tree must not be divided, also if it is large";
const FREE_LANES: &str = "the free lanes of a block hold numbers of primitives: they have NO_PRIMITIVE";
const MISSING_BLOCK: &str =
    "the last block of a leaf, which is not full, is missing: a leaf has ⌈count / BLOCK⌉ blocks";
const SAME_BLOCKS: &str =
    "each block of a leaf begins with its first primitive: go on where the block before ended";
const GAP_FIRST: &str = "an empty place stands before a child: fill the places from 0 on";
const CHILD_FIRST: &str = "a node gets its index after the nodes below it: a parent has the smaller index";

/// Whether only the full blocks of leaves exist, and some leaf has one that is not full.
fn lacks_blocks(wide: &WideTree) -> bool {
    let counts = leaf_counts(wide);
    counts.iter().map(|count| count / BLOCK).sum::<usize>() == wide.blocks.len()
        && counts.iter().any(|count| !count.is_multiple_of(BLOCK))
}

/// The number of primitives of each child; 0 for nodes.
fn leaf_counts(wide: &WideTree) -> Vec<usize> {
    let count = |child: Child| match child.contents() {
        ChildContents::Leaf { count, .. } => count as usize,
        ChildContents::Inner(_) => 0,
    };
    wide.nodes.iter().flat_map(|node| node.children).map(count).collect()
}

/// The leaves and places of a wide tree over `tree`, or the first fault.
fn meaning(tree: &FlatTree, wide: &WideTree) -> Result<Meaning, Fault> {
    let wrong = |yours: String, expected: &str| Err((yours, expected.to_owned(), None));
    if tree.nodes.is_empty() || wide.nodes.is_empty() {
        let yours = format!("{} wide nodes for {} nodes", wide.nodes.len(), tree.nodes.len());
        let same = tree.nodes.is_empty() && wide.nodes.is_empty();
        return if same {
            Ok(Meaning::default())
        } else {
            wrong(yours, "nodes for nodes, and none for none")
        };
    }
    let (parents, ranges) = (parents(tree), ranges(tree));
    let node_of: HashMap<(u32, u32), usize> = ranges.iter().copied().zip(0..).collect();
    let mut meaning = Meaning::default();
    let mut children = vec![Vec::new(); wide.nodes.len()];
    let mut times = vec![0; tree.order.len()];
    let (mut reached, mut used) = (vec![0; wide.nodes.len()], vec![0; wide.blocks.len()]);
    reached[0] = 1;
    // A parent precedes its children, so in reverse order the meaning of each child is known.
    for (index, node) in wide.nodes.iter().enumerate().rev() {
        let n = node.children.iter().position(|child| *child == Child::EMPTY).unwrap_or(8);
        if node.children[n..].iter().any(|child| *child != Child::EMPTY) || n == 0 {
            let yours = format!("node {index} has the children {:?}", node.children);
            let cause = node.children[n..].iter().any(|child| *child != Child::EMPTY).then_some(GAP_FIRST);
            return Err((yours, "the children first, then the empty places".into(), cause));
        }
        for place in 0..n {
            let (stands_for, bounds) = match node.children[place].contents() {
                ChildContents::Inner(below) => {
                    let below = below as usize;
                    if below <= index || below >= wide.nodes.len() {
                        let yours =
                            format!("a child of node {index} is node {below} of {}", wide.nodes.len());
                        let expected = "a parent has a smaller index than its children".to_owned();
                        return Err((yours, expected, (below < index).then_some(CHILD_FIRST)));
                    }
                    reached[below] += 1;
                    let Some(top) = common(&parents, &children[below]) else { continue };
                    if children[below].iter().map(|&one| ranges[one].1).sum::<u32>() != ranges[top].1 {
                        let yours = format!("node {below} holds leaves of different parts of the tree");
                        return wrong(yours, "everything below one node of the binary tree");
                    }
                    meaning.inner.push(top);
                    (top, tree.nodes[top].bounds())
                }
                ChildContents::Leaf { block, count } => {
                    let blocks = block as usize..block as usize + (count as usize).div_ceil(BLOCK);
                    let Some(lanes) = wide.blocks.get(blocks.clone()) else {
                        let yours = format!("a leaf with the blocks {blocks:?} of {}", wide.blocks.len());
                        let cause = lacks_blocks(wide).then_some(MISSING_BLOCK);
                        return Err((yours, "blocks that exist".into(), cause));
                    };
                    used[blocks].iter_mut().for_each(|used| *used += 1);
                    let lanes: Vec<u32> = lanes.iter().flatten().copied().collect();
                    let (ids, free) = lanes.split_at(count as usize);
                    let Some(first) = tree.order.iter().position(|id| ids.first() == Some(id)) else {
                        return wrong(format!("a leaf of {ids:?}"), "primitives that exist");
                    };
                    let is_in_order = tree.order[first..].starts_with(ids);
                    let leaf = node_of.get(&(first as u32, count)).filter(|_| is_in_order);
                    let Some(&leaf) = leaf.filter(|_| free.iter().all(|&id| id == NO_PRIMITIVE)) else {
                        let is_part = |node: &FlatNode| node.first == first as u32 && count < node.count;
                        let is_whole = leaf_counts(wide).iter().sum::<usize>() == tree.order.len();
                        let is_part = is_in_order && is_whole && tree.nodes.iter().any(is_part);
                        let is_again =
                            lanes.len() > BLOCK && lanes.chunks(BLOCK).all(|block| block[0] == lanes[0]);
                        let causes = [
                            (lacks_blocks(wide), MISSING_BLOCK),
                            (leaf.is_some(), FREE_LANES),
                            (is_part, SPLIT_LEAF),
                            (is_again, SAME_BLOCKS),
                        ];
                        let expected =
                            "the primitives of one binary node in order, and NO_PRIMITIVE in the free lanes";
                        let yours = format!("a leaf with the lanes {lanes:?}");
                        let cause = causes.into_iter().find(|(is_so, _)| *is_so).map(|(_, text)| text);
                        return Err((yours, expected.into(), cause));
                    };
                    times[first..first + count as usize].iter_mut().for_each(|times| *times += 1);
                    meaning.leaves.push(leaf);
                    let node = &tree.nodes[leaf];
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
            children[index].push(stands_for);
        }
    }
    if let Some(at) = times.iter().position(|&times| times != 1) {
        return wrong(format!("primitive {} is in {} leaves", tree.order[at], times[at]), "in one leaf");
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

/// What [`Kit::collapse`] asks: a tree, and the cost of a node.
type Collapsed = (FlatTree, f32);

/// Trees with a cost of a node in the range of those in use.
fn trees_only(most: usize) -> impl Strategy<Value = Collapsed> + Clone {
    (drawn_trees(most), 1.0..6.0f32).prop_map(|((_, tree), cost)| (tree, cost))
}

/// Trees with an inner node: another check judges those with one leaf or none.
fn divided_trees(most: usize) -> impl Strategy<Value = Collapsed> + Clone {
    trees_only(most).prop_filter("an inner node", |(tree, _)| tree.nodes.len() > 1)
}

pub(super) fn collapse_keeps_every_leaf(trial: &Trial<'_>) -> CheckResult {
    trial.each(300, divided_trees(80), <dyn Kit>::collapse, |(tree, _), wide| judge_leaves(tree, &wide))
}

pub(super) fn collapse_of_one_leaf_and_of_nothing(trial: &Trial<'_>) -> CheckResult {
    // Leaves of one primitive, of whole blocks, and of more.
    let leaf = |n: usize| drawn_tree(&vec![Aabb::new(Vec3::ZERO, Vec3::ONE); n], n, &[1]);
    let chosen: Vec<Collapsed> = [1, 8, 9, 16, 32, 0].into_iter().map(|n| (leaf(n), 2.0)).collect();
    trial.each_and(&chosen, 60, trees_only(3), <dyn Kit>::collapse, |(tree, _), wide| {
        judge_leaves(tree, &wide)
    })
}

/// By which rule a tree is made.
#[derive(Clone, Copy, PartialEq)]
enum Rule {
    Right,
    /// A node has at most so many children.
    Most(usize),
    LeavesStay,
    /// A leaf of MAX_LEAF primitives is too large.
    SmallLeaves,
    Primitives,
    PartsOfBlocks,
    NodesAreFree,
    NodesWithoutArea,
    Greedy,
    /// The left and the right child of a binary node get half of its places each; of an odd number the left one more, or less.
    Halves(bool),
    /// The left child gets the places of the right one.
    Exchanged,
    /// A node in one place costs as much as its two children in one place each.
    Pairs,
}

const WRONG_RULES: [(Rule, &str); 14] = named![
    Rule::Greedy =>
        "the inner child with the largest surface area is opened until there are eight: this is not always the cheapest",
    Rule::Most(2) => "a node gets at most two children, not eight",
    Rule::Most(4) => "a node gets at most four children, not eight",
    Rule::Most(7) => "a node gets at most seven children, not eight",
    Rule::LeavesStay => "every leaf stays a leaf: everything below an inner node may become one leaf as well",
    Rule::Primitives => "the costs count single primitives: a leaf pays for whole blocks, block_cost",
    Rule::SmallLeaves => "a leaf holds fewer than MAX_LEAF primitives: it may hold MAX_LEAF",
    Rule::PartsOfBlocks =>
        "a block that is not full costs less than a full one: a leaf pays for whole blocks, block_cost",
    Rule::NodesAreFree => "the cost of a node is left out: visiting it costs something, too",
    Rule::NodesWithoutArea => "the cost of a node is not multiplied by its area: a ray rarely enters a small one",
    Rule::Halves(false) => HALVES,
    Rule::Halves(true) => HALVES,
    Rule::Exchanged => "both children get each other's places: the left one gets those that were counted for it",
    Rule::Pairs => "a node costs as much as two children in one place each: its two children share eight places",
];

const HALVES: &str = "both children get half of the places: try each number of places for the left one";

/// The cost of everything below a node of `count` primitives as one leaf.
fn leaf_cost(node: &FlatNode, count: u32, rule: Rule) -> f64 {
    let blocks = match rule {
        Rule::Primitives => f64::from(count),
        Rule::PartsOfBlocks => f64::from(count) / BLOCK as f64,
        _ => f64::from(count.div_ceil(BLOCK as u32)),
    };
    let most = if rule == Rule::SmallLeaves { MAX_LEAF - 1 } else { MAX_LEAF };
    let may_be = count as usize <= most && (node.is_leaf() || rule != Rule::LeavesStay);
    if may_be { half_area(&node.bounds()) * blocks } else { f64::INFINITY }
}

fn inner_cost(node: &FlatNode, node_cost: f32, rule: Rule) -> f64 {
    match rule {
        Rule::NodesAreFree => 0.0,
        Rule::NodesWithoutArea => f64::from(node_cost),
        _ => half_area(&node.bounds()) * f64::from(node_cost),
    }
}

/// The numbers of places that the left child of a binary node may get of `n`.
fn shares(n: usize, rule: Rule) -> RangeInclusive<usize> {
    match rule {
        Rule::Halves(more) if n > 1 => (n + usize::from(more)) / 2..=(n + usize::from(more)) / 2,
        _ => 1..=n - 1,
    }
}

/// For each node of a binary tree its least cost by a rule in one place and in up to eight; the last number is that of a division.
fn table((tree, node_cost): &Collapsed, rule: Rule) -> Vec<[f64; 9]> {
    let ranges = ranges(tree);
    let most = if let Rule::Most(most) = rule { most } else { 8 };
    let leaf = |index: usize| leaf_cost(&tree.nodes[index], ranges[index].1, rule);
    let join = |index: usize, left: [f64; 9], right: [f64; 9]| {
        let mut costs = [f64::INFINITY; 9];
        for (cost, n) in costs[1..most].iter_mut().zip(2..) {
            let n = if rule == Rule::Pairs { 2 } else { n };
            let sums = shares(n, rule).map(|i| left[i - 1] + right[n - i - 1]);
            *cost = sums.fold(f64::INFINITY, f64::min);
        }
        let divided = costs[most - 1];
        let one = leaf(index).min(inner_cost(&tree.nodes[index], *node_cost, rule) + divided);
        let mut costs = costs.map(|cost| cost.min(one));
        costs[8] = divided.min(leaf(index));
        costs
    };
    from_leaves(tree, |index, _| [leaf(index); 9], join)
}

/// The least cost of a wide tree by a rule, without its root.
fn least(asked: &Collapsed, rule: Rule) -> f64 {
    table(asked, rule).first().map_or(0.0, |root| root[8])
}

/// The cost of the tree that is built by costs that are counted by one rule, and where children get places by another one.
fn built(asked: &Collapsed, counted: Rule, placed: Rule) -> f64 {
    let (tree, table) = (&asked.0, table(asked, counted));
    let ranges = ranges(tree);
    let leaf = |node: usize| leaf_cost(&tree.nodes[node], ranges[node].1, Rule::Right);
    let (mut sum, mut waiting) = (0.0, vec![(0, 8, true)]);
    while let Some((node, n, is_top)) = waiting.pop() {
        let first = tree.nodes[node].first as usize;
        // A leaf and a single place have no division.
        let places = shares(if tree.nodes[node].is_leaf() { 1 } else { n }, placed);
        let divided = places.map(|i| (table[first][i - 1] + table[first + 1][n - i - 1], i));
        match divided.min_by(|p, q| p.0.total_cmp(&q.0)) {
            Some((cost, i)) if cost < leaf(node) && (is_top || cost <= table[node][0]) => {
                let i = if placed == Rule::Exchanged { n - i } else { i };
                waiting.extend([(first, i, false), (first + 1, n - i, false)]);
            }
            _ if is_top || leaf(node) <= table[node][0] => sum += leaf(node),
            _ => {
                sum += inner_cost(&tree.nodes[node], asked.1, Rule::Right);
                waiting.push((node, 8, true));
            }
        }
    }
    sum
}

/// The cost of a wide tree by a rule, without its root.
fn cost((tree, node_cost): &Collapsed, meaning: &Meaning, rule: Rule) -> f64 {
    let ranges = ranges(tree);
    let leaves = meaning.leaves.iter().map(|&leaf| leaf_cost(&tree.nodes[leaf], ranges[leaf].1, rule));
    let inner = meaning.inner.iter().map(|&inner| inner_cost(&tree.nodes[inner], *node_cost, rule));
    leaves.chain(inner).sum()
}

/// The nodes that stay inner nodes if the inner child with the largest surface area is opened until there are eight.
fn kept_by_greed(tree: &FlatTree) -> Vec<usize> {
    let (mut kept, mut waiting) = (Vec::new(), vec![0]);
    while let Some(top) = waiting.pop() {
        let mut children = vec![top];
        let is_inner = |child: &usize| !tree.nodes[*child].is_leaf();
        while children.len() < 8 {
            let inner = (0..children.len()).filter(|&place| is_inner(&children[place]));
            let area = |place: &usize| half_area(&tree.nodes[children[*place]].bounds());
            let Some(place) = inner.max_by(|p, q| area(p).total_cmp(&area(q))) else { break };
            let first = tree.nodes[children[place]].first as usize;
            children.splice(place..=place, [first, first + 1]);
        }
        children.retain(is_inner);
        kept.extend(&children);
        waiting.extend(children);
    }
    kept.sort_unstable();
    kept
}

/// Judges the cost of wide trees, which is counted without the root.
fn judge_costs(trial: &Trial<'_>, trees: &[Collapsed]) -> Vec<CheckResult> {
    let judge = |asked: &Collapsed, wide: WideTree| {
        let tree = &asked.0;
        judge_leaves(tree, &wide)?;
        let Ok(meaning) = meaning(tree, &wide) else { return Ok(()) };
        let (yours, least) = (cost(asked, &meaning, Rule::Right), least(asked, Rule::Right));
        if yours <= least * (1.0 + 1e-4) {
            return Ok(());
        }
        let [yours, least] = [yours, least].map(|cost| format!("a cost of {cost:.3} below the root"));
        Err(Broken::with_texts(describe(tree), yours, least, "the surface area heuristic"))
    };
    let formulas = |asked: &Collapsed, wide: &WideTree| {
        let tree = &asked.0;
        let meaning = meaning(tree, wide).ok();
        let most = wide.nodes.iter().map(WideNode::n_children).max().unwrap_or(0) as usize;
        let gives = |rule, meaning: &Meaning| {
            let (cost, right) = (cost(asked, meaning, rule), cost(asked, meaning, Rule::Right));
            let is_built = |by: Rule| (built(asked, by, rule) - right).abs() <= 1e-4 * right;
            match rule {
                Rule::Greedy => {
                    let mut inner = meaning.inner.clone();
                    inner.sort_unstable();
                    inner == kept_by_greed(tree)
                }
                Rule::Exchanged => is_built(Rule::Right),
                Rule::Pairs => is_built(rule),
                Rule::Halves(_) => is_built(rule) || is_built(Rule::Right),
                Rule::Most(n) if most > n => false,
                rule => cost <= least(asked, rule) * (1.0 + 1e-4),
            }
        };
        WRONG_RULES
            .map(|(rule, text)| (meaning.as_ref().is_some_and(|meaning| gives(rule, meaning)), text))
            .to_vec()
    };
    compare_formulas(trees, trial.kit.collapse(trees), judge, formulas)
}

pub(super) fn collapse_costs_least(trial: &Trial<'_>) -> CheckResult {
    trial.forall(200, divided_trees(160), |trees| judge_costs(trial, trees))
}

/// A tree over boxes in a row whose nodes are divided in half down to leaves of one.
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
    drawn_tree(&order, 1, &[])
}

pub(super) fn collapse_fills_its_leaves(trial: &Trial<'_>) -> CheckResult {
    all_hold(judge_costs(trial, &[512, 1500, 2048].map(|n| (halved(trial.seed, n), 2.0))))
}
