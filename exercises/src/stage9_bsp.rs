//! Stage 9 · the BSP tree: planes of any direction divide space, above all the planes of the polygons themselves.
//!
//! Slides: "Binary Space Partition (BSP) Tree" (recursively partition space by planes; traverse nodes front-to-back).
//!
//! Given: [`Bsp`] with `add_node`, `set_leaf` and `set_children`; [`CutPlane`] with `distance` and `across`;
//! [`ListGrowth`].

use crate::stage9_cells::{ROUNDING, may_stop_before, part_above, range, test_cell};
use glam::{DVec3, Vec3};
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Bsp, BspNode, Cells, CutPlane, ListGrowth};
use raykata::ray::Ray;

/// Builds a BSP tree over hulls. A hull is the list of corners of a polygon, or the eight corners of a box.
///
/// The candidates for a cut are the planes of the polygons, and one plane across the longest extent through the median
/// centre, because the planes of a convex body do not divide it. Choose a plane that leaves few primitives on its
/// fuller side, and few on both sides. Make a leaf if a node has at most `leaf_size` primitives, if it is at
/// `max_depth` (the root is at depth 0), or if no plane leaves fewer primitives on each side and less than 60 % of them
/// on both. Make a leaf also if [`ListGrowth::divide`] returns `None`: all leaves together list at most
/// [`MOST_REFERENCES`] references per primitive.
///
/// List a primitive once in every leaf that it overlaps; a primitive that touches a plane is on both sides. Leave out
/// hulls that have no corner, or a corner with NaN or infinity. Without a usable hull the tree has no nodes.
///
/// Pitfall: many polygons in one plane, or around one line, are on both sides of each of their planes. The recursion
/// must end there. If polygons cross each other, every plane has some of them on both sides, and the number of
/// references grows at every level.
///
/// Slide: "Binary Space Partition (BSP) Tree".
///
/// [`MOST_REFERENCES`]: raykata::partition::MOST_REFERENCES
pub fn build(hulls: &[Vec<Vec3>], leaf_size: usize, max_depth: usize) -> Bsp {
    todo!("make a leaf if the primitives are few; else choose a plane and build both sides")
}

/// Finds the closest hit. At each plane search the side of the ray's origin first and the other side second, each with
/// the part of the ray that is on it.
///
/// Returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller primitive number wins.
/// `None` if there is no hit or no node. Visit a node at most once, and only if the ray enters it before the best hit.
/// A hit may lie outside the leaf that lists its primitive.
///
/// Pitfall: `if (t < min_t) || (t < max_t)) return no_intersection` is wrong if the plane is behind the ray or beyond
/// its end. There the ray is on one side along its whole length, and that side must be searched. A ray in the plane is
/// on both sides, and so is a ray that starts on it; a primitive in the plane may be listed on one side only. The computed
/// height of such a ray may be a rounding error in place of 0.
///
/// Slide: "Binary Space Partition (BSP) Tree".
pub fn closest_hit(bsp: &Bsp, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("search the near side of each plane first, then the far side unless the best hit is before it")
}
