//! Stage 3 · building a bounding volume hierarchy: three strategies that split the primitives of a node.
//!
//! Slides: "Bounding Volume Hierarchy", "Object Median", "Spatial Median", "Surface Area Heuristic".
//!
//! Given: [`Bvh`] with `add_node`, `set_leaf` and `set_children`; [`PrimitiveRef`] with the number, the box and the
//! centroid of a primitive; the costs [`TRAVERSAL_COST`] and [`INTERSECTION_COST`]; [`DEEPEST_SPLIT`]; your own functions
//! for boxes.

use crate::stage3_boxes::{centroid, surface_area, union};
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, DEEPEST_SPLIT, INTERSECTION_COST, PrimitiveRef, TRAVERSAL_COST};
use raykata::scene::Split;

/// Object median split: order the primitives by centroid along the longest axis of the box around all of them, and
/// put half of them on each side.
///
/// `primitives` has at least two elements. The function reorders them and returns an index: the primitives before it
/// go to the left side, the others to the right side. The sides hold n / 2 primitives each; if n is odd, either side
/// may hold one more. Neither side may be empty. Equal centroids may go to either side. A centroid may be NaN, so
/// sort with `total_cmp`.
pub fn split_object_median(primitives: &mut [PrimitiveRef]) -> usize {
    todo!("order the primitives by centroid along the longest axis and split in half")
}

/// Spatial median split: cut the box around all primitives in the middle of its longest axis. Each primitive goes to
/// the side on which its centroid lies.
///
/// Input and result are as for [`split_object_median`]: neither side may be empty. A centroid exactly on the cut may
/// go to either side.
///
/// Pitfall: if all centroids are on one side, that side is the whole problem again, and the recursion never ends. Use
/// another split then, for example the object median.
pub fn split_spatial_median(primitives: &mut [PrimitiveRef]) -> usize {
    todo!("cut the box in the middle of its longest axis; handle the case that all go to one side")
}

/// Surface area heuristic: sort the primitives by centroid along each of the three axes, try all n - 1 cuts of each
/// order, and take the cut with the smallest `A(L) n(L) + A(R) n(R)`. `A` is the surface area of the box around a
/// side, `n` the number of its primitives, and P the parent with all primitives.
///
/// Input and index are as for [`split_object_median`]. The function returns `None` for a leaf, if no cut is cheaper:
/// `TRAVERSAL_COST · A(P) + INTERSECTION_COST · (A(L) n(L) + A(R) n(R)) ≥ INTERSECTION_COST · A(P) n(P)`. Of cuts
/// with equal cost any one is right. For boxes without area all costs are 0, and both a leaf and any cut are right.
///
/// Pitfall: the slide divides by `A(P)`, which is 0 for primitives in a line, and 0/0 is NaN. Multiply the whole
/// comparison by `A(P)` instead. The slide also leaves out the two costs, without which no leaf is ever cheaper.
pub fn split_surface_area(primitives: &mut [PrimitiveRef]) -> Option<usize> {
    todo!("find the cut with the least A(L) n(L) + A(R) n(R) over all three axes")
}

/// Builds a hierarchy over the primitives with these boxes, from the top down: a node gets the box around its
/// primitives, and it becomes a leaf or its primitives are split in two.
///
/// Primitive `i` has the box `bounds[i]`. Each primitive is in exactly one leaf, and each box contains everything
/// below it. Each leaf holds at least 1 and at most `leaf_size` primitives. With both medians `leaf_size` primitives
/// or fewer become a leaf. With [`Split::SurfaceArea`] such a group is still split if that is cheaper than a leaf,
/// and a larger group for which no cut is cheaper is split by the object median. Without primitives the hierarchy has
/// no node. The build ends for any boxes, also if all centroids are equal. A box of NaN goes into some leaf and does
/// not change the boxes of other primitives.
///
/// A node at depth [`DEEPEST_SPLIT`] or more is split by the object median, with any [`Split`]; the root has depth 0.
/// So the hierarchy has at most `DEEPEST_SPLIT + ⌈log₂ n⌉ + 1` levels.
///
/// Pitfall: the slide stops at `e - s < N_leaf`. With `N_leaf = 1` it splits a single primitive forever. And if each
/// box is a little larger than the one before, with a common corner, a spatial median splits off one box per level.
pub fn build(bounds: &[Aabb], split: Split, leaf_size: usize) -> Bvh {
    todo!("make a leaf if the primitives are few enough; otherwise split them and build both halves")
}
