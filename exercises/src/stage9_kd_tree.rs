//! Stage 9 · the kd-tree: planes across the axes divide space, and five heuristics choose the planes.
//!
//! Slides: "Kd-Trees", "Heuristics" 1 to 5, "kd-Tree Traversal" with `t` and `t'`.
//!
//! Given: [`KdTree`] with `add_node`, `set_leaf` and `set_children`; [`ListGrowth`].

use crate::stage9_cells::{ROUNDING, may_stop_before, padded_boxes, part_above, span, test_cell};
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, KdHeuristics, KdNode, KdTree, ListGrowth};
use raykata::ray::Ray;

/// Builds a kd-tree from the root down.
///
/// Divide a node with more than `leaf_size` primitives, unless it is at depth [`KdTree::most_depth`] (the root is at
/// depth 0), all primitives would be on both sides, or [`ListGrowth::divide`] returns `None`: all leaves together list at
/// most [`MOST_REFERENCES`] references per primitive. A plane lies within its cell. List a primitive once in every leaf
/// that its box touches; a primitive that touches a plane is on both sides. Leave out empty boxes and boxes with NaN.
/// Without a usable box the tree has no nodes.
///
/// Each heuristic can be switched on alone:
/// - `longest_axis` cuts across the longest side of the cell. Without it the cuts take x, y, z in turn, with x at the
///   root.
/// - `balanced_counts` minimises the difference of the counts of the two sides.
/// - `few_straddlers` minimises the number of primitives on both sides. With both heuristics the sum of the two numbers
///   is minimal; with neither the cut is in the middle of the cell.
/// - `cut_off_empty_space` first cuts off an empty margin of more than a tenth of the cell.
/// - `stop_at_overlap` makes a leaf if at least 60 % of the primitives of one side would be on both sides. If no primitive
///   would be on both sides, it makes no leaf.
///
/// Pitfall: boxes that all lie at one place are on both sides of every plane through them. The recursion must end
/// there. Without heuristics, long thin boxes are on both sides of most planes, and each level of the tree doubles the
/// number of references.
///
/// Why 60 %: a primitive on both sides is listed twice, so a plane with a large overlap costs memory and gains little. The rule
/// looks at one plane only. A plane through a connected surface has a large overlap if one side has few primitives, and then
/// the node stays whole, although later planes would divide it well. With all heuristics a ray makes 138 primitive tests in
/// `scenes/showcase.toml`, without this rule 56, and with none of them ("easy way") 7, in 1.7, 8.3 and 7.0 MB (`raykata compare
/// scenes/showcase.toml --size 96x60 --spp 1 --of heuristics --table`).
///
/// Slides: "Kd-Trees", "Heuristics" 1 to 5.
///
/// [`MOST_REFERENCES`]: raykata::partition::MOST_REFERENCES
pub fn build(bounds: &[Aabb], heuristics: &KdHeuristics, leaf_size: usize) -> KdTree {
    todo!("make a leaf if the primitives are few; else choose a plane and build both sides")
}

/// Finds the closest hit, with the interval of `t` in which the ray is in each cell: searches the near side of each
/// plane first, then the far side, unless the best hit lies before it.
///
/// Returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller primitive number wins.
/// `None` if there is no hit, if the ray misses the bounds, or if there is no node. Visit a node at most once, and only
/// if the ray enters it before the best hit. A hit may lie outside the leaf that lists its primitive.
///
/// Pitfall: `hit.distance < t'` loses a wall on the face of the box, and a primitive that extends beyond its leaf.
/// A ray in the plane, or one that starts on it, is on both sides, because a builder may list a primitive in the plane
/// on one side only.
///
/// Slide: "kd-Tree Traversal" with `t` and `t'`.
pub fn closest_hit(tree: &KdTree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("search the near side of each plane first, then the far side unless the best hit is before it")
}
