//! Stage 3 · building a bounding volume hierarchy: three strategies that split the primitives of a
//! node.
//!
//! Slides: `slides/stage03.md`.
//!
//! Given: [`Bvh`] with `add_node`, `set_leaf` and `set_children`; [`PrimitiveRef`] with the number,
//! the box and the centroid of a primitive; the costs [`TRAVERSAL_COST`] and [`INTERSECTION_COST`];
//! [`DEEPEST_SPLIT`]; your own functions for boxes. `counted::union` calls your `union`, and a
//! check counts the calls.

use crate::counted::union;
use crate::stage3_boxes::{centroid, surface_area};
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, DEEPEST_SPLIT, INTERSECTION_COST, PrimitiveRef, TRAVERSAL_COST};
use raykata::scene::Split;

/// Object median: order the primitives by centroid along the longest axis of the box around all of
/// them, and put half of them on each side.
///
/// Reorders `primitives`, at least two, and returns an index: those before it go left, the others
/// right. If n is odd, either side may hold one more. Equal centroids may go to either side. The
/// box around the centroids will do as well.
pub fn split_object_median(primitives: &mut [PrimitiveRef]) -> usize {
    todo!("order the primitives by centroid along the longest axis and split in half")
}

/// Spatial median: cut the box around all primitives in the middle of its longest axis. Each
/// primitive goes to the side of its centroid. What if all centroids lie on one side?
///
/// Input, result and box are as for [`split_object_median`]. A centroid exactly on the cut may go
/// to either side.
///
/// Exactly:
///
/// 1. Neither side is empty: if the cut leaves one empty, any other split is right.
pub fn split_spatial_median(primitives: &mut [PrimitiveRef]) -> usize {
    todo!("cut the box in the middle of its longest axis; handle the case that all go to one side")
}

/// Surface area heuristic: a ray that enters the parent P enters a child with probability
/// `A(child) / A(P)`, the ratio of their surface areas. Sort by centroid along each axis, try all
/// `n - 1` cuts, and take the one with the smallest `A(L) n(L) + A(R) n(R)`. What is the ratio for
/// primitives in a line?
///
/// Input and index are as for [`split_object_median`]. The result is `None`, a leaf, if for the
/// best cut
///
/// ```text
/// TRAVERSAL_COST · A(P) + INTERSECTION_COST · (A(L) n(L) + A(R) n(R))
///     ≥ INTERSECTION_COST · A(P) n(P)
/// ```
///
/// Of cuts with equal cost any is right. For boxes without area all costs are 0, and both a leaf
/// and any cut are right.
///
/// Exactly:
///
/// 1. At most 64 `union` calls per primitive.
pub fn split_surface_area(primitives: &mut [PrimitiveRef]) -> Option<usize> {
    todo!("find the cut with the least A(L) n(L) + A(R) n(R) over all three axes")
}

/// From the top down, a node gets the box around its primitives. It becomes a leaf, or they are
/// split in two and both parts are built in the same way. Does that end for one primitive? How
/// deep is it if each split takes one away?
///
/// Primitive `i` has the box `bounds[i]`.
///
/// Exactly:
///
/// 1. Each primitive is in exactly one leaf, and each box contains everything below it. Without
///    primitives there is no node.
/// 2. A leaf holds 1 to `leaf_size` primitives. With both medians, `leaf_size` or fewer become a
///    leaf.
/// 3. With [`Split::SurfaceArea`] such a group is still split if that is cheaper. A larger group
///    for which no cut is cheaper is split by the object median.
/// 4. From depth [`DEEPEST_SPLIT`] on (the root has 0) every split is an object median. So there
///    are at most `DEEPEST_SPLIT + ⌈log₂ n⌉ + 1` levels, for any boxes.
pub fn build(bounds: &[Aabb], split: Split, leaf_size: usize) -> Bvh {
    todo!("make a leaf if the primitives are few enough; otherwise split them and build both halves")
}
