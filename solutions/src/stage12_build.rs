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

// <solution>
use glam::{Vec3, Vec3A};
use raykata::wide::{Bin, BoxA, FlatNode};
// </solution>

/// Sorts primitives into bins, `bin(c) = ⌊(c - low) · scale⌋`: per axis, each bin gets the number
/// of the primitives whose centroid lies in it, and the box around their boxes.
///
/// Exactly:
///
/// 1. c is `primitive.twice_centroid()`.
/// 2. A bin below 0 counts as bin 0, a bin above the last one as the last one.
/// 3. The empty box changes no box, but its primitive is counted.
pub fn fill_bins(primitives: &[PrimitiveBox], grid: &BinGrid) -> Bins {
    // <solution>
    let mut bins = Bins::EMPTY;
    for primitive in primitives {
        let place = (primitive.twice_centroid() - grid.low) * grid.scale;
        for axis in 0..3 {
            let bin = &mut bins.0[axis][bin_at(place[axis], grid)];
            bin.bounds = bin.bounds.and(primitive);
            bin.count += 1;
        }
    }
    bins
    // <stub> todo!("find the bin of each primitive along each axis; extend its box and count the primitive")
    // </solution>
}

// <solution>
/// The bin at a place in units of bins: the conversion rounds down.
#[inline(always)]
fn bin_at(place: f32, grid: &BinGrid) -> usize {
    // The minimum with MAX_BINS - 1 tells the compiler that the index is in range.
    (place as usize).min(grid.n_bins as usize - 1).min(MAX_BINS - 1)
}

/// Boxes that grow.
trait Grow {
    /// The box around this box and that of a primitive.
    fn and(self, primitive: &PrimitiveBox) -> Self;

    /// The box around two boxes.
    fn union(self, other: &Self) -> Self;

    /// Half of the surface area: the area of three faces. 0 for the empty box.
    fn half_area(&self) -> f32;
}

impl Grow for BoxA {
    #[inline(always)]
    fn and(self, primitive: &PrimitiveBox) -> BoxA {
        BoxA { low: primitive.low().min(self.low), high: primitive.high().max(self.high) }
    }

    #[inline(always)]
    fn union(self, other: &BoxA) -> BoxA {
        BoxA { low: other.low.min(self.low), high: other.high.max(self.high) }
    }

    #[inline(always)]
    fn half_area(&self) -> f32 {
        // The extent of the empty box is -∞.
        let size = (self.high - self.low).max(Vec3A::ZERO);
        size.x * size.y + size.y * size.z + size.z * size.x
    }
}
// </solution>

/// The cost of a leaf of n primitives: `BLOCK_COST · ⌈n / BLOCK⌉`. A ray tests eight triangles at
/// once, so it pays for whole blocks: nine cost as much as sixteen. The result is exact for up to 2²⁴
/// primitives.
pub fn block_cost(n_primitives: u32) -> f32 {
    // <solution>
    BLOCK_COST * n_primitives.div_ceil(BLOCK as u32) as f32
    // <stub> todo!("round up to whole blocks")
    // </solution>
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
    // <solution>
    let n_bins = (n_bins as usize).min(MAX_BINS);
    let mut best: Option<BinSplit> = None;
    for (axis, bins) in bins.0.iter().enumerate() {
        // Compute the cost of all right sides: right_cost[i] belongs to the bins from i on.
        let mut right_cost = [f32::INFINITY; MAX_BINS];
        let mut right = Bin::EMPTY;
        for i in (1..n_bins).rev() {
            right = join(&right, &bins[i]);
            right_cost[i] = cost_of(&right);
        }
        // Add the cost of the left side, and keep the cheapest split.
        let mut left = Bin::EMPTY;
        for i in 1..n_bins {
            left = join(&left, &bins[i - 1]);
            let cost = cost_of(&left) + right_cost[i];
            if cost < best.map_or(f32::INFINITY, |best| best.cost) {
                best = Some(BinSplit { axis: axis as u32, bin: i as u32, cost });
            }
        }
    }
    best
    // <stub> todo!("for each axis: add up bins from the right and from the left, and compare the costs")
    // </solution>
}

// <solution>
fn join(one: &Bin, other: &Bin) -> Bin {
    Bin { bounds: one.bounds.union(&other.bounds), count: one.count + other.count }
}

/// The cost of one side of a split; infinite for a side without primitives.
fn cost_of(side: &Bin) -> f32 {
    if side.count == 0 { f32::INFINITY } else { side.bounds.half_area() * block_cost(side.count) }
}
// </solution>

