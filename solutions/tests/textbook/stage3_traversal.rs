//! Stage 3, traversal: the recursive closest hit of the lecture.

use raykata::bvh::{Bvh, Contents, PrimitiveHit, Probe};
use raykata::ray::Ray;

fn closer(first: Option<PrimitiveHit>, second: Option<PrimitiveHit>) -> Option<PrimitiveHit> {
    match (first, second) {
        (None, hit) | (hit, None) => hit,
        (Some(a), Some(b)) => Some(if b.t < a.t { b } else { a }),
    }
}

fn leaf_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray, first: u32, count: u32) -> Option<PrimitiveHit> {
    let mut closest = None;
    for &primitive in bvh.primitives(first, count) {
        let hit = probe.hit(primitive, ray).map(|t| PrimitiveHit { t, primitive });
        closest = closer(closest, hit);
    }
    closest
}

pub fn closest_hit_both(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    both(bvh.root()?, bvh, probe, ray)
}

fn both(node: u32, bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    probe.enter(node, ray)?;
    match probe.open(node) {
        Contents::Leaf { first, count } => leaf_hit(bvh, probe, ray, first, count),
        Contents::Inner { left, right } => {
            let in_left = both(left, bvh, probe, ray);
            let in_right = both(right, bvh, probe, ray);
            closer(in_left, in_right)
        }
    }
}

pub fn closest_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    let root = bvh.root()?;
    let enter = probe.enter(root, ray)?;
    nearest_first(root, enter, bvh, probe, ray, None)
}

fn nearest_first(
    node: u32,
    enter: f32,
    bvh: &Bvh,
    probe: &mut impl Probe,
    ray: &Ray,
    best: Option<PrimitiveHit>,
) -> Option<PrimitiveHit> {
    // A box that begins behind the best hit cannot contain a nearer one.
    if best.is_some_and(|best| enter > best.t) {
        return best;
    }
    match probe.open(node) {
        Contents::Leaf { first, count } => closer(best, leaf_hit(bvh, probe, ray, first, count)),
        Contents::Inner { left, right } => {
            let mut children: Vec<(f32, u32)> = [left, right]
                .into_iter()
                .filter_map(|child| Some((probe.enter(child, ray)?, child)))
                .collect();
            children.sort_by(|a, b| a.0.total_cmp(&b.0));
            children
                .into_iter()
                .fold(best, |best, (enter, child)| nearest_first(child, enter, bvh, probe, ray, best))
        }
    }
}

pub fn any_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> bool {
    bvh.root().is_some_and(|root| any(root, bvh, probe, ray))
}

fn any(node: u32, bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> bool {
    if probe.enter(node, ray).is_none() {
        return false;
    }
    match probe.open(node) {
        Contents::Leaf { first, count } => {
            for &primitive in bvh.primitives(first, count) {
                if probe.hit(primitive, ray).is_some() {
                    return true;
                }
            }
            false
        }
        Contents::Inner { left, right } => any(left, bvh, probe, ray) || any(right, bvh, probe, ray),
    }
}
