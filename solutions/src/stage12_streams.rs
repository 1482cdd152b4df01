//! Stage 12, bonus · streams: many rays go through the tree together, so that each node is fetched once.
//!
//! Sources: Pharr, Kolb, Gershbein and Hanrahan, "Rendering Complex Scenes with Memory-Coherent Ray Tracing", SIGGRAPH 1997;
//! Fuetterling, Lojewski, Pfreundt and Ebert, "Efficient Ray Tracing Kernels for Modern CPU Architectures", JCGT 2015.
//!
//! Given: [`StreamProbe`], whose calls take the number of a ray; [`raykata::wide::Child`], what a place of a node holds.

use raykata::bvh::PrimitiveHit;
use raykata::ray::Ray;
use raykata::wide::StreamProbe;

// <solution>
use crate::stage3_traversal::keep_closest;
use glam::Vec3;
use raykata::wide::{BLOCK, Child, ChildContents};
// </solution>

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
    // <solution>
    let low = rays.iter().fold(Vec3::INFINITY, |low, ray| low.min(ray.origin)).as_dvec3();
    let high = rays.iter().fold(Vec3::NEG_INFINITY, |high, ray| high.max(ray.origin)).as_dvec3();
    let key = |ray: &Ray| -> u64 {
        let at = 1024.0 * (ray.origin.as_dvec3() - low) / (high - low);
        let mut key = 0;
        for axis in 0..3 {
            // The conversion rounds down, and makes 0 of the NaN 0/0.
            let cell = (at[axis] as u64).min(1023);
            for bit in 0..10 {
                key |= (cell >> bit & 1) << (3 * bit + axis);
            }
            key |= u64::from(ray.direction[axis] < 0.0) << (30 + axis);
        }
        key
    };
    let mut keyed: Vec<(u64, u32)> = (0..).zip(rays).map(|(number, ray)| (key(ray), number)).collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, number)| number).collect()
    // <stub> todo!("compute the octant and the Morton code of each ray, and sort")
    // </solution>
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
    // <solution>
    let mut rays = rays.to_vec();
    let mut closest = vec![None; rays.len()];
    // A place on the stack has the rays in `waiting` from an index on, each with the t at which it enters.
    let mut waiting: Vec<(u32, f32)> = (0..).zip(&rays).map(|(ray, one)| (ray, one.t_min + 0.0)).collect();
    let mut stack = vec![(Child::ROOT, 0)];
    let mut active: Vec<(u32, f32)> = Vec::new();
    let mut below: [Vec<(u32, f32)>; 8] = Default::default();
    while let Some((child, start)) = stack.pop() {
        // Take the rays of the place, without those that have a hit in front of it.
        active.clear();
        active.extend(waiting.drain(start..).filter(|&(ray, t)| t < rays[ray as usize].t_max));
        match child.contents() {
            _ if active.is_empty() => {}
            ChildContents::Inner(node) => {
                // Give each child the rays that enter it.
                for &(ray, _) in &active {
                    let entered = probe.enter(ray, node, rays[ray as usize].t_max);
                    for (i, of_child) in below.iter_mut().enumerate() {
                        if entered.mask >> i & 1 == 1 {
                            of_child.push((ray, entered.t[i]));
                        }
                    }
                }
                // Push the children, and last the one that is entered first.
                let first_entry =
                    |i: usize| below[i].iter().fold(f32::INFINITY, |first, (_, t)| first.min(*t));
                let mut order: [(f32, usize); 8] = std::array::from_fn(|i| (first_entry(i), i));
                order.sort_by(|p, q| q.0.total_cmp(&p.0));
                let children = probe.children(node);
                for (_, i) in order {
                    if !below[i].is_empty() {
                        stack.push((children[i], waiting.len()));
                        waiting.append(&mut below[i]);
                    }
                }
            }
            ChildContents::Leaf { block, count } => {
                // Test each block with all rays. Each hit shortens its ray.
                for i in 0..count.div_ceil(BLOCK as u32) {
                    let n = (count - i * BLOCK as u32).min(BLOCK as u32);
                    for &(ray, _) in &active {
                        let (number, ray) = (ray, &mut rays[ray as usize]);
                        let mut lanes = probe.candidates(number, block + i, n, ray.t_max);
                        while lanes != 0 {
                            if let Some(hit) = probe.hit(number, block + i, lanes.trailing_zeros(), ray) {
                                keep_closest(&mut closest[number as usize], ray, hit);
                            }
                            lanes &= lanes - 1;
                        }
                    }
                }
            }
        }
    }
    closest
    // <stub> todo!("take all rays of a place through its node, and give each child the rays that enter it")
    // </solution>
}
