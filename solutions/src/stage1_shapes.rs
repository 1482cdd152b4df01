//! Stage 1 · shapes: the `t` at which a ray hits a sphere or a plane.
//!
//! Slides: "Ray-Sphere Intersection" I and II, "Ray-plane intersection", "Negate Normal Vector".
//!
//! Given: [`Ray`] with `origin`, `direction` and `ray.contains(t)`. A hit at `t` counts if `ray.contains(t)` is true,
//! which means `t_min < t < t_max`. Both ends are open, and NaN never counts.
//! Asked: the `t` of the nearest hit that counts, or `None`. `t` counts lengths of `direction`, which need not be a
//! unit vector. Start with [`nearest_root`], because both sphere functions end with it.

use glam::Vec3;
use raykata::ray::Ray;

// <solution>
use glam::DVec3;
// </solution>

/// The smaller one of the roots that count (`ray.contains(t)` is true), or `None` if neither of them counts.
///
/// The roots come in any order. Each of them may be NaN or infinite. A root that is NaN does not count, but the other
/// root still may.
///
/// Pitfall: a ray that starts inside a sphere has one root behind its origin, so the smaller root may not be the hit.
pub fn nearest_root(roots: [f32; 2], ray: &Ray) -> Option<f32> {
    // <solution>
    let [first, second] = roots;
    // Sort the roots. If one of them is NaN, min and max both return the other.
    let (near, far) = (first.min(second), first.max(second));
    // Return the first root that lies in the ray's range.
    [near, far].into_iter().find(|&t| ray.contains(t))
    // <stub> todo!("return the smaller of the two roots for which ray.contains(t) is true")
    // </solution>
}

/// Ray-sphere intersection by algebra: put `o + t d` into `|p - center|² = r²` and solve `a t² - 2 b t + c = 0` with
/// `a = d·d`, `b = -(o - center)·d` and `c = |o - center|² - r²`.
///
/// Returns the nearest root that counts, in lengths of `direction`, which need not be a unit vector. A tangent ray
/// (discriminant exactly 0) hits. A ray that starts on the sphere has a root `t = 0`, which does not count. The
/// result is `None` for a radius of 0, a negative radius, a direction of 0, an infinite origin, and a NaN anywhere.
///
/// Pitfall: `b² - a c` subtracts two huge numbers when the sphere is distant or small. At distance 100,000 from a
/// unit sphere it loses 24 of 100 true hits. The checks accept an error of a few roundings, also for near spheres. So
/// use the equal form `a (r² - |f⊥|²)` with `f = o - center` and `f⊥ = f + (b / a) d`, which does not cancel.
///
/// Sizes are between 1e-6 and 1e6 in the checks. Where they are below 1e-9 or above 1e9, products of four lengths do not
/// fit single precision: the reference computes them in double precision.
#[inline]
pub fn sphere_algebraic(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    // <solution>
    // Compute the squares in double precision: in single precision they overflow above 1e19 and underflow below 1e-19.
    let (f, d, r) = ((ray.origin - center).as_dvec3(), ray.direction.as_dvec3(), f64::from(radius));
    // Compute the coefficients of the quadratic a t² - 2 b t + c = 0.
    let a = d.length_squared();
    let b = -f.dot(d);
    let c = f.length_squared() - r * r;

    // Compute the discriminant without cancellation: b² - a c = a h², where f⊥ is the part of f at right angles to the
    // ray, and h² = r² - |f⊥|² is the squared half chord.
    let f_perpendicular = f + (b / a) * d;
    let half_chord_squared = r * r - f_perpendicular.length_squared();
    // Reject rays that pass beside the sphere. NaN makes the comparison false, so it is rejected as well.
    if !(half_chord_squared >= 0.0 && r > 0.0) {
        return None;
    }

    // Compute one root as a sum of two numbers of the same sign, which does not cancel. The product of both roots is
    // c / a, which gives the other root.
    let q = b + (a * half_chord_squared).sqrt().copysign(b);
    // Return the nearest root in the ray's range.
    nearest_root([c / q, q / a].map(|t| t as f32), ray)
    // <stub> todo!("solve the quadratic for t and return the nearest root that counts")
    // </solution>
}

