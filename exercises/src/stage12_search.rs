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
    todo!("visit the nearest child, push the others, and skip what lies beyond the best hit")
}

/// Whether any primitive of a wide tree is hit within the range of the ray (shadow rays). The order
/// of the children is free.
///
/// The search makes no further call after the first hit. No node is visited twice, and none that
/// the ray does not enter.
#[inline(always)]
pub fn wide_any_hit<P: WideProbe>(probe: &mut P, ray: &Ray) -> bool {
    todo!("push inner children that the ray enters, test leaves, and stop at the first hit")
}
