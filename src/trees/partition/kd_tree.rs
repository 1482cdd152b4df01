//! The kd-tree as data: binary space partitioning by planes across the axes.

use super::{Cell, CellTree, Tree, TreeNode};
use crate::aabb::Aabb;
use crate::message;
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

message! { KdHeuristics { longest_axis, balanced_counts, few_straddlers, cut_off_empty_space, stop_at_overlap } }

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
#[derive(Clone, Copy, Debug, PartialEq)]
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
        /// The index in [`Tree::items`] of the leaf's first primitive.
        first: u32,
        /// The number of primitives in the leaf, which may be 0.
        count: u32,
    },
}

message! { enum KdNode { Inner { axis, at, left, right }, Leaf { first, count } } }

impl TreeNode for KdNode {
    type Region = Cell;

    fn leaf(first: u32, count: u32) -> Self {
        KdNode::Leaf { first, count }
    }

    fn range(&self) -> Option<(u32, u32)> {
        if let KdNode::Leaf { first, count } = *self { Some((first, count)) } else { None }
    }

    fn children(&self) -> impl Iterator<Item = u32> {
        let both = if let KdNode::Inner { left, right, .. } = *self { Some([left, right]) } else { None };
        both.into_iter().flatten()
    }

    fn divide(&self, cell: &Cell) -> Vec<Cell> {
        match *self {
            KdNode::Inner { axis, at, .. } => cell.cut(usize::from(axis), f64::from(at)).into(),
            KdNode::Leaf { .. } => Vec::new(),
        }
    }
}

/// Cells that planes across the axes divide in two.
pub type KdTree = CellTree<KdNode>;

impl KdTree {
    /// A tree without nodes over the cell `bounds`, to which a builder adds the root first.
    pub fn new(bounds: Aabb) -> Self {
        KdTree { bounds, tree: Tree::default() }
    }

    /// The greatest depth of a tree over `n_primitives` primitives, where the root has depth 0:
    /// `8 + 1.3 log₂ n`, rounded down. Deeper trees gain nothing (Havran, "Heuristic Ray Shooting
    /// Algorithms", 2000). No primitives count as one.
    pub fn most_depth(n_primitives: usize) -> usize {
        8 + (1.3 * (n_primitives.max(1) as f64).log2()) as usize
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
}
