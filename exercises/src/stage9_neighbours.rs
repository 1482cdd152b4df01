//! Stage 9 · the octree from neighbour to neighbour: the search goes up only as far as it must, and
//! then down again.
//!
//! Slides: `slides/stage09.md`. Source: Samet, "Implementing Ray Tracing with Octrees and Neighbor
//! Finding", 1989.
//!
//! Given: [`Octree`]; [`Cell`] with `octant` and `middle`.
//!
//! A search returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller
//! primitive number wins. A hit may lie outside the leaf that lists its primitive. Without a hit or
//! a node, or if the ray misses the bounds, the result is `None`.

use crate::stage9_cells::{may_stop_before, span, test_cell};
use glam::DVec3;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, Octree, OctreeNode};
use raykata::ray::Ray;

/// From leaf to leaf like `closest_hit_by_cells`, but without a return to the root: goes up to the
/// smallest cell that contains both the leaf and its neighbour, and down from there. An octree
/// stores no links to parents: how do you get up? And how large can a neighbour be?
///
/// Visit a node when the search comes to it from above, at most once, and only if the ray enters it
/// before the best hit.
///
/// Source: "Octree" (trace rays through neighbor cells).
pub fn closest_hit_by_neighbours(octree: &Octree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("keep the nodes from the root to the leaf; at the exit go up while the face is shared, then down")
}
