//! The octree as data: cells that are divided into eight octants.

use super::{Cell, CellTree, Tree, TreeNode};
use crate::aabb::Aabb;
use crate::message;

/// What a node of an octree contains: eight child nodes, or a range of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OctreeNode {
    /// An inner node with the eight nodes `first..first + 8`, in the order of [`Cell::octant`].
    Inner {
        /// The index of the first child.
        first: u32,
    },
    /// A leaf with the primitives `items[first..first + count]`.
    Leaf {
        /// The index in [`Tree::items`] of the leaf's first primitive.
        first: u32,
        /// The number of primitives in the leaf, which may be 0.
        count: u32,
    },
}

message! { enum OctreeNode { Inner { first }, Leaf { first, count } } }

impl TreeNode for OctreeNode {
    type Region = Cell;

    fn leaf(first: u32, count: u32) -> Self {
        OctreeNode::Leaf { first, count }
    }

    fn range(&self) -> Option<(u32, u32)> {
        if let OctreeNode::Leaf { first, count } = *self { Some((first, count)) } else { None }
    }

    fn children(&self) -> impl Iterator<Item = u32> {
        let first = if let OctreeNode::Inner { first } = *self { Some(first) } else { None };
        first.into_iter().flat_map(|first| (0..8).map(move |octant| first.saturating_add(octant)))
    }

    fn divide(&self, cell: &Cell) -> Vec<Cell> {
        match self {
            OctreeNode::Inner { .. } => (0..8).map(|octant| cell.octant(octant)).collect(),
            OctreeNode::Leaf { .. } => Vec::new(),
        }
    }
}

/// Cells that are divided into eight octants where there are many primitives.
pub type Octree = CellTree<OctreeNode>;

impl Octree {
    /// A tree over the cell `bounds` whose only node is the root, a leaf without primitives.
    pub fn new(bounds: Aabb) -> Self {
        let mut octree = Octree { bounds, tree: Tree::default() };
        octree.add_node(0, 0);
        octree
    }

    /// The tree over no primitives: without nodes, over the empty box.
    pub fn empty() -> Self {
        Octree { bounds: Aabb::EMPTY, tree: Tree::default() }
    }

    /// Makes `node` an inner node with eight new children, which are leaves without primitives at `depth`
    /// (the root has depth 0). Returns the index of the first child; the others follow it. `node` must be an
    /// existing node.
    ///
    /// # Panics
    ///
    /// If `depth` is above `max_depth`. Then the recursion would never end.
    #[track_caller]
    pub fn divide(&mut self, node: u32, depth: usize, max_depth: usize) -> u32 {
        let first = self.add_nodes(8, depth, max_depth);
        self.nodes[node as usize] = OctreeNode::Inner { first };
        first
    }
}
