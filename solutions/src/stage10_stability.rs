//! Stage 10 · stability: intersection tests of earlier stages, for inputs where rounding errors
//! decide the answer.
//!
//! Slides: `slides/stage10.md`. Sources: Woop, Benthin and Wald 2013; Ize 2013; Pharr, Jakob and
//! Humphreys, "Physically Based Rendering", 4th edition, section 6.8.
//!
//! Your functions of earlier stages may already be good enough.
//! `cargo run --release -- gauntlet --kit exercises` shows what they cost and where they fail.
//!
//! A hit with a triangle or a sphere counts if `ray.contains(t)`, that is `t_min < t < t_max`: both
//! ends are open.
//!
//! Your pictures use [`watertight`], [`conservative_slab`], [`offset_origin`] and
//! [`safe_normalize`] as soon as they are written; before, triangles use `triangle_choice` of stage
//! 2, boxes `slab` of stage 3, and shadow rays and secondary rays start where `shadow_ray` of stage
//! 4 and `spawn_ray` of stage 5 put them. Scenes with `sphere_method = "stable_roots"` or
//! `precision = "double"` use [`stable_roots`] or the last two functions.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::kit::TriangleHit;
use raykata::ray::Ray;
use raykata::rounding::exact_sum;
use raykata::shape::Triangle;

// <solution>
use crate::{stage1_shapes::nearest_root, stage4_shading::off_surface};
use glam::{DVec2, DVec3};
use raykata::count::exact_test;
use raykata::rounding::{gamma, two_sum};
// </solution>

