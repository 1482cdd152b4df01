//! Stage 9 · coherence: neighbouring rays often hit the same primitive. A ray first tests the
//! primitive that the previous ray hit, and a packet of rays traverses the tree together.
//!
//! Slides: `slides/stage09.md`.
//!
//! Given: [`Probe`] with `enter`, `open` and `hit`, as in stage 3; [`Cells`] with `hit`.

use raykata::bvh::{Bvh, Contents, PrimitiveHit, Probe};
use raykata::partition::Cells;
use raykata::ray::Ray;

/// The largest number of rays in a packet: one bit each of a byte, or one lane each of a wide
/// register.
pub const PACKET: usize = 8;

/// Neighbouring rays often hit the same primitive. Test `last`, the primitive that the previous ray
/// hit, and give `search` a ray that ends at this hit. The answer is that of `search` alone. What
/// if it then finds nothing?
///
/// Exactly:
///
/// 1. At equal `t` the smaller number wins.
/// 2. A hit counts only within the range of `ray`.
/// 3. With `last = None`, or if the ray misses that primitive, `search` gets the whole ray.
///
/// Source: "Cache Node Intersections".
pub fn closest_hit_cached<P: Cells>(
    last: Option<u32>,
    probe: &mut P,
    ray: &Ray,
    search: impl FnOnce(&mut P, &Ray) -> Option<PrimitiveHit>,
) -> Option<PrimitiveHit> {
    todo!("test the last primitive, shorten the ray by its hit, search, and keep the nearer of both")
}

/// Up to [`PACKET`] neighbouring rays, which open mostly the same nodes, traverse the tree
/// together; more form several packets. When may one skip a node?
///
/// Exactly:
///
/// 1. One result per ray, in order, the same as alone: each ray keeps its range and best hit. At
///    equal `t` any of the primitives counts.
/// 2. Open a node at most once per packet, and only if at least one ray enters it before its best
///    hit.
///
/// Source: "Other Accelerations".
pub fn closest_hit_packet(bvh: &Bvh, probe: &mut impl Probe, rays: &[Ray]) -> Vec<Option<PrimitiveHit>> {
    todo!("go down once for up to eight rays, with the rays that enter each box")
}
