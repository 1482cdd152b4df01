//! Stage 9 · the octree: cells with many primitives are divided into eight octants. It has two
//! searches.
//!
//! Slides: `slides/stage09.md`.
//!
//! Given: [`Octree`] with `divide` and `set_leaf`; [`Cell`] with `octant`, `middle` and `touches`;
//! [`ListGrowth`], whose `divide` returns `None` where all leaves together would list more than
//! [`MOST_REFERENCES`](raykata::partition::MOST_REFERENCES) references per primitive, which is the
//! most that is allowed.
//!
//! A search returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller
//! primitive number wins. A hit may lie outside the leaf that lists its primitive. Without a hit or
//! a node, or if the ray misses the bounds, the result is `None`.

use crate::stage9_cells::{around, may_stop_before, padded_boxes, span, test_cell};
use glam::DVec3;
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, ListGrowth, Octree, OctreeNode};
use raykata::ray::Ray;

/// Makes a cube of the box around all padded boxes, and divides every cell with too many primitives
/// into eight octants. A thousand copies of one box are in the same octants at every level. When
/// does the build end?
///
/// Exactly:
///
/// 1. Divide a cell, unless it holds at most `leaf_size` primitives, is at `max_depth` (the root is
///    at depth 0), its octants together would hold about three times as many or more, or
///    [`ListGrowth::divide`] returns `None`.
/// 2. List a primitive once in every leaf that its box touches.
/// 3. Leave out empty boxes. Without a usable box the tree has no nodes.
///
/// Source: "Octree" (recursively subdivide box-shaped cells into 8 octants).
pub fn build(bounds: &[Aabb], leaf_size: usize, max_depth: usize) -> Octree {
    todo!("make a leaf if the primitives are few; else divide the cell and build all eight octants")
}

/// From cell to cell: goes down from the root to the leaf that contains the point of entry, tests
/// its primitives, and continues with the leaf behind its exit. To which of two cells does a point
/// on their face belong? And is the rounded exit on the face?
///
/// Visit every node on the way down to a leaf, and each leaf at most once.
///
/// Source: "Octree" (trace rays through neighbor cells).
pub fn closest_hit_by_cells(octree: &Octree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("go down to the leaf that contains the point, test its primitives, and continue at its exit")
}

/// From the root down: sorts the octants that the ray enters by their entries, searches them in
/// this order, and stops at one that begins behind the best hit. What if the ray enters four
/// octants at the same `t`? And what if a primitive is hit outside its octant?
///
/// Visit each node at most once, and only if the ray enters it before the best hit.
///
/// Source: "Octree" (sort eight boxes front-to-back).
pub fn closest_hit(octree: &Octree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("sort the octants by where the ray enters them, and search them in that order")
}