/// The real roots of `a t² + b t + c = 0`, whose product is `c / a`. The usual formula gives 0 for
/// one root of `t² - 10000 t + 1`: why?
///
/// Exactly:
///
/// 1. The smaller root comes first, for every sign of `a` and `b`.
/// 2. A double root is returned twice; for `b = c = 0` both roots are 0.
/// 3. `None` if there is no real root, if `a` is 0, or if a coefficient is NaN or infinite.
///
/// Source: "Ray-Sphere Intersection".
pub fn stable_roots(a: f32, b: f32, c: f32) -> Option<[f32; 2]> {
    // <solution>
    // Refuse equations that are not quadratic and coefficients that are not finite.
    if a == 0.0 || !(a.is_finite() && b.is_finite() && c.is_finite()) {
        return None;
    }
    // Compute the discriminant in double precision: both products are exact, so it is rounded once
    // and its sign is right.
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

/// Intersects a ray with a triangle so that no ray escapes from a closed mesh. If the ray is the z
/// axis, the sign of `e(p, q) = p_x q_y - p_y q_x` tells on which side of the edge `pq` it passes,
/// and the neighbour gets the same number with the opposite sign. What if rounding errors decide
/// the sign? [`exact_sum`] makes none.
///
/// Exactly:
///
/// 1. No ray escapes at a shared edge or corner, at any size and place.
/// 2. None escapes through a triangle seen edge-on.
/// 3. Points on edges belong to the triangle, but a ray in its plane may miss it.
/// 4. Scaling by a power of two changes no answer, unless a number over- or underflows.
/// 5. `t` is accurate also on triangles a million times as long as wide. β and γ are right to
///    1e-3 well inside.
/// 6. NaN or infinity gives `None` or a finite hit.
///
/// Source: Woop, Benthin and Wald, "Watertight Ray/Triangle Intersection", JCGT 2013; Shewchuk,
/// "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates", 1997.
#[inline]
pub fn watertight(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    // <solution>
    // Convert everything to double precision, in which no product of three single precision numbers
    // overflows or underflows.
    let [o, d, a, b, c] = [ray.origin, ray.direction, triangle.a, triangle.b, triangle.c].map(Vec3::as_dvec3);

    // Transform the triangle: the ray's origin to zero, the ray's longest axis to z, and a shear
    // that turns the ray into (0 0 z).
    let z = ray.direction.abs().max_position();
    let (x, y) = ((z + 1) % 3, (z + 2) % 3);
    let shear = DVec2::new(d[x], d[y]) / d[z];
    let corners = [a - o, b - o, c - o];
    let [p, q, r] = corners.map(|corner| DVec2::new(corner[x], corner[y]) - shear * corner[z]);

    // Compute three edge functions. The sign of each tells on which side of the edge the ray
    // passes.
    let [alpha, beta, gamma] = [edge(q, r), edge(r, p), edge(p, q)];
    let (least, most) = (alpha.min(beta).min(gamma), alpha.max(beta).max(gamma));
    let sum = alpha + beta + gamma;
    // Reject inputs with NaN or infinite numbers.
    if !sum.is_finite() {
        return None;
    }
    // Bound the rounding errors, and reject the ray if two signs differ for certain.
    let width = largest([p.x, p.y, q.x, q.y, r.x, r.y]);
    let depth = largest(corners.map(|corner| corner[z]));
    let edge_error = EDGE_ERROR * width * (width + depth);
    if least < -edge_error && most > edge_error {
        return None;
    }

    // Compute t from the plane, t = (a - o)·n / d·n, and bound the rounding errors of both
    // products. The paper takes t from the sheared z of the corners, which loses all digits on a
    // needle seen from inside.
    let normal = (b - a).cross(c - a);
    let (distance, slope) = (corners[0].dot(normal), d.dot(normal));
    let terms = cross_without_signs((b - a).abs(), (c - a).abs());
    let distance_error = PLANE_ERROR * corners[0].abs().dot(terms);
    let slope_error = PLANE_ERROR * d.abs().dot(terms);

    // Reject the ray if t is outside its range for certain, compared as t |d·n|. A ray that leaves
    // a wall asks about its own wall: there the sign of t is certain long before its digits are.
    let (along, steep) = (distance * 1f64.copysign(slope), slope.abs());
    let [t_min, t_max] = [ray.t_min, ray.t_max].map(f64::from);
    let too_near = along - t_min * steep < -(distance_error + t_min.abs() * slope_error);
    let too_far = along - t_max * steep > distance_error + t_max.abs() * slope_error;
    if steep > slope_error && (too_near || too_far) {
        return None;
    }

    // Where rounding errors may decide, compute the exact answer. That is rare: the ray meets an
    // edge, or the triangle is a needle, is seen edge-on, or contains the origin of the ray up to
    // rounding.
    let certain = (least > edge_error || most < -edge_error)
        && sum.abs() > DIGITS * edge_error
        && distance.abs() > DIGITS * distance_error
        && slope.abs() > DIGITS * slope_error;
    if !certain {
        return exact_hit(ray, triangle);
    }
    // Reject hits outside the ray's range. Divide by the sum to get barycentric coordinates.
    let t = (distance / slope) as f32;
    ray.contains(t).then_some(TriangleHit { t, beta: (beta / sum) as f32, gamma: (gamma / sum) as f32 })
    // <stub> todo!("transform the triangle to the ray's coordinates, and decide each edge by its two ends only")
    // </solution>
}

// <solution>
/// A bound on the rounding errors of an edge function is `EDGE_ERROR · w (w + z)`, with `w` the
/// largest coordinate of the three sheared corners and `z` their largest depth.
///
/// With `u = 2⁻⁵³`: the shear, a corner and their product have a relative error of `u` each, so a
/// sheared coordinate `x - s z` has an error of at most `u (|x| + 3 |s z|) + u w ≤ u (2 w + 4 z)`,
/// because `|s| ≤ 1` and `|x| ≤ w + |z|`. An edge function is the difference of two products of
/// sheared coordinates: that makes `4 w` times this error, plus `4 u w²` for its own three
/// roundings. Together `u w (12 w + 16 z)`; `32 u` leaves room for products of errors.
const EDGE_ERROR: f64 = 16.0 * f64::EPSILON;

/// A bound on the rounding errors of `v·(e × f)` is `PLANE_ERROR` times the sum of its six products
/// without their signs, `|v_x| (|e_y f_z| + |e_z f_y|) + …`: it is 0 where the exact products are.
///
/// Each product has a relative error of `u` for each of its three differences, and two more for
/// itself; then it is in three sums. Together `8 u`. The comparison of `(a - o)·n` with `t d·n`
/// rounds a product and a difference: `10 u`. `16 u` leaves room for products of errors.
const PLANE_ERROR: f64 = 8.0 * f64::EPSILON;

/// A number that exceeds its error bound by this factor has 26 right binary digits, two more than
/// single precision keeps.
const DIGITS: f64 = (1 << 26) as f64;

/// The sums in place of the differences in `e × f`.
fn cross_without_signs(e: DVec3, f: DVec3) -> DVec3 {
    DVec3::new(e.y * f.z + e.z * f.y, e.z * f.x + e.x * f.z, e.x * f.y + e.y * f.x)
}

/// Twice the signed area of the triangle from the origin over `p` to `q`.
fn edge(p: DVec2, q: DVec2) -> f64 {
    p.x * q.y - p.y * q.x
}

/// The largest absolute value.
fn largest<const N: usize>(numbers: [f64; N]) -> f64 {
    numbers.into_iter().fold(0.0, |most, number| if number.abs() > most { number.abs() } else { most })
}

/// The hit of a ray with a triangle. Signs are exact, and the numbers have 26 right binary digits
/// before they are rounded.
///
/// Why no ray escapes from a closed mesh: let the ray start inside, on no triangle. Move its origin
/// by a little, such that the ray meets no edge and lies in no plane of a triangle. It still starts
/// inside, so it crosses some triangle at `t > 0`. Let these moves tend to zero: as there are
/// finitely many triangles, one of them is crossed again and again. It contains the limit, which is
/// a point of the original ray, because triangles are closed. Its determinant depends only on the
/// direction, which was not moved, so it is not 0. Its `t` tends to a number that is not negative,
/// and not 0, because the origin lies on no triangle. This triangle is hit by exact arithmetic, so
/// it is hit by `watertight`, whose decisions are exact: wherever rounding errors may decide, it
/// comes here. Rounding keeps `t > 0`, unless it underflows.
///
/// The same holds for a mesh with a border, such as a fan around a vertex, if the ray would hit it
/// after every small move of the origin. A ray in the plane of a triangle misses that triangle and
/// hits its neighbours.
#[cold]
fn exact_hit(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    exact_test();
    let (o, d, Triangle { a, b, c }) = (ray.origin, ray.direction, *triangle);
    // The barycentric coordinates are to each other as the determinants |d  b-o  c-o|,
    // |d  c-o  a-o| and |d  a-o  b-o|. A determinant is linear in each column, so expand the
    // differences.
    let side = |q: Vec3, r: Vec3| sum_of_determinants([[d, q, r], [o, d, r], [q, d, o]]);
    let (alpha, beta) = (side(b, c), side(c, a));
    // Reject the ray if two signs differ, or if it lies in the plane of the triangle.
    if alpha.min(beta) < 0.0 && alpha.max(beta) > 0.0 {
        return None;
    }
    let gamma = side(a, b);
    let (least, most) = (alpha.min(beta).min(gamma), alpha.max(beta).max(gamma));
    let sum = alpha + beta + gamma;
    if (least < 0.0 && most > 0.0) || sum == 0.0 {
        return None;
    }
    // t is |a-o  b-o  c-o| divided by the sum of these determinants.
    let volume = sum_of_determinants([[a, b, c], [b, o, c], [o, a, c], [b, a, o]]);
    let t = (volume / sum) as f32;
    ray.contains(t).then_some(TriangleHit { t, beta: (beta / sum) as f32, gamma: (gamma / sum) as f32 })
}

/// The sum of the determinants of matrices with three columns. Its sign is right, and so are its
/// first 26 binary digits.
fn sum_of_determinants<const N: usize>(matrices: [[Vec3; 3]; N]) -> f64 {
    // Expand the determinants into products of three numbers. A product of two single precision
    // numbers has 48 digits, so it is exact in double precision. Each half of its digits times the
    // third number is exact, too.
    let mut terms = [[0.0; 12]; N];
    for (terms, columns) in terms.iter_mut().zip(matrices) {
        let [u, v, w] = columns.map(Vec3::as_dvec3);
        let orders = [[0, 1, 2], [1, 2, 0], [2, 0, 1]];
        for (four, [i, j, k]) in terms.chunks_exact_mut(4).zip(orders) {
            for (two, product) in four.chunks_exact_mut(2).zip([u[i] * v[j], -u[j] * v[i]]) {
                let upper = upper_half(product);
                two.copy_from_slice(&[upper * w[k], (product - upper) * w[k]]);
            }
        }
    }
    let terms = terms.as_flattened();
    // Add the terms, and beside them the rounding error of each addition, which is a double.
    let [mut sum, mut error, mut lost, mut size] = [0.0f64; 4];
    for &term in terms {
        let (rounded, rounding) = two_sum(sum, term);
        sum = rounded;
        error += rounding;
        lost += rounding.abs();
        size += term.abs();
    }
    // Return the sum if no digit was lost, or if its digits are right: with its rounding errors
    // added, the sum of n terms is off by at most u |sum| + (n u)² Σ|term| (Ogita, Rump and Oishi,
    // "Accurate Sum and Dot Product", 2005), with u = ε/2. The other half of ε leaves room for the
    // rounding of this bound.
    let bound = (terms.len() as f64 * f64::EPSILON).powi(2) * size;
    let corrected = sum + error;
    if lost == 0.0 || corrected.abs() > DIGITS * bound {
        return corrected;
    }
    exact_sum(terms.iter().copied())
}

/// The first 24 of the binary digits of a number, so that at most 24 remain of a product of two
/// single precision numbers.
fn upper_half(product: f64) -> f64 {
    const LOWER: u64 = (1 << (f64::MANTISSA_DIGITS - f32::MANTISSA_DIGITS)) - 1;
    f64::from_bits(product.to_bits() & !LOWER)
}
// </solution>

/// The slab test of stage 3, with the same results, but it misses no box. Each `t` of a plane has
/// three rounding errors, together at most `γ₃ |t|`. At a corner entry and exit are equal: which is
/// larger after rounding? And which way is "later" at a negative `t`?
///
/// Coordinates and directions are below 1e37 in size, and a `t` that is not 0 is above 1e-30.
///
/// Exactly:
///
/// 1. No box that the ray meets gives `None`: at corners, along faces, flat boxes, far away.
/// 2. The same in every range, also at negative `t`.
/// 3. The same in every direction, also -0.0, and where `1/d` overflows.
/// 4. A box with a hit at `t` is entered at `t` or before.
/// 5. The entry is right up to 64 roundings, where the ray clearly meets the box.
/// 6. A box passed by at more than 64 roundings gives `None`.
///
/// Source: Ize, "Robust BVH Ray Traversal", JCGT 2013.
pub fn conservative_slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)> {
    // <solution>
    let (mut near, mut far) = (ray.t_min, ray.t_max);
    for axis in 0..3 {
        // Compute the t of both planes as in stage 3.
        let inverse = inverse_direction[axis];
        let t_at = |plane: f32| {
            let distance = plane - ray.origin[axis];
            if inverse.is_finite() { distance * inverse } else { distance / ray.direction[axis] }
        };
        let [low, high] = [bounds.min[axis], bounds.max[axis]].map(t_at);
        let (enter, leave) = if inverse.is_sign_negative() { (high, low) } else { (low, high) };
        // Move the exit later and the entry earlier by 2 γ₃ |t|. One factor is not enough: it would
        // move a negative t the wrong way. A fixed width of 1e-5 has no effect at coordinates of
        // 1000 and more.
        let enter = (enter * LESS).min(enter * MORE);
        let leave = (leave * LESS).max(leave * MORE);
        // Intersect the intervals. The comparison is false for NaN, a ray within a face.
        if enter > near {
            near = enter;
        }
        if leave < far {
            far = leave;
        }
    }
    (near <= far).then_some((near, far))
    // <stub> todo!("compare so that NaN changes nothing; then widen the interval at both ends, on both sides of 0")
    // </solution>
}

