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
    // <solution>
    let root = bvh.root()?;
    closest_below(root, bvh, probe, ray)
    // <stub> todo!("ask both children of every box that the ray enters, and keep the nearer hit")
    // </solution>
}

// <solution>
/// The closest hit below `node`.
fn closest_below(node: u32, bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    // Return if the ray misses the box.
    probe.enter(node, ray)?;
    // Search both children of an inner node, or ask all primitives of a leaf. Keep the nearest hit.
    match probe.open(node) {
        Contents::Inner { left, right } => {
            let in_left = closest_below(left, bvh, probe, ray);
            let in_right = closest_below(right, bvh, probe, ray);
            nearer(in_left, in_right)
        }
        Contents::Leaf { first, count } => bvh
            .primitives(first, count)
            .iter()
            .filter_map(|&primitive| probe.hit(primitive, ray).map(|t| PrimitiveHit { t, primitive }))
            .fold(None, |closest, hit| nearer(closest, Some(hit))),
    }
}

/// The hit with the smaller `t`; at the same `t` the one with the smaller primitive number, so that
/// the result does not depend on the order of the tests.
#[inline]
pub fn nearer(first: Option<PrimitiveHit>, second: Option<PrimitiveHit>) -> Option<PrimitiveHit> {
    match (first, second) {
        (Some(p), Some(q)) => Some(if (q.t, q.primitive) < (p.t, p.primitive) { q } else { p }),
        (one, other) => one.or(other),
    }
}

/// Keeps the nearer one of the closest hit so far and `hit`, and shortens the ray to it.
///
/// The range of a ray is open. So the ray ends one float above `t`, and a primitive at exactly the
/// same `t` is still reported.
#[inline]
pub fn keep_closest(closest: &mut Option<PrimitiveHit>, ray: &mut Ray, hit: PrimitiveHit) {
    *closest = nearer(*closest, Some(hit));
    ray.t_max = hit.t.next_up().min(ray.t_max);
}
// </solution>

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
    // <solution>
    // Enter the root, and search below it with a copy of the ray whose range shrinks.
    let root = bvh.root()?;
    let mut ray = *ray;
    let mut closest = None;
    probe.enter(root, &ray)?;
    search(root, bvh, probe, &mut ray, &mut closest);
    closest
    // <stub> todo!("enter the nearer child first, and skip boxes beyond the best hit")
    // </solution>
}

// <solution>
/// Searches below `node`, whose box the ray enters. Each hit lowers `ray.t_max`.
fn search(node: u32, bvh: &Bvh, probe: &mut impl Probe, ray: &mut Ray, closest: &mut Option<PrimitiveHit>) {
    match probe.open(node) {
        Contents::Leaf { first, count } => {
            // Ask all primitives of the leaf.
            for &primitive in bvh.primitives(first, count) {
                let Some(t) = probe.hit(primitive, ray) else { continue };
                keep_closest(closest, ray, PrimitiveHit { t, primitive });
            }
        }
        Contents::Inner { left, right } => match (probe.enter(left, ray), probe.enter(right, ray)) {
            (Some(enter_left), Some(enter_right)) => {
                // Search the nearer child. Then search the farther one unless its box begins beyond
                // the best hit.
                let (near, far, enter_far) = if enter_left <= enter_right {
                    (left, right, enter_right)
                } else {
                    (right, left, enter_left)
                };
                search(near, bvh, probe, ray, closest);
                if enter_far < ray.t_max {
                    search(far, bvh, probe, ray, closest);
                }
            }
            (Some(_), None) => search(left, bvh, probe, ray, closest),
            (None, Some(_)) => search(right, bvh, probe, ray, closest),
            (None, None) => {}
        },
    }
}
// </solution>

/// Whether any primitive is hit within the ray's range: a shadow ray needs to know no more. Is a
/// box that it enters a hit?
///
/// After the first hit no further primitive is tested. A node is opened only if the ray enters its
/// box.
pub fn any_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> bool {
    // <solution>
    bvh.root().is_some_and(|root| any_below(root, bvh, probe, ray))
    // <stub> todo!("like closest_hit_both, but stop at the first hit")
    // </solution>
}

// <solution>
/// Whether any primitive below `node` is hit.
fn any_below(node: u32, bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> bool {
    // Return if the ray misses the box.
    if probe.enter(node, ray).is_none() {
        return false;
    }
    // Stop at the first hit: `||` and `any` do not evaluate the rest.
    match probe.open(node) {
        Contents::Inner { left, right } => {
            any_below(left, bvh, probe, ray) || any_below(right, bvh, probe, ray)
        }
        Contents::Leaf { first, count } => {
            bvh.primitives(first, count).iter().any(|&primitive| probe.hit(primitive, ray).is_some())
        }
    }
}
// </solution>
