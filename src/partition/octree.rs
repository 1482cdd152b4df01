//! The octree as data.

use super::{Cell, check_depth, walk};
use crate::aabb::Aabb;
use serde::{Deserialize, Serialize};

/// What a node of an octree holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum OctreeNode {
    /// The eight nodes `first..first + 8`, in the order of [`Cell::octant`].
    Inner {
        /// Number of the first child.
        first: u32,
    },
    /// The primitives `items[first..first + count]`.
    Leaf {
        /// Where they begin in [`Octree::items`].
        first: u32,
        /// How many they are; a leaf may hold none.
        count: u32,
    },
}

/// Cells that are divided in eight wherever there is much. Node 0 is the root and has the cell `bounds`; the cells below
/// are its octants, worked out on the way down. A tree over nothing has no nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Octree {
    /// The cell of the root: all that can be met lies within.
    pub bounds: Aabb,
    /// All nodes, a parent before its children.
    pub nodes: Vec<OctreeNode>,
    /// Numbers of primitives, those of a leaf side by side. A primitive stands in every leaf that it reaches into.
    pub items: Vec<u32>,
}

impl Octree {
    /// A tree with a root that is a leaf with nothing in it.
    pub fn new(bounds: Aabb) -> Self {
        Octree { bounds, nodes: vec![OctreeNode::Leaf { first: 0, count: 0 }], items: Vec::new() }
    }

    /// A tree over nothing.
    pub fn empty() -> Self {
        Octree { bounds: Aabb::EMPTY, nodes: Vec::new(), items: Vec::new() }
    }

    /// Makes `node` a leaf that holds `primitives`.
    pub fn set_leaf(&mut self, node: u32, primitives: &[u32]) {
        let first = self.items.len() as u32;
        self.items.extend(primitives);
        self.nodes[node as usize] = OctreeNode::Leaf { first, count: primitives.len() as u32 };
    }

    /// Gives `node` eight children, which are at `depth`, the root being at 0: leaves with nothing in them. Tells the
    /// first.
    ///
    /// # Panics
    ///
    /// When `depth` is beyond `max_depth`: then the recursion would never end.
    #[track_caller]
    pub fn divide(&mut self, node: u32, depth: usize, max_depth: usize) -> u32 {
        check_depth(depth, max_depth);
        let first = self.nodes.len() as u32;
        self.nodes.extend([OctreeNode::Leaf { first: 0, count: 0 }; 8]);
        self.nodes[node as usize] = OctreeNode::Inner { first };
        first
    }

    /// The primitives of a leaf.
    pub fn primitives(&self, first: u32, count: u32) -> &[u32] {
        &self.items[first as usize..(first + count) as usize]
    }

    /// Nodes on the longest way down, the root counted; 0 when there is nothing.
    pub fn depth(&self) -> usize {
        self.walk(usize::MAX, |_, _, _| {})
    }

    /// The cells at `depth`, and the leaves above it, as boxes to be drawn. The root is at depth 0.
    pub fn cells(&self, depth: usize) -> Vec<Aabb> {
        let is_leaf = |node: u32| matches!(self.nodes[node as usize], OctreeNode::Leaf { .. });
        let mut cells = Vec::new();
        self.walk(depth, |node, cell, at| {
            cells.extend((at == depth || is_leaf(node)).then(|| cell.to_box()));
        });
        cells
    }

    /// Tells `each` about all nodes down to `most`: number, cell and depth. How many levels it came to.
    pub fn walk(&self, most: usize, mut each: impl FnMut(u32, Cell, usize)) -> usize {
        let root = (!self.nodes.is_empty()).then(|| Cell::new(&self.bounds));
        let below = |node: u32, cell: &Cell| match self.nodes[node as usize] {
            OctreeNode::Inner { first } => (0..8).map(|i| (first + i, cell.octant(i as usize))).collect(),
            OctreeNode::Leaf { .. } => Vec::new(),
        };
        walk(root, most, below, |node, cell, depth| each(node, *cell, depth))
    }
}