// <solution>
/// The factors by which `conservative_slab` moves entry and exit. An exit that is later by the
/// error of both ends loses no box. An entry that is earlier matters to a search, which compares it
/// with the `t` of the best hit, rounded in another way: without it 1 of 500 rays in a room of flat
/// walls, and 2 or 3 of 500 in a stadium with a small object, find another triangle than brute
/// force (measured).
const MORE: f32 = 1.0 + 2.0 * gamma(3);
const LESS: f32 = 1.0 - 2.0 * gamma(3);
// </solution>

/// The origin of a ray that leaves a surface and must not hit it again (shadow acne).
///
/// ```text
///    • origin
/// ┌──┼──┐
/// │  •  │ point ± error
/// └─────┘
/// ```
///
/// The true surface lies within `error` of `point` along each axis, so along the unit `normal` n at
/// most `h = e_x |n_x| + e_y |n_y| + e_z |n_z|` away. Which fixed distance suits scenes of size
/// 0.001 and of size 1000?
///
/// Exactly:
///
/// 1. The origin is at least h above `point`, also after rounding.
/// 2. It is on the side to which `direction` goes, or on that of `normal` if both are
///    perpendicular.
/// 3. Its height is at most 4 h plus 64 rounding steps of the largest coordinate.
///
/// Source: Pharr, Jakob and Humphreys, section 6.8.
pub fn offset_origin(point: Vec3, error: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    // <solution>
    // Turn the normal to the side to which the ray goes, and leave the surface on that side, by
    // error · |n| and then by one float per coordinate, because the sum is rounded as well.
    let side = if normal.dot(direction) < 0.0 { -normal } else { normal };
    off_surface(point, error, side)
    // <stub> todo!("move the point along the normal by its error, then each coordinate by one float outwards")
    // </solution>
}

