//! Stage 10 · stability: intersection tests of earlier stages, for inputs where rounding errors decide the answer.
//!
//! Slides: "Ray-Sphere Intersection", "Inside Test", "Numerical precision", "Bounding Volumes"; Woop, Benthin and Wald
//! 2013; Ize 2013; Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th edition, section 6.8.
//!
//! Your functions of earlier stages may already be good enough. `cargo run --release -- gauntlet --kit exercises` shows
//! what they cost and where they fail.
//!
//! A hit with a triangle or a sphere counts if `ray.contains(t)`, that is `t_min < t < t_max`: both ends are open.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::kit::TriangleHit;
use raykata::ray::Ray;
use raykata::shape::Triangle;

// <solution>
use crate::{stage1_shapes::nearest_root, stage3_boxes::slab, stage4_shading::off_surface};
use glam::{DVec2, DVec3};
// </solution>

/// Computes the real roots of `a t² + b t + c = 0` without cancellation.
///
/// Returns the smaller root first, for every sign of `a` and `b`. A double root is returned twice, and for `b = c = 0`
/// both roots are 0. Returns `None` if there is no real root, if `a` is 0, or if a coefficient is NaN or infinite. No
/// root is NaN; a root too large for `f32` is infinite.
///
/// Pitfall: `-b + √(b² - 4ac)` cancels if b is large: one root of `t² - 10000 t + 1` becomes 0. Add numbers of the same
/// sign instead, `q = -(b + sign(b) √(b² - 4ac)) / 2`: one root is `q / a`, the other `c / q`.
///
/// Slide: "Ray-Sphere Intersection".
pub fn stable_roots(a: f32, b: f32, c: f32) -> Option<[f32; 2]> {
    // <solution>
    // Refuse equations that are not quadratic and coefficients that are not finite.
    if a == 0.0 || !(a.is_finite() && b.is_finite() && c.is_finite()) {
        return None;
    }
    // Compute the discriminant in double precision: both products are exact, so it is rounded once and its sign is
    // right.
    let [a, b, c] = [a, b, c].map(f64::from);
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    // Add two numbers of the same sign, so that nothing cancels.
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    // Avoid 0 / 0: q is 0 only if b and c are 0.
    let (first, second) = if q == 0.0 { (0.0, 0.0) } else { (q / a, c / q) };
    Some([first.min(second) as f32, first.max(second) as f32])
    // <stub> todo!("avoid the difference of two nearly equal numbers: q first, then q / a and c / q")
    // </solution>
}

/// Intersects a ray with a triangle such that no ray escapes between two triangles that share an edge or a corner, at
/// any size and at any place.
///
/// Returns `t` and the barycentric coordinates β and γ of the hit. Points on edges belong to the triangle. Scaling ray
/// and triangle by a power of two changes no answer, unless a number over- or underflows. `t` is accurate also on
/// triangles a million times as long as wide. NaN or infinite inputs give `None` or a finite hit.
///
/// Pitfall: each triangle has its own rounding errors, so a ray at a shared edge may miss both. Decide on which side of
/// an edge the ray passes by a computation that uses only the two ends of the edge: the neighbour repeats it exactly.
///
/// Your pictures use this function for triangles as soon as it is written; before, they use `triangle_choice` of stage 2.
///
/// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013.
#[inline]
pub fn watertight(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    // <solution>
    // Convert everything to double precision, which holds products of sizes from 1e-38 to 1e38 without overflow or
    // underflow. In single precision neighbouring triangles also agree, but rounding may give a ray to the neighbour
    // of the triangle that it hits, and the ray may miss the neighbour's box: in a hierarchy 7 of 10⁸ rays at edges
    // leaked out of meshes. Double precision makes a plain frame of 57,600 triangles a tenth slower.
    let [o, d, a, b, c] = [ray.origin, ray.direction, triangle.a, triangle.b, triangle.c].map(Vec3::as_dvec3);

    // Transform the triangle: the ray's origin to zero, the ray's longest axis to z, and a shear that turns the ray
    // into (0 0 z).
    let z = longest_axis(ray.direction);
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    let shear = DVec2::new(d[x], d[y]) / d[z];
    let project = |corner: DVec3| {
        let corner = corner - o;
        DVec2::new(corner[x], corner[y]) - shear * corner[z]
    };
    let [p, q, r] = [a, b, c].map(project);

    // Compute three edge functions. The sign of each tells on which side of the edge the ray passes. Two triangles
    // compute a shared edge from the same two points, and rounding is monotone, so it cannot turn "inside" into
    // "outside".
    let [alpha, beta, gamma] = [edge(q, r), edge(r, p), edge(p, q)];
    // Reject the ray if two signs differ or if the projected triangle has no area.
    let (least, most) = (alpha.min(beta).min(gamma), alpha.max(beta).max(gamma));
    let sum = alpha + beta + gamma;
    if (least < 0.0 && most > 0.0) || sum == 0.0 || sum.is_nan() {
        return None;
    }

    // Compute t from the plane: t = (a - o)·n / d·n. The paper takes t from the sheared z of the corners, which loses
    // all digits on a needle seen from inside.
    let normal = (b - a).cross(c - a);
    let t = ((a - o).dot(normal) / d.dot(normal)) as f32;
    // Reject hits outside the ray's range. Divide by the sum to get barycentric coordinates.
    ray.contains(t).then_some(TriangleHit { t, beta: (beta / sum) as f32, gamma: (gamma / sum) as f32 })
    // <stub> todo!("transform the triangle to the ray's coordinates, and decide each edge by its two ends only")
    // </solution>
}

