//! Stage 9 · the octree from neighbour to neighbour: the search goes up only as far as it must, and then down again.
//!
//! Slides: "Octree" (trace rays through neighbor cells; generally fewer cells). Samet, "Implementing Ray Tracing with
//! Octrees and Neighbor Finding", 1989.
//!
//! Given: [`Octree`]; [`Cell`] with `octant` and `middle`.

use crate::stage9_cells::{may_stop_before, span, test_cell};
use glam::DVec3;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, Octree, OctreeNode};
use raykata::ray::Ray;

/// Finds the closest hit from leaf to leaf, like `closest_hit_by_cells`, but without a return to the root for each leaf:
/// goes up to the smallest cell that contains both the leaf and its neighbour, and down from there.
///
/// Returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller primitive number wins.
/// `None` if there is no hit, if the ray misses the bounds, or if there is no node. Visit a node when the search comes to
/// it from above, and visit each node at most once, and only if the ray enters it before the best hit. A hit may lie outside
/// the leaf that lists its primitive.
///
/// A simple way is a stack with the nodes from the root to the leaf: an octree stores no links from children to parents, and
/// a table of all neighbours would take more memory than the tree. At the exit, take nodes off the stack while the exit is on
/// the far side of the node above. Half of all neighbours have the same parent, a quarter the same grandparent, and so on,
/// so on average the search goes up two levels, however deep the tree is. The recursion of `closest_hit` keeps the same
/// stack, and also visits each node once, but computes the intervals of all eight octants.
///
/// Pitfall: the neighbour can be larger than the leaf, or divided into smaller leaves. Only the cell with both of them says
/// which. A point that is not set exactly on the face can lead back into the leaf.
///
/// Slide: "Octree" (trace rays through neighbor cells).
pub fn closest_hit_by_neighbours(octree: &Octree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("keep the nodes from the root to the leaf; at the exit go up while the face is shared, then down")
}
