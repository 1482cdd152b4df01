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
    // <solution>
    let (mut near, mut far) = (F32x8::splat(level, ray.t_min), F32x8::splat(level, t_max));
    for axis in 0..3 {
        // Compute the t of the near and of the far plane of all eight boxes. `& 1` tells the
        // compiler that the index is in range.
        let side = ray.near_side[axis] & 1;
        let enter = F32x8::load(level, &node.bounds[axis][side])
            .mul_add(F32x8::splat(level, ray.scale[0][axis]), F32x8::splat(level, ray.offset[0][axis]));
        let leave = F32x8::load(level, &node.bounds[axis][1 - side])
            .mul_add(F32x8::splat(level, ray.scale[1][axis]), F32x8::splat(level, ray.offset[1][axis]));
        // Intersect the intervals.
        near = near.max(enter);
        far = far.min(leave);
    }
    Entered { mask: near.le(far).bits(), t: near.to_array() }
    // <stub> todo!("the slab test with eight lanes: near planes, far planes, minimum, maximum, compare")
    // </solution>
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
    // <solution>
    // Load the corners with the axes in the order of the ray. Compute a - o and both edges.
    let [a, b, c] = [
        load(level, &block.corners[0], ray),
        load(level, &block.corners[1], ray),
        load(level, &block.corners[2], ray),
    ];
    let (to_a, edge_b, edge_c) = (minus(a, splat(level, ray.origin)), minus(b, a), minus(c, a));
    let (far_away, size) = (largest(to_a), F32x8::load(level, &block.size));

    // Shear them, so that the ray becomes the z axis. Compute N, U, V and W.
    let (p, e, f) = (sheared(level, to_a, ray), sheared(level, edge_b, ray), sheared(level, edge_c, ray));
    let (u, v, n) = (cross(f, p), cross(p, e), cross(e, f));
    let w = n - u - v;

    // Reject a triangle if two signs differ for certain. Most blocks are done here. Each comparison
    // is false for a NaN, which rejects nothing.
    let (zero, tiny) = (F32x8::splat(level, 0.0), F32x8::splat(level, UNDERFLOW));
    let reach = far_away + size;
    let edge_error = size.mul_add(F32x8::splat(level, EDGE_ERROR), tiny).mul_add(reach, tiny);
    let (least, most) = (w.min(u.min(v)), w.max(u.max(v)));
    let outside = least.lt(zero - edge_error) & edge_error.lt(most);
    let may_be_inside = !outside.bits() & 255;
    if may_be_inside == 0 {
        return Filtered { possible: 0, certain: 0 };
    }

    // Compute N t and |N|, and bound the rounding errors.
    let along = n.mul_add(p[2], u.mul_add(e[2], v * f[2])) * F32x8::splat(level, ray.per_z);
    let (along, steep) = (along * F32x8::splat(level, 1.0).copysign(n), n.abs());
    let t_per_length = ray.per_z.abs();
    let area = (F32x8::splat(level, T_ERROR) * size).mul_add(size, tiny);
    let t_error = area.mul_add(
        reach * F32x8::splat(level, t_per_length),
        F32x8::splat(level, UNDERFLOW * (1.0 + t_per_length)),
    );
    let [t_min, t_max] = [F32x8::splat(level, ray.t_min), F32x8::splat(level, t_max)];

    // A hit before t_min needs an N whose sign is certain. Beyond t_max it does not, see T_ERROR.
    let beyond = t_error.lt(along - t_max * steep);
    let has_sign = edge_error.lt(steep);
    let before = along.lt(t_min * steep - t_error) & has_sign;
    let inside = (edge_error.lt(least) | most.lt(zero - edge_error)) & has_sign;
    Filtered { possible: may_be_inside & !(beyond | before).bits(), certain: inside.bits() }
    // <stub> todo!("compute U, V, W and N with eight lanes, bound their errors, and reject what is certain")
    // </solution>
}

