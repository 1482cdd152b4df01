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

// <solution>
use glam::Vec3;
// </solution>

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
    // <solution>
    let (mut near, mut far) = (F32x8::splat(level, f32::NEG_INFINITY), F32x8::splat(level, f32::INFINITY));
    for axis in 0..3 {
        // Compute the t of the near and of the far plane of all eight boxes. `& 1` tells the
        // compiler that the index is in range.
        let (origin, inverse) =
            (F32x8::splat(level, ray.origin[axis]), F32x8::splat(level, ray.inverse_direction[axis]));
        let side = ray.near_side[axis] & 1;
        let enter = (F32x8::load(level, &node.bounds[axis][side]) - origin) * inverse;
        let leave = (F32x8::load(level, &node.bounds[axis][1 - side]) - origin) * inverse;
        // Intersect the intervals. `min` and `max` return their second operand if the first one is
        // NaN, so the interval so far is the second one.
        near = enter.max(near);
        far = leave.min(far);
    }
    // Widen the interval by the rounding errors: outwards from 0 is earlier for an entry and later
    // for an exit that counts, because t is not negative within the range.
    let near = (near * F32x8::splat(level, 1.0 - 2.0 * gamma(3))).max(F32x8::splat(level, ray.t_min));
    let far = (far * F32x8::splat(level, 1.0 + 2.0 * gamma(3))).min(F32x8::splat(level, t_max));
    // Leave out the empty places: where all three axes are ignored, their boxes are entered as
    // well.
    Entered { mask: near.le(far).bits() & node.occupied, t: near.to_array() }
    // <stub> todo!("the slab test with eight lanes: near planes, far planes, minimum, maximum, widen, compare")
    // </solution>
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
    // <solution>
    let [a, b, c] =
        [load(level, &block.corners[0]), load(level, &block.corners[1]), load(level, &block.corners[2])];
    let (origin, direction) = (splat(level, ray.origin), splat(level, ray.direction));

    // Compute the edges from corner a, the normal, and a - o.
    let (edge_b, edge_c) = (minus(b, a), minus(c, a));
    let to_a = minus(a, origin);
    let normal = cross(edge_b, edge_c);

    // Compute U, V and W, and bound their rounding errors.
    let moment = cross(to_a, direction);
    let (u, minus_v) = (dot(moment, edge_c), dot(moment, edge_b));
    let slope = dot(direction, normal);
    let w = slope - u + minus_v;
    let fastest = ray.direction.abs().max_element();
    let (size, far_away) = (F32x8::load(level, &block.size), largest(to_a));
    let tiny = F32x8::splat(level, UNDERFLOW);
    let edge_error = F32x8::splat(level, EDGE_ERROR * fastest)
        .mul_add(size, tiny)
        .mul_add(far_away + size, F32x8::splat(level, UNDERFLOW * (1.0 + fastest)));

    // Reject a triangle if two signs differ for certain. Most blocks are done here. Each comparison
    // is false for a NaN, which rejects nothing.
    let v = F32x8::splat(level, 0.0) - minus_v;
    let (least, most) = (w.min(u.min(v)), w.max(u.max(v)));
    let outside = least.lt(F32x8::splat(level, 0.0) - edge_error) & edge_error.lt(most);
    let may_be_inside = !outside.bits() & 255;
    if may_be_inside == 0 {
        return 0;
    }

    // Compute both parts of t, and bound the rounding errors at both ends of the range.
    let distance = dot(normal, to_a);
    let t_min = ray.t_min;
    let area = (F32x8::splat(level, T_ERROR) * size).mul_add(size, tiny);
    let error_at_t_min = area.mul_add(
        far_away + F32x8::splat(level, t_min * fastest),
        F32x8::splat(level, UNDERFLOW * (1.0 + t_min)),
    );
    let error_at_t_max = area.mul_add(
        far_away + F32x8::splat(level, t_max * fastest),
        F32x8::splat(level, UNDERFLOW * (1.0 + t_max)),
    );

    // Beyond t_max, with the computed sign of the slope: |slope| t = along.
    let (along, steep) = (distance * F32x8::splat(level, 1.0).copysign(slope), slope.abs());
    let beyond = error_at_t_max.lt(along - F32x8::splat(level, t_max) * steep);
    // A hit before t_min needs a slope whose sign is certain. Beyond t_max it does not, see
    // T_ERROR.
    let before = along.lt(F32x8::splat(level, t_min) * steep - error_at_t_min) & edge_error.lt(steep);
    may_be_inside & !(beyond | before).bits()
    // <stub> todo!("compute U, V and W with eight lanes, bound their errors, and reject what is certain")
    // </solution>
}

