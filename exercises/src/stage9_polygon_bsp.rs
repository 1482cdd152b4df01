//! Stage 9 · the BSP tree of the slide: the polygons lie in its nodes, and a polygon that crosses a plane is split.
//!
//! Slides: "Binary Space Partition (BSP) Tree" ("BSP tree nodes store partition plane and set of polygons lying on that
//! partition plane"; "every part of every polygon lies on a partition plane"; `ComputeBSPIntersection`).
//!
//! Given: [`PolygonBsp`] with `add_node`, `set_leaf` and `set_children`; [`CutPlane`] with `distance`, `across` and
//! `keep`, which clips a polygon; [`ListGrowth`].

use crate::stage9_cells::{ROUNDING, may_stop_before, part_above, range, test_cell};
use glam::{DVec3, Vec3};
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cells, CutPlane, ListGrowth, PolygonBsp, PolygonBspNode};
use raykata::ray::Ray;

/// Builds a BSP tree whose nodes hold the polygons on their planes.
///
/// A hull of three to seven corners that lie in one plane is a convex polygon, with its corners in order. Every other
/// hull is a solid: the eight corners of a box, or corners without a plane. Leave out hulls that have no corner, or a
/// corner with NaN or infinity. Without a usable hull the tree has no nodes.
///
/// Choose a plane for each node: that of a polygon, or one across an axis. List all polygons of the node that lie in the
/// plane at the node. Split each polygon that crosses the plane, and pass its two parts to the two sides; pass a solid to
/// each side that it reaches. A point within [`PolygonBsp::room`] of a plane counts as a point of the plane. Choose
/// `room` from 0 to a 1000th of the largest coordinate, and clip at the plane itself. Prefer planes that split
/// few polygons and leave few primitives on their fuller side.
///
/// Go on until every part of every polygon lies on the plane of a node that lists it, and until a leaf lists at most
/// `leaf_size` solids or no plane divides its solids. Only at `max_depth` (the root is at depth 0), and where
/// [`ListGrowth::divide`] returns `None`, may a leaf list polygons. All nodes together list at most [`MOST_REFERENCES`]
/// references per primitive.
///
/// Pitfall: the planes of the polygons of a convex body have all other polygons on one side. If no other plane is
/// chosen, the tree is a list, in which each ray visits most nodes. If a polygon that crosses the plane is passed on
/// whole, it comes to lie on both sides of more and more planes.
///
/// Slide: "Binary Space Partition (BSP) Tree". The idea is from Fuchs, Kedem and Naylor, "On Visible Surface Generation
/// by A Priori Tree Structures", SIGGRAPH 1980.
///
/// [`MOST_REFERENCES`]: raykata::partition::MOST_REFERENCES
pub fn build(hulls: &[Vec<Vec3>], leaf_size: usize, max_depth: usize) -> PolygonBsp {
    todo!("choose a plane, list the polygons in it, split the polygons that cross it, and build both sides")
}

/// Finds the closest hit: searches the side of the ray's origin first, then the polygons on the plane (step 2 of the
/// slide), then the other side.
///
/// Returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller primitive number wins.
/// `None` if there is no hit or no node. Test the polygons of a node only if the ray comes to its plane within the part
/// of the ray that is in the node. Visit a node at most once, and only if the ray enters it before the best hit. A
/// point within [`PolygonBsp::room`] of a plane counts as a point of the plane: a polygon in front of the plane may extend
/// behind it by this distance.
///
/// Pitfall: `if (t < min_t) || (t < max_t)) return no_intersection` is wrong if the plane is behind the ray or beyond
/// its end. There the ray is on one side along its whole length, and that side must be searched. `if (intersection1 is
/// a hit) return intersection1` is wrong if a leaf lists solids: a solid of the near side may be hit on the far side,
/// behind a polygon.
///
/// Slide: "Binary Space Partition (BSP) Tree" (`ComputeBSPIntersection`).
pub fn closest_hit(bsp: &PolygonBsp, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("search the near side of each plane, then the polygons on it, then the far side")
}
