//! Stage 9 · the BSP tree of the slide: the polygons lie in its nodes, and a polygon that crosses a
//! plane is split.
//!
//! Slides: `slides/stage09.md`.
//!
//! Given: [`PolygonBsp`] with `add_node`, `set_leaf` and `set_children`; [`CutPlane`] with
//! `distance`, `across` and `keep`, which clips a polygon; [`ListGrowth`], whose `divide` returns
//! `None` where all nodes together would list more than
//! [`MOST_REFERENCES`](raykata::partition::MOST_REFERENCES) references per primitive, which is the
//! most that is allowed. A hull of three to seven corners that lie in one plane is a convex
//! polygon, with its corners in order. Every other hull is a solid: the eight corners of a box, or
//! corners without a plane.
//!
//! A search returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller
//! primitive number wins. A hit may lie outside the leaf that lists its primitive. Without a hit or
//! a node, the result is `None`.

use crate::stage9_cells::{ROUNDING, may_stop_before, part_above, range, test_cell};
use glam::{DVec3, Vec3};
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cells, CutPlane, ListGrowth, PolygonBsp, PolygonBspNode};
use raykata::ray::Ray;

/// Each node holds the polygons on its plane; those that cross it are split. The planes of a convex
/// body have all its polygons on one side: what does their tree look like?
///
/// Exactly:
///
/// 1. A plane is that of a polygon, or across an axis. Prefer one that splits few polygons and
///    leaves few primitives on its fuller side.
/// 2. A node lists all polygons in its plane, and no solids.
/// 3. A point within [`PolygonBsp::room`] of a plane counts as on it; choose it from 0 to a 1000th
///    of the largest coordinate. Clip at the plane itself.
/// 4. Pass each part to its side, and a solid to each side that it reaches.
/// 5. Every part of every polygon lies on the plane of a node that lists it, and a leaf lists at
///    most `leaf_size` solids, or those that no plane divides. Exceptions: at `max_depth` (root:
///    0), and where [`ListGrowth::divide`] returns `None`.
/// 6. Leave out hulls without corners. Without a usable hull there are no nodes.
///
/// Source: Fuchs et al., SIGGRAPH 1980.
pub fn build(hulls: &[Vec<Vec3>], leaf_size: usize, max_depth: usize) -> PolygonBsp {
    todo!("choose a plane, list the polygons in it, split the polygons that cross it, and build both sides")
}

/// Three steps per plane: search the side of the ray's origin, test the polygons on the plane,
/// search the other side. The slide returns `no_intersection` if `t < min_t` or `t < max_t`, else
/// the first hit. What if the plane is behind the ray? And where is a solid of the near side hit?
///
/// Exactly:
///
/// 1. Test the polygons of a node only if the ray comes to its plane within the part of the ray
///    that is in the node.
/// 2. Visit a node at most once, and only if the ray enters it before the best hit.
/// 3. A point within [`PolygonBsp::room`] of a plane counts as on it: a polygon in front of the
///    plane may extend behind it by this distance.
///
/// Source: "Binary Space Partition (BSP) Tree" (`ComputeBSPIntersection`).
pub fn closest_hit(bsp: &PolygonBsp, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("search the near side of each plane, then the polygons on it, then the far side")
}
