//! Stage 12 · a builder that is as fast as its trees: bins in place of sorting, leaves that pay for whole blocks, and work
//! that several threads share.
//!
//! Slides: "Surface Area Heuristic". Source: Wald, "On fast Construction of SAH-based Bounding Volume Hierarchies", 2007.
//!
//! Given: [`PrimitiveBox`], a primitive with its box in 32 bytes; [`BinGrid`] and [`Bins`]; [`Forks`], which makes these boxes, runs
//! two pieces of work in parallel and logs it; the costs [`NODE_COST`] and [`BLOCK_COST`]; [`DEEPEST_SPLIT`].

use raykata::aabb::Aabb;
use raykata::bvh::DEEPEST_SPLIT;
use raykata::wide::{
    BLOCK, BLOCK_COST, BinGrid, BinSplit, Bins, FlatTree, Fork, ForkKind, Forks, MAX_BINS, MAX_LEAF,
    NODE_COST, PrimitiveBox,
};

/// Sorts primitives into bins: per axis, each bin gets the number of the primitives whose centroid lies in it, and the box
/// around their boxes.
///
/// Along an axis, a primitive with `c = primitive.twice_centroid()` belongs to bin `⌊(c - grid.low) · grid.scale⌋`. A bin below
/// 0 or a NaN counts as bin 0, and a bin above the last one as the last one. The empty box changes no box of a bin, but its
/// primitive is counted.
///
/// One pass over the primitives is enough, and it must be one pass: the builder does it at each node.
pub fn fill_bins(primitives: &[PrimitiveBox], grid: &BinGrid) -> Bins {
    todo!("find the bin of each primitive along each axis; extend its box and count the primitive")
}

/// The cost of a leaf with this number of primitives: `BLOCK_COST · ⌈n / BLOCK⌉`.
///
/// A ray tests four triangles at once, so it pays for whole blocks. A leaf of five costs as much as one of eight. The result is
/// exact for up to 2²⁴ primitives.
pub fn block_cost(n_primitives: u32) -> f32 {
    todo!("round up to whole blocks")
}

/// The cheapest split between two bins, of all three axes, by the surface area heuristic: the one with the smallest
/// `A(L) c(L) + A(R) c(R)`, with half the surface area `A` of the box around a side, and the cost `c` of its primitives as a
/// leaf ([`block_cost`]).
///
/// `n_bins` bins per axis are in use, so the first bin of the right side is one of `1..n_bins`. Both sides have primitives; the
/// result is `None` if every split leaves one side without any. Of splits with the same cost up to rounding any one is right,
/// and a cost of 0 (boxes without area) is a cost like any other. The box of a side is the box around its bins. The result has
/// the cost of the split.
///
/// Two passes per axis are enough: one from the right that stores the cost of each right side, and one from the left.
pub fn cheapest_split(bins: &Bins, n_bins: u32) -> Option<BinSplit> {
    todo!("for each axis: add up bins from the right and from the left, and compare the costs")
}

/// Reorders primitives so that those of the left side of `split` come first, and returns their number.
///
/// The bin of a primitive is that of [`fill_bins`]. The order within a side is free. No memory is needed beside the slice.
///
/// Pitfall: a different formula for the bin may round differently. Then the sides are not those whose cost was compared,
/// and one may be empty.
pub fn partition_bins(primitives: &mut [PrimitiveBox], grid: &BinGrid, split: &BinSplit) -> usize {
    todo!("swap primitives in place until all of the left side come first")
}

/// Builds a binary hierarchy over primitives with these boxes, top down, with bins in place of sorting.
///
/// Primitive `i` has the box `bounds[i]`. A node of at most [`BLOCK`] primitives becomes a leaf. A larger node is split at its
/// cheapest split between [`MAX_BINS`] equal bins per axis, over the box around the centroids of its primitives, unless
/// a leaf is not more expensive: `NODE_COST · A + A(L) c(L) + A(R) c(R) ≥ A · c` with `c` for [`block_cost`]. Only a node of at
/// most [`MAX_LEAF`] primitives may become a leaf. A node with fewer primitives than bins may use fewer bins. Where no split is
/// possible, because all centroids are equal, a node that may become a leaf becomes one. A larger one, and every node of more than
/// [`BLOCK`] primitives at depth [`DEEPEST_SPLIT`], is divided in half in any order.
///
/// The tree has the layout of [`FlatTree`], and its leaves stand in `order` in the order of the tree. The box of a node is the
/// smallest box around the boxes of its primitives. A box that is empty or has NaN goes into some leaf and changes no other box.
///
/// The cost of the tree, `NODE_COST · A` for each inner node and `A · c` for each leaf, is at most 1.05 times that of a full
/// sweep, which tries every split of the sorted primitives with the same costs. Equal bins cannot do this for sizes that
/// differ by a factor of a million, such as boxes of which each is half as large as the one before.
///
/// Pitfall: with `1 / extent` as scale, an axis along which all centroids are equal gives 0 · ∞.
pub fn build_binned(bounds: &[Aabb]) -> FlatTree {
    todo!("make a leaf or fill bins, choose a split, partition, and build both sides")
}

/// Builds the tree of [`build_binned`] with forks: where both sides of a split are large, they are built in parallel
/// by [`Forks::join`].
///
/// The tree is the same as that of [`build_binned`], bit for bit. Each forked node is logged once, as
/// [`ForkKind::Children`]: `first` is the position of its first primitive in the `order` of the whole tree.
///
/// The *work* is the time on one thread, and the *span* the time on any number of threads, both counted in primitives. The work
/// of a node is its number of primitives plus the work of its two sides. Its span is its number of primitives plus the larger span
/// of its two sides if they are built in parallel, and plus both spans if not. For primitives of about one size,
/// the span must be at most a third of the work at 30,000 primitives and at most a fifth at 100,000. Forks at all nodes above 2,000
/// primitives achieve that.
///
/// Bonus: with as many threads as you like, the root's own primitives take most of the time. Sort the primitives of large nodes
/// into bins in equal pieces by [`Forks::each`], which logs the node once with the number of pieces, and add up the bins. Half of
/// the node's own work is sorting, which takes the time of one piece then; the other half, dividing, is not forked. So its own
/// span is `n/2 + n/(2 pieces)` in place of `n`. A piece has at least 1,000 primitives. The span must be at most an eighth of the work
/// at 100,000 primitives.
///
/// Pitfall: two sides that are built in parallel cannot append to one array, and indices shift when arrays are joined.
///
/// Source: Blumofe and Leiserson, "Scheduling Multithreaded Computations by Work Stealing", 1999.
pub fn build_parallel(bounds: &[Aabb], forks: &mut Forks) -> FlatTree {
    todo!("build as before; where both sides are large, join them by a fork")
}