// <solution>
/// A bound on the rounding errors of U, V, W and d·n is `EDGE_ERROR · m e (h + e)`, with the
/// largest coordinates `m` of d, `e` of both edges and `h` of a - o.
///
/// With the unit roundoff u: a difference of two inputs has a relative error of u. A coordinate of
/// `(a - o) × d` is at most `2 h m` and has an error of `6 u h m` (two products of numbers with
/// errors u, and a difference). U adds three products of it with an edge: an error of
/// `3 (6 + 2 · 2) u h m e` plus `10 u h m e` for two sums, together `40 u h m e`. A coordinate of n
/// is at most `2 e²` and has an error of `8 u e²`, so d·n has an error of
/// `3 (8 + 2) u m e² + 10 u m e² = 40 u m e²`. W adds the errors of d·n, U and V and rounds twice:
/// `52 u m e² + 98 u h m e`. `128 u` leaves room for products of errors. With fused products there
/// are fewer roundings.
const EDGE_ERROR: f32 = 128.0 * UNIT_ROUNDOFF;

/// A bound on the rounding errors of `n·(a - o) - t d·n` is `T_ERROR · e² (h + t m)`, for t_min and
/// for t_max.
///
/// `n·(a - o)` has an error of `3 (8 + 2 · 2) u e² h + 10 u e² h = 46 u e² h`, and `d·n` one of
/// `40 u m e²`. The product with t and the difference round numbers of at most `6 e² h` and
/// `6 t m e²`: together at most `52 u e² (h + t m)`. The remaining `12 u` cover the rounding of the
/// hit's `t` to single precision.
///
/// So `along > t_max |slope| + error` is certain to reject. If the slope has the computed sign, the
/// exact `|slope| t` is above `t_max |slope|` as well. If rounding has changed its sign, then so
/// has the sign of the exact `t`: `along` is larger than the error of `n·(a - o)`, which is a part
/// of the bound, so that the exact `along` is positive too, and the exact `t`, which is
/// `along / |slope|` with the other sign, is negative. If the slope is exactly 0, there is no hit.
const T_ERROR: f32 = 64.0 * UNIT_ROUNDOFF;

/// Where a product underflows, it has an error of up to 2⁻¹⁵⁰ more. In U, V, W, d·n and n·(a - o)
/// at most 12 of these are multiplied by e, 6 by m, 6 by h and 9 by nothing: together at most
/// `2⁻¹⁴⁶ (1 + m + e + h)`. A larger number serves as well. This one is not subnormal: many
/// processors compute slowly with subnormal numbers, and with 2⁻¹⁴³ a search in thin triangles took
/// 1.6 times as long.
const UNDERFLOW: f32 = f32::MIN_POSITIVE; // 2⁻¹²⁶

/// Eight vectors, one per lane. Functions with a level are `#[inline(always)]`, and closures are
/// avoided, because a closure may be compiled without the instructions of the level: measured, a
/// closure in `may_hit` made searches twice as slow.
type Vector<L> = [F32x8<L>; 3];

#[inline(always)]
fn load<L: Level>(level: L, corner: &[[f32; 8]; 3]) -> Vector<L> {
    [F32x8::load(level, &corner[0]), F32x8::load(level, &corner[1]), F32x8::load(level, &corner[2])]
}

#[inline(always)]
fn splat<L: Level>(level: L, p: Vec3) -> Vector<L> {
    [F32x8::splat(level, p.x), F32x8::splat(level, p.y), F32x8::splat(level, p.z)]
}

#[inline(always)]
fn minus<L: Level>(p: Vector<L>, q: Vector<L>) -> Vector<L> {
    [p[0] - q[0], p[1] - q[1], p[2] - q[2]]
}

#[inline(always)]
fn cross<L: Level>(p: Vector<L>, q: Vector<L>) -> Vector<L> {
    [p[1].mul_sub(q[2], p[2] * q[1]), p[2].mul_sub(q[0], p[0] * q[2]), p[0].mul_sub(q[1], p[1] * q[0])]
}

#[inline(always)]
fn dot<L: Level>(p: Vector<L>, q: Vector<L>) -> F32x8<L> {
    p[0].mul_add(q[0], p[1].mul_add(q[1], p[2] * q[2]))
}

/// The largest absolute coordinate of each vector. A NaN in the first two coordinates may be lost:
/// the comparisons see it all the same, because U, V and W are NaN then.
#[inline(always)]
fn largest<L: Level>(p: Vector<L>) -> F32x8<L> {
    p[0].abs().max(p[1].abs()).max(p[2].abs())
}
// </solution>
