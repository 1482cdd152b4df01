//! Stage 10 · stability: the same questions as before, asked so that roundings decide; and answers that survive it.
//!
//! Slides: "Ray-Sphere Intersection", "Inside Test", "Numerical precision", "Bounding Volumes"; Woop, Benthin and Wald
//! 2013; Ize 2013; Pharr, Jakob and Humphreys, "Physically Based Rendering", 4th edition, section 6.8.
//!
//! What you wrote in earlier stages may do already. `cargo run --release -- gauntlet --kit exercises` shows what it
//! costs and where it fails.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::kit::TriangleHit;
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// The real roots of `a t² + b t + c = 0`, the smaller one first; a double root is there twice. `None` if there is none,
/// if `a` is 0, or if some number is not finite.
///
/// Where the formula lies: `-b + √(b² - 4ac)` cancels if b is large: one root of `t² - 10000 t + 1` comes out as 0. Add
/// numbers of the same sign, `q = -(b + sign(b) √(b² - 4ac)) / 2`: one root is `q / a`, the other `c / q`.
pub fn stable_roots(a: f32, b: f32, c: f32) -> Option<[f32; 2]> {
    // <solution>
    if a == 0.0 || !(a.is_finite() && b.is_finite() && c.is_finite()) {
        return None;
    }
    // In double both products are exact, so the discriminant is rounded once and its sign is right.
    let [a, b, c] = [a, b, c].map(f64::from);
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 {
        return None;
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    // q is 0 only if b and c are.
    let (first, second) = if q == 0.0 { (0.0, 0.0) } else { (q / a, c / q) };
    Some([first.min(second) as f32, first.max(second) as f32])
    // <stub> todo!("never subtract what is nearly the same: q first, then q / a and c / q")
    // </solution>
}

/// Ray against triangle such that no ray slips through between two triangles that share an edge or a corner, at any size
/// and any place; with the `t`, β and γ of the hit.
///
/// Where the formula lies: each triangle rounds for itself, and a ray at a shared edge is beside both. Decide on which
/// side of an edge the ray passes by one computation on its two ends, which the neighbour repeats.
pub fn watertight(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    // <solution>
    // That of stage 2 does, in double precision throughout.
    crate::stage2_triangles::triangle_choice(ray, triangle)
    // <stub> todo!("see the triangle from the ray, and decide each edge by its two ends alone")
    // </solution>
}

/// Where `ray` enters and leaves `bounds`, as in stage 3, but never `None` for a box that the ray meets: not at its
/// corners, not if it is flat, not far away, not along its faces, not for -0.0.
///
/// Where the formula lies: widening boxes by 1e-5 does nothing at 1000 and more. Make the way out longer by the error of
/// its own three roundings instead, `1 + 2 γ₃`, and the way in earlier by as much: a search compares it with the `t` of
/// hits, which are rounded in another way.
pub fn conservative_slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)> {
    // <solution>
    // That of stage 3 is.
    crate::stage3_bvh::slab(ray, inverse_direction, bounds)
    // <stub> todo!("compare so that NaN changes nothing, and let the way out be a little longer")
    // </solution>
}

/// Where a ray along `direction` starts from a surface whose true place is within `error` of `point` along each axis:
/// off the surface, on the side to which it goes, and no farther than it must.
///
/// Where the formula lies: any fixed distance is too small somewhere and too large elsewhere: at a size of 0.001 a ray
/// that starts 0.0001 away misses what touches the surface.
pub fn offset_origin(point: Vec3, error: Vec3, normal: Vec3, direction: Vec3) -> Vec3 {
    // <solution>
    // `off_surface` of stage 4 does the same, but as a helper: here it is what is asked for.
    let side = if normal.dot(direction) < 0.0 { -normal } else { normal };
    let origin = point + error.dot(side.abs()) * side;
    // The sum is rounded as well, so go one more step outwards on each axis.
    Vec3::from_array([0, 1, 2].map(|axis| match side[axis] {
        along if along > 0.0 => origin[axis].next_up(),
        along if along < 0.0 => origin[axis].next_down(),
        _ => origin[axis],
    }))
    // <stub> todo!("move the point along the normal by its error, and then by a step of the last digit")
    // </solution>
}

/// `v / |v|` for every v that has a direction, however short or long; `None` for 0 and for what is not finite.
///
/// Where the formula lies: the squares of 1e-30 are 0 and those of 1e30 are infinite.
pub fn safe_normalize(v: Vec3) -> Option<Vec3> {
    // <solution>
    let largest = v.abs().max_element();
    if largest == 0.0 || !v.is_finite() {
        return None;
    }
    // In double the squares of all finite numbers fit.
    Some(v.as_dvec3().normalize().as_vec3())
    // <stub> todo!("scale by the largest coordinate first")
    // </solution>
}

/// Ray against triangle by Cramer's rule as in stage 2, `β (a - b) + γ (a - c) + t d = a - o`, with every number in `f64`
/// and only the three results rounded. The range of the ray is asked about the rounded `t`. Scenes with
/// `precision = "double"` are rendered with this.
///
/// Where the formula lies: what was rounded before it was converted stays rounded, so `(a - b).as_dvec3()` buys nothing.
/// And in no precision has an epsilon on the determinant a meaning: it grows with the cube of the size.
pub fn triangle_in_double(ray: &Ray, triangle: &Triangle) -> Option<TriangleHit> {
    // <solution>
    let [o, d, a, b, c] = [ray.origin, ray.direction, triangle.a, triangle.b, triangle.c].map(Vec3::as_dvec3);
    let (from_b, from_c, from_o) = (a - b, a - c, a - o);

    let aside = from_c.cross(d);
    let along = from_b.cross(from_o);
    let determinant = from_b.dot(aside);
    let beta = from_o.dot(aside) / determinant;
    let gamma = d.dot(along) / determinant;
    let t = (-from_c.dot(along) / determinant) as f32;

    // A determinant of 0 makes infinities or NaN, and one of these is false then.
    let inside = beta >= 0.0 && gamma >= 0.0 && beta + gamma <= 1.0;
    (inside && ray.contains(t)).then_some(TriangleHit { t, beta: beta as f32, gamma: gamma as f32 })
    // <stub> todo!("convert all five vectors first, then Cramer's rule; round t, β and γ last")
    // </solution>
}

/// Ray against sphere in the same way: the `t` of the nearest hit that counts, rounded once. A sphere without a radius
/// above 0 is never hit, and NaN is no hit.
///
/// Where the formula lies: `(o - c).as_dvec3()` is off by up to 3 thousandths of a radius for a sphere 100,000 radii
/// away, and all that follows is right for another sphere.
pub fn sphere_in_double(ray: &Ray, center: Vec3, radius: f32) -> Option<f32> {
    // <solution>
    let (d, r) = (ray.direction.as_dvec3(), f64::from(radius));
    let f = ray.origin.as_dvec3() - center.as_dvec3();

    // r² - |f⊥|² as in stage 1; b² - a c has digits enough here as well.
    let a = d.length_squared();
    let b = -f.dot(d);
    let discriminant = r * r - (f + (b / a) * d).length_squared();
    if !(discriminant >= 0.0 && r > 0.0) {
        return None;
    }

    let q = b + (a * discriminant).sqrt().copysign(b);
    let roots = [(f.length_squared() - r * r) / q, q / a].map(|t| t as f32);
    let [near, far] = [roots[0].min(roots[1]), roots[0].max(roots[1])];
    [near, far].into_iter().find(|&t| ray.contains(t))
    // <stub> todo!("convert origin, direction, centre and radius first, then any way of stage 1")
    // </solution>
}
