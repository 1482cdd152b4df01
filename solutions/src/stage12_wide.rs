//! Stage 12 · trees as fast searches need them: all nodes in one array, and eight children per
//! node.
//!
//! Source: Wald, Benthin and Boulos, "Getting Rid of Packets", 2008; Ylitie, Karras and Laine,
//! "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", 2017.
//!
//! Given: [`FlatTree`], a binary tree with nodes of 32 bytes; [`WideTree`], a tree whose nodes have
//! eight children.

use raykata::bvh::Bvh;
use raykata::wide::{BLOCK, Child, FlatTree, MAX_LEAF, NO_PRIMITIVE, WideNode, WideTree};

// <solution>
use crate::stage12_build::block_cost;
use raykata::bvh::Contents;
use raykata::wide::FlatNode;
// </solution>

/// Copies a hierarchy of stage 3 into one array, [`FlatTree`]. A ray needs both children of a node
/// at once, so they lie side by side:
///
/// ```text
/// root | A B | children of A | ... | children of B | ...
/// ```
///
/// Exactly:
///
/// 1. The left child A comes first, and all below A before all below B.
/// 2. Boxes, leaves and the order of the primitives stay as they are.
/// 3. A hierarchy without nodes gives a tree without nodes.
pub fn flatten(bvh: &Bvh) -> FlatTree {
    // <solution>
    let mut nodes = Vec::with_capacity(bvh.nodes.len());
    if let Some(root) = bvh.root() {
        nodes.push(flat_node(bvh, root));
        flatten_below(bvh, root, 0, &mut nodes);
    }
    FlatTree { nodes, order: bvh.order.clone() }
    // <stub> todo!("copy the root, then the two children of each node side by side, depth first")
    // </solution>
}

// <solution>
/// A copy of a node, as a leaf or as an inner node whose first child is not known yet.
fn flat_node(bvh: &Bvh, node: u32) -> FlatNode {
    let node = &bvh.nodes[node as usize];
    let (first, count) = match node.contents {
        Contents::Leaf { first, count } => (first, count),
        Contents::Inner { .. } => (0, 0),
    };
    FlatNode { low: node.bounds.min, first, high: node.bounds.max, count }
}

/// Appends all nodes below `node`, whose copy is at `index`.
fn flatten_below(bvh: &Bvh, node: u32, index: usize, nodes: &mut Vec<FlatNode>) {
    let Contents::Inner { left, right } = bvh.nodes[node as usize].contents else { return };
    let pair = nodes.len();
    nodes[index].first = pair as u32;
    nodes.extend([flat_node(bvh, left), flat_node(bvh, right)]);
    flatten_below(bvh, left, pair, nodes);
    flatten_below(bvh, right, pair + 1, nodes);
}
// </solution>

/// Turns a binary tree into the cheapest one with eight children per node, by dynamic programming.
/// Everything below a binary node becomes a leaf, or up to eight children. The cost is
/// `node_cost · A` per inner node and `A · c` per leaf, with half the surface area `A` of its
/// box and `block_cost` as `c`. Which costs does a node need from its two children?
///
/// Exactly:
///
/// 1. The cost is the least, up to rounding.
/// 2. A leaf has the box and all primitives of a binary node, in order, at most [`MAX_LEAF`]. Free
///    lanes of its last block have [`NO_PRIMITIVE`].
/// 3. The children of a node come before its empty places.
/// 4. A parent has a smaller index than its children, and each node and block is used once.
/// 5. A tree that is best as one leaf has one node with one child; no nodes give no nodes.
pub fn collapse(tree: &FlatTree, node_cost: f32) -> WideTree {
    // <solution>
    let mut wide = WideTree::default();
    if !tree.nodes.is_empty() {
        wide.nodes.reserve(tree.nodes.len() / 4);
        wide.blocks.reserve(tree.order.len() / 5);
        wide.nodes.push(WideNode::EMPTY);
        Costs::of(tree, node_cost).fill_node(0, 0, &mut wide);
    }
    wide
    // <stub> todo!("from the last node to the first: the least cost as 1 to 8 children; then build what costs least")
    // </solution>
}

// <solution>
/// What the parts of a binary tree cost in a wide tree.
struct Costs<'a> {
    tree: &'a FlatTree,
    /// The primitives below each node, as a range of `tree.order`.
    ranges: Vec<[u32; 2]>,
    /// `least[node][n - 1]`: the least cost of everything below `node` as at most `n` children.
    least: Vec<[f32; 8]>,
}

