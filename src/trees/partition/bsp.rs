//! The BSP tree as data: binary space partitioning by planes in any direction.

use super::planes::{CutPlane, PlaneNode, both_sides};
use super::{Tree, TreeNode};
use crate::message;

/// What a node of a BSP tree contains: a plane with two child nodes, or a range of primitives.
#[derive(Clone, Copy, Debug, PartialEq)]
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
        /// The index in [`Tree::items`] of the leaf's first primitive.
        first: u32,
        /// The number of primitives in the leaf, which may be 0.
        count: u32,
    },
}

message! { enum BspNode { Inner { plane, back, front }, Leaf { first, count } } }

impl TreeNode for BspNode {
    type Region = Vec<(CutPlane, f64)>;

    fn leaf(first: u32, count: u32) -> Self {
        BspNode::Leaf { first, count }
    }

    fn range(&self) -> Option<(u32, u32)> {
        if let BspNode::Leaf { first, count } = *self { Some((first, count)) } else { None }
    }

    fn children(&self) -> impl Iterator<Item = u32> {
        let both = if let BspNode::Inner { back, front, .. } = *self { Some([back, front]) } else { None };
        both.into_iter().flatten()
    }

    fn divide(&self, above: &Vec<(CutPlane, f64)>) -> Vec<Vec<(CutPlane, f64)>> {
        self.plane().map_or(Vec::new(), |plane| both_sides(above, plane))
    }
}

impl PlaneNode for BspNode {
    fn plane(&self) -> Option<CutPlane> {
        if let BspNode::Inner { plane, .. } = *self { Some(plane) } else { None }
    }
}

/// A binary space partition. The root's region is all of space.
pub type Bsp = Tree<BspNode>;

impl Bsp {
    /// Makes `node` an inner node with the children `back` and `front` of `plane`.
    ///
    /// # Panics
    ///
    /// If there is no node with the index `node`. The two children are not checked.
    pub fn set_children(&mut self, node: u32, plane: CutPlane, back: u32, front: u32) {
        self.nodes[node as usize] = BspNode::Inner { plane, back, front };
    }
}
