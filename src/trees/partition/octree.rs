//! The octree as data: cells that are divided into eight octants.

use super::{Cell, check_depth, limit, walk};
use crate::aabb::Aabb;
use serde::{Deserialize, Serialize};

/// What a node of an octree contains: eight child nodes, or a range of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum OctreeNode {
    /// An inner node with the eight nodes `first..first + 8`, in the order of [`Cell::octant`].
    Inner {
        /// The index of the first child.
        first: u32,
    },
    /// A leaf with the primitives `items[first..first + count]`.
    Leaf {
        /// The index in [`Octree::items`] of the leaf's first primitive.
        first: u32,
        /// The number of primitives in the leaf, which may be 0.
        count: u32,
    },
}

/// Cells that are divided into eight octants where there are many primitives. Node 0 is the root, whose cell
/// is `bounds`; the cells of the other nodes are its octants, computed on the way down. A tree over no
/// primitives has no nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Octree {
    /// The cell of the root, in world units; it contains all primitives that can be hit.
    pub bounds: Aabb,
    /// All nodes. A parent has a smaller index than its children.
    pub nodes: Vec<OctreeNode>,
    /// The numbers of primitives, those of a leaf adjacent. A primitive is listed in every leaf that it
    /// overlaps.
    pub items: Vec<u32>,
}

impl Octree {
    /// A tree over the cell `bounds` whose only node is the root, a leaf without primitives.
    pub fn new(bounds: Aabb) -> Self {
        Octree { bounds, nodes: vec![OctreeNode::Leaf { first: 0, count: 0 }], items: Vec::new() }
    }

    /// The tree over no primitives: without nodes, over the empty box.
    pub fn empty() -> Self {
        Octree { bounds: Aabb::EMPTY, nodes: Vec::new(), items: Vec::new() }
    }

    /// Makes `node` a leaf with `primitives`: appends their numbers to [`Octree::items`]. Call it once per
    /// leaf.
    ///
    /// # Panics
    ///
    /// If there is no node with the index `node`. In frames and checks also if the leaves list more than
    /// [`MOST_REFERENCES`](super::MOST_REFERENCES) references per primitive.
    #[track_caller]
    pub fn set_leaf(&mut self, node: u32, primitives: &[u32]) {
        limit::count(primitives.len());
        let first = self.items.len() as u32;
        self.items.extend(primitives);
        self.nodes[node as usize] = OctreeNode::Leaf { first, count: primitives.len() as u32 };
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
        check_depth(depth, max_depth);
        let first = self.nodes.len() as u32;
        self.nodes.extend([OctreeNode::Leaf { first: 0, count: 0 }; 8]);
        self.nodes[node as usize] = OctreeNode::Inner { first };
        first
    }

    /// The numbers of the primitives of a leaf, `items[first..first + count]`.
    ///
    /// # Panics
    ///
    /// If the range does not lie in [`Octree::items`].
    pub fn primitives(&self, first: u32, count: u32) -> &[u32] {
        &self.items[first as usize..(first + count) as usize]
    }

    /// The number of nodes on the longest path from the root to a leaf, both counted; 0 if there are no
    /// nodes.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range.
    pub fn depth(&self) -> usize {
        self.walk(usize::MAX, |_, _, _| {})
    }

    /// The cells at `depth` (the root has depth 0), and the leaves above it, as boxes for drawing.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range.
    pub fn cells(&self, depth: usize) -> Vec<Aabb> {
        let is_leaf = |node: u32| matches!(self.nodes[node as usize], OctreeNode::Leaf { .. });
        let mut cells = Vec::new();
        self.walk(depth, |node, cell, at| {
            cells.extend((at == depth || is_leaf(node)).then(|| cell.to_box()));
        });
        cells
    }

    /// Calls `each` for all nodes down to depth `most` in depth-first order, with the index of the node, its
    /// cell and its depth, and returns the number of levels that it reached.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range.
    pub fn walk(&self, most: usize, mut each: impl FnMut(u32, Cell, usize)) -> usize {
        let root = (!self.nodes.is_empty()).then(|| Cell::new(&self.bounds));
        let below = |node: u32, cell: &Cell| match self.nodes[node as usize] {
            OctreeNode::Inner { first } => (0..8).map(|i| (first + i, cell.octant(i as usize))).collect(),
            OctreeNode::Leaf { .. } => Vec::new(),
        };
        walk(root, most, below, |node, cell, depth| each(node, *cell, depth))
    }
}
