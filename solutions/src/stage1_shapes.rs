//! Stage 1 · shapes: the `t` at which a ray hits a sphere or a plane.
//!
//! Slides: `slides/stage01.md`.
//!
//! Given: [`Ray`] with `origin`, `direction` and `ray.contains(t)`. A hit at `t` counts if
//! `ray.contains(t)` is true, which means `t_min < t < t_max`. Both ends are open, and NaN never
//! counts.
//!
//! Asked: the `t` of the nearest hit that counts, or `None`. `t` counts lengths of `direction`,
//! which need not be a unit vector. Start with [`nearest_root`], because both sphere functions end
//! with it.

use glam::Vec3;
use raykata::ray::Ray;

// <solution>
use glam::DVec3;
// </solution>

/// A line meets a sphere at two values of `t`, and a ray sees the smaller one in its range. Which
/// one is that if it starts inside? And is 2 smaller than NaN?
///
/// Returns the smaller one of the roots that count, or `None` if neither does.
///
/// Exactly:
///
/// 1. The roots come in any order.
/// 2. A root that is NaN or infinite does not count, but the other root still may.
pub fn nearest_root(roots: [f32; 2], ray: &Ray) -> Option<f32> {
    // <solution>
    let [first, second] = roots;
    // Sort the roots. If one of them is NaN, min and max both return the other.
    let (near, far) = (first.min(second), first.max(second));
    // Return the first root that lies in the ray's range. It is the far one for a ray that starts
    // inside.
    [near, far].into_iter().find(|&t| ray.contains(t))
    // <stub> todo!("return the smaller of the two roots for which ray.contains(t) is true")
    // </solution>
}

/// A point `o + t d` of the ray lies on the sphere where `|o + t d - center|² = r²`. That is a
/// quadratic:
///
/// ```text
/// a t² + b t + c = 0
/// a = d·d,  b = 2 (o - center)·d,  c = |o - center|² - r²
/// ```
///
/// A line meets a sphere in two points: which one does the ray see? What is left of `b² - 4 a c`
/// when the sphere is far away?
///
/// Returns the nearest root that counts.
///
/// Exactly:
///
/// 1. A tangent ray (discriminant exactly 0) hits.
/// 2. A root `t = 0`, of a ray that starts on the sphere, does not count.
/// 3. Hits of near, distant and tiny spheres (sizes 1e-6 to 1e6) are right up to a few roundings of
///    the input.
#[inline]
pub fn sphere_algebraic(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    // <solution>
    // Compute the squares in double precision: in single precision they overflow above 1e19 and
    // underflow below 1e-19.
    let (f, d, r) = ((ray.origin - center).as_dvec3(), ray.direction.as_dvec3(), f64::from(radius));
    // Compute the coefficients of the quadratic a t² - 2 b t + c = 0.
    let a = d.length_squared();
    let b = -f.dot(d);
    let c = f.length_squared() - r * r;

    // Compute the discriminant without cancellation: b² - a c = a h², where f⊥ is the part of f at
    // right angles to the ray, and h² = r² - |f⊥|² is the squared half chord.
    let f_perpendicular = f + (b / a) * d;
    let half_chord_squared = r * r - f_perpendicular.length_squared();
    // Reject rays that pass beside the sphere. NaN makes the comparison false, so it is rejected as
    // well.
    if !(half_chord_squared >= 0.0 && r > 0.0) {
        return None;
    }

    // Compute one root as a sum of two numbers of the same sign, which does not cancel. The product
    // of both roots is c / a, which gives the other root.
    let q = b + (a * half_chord_squared).sqrt().copysign(b);
    // Return the nearest root in the ray's range.
    nearest_root([c / q, q / a].map(|t| t as f32), ray)
    // <stub> todo!("solve the quadratic for t and return the nearest root that counts")
    // </solution>
}

