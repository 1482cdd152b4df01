//! Flat trees: trees whose shape is drawn, and the faults and the cost of a tree.

use checks::prelude::*;
use checks::tree::{around, half_area};
use raykata::wide::{BLOCK, BLOCK_COST, FlatNode, FlatTree, MAX_LEAF, NODE_COST};

/// A node that is not filled in yet.
const GAP: FlatNode = FlatNode { low: Vec3::ZERO, first: 0, high: Vec3::ZERO, count: 0 };

/// Boxes of whole eighths: some flat, some equal.
pub(super) fn boxes(most: usize) -> impl Strategy<Value = Vec<Aabb>> + Clone {
    let one = (point(6), 0..=6i32, 0..=3usize).prop_map(|(low, size, flat)| {
        let mut size = Vec3::new(size as f32, size as f32 / 2.0, 1.0) / 4.0;
        if flat < 3 {
            size[flat] = 0.0;
        }
        Aabb::new(low, low + size)
    });
    prop::collection::vec(one, 0..=most)
}

/// The numbers `0..n` in another order.
pub(super) fn shuffled(n: usize) -> Vec<u32> {
    // A prime step that does not divide n visits every number once.
    let step = [7, 11, 13].into_iter().find(|step| !n.is_multiple_of(*step)).unwrap_or(1);
    (0..n).map(|i| (i * step % n) as u32).collect()
}

/// A tree over boxes. It is divided as `cuts` says, and so follows none of the rules by which students build.
///
/// Primitives are listed in an order that is not that of their numbers. Leaves have at most `leaf_size` primitives. Without
/// cuts, nodes are divided in half down to leaves of this size.
pub(super) fn drawn_tree(boxes: &[Aabb], leaf_size: usize, cuts: &[u16]) -> FlatTree {
    let mut tree = FlatTree { nodes: Vec::new(), order: shuffled(boxes.len()) };
    if !boxes.is_empty() {
        tree.nodes.push(GAP);
        divide(boxes, leaf_size, &mut cuts.iter().cycle(), &mut tree, 0, 0..boxes.len());
    }
    tree
}

fn divide<'a>(
    boxes: &[Aabb],
    leaf_size: usize,
    cuts: &mut impl Iterator<Item = &'a u16>,
    tree: &mut FlatTree,
    node: usize,
    range: std::ops::Range<usize>,
) {
    let bounds = around(tree.order[range.clone()].iter().map(|&id| &boxes[id as usize]));
    let count = range.len();
    let (is_leaf, left) = match cuts.next().copied().map(usize::from) {
        Some(cut) => {
            (count == 1 || count <= leaf_size && cut % 3 != 0, 1 + cut % count.max(2).saturating_sub(1))
        }
        None => (count <= leaf_size, count / 2),
    };
    let (first, n) = if is_leaf { (range.start, count) } else { (tree.nodes.len(), 0) };
    tree.nodes[node] = FlatNode { low: bounds.min, first: first as u32, high: bounds.max, count: n as u32 };
    if !is_leaf {
        tree.nodes.extend([GAP, GAP]);
        let middle = range.start + left;
        divide(boxes, leaf_size, cuts, tree, first, range.start..middle);
        divide(boxes, leaf_size, cuts, tree, first + 1, middle..range.end);
    }
}

/// Trees over up to `most` boxes, with the boxes.
pub(super) fn drawn_trees(most: usize) -> impl Strategy<Value = (Vec<Aabb>, FlatTree)> + Clone {
    (boxes(most), 1..=10usize, prop::collection::vec(any::<u16>(), 1..40)).prop_map(
        |(boxes, leaf_size, cuts)| {
            let tree = drawn_tree(&boxes, leaf_size, &cuts);
            (boxes, tree)
        },
    )
}

