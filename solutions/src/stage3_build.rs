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

// <solution>
use crate::stage3_boxes::longest_axis;
// </solution>

/// Object median split: order the primitives by centroid along the longest axis of the box around all of them, and
/// put half of them on each side.
///
/// `primitives` has at least two elements. The function reorders them and returns an index: the primitives before it
/// go to the left side, the others to the right side. The sides hold n / 2 primitives each; if n is odd, either side
/// may hold one more. Neither side may be empty. Equal centroids may go to either side. A centroid may be NaN, so
/// sort with `total_cmp`.
pub fn split_object_median(primitives: &mut [PrimitiveRef]) -> usize {
    // <solution>
    let axis = longest_axis(&bounds_of(primitives));
    // Move the smaller half to the front. A complete sort is not necessary. The id breaks ties, so that the same
    // scene always gives the same tree.
    let middle = primitives.len() / 2;
    primitives.select_nth_unstable_by(middle, |p, q| {
        p.centroid[axis].total_cmp(&q.centroid[axis]).then(p.id.cmp(&q.id))
    });
    middle
    // <stub> todo!("order the primitives by centroid along the longest axis and split in half")
    // </solution>
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
    // <solution>
    // Find the cheapest cut of all three axes.
    let mut best: Option<Cut> = None;
    for axis in 0..3 {
        sort_along(primitives, axis);

        // Compute the areas of all right sides in one pass: area_right[i] belongs to the box around primitives[i..].
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

    // Return None if a leaf is not more expensive than the cut. A NaN gives a leaf, too.
    let Cut { axis, middle, cost } = best?;
    let area = surface_area(&bounds_of(primitives));
    let as_leaf = INTERSECTION_COST * area * primitives.len() as f32;
    if !(TRAVERSAL_COST * area + INTERSECTION_COST * cost < as_leaf) {
        return None;
    }
    // Sort along the best axis again, because the last sort was along z.
    sort_along(primitives, axis);
    Some(middle)
    // <stub> todo!("find the cut with the least A(L) n(L) + A(R) n(R) over all three axes")
    // </solution>
}

// <solution>
/// A cut of the primitives, sorted by centroid along `axis`: those before the index `middle` go to the left side.
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

/// Sorts by centroid along an axis. The id breaks ties.
fn sort_along(primitives: &mut [PrimitiveRef], axis: usize) {
    primitives.sort_unstable_by(|p, q| p.centroid[axis].total_cmp(&q.centroid[axis]).then(p.id.cmp(&q.id)));
}
// </solution>

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
/// Builds the tree below a new node over these primitives, at least one, and returns the number of the node.
fn subdivide(
    bvh: &mut Bvh,
    primitives: &mut [PrimitiveRef],
    split: Split,
    leaf_size: usize,
    depth: usize,
) -> u32 {
    // Add the node before its children. Then make it a leaf, or split the primitives and build both sides.
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
    let fits = primitives.len() <= leaf_size;
    match split {
        _ if primitives.len() == 1 => None,
        Split::ObjectMedian | Split::SpatialMedian if fits => None,
        Split::ObjectMedian => Some(split_object_median(primitives)),
        Split::SpatialMedian => Some(split_spatial_median(primitives)),
        Split::SurfaceArea => {
            let cheaper = split_surface_area(primitives);
            // If no cut is cheaper but a leaf may not hold so many primitives, use the object median.
            cheaper.or_else(|| (!fits).then(|| split_object_median(primitives)))
        }
    }
}
// </solution>
