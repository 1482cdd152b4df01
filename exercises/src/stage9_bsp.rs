//! Stage 9 · the BSP tree: planes in any direction, those of the polygons themselves.
//!
//! Slides: "Binary Space Partition (BSP) Tree" (recursively partition space by planes; traverse nodes front-to-back).
//!
//! Given: [`Bsp`] with `add_node`, `set_leaf` and `set_children`; [`CutPlane`] with `distance` and `across`.

use crate::stage9_cells::{ROUNDING, look_into, part_above, range, settled};
use glam::{DVec3, Vec3};
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Bsp, BspNode, Cells, CutPlane};
use raykata::ray::Ray;

/// Builds a BSP tree over hulls: the corners of a polygon, or the eight of a box. Candidates for a cut are the planes of
/// the polygons, and one across the longest extent in the middle of things, for those of a convex body divide nothing. The
/// plane is taken that leaves few primitives on its fuller side, and fewer still on both. A leaf is made if there are no
/// more than `leaf_size`, at `max_depth`, or if no plane leaves fewer on either side and less than 60 % on both.
///
/// A primitive is listed on each side that it reaches into; one that touches the plane, on both. What is not a number is
/// left out.
pub fn build(hulls: &[Vec<Vec3>], leaf_size: usize, max_depth: usize) -> Bsp {
    todo!("make a leaf if the primitives are few; else choose a plane and build both sides")
}

/// The closest hit: the side that the ray comes from first, then the other one, each with the part of the ray that is on
/// it.
///
/// Where the formula lies: `if (t < min_t) || (t < max_t)) return no_intersection` gives up where the plane is behind the
/// ray or beyond its end; there the ray is on one side all the way, and that side must be searched. A ray in the plane is
/// on both sides, and so is one that starts on it.
pub fn closest_hit(bsp: &Bsp, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("search the near side of each plane first, then the far one if it can matter")
}
