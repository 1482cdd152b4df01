//! Stage 3 · traversing a bounding volume hierarchy: with its boxes, a ray tests only a small part of a scene.
//!
//! Slides: "Bounding Volume Hierarchy", "Sort Bounding Volume Intersections".
//!
//! Given: [`Probe`] with `open` (the contents of a node), `enter` (the `t` at which the ray enters its box) and `hit`
//! (the `t` at which the ray hits a primitive). The searches take all boxes and hits from the probe, which also counts
//! the calls.

use raykata::bvh::{Bvh, Contents, PrimitiveHit, Probe};
use raykata::ray::Ray;

/// The closest hit by the simple search of the lecture: if the ray enters the box of a node, search both children and
/// keep the nearer hit.
///
/// The result is the hit with the smallest `t` in the ray's range, or `None`. Of two hits at the same `t` the smaller
/// primitive number wins. A node is opened only if the ray enters its box (`probe.enter` returns `Some`).
pub fn closest_hit_both(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("ask both children of every box that the ray enters, and keep the nearer hit")
}

/// The closest hit by the fast search: of two children search the nearer one first, and skip every box that begins
/// beyond the best hit so far.
///
/// The result is the same hit as that of [`closest_hit_both`], also for two hits at the same `t`. The search opens
/// far fewer nodes: it lowers `t_max` at each hit, and compares the farther child's entry with `t_max` again after it
/// has searched the nearer child. If the ray enters both children at the same `t`, either may be searched first.
///
/// Pitfall: boxes overlap, so a hit in the nearer child may lie behind a hit in the farther child. And if `t_max`
/// becomes exactly `t`, another hit at the same `t` is not reported, because the range is open.
pub fn closest_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("enter the nearer child first, and skip boxes beyond the best hit")
}

/// Whether any primitive is hit within the ray's range. A shadow ray needs no more than that.
///
/// The search stops at the first hit: after it, no further primitive is tested. A node is opened only if the ray
/// enters its box.
///
/// Pitfall: to enter a box is not yet a hit.
pub fn any_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> bool {
    todo!("like closest_hit_both, but stop at the first hit")
}