/// Reorders primitives so that those of the left side of `split` come first, and returns their
/// number. On which side is a centroid exactly between two bins?
///
/// The bin of a primitive is that of [`fill_bins`]. The order within a side is free, and a side may
/// be empty.
pub fn partition_bins(primitives: &mut [PrimitiveBox], grid: &BinGrid, split: &BinSplit) -> usize {
    // <solution>
    let axis = split.axis as usize;
    // Compute the bin by the operations of `fill_bins`: any other formula rounds differently, and a
    // primitive would go to another side than the one on which it was counted.
    let is_left = |primitive: &PrimitiveBox| {
        let place = (primitive.twice_centroid()[axis] - grid.low[axis]) * grid.scale[axis];
        bin_at(place, grid) < split.bin as usize
    };
    // Swap each primitive with the first one of the right side, and move the border behind it if it
    // belongs to the left side. To swap all takes less time than a branch that is wrongly predicted
    // for every other primitive: the build took 1.1 to 1.5 times as long with it.
    let mut left = 0;
    for i in 0..primitives.len() {
        let goes_left = is_left(&primitives[i]);
        primitives.swap(left, i);
        left += usize::from(goes_left);
    }
    left
    // <stub> todo!("swap primitives in place until all of the left side come first")
    // </solution>
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
    // <solution>
    if bounds.is_empty() {
        return FlatTree::default();
    }
    let mut primitives: Vec<_> = (0..).zip(bounds).map(|(id, one)| PrimitiveBox::new(id, one)).collect();
    // The root comes first, and is known last.
    let mut nodes = vec![LEAF];
    nodes[0] = build_node(&mut primitives, 0, 0, &mut nodes);
    FlatTree { nodes, order: primitives.iter().map(PrimitiveBox::id).collect() }
    // <stub> todo!("make a leaf or fill bins, choose a split, partition, and build both sides")
    // </solution>
}

// <solution>
const LEAF: FlatNode = FlatNode { low: Vec3::ZERO, first: 0, high: Vec3::ZERO, count: 0 };

/// The node over these primitives, of which the first is at position `first` of the finished order.
/// All nodes below it are appended to `nodes`.
fn build_node(
    primitives: &mut [PrimitiveBox],
    first: u32,
    depth: usize,
    nodes: &mut Vec<FlatNode>,
) -> FlatNode {
    // Find the box around all primitives, and the box around their centroids.
    let (bounds, centroids) = bounds_of(primitives);
    // Make a leaf, or divide the primitives.
    let Some(middle) = divide(primitives, &bounds, &centroids, depth, fill_bins) else {
        return node(&bounds, first, primitives.len());
    };
    // Build both sides. The two children come first, then all nodes below the left one, then those
    // below the right one.
    let (below, above) = primitives.split_at_mut(middle);
    let pair = nodes.len();
    nodes.extend([LEAF, LEAF]);
    nodes[pair] = build_node(below, first, depth + 1, nodes);
    nodes[pair + 1] = build_node(above, first + middle as u32, depth + 1, nodes);
    node(&bounds, pair as u32, 0)
}

/// A leaf of `count` primitives, the first at position `first`, or an inner node whose children are
/// at `first` and behind it.
fn node(bounds: &BoxA, first: u32, count: usize) -> FlatNode {
    FlatNode { low: bounds.low.into(), first, high: bounds.high.into(), count: count as u32 }
}
// </solution>

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
    // <solution>
    if bounds.is_empty() {
        return FlatTree::default();
    }
    let mut primitives = forks.boxes(bounds);
    // With many more forks than processors, copying the nodes of the right sides takes longer than
    // waiting.
    let fork_from = FORK_FROM.max(bounds.len() / 128);

    // The root comes first, and is known last.
    let mut parts = vec![Part { nodes: vec![LEAF], shift: 0 }];
    parts[0].nodes[0] = fork_node(&mut primitives, 0, 0, &mut parts, forks, fork_from);
    let order = primitives.iter().map(PrimitiveBox::id).collect();
    // Join the arrays. The primitives need the most memory, and nothing asks for them any more.
    drop(primitives);
    let mut nodes = Vec::with_capacity(n_nodes(&parts));
    for Part { nodes: part, shift } in parts {
        nodes.extend(part.into_iter().map(|node| shifted(node, shift)));
    }
    FlatTree { nodes, order }
    // <stub> todo!("build as before; where both sides are large, join them by a fork")
    // </solution>
}

// <solution>
/// Both sides of a node of fewer primitives are built one after the other: they would take less
/// time than a fork.
const FORK_FROM: usize = 2048;

/// An array of nodes, which stand side by side in the finished tree.
struct Part {
    nodes: Vec<FlatNode>,
    /// The number of nodes in arrays in front of this one, which its indices do not count.
    shift: u32,
}

fn n_nodes(parts: &[Part]) -> usize {
    parts.iter().map(|part| part.nodes.len()).sum()
}

/// A node whose children, if it has any, stand further behind.
fn shifted(mut node: FlatNode, by: u32) -> FlatNode {
    if !node.is_leaf() {
        node.first += by;
    }
    node
}