impl Costs<'_> {
    fn of(tree: &FlatTree, node_cost: f32) -> Costs<'_> {
        let n = tree.nodes.len();
        let mut costs = Costs { tree, ranges: vec![[0; 2]; n], least: vec![[0.0; 8]; n] };
        // Children come after their parents, so from the last node to the first they are known.
        for (index, node) in tree.nodes.iter().enumerate().rev() {
            let first = node.first as usize;
            if node.is_leaf() {
                costs.ranges[index] = [node.first, node.first + node.count];
                costs.least[index] = [costs.as_leaf(index); 8];
                continue;
            }
            costs.ranges[index] = [costs.ranges[first][0], costs.ranges[first + 1][1]];
            // Divide n places between both children in the cheapest way.
            let (left, right) = (&costs.least[first], &costs.least[first + 1]);
            let mut least = [f32::INFINITY; 8];
            for i in 0..7 {
                for j in 0..7 - i {
                    least[i + j + 1] = least[i + j + 1].min(left[i] + right[j]);
                }
            }
            // In one place the node is a leaf, or a wide node with up to eight children.
            let as_node = node_cost * half_area(node) + least[7];
            let one = costs.as_leaf(index).min(as_node);
            costs.least[index] = least.map(|divided| divided.min(one));
        }
        costs
    }

    /// The cost of everything below a node as one leaf.
    fn as_leaf(&self, node: usize) -> f32 {
        let [first, end] = self.ranges[node];
        let is_small = (end - first) as usize <= MAX_LEAF;
        if is_small { half_area(&self.tree.nodes[node]) * block_cost(end - first) } else { f32::INFINITY }
    }

    /// The least cost of both children of an inner node in `n` places, and the number of places of
    /// the left one.
    fn division(&self, node: u32, n: usize) -> (f32, usize) {
        let first = self.tree.nodes[node as usize].first as usize;
        let (left, right) = (&self.least[first], &self.least[first + 1]);
        let costs = (1..n).map(|i| (left[i - 1] + right[n - i - 1], i));
        costs.reduce(|best, other| if other.0 < best.0 { other } else { best }).unwrap_or((0.0, 1))
    }

    /// Adds the nodes that stand for everything below `node` in `n` places.
    fn place(&self, node: u32, n: usize, children: &mut Vec<u32>) {
        if n > 1 && !self.tree.nodes[node as usize].is_leaf() {
            // Of equal costs choose a leaf, then more children: boxes without area cost nothing.
            let (cost, of_left) = self.division(node, n);
            if cost <= self.least[node as usize][0] && cost < self.as_leaf(node as usize) {
                let first = self.tree.nodes[node as usize].first;
                self.place(first, of_left, children);
                return self.place(first + 1, n - of_left, children);
            }
        }
        children.push(node);
    }

    /// Fills the wide node `index` with everything below `node`.
    fn fill_node(&self, node: u32, index: usize, wide: &mut WideTree) {
        // An inner node is never its own child: only the root may be a leaf.
        let flat = &self.tree.nodes[node as usize];
        let mut children = Vec::with_capacity(8);
        if flat.is_leaf() || self.as_leaf(node as usize) <= self.division(node, 8).0 {
            children.push(node);
        } else {
            let (_, of_left) = self.division(node, 8);
            self.place(flat.first, of_left, &mut children);
            self.place(flat.first + 1, 8 - of_left, &mut children);
        }
        // Put the children side by side, and fill them in the same order.
        let next = wide.nodes.len();
        let is_leaf = |child: &u32| self.as_leaf(*child as usize) <= self.least[*child as usize][0];
        for (place, child) in children.iter().enumerate() {
            let content = if node == *child || is_leaf(child) {
                self.add_leaf(*child, wide)
            } else {
                wide.nodes.push(WideNode::EMPTY);
                Child::inner(wide.nodes.len() as u32 - 1)
            };
            wide.nodes[index].set(place, &self.tree.nodes[*child as usize].bounds(), content);
        }
        let inner = children.iter().filter(|&&child| child != node && !is_leaf(&child));
        inner.zip(next..).for_each(|(&child, index)| self.fill_node(child, index, wide));
    }

    /// Adds the blocks of a leaf with everything below `node`.
    fn add_leaf(&self, node: u32, wide: &mut WideTree) -> Child {
        let block = wide.blocks.len() as u32;
        let [first, end] = self.ranges[node as usize];
        for part in self.tree.order[first as usize..end as usize].chunks(BLOCK) {
            let mut ids = [NO_PRIMITIVE; BLOCK];
            ids[..part.len()].copy_from_slice(part);
            wide.blocks.push(ids);
        }
        Child::leaf(block, end - first)
    }
}

/// Half of the surface area of a node's box; 0 for an empty box. It is finite for every box, so
/// that costs can be compared.
fn half_area(node: &FlatNode) -> f32 {
    let size = (node.high - node.low).max(glam::Vec3::ZERO);
    (size.x * size.y + size.y * size.z + size.z * size.x).min(1e30)
}
// </solution>
