//! Stage 12 · trees as fast searches need them: all nodes in one array, and eight children per
//! node.
//!
//! Source: Wald, Benthin and Boulos, "Getting Rid of Packets", 2008.
//!
//! Given: [`FlatTree`], a binary tree with nodes of 32 bytes; [`WideTree`], a tree whose nodes have
//! eight children.

use raykata::bvh::Bvh;
use raykata::wide::{BLOCK, Child, FlatTree, NO_PRIMITIVE, WideNode, WideTree};

// <solution>
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
/// - The left child A comes first, and all below A before all below B.
/// - Boxes, leaves and the order of the primitives stay as they are.
/// - A hierarchy without nodes gives a tree without nodes.
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

/// Turns a binary tree into one with eight children per node. A node takes its two children, and
/// replaces the inner child with the largest surface area by its own two, until there are eight or
/// only leaves. Which child does a ray enter most probably?
///
/// Exactly:
///
/// - Each leaf becomes one leaf with the same box and primitives.
/// - Its primitives fill whole blocks of four, in order; free lanes of the last block have
///   [`NO_PRIMITIVE`].
/// - The children of a node come before its empty places.
/// - A parent has a smaller index than its children.
/// - A root that is a leaf becomes the only child of one node; no nodes give no nodes.
pub fn collapse(tree: &FlatTree) -> WideTree {
    // <solution>
    let mut wide = WideTree::default();
    if let Some(root) = tree.nodes.first() {
        wide.nodes.reserve(tree.nodes.len() / 8);
        wide.blocks.reserve(tree.order.len() / 3);
        let children = if root.is_leaf() { Children::one(0) } else { open(tree, 0) };
        add_node(tree, &children, &mut wide);
    }
    wide
    // <stub> todo!("open the child with the largest area until there are eight; fill blocks at the leaves")
    // </solution>
}

// <solution>
/// Up to eight nodes of the binary tree, which become the children of one wide node.
struct Children {
    nodes: [u32; 8],
    len: usize,
}

impl Children {
    fn one(node: u32) -> Children {
        Children { nodes: [node; 8], len: 1 }
    }
}

/// The nodes of the binary tree that become the children of the inner node `node`.
fn open(tree: &FlatTree, node: u32) -> Children {
    let mut children = Children::one(node);
    // Remember the area of each child that can be opened; it is negative for a leaf.
    let area = |node: u32| {
        let node = &tree.nodes[node as usize];
        if node.is_leaf() { -1.0 } else { half_area(node) }
    };
    let mut areas = [f32::INFINITY; 8];
    while children.len < 8 {
        // Find the inner child with the largest area. A box without area is opened as well.
        let mut largest = 0;
        for i in 1..children.len {
            if areas[i] > areas[largest] {
                largest = i;
            }
        }
        if areas[largest] < 0.0 {
            break;
        }
        // Replace it by its two children.
        let first = tree.nodes[children.nodes[largest] as usize].first;
        for (place, node) in [(largest, first), (children.len, first + 1)] {
            children.nodes[place] = node;
            areas[place] = area(node);
        }
        children.len += 1;
    }
    children
}

/// Half of the surface area of a node's box; 0 for an empty box.
fn half_area(node: &FlatNode) -> f32 {
    let size = (node.high - node.low).max(glam::Vec3::ZERO);
    size.x * size.y + size.y * size.z + size.z * size.x
}

/// Adds a wide node with these children and everything below it, and returns its index.
fn add_node(tree: &FlatTree, children: &Children, wide: &mut WideTree) -> u32 {
    let index = wide.nodes.len();
    wide.nodes.push(WideNode::EMPTY);
    for place in 0..children.len {
        let number = children.nodes[place];
        let node = &tree.nodes[number as usize];
        let child = if node.is_leaf() {
            add_leaf(tree, node, wide)
        } else {
            Child::inner(add_node(tree, &open(tree, number), wide))
        };
        wide.nodes[index].set(place, &node.bounds(), child);
    }
    index as u32
}

/// Adds the blocks of a leaf.
fn add_leaf(tree: &FlatTree, leaf: &FlatNode, wide: &mut WideTree) -> Child {
    let first = wide.blocks.len() as u32;
    let primitives = &tree.order[leaf.first as usize..(leaf.first + leaf.count) as usize];
    for part in primitives.chunks(BLOCK) {
        let mut block = [NO_PRIMITIVE; BLOCK];
        block[..part.len()].copy_from_slice(part);
        wide.blocks.push(block);
    }
    Child::leaf(first, leaf.count)
}
// </solution>
