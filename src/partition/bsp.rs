//! The BSP tree as data: planes in any direction.

use super::{check_depth, walk};
use crate::aabb::Aabb;
use glam::{DVec3, Vec3};
use serde::{Deserialize, Serialize};

/// A plane that divides space: all points `p` with `normal · p = offset`. In front is where the normal points.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CutPlane {
    /// At right angles to the plane, of length 1.
    pub normal: DVec3,
    /// The distance of the plane from the origin of space, along the normal.
    pub offset: f64,
}

impl CutPlane {
    /// The plane across `axis` at `at`.
    pub fn across(axis: usize, at: f64) -> Self {
        CutPlane { normal: DVec3::AXES[axis], offset: at }
    }

    /// A square in the plane, with corners this far from the foot of `point`.
    fn square(&self, point: DVec3, reach: f64) -> Vec<DVec3> {
        let foot = point - (self.normal.dot(point) - self.offset) * self.normal;
        let (u, v) = self.normal.any_orthonormal_pair();
        [u, v, -u, -v].map(|way| foot + 2.0 * reach * way).to_vec()
    }

    /// What of a convex polygon is in front of the plane for `side` 1, or behind it for -1.
    fn keep(&self, polygon: &[DVec3], side: f64) -> Vec<DVec3> {
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

    /// How far in front of the plane `point` lies; negative behind it.
    pub fn distance(&self, point: Vec3) -> f64 {
        self.normal.dot(point.as_dvec3()) - self.offset
    }
}

/// What a node of a BSP tree holds.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum BspNode {
    /// Two nodes, one on either side of a plane.
    Inner {
        /// The plane.
        plane: CutPlane,
        /// The node behind it.
        back: u32,
        /// The node in front of it.
        front: u32,
    },
    /// The primitives `items[first..first + count]`.
    Leaf {
        /// Where they begin in [`Bsp::items`].
        first: u32,
        /// How many they are; a leaf may hold none.
        count: u32,
    },
}

/// Space, divided by planes in any direction. Node 0 is the root and is all of space. A tree over nothing has no nodes.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Bsp {
    /// All nodes, a parent before its children.
    pub nodes: Vec<BspNode>,
    /// Numbers of primitives, those of a leaf side by side. A primitive stands in every leaf that it reaches into.
    pub items: Vec<u32>,
}

impl Bsp {
    /// Adds a node at `depth`, the root being at depth 0, and gives its number. It is a leaf with nothing in it until
    /// [`Bsp::set_leaf`] or [`Bsp::set_children`] says otherwise.
    ///
    /// # Panics
    ///
    /// When `depth` is beyond `max_depth`: then the recursion would never end.
    #[track_caller]
    pub fn add_node(&mut self, depth: usize, max_depth: usize) -> u32 {
        check_depth(depth, max_depth);
        self.nodes.push(BspNode::Leaf { first: 0, count: 0 });
        self.nodes.len() as u32 - 1
    }

    /// Makes `node` a leaf that holds `primitives`.
    pub fn set_leaf(&mut self, node: u32, primitives: &[u32]) {
        let first = self.items.len() as u32;
        self.items.extend(primitives);
        self.nodes[node as usize] = BspNode::Leaf { first, count: primitives.len() as u32 };
    }

    /// Makes `node` the parent of `back` and `front`.
    pub fn set_children(&mut self, node: u32, plane: CutPlane, back: u32, front: u32) {
        self.nodes[node as usize] = BspNode::Inner { plane, back, front };
    }

    /// The primitives of a leaf.
    pub fn primitives(&self, first: u32, count: u32) -> &[u32] {
        &self.items[first as usize..(first + count) as usize]
    }

    /// Nodes on the longest way down, the root counted; 0 when there is nothing.
    pub fn depth(&self) -> usize {
        self.walk(|_, _, _| {})
    }

    /// The planes above `depth`, the root being at depth 0, each as the polygon that the planes above it and the box
    /// `bounds` leave of it.
    pub fn polygons(&self, bounds: &Aabb, depth: usize) -> Vec<Vec<DVec3>> {
        let mut polygons = Vec::new();
        self.walk(|node, above, at| {
            if let BspNode::Inner { plane, .. } = self.nodes[node as usize]
                && at < depth
            {
                let faces = (0..3).flat_map(|axis| {
                    let (low, high) = (f64::from(bounds.min[axis]), f64::from(bounds.max[axis]));
                    [(CutPlane::across(axis, low), 1.0), (CutPlane::across(axis, high), -1.0)]
                });
                let size = (bounds.max - bounds.min).as_dvec3().length();
                let square = plane.square(0.5 * (bounds.min + bounds.max).as_dvec3(), size);
                let cut = faces
                    .chain(above.iter().copied())
                    .fold(square, |polygon, (plane, side)| plane.keep(&polygon, side));
                polygons.extend((cut.len() > 2).then_some(cut));
            }
        });
        polygons
    }

    /// Tells `each` about all nodes: number, the planes above with the side on which the node lies (1 in front, -1
    /// behind), and depth. How many levels it came to.
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
