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
    todo!("copy the root, then the two children of each node side by side, depth first")
}

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
    todo!("from the last node to the first: the least cost as 1 to 8 children; then build what costs least")
}