/// What is wrong with a tree: yours, expected, and the text of a diagnosis if the fault is itself the cause.
pub(super) type Fault = (String, String, Option<&'static str>);

pub(super) fn broken_by((yours, expected, cause): Fault, input: String, source: &'static str) -> Broken {
    Broken::with_texts(input, yours, expected, source).explained_by(cause.map(|text| (true, text)))
}

const LEFT_OUT: &str = "a primitive was left out, or is in two leaves: both sides of a split together \
                                   must hold each exactly once";
const LISTED_TWICE: &str = "a leaf begins before the previous one ends: the right side's primitives begin behind those of the left side";
const NOT_DEPTH_FIRST: &str = "the nodes are not depth first: append both children of a node, then all \
                                          nodes below the first, then all below the second";
const TOO_LARGE: &str =
    "a leaf holds more than MAX_LEAF primitives: only a node of at most MAX_LEAF may become a leaf";

/// The first fault of a tree that a builder made over `boxes`.
pub(super) fn fault(tree: &FlatTree, boxes: &[Aabb]) -> Option<Fault> {
    let wrong = |yours: String, expected: &str| Some((yours, expected.to_owned(), None));
    if boxes.is_empty() || tree.nodes.is_empty() {
        let both = boxes.is_empty() && tree.nodes.is_empty();
        let yours = format!("{} nodes over {} primitives", tree.nodes.len(), boxes.len());
        return if both { None } else { wrong(yours, "nodes if and only if there are primitives") };
    }
    let mut times = vec![0u32; boxes.len()];
    for &id in &tree.order {
        let Some(times) = times.get_mut(id as usize) else {
            return wrong(format!("primitive {id} in `order`"), &format!("primitives 0..{}", boxes.len()));
        };
        *times += 1;
    }
    if let Some(id) = times.iter().position(|&times| times != 1) {
        let yours = format!("primitive {id} is {} times in `order`", times[id]);
        return Some((yours, "each primitive exactly once".to_owned(), Some(LEFT_OUT)));
    }
    // Visit the nodes depth first. `next` is where the children of the next inner node must be, and `listed` where the
    // primitives of the next leaf must begin.
    let (mut waiting, mut next, mut listed) = (vec![0], 1, 0);
    while let Some(index) = waiting.pop() {
        let node = &tree.nodes[index];
        if node.is_leaf() {
            if node.count as usize > MAX_LEAF {
                let yours = format!("leaf {index} holds {}", node.count);
                return Some((yours, format!("at most {MAX_LEAF}"), Some(TOO_LARGE)));
            }
            let range = node.first as usize..node.first as usize + node.count as usize;
            if range.start != listed || range.end > tree.order.len() {
                let yours = format!("leaf {index} lists order[{range:?}]");
                let expected = format!("order[{listed}..]: the leaves follow each other");
                return Some((yours, expected, (range.start < listed).then_some(LISTED_TWICE)));
            }
            listed = range.end;
            let outside = |&&id: &&u32| !node.bounds().contains_box(&boxes[id as usize]);
            if let Some(id) = tree.order[range].iter().find(outside) {
                let yours = format!("primitive {id} sticks out of leaf {index}");
                return wrong(yours, "boxes around their primitives");
            }
            continue;
        }
        let first = node.first as usize;
        if first != next || first + 1 >= tree.nodes.len() {
            let yours = format!("the children of node {index} are nodes {first} and {}", first + 1);
            let expected = format!("nodes {next} and {} of {}", next + 1, tree.nodes.len());
            return Some((yours, expected, holds_each_once(tree, boxes).then_some(NOT_DEPTH_FIRST)));
        }
        next += 2;
        for child in [first, first + 1] {
            if !node.bounds().contains_box(&tree.nodes[child].bounds()) {
                return wrong(format!("node {child} sticks out of its parent {index}"), "boxes within boxes");
            }
        }
        waiting.extend([first + 1, first]);
    }
    if (next, listed) != (tree.nodes.len(), boxes.len()) {
        let yours = format!("{next} of {} nodes in use, {listed} primitives", tree.nodes.len());
        return wrong(yours, &format!("all nodes, {} primitives", boxes.len()));
    }
    None
}

/// Whether a tree is right except for the order of its nodes: all of them are below the root, and the leaves hold all primitives.
fn holds_each_once(tree: &FlatTree, boxes: &[Aabb]) -> bool {
    let (mut waiting, mut used, mut listed) = (vec![0], 0, 0);
    while let Some(index) = waiting.pop() {
        let Some(node) = tree.nodes.get(index).filter(|_| used < tree.nodes.len()) else { return false };
        used += 1;
        let first = node.first as usize;
        if !node.is_leaf() {
            waiting.extend([first, first + 1]);
            continue;
        }
        listed += node.count as usize;
        let ids = tree.order.get(first..first + node.count as usize).unwrap_or_default();
        if ids.is_empty() || ids.iter().any(|&id| !node.bounds().contains_box(&boxes[id as usize])) {
            return false;
        }
    }
    (used, listed) == (tree.nodes.len(), boxes.len())
}

/// A value for each node of a tree without faults, from the leaves up. `join` computes it from the values of both children.
/// Both functions also get the index of the node.
pub(super) fn from_leaves<T: Copy>(
    tree: &FlatTree,
    leaf: impl Fn(usize, &FlatNode) -> T,
    join: impl Fn(usize, T, T) -> T,
) -> Vec<T> {
    // Children come after their parents, so the values are computed, and stored, from the last node to the first.
    let last = tree.nodes.len().saturating_sub(1);
    let mut values: Vec<T> = Vec::new();
    for (index, node) in tree.nodes.iter().enumerate().rev() {
        let of = |child: u32| values[last - child as usize];
        values.push(if node.is_leaf() {
            leaf(index, node)
        } else {
            join(index, of(node.first), of(node.first + 1))
        });
    }
    values.reverse();
    values
}

/// For each node of a tree without faults the primitives below it: where they begin in the order, and their number.
pub(super) fn ranges(tree: &FlatTree) -> Vec<(u32, u32)> {
    from_leaves(tree, |_, leaf| (leaf.first, leaf.count), |_, left, right| (left.0, left.1 + right.1))
}

/// The cost of a tree without faults by the surface area heuristic of this stage, for a ray that enters its root.
pub fn cost(tree: &FlatTree) -> f64 {
    let cost = |node: &FlatNode| {
        let blocks = f64::from(node.count.div_ceil(BLOCK as u32));
        half_area(&node.bounds())
            * if node.is_leaf() { f64::from(BLOCK_COST) * blocks } else { f64::from(NODE_COST) }
    };
    let root = tree.nodes.first().map_or(1.0, |root| half_area(&root.bounds()));
    tree.nodes.iter().map(cost).sum::<f64>() / root
}
