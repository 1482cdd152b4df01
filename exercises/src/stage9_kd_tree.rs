//! Stage 9 · the kd-tree: planes across the axes divide space, and five heuristics choose the
//! planes.
//!
//! Slides: `slides/stage09.md`.
//!
//! Given: [`KdTree`] with `add_node`, `set_leaf` and `set_children`; [`ListGrowth`], whose `divide`
//! returns `None` where all leaves together would list more than
//! [`MOST_REFERENCES`](raykata::partition::MOST_REFERENCES) references per primitive, which is the
//! most that is allowed.
//!
//! A search returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller
//! primitive number wins. A hit may lie outside the leaf that lists its primitive. Without a hit or
//! a node, or if the ray misses the bounds, the result is `None`.

use crate::stage9_cells::{ROUNDING, around, may_stop_before, padded_boxes, part_above, span, test_cell};
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, KdHeuristics, KdNode, KdTree, ListGrowth};
use raykata::ray::Ray;

/// Planes across the axes divide space. Five heuristics choose them, each alone or together. What
/// if all boxes are on both sides?
///
/// Exactly:
///
/// 1. Divide a node of more than `leaf_size` primitives, unless it is at depth
///    [`KdTree::most_depth`] (root: 0), all would be on both sides, or
///    [`ListGrowth::divide`] returns `None`.
/// 2. A plane lies within its cell. The bounds contain all padded boxes.
/// 3. List a primitive once in every leaf that its box touches, on both sides of a touched plane.
/// 4. Leave out empty boxes. Without a usable box there are no nodes.
/// 5. `longest_axis`: cut across the cell's longest side. Off: x, y, z in turn, x first.
/// 6. `balanced_counts`: minimise the difference of counts.
/// 7. `few_straddlers`: minimise the number on both sides. With both, minimise the sum; with
///    neither, cut the cell in the middle.
/// 8. `cut_off_empty_space`: first cut off an empty margin of over a tenth of the cell.
/// 9. `stop_at_overlap`: make a leaf if at least 60 % of one side, but not 0, would be on both.
///
/// Source: "Heuristics" 1 to 5.
pub fn build(bounds: &[Aabb], heuristics: &KdHeuristics, leaf_size: usize) -> KdTree {
    todo!("make a leaf if the primitives are few; else choose a plane and build both sides")
}

/// The ray is in each cell for an interval `t..t'`. A plane cuts it in two: search the near side
/// first, then the far side, unless the best hit lies before it. Is a hit on the face of the cell
/// before `t'`?
///
/// Exactly:
///
/// 1. Visit a node at most once, and only if the ray enters it before the best hit.
/// 2. A ray in the plane, or that starts on it, is on both sides: a primitive in the plane may be
///    listed on one side only.
///
/// Source: "kd-Tree Traversal" with `t` and `t'`.
pub fn closest_hit(tree: &KdTree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("search the near side of each plane first, then the far side unless the best hit is before it")
}
