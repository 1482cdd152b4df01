//! Stage 9 · coherence: neighbouring rays often hit the same primitive. A ray first tests the
//! primitive that the previous ray hit, and a packet of rays traverses the tree together.
//!
//! Slides: `slides/stage09.md`.
//!
//! Given: [`Probe`] with `enter`, `open` and `hit`, as in stage 3; [`Cells`] with `hit`.

use raykata::bvh::{Bvh, Contents, PrimitiveHit, Probe};
use raykata::partition::Cells;
use raykata::ray::Ray;

// <solution>
use crate::stage3_traversal::{keep_closest, nearer};
// </solution>

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
    // <solution>
    // Test the primitive of the previous ray, and shorten the ray to its hit.
    let (mut ray, mut closest) = (*ray, None);
    if let Some(primitive) = last
        && let Some(t) = probe.hit(primitive, &ray)
    {
        keep_closest(&mut closest, &mut ray, PrimitiveHit { t, primitive });
    }
    // Search with the shortened ray.
    // It may find nothing; then the hit with the last primitive is the answer.
    let found = search(probe, &ray);
    nearer(closest, found)
    // <stub> todo!("test the last primitive, shorten the ray by its hit, search, and keep the nearer of both")
    // </solution>
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
    // <solution>
    // Traverse the tree once per packet of at most eight rays.
    let mut hits = Vec::with_capacity(rays.len());
    for rays in rays.chunks(PACKET) {
        let mut packet = Packet { rays: rays.to_vec(), best: vec![None; rays.len()] };
        if let Some(root) = bvh.root() {
            let all = [Some(f32::NEG_INFINITY); PACKET];
            let entries = packet.enter(root, probe, &all);
            packet.search(root, bvh, probe, &entries);
        }
        hits.extend(packet.best);
    }
    hits
    // <stub> todo!("go down once for up to eight rays, with the rays that enter each box")
    // </solution>
}

// <solution>
/// The `t` at which each ray enters a box; `None` for a ray that misses the box or ends before it.
type Entries = [Option<f32>; PACKET];

struct Packet {
    /// `t_max` shrinks with every hit.
    rays: Vec<Ray>,
    best: Vec<Option<PrimitiveHit>>,
}

impl Packet {
    /// Computes the entries of a box for all rays that enter its parent.
    fn enter(&self, node: u32, probe: &mut impl Probe, parent: &Entries) -> Entries {
        let mut entries = [None; PACKET];
        for (index, ray) in self.rays.iter().enumerate() {
            entries[index] = parent[index].and_then(|_| probe.enter(node, ray));
        }
        entries
    }

    fn search(&mut self, node: u32, bvh: &Bvh, probe: &mut impl Probe, entries: &Entries) {
        // Remove the rays that have found a hit before this box since its entry was computed.
        let mut active = *entries;
        for (entry, ray) in active.iter_mut().zip(&self.rays) {
            *entry = entry.filter(|enter| *enter < ray.t_max);
        }
        // Skip the box only if no ray is left, not as soon as one ray misses it.
        if active.iter().all(Option::is_none) {
            return;
        }
        // Open the node once for all remaining rays.
        match probe.open(node) {
            Contents::Leaf { first, count } => {
                for &primitive in bvh.primitives(first, count) {
                    self.test(primitive, probe, &active);
                }
            }
            Contents::Inner { left, right } => {
                let in_left = self.enter(left, probe, &active);
                let in_right = self.enter(right, probe, &active);
                // Let the rays vote which child is nearer, and search it first.
                let votes: i32 = (0..PACKET)
                    .map(|index| match (in_left[index], in_right[index]) {
                        (Some(left), Some(right)) => i32::from(left <= right) - i32::from(right < left),
                        _ => 0,
                    })
                    .sum();
                let order = if votes >= 0 {
                    [(left, in_left), (right, in_right)]
                } else {
                    [(right, in_right), (left, in_left)]
                };
                for (child, entries) in &order {
                    self.search(*child, bvh, probe, entries);
                }
            }
        }
    }

    fn test(&mut self, primitive: u32, probe: &mut impl Probe, active: &Entries) {
        for (index, ray) in self.rays.iter_mut().enumerate() {
            if active[index].is_none() {
                continue;
            }
            let Some(t) = probe.hit(primitive, ray) else { continue };
            keep_closest(&mut self.best[index], ray, PrimitiveHit { t, primitive });
        }
    }
}
// </solution>
