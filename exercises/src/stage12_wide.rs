//! Stage 12 · trees as fast searches need them: all nodes in one array, and eight children per
//! node.
//!
//! Source: Wald, Benthin and Boulos, "Getting Rid of Packets", 2008.
//!
//! Given: [`FlatTree`], a binary tree with nodes of 32 bytes; [`WideTree`], a tree whose nodes have
//! eight children.

use raykata::bvh::Bvh;
use raykata::wide::{BLOCK, Child, FlatTree, NO_PRIMITIVE, WideNode, WideTree};

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
    todo!("copy the root, then the two children of each node side by side, depth first")
}

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
    todo!("open the child with the largest area until there are eight; fill blocks at the leaves")
}
