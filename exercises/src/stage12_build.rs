//! Stage 12 · a builder that is as fast as its trees: bins in place of sorting, leaves that pay for
//! whole blocks, and work that several threads share.
//!
//! Slides: `slides/stage12.md`. Source: Wald, "On fast Construction of SAH-based Bounding Volume
//! Hierarchies", 2007.
//!
//! Given: [`PrimitiveBox`], a primitive with its box in 32 bytes; [`BinGrid`] and [`Bins`];
//! [`Forks`], which makes these boxes, runs two pieces of work in parallel and logs it; the costs
//! [`NODE_COST`] and [`BLOCK_COST`]; [`DEEPEST_SPLIT`].

use raykata::aabb::Aabb;
use raykata::bvh::DEEPEST_SPLIT;
use raykata::wide::{
    BLOCK, BLOCK_COST, BinGrid, BinSplit, Bins, FlatTree, Fork, ForkKind, Forks, MAX_BINS, MAX_LEAF,
    NODE_COST, PrimitiveBox,
};

/// Sorts primitives into bins, `bin(c) = ⌊(c - low) · scale⌋`: per axis, each bin gets the number
/// of the primitives whose centroid lies in it, and the box around their boxes.
///
/// Exactly:
///
/// 1. c is `primitive.twice_centroid()`.
/// 2. A bin below 0 counts as bin 0, a bin above the last one as the last one.
/// 3. The empty box changes no box, but its primitive is counted.
pub fn fill_bins(primitives: &[PrimitiveBox], grid: &BinGrid) -> Bins {
    todo!("find the bin of each primitive along each axis; extend its box and count the primitive")
}

/// The cost of a leaf of n primitives: `BLOCK_COST · ⌈n / BLOCK⌉`. A ray tests eight triangles at
/// once, so it pays for whole blocks: nine cost as much as sixteen. The result is exact for up to 2²⁴
/// primitives.
pub fn block_cost(n_primitives: u32) -> f32 {
    todo!("round up to whole blocks")
}

/// The cheapest split between two bins, of all three axes, by the surface area heuristic: the
/// smallest `A(L) c(L) + A(R) c(R)`, with half the surface area `A` of the box around a side's bins
/// and the cost `c` of its primitives as a leaf ([`block_cost`]). How many passes over the bins
/// does an axis need?
///
/// `n_bins` bins per axis are in use, so the right side begins at a bin of `1..n_bins`. Of equal
/// costs up to rounding, any is right.
///
/// Exactly:
///
/// 1. Both sides have primitives; `None` if every split leaves one side without any.
/// 2. A cost of 0 (boxes without area) is a cost like any other.
/// 3. The result has the cost of the split.
///
/// Source: "Surface Area Heuristic"; Wald, "On fast Construction of SAH-based Bounding Volume
/// Hierarchies", 2007.
pub fn cheapest_split(bins: &Bins, n_bins: u32) -> Option<BinSplit> {
    todo!("for each axis: add up bins from the right and from the left, and compare the costs")
}

/// Reorders primitives so that those of the left side of `split` come first, and returns their
/// number. On which side is a centroid exactly between two bins?
///
/// The bin of a primitive is that of [`fill_bins`]. The order within a side is free, and a side may
/// be empty.
pub fn partition_bins(primitives: &mut [PrimitiveBox], grid: &BinGrid, split: &BinSplit) -> usize {
    todo!("swap primitives in place until all of the left side come first")
}

/// Builds a binary hierarchy from the top down, each node divided at its cheapest split between up
/// to [`MAX_BINS`] equal bins per axis over its centroids. What if all centroids are equal?
/// Primitive `i` has the box `bounds[i]`.
///
/// Exactly:
///
/// 1. A node of up to [`BLOCK`] primitives is a leaf; one of more than [`MAX_LEAF`] never is.
/// 2. In between it is one where no split is possible, or if
///    `NODE_COST · A + A(L) c(L) + A(R) c(R) ≥ A · c` (c is [`block_cost`]).
/// 3. Without a split a larger node, and at depth [`DEEPEST_SPLIT`] each of more than `BLOCK`, is
///    halved in any order.
/// 4. Leaves stand in `order` as in the tree.
/// 5. Boxes are the smallest possible.
/// 6. The cost (`NODE_COST · A` per inner node, `A · c` per leaf) is at most 1.05 times that of a
///    full sweep, unless sizes differ a millionfold.
pub fn build_binned(bounds: &[Aabb]) -> FlatTree {
    todo!("make a leaf or fill bins, choose a split, partition, and build both sides")
}

/// Builds the tree of [`build_binned`], both sides of large nodes in parallel by [`Forks::join`].
/// The *work* is the time on one thread, the *span* that on any number. A node adds its number n of
/// primitives to the work and span of its sides; of parallel sides the larger span counts. What
/// happens to indices when arrays are joined?
///
/// Exactly:
///
/// 1. The tree is the same, bit for bit.
/// 2. Each forked node is logged once, as [`ForkKind::Children`], with the position `first` of its
///    first primitive in the whole `order`.
/// 3. The span is at most 1/3 of the work at 30,000 primitives of about one size, and 1/5 at
///    100,000.
/// 4. Bonus: 1/8 at 100,000. [`Forks::each`] sorts into bins in pieces of 1,000 primitives or more,
///    logged once with the number of pieces; the node then adds `n/2 + n/(2 pieces)` to the span.
///
/// Source: Blumofe and Leiserson, "Scheduling Multithreaded Computations by Work Stealing", 1999.
pub fn build_parallel(bounds: &[Aabb], forks: &mut Forks) -> FlatTree {
    todo!("build as before; where both sides are large, join them by a fork")
}