// <solution>
/// Twice the signed area of the triangle from the origin over `p` to `q`.
fn edge(p: DVec2, q: DVec2) -> f64 {
    p.x * q.y - p.y * q.x
}

/// The axis along which `v` is longest.
fn longest_axis(v: Vec3) -> usize {
    let v = v.abs();
    if v.x >= v.y && v.x >= v.z {
        0
    } else if v.y >= v.z {
        1
    } else {
        2
    }
}
// </solution>

/// Computes the `t` at which `ray` enters and leaves `bounds`, as in stage 3, but never returns `None` for a box that
/// the ray meets.
///
/// This holds at corners, for flat boxes, far away, along faces and for directions of -0.0, with `t_min >= 0` and with
/// `inverse_direction` finite wherever the direction is not 0. A box with a hit at `t` is entered at `t` or before. A
/// box that the ray passes by at more than 64 roundings gives `None`, and so does the empty box. Neither result is ever
/// NaN.
///
/// Pitfall: widening boxes by 1e-5 has no effect at coordinates of 1000 and more. Multiply the exit by `1 + 2 γ₃`, the
/// bound on its own three rounding errors, and the entry by `1 - 2 γ₃`, because a search compares the entry with the
/// `t` of hits, which are rounded differently.
///
/// Source: Ize, "Robust BVH Ray Traversal", JCGT 2013.
pub fn conservative_slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)> {
    // <solution>
    // Call the slab test of stage 3, which is conservative.
    slab(ray, inverse_direction, bounds)
    // <stub> todo!("compare so that NaN changes nothing; make the exit a little later and the entry a little earlier")
    // </solution>
}

/// Computes the origin of a ray along `direction` that leaves a surface, such that the ray does not hit the same
/// surface again (shadow acne).
///
/// The true surface lies within `error` of `point` along each axis. Move the point along the unit `normal` by
/// `error · |normal|`, to the side to which `direction` goes, and then each coordinate by one float outwards, because
/// the sum is rounded as well. If `direction` is perpendicular to the normal, take the side of the normal. The height
/// above `point` may be at most 4 times this bound plus 64 rounding steps of the largest coordinate.
///
/// Pitfall: any fixed distance is too small in one scene and too large in another. In a scene of size 0.001, a ray that
/// starts 0.0001 away misses objects that touch the surface.
///
/// Source: Pharr, Jakob and Humphreys, section 6.8.
pub fn offset_origin(point: Vec3, error: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    // <solution>
    // Turn the normal to the side to which the ray goes, and leave the surface on that side.
    let side = if normal.dot(direction) < 0.0 { -normal } else { normal };
    off_surface(point, error, side)
    // <stub> todo!("move the point along the normal by its error, then each coordinate by one float outwards")
    // </solution>
}

