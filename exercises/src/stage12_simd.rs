//! Stage 12 · eight boxes at once, and eight triangles at once.
//!
//! Slides: `slides/stage12.md`. Sources: Ize, "Robust BVH Ray Traversal", JCGT 2013; Woop, Benthin
//! and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013; Higham, "Accuracy and Stability of
//! Numerical Algorithms", 2002.
//!
//! Given: [`UNIT_ROUNDOFF`]; [`F32x8`] with `+`, `-`, `*`, `min`, `max`, `abs`, `le`, `lt` per lane;
//! masks with `&`, `|` and `bits`; [`WideRay`] with the factors of planes, the near side of boxes and
//! the shear. `ray.t_min` is 0 or more. Coordinates and directions of triangles are at most
//! [`LARGEST`](raykata::wide::LARGEST) in size, so nothing overflows.

use raykata::rounding::UNIT_ROUNDOFF;
use raykata::wide::simd::{F32x8, Level};
use raykata::wide::{Entered, Filtered, TriangleBlock, WideNode, WideRay};

/// Which of the eight boxes of a node a ray enters: the slab test `t_b = t_x ∩ t_y ∩ t_z`, eight
/// boxes at once. `ray.near_side[axis]` says which plane the ray passes first. Why do near and far
/// planes have factors of their own?
///
/// Exactly:
///
/// 1. The `t` of a plane is `plane · scale + offset`, with one or two roundings: with `scale[0]`
///    and `offset[0]` for near planes, `scale[1]` and `offset[1]` for far ones.
/// 2. Intersect the axes with the range `ray.t_min..=t_max`. A box is entered if the entry is at
///    most the exit, so an empty place never is.
///
/// Source: "Ray/box intersection"; Ize, "Robust BVH Ray Traversal", JCGT 2013.
#[inline(always)]
pub fn enter_boxes<L: Level>(level: L, node: &WideNode, ray: &WideRay, t_max: f32) -> Entered {
    todo!("the slab test with eight lanes: near planes, far planes, minimum, maximum, compare")
}

/// Which of eight triangles a ray may hit before `t_max`: a filter before the test of stage 10. Shear
/// a' = a-o, e = b-a and f = c-a to `(x + shear[0] z, y + shear[1] z, z)`. With their cross products
/// in x and y, `N = e×f`, `U = f×a'`, `V = a'×e` and `W = N-U-V`, different signs of U, V and W mean
/// a miss: when is a sign certain? `t` is `(N a'_z + U e_z + V f_z) / (N d_z)`.
///
/// Exactly:
///
/// 1. `possible` has the bit of each triangle that the exact line meets at a `t`, rounded, in
///    `ray.t_min..t_max`, for any finite input.
/// 2. At least 99 of 100 are left out that a ray misses by a good part of their size, or hits a
///    tenth outside of the range.
/// 3. A lane with NaN, another shape, is possible.
/// 4. `certain` has the bits where U, V, W and N have the same sign for certain: most of those hit.
///
/// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013.
#[inline(always)]
pub fn may_hit<L: Level>(level: L, block: &TriangleBlock, ray: &WideRay, t_max: f32) -> Filtered {
    todo!("compute U, V, W and N with eight lanes, bound their errors, and reject what is certain")
}