/// The node of [`build_node`]. From `fork_from` primitives on, its two sides are built in parallel:
/// the left side goes on in the only array so far, the right side begins one of its own.
fn fork_node(
    primitives: &mut [PrimitiveBox],
    first: u32,
    depth: usize,
    parts: &mut Vec<Part>,
    forks: &mut Forks,
    fork_from: usize,
) -> FlatNode {
    if primitives.len() < fork_from {
        return build_node(primitives, first, depth, &mut parts[0].nodes);
    }
    // Divide the primitives. So many are never a leaf.
    let fork = Fork { first, count: primitives.len() as u32, kind: ForkKind::Children };
    let (bounds, centroids) = bounds_of(primitives);
    let bins = |primitives: &[PrimitiveBox], grid: &BinGrid| fill_in_pieces(primitives, grid, first, forks);
    let Some(middle) = divide(primitives, &bounds, &centroids, depth, bins) else {
        return node(&bounds, first, primitives.len());
    };
    let (below, above) = primitives.split_at_mut(middle);
    let first_above = first + middle as u32;

    // Build both sides.
    let pair = parts[0].nodes.len();
    parts[0].nodes.extend([LEAF, LEAF]);
    let (left, (right, parts_right)) = forks.join(
        fork,
        |forks| fork_node(below, first, depth + 1, parts, forks, fork_from),
        |forks| {
            // Reserve what leaves of three primitives need. Arrays that grow leave their old places
            // behind: a tree of a million triangles took 1.69 times its memory in place of 1.50.
            let mut parts = vec![Part { nodes: Vec::with_capacity(2 * fork_from / 3), shift: 0 }];
            (fork_node(above, first_above, depth + 1, &mut parts, forks, fork_from), parts)
        },
    );
    // The arrays of the right side come after those of the left side.
    let shift = n_nodes(parts) as u32;
    parts[0].nodes[pair..pair + 2].copy_from_slice(&[left, shifted(right, shift)]);
    parts.extend(parts_right.into_iter().map(|part| Part { shift: part.shift + shift, ..part }));
    node(&bounds, pair as u32, 0)
}

/// The bins of [`fill_bins`], of large nodes in pieces.
fn fill_in_pieces(primitives: &[PrimitiveBox], grid: &BinGrid, first: u32, forks: &mut Forks) -> Bins {
    let count = primitives.len();
    if count < BIN_IN_PIECES_FROM {
        return fill_bins(primitives, grid);
    }
    let pieces = primitives.chunks(count.div_ceil(BINNING_PIECES)).collect();
    let bins = forks.each(first, count as u32, pieces, |piece| fill_bins(piece, grid));
    bins.into_iter().fold(Bins::EMPTY, |sum, of_piece| sum_of(sum, &of_piece))
}

/// The box around all primitives, and the box around twice their centroids.
fn bounds_of(primitives: &[PrimitiveBox]) -> (BoxA, BoxA) {
    let (mut bounds, mut centroids) = (BoxA::EMPTY, BoxA::EMPTY);
    for primitive in primitives {
        bounds = bounds.and(primitive);
        let centroid = primitive.twice_centroid();
        // A NaN as first operand changes nothing.
        centroids.low = centroid.min(centroids.low);
        centroids.high = centroid.max(centroids.high);
    }
    (bounds, centroids)
}

/// Divides the primitives of a node in two and returns the number of the first side; `None` for a
/// leaf. `fill` sorts them into bins.
fn divide(
    primitives: &mut [PrimitiveBox],
    bounds: &BoxA,
    centroids: &BoxA,
    depth: usize,
    fill: impl FnOnce(&[PrimitiveBox], &BinGrid) -> Bins,
) -> Option<usize> {
    let count = primitives.len();
    if count <= BLOCK {
        return None;
    }
    let in_half = Some(count / 2);
    if depth >= DEEPEST_SPLIT {
        return in_half;
    }
    // Place the bins over the centroids, and find the cheapest split.
    let n_bins = bins_for(count);
    let extent = centroids.high - centroids.low;
    // The last bin must contain the largest centroid, and an axis without extent has one bin.
    let scale = extent.to_array().map(|extent| {
        let scale = 0.999_99 * n_bins as f32 / extent;
        if scale.is_finite() { scale } else { 0.0 }
    });
    let grid = BinGrid { low: centroids.low, scale: scale.into(), n_bins };
    let split = cheapest_split(&fill(primitives, &grid), n_bins);
    let Some(split) = split else { return if count <= MAX_LEAF { None } else { in_half } };

    // A leaf is better if it is not more expensive.
    let area = bounds.half_area();
    let as_leaf = area * block_cost(count as u32);
    if count <= MAX_LEAF && !(NODE_COST * area + split.cost < as_leaf) {
        return None;
    }
    Some(partition_bins(primitives, &grid, &split))
}

/// The bins of two sets of primitives together. Boxes and counts are exact, so the sum is that of
/// one pass.
fn sum_of(mut sum: Bins, other: &Bins) -> Bins {
    for (bins, others) in sum.0.iter_mut().zip(&other.0) {
        for (bin, other) in bins.iter_mut().zip(others) {
            *bin = join(bin, other);
        }
    }
    sum
}

/// From this number of primitives on, they are sorted into bins in [`BINNING_PIECES`] pieces in
/// parallel.
const BIN_IN_PIECES_FROM: usize = 16_384;
const BINNING_PIECES: usize = 8;

/// The number of bins for a node: small nodes use fewer, because at a node of ten primitives the
/// bins take longer than the primitives.
fn bins_for(count: usize) -> u32 {
    (8 + count / 2).min(MAX_BINS) as u32
}
// </solution>
