//! Stage 9 · the octree: cells with many primitives are divided into eight octants. It has two searches.
//!
//! Slides: "Octree" (recursively subdivide box-shaped cells into 8 octants; trace rays through neighbor cells; "Or,
//! check rays versus octree boxes hierarchically": sort eight boxes front-to-back at each level).
//!
//! Given: [`Octree`] with `divide` and `set_leaf`; [`Cell`] with `octant`, `middle` and `touches`; [`ListGrowth`].

use crate::stage9_cells::{may_stop_before, padded_boxes, span, test_cell};
use glam::DVec3;
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, ListGrowth, Octree, OctreeNode};
use raykata::ray::Ray;

/// Builds an octree: makes a cube of the box around all primitives, and divides every cell that holds more than
/// `leaf_size` primitives into octants.
///
/// Make a leaf if a cell holds at most `leaf_size` primitives, if it is at `max_depth` (the root is at depth 0), or if
/// its octants together would hold more than three times as many primitives. Make a leaf also if [`ListGrowth::divide`]
/// returns `None`: all leaves together list at most [`MOST_REFERENCES`] references per primitive. List a primitive once
/// in every leaf that its box touches. Leave out empty boxes and boxes with NaN. Without a usable box the tree has no
/// nodes.
///
/// Pitfall: a thousand copies of one box are in the same octants at every level, and the number of references to long
/// thin boxes doubles at every level. Without the two limits the build does not end in reasonable time.
///
/// [`MOST_REFERENCES`]: raykata::partition::MOST_REFERENCES
///
/// Slide: "Octree" (recursively subdivide box-shaped cells into 8 octants).
pub fn build(bounds: &[Aabb], leaf_size: usize, max_depth: usize) -> Octree {
    todo!("make a leaf if the primitives are few; else divide the cell and build all eight octants")
}

/// Finds the closest hit from cell to cell: goes down from the root to the leaf that contains the point of entry, tests
/// its primitives, and continues with the leaf behind its exit.
///
/// Returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller primitive number wins.
/// `None` if there is no hit, if the ray misses the bounds, or if there is no node. Visit every node on the way down to
/// a leaf, and each leaf at most once. A hit may lie outside the leaf that lists its primitive.
///
/// Pitfall: a point on a face belongs to two cells. Take the cell that the ray is about to enter, and set the point
/// exactly on the face; otherwise the search makes no progress along edges.
///
/// Slide: "Octree" (trace rays through neighbor cells).
pub fn closest_hit_by_cells(octree: &Octree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("go down to the leaf that contains the point, test its primitives, and continue at its exit")
}

/// Finds the closest hit from the root down: searches the octants that the ray enters in the order of their entries,
/// and stops at an octant that begins behind the best hit.
///
/// Returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller primitive number wins.
/// `None` if there is no hit, if the ray misses the bounds, or if there is no node. Visit each node at most once, and
/// only if the ray enters it before the best hit.
///
/// Pitfall: "sort eight boxes" needs an order also for octants that the ray enters at the same `t`. A primitive of an
/// octant may be hit outside the octant, so stop only at an octant that begins behind the best hit.
///
/// Slide: "Octree" (sort eight boxes front-to-back).
pub fn closest_hit(octree: &Octree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("sort the octants by where the ray enters them, and search them in that order")
}
