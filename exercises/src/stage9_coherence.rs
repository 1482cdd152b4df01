//! Stage 9 · coherence: neighbouring rays meet the same things. A ray first asks about what the one before it met, and a
//! packet of rays goes through the tree together.
//!
//! Slides: "Cache Node Intersections", "Other Accelerations" (screen space coherence: check > 1 ray at once).

use raykata::bvh::{Bvh, Contents, PrimitiveHit, Probe};
use raykata::partition::Cells;
use raykata::ray::Ray;

/// The most rays of a packet: as many as have a bit in a byte, or a lane in a wide register.
pub const PACKET: usize = 8;

/// The closest hit by `search`, which gets a ray that ends at the primitive that the ray before met first, if this ray
/// meets it as well. The answer is the same as without, ties included; what lies behind is skipped from the start.
pub fn closest_hit_cached<P: Cells>(
    last: Option<u32>,
    probe: &mut P,
    ray: &Ray,
    search: impl FnOnce(&mut P, &Ray) -> Option<PrimitiveHit>,
) -> Option<PrimitiveHit> {
    todo!("test the last primitive, shorten the ray by its hit, search, and keep the nearer of both")
}

/// The closest hits of all rays, in one traversal for every [`PACKET`] of them: a node is opened once if any ray enters
/// it that has no hit before it, and then serves all that do. Each ray keeps its own range and its own best hit, and finds
/// what it would find alone.
pub fn closest_hit_packet(bvh: &Bvh, probe: &mut impl Probe, rays: &[Ray]) -> Vec<Option<PrimitiveHit>> {
    todo!("go down once for up to eight rays, with the rays that enter each box")
}
