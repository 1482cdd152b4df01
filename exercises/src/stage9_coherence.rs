//! Stage 9 · coherence: neighbouring rays often hit the same primitive. A ray first tests the primitive that the
//! previous ray hit, and a packet of rays traverses the tree together.
//!
//! Slides: "Cache Node Intersections", "Other Accelerations" (screen space coherence: check > 1 ray at once).
//!
//! Given: [`Probe`] with `enter`, `open` and `hit`, as in stage 3; [`Cells`] with `hit`.

use raykata::bvh::{Bvh, Contents, PrimitiveHit, Probe};
use raykata::partition::Cells;
use raykata::ray::Ray;

/// The largest number of rays in a packet: one bit each of a byte, or one lane each of a wide register.
pub const PACKET: usize = 8;

/// Finds the closest hit faster by testing first the primitive `last` that the previous ray hit: `search` gets a ray
/// that ends at this hit, so it skips everything behind it.
///
/// The answer is the same as that of `search` alone: of two hits at the same `t` the smaller primitive number wins, and
/// a hit counts only within the range of `ray`. With `last = None`, or if the ray misses that primitive, `search` gets
/// the whole ray.
///
/// Pitfall: the shortened ray may find no hit. Then the hit with `last` is the answer.
///
/// Slide: "Cache Node Intersections".
pub fn closest_hit_cached<P: Cells>(
    last: Option<u32>,
    probe: &mut P,
    ray: &Ray,
    search: impl FnOnce(&mut P, &Ray) -> Option<PrimitiveHit>,
) -> Option<PrimitiveHit> {
    todo!("test the last primitive, shorten the ray by its hit, search, and keep the nearer of both")
}

/// Finds the closest hits of all rays, in one traversal per [`PACKET`] of them: open a node at most once, if at least
/// one ray enters it before its best hit, and use it for all such rays.
///
/// Returns one result per ray, in order. Each ray keeps its own range and its own best hit, and gets the same answer as
/// alone; of two hits at the same `t` the smaller primitive number wins. More than [`PACKET`] rays form several
/// packets.
///
/// Pitfall: a node may be skipped only if no ray of the packet enters it, not as soon as one ray misses it.
///
/// Slide: "Other Accelerations".
pub fn closest_hit_packet(bvh: &Bvh, probe: &mut impl Probe, rays: &[Ray]) -> Vec<Option<PrimitiveHit>> {
    todo!("go down once for up to eight rays, with the rays that enter each box")
}
