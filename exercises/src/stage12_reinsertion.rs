//! Stage 12, bonus · better trees: subtrees move to places where they cost less.
//!
//! Sources: Bittner, Hapala and Havran, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies", Computer Graphics
//! Forum 2013; Meister and Bittner, "Parallel Reinsertion for Bounding Volume Hierarchy Optimization", Eurographics 2018.
//!
//! Given: [`PlaceProbe`] with `open` (a node's area, its area together with the subtree, and its children); [`SubtreePlace`];
//! [`FlatTree`].

use raykata::wide::{FlatTree, PlaceProbe, SubtreePlace};

/// Where a subtree costs least: the node `X` beside which it is inserted. A new inner node takes the place of `X`, with `X` and the
/// subtree as its children.
///
/// The areas of all inner nodes together grow by
///
/// `increase(X) = U(X) + Σ (U(Y) - A(Y))` over all nodes `Y` above `X`,
///
/// with half the surface area `A` of a node's box, and `U` of the box around the node and the subtree. `U(X)` is the area of the
/// new inner node, and each node above it grows to hold the subtree. `X` may be the root or a leaf. `area` is that of the
/// subtree's box, and no `U` is smaller. All areas are finite. Of places with the same increase any one is right.
///
/// Find it by branch and bound: below a node, each increase is at least the growth of all nodes above plus `area`. So a node is
/// left out if this bound is not below the best increase so far. The calls of the probe are counted; all points need at most 1.05
/// times as many as the reference makes, which always opens the node with the smallest bound (a priority queue).
///
/// Pitfall: the child with the smaller increase may be the wrong way down.
pub fn cheapest_place<P: PlaceProbe>(probe: &mut P, root: u32, area: f64) -> SubtreePlace {
    todo!("open the node with the smallest bound, until no bound is below the best increase")
}

/// Improves a tree by moves of subtrees, and returns it in the layout of [`FlatTree`].
///
/// A move takes a node that is not the root, with everything below it, out of the tree; its sibling takes the place of its
/// parent. Then the subtree is inserted beside another node, as [`cheapest_place`] describes. It makes at most `most_moves` moves,
/// and none that makes the areas of all inner nodes together larger. It ends where no move makes them smaller by more than a
/// rounding error. It may end earlier, but makes at least one move if one is allowed and makes them clearly smaller.
///
/// Each leaf stays a leaf, with the same box and the same primitives in the same order. The box of an inner node is the smallest
/// box around the boxes of its two children; an empty box changes no union. `order` lists the leaves in the new order of the
/// tree. A tree without nodes, or with one leaf, stays as it is. Boxes have any size, so areas need double precision.
///
/// With as many moves as the tree has nodes, trees over primitives in the order of the Morton code become a sixth cheaper on average,
/// by the cost of [`build_binned`](crate::stage12_build::build_binned); all points need nine tenths of what the reference
/// saves. One way to get there: try all nodes, the largest area first, each at its cheapest place, and repeat that a few times.
///
/// Pitfall: the areas above the old place shrink before the new place is searched. Without that, a subtree seems to fit best where
/// it already is.
pub fn reinsert(tree: &FlatTree, most_moves: u32) -> FlatTree {
    todo!("take each subtree out, find its cheapest place, and insert it there if the tree gets cheaper")
}
