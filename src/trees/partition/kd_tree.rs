//! The kd-tree as data: binary space partitioning by planes across the axes.

use super::{Cell, check_depth, limit, walk};
use crate::aabb::Aabb;
use serde::{Deserialize, Serialize};

/// Which of the five heuristics of the lecture ("Heuristics" 1 to 5) a builder follows; the default is all of
/// them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct KdHeuristics {
    /// Divide across the longest side of the cell; without it across x, y, z in turn.
    pub longest_axis: bool,
    /// Divide such that both sides have roughly the same number of primitives; without it in the middle.
    pub balanced_counts: bool,
    /// Avoid planes with many primitives on both sides.
    pub few_straddlers: bool,
    /// Cut off empty space as soon as possible.
    pub cut_off_empty_space: bool,
    /// Stop dividing if 60 % of the primitives on one side are also on the other.
    pub stop_at_overlap: bool,
}

impl KdHeuristics {
    /// No heuristic, which is the "easy way" of the lecture: planes across x, y, z in turn, in the middle of the cell.
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

/// What a node of a kd-tree contains: a plane with two child nodes, or a range of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum KdNode {
    /// An inner node: two nodes, one on each side of a plane.
    Inner {
        /// The axis across which the plane lies: 0 for x, 1 for y, 2 for z.
        axis: u8,
        /// The coordinate of the plane on that axis, in world units.
        at: f32,
        /// The index of the node with the smaller coordinates.
        left: u32,
        /// The index of the node with the larger coordinates.
        right: u32,
    },
    /// A leaf with the primitives `items[first..first + count]`.
    Leaf {
        /// The index in [`KdTree::items`] of the leaf's first primitive.
        first: u32,
        /// The number of primitives in the leaf, which may be 0.
        count: u32,
    },
}

/// Cells that planes across the axes divide in two. Node 0 is the root, whose cell is `bounds`. A tree over
/// no primitives has no nodes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct KdTree {
    /// The cell of the root, in world units; it contains all primitives that can be hit.
    pub bounds: Aabb,
    /// All nodes. A parent has a smaller index than its children.
    pub nodes: Vec<KdNode>,
    /// The numbers of primitives, those of a leaf adjacent. A primitive is listed in every leaf that it
    /// overlaps.
    pub items: Vec<u32>,
}

impl KdTree {
    /// A tree without nodes over the cell `bounds`, to which a builder adds the root first.
    pub fn new(bounds: Aabb) -> Self {
        KdTree { bounds, nodes: Vec::new(), items: Vec::new() }
    }

    /// The greatest depth of a tree over `n_primitives` primitives, where the root has depth 0:
    /// `8 + 1.3 log₂ n`, rounded down. Deeper trees gain nothing (Havran, "Heuristic Ray Shooting
    /// Algorithms", 2000). No primitives count as one.
    pub fn most_depth(n_primitives: usize) -> usize {
        8 + (1.3 * (n_primitives.max(1) as f64).log2()) as usize
    }

    /// Adds a node at `depth` (the root has depth 0) and returns its index. It is a leaf without primitives
    /// until [`KdTree::set_leaf`] or [`KdTree::set_children`] changes it.
    ///
    /// # Panics
    ///
    /// If `depth` is above `max_depth`. Then the recursion would never end.
    #[track_caller]
    pub fn add_node(&mut self, depth: usize, max_depth: usize) -> u32 {
        check_depth(depth, max_depth);
        self.nodes.push(KdNode::Leaf { first: 0, count: 0 });
        self.nodes.len() as u32 - 1
    }

    /// Makes `node` a leaf with `primitives`: appends their numbers to [`KdTree::items`]. Call it once per
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
        self.nodes[node as usize] = KdNode::Leaf { first, count: primitives.len() as u32 };
    }

    /// Makes `node` an inner node with the children `left` and `right` of the plane at `at` (world units)
    /// across `axis`, 0 for x, 1 for y, 2 for z.
    ///
    /// # Panics
    ///
    /// If there is no node with the index `node`. The axis and the two children are not checked.
    pub fn set_children(&mut self, node: u32, axis: usize, at: f32, left: u32, right: u32) {
        self.nodes[node as usize] = KdNode::Inner { axis: axis as u8, at, left, right };
    }

    /// The numbers of the primitives of a leaf, `items[first..first + count]`.
    ///
    /// # Panics
    ///
    /// If the range does not lie in [`KdTree::items`].
    pub fn primitives(&self, first: u32, count: u32) -> &[u32] {
        &self.items[first as usize..(first + count) as usize]
    }

    /// The number of nodes on the longest path from the root to a leaf, both counted; 0 if there are no
    /// nodes.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range, or an axis is above 2.
    pub fn depth(&self) -> usize {
        self.walk(usize::MAX, |_, _, _| {})
    }

    /// The cells at `depth` (the root has depth 0), and the leaves above it, as boxes for drawing.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range, or an axis is above 2.
    pub fn cells(&self, depth: usize) -> Vec<Aabb> {
        let is_leaf = |node: u32| matches!(self.nodes[node as usize], KdNode::Leaf { .. });
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
    /// If a child's index is out of range, or an axis is above 2.
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
