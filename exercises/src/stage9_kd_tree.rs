//! Stage 9 · the kd-tree: planes across the axes, put where five heuristics want them.
//!
//! Slides: "Kd-Trees", "Heuristics" 1 to 5, "kd-Tree Traversal" with `t` and `t'`.
//!
//! Given: [`KdTree`] with `add_node`, `set_leaf` and `set_children`.

use crate::stage9_cells::{ROUNDING, look_into, part_above, settled, span, widened};
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, KdHeuristics, KdNode, KdTree};
use raykata::ray::Ray;

/// Builds a kd-tree from the top down. A node with more than `leaf_size` primitives is divided, if it is not at
/// [`KdTree::most_depth`] yet and not all primitives would be on both sides. A primitive that touches a plane is on both.
///
/// Each heuristic does one thing: `longest_axis` cuts across the longest side of the cell, or else across x, y, z by
/// turns, from x at the root; `balanced_counts` keeps the counts of the two sides alike; `few_straddlers` keeps those on
/// both few (together, the sum of the difference and the number on both is least; with neither the cut is in the middle);
/// `cut_off_empty_space` takes a margin of a tenth of the cell or more away first; `stop_at_overlap` makes a leaf if 60 %
/// of those on one side would also be on the other.
pub fn build(bounds: &[Aabb], heuristics: &KdHeuristics, leaf_size: usize) -> KdTree {
    todo!("make a leaf if the primitives are few; else choose a plane and build both sides")
}

/// The closest hit, with the interval of `t` in which the ray is in each cell: the nearer side of a plane first, then the
/// farther one, unless the best hit lies before it.
///
/// Where the formula lies: `hit.distance < t'` drops a wall on the face of the box, and what reaches out of its leaf; and
/// a ray in the plane, or from it, is on both sides, for a builder may list what lies in the plane on one side only.
pub fn closest_hit(tree: &KdTree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("search the nearer side of each plane first, then the farther one if it can matter")
}