/// Ray-sphere intersection by geometry: `t_ca` is the `t` of the ray's point nearest to the centre, and `t_hc` is
/// half of the chord. The two roots are `t_ca - t_hc` and `t_ca + t_hc`.
///
/// The contract is that of [`sphere_algebraic`]: the nearest root that counts, in lengths of `direction`. A tangent
/// ray hits. The result is `None` for a radius of 0, a negative radius, a direction of 0, an infinite origin, and a
/// NaN anywhere.
///
/// Pitfall: the slide returns no hit when `t_ca < 0`, but a ray that starts inside and points away from the centre
/// hits the far side. The slide's `d² = L·L - t_ca²` cancels for a distant sphere and needs a unit direction.
pub fn sphere_geometric(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    // <solution>
    // Compute the squares in double precision, in which they neither overflow nor underflow.
    let (to_center, d, r) = ((center - ray.origin).as_dvec3(), ray.direction.as_dvec3(), f64::from(radius));
    let length_squared = d.length_squared();

    // Find the ray's point nearest to the centre, and the vector from there to the centre.
    let t_ca = to_center.dot(d) / length_squared;
    let nearest = to_center - t_ca * d;
    // Compute the squared half chord by Pythagoras. Reject rays that pass beside the sphere, and NaN.
    let half_chord_squared = r * r - nearest.length_squared();
    if !(half_chord_squared >= 0.0 && r > 0.0) {
        return None;
    }
    // Convert half of the chord to lengths of the direction.
    let t_hc = (half_chord_squared / length_squared).sqrt();

    // Compute the root farther from t = 0 as a sum of two numbers of the same sign. The other difference would cancel
    // for an origin near the surface, so divide the product of both roots, (|L|² - r²) / |d|² (the power of a point).
    let away = t_ca + t_hc.copysign(t_ca);
    let power = (to_center.length_squared() - r * r) / length_squared;
    // Return the nearest root in the ray's range.
    nearest_root([power / away, away].map(|t| t as f32), ray)
    // <stub> todo!("find t_ca and t_hc, and return the nearest of t_ca - t_hc and t_ca + t_hc that counts")
    // </solution>
}

/// The unit normal of a sphere at `point`: the direction from the centre to `point`.
///
/// `point` lies on the sphere up to rounding. The result has length 1 up to rounding. If `point` is the centre, any
/// unit vector is right.
pub fn sphere_normal(center: Vec3, point: Vec3) -> Vec3 {
    // <solution>
    // Divide by the length and not by r: this keeps the normal at length 1 when `point` has a rounding error.
    (point - center).as_dvec3().normalize_or(DVec3::Z).as_vec3()
    // <stub> todo!("return the unit vector from the centre to the point")
    // </solution>
}

/// Ray-plane intersection: solve `n·(o + t d - p₀) = 0` for `t`. The plane is infinite and contains `point` = `p₀`.
///
/// Returns `t` in lengths of `direction` if it counts. Neither `direction` nor `normal` need be a unit vector. The
/// plane can be hit from both sides. The result is `None` for a ray parallel to the plane (`n·d = 0` exactly), a ray
/// that starts in the plane, a normal of 0, and a NaN anywhere.
///
/// Pitfall: for a ray along the plane the division by `n·d = 0` gives infinity or NaN, which is not a hit. The form
/// `t = -(D + n·o) / n·d` is equal on paper but cancels far from the origin.
pub fn plane(ray: &Ray, point: Vec3, normal: Vec3) -> Option<f32> {
    // <solution>
    let t = (point - ray.origin).dot(normal) / ray.direction.dot(normal);
    // Reject NaN (from 0/0) and infinity (from 1/0) together with all other t out of range.
    ray.contains(t).then_some(t)
    // <stub> todo!("solve n·(o + t d - p0) = 0 for t and return it if ray.contains(t)")
    // </solution>
}

/// Ray-plane intersection with the plane as an equation: put `o + t v` into `A x + B y + C z + D = 0` and solve for `t`.
/// With `normal` = n = (A, B, C), `d` = D and the direction v of the ray, `t = (-D - n·o) / (n·v)`.
///
/// Returns `t` in lengths of `direction` if it counts. Neither `direction` nor `normal` need be a unit vector: all four
/// coefficients times the same factor, positive or negative, give the same plane and so the same `t`. The plane can be
/// hit from both sides, and [`face_forward`] turns its normal to the ray. The result is `None` for a ray parallel to the
/// plane (`n·v = 0` exactly), a ray that starts in the plane, a normal of 0, and a NaN anywhere.
///
/// Pitfall: far from the origin D and n·o are large and cancel. `t` must keep its digits there, up to a few roundings,
/// for the plane that the coefficients give: add D and n·o in double precision, in which the product of two `f32` is
/// exact. Factors are between 1e-12 and 1e12 in the checks.
///
/// Slide: "Ray-plane intersection".
pub fn plane_by_coefficients(ray: &Ray, normal: Vec3, d: f32) -> Option<f32> {
    // <solution>
    let (n, o, v) = (normal.as_dvec3(), ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let t = ((-f64::from(d) - n.dot(o)) / n.dot(v)) as f32;
    // Reject NaN (from 0/0) and infinity (from 1/0) together with all other t out of range.
    ray.contains(t).then_some(t)
    // <stub> todo!("solve n·(o + t v) + D = 0 for t and return it if ray.contains(t)")
    // </solution>
}

/// `normal` or `-normal`: the one that points to the side from which a ray along `direction` comes, so that
/// `n·d ≤ 0`.
///
/// Neither vector need be a unit vector. The length of the normal does not change. If `n·d` is 0, either is right.
pub fn face_forward(normal: Vec3, direction: Vec3) -> Vec3 {
    // <solution>
    if normal.dot(direction) > 0.0 { -normal } else { normal }
    // <stub> todo!("negate the normal if n·d > 0")
    // </solution>
}
