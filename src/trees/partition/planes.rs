//! Planes that divide space, and what all trees of such planes have in common.

use super::{Tree, TreeNode};
use crate::aabb::Aabb;
use crate::message;
use glam::{DVec3, Vec3};

/// A plane that divides space: all points `p` with `normal · p = offset`. The front is the side to which the
/// normal points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CutPlane {
    /// The normal of the plane, of unit length.
    pub normal: DVec3,
    /// The signed distance of the plane from the origin along the normal, in world units.
    pub offset: f64,
}

message! { CutPlane { normal, offset } }

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

/// A node that a plane divides. Its region is described by the planes above it, each with the side on which the node
/// lies: 1 in front, -1 behind.
pub trait PlaneNode: TreeNode<Region = Vec<(CutPlane, f64)>> {
    /// The plane of an inner node; `None` for a leaf.
    fn plane(&self) -> Option<CutPlane>;
}

/// The regions behind and in front of `plane`, below the planes `above`.
pub(super) fn both_sides(above: &[(CutPlane, f64)], plane: CutPlane) -> Vec<Vec<(CutPlane, f64)>> {
    [-1.0, 1.0].map(|side| above.iter().copied().chain([(plane, side)]).collect()).into()
}

impl<N: PlaneNode> Tree<N> {
    /// Calls `each` for all nodes in depth-first order, with the index of the node, the planes above it and
    /// its depth, and returns the number of levels. Each plane comes with the side on which the node lies: 1
    /// in front, -1 behind.
    ///
    /// # Panics
    ///
    /// If a child's index is out of range.
    pub fn walk(&self, mut each: impl FnMut(u32, &[(CutPlane, f64)], usize)) -> usize {
        self.walk_from(Vec::new(), usize::MAX, |node, above, depth| each(node, above, depth))
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
            let plane = self.nodes[node as usize].plane().filter(|_| at < depth);
            polygons.extend(plane.and_then(|plane| plane.clipped(bounds, above)));
        });
        polygons
    }
}
