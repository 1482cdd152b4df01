//! The BSP tree as data: binary space partitioning by planes in any direction.

use super::{check_depth, limit, walk};
use crate::aabb::Aabb;
use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

/// A plane that divides space: all points `p` with `normal · p = offset`. The front is the side to which the
/// normal points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CutPlane {
    /// The normal of the plane, of unit length.
    pub normal: DVec3,
    /// The signed distance of the plane from the origin along the normal, in world units.
    pub offset: f64,
}

impl CutPlane {
    /// The plane at coordinate `at` (world units) of `axis`, 0 for x, 1 for y, 2 for z; its front has the
    /// larger coordinates.
    ///
    /// # Panics
    ///
    /// If `axis` is above 2.
    pub fn across(axis: usize, at: f64) -> Self {
        CutPlane { normal: DVec3::AXES[axis], offset: at }
    }

    /// A square in the plane around the projection of `point`, with corners at the distance `2 reach` from
    /// it.
    fn square(&self, point: DVec3, reach: f64) -> Vec<DVec3> {
        let foot = point - (self.normal.dot(point) - self.offset) * self.normal;
        let (u, v) = self.normal.any_orthonormal_pair();
        [u, v, -u, -v].map(|way| foot + 2.0 * reach * way).to_vec()
    }

    /// The part of a convex polygon that lies in front of the plane for `side` 1, or behind it for `side` -1
    /// (Sutherland and Hodgman, "Reentrant Polygon Clipping", 1974). `polygon` lists the corners in order, in world
    /// units. The plane belongs to both sides. The part has fewer than three corners if the polygon lies on the
    /// other side, or touches the plane from there in a corner or an edge.
    pub fn keep(&self, polygon: &[DVec3], side: f64) -> Vec<DVec3> {
        let height = |point: DVec3| side * (self.normal.dot(point) - self.offset);
        let next = polygon.iter().cycle().skip(1);
        let edges = polygon.iter().zip(next).flat_map(|(&p, &q)| {
            let (from, to) = (height(p), height(q));
            let crosses = (from < 0.0) != (to < 0.0);
            let crossing = crosses.then(|| p.lerp(q, from / (from - to)));
            [(from >= 0.0).then_some(p), crossing]
        });
        edges.flatten().collect()
    }

    /// The convex polygon to which the box `bounds` and the planes `above` clip this plane, each of which comes with
    /// the side that is kept: 1 in front, -1 behind. `None` if nothing is left.
    pub(super) fn clipped(&self, bounds: &Aabb, above: &[(CutPlane, f64)]) -> Option<Vec<DVec3>> {
        let faces = (0..3).flat_map(|axis| {
            let (low, high) = (f64::from(bounds.min[axis]), f64::from(bounds.max[axis]));
            [(CutPlane::across(axis, low), 1.0), (CutPlane::across(axis, high), -1.0)]
        });
        let size = (bounds.max - bounds.min).as_dvec3().length();
        let square = self.square(0.5 * (bounds.min + bounds.max).as_dvec3(), size);
        let cut = faces
            .chain(above.iter().copied())
            .fold(square, |polygon, (plane, side)| plane.keep(&polygon, side));
        (cut.len() > 2).then_some(cut)
    }

    /// The signed distance of `point` from the plane in world units, computed in double precision: positive
    /// in front of the plane, negative behind it.
    pub fn distance(&self, point: Vec3) -> f64 {
        self.normal.dot(point.as_dvec3()) - self.offset
    }
}

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
        let mut polygons = Vec::new();
        self.walk(|node, above, at| {
            if let BspNode::Inner { plane, .. } = self.nodes[node as usize]
                && at < depth
            {
                polygons.extend(plane.clipped(bounds, above));
            }
        });
        polygons
    }

    /// Calls `each` for all nodes in depth-first order, with the index of the node, the planes above it and
    /// its depth, and returns the number of levels. Each plane comes with the side on which the node lies: 1
    /// in front, -1 behind.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range.
    pub fn walk(&self, mut each: impl FnMut(u32, &[(CutPlane, f64)], usize)) -> usize {
        let root = (!self.nodes.is_empty()).then(Vec::new);
        let below = |node: u32, above: &Vec<(CutPlane, f64)>| match self.nodes[node as usize] {
            BspNode::Inner { plane, back, front } => {
                let with = |side: f64| above.iter().copied().chain([(plane, side)]).collect();
                vec![(back, with(-1.0)), (front, with(1.0))]
            }
            BspNode::Leaf { .. } => Vec::new(),
        };
        walk(root, usize::MAX, below, |node, above, depth| each(node, above, depth))
    }
}
