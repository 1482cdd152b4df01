//! Stage 9 · the octree: cells that are divided in eight wherever there is much, and two ways through it.
//!
//! Slides: "Octree" (recursively subdivide box-shaped cells into 8 octants; trace rays through neighbor cells; "Or, check
//! rays versus octree boxes hierarchically": sort eight boxes front-to-back at each level).
//!
//! Given: [`Octree`] with `divide` and `set_leaf`; [`Cell`] with `octant`, `middle` and `touches`.

use crate::stage9_cells::{look_into, settled, span, widened};
use glam::DVec3;
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, Octree, OctreeNode};
use raykata::ray::Ray;

/// Divides the box around all, made a cube, into octants for as long as there are more than `leaf_size` primitives and it
/// helps, down to `max_depth` (the root is at depth 0). A primitive is listed in every leaf that its box reaches into,
/// touching included. Nothing makes no node.
///
/// Where the formula lies: a thousand copies of one box reach into the same octants again and again; if all octants
/// together would hold more than three times as many, a leaf is better.
pub fn build(bounds: &[Aabb], leaf_size: usize, max_depth: usize) -> Octree {
    todo!("make a leaf if the primitives are few; else divide the cell and build all eight octants")
}

/// The closest hit, from cell to cell: find the leaf that holds the point at which the ray enters, look into it, go on
/// just past its exit. Every node on the way down to a leaf is visited.
pub fn closest_hit_by_cells(octree: &Octree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("go down to the leaf that holds the point, look into it, and go on at its exit")
}

/// The closest hit, from the root down: of the octants that the ray meets the nearest one first, and none beyond the best
/// hit.
///
/// Where the formula lies: "sort eight boxes" needs an order for boxes that are entered at one `t`, and the hit of an
/// octant need not be in it: stop only at an octant that begins behind the best hit.
pub fn closest_hit(octree: &Octree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("sort the octants by where the ray enters them, and search them in that order")
}
