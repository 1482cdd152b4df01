//! Stage 12 · searching a tree with eight children per node: nearest child first, without recursion.
//!
//! Slides: "Sort Bounding Volume Intersections". Source: Wald, Benthin and Boulos, "Getting Rid of Packets", 2008.
//!
//! Given: [`WideProbe`] with `enter` (which children of a node the ray enters, and where), `children`, `candidates` (which
//! lanes of a block may be hit) and `hit` (the exact test of one lane); [`Child`] and its keys, which sort by distance;
//! [`Stack`].

use raykata::bvh::PrimitiveHit;
use raykata::ray::Ray;
use raykata::wide::{BLOCK, Child, ChildContents, Stack, WideProbe};

/// The closest hit in a wide tree with at least one node, or `None`: the same hit as that of stage 3, also for two hits at the
/// same `t`, of which the smaller primitive number wins.
///
/// Start at [`Child::ROOT`]. Of the children that the ray enters, visit the nearest first, and keep the others on a stack, the
/// nearest on top. A child that is entered beyond the best `t` so far is skipped when it comes from the stack; one that is entered
/// exactly there may hold a hit with a smaller number. `t_max` in the calls of the probe is the end of the shortened ray,
/// one float above the best `t`, as in stage 3. A leaf has `⌈count / BLOCK⌉` blocks, and only its primitives are asked for.
///
/// No node is visited twice, and none that the ray does not enter. The calls of the probe are counted; all points need at most
/// 1.05 times as many as the reference makes.
///
/// In most nodes the ray enters one or two children. Treat these cases first: one child needs no stack, and two need one
/// comparison.
///
/// Pitfall: a child that was nearest when its node was opened need not be nearest now.
#[inline(always)]
pub fn wide_closest_hit<P: WideProbe>(probe: &mut P, ray: &Ray) -> Option<PrimitiveHit> {
    todo!("visit the nearest child, push the others in order, and skip what lies beyond the best hit")
}

/// Whether any primitive of a wide tree with at least one node is hit within the range of the ray (shadow rays).
///
/// The search ends at the first hit: it makes no further call. The order of the children is free, so nothing is sorted. No node is
/// visited twice, and none that the ray does not enter.
#[inline(always)]
pub fn wide_any_hit<P: WideProbe>(probe: &mut P, ray: &Ray) -> bool {
    todo!("push all children that the ray enters, and stop at the first hit")
}
