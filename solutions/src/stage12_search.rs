//! Stage 12 · searching a tree with eight children per node: nearest child first, without
//! recursion.
//!
//! Slides: `slides/stage12.md`. Source: Wald, Benthin and Boulos, "Getting Rid of Packets", 2008.
//!
//! Given: [`WideProbe`] with `enter` (which children of a node the ray enters, and where),
//! `children`, `candidates` (which lanes of a block may be hit) and `hit` (the exact test of one
//! lane); [`Child`] and its keys, which sort by distance; [`Stack`]. A wide tree has at least one
//! node, and a leaf has `⌈count / BLOCK⌉` blocks.

use raykata::bvh::PrimitiveHit;
use raykata::ray::Ray;
use raykata::wide::{BLOCK, Child, ChildContents, Stack, WideProbe};

// <solution>
use crate::stage3_traversal::keep_closest;
// </solution>

/// The closest hit in a wide tree. From [`Child::ROOT`] on, the nearest child is visited first, and
/// the others wait on a stack, in any order. Is a child still needed when it comes from the stack?
///
/// `t_max` in calls of the probe is the end of the shortened ray, one float above the best `t`.
///
/// Exactly:
///
/// 1. Of hits at the same `t` the smaller primitive number wins, also in a child entered there.
/// 2. A child entered beyond the best `t` is skipped.
/// 3. Only primitives of the leaf are asked for.
/// 4. No node is visited twice, and none that the ray does not enter.
/// 5. Full points need at most 1.05 times the reference's calls of the probe.
#[inline(always)]
pub fn wide_closest_hit<P: WideProbe>(probe: &mut P, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    let mut ray = *ray;
    let mut closest = None;
    let mut stack = Stack::new();
    stack.push(Child::ROOT.key(ray.t_min + 0.0));
    while let Some(key) = stack.pop() {
        // Skip a place beyond the best hit.
        let (mut child, t) = Child::of_key(key);
        if !(t < ray.t_max) {
            continue;
        }
        // Go down to a leaf, always to the nearest child.
        let leaf = loop {
            match child.contents() {
                ChildContents::Leaf { block, count } => break Some((block, count)),
                ChildContents::Inner(node) => match nearest_child(probe, node, ray.t_max, &mut stack) {
                    Some(nearest) => child = nearest,
                    None => break None,
                },
            }
        };
        // Test its blocks. Each hit shortens the ray.
        let Some((first, count)) = leaf else { continue };
        for (block, n) in blocks(first, count) {
            let mut lanes = probe.candidates(block, n, ray.t_max);
            while lanes != 0 {
                if let Some(hit) = probe.hit(block, lanes.trailing_zeros(), &ray) {
                    keep_closest(&mut closest, &mut ray, hit);
                }
                lanes &= lanes - 1;
            }
        }
    }
    closest
    // <stub> todo!("visit the nearest child, push the others, and skip what lies beyond the best hit")
    // </solution>
}

// <solution>
/// The nearest child of `node` that the ray enters, or `None`. The others are pushed: to sort them
/// takes longer than the visits that it saves.
#[inline(always)]
fn nearest_child(probe: &mut impl WideProbe, node: u32, t_max: f32, stack: &mut Stack) -> Option<Child> {
    let entered = probe.enter(node, t_max);
    let children = probe.children(node);
    let mut mask = entered.mask;
    if mask == 0 {
        return None;
    }
    let i = mask.trailing_zeros() as usize & 7;
    mask &= mask - 1;
    // Do not wait for the distance of an only child.
    if mask == 0 {
        return Some(children[i]);
    }
    let mut nearest = children[i].key(entered.t[i]);
    while mask != 0 {
        let i = mask.trailing_zeros() as usize & 7;
        mask &= mask - 1;
        // Keep the smaller key, and push the larger one.
        let key = children[i].key(entered.t[i]);
        stack.push(nearest.max(key));
        nearest = nearest.min(key);
    }
    Some(Child::of_key(nearest).0)
}

/// The blocks of a leaf, each with the number of its primitives.
#[inline(always)]
fn blocks(first: u32, count: u32) -> impl Iterator<Item = (u32, u32)> {
    let n_blocks = count.div_ceil(BLOCK as u32);
    (0..n_blocks).map(move |i| (first + i, (count - i * BLOCK as u32).min(BLOCK as u32)))
}
// </solution>

/// Whether any primitive of a wide tree is hit within the range of the ray (shadow rays). The order
/// of the children is free.
///
/// The search makes no further call after the first hit. No node is visited twice, and none that
/// the ray does not enter.
#[inline(always)]
pub fn wide_any_hit<P: WideProbe>(probe: &mut P, ray: &Ray) -> bool {
    // <solution>
    let mut stack = Stack::new();
    let mut next = Some(Child::ROOT);
    while let Some(ChildContents::Inner(node)) = next.map(Child::contents) {
        next = None;
        let mut mask = probe.enter(node, ray.t_max).mask;
        while mask != 0 {
            let child = probe.children(node)[mask.trailing_zeros() as usize & 7];
            mask &= mask - 1;
            match child.contents() {
                // Visit the first inner child next. The others wait.
                ChildContents::Inner(_) if next.is_none() => next = Some(child),
                ChildContents::Inner(_) => stack.push(child.key(0.0)),
                // Test a leaf at once, and stop at the first hit.
                ChildContents::Leaf { block, count } => {
                    for (block, n) in blocks(block, count) {
                        let mut lanes = probe.candidates(block, n, ray.t_max);
                        while lanes != 0 {
                            if probe.hit(block, lanes.trailing_zeros(), ray).is_some() {
                                return true;
                            }
                            lanes &= lanes - 1;
                        }
                    }
                }
            }
        }
        if next.is_none() {
            next = stack.pop().map(|key| Child::of_key(key).0);
        }
    }
    false
    // <stub> todo!("push inner children that the ray enters, test leaves, and stop at the first hit")
    // </solution>
}
