//! Stage 12, bonus · better trees: subtrees move to places where they cost less.
//!
//! Sources: Bittner, Hapala and Havran, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies", Computer Graphics
//! Forum 2013; Meister and Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization", Eurographics 2018.
//!
//! Given: [`PlaceProbe`] with `open` (a node's area, its area together with the subtree, and its children); [`SubtreePlace`];
//! [`FlatTree`].

use raykata::wide::{FlatTree, PlaceProbe, SubtreePlace};

// <solution>
use glam::{DVec3, Vec3};
use raykata::wide::{FlatNode, OpenedNode};
use std::cmp::Reverse;
use std::collections::BinaryHeap;
// </solution>

/// Where a subtree costs least: the node `X` beside which it is inserted. A new inner node takes the place of `X`, with `X` and the
/// subtree as its children.
///
/// The areas of all inner nodes together grow by
///
/// `increase(X) = U(X) + Σ (U(Y) - A(Y))` over all nodes `Y` above `X`,
///
/// with half the surface area `A` of a node's box, and `U` of the box around the node and the subtree. `U(X)` is the area of the
/// new inner node, and each node above it grows to hold the subtree. `X` may be the root or a leaf. `area` is that of the
/// subtree's box, and no `U` is smaller. All areas are finite. Of places with the same increase any one is right.
///
/// Find it by branch and bound: below a node, each increase is at least the growth of all nodes above plus `area`. So a node is
/// left out if this bound is not below the best increase so far. The calls of the probe are counted; all points need at most 1.05
/// times as many as the reference makes, which always opens the node with the smallest bound (a priority queue).
///
/// Pitfall: the child with the smaller increase may be the wrong way down.
pub fn cheapest_place<P: PlaceProbe>(probe: &mut P, root: u32, area: f64) -> SubtreePlace {
    // <solution>
    let mut best = SubtreePlace { node: root, increase: f64::INFINITY };
    // A node waits with the growth of all nodes above it. The bits of numbers that are not negative are in their order.
    let mut waiting = BinaryHeap::from([Reverse((0, root))]);
    while let Some(Reverse((bits, node))) = waiting.pop() {
        let growth = f64::from_bits(bits);
        // All others have larger bounds.
        if !(growth + area < best.increase) {
            break;
        }
        // Try the place beside this node.
        let opened = probe.open(node);
        let increase = growth + opened.united;
        if increase < best.increase {
            best = SubtreePlace { node, increase };
        }
        // Below it, the node itself grows as well.
        let growth = (growth + (opened.united - opened.area)).max(0.0);
        if growth + area < best.increase {
            waiting.extend(
                opened.children.into_iter().flatten().map(|child| Reverse((growth.to_bits(), child))),
            );
        }
    }
    best
    // <stub> todo!("open the node with the smallest bound, until no bound is below the best increase")
    // </solution>
}

/// Improves a tree by moves of subtrees, and returns it in the layout of [`FlatTree`].
///
/// A move takes a node that is not the root, with everything below it, out of the tree; its sibling takes the place of its
/// parent. Then the subtree is inserted beside another node, as [`cheapest_place`] describes. It makes at most `most_moves` moves,
/// and none that makes the areas of all inner nodes together larger. It ends where no move makes them smaller by more than a
/// rounding error. It may end earlier, but makes at least one move if one is allowed and makes them clearly smaller.
///
/// Each leaf stays a leaf, with the same box and the same primitives in the same order. The box of an inner node is the smallest
/// box around the boxes of its two children; an empty box changes no union. `order` lists the leaves in the new order of the
/// tree. A tree without nodes, or with one leaf, stays as it is. Boxes have any size, so areas need double precision.
///
/// With as many moves as the tree has nodes, trees over primitives in the order of the Morton code become a sixth cheaper on average,
/// by the cost of [`build_binned`](crate::stage12_build::build_binned); all points need nine tenths of what the reference
/// saves. One way to get there: try all nodes, the largest area first, each at its cheapest place, and repeat that a few times.
///
/// Pitfall: the areas above the old place shrink before the new place is searched. Without that, a subtree seems to fit best where
/// it already is.
pub fn reinsert(tree: &FlatTree, most_moves: u32) -> FlatTree {
    // <solution>
    if tree.nodes.is_empty() {
        return tree.clone();
    }
    let mut links = Links::new(tree);
    let mut moves_left = most_moves;
    for _ in 0..PASSES {
        // Try the nodes with the largest areas first: they are entered by most rays.
        let mut nodes: Vec<u32> = (0..tree.nodes.len() as u32).collect();
        nodes.sort_by(|&p, &q| links.area(q).total_cmp(&links.area(p)));
        let before = moves_left;
        for node in nodes {
            if moves_left == 0 {
                break;
            }
            moves_left -= u32::from(links.improve(node));
        }
        // End if a pass moves few nodes.
        if before - moves_left <= tree.nodes.len() as u32 / 200 {
            break;
        }
    }
    links.flatten(tree)
    // <stub> todo!("take each subtree out, find its cheapest place, and insert it there if the tree gets cheaper")
    // </solution>
}

// <solution>
/// The largest number of passes over all nodes. The third one still saves a percent in most trees, later ones less.
const PASSES: usize = 4;

/// A move must save more than this part of the root's area, which is more than the rounding errors of all areas above a node.
const LEAST_GAIN: f64 = 1e-9;

/// No node.
const NONE: u32 = u32::MAX;

/// A binary tree whose nodes know their parents. Nodes have the numbers of the flat tree.
struct Links {
    nodes: Vec<Link>,
    root: u32,
}

