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

// <solution>
use crate::stage3_boxes::longest_axis;
use std::cmp::Ordering;
// </solution>

/// Object median: order the primitives by centroid along the longest axis of the box around all of
/// them, and put half of them on each side.
///
/// Reorders `primitives`, at least two, and returns an index: those before it go left, the others
/// right. If n is odd, either side may hold one more. Equal centroids may go to either side. The
/// box around the centroids will do as well.
pub fn split_object_median(primitives: &mut [PrimitiveRef]) -> usize {
    // <solution>
    let axis = longest_axis(&bounds_of(primitives));
    // Move the smaller half to the front. A complete sort is not necessary. The id breaks ties, so
    // that the same scene always gives the same tree.
    let middle = primitives.len() / 2;
    primitives.select_nth_unstable_by(middle, along(axis));
    middle
    // <stub> todo!("order the primitives by centroid along the longest axis and split in half")
    // </solution>
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
    // <solution>
    // Find the middle of the longest axis.
    let bounds = bounds_of(primitives);
    let axis = longest_axis(&bounds);
    let cut = centroid(&bounds)[axis];

    // Swap each primitive below the cut to the front. `middle` counts them.
    let mut middle = 0;
    for i in 0..primitives.len() {
        if primitives[i].centroid[axis] < cut {
            primitives.swap(i, middle);
            middle += 1;
        }
    }
    // Use the object median if one side is empty.
    if middle == 0 || middle == primitives.len() {
        return split_object_median(primitives);
    }
    middle
    // <stub> todo!("cut the box in the middle of its longest axis; handle the case that all go to one side")
    // </solution>
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
    // <solution>
    // Find the cheapest cut of all three axes.
    let mut best: Option<Cut> = None;
    for axis in 0..3 {
        primitives.sort_unstable_by(along(axis));

        // Compute the areas of all right sides in one pass: area_right[i] belongs to the box around
        // primitives[i..].
        let mut area_right = vec![0.0; primitives.len()];
        let mut right = Aabb::EMPTY;
        for (i, primitive) in primitives.iter().enumerate().rev() {
            right = union(&right, &primitive.bounds);
            area_right[i] = surface_area(&right);
        }

        // Compute the cost of each cut while the left box grows, and keep the cheapest cut.
        let mut left = Aabb::EMPTY;
        for middle in 1..primitives.len() {
            left = union(&left, &primitives[middle - 1].bounds);
            let n_left = middle as f32;
            let n_right = (primitives.len() - middle) as f32;
            let cost = surface_area(&left) * n_left + area_right[middle] * n_right;
            if best.as_ref().is_none_or(|best| cost < best.cost) {
                best = Some(Cut { axis, middle, cost });
            }
        }
    }

    // Return None if a leaf is not more expensive than the cut. A NaN gives a leaf, too. Both sides
    // are multiplied by A(P), because a division by A(P) is 0/0 for primitives in a line. Without
    // the two costs no leaf would be cheaper.
    let Cut { axis, middle, cost } = best?;
    let area = surface_area(&bounds_of(primitives));
    let as_leaf = INTERSECTION_COST * area * primitives.len() as f32;
    if !(TRAVERSAL_COST * area + INTERSECTION_COST * cost < as_leaf) {
        return None;
    }
    // Move the left side to the front. The last sort was along z, and here a selection is enough,
    // which is linear.
    primitives.select_nth_unstable_by(middle, along(axis));
    Some(middle)
    // <stub> todo!("find the cut with the least A(L) n(L) + A(R) n(R) over all three axes")
    // </solution>
}

// <solution>
/// A cut of the primitives, sorted by centroid along `axis`: those before the index `middle` go to
/// the left side.
struct Cut {
    axis: usize,
    middle: usize,
    /// `A(L) n(L) + A(R) n(R)`, without the constant costs.
    cost: f32,
}

/// The box around all primitives.
fn bounds_of(primitives: &[PrimitiveRef]) -> Aabb {
    primitives.iter().fold(Aabb::EMPTY, |all, primitive| union(&all, &primitive.bounds))
}

/// The order of primitives by centroid along an axis. The id breaks ties.
fn along(axis: usize) -> impl Fn(&PrimitiveRef, &PrimitiveRef) -> Ordering {
    move |p, q| p.centroid[axis].total_cmp(&q.centroid[axis]).then(p.id.cmp(&q.id))
}
// </solution>

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
    // <solution>
    // Collect number, box and centroid of each primitive.
    let mut primitives: Vec<PrimitiveRef> = bounds
        .iter()
        .enumerate()
        .map(|(id, bounds)| PrimitiveRef { id: id as u32, bounds: *bounds, centroid: centroid(bounds) })
        .collect();
    // Build the tree below the root, unless there is nothing to build.
    let mut bvh = Bvh::for_primitives(primitives.len());
    if !primitives.is_empty() {
        subdivide(&mut bvh, &mut primitives, split, leaf_size.max(1), 0);
    }
    bvh
    // <stub> todo!("make a leaf if the primitives are few enough; otherwise split them and build both halves")
    // </solution>
}

// <solution>
/// Builds the tree below a new node over these primitives, at least one, and returns the number of
/// the node.
fn subdivide(
    bvh: &mut Bvh,
    primitives: &mut [PrimitiveRef],
    split: Split,
    leaf_size: usize,
    depth: usize,
) -> u32 {
    // Add the node before its children. Then make it a leaf, or split the primitives and build both
    // sides.
    let node = bvh.add_node(bounds_of(primitives));
    let split = if depth < DEEPEST_SPLIT { split } else { Split::ObjectMedian };
    match choose_split(primitives, split, leaf_size) {
        None => bvh.set_leaf(node, primitives),
        Some(middle) => {
            let (below, above) = primitives.split_at_mut(middle);
            let left = subdivide(bvh, below, split, leaf_size, depth + 1);
            let right = subdivide(bvh, above, split, leaf_size, depth + 1);
            bvh.set_children(node, left, right);
        }
    }
    node
}

/// The index at which the split strategy divides the primitives; `None` for a leaf.
fn choose_split(primitives: &mut [PrimitiveRef], split: Split, leaf_size: usize) -> Option<usize> {
    // Stop at `leaf_size` primitives or fewer. With the slide's `e - s < N_leaf` and N_leaf = 1, a
    // single primitive would be split forever.
    let fits = primitives.len() <= leaf_size;
    match split {
        _ if primitives.len() == 1 => None,
        Split::ObjectMedian | Split::SpatialMedian if fits => None,
        Split::ObjectMedian => Some(split_object_median(primitives)),
        Split::SpatialMedian => Some(split_spatial_median(primitives)),
        Split::SurfaceArea => {
            let cheaper = split_surface_area(primitives);
            // If no cut is cheaper but a leaf may not hold so many primitives, use the object
            // median.
            cheaper.or_else(|| (!fits).then(|| split_object_median(primitives)))
        }
    }
}
// </solution>