/// Normalizes a vector: `v / |v|`, with length 1 up to rounding, for every finite `v` except 0, however short or long.
///
/// Returns `None` for the zero vector (also with -0.0) and for a vector with a coordinate that is NaN or infinite.
///
/// Pitfall: in single precision the square of 1e-30 is 0 and the square of 1e30 is infinite.
///
/// Slide: "Numerical precision".
pub fn safe_normalize(v: Vec3) -> Option<Vec3> {
    // <solution>
    let largest = v.abs().max_element();
    if largest == 0.0 || !v.is_finite() {
        return None;
    }
    // Normalize in double precision, in which the square of every finite `f32` fits.
    Some(v.as_dvec3().normalize().as_vec3())
    // <stub> todo!("scale by the largest coordinate first")
    // </solution>
}

/// Intersects a ray with a triangle in double precision: solves `o + t d = a + β (b - a) + γ (c - a)`.
///
/// Every number is an `f64`, and only the three results are rounded to `f32`. Any method is accepted. Points on edges
/// belong to the triangle: `β >= 0`, `γ >= 0` and `β + γ <= 1`. A hit counts if the range of the ray contains the
/// rounded `t`. An input with NaN gives `None`, and so does a determinant of 0. Every hit is finite. Scenes with
/// `precision = "double"` are rendered with this function.
///
/// Pitfall: a number that was rounded before its conversion stays rounded, so `(a - b).as_dvec3()` gains nothing. Do
/// not compare the determinant with an epsilon, in any precision, because it grows with the cube of the size.
///
/// Slide: "Cramer's Rule". The reference is the method of Möller and Trumbore, as `triangle_choice` of stage 2.
pub fn triangle_in_double(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    // <solution>
    // Convert all inputs before the first subtraction.
    let [o, d, a, b, c] = [ray.origin, ray.direction, triangle.a, triangle.b, triangle.c].map(Vec3::as_dvec3);

    // Solve o + t d = a + β edge1 + γ edge2 by the method of Möller and Trumbore, and round only t.
    let (edge1, edge2) = (b - a, c - a);
    let pvec = d.cross(edge2);
    let determinant = edge1.dot(pvec);
    let tvec = o - a;
    let beta = tvec.dot(pvec) / determinant;
    let qvec = tvec.cross(edge1);
    let gamma = d.dot(qvec) / determinant;
    let t = (edge2.dot(qvec) / determinant) as f32;

    // Reject points outside the triangle. A determinant of 0 gives infinities or NaN, for which a comparison is false.
    let inside = beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0;
    (inside && ray.contains(t)).then_some(TriangleHit { t, beta: beta as f32, gamma: gamma as f32 })
    // <stub> todo!("convert all five vectors first, then solve for t, β and γ; round them last")
    // </solution>
}

/// Intersects a ray with a sphere in double precision: the `t` of the nearest hit within the range of the ray, rounded
/// to `f32` once.
///
/// A ray that starts inside hits the far side. A ray that touches the sphere hits it. A sphere whose radius is 0,
/// negative or NaN is never hit. An input with NaN gives `None`, and every `t` is finite.
///
/// Pitfall: `(o - c).as_dvec3()` has an error of up to 3 thousandths of a radius for a sphere 100,000 radii away. The
/// rest of the computation is then exact for a sphere at a wrong place.
///
/// Slide: "Ray-Sphere Intersection".
pub fn sphere_in_double(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    // <solution>
    // Convert origin, centre, direction and radius before the subtraction.
    let (d, r) = (ray.direction.as_dvec3(), f64::from(radius));
    let f = ray.origin.as_dvec3() - center.as_dvec3();

    // Compute the squared half chord r² - |f⊥|², as in stage 1. b² - a c is accurate enough here as well.
    let a = d.length_squared();
    let b = -f.dot(d);
    let half_chord_squared = r * r - (f + (b / a) * d).length_squared();
    if !(half_chord_squared >= 0.0 && r > 0.0) {
        return None;
    }

    // Compute both roots without cancellation, round each, and return the nearest one in the range of the ray.
    let q = b + (a * half_chord_squared).sqrt().copysign(b);
    nearest_root([(f.length_squared() - r * r) / q, q / a].map(|t| t as f32), ray)
    // <stub> todo!("convert origin, direction, centre and radius first, then use any method of stage 1")
    // </solution>
}