#[derive(Clone, Copy)]
struct Link {
    low: Vec3,
    high: Vec3,
    parent: u32,
    /// Both are [`NONE`] for a leaf.
    children: [u32; 2],
}

impl Links {
    fn new(tree: &FlatTree) -> Links {
        let link = |node: &FlatNode| {
            let children = if node.is_leaf() { [NONE; 2] } else { [node.first, node.first + 1] };
            Link { low: node.low, high: node.high, parent: NONE, children }
        };
        let mut nodes: Vec<Link> = tree.nodes.iter().map(link).collect();
        for index in 0..nodes.len() {
            for child in nodes[index].children.into_iter().filter(|&child| child != NONE) {
                nodes[child as usize].parent = index as u32;
            }
        }
        Links { nodes, root: 0 }
    }

    fn area(&self, node: u32) -> f64 {
        let node = &self.nodes[node as usize];
        half_area(node.low, node.high)
    }

    /// Moves a subtree to its cheapest place; false if it stays where it is.
    fn improve(&mut self, node: u32) -> bool {
        let parent = self.nodes[node as usize].parent;
        if parent == NONE {
            return false;
        }
        // Take the subtree out, and see what that saves.
        let [left, right] = self.nodes[parent as usize].children;
        let sibling = if left == node { right } else { left };
        let saved = self.area(parent) + self.replace(parent, sibling);
        // Insert it at its cheapest place, or where it was.
        let area = self.area(node);
        let place = cheapest_place(&mut Place { links: self, subtree: node }, self.root, area);
        let gains = saved - place.increase > LEAST_GAIN * self.area(self.root);
        let target = if gains { place.node } else { sibling };
        self.insert(node, parent, target);
        target != sibling
    }

    /// Puts `new` into the place of `old`, and fits the boxes above; returns the area that they lose.
    fn replace(&mut self, old: u32, new: u32) -> f64 {
        let above = self.nodes[old as usize].parent;
        self.nodes[new as usize].parent = above;
        if above == NONE {
            self.root = new;
            return 0.0;
        }
        let children = &mut self.nodes[above as usize].children;
        let side = usize::from(children[1] == old);
        children[side] = new;
        self.fit(above)
    }

    /// Inserts `node` beside `target`, below the unused inner node `parent`.
    fn insert(&mut self, node: u32, parent: u32, target: u32) {
        self.nodes[parent as usize].parent = self.nodes[target as usize].parent;
        self.nodes[parent as usize].children = [target, node];
        self.nodes[node as usize].parent = parent;
        // The new inner node takes the place of the target before the boxes above it are fitted.
        let (low, high) = self.around(parent);
        (self.nodes[parent as usize].low, self.nodes[parent as usize].high) = (low, high);
        self.replace(target, parent);
        self.nodes[target as usize].parent = parent;
    }

    /// Makes the box of `node` and those of all nodes above it as small as possible; returns the area that they lose.
    fn fit(&mut self, mut node: u32) -> f64 {
        let mut lost = 0.0;
        while node != NONE {
            let (low, high) = self.around(node);
            let before = self.area(node);
            let link = &mut self.nodes[node as usize];
            (link.low, link.high) = (low, high);
            node = link.parent;
            lost += before - half_area(low, high);
        }
        lost
    }

    /// The box around the boxes of both children.
    fn around(&self, node: u32) -> (Vec3, Vec3) {
        let [p, q] = self.nodes[node as usize].children.map(|child| self.nodes[child as usize]);
        (p.low.min(q.low), p.high.max(q.high))
    }

    /// The tree in depth-first order, with the leaves of `tree`.
    fn flatten(&self, tree: &FlatTree) -> FlatTree {
        let mut flat = FlatTree { nodes: vec![tree.nodes[0]], order: Vec::with_capacity(tree.order.len()) };
        let mut waiting = vec![(self.root, 0)];
        while let Some((node, index)) = waiting.pop() {
            let Link { low, high, children, .. } = self.nodes[node as usize];
            let old = &tree.nodes[node as usize];
            let (first, count) = if children[0] == NONE {
                let first = flat.order.len();
                flat.order.extend(&tree.order[old.first as usize..(old.first + old.count) as usize]);
                (first, old.count)
            } else {
                // The two children come next to each other, and everything below the left one before the rest.
                let pair = flat.nodes.len();
                flat.nodes.extend([*old, *old]);
                waiting.extend([(children[1], pair + 1), (children[0], pair)]);
                (pair, 0)
            };
            flat.nodes[index] = FlatNode { low, first: first as u32, high, count };
        }
        flat
    }
}

/// Half the surface area of a box; 0 for the empty box.
fn half_area(low: Vec3, high: Vec3) -> f64 {
    let size = (high.as_dvec3() - low.as_dvec3()).max(DVec3::ZERO);
    size.x * size.y + size.y * size.z + size.z * size.x
}

/// The tree without a subtree, for which a place is searched.
struct Place<'a> {
    links: &'a Links,
    subtree: u32,
}

impl PlaceProbe for Place<'_> {
    fn open(&mut self, node: u32) -> OpenedNode {
        let [one, subtree] = [node, self.subtree].map(|node| self.links.nodes[node as usize]);
        let is_leaf = one.children[0] == NONE;
        OpenedNode {
            area: half_area(one.low, one.high),
            united: half_area(one.low.min(subtree.low), one.high.max(subtree.high)),
            children: (!is_leaf).then_some(one.children),
        }
    }
}
// </solution>
