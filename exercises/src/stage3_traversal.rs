//! Stage 3 · traversing a bounding volume hierarchy: with its boxes, a ray tests only a small part
//! of a scene.
//!
//! Slides: `slides/stage03.md`.
//!
//! Given: [`Probe`] with `open` (the contents of a node), `enter` (the `t` at which the ray enters
//! its box) and `hit` (the `t` at which the ray hits a primitive). The searches take all boxes and
//! hits from the probe, which also counts the calls.

use raykata::bvh::{Bvh, Contents, PrimitiveHit, Probe};
use raykata::ray::Ray;

/// If a ray misses a box, it misses everything inside. If it enters the box of a node, search both
/// children and keep the nearer hit.
///
/// Returns the hit with the smallest `t` in the ray's range. At the same `t` the smaller primitive
/// number wins. A node is opened only if the ray enters its box (`probe.enter` returns `Some`).
pub fn closest_hit_both(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("ask both children of every box that the ray enters, and keep the nearer hit")
}

/// Search the nearer child first, and skip every box that begins beyond the best hit so far. Boxes
/// overlap: is a hit in the nearer child the closest? Does a hit at exactly `t_max` count?
///
/// Returns the same hit as [`closest_hit_both`], also at the same `t`. If the ray enters both
/// children at the same `t`, either may be first.
///
/// Exactly:
///
/// 1. `t_max` is lowered at each hit. After the nearer child, the farther child's entry is compared
///    with it again.
pub fn closest_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("enter the nearer child first, and skip boxes beyond the best hit")
}

/// Whether any primitive is hit within the ray's range: a shadow ray needs to know no more. Is a
/// box that it enters a hit?
///
/// After the first hit no further primitive is tested. A node is opened only if the ray enters its
/// box.
pub fn any_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> bool {
    todo!("like closest_hit_both, but stop at the first hit")
}
