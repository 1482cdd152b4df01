//! The BSP tree of the lecture slide as data: its nodes hold the polygons that lie on their planes.

use super::planes::{CutPlane, PlaneNode, both_sides};
use super::{Tree, TreeNode};
use crate::message;
use std::ops::{Deref, DerefMut};

/// What a node of a [`PolygonBsp`] contains: a plane with the polygons on it and two child nodes, or a range of
/// primitives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PolygonBspNode {
    /// An inner node: the polygons `items[first..first + count]` lie on the plane, at least with a part.
    Inner {
        /// The plane that divides the region of the node.
        plane: CutPlane,
        /// The index in [`Tree::items`] of the first polygon on the plane.
        first: u32,
        /// The number of polygons on the plane, which may be 0.
        count: u32,
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

message! { enum PolygonBspNode { Inner { plane, first, count, back, front }, Leaf { first, count } } }

impl TreeNode for PolygonBspNode {
    type Region = Vec<(CutPlane, f64)>;

    fn leaf(first: u32, count: u32) -> Self {
        PolygonBspNode::Leaf { first, count }
    }

    fn range(&self) -> Option<(u32, u32)> {
        let (PolygonBspNode::Leaf { first, count } | PolygonBspNode::Inner { first, count, .. }) = *self;
        Some((first, count))
    }

    fn children(&self) -> impl Iterator<Item = u32> {
        let both =
            if let PolygonBspNode::Inner { back, front, .. } = *self { Some([back, front]) } else { None };
        both.into_iter().flatten()
    }

    fn divide(&self, above: &Vec<(CutPlane, f64)>) -> Vec<Vec<(CutPlane, f64)>> {
        self.plane().map_or(Vec::new(), |plane| both_sides(above, plane))
    }
}

impl PlaneNode for PolygonBspNode {
    fn plane(&self) -> Option<CutPlane> {
        if let PolygonBspNode::Inner { plane, .. } = *self { Some(plane) } else { None }
    }
}

/// A binary space partition with polygons in its nodes. The root's region is all of space. A polygon is listed in each
/// node on whose plane one of its parts lies; a primitive that is no polygon is listed in every leaf that it overlaps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PolygonBsp {
    /// The nodes and the primitives that they list.
    pub tree: Tree<PolygonBspNode>,
    /// The distance from a plane, in world units and at least 0, within which points count as points of the plane.
    /// A polygon in front of a plane may extend behind it by this distance.
    pub room: f64,
}

message! { PolygonBsp { tree, room } }

impl Deref for PolygonBsp {
    type Target = Tree<PolygonBspNode>;

    fn deref(&self) -> &Self::Target {
        &self.tree
    }
}

impl DerefMut for PolygonBsp {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut self.tree
    }
}

impl PolygonBsp {
    /// Makes `node` an inner node with the polygons `on_plane` and the children `back` and `front` of `plane`:
    /// appends the numbers of the polygons to [`Tree::items`]. Call it once per node.
    ///
    /// # Panics
    ///
    /// As [`Tree::set_leaf`]. The two children are not checked.
    #[track_caller]
    pub fn set_children(&mut self, node: u32, plane: CutPlane, on_plane: &[u32], back: u32, front: u32) {
        let (first, count) = self.append(on_plane);
        self.nodes[node as usize] = PolygonBspNode::Inner { plane, first, count, back, front };
    }
}