/// The unit vector in the direction of `v`: `v / |v|`. What is the square of 1e-30 in single
/// precision, and of 1e30?
///
/// The result has length 1 up to rounding for every finite `v` except 0, however short or long. It
/// is `None` for the zero vector (also with -0.0) and for a vector with a coordinate that is NaN or
/// infinite.
///
/// Source: "Numerical precision".
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

/// Intersects a ray with a triangle in double precision: solves
/// `o + t d = a + β (b - a) + γ (c - a)`, by Cramer's rule or any other method. How many right
/// digits has `(a - b).as_dvec3()`? Which epsilon suits determinants of every size?
///
/// Exactly:
///
/// 1. Every number is an `f64`, and only the results are rounded: `t` is at most one unit in the
///    last place off; β and γ, well inside, two roundings.
/// 2. Points on edges belong to the triangle, if no product of three numbers is rounded.
/// 3. The range of the ray contains the rounded `t`.
/// 4. `None` for a determinant of 0. Every hit is finite.
///
/// Source: "Cramer's Rule".
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

    // Reject points outside the triangle. A determinant of 0 gives infinities or NaN, for which a
    // comparison is false.
    let inside = beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0;
    (inside && ray.contains(t)).then_some(TriangleHit { t, beta: beta as f32, gamma: gamma as f32 })
    // <stub> todo!("convert all five vectors first, then solve for t, β and γ; round them last")
    // </solution>
}

