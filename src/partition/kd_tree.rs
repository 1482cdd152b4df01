//! The kd-tree as data.

use super::{Cell, check_depth, walk};
use crate::aabb::Aabb;
use serde::{Deserialize, Serialize};

/// Which of the five heuristics of the lecture a builder follows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct KdHeuristics {
    /// Divide along the largest dimension; without it along x, y, z by turns.
    pub longest_axis: bool,
    /// Divide such that both sides have roughly the same number of shapes; without it in the middle.
    pub balanced_counts: bool,
    /// Avoid planes with many shapes on both sides.
    pub few_straddlers: bool,
    /// Cut off empty space as soon as possible.
    pub cut_off_empty_space: bool,
    /// Do not divide any further if 60 % of the shapes on one side are also on the other.
    pub stop_at_overlap: bool,
}

impl KdHeuristics {
    /// None of them.
    pub const NONE: KdHeuristics = KdHeuristics {
        longest_axis: false,
        balanced_counts: false,
        few_straddlers: false,
        cut_off_empty_space: false,
        stop_at_overlap: false,
    };
}

impl Default for KdHeuristics {
    fn default() -> Self {
        KdHeuristics {
            longest_axis: true,
            balanced_counts: true,
            few_straddlers: true,
            cut_off_empty_space: true,
            stop_at_overlap: true,
        }
    }
}

/// What a node of a kd-tree holds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum KdNode {
    /// Two nodes, one on either side of a plane.
    Inner {
        /// 0 for a plane across x, 1 across y, 2 across z.
        axis: u8,
        /// Where on that axis.
        at: f32,
        /// The node with the smaller coordinates.
        left: u32,
        /// The node with the larger ones.
        right: u32,
    },
    /// The primitives `items[first..first + count]`.
    Leaf {
        /// Where they begin in [`KdTree::items`].
        first: u32,
        /// How many they are; a leaf may hold none.
        count: u32,
    },
}

/// Cells that planes across the axes divide in two. Node 0 is the root and has the cell `bounds`. A tree over nothing has
/// no nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct KdTree {
    /// The cell of the root: all that can be met lies within.
    pub bounds: Aabb,
    /// All nodes, a parent before its children.
    pub nodes: Vec<KdNode>,
    /// Numbers of primitives, those of a leaf side by side. A primitive stands in every leaf that it reaches into.
    pub items: Vec<u32>,
}

impl KdTree {
    /// A tree over nothing, or the beginning of one over what lies in `bounds`.
    pub fn new(bounds: Aabb) -> Self {
        KdTree { bounds, nodes: Vec::new(), items: Vec::new() }
    }

    /// The greatest depth of a tree over so many primitives, the root being at depth 0: where cuts stop helping (Havran,
    /// "Heuristic Ray Shooting Algorithms", 2000).
    pub fn most_depth(n_primitives: usize) -> usize {
        8 + (1.3 * (n_primitives.max(1) as f64).log2()) as usize
    }

    /// Adds a node at `depth` and gives its number. It is a leaf with nothing in it until [`KdTree::set_leaf`] or
    /// [`KdTree::set_children`] says otherwise.
    ///
    /// # Panics
    ///
    /// When `depth` is beyond `max_depth`: then the recursion would never end.
    #[track_caller]
    pub fn add_node(&mut self, depth: usize, max_depth: usize) -> u32 {
        check_depth(depth, max_depth);
        self.nodes.push(KdNode::Leaf { first: 0, count: 0 });
        self.nodes.len() as u32 - 1
    }

    /// Makes `node` a leaf that holds `primitives`.
    pub fn set_leaf(&mut self, node: u32, primitives: &[u32]) {
        let first = self.items.len() as u32;
        self.items.extend(primitives);
        self.nodes[node as usize] = KdNode::Leaf { first, count: primitives.len() as u32 };
    }

    /// Makes `node` the parent of `left` and `right`, on either side of the plane at `at` across `axis`.
    pub fn set_children(&mut self, node: u32, axis: usize, at: f32, left: u32, right: u32) {
        self.nodes[node as usize] = KdNode::Inner { axis: axis as u8, at, left, right };
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
        let is_leaf = |node: u32| matches!(self.nodes[node as usize], KdNode::Leaf { .. });
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
            KdNode::Inner { axis, at, left, right } => {
                let [below, above] = cell.cut(usize::from(axis), f64::from(at));
                vec![(left, below), (right, above)]
            }
            KdNode::Leaf { .. } => Vec::new(),
        };
        walk(root, most, below, |node, cell, depth| each(node, *cell, depth))
    }
}
