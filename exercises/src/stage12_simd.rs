//! Stage 12 · eight boxes at once, and eight triangles at once.
//!
//! Slides: `slides/stage12.md`. Sources: Ize, "Robust BVH Ray Traversal", JCGT 2013; Möller and
//! Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection", 1997; Higham, "Accuracy and
//! Stability of Numerical Algorithms", 2002.
//!
//! Given: [`gamma`] and [`UNIT_ROUNDOFF`]; [`F32x8`] with `+`, `-`, `*`, `min`, `max`, `abs`, `le`,
//! `lt` per lane; masks with `&`, `|` and `bits`; [`WideRay`] with `1 / direction` and the near side
//! of boxes on each axis. `ray.t_min` is 0 or more. Coordinates and directions of triangles are at
//! most [`LARGEST`](raykata::wide::LARGEST) in size, so nothing overflows.

use raykata::rounding::{UNIT_ROUNDOFF, gamma};
use raykata::wide::simd::{F32x8, Level};
use raykata::wide::{Entered, TriangleBlock, WideNode, WideRay};

/// Which of the eight boxes of a node a ray enters: the slab test `t_b = t_x ∩ t_y ∩ t_z`, eight
/// boxes at once. `ray.near_side[axis]` says which plane the ray passes first. What is `0 · ∞`, and
/// which operand of `min` and `max` survives a NaN?
///
/// Exactly:
///
/// - The `t` of a plane is `(plane - origin) · inverse_direction`; one that is NaN decides nothing.
/// - Intersect the axes, multiply the entry by `1 - 2γ₃` and the exit by `1 + 2γ₃`, and intersect
///   with the range `ray.t_min..=t_max`. A box is entered if the entry is at most the exit.
/// - The result is that of these operations in single precision, bit for bit, except for the sign
///   of 0.
/// - An empty place is never entered: `node.occupied` has a bit per child.
///
/// Source: "Ray/box intersection"; Ize, "Robust BVH Ray Traversal", JCGT 2013.
#[inline(always)]
pub fn enter_boxes<L: Level>(level: L, node: &WideNode, ray: &WideRay, t_max: f32) -> Entered {
    todo!("the slab test with eight lanes: near planes, far planes, minimum, maximum, widen, compare")
}

/// Which of eight triangles a ray may hit before `t_max`: a filter before the test of stage 10,
/// which decides. The barycentric coordinates times `d·n` are `U = ((a-o) × d)·(c-a)`,
/// `V = -((a-o) × d)·(b-a)` and `W = d·n - U - V`, with `n = (b-a) × (c-a)`. Different signs mean a
/// miss: when is a sign certain? `t` is `n·(a-o) / d·n`.
///
/// Bit `i` is 0 if triangle `i` is rejected.
///
/// Exactly:
///
/// - No triangle that the watertight test hits is rejected, for any finite input: the exact line
///   meets the closed triangle, and the exact `t`, rounded, is in `ray.t_min..t_max`.
/// - At least 99 of 100 are rejected that a ray misses by a good part of their size, or hits
///   outside of the range by a tenth.
/// - A lane with NaN is never rejected: it holds another shape.
///
/// Source: "Cramer's Rule"; Möller and Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection",
/// 1997.
#[inline(always)]
pub fn may_hit<L: Level>(level: L, block: &TriangleBlock, ray: &WideRay, t_max: f32) -> u32 {
    todo!("compute U, V and W with eight lanes, bound their errors, and reject what is certain")
}
