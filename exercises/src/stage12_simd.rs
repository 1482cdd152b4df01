//! Stage 12 · eight boxes at once, and four triangles at once.
//!
//! Slides: the box intersection with `t_b = t_x ∩ t_y ∩ t_z`; "Cramer's Rule". Sources: Ize, "Robust BVH Ray Traversal", JCGT
//! 2013; Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997; Higham, "Accuracy and Stability of
//! Numerical Algorithms", 2002.
//!
//! Given: [`gamma`] and [`UNIT_ROUNDOFF`]; [`F32x8`] and [`F32x4`] with `+`, `-`, `*`, `min`, `max`, `abs`, `le`, `lt` per lane; masks with `&`, `|` and `bits`;
//! [`WideRay`] with `1 / direction` and the near side of boxes on each axis.

use raykata::rounding::{UNIT_ROUNDOFF, gamma};
use raykata::wide::simd::{F32x4, F32x8, Level};
use raykata::wide::{Entered, TriangleBlock, WideNode, WideRay};

/// Which of the eight boxes of a node a ray enters, by the slab test of stage 3, eight boxes at once.
///
/// For a ray with the range `ray.t_min..=t_max`, `t_min >= 0`: the `t` of a plane is `(plane - origin) · inverse_direction`.
/// Intersect the intervals of the three axes, multiply the entry by `1 - 2γ₃` and the exit by `1 + 2γ₃`, and intersect with the
/// range. A box is entered if the entry is at most the exit. The result is that of these operations in single precision, bit for
/// bit (0 and -0 are the same). So no box is missed that a ray meets, and the entry is never NaN. Where a plane has the `t`
/// NaN, it decides nothing: the ray runs within a face, or the axis is ignored because `inverse_direction` is NaN. An empty
/// place is never entered: `node.occupied` has a bit per child.
///
/// `ray.near_side[axis]` says which of the two coordinates the ray passes first, so nothing is compared or swapped.
///
/// Pitfall: `0 · ∞` is NaN where a ray runs within a face. `min` and `max` return the second operand if the first one is NaN,
/// so the interval so far must be the second operand.
#[inline(always)]
pub fn enter_boxes<L: Level>(level: L, node: &WideNode, ray: &WideRay, t_max: f32) -> Entered {
    todo!("the slab test with eight lanes: near planes, far planes, minimum, maximum, widen, compare")
}

/// Which of four triangles a ray may hit before `t_max`: bit `i` of the result is 0 only if the ray certainly misses triangle
/// `i`, or certainly hits it outside of `ray.t_min..t_max`.
///
/// Frames test only the remaining triangles with the watertight test of stage 10, in double precision. So this function may
/// not reject any triangle that the watertight test hits, for any finite input: the exact line meets the closed triangle, and
/// the exact `t`, rounded, is in the range. It must reject nearly all others, because each triangle that remains costs about as
/// much as a whole block: at least 99 of 100 triangles that a ray misses by a good part of their size, or hits outside of
/// `ray.t_min..t_max` by a tenth. A lane with NaN is never rejected, because its primitive is not a triangle. Coordinates and
/// directions are at most [`LARGEST`](raykata::wide::LARGEST) in size, so nothing overflows.
///
/// The signs of three numbers decide: `U = ((a - o) × d)·(c - a)`, `V = -((a - o) × d)·(b - a)` and `W = d·n - U - V` with
/// `n = (b - a) × (c - a)`. They are the barycentric coordinates times `d·n`. If two of them have different signs, and both
/// are larger than their rounding errors, the ray misses. `t` is `n·(a - o) / d·n`.
///
/// Pitfall: rounding errors grow with the distance of the triangle and not with its size. A fixed epsilon rejects hits in one
/// scene and nothing in another. And where `d·n` is smaller than its error, its sign is unknown, and with it the sign of `t`.
#[inline(always)]
pub fn may_hit<L: Level>(level: L, block: &TriangleBlock, ray: &WideRay, t_max: f32) -> u32 {
    todo!("compute U, V and W with four lanes, bound their errors, and reject what is certain")
}