// <solution>
/// A bound on the rounding errors of U, V, W and N is `EDGE_ERROR · e (h + e)`, with the largest
/// coordinates `e` of both edges and `h` of a - o.
///
/// With the unit roundoff u: a difference of two inputs has a relative error of u, and the shear,
/// which is at most 1, one of 2 u. A sheared coordinate of a - o is at most `2 h` and has an error
/// of `7 u h` (the two parts, the shear, the product and the sum), one of an edge is at most `2 e`
/// and has `7 u e`. U is the difference of two products of at most `4 e h`, each with an error of
/// `28 u e h` and `4 u e h` for itself: `72 u e h` with the last rounding, and so for V. N has
/// `72 u e²`. W adds these errors and rounds twice: `88 u e² + 168 u e h`. `192 u` leaves room for
/// products of errors. With fused products there are fewer roundings.
const EDGE_ERROR: f32 = 192.0 * UNIT_ROUNDOFF;

/// A bound on the rounding errors of `N t - t_end N` is `T_ERROR · e² (h + e) / |d_z|`, for both ends
/// of the range and a hit between them.
///
/// Each of the three products of `N t` has an error of `72 u e² h` from N, U or V and `16 u e² h` of
/// its own, and is at most `8 e² h`. Their sum has `304 u e² h`, and `352 u e² h / |d_z|` after the
/// product with `1 / d_z`. A hit has `t ≤ (h + e) / |d_z|`, because its z lies between those of the
/// corners. So the error of N, `72 u e²`, adds `72 u e² t` at most: beyond `t_max > t` a computed
/// `t_max |N|` that is too small is too small by no more, because it is not negative. The rest of
/// `512 u` covers the last roundings and that of the hit's `t` to single precision.
///
/// So `along > t_max |N| + error` is certain to reject if N has the computed sign. If rounding has
/// changed its sign, `along` is at most the error. If N is exactly 0, there is no hit.
const T_ERROR: f32 = 512.0 * UNIT_ROUNDOFF;

/// Where a product underflows, it has an error of up to 2⁻¹⁵⁰ more, at most 12 times, and most of
/// these are multiplied by e, h, `1 / |d_z|` or t: this number times their sum is more than enough.
/// It is not subnormal: many processors compute slowly with subnormal numbers, and with 2⁻¹⁴³
/// a search in thin triangles took 1.6 times as long.
const UNDERFLOW: f32 = f32::MIN_POSITIVE; // 2⁻¹²⁶

/// Eight vectors, one per lane. Functions with a level are `#[inline(always)]`, and closures are
/// avoided, because a closure may be compiled without the instructions of the level: measured, a
/// closure in `may_hit` made searches three times as slow.
type Vector<L> = [F32x8<L>; 3];

/// A corner of eight triangles, with the axes in the order of the ray. The minimum tells the compiler
/// that the index is in range.
#[inline(always)]
fn load<L: Level>(level: L, corner: &[[f32; 8]; 3], ray: &WideRay) -> Vector<L> {
    let [x, y, z] = ray.axes;
    [
        F32x8::load(level, &corner[x.min(2)]),
        F32x8::load(level, &corner[y.min(2)]),
        F32x8::load(level, &corner[z.min(2)]),
    ]
}

#[inline(always)]
fn splat<L: Level>(level: L, p: [f32; 3]) -> Vector<L> {
    [F32x8::splat(level, p[0]), F32x8::splat(level, p[1]), F32x8::splat(level, p[2])]
}

#[inline(always)]
fn minus<L: Level>(p: Vector<L>, q: Vector<L>) -> Vector<L> {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

#[inline(always)]
fn sheared<L: Level>(level: L, p: Vector<L>, ray: &WideRay) -> Vector<L> {
    let [x, y] = [F32x8::splat(level, ray.shear[0]), F32x8::splat(level, ray.shear[1])];
    [p[2].mul_add(x, p[0]), p[2].mul_add(y, p[1]), p[2]]
}

/// `p × q` of the first two coordinates.
#[inline(always)]
fn cross<L: Level>(p: Vector<L>, q: Vector<L>) -> F32x8<L> {
    p[0].mul_sub(q[1], p[1] * q[0])
}

/// The largest absolute coordinate of each vector. A NaN in the first two coordinates may be lost:
/// the comparisons see it all the same, because U, V and W are NaN then.
#[inline(always)]
fn largest<L: Level>(p: Vector<L>) -> F32x8<L> {
    p[0].abs().max(p[1].abs()).max(p[2].abs())
}
// </solution>
