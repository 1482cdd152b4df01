//! Stage 12 · trees as fast searches need them: all nodes in one array, and eight children per node.
//!
//! Source: Wald, Benthin and Boulos, "Getting Rid of Packets", 2008.
//!
//! Given: [`FlatTree`], a binary tree with nodes of 32 bytes; [`WideTree`], a tree whose nodes have eight children.

use raykata::bvh::Bvh;
use raykata::wide::{BLOCK, Child, FlatTree, NO_PRIMITIVE, WideNode, WideTree};

/// Copies a hierarchy of stage 3 into the layout of [`FlatTree`]: nodes of 32 bytes, the two children of a node next to each
/// other, and the nodes below the first child before those below the second.
///
/// Boxes, leaves and the order of the primitives stay as they are, and the left child comes first. Neighbours are read together: a line of the cache holds 64
/// bytes, which is a pair of children. A hierarchy without nodes gives a tree without nodes.
pub fn flatten(bvh: &Bvh) -> FlatTree {
    todo!("copy the root, then the two children of each node side by side, depth first")
}

/// Collapses a binary tree into one with eight children per node: a node takes its two children, and then replaces the inner
/// child with the largest surface area by the two children of that child, until it has eight children or only leaves.
///
/// Each leaf of the binary tree becomes one leaf of the wide tree, with the same box and primitives. Its primitives fill
/// whole blocks of four, in order; free lanes of the last block have [`NO_PRIMITIVE`]. The children of a node come first, then
/// its empty places. If the root is a leaf, the wide tree has one node with one child. A tree without nodes gives a tree
/// without nodes. A parent has a smaller index than its children.
///
/// Why the largest area: a ray that enters a node enters a child with a probability proportional to the child's area, so this
/// child saves most visits.
pub fn collapse(tree: &FlatTree) -> WideTree {
    todo!("open the child with the largest area until there are eight; fill blocks at the leaves")
}
