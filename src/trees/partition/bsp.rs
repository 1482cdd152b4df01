//! The BSP tree as data: binary space partitioning by planes in any direction.

use super::planes::{CutPlane, polygons, walk_planes};
use super::{check_depth, limit};
use crate::aabb::Aabb;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// What a node of a BSP tree contains: a plane with two child nodes, or a range of primitives.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum BspNode {
    /// An inner node: two nodes, one on each side of a plane.
    Inner {
        /// The plane that divides the region of the node.
        plane: CutPlane,
        /// The index of the node behind the plane.
        back: u32,
        /// The index of the node in front of the plane.
        front: u32,
    },
    /// A leaf with the primitives `items[first..first + count]`.
    Leaf {
        /// The index in [`Bsp::items`] of the leaf's first primitive.
        first: u32,
        /// The number of primitives in the leaf, which may be 0.
        count: u32,
    },
}

/// A binary space partition. Node 0 is the root, whose region is all of space. A tree over no primitives has
/// no nodes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bsp {
    /// All nodes. A parent has a smaller index than its children.
    pub nodes: Vec<BspNode>,
    /// The numbers of primitives, those of a leaf adjacent. A primitive is listed in every leaf that it
    /// overlaps.
    pub items: Vec<u32>,
}

impl Bsp {
    /// Adds a node at `depth` (the root has depth 0) and returns its index. It is a leaf without primitives
    /// until [`Bsp::set_leaf`] or [`Bsp::set_children`] changes it.
    ///
    /// # Panics
    ///
    /// If `depth` is above `max_depth`. Then the recursion would never end.
    #[track_caller]
    pub fn add_node(&mut self, depth: usize, max_depth: usize) -> u32 {
        check_depth(depth, max_depth);
        self.nodes.push(BspNode::Leaf { first: 0, count: 0 });
        self.nodes.len() as u32 - 1
    }

    /// Makes `node` a leaf with `primitives`: appends their numbers to [`Bsp::items`]. Call it once per leaf.
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
        self.nodes[node as usize] = BspNode::Leaf { first, count: primitives.len() as u32 };
    }

    /// Makes `node` an inner node with the children `back` and `front` of `plane`.
    ///
    /// # Panics
    ///
    /// If there is no node with the index `node`. The two children are not checked.
    pub fn set_children(&mut self, node: u32, plane: CutPlane, back: u32, front: u32) {
        self.nodes[node as usize] = BspNode::Inner { plane, back, front };
    }

    /// The numbers of the primitives of a leaf, `items[first..first + count]`.
    ///
    /// # Panics
    ///
    /// If the range does not lie in [`Bsp::items`].
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
        self.walk(|_, _, _| {})
    }

    /// The planes of the inner nodes above `depth` (the root has depth 0), each as the convex polygon to
    /// which the planes above it and the box `bounds` clip it, in world units. Planes of which nothing is
    /// left are not in the result.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range.
    pub fn polygons(&self, bounds: &Aabb, depth: usize) -> Vec<Vec<DVec3>> {
        polygons(self.nodes.len(), |node| self.inner(node), bounds, depth)
    }

    /// Calls `each` for all nodes in depth-first order, with the index of the node, the planes above it and
    /// its depth, and returns the number of levels. Each plane comes with the side on which the node lies: 1
    /// in front, -1 behind.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range.
    pub fn walk(&self, each: impl FnMut(u32, &[(CutPlane, f64)], usize)) -> usize {
        walk_planes(self.nodes.len(), |node| self.inner(node), each)
    }
    /// The plane of an inner node and its children behind and in front of the plane; `None` for a leaf.
    fn inner(&self, node: u32) -> Option<(CutPlane, [u32; 2])> {
        match self.nodes[node as usize] {
            BspNode::Inner { plane, back, front } => Some((plane, [back, front])),
            BspNode::Leaf { .. } => None,
        }
    }
}
