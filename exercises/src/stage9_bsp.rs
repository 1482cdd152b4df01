//! Stage 9 · the BSP tree: planes of any direction divide space, above all the planes of the
//! polygons themselves.
//!
//! Slides: `slides/stage09.md`.
//!
//! Given: [`Bsp`] with `add_node`, `set_leaf` and `set_children`; [`CutPlane`] with `distance` and
//! `across`; [`ListGrowth`], whose `divide` returns `None` where all leaves together would list
//! more than [`MOST_REFERENCES`](raykata::partition::MOST_REFERENCES) references per primitive,
//! which is the most that is allowed. A hull is the list of corners of a polygon, or the eight
//! corners of a box.
//!
//! A search returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller
//! primitive number wins. A hit may lie outside the leaf that lists its primitive. Without a hit or
//! a node, the result is `None`.

use crate::stage9_cells::{ROUNDING, may_stop_before, part_above, range, test_cell};
use glam::{DVec3, Vec3};
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Bsp, BspNode, Cells, CutPlane, ListGrowth};
use raykata::ray::Ray;

/// Planes of any direction divide space. Candidates are the planes of the polygons and, because
/// those of a convex body do not divide it, one across the longest extent through the median
/// centre. What if many polygons lie in one plane, or around one line?
///
/// Exactly:
///
/// 1. Choose a plane that leaves few primitives on its fuller side, and few on both.
/// 2. Make a leaf of at most `leaf_size` primitives, at `max_depth` (the root is at depth 0), if no
///    plane leaves fewer primitives on each side and less than 60 % of them on both, or if
///    [`ListGrowth::divide`] returns `None`.
/// 3. List a primitive once in every leaf that it overlaps; one that touches a plane is on both
///    sides.
/// 4. Leave out hulls without corners. Without a usable hull there are no nodes.
///
/// Source: "Binary Space Partition (BSP) Tree".
pub fn build(hulls: &[Vec<Vec3>], leaf_size: usize, max_depth: usize) -> Bsp {
    todo!("make a leaf if the primitives are few; else choose a plane and build both sides")
}

/// At each plane, search the side of the ray's origin first and the other side second, each with
/// the part of the ray that is on it. The slide returns `no_intersection` if `t < min_t` or
/// `t < max_t`. Where is a ray that ends before the plane?
///
/// Exactly:
///
/// 1. Visit a node at most once, and only if the ray enters it before the best hit.
/// 2. A ray in the plane, or that starts on it, is on both sides: a primitive in the plane may be
///    listed on one side only. Its computed height may be a rounding error in place of 0.
///
/// Source: "Binary Space Partition (BSP) Tree".
pub fn closest_hit(bsp: &Bsp, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("search the near side of each plane first, then the far side unless the best hit is before it")
}
