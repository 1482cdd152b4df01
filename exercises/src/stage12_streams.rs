//! Stage 12, bonus · streams: many rays go through the tree together, so that each node is fetched once.
//!
//! Sources: Pharr, Kolb, Gershbein and Hanrahan, "Rendering Complex Scenes with Memory-Coherent Ray Tracing", SIGGRAPH 1997;
//! Fuetterling, Lojewski, Pfreundt and Ebert, "Efficient Ray Tracing Kernels for Modern CPU Architectures", JCGT 2015.
//!
//! Given: [`StreamProbe`], whose calls take the number of a ray; [`raykata::wide::Child`], what a place of a node holds.

use raykata::bvh::PrimitiveHit;
use raykata::ray::Ray;
use raykata::wide::StreamProbe;

/// The numbers of all rays in an order in which neighbours visit the same nodes: sorted by the octant of the direction, and within an
/// octant along a curve of Morton through the origins.
///
/// The octant is `Σ 2^axis` over the axes on which the direction is below 0; −0 is not. The space of the origins is the smallest
/// box around all of them, divided into 1024 cells along each axis. The cell of an origin is `⌊1024 (o - low) / (high - low)⌋`, at
/// most 1023, and 0 on an axis along which all origins are equal. The Morton code interleaves the bits of the three cells: bit `b`
/// of the cell on `axis` is bit `3 b + axis` of the code. Origins are finite.
///
/// The order of rays with the same octant and the same code is free. An origin that is closer than a thousandth of a cell to the
/// next cell may count there.
///
/// Source: Morton, "A Computer Oriented Geodetic Data Base", 1966.
pub fn stream_order(rays: &[Ray]) -> Vec<u32> {
    todo!("compute the octant and the Morton code of each ray, and sort")
}

/// The closest hit of each ray in a wide tree with at least one node, or `None`: the same hits as those of
/// [`wide_closest_hit`](crate::stage12_search::wide_closest_hit) for each ray alone. There are at most
/// [`STREAM`](raykata::wide::STREAM) rays.
///
/// A stack holds places of the tree, each with the rays that enter it. A node is entered by all of its rays, one after the other, so
/// that it is fetched once. Each child gets the rays that enter it. The child that any ray enters first is visited first. A ray is
/// left out of a place beyond its best `t` so far when the place comes from the stack, as in the search for one ray, and a place
/// without rays is skipped. A leaf is tested block by block, each with all rays.
///
/// No node and no block is fetched twice, and no ray is tested in a node that it does not enter. All calls of the probe are counted;
/// all points need at most 1.05 times as many as the reference makes.
///
/// Pitfall: each ray has a range of its own, which its own hits shorten.
#[inline(always)]
pub fn stream_closest_hits<P: StreamProbe>(probe: &mut P, rays: &[Ray]) -> Vec<Option<PrimitiveHit>> {
    todo!("take all rays of a place through its node, and give each child the rays that enter it")
}