/// `t_ca` leads to the ray's point nearest to the centre. From there, half of the chord, `t_hc`,
/// leads to the surface on both sides:
///
/// ```text
/// o ------ t_ca ------>+-- t_hc -->
///                      | d
///                    center
/// ```
///
/// The roots are `t_ca - t_hc` and `t_ca + t_hc`. Pythagoras gives `t_hc` from r and d. If
/// `t_ca < 0`, is the sphere always missed?
///
/// The contract is that of [`sphere_algebraic`].
pub fn sphere_geometric(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    // <solution>
    // Compute the squares in double precision, in which they neither overflow nor underflow.
    let (to_center, d, r) = ((center - ray.origin).as_dvec3(), ray.direction.as_dvec3(), f64::from(radius));
    let length_squared = d.length_squared();

    // Find the ray's point nearest to the centre, and the vector from there to the centre. A
    // negative t_ca is no miss: a ray that starts inside and points away from the centre hits the
    // far side.
    let t_ca = to_center.dot(d) / length_squared;
    let nearest = to_center - t_ca * d;
    // Compute the squared half chord by Pythagoras. The slide's d² = L·L - t_ca² cancels for a
    // distant sphere; the length of a vector does not. Reject rays that pass beside the sphere, and
    // NaN.
    let half_chord_squared = r * r - nearest.length_squared();
    if !(half_chord_squared >= 0.0 && r > 0.0) {
        return None;
    }
    // Convert half of the chord to lengths of the direction.
    let t_hc = (half_chord_squared / length_squared).sqrt();

    // Compute the root farther from t = 0 as a sum of two numbers of the same sign. The other
    // difference would cancel for an origin near the surface, so divide the product of both roots,
    // (|L|² - r²) / |d|² (the power of a point).
    let away = t_ca + t_hc.copysign(t_ca);
    let power = (to_center.length_squared() - r * r) / length_squared;
    // Return the nearest root in the ray's range.
    nearest_root([power / away, away].map(|t| t as f32), ray)
    // <stub> todo!("find t_ca and t_hc, and return the nearest of t_ca - t_hc and t_ca + t_hc that counts")
    // </solution>
}

/// The unit normal of a sphere points from its centre to the point of the surface:
/// `n = (p - c) / |p - c|`.
///
/// `point` lies on the sphere up to rounding. The result has length 1 up to rounding.
pub fn sphere_normal(center: Vec3, point: Vec3) -> Vec3 {
    // <solution>
    // Divide by the length and not by r: this keeps the normal at length 1 when `point` has a
    // rounding error.
    (point - center).as_dvec3().normalize_or(DVec3::Z).as_vec3()
    // <stub> todo!("return the unit vector from the centre to the point")
    // </solution>
}

/// A point p lies in the plane if `n·(p - p₀) = 0`, where p₀ is `point`. Put `o + t d` for p and
/// solve for `t`. What if the ray runs along the plane? How large are `n·o` and `n·p₀` far from the
/// origin?
///
/// Returns `t` if it counts.
///
/// Exactly:
///
/// 1. The plane is infinite and is hit from both sides. `normal` need not be a unit vector.
/// 2. `None` for a ray parallel to the plane (`n·d = 0` exactly) or starting in it, and a normal of 0.
/// 3. `t` keeps its digits far from the origin.
pub fn plane(ray: &Ray, point: Vec3, normal: Vec3) -> Option<f32> {
    // <solution>
    // Subtract the points first. The form -(D + n·o) / n·d is equal on paper, but far from the
    // origin it subtracts two large numbers and loses their last digits.
    let t = (point - ray.origin).dot(normal) / ray.direction.dot(normal);
    // Reject NaN (from 0/0) and infinity (from 1/0) together with all other t out of range.
    ray.contains(t).then_some(t)
    // <stub> todo!("solve n·(o + t d - p0) = 0 for t and return it if ray.contains(t)")
    // </solution>
}

/// Put `o + t v`, with the ray's direction v, into the plane `A x + B y + C z + D = 0`: with n =
/// (A, B, C), `t = (-D - n·o) / (n·v)`. How many digits are left where D and `n·o` are large?
///
/// `normal` is n, and `d` is D. Returns `t` if it counts.
///
/// Exactly:
///
/// 1. What [`plane`] demands.
/// 2. All four coefficients times the same factor (1e-12 to 1e12, or negative) give the same `t`.
/// 3. `t` is right up to a few roundings for the plane that the coefficients give, also far from
///    the origin.
///
/// Source: "Ray-plane intersection".
pub fn plane_by_coefficients(ray: &Ray, normal: Vec3, d: f32) -> Option<f32> {
    // <solution>
    // Add D and n·o in double precision, because they may cancel. There the product of two `f32` is
    // exact.
    let (n, o, v) = (normal.as_dvec3(), ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let t = ((-f64::from(d) - n.dot(o)) / n.dot(v)) as f32;
    // Reject NaN (from 0/0) and infinity (from 1/0) together with all other t out of range.
    ray.contains(t).then_some(t)
    // <stub> todo!("solve n·(o + t v) + D = 0 for t and return it if ray.contains(t)")
    // </solution>
}

/// A ray with `n·d > 0` goes to the side to which the normal points, so it comes from behind.
///
/// Returns `normal` or `-normal`: the one with `n·d ≤ 0`, either if `n·d` is 0. Neither vector need
/// be a unit vector, and the length of the normal does not change.
pub fn face_forward(normal: Vec3, direction: Vec3) -> Vec3 {
    // <solution>
    if normal.dot(direction) > 0.0 { -normal } else { normal }
    // <stub> todo!("negate the normal if n·d > 0")
    // </solution>
}
