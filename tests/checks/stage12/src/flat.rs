//! `flatten`.

use super::trees::{drawn_tree, drawn_trees};
use checks::prelude::*;
use raykata::bvh::{Bvh, Contents};
use raykata::wide::{FlatNode, FlatTree};

/// A hierarchy of stage 3 with the nodes of `tree`, numbered in another order: any whose parents precede their children.
fn scattered(tree: &FlatTree, choices: &[u16]) -> Bvh {
    let mut bvh = Bvh::for_primitives(tree.order.len());
    bvh.order.clone_from(&tree.order);
    let mut numbers = vec![0; tree.nodes.len()];
    let mut choices = choices.iter().cycle();
    let mut waiting: Vec<usize> = (0..tree.nodes.len().min(1)).collect();
    while !waiting.is_empty() {
        let chosen = usize::from(*choices.next().unwrap_or(&0)) % waiting.len();
        let index = waiting.swap_remove(chosen);
        let node = &tree.nodes[index];
        numbers[index] = bvh.add_node(node.bounds());
        if !node.is_leaf() {
            waiting.extend([node.first as usize, node.first as usize + 1]);
        }
    }
    for (node, number) in tree.nodes.iter().zip(&numbers) {
        bvh.nodes[*number as usize].contents = if node.is_leaf() {
            Contents::Leaf { first: node.first, count: node.count }
        } else {
            let first = node.first as usize;
            Contents::Inner { left: numbers[first], right: numbers[first + 1] }
        };
    }
    bvh
}

/// A hierarchy with its flat form.
#[derive(Clone, Debug)]
struct Flat {
    bvh: Bvh,
    tree: FlatTree,
}

fn flats(most: usize) -> impl Strategy<Value = Flat> + Clone {
    (drawn_trees(most), prop::collection::vec(any::<u16>(), 1..20))
        .prop_map(|((_, tree), choices)| Flat { bvh: scattered(&tree, &choices), tree })
}

/// Wrong orders of nodes: level by level, the right child first, or all below the second child first.
#[derive(Clone, Copy)]
enum Order {
    Breadth,
    Right,
    SecondSide,
}

/// The same tree with its nodes in a wrong order.
fn reordered(tree: &FlatTree, order: Order) -> FlatTree {
    let mut nodes = tree.nodes[..tree.nodes.len().min(1)].to_vec();
    // Pairs of (index in the tree, index in the result) whose children are not placed yet.
    let mut waiting: Vec<(usize, usize)> = nodes.iter().map(|_| (0, 0)).collect();
    while !waiting.is_empty() {
        let next = if matches!(order, Order::Breadth) { 0 } else { waiting.len() - 1 };
        let (from, to) = waiting.remove(next);
        let node = tree.nodes[from];
        if node.is_leaf() {
            continue;
        }
        let (first, pair) = (node.first as usize, nodes.len());
        nodes[to].first = pair as u32;
        let children = if matches!(order, Order::Right) { [first + 1, first] } else { [first, first + 1] };
        nodes.extend(children.map(|child| tree.nodes[child]));
        let mut placed = [(children[0], pair), (children[1], pair + 1)];
        if matches!(order, Order::Right) {
            placed.reverse();
        }
        waiting.extend(placed);
    }
    FlatTree { nodes, order: tree.order.clone() }
}

fn judge(flat: &Flat, yours: &FlatTree) -> CheckResult {
    if *yours == flat.tree {
        return Ok(());
    }
    let n = flat.tree.nodes.len();
    let input = format!("flatten of a hierarchy of {n} nodes over {} primitives", flat.tree.order.len());
    let different = (0..n.max(yours.nodes.len())).find(|&i| yours.nodes.get(i) != flat.tree.nodes.get(i));
    let (yours_text, expected) = match different {
        Some(i) => {
            (format!("node {i}: {:?}", yours.nodes.get(i)), format!("node {i}: {:?}", flat.tree.nodes.get(i)))
        }
        None => (format!("order {:?}", yours.order), format!("order {:?}", flat.tree.order)),
    };
    let is_as_given = yours.nodes.len() == n
        && flat.bvh.nodes.iter().zip(&yours.nodes).all(|(given, yours)| given.bounds == yours.bounds());
    // The nodes depth first, one by one.
    let (mut one_by_one, mut waiting) = (Vec::new(), vec![0; n.min(1)]);
    while let Some(index) = waiting.pop() {
        let node: &FlatNode = &flat.tree.nodes[index];
        one_by_one.push((node.bounds(), node.count));
        waiting
            .extend([node.first as usize + 1, node.first as usize].into_iter().filter(|_| !node.is_leaf()));
    }
    let is_one_by_one = one_by_one.into_iter().eq(yours.nodes.iter().map(|node| (node.bounds(), node.count)));
    let only_boxes_differ = yours.nodes.len() == n
        && yours.nodes.iter().zip(&flat.tree.nodes).all(|(p, q)| (p.first, p.count) == (q.first, q.count));
    let only_order_differs = yours.nodes == flat.tree.nodes;
    Err(Broken::with_texts(input, yours_text, expected, "the layout of FlatTree").explained_by(named![
        *yours == reordered(&flat.tree, Order::Breadth) =>
            "the nodes are in breadth-first order: finish everything below the first child before the second",
        *yours == reordered(&flat.tree, Order::Right) => "the right child comes first: left and right are exchanged",
        *yours == reordered(&flat.tree, Order::SecondSide) => "the nodes below the second child come before those below the first",
        is_one_by_one => "the second child comes after all below the first: both children lie side by side",
        n == 0 && !yours.nodes.is_empty() => "a hierarchy without nodes gives a tree without nodes",
        is_as_given => "the nodes keep the order of the hierarchy, so children need not be neighbours",
        only_order_differs => "the list of primitives was changed: copy `order` as it is",
        only_boxes_differ => "only the boxes differ: copy the box of each node",
    ]))
}

/// Judges hierarchies, the first of which are chosen so that each wrong order gives another tree.
fn judge_all(trial: &Trial<'_>, chosen: &[Flat], fewest: usize, most: usize) -> CheckResult {
    let large = flats(most).prop_filter("enough nodes", move |flat| flat.tree.nodes.len() >= fewest);
    trial.forall_and(chosen, 400, large, |flats| {
        let queries: Vec<Bvh> = flats.iter().map(|flat| flat.bvh.clone()).collect();
        compare(flats, trial.kit.flatten(&queries), |flat, yours| judge(flat, &yours))
    })
}

pub(super) fn flatten_is_depth_first(trial: &Trial<'_>) -> CheckResult {
    judge_all(trial, &[], 2, 40)
}

pub(super) fn flatten_of_one_leaf_and_of_nothing(trial: &Trial<'_>) -> CheckResult {
    let leaf = |n: usize| {
        let boxes = vec![Aabb::new(Vec3::ZERO, Vec3::ONE); n];
        let tree = drawn_tree(&boxes, n, &[1]);
        Flat { bvh: scattered(&tree, &[0]), tree }
    };
    judge_all(trial, &[leaf(1), leaf(3), leaf(0)], 0, 3)
}