/// Intersects a ray with a sphere in double precision, by any method. What is the error of
/// `(o - c).as_dvec3()` for a sphere 100,000 radii away?
///
/// Returns the `t` of the nearest hit within the range of the ray, rounded to `f32` last.
///
/// Exactly:
///
/// 1. A ray that starts inside hits the far side; one that touches the sphere hits it.
/// 2. `t` is at most one unit in the last place off, if the ray starts a millionth of the radius
///    or more away from the sphere.
///
/// Source: "Ray-Sphere Intersection".
pub fn sphere_in_double(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    // <solution>
    // Convert origin, centre, direction and radius before the subtraction.
    let (d, r) = (ray.direction.as_dvec3(), f64::from(radius));
    let f = ray.origin.as_dvec3() - center.as_dvec3();

    // Compute the squared half chord r² - |f⊥|², as in stage 1. b² - a c is accurate enough here as
    // well.
    let a = d.length_squared();
    let b = -f.dot(d);
    let half_chord_squared = r * r - (f + (b / a) * d).length_squared();
    if !(half_chord_squared >= 0.0 && r > 0.0) {
        return None;
    }

    // Compute both roots without cancellation, round each, and return the nearest one in the range
    // of the ray.
    let q = b + (a * half_chord_squared).sqrt().copysign(b);
    nearest_root([(f.length_squared() - r * r) / q, q / a].map(|t| t as f32), ray)
    // <stub> todo!("convert origin, direction, centre and radius first, then use any method of stage 1")
    // </solution>
}
