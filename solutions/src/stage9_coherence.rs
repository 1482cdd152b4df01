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
    // <solution>
    let known = last.and_then(|primitive| {
        let t = probe.hit(primitive, ray)?;
        Some(PrimitiveHit { t, primitive })
    });
    // One step beyond t, so that another primitive at the very same t is still heard.
    let t_max = known.map_or(ray.t_max, |known| known.t.next_up().min(ray.t_max));
    let found = search(probe, &ray.with_range(ray.t_min, t_max));
    nearer(known, found)
    // <stub> todo!("test the last primitive, shorten the ray by its hit, search, and keep the nearer of both")
    // </solution>
}

// <solution>
/// The hit with the smaller `t`; at the same `t` the one with the smaller primitive number.
fn nearer(first: Option<PrimitiveHit>, second: Option<PrimitiveHit>) -> Option<PrimitiveHit> {
    match (first, second) {
        (Some(p), Some(q)) => Some(if (q.t, q.primitive) < (p.t, p.primitive) { q } else { p }),
        (one, other) => one.or(other),
    }
}
// </solution>

/// The closest hits of all rays, in one traversal for every [`PACKET`] of them: a node is opened once if any ray enters
/// it that has no hit before it, and then serves all that do. Each ray keeps its own range and its own best hit, and finds
/// what it would find alone.
pub fn closest_hit_packet(bvh: &Bvh, probe: &mut impl Probe, rays: &[Ray]) -> Vec<Option<PrimitiveHit>> {
    // <solution>
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
/// Where each ray enters a box; `None` for a ray that does not, or has ended before.
type Entries = [Option<f32>; PACKET];

struct Packet {
    /// `t_max` shrinks with every hit.
    rays: Vec<Ray>,
    best: Vec<Option<PrimitiveHit>>,
}

impl Packet {
    /// Asks about a box for all rays that are in its parent.
    fn enter(&self, node: u32, probe: &mut impl Probe, parent: &Entries) -> Entries {
        let mut entries = [None; PACKET];
        for (index, ray) in self.rays.iter().enumerate() {
            entries[index] = parent[index].and_then(|_| probe.enter(node, ray));
        }
        entries
    }

    fn search(&mut self, node: u32, bvh: &Bvh, probe: &mut impl Probe, entries: &Entries) {
        // Rays that have met something nearer since they were asked leave the packet here.
        let mut active = *entries;
        for (entry, ray) in active.iter_mut().zip(&self.rays) {
            *entry = entry.filter(|enter| *enter < ray.t_max);
        }
        if active.iter().all(Option::is_none) {
            return;
        }
        match probe.open(node) {
            Contents::Leaf { first, count } => {
                for &primitive in bvh.primitives(first, count) {
                    self.test(primitive, probe, &active);
                }
            }
            Contents::Inner { left, right } => {
                let in_left = self.enter(left, probe, &active);
                let in_right = self.enter(right, probe, &active);
                // The rays vote which child is nearer.
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
            self.best[index] = nearer(self.best[index], Some(PrimitiveHit { t, primitive }));
            ray.t_max = t.next_up().min(ray.t_max);
        }
    }
}
// </solution>
