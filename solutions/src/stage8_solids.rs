//! Stage 8 · solids: boxes, cylinders, cones, disks and polygons, each in its own space.
//!
//! Slides: "Ray-Box Intersection", "Other Ray-Primitive Intersections" (cone, cylinder: similar to sphere, must also check
//! end caps; convex polygon: same as triangle).
//!
//! A convex solid is what several simpler sets have in common: a box is three slabs, a cylinder an infinite cylinder and a
//! slab. A line is in each of them for one interval of `t`, so it is in the solid where all intervals overlap, and there is
//! no cap to be forgotten. The first end of the overlap in the range of the ray is the hit.

use glam::{DVec3, Vec3};
use raykata::kit::SolidHit;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Polygon};

// <solution>
/// The part of a line that lies in a convex set, with the outward normals at its ends. In double precision: the numbers of
/// the input are single, so that products of two are exact and cancellation leaves digits enough.
#[derive(Clone, Copy)]
struct Span {
    enter: f64,
    leave: f64,
    enter_normal: DVec3,
    leave_normal: DVec3,
}

impl Span {
    const WHOLE_LINE: Span = Span {
        enter: f64::NEG_INFINITY,
        leave: f64::INFINITY,
        enter_normal: DVec3::ZERO,
        leave_normal: DVec3::ZERO,
    };

    /// What it has in common with another one; `None` if nothing. To touch is to hit.
    fn and(self, other: Span) -> Option<Span> {
        let first = if other.enter > self.enter { other } else { self };
        let last = if other.leave < self.leave { other } else { self };
        let both = Span {
            enter: first.enter,
            enter_normal: first.enter_normal,
            leave: last.leave,
            leave_normal: last.leave_normal,
        };
        (both.enter <= both.leave).then_some(both)
    }

    /// The first end within the range of the ray.
    fn first_hit(&self, ray: &Ray) -> Option<SolidHit> {
        let ends = [(self.enter, self.enter_normal), (self.leave, self.leave_normal)];
        ends.into_iter()
            .map(|(t, normal)| SolidHit { t: t as f32, normal: normal.normalize_or_zero().as_vec3() })
            .find(|hit| ray.contains(hit.t))
    }
}

/// Where a line whose height is `start + t rate` lies between two heights. `up` is the direction of height.
fn slab(start: f64, rate: f64, [low, high]: [f64; 2], up: DVec3) -> Option<Span> {
    if rate == 0.0 {
        // Along the slab: inside all the way or never. No division, so neither 0/0 nor -0.0 can do harm.
        return (low <= start && start <= high).then_some(Span::WHOLE_LINE);
    }
    let (at_low, at_high) = ((low - start) / rate, (high - start) / rate);
    Some(match rate > 0.0 {
        true => Span { enter: at_low, leave: at_high, enter_normal: -up, leave_normal: up },
        false => Span { enter: at_high, leave: at_low, enter_normal: up, leave_normal: -up },
    })
}

/// The roots of `a t² + 2 b t + c` with `root = √(b² - ac)`, the smaller first: never a difference of like numbers.
fn roots(a: f64, b: f64, c: f64, root: f64) -> (f64, f64) {
    let q = -(b + root.copysign(b));
    // q is 0 only if b and the root are: both roots of a t² are 0.
    let (first, second) = if q == 0.0 { (0.0, 0.0) } else { (q / a, c / q) };
    (first.min(second), first.max(second))
}

fn all_finite(ray: &Ray, points: &[Vec3]) -> bool {
    ray.origin.is_finite() && ray.direction.is_finite() && points.iter().all(|point| point.is_finite())
}
// </solution>

/// Ray against a solid box: the nearest point of its surface within the range of the ray. From inside that is where the
/// ray leaves. The box may be flat.
///
/// Where the formula lies: "check front-facing sides" loses every ray that starts inside, and a point computed on one face
/// is tested against the others' edges with its rounding, so rays at edges are lost. Cut three intervals instead.
pub fn cuboid(ray: &Ray, cuboid: &Cuboid) -> Option<SolidHit> {
    // <solution>
    if !all_finite(ray, &[cuboid.min, cuboid.max]) || ray.direction == Vec3::ZERO {
        return None;
    }
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let (min, max) = (cuboid.min.as_dvec3(), cuboid.max.as_dvec3());
    let mut span = Span::WHOLE_LINE;
    for (axis, up) in DVec3::AXES.into_iter().enumerate() {
        span = span.and(slab(origin[axis], direction[axis], [min[axis], max[axis]], up)?)?;
    }
    span.first_hit(ray)
    // <stub> todo!("cut the intervals of the three axes; the first end in the range of the ray is the hit")
    // </solution>
}

/// Ray against a cylinder with both ends closed.
///
/// With the axis `A` from base to top and the moment `L = (o - base) × d`, the line passes the axis at the distance
/// `|A·L| / |d × A|`, so the discriminant of the infinite cylinder is `|d × A|² r² - (A·L)²`.
///
/// Where the formula lies: "similar to sphere": for a ray along the axis `a = |d × A|²` is 0, and 0/0 is NaN. And caps
/// tested as disks on their own leak at the rim.
pub fn cylinder(ray: &Ray, cylinder: &Cylinder) -> Option<SolidHit> {
    // <solution>
    if !all_finite(ray, &[cylinder.base, cylinder.top]) || ray.direction == Vec3::ZERO {
        return None;
    }
    let direction = ray.direction.as_dvec3();
    let from_base = ray.origin.as_dvec3() - cylinder.base.as_dvec3();
    let axis = cylinder.top.as_dvec3() - cylinder.base.as_dvec3();
    let between_caps = slab(from_base.dot(axis), direction.dot(axis), [0.0, axis.length_squared()], axis)?;

    // |(p + t d) × A|² ≤ r² |A|²
    let radius_squared = f64::from(cylinder.radius).powi(2);
    let (m, n) = (direction.cross(axis), from_base.cross(axis));
    let (a, b, c) = (m.dot(m), n.dot(m), n.dot(n) - radius_squared * axis.length_squared());
    let round = if a == 0.0 {
        if c > 0.0 {
            return None;
        }
        Span::WHOLE_LINE
    } else {
        let discriminant = a * radius_squared - axis.dot(from_base.cross(direction)).powi(2);
        if discriminant < 0.0 {
            return None;
        }
        let (enter, leave) = roots(a, b, c, axis.length() * discriminant.sqrt());
        let outwards = |t: f64| {
            let at = from_base + t * direction;
            at - at.project_onto(axis)
        };
        Span { enter, leave, enter_normal: outwards(enter), leave_normal: outwards(leave) }
    };
    between_caps.and(round)?.first_hit(ray)
    // <stub> todo!("cut the interval between the caps and the interval in the infinite cylinder")
    // </solution>
}

/// Ray against a cone with its base closed.
///
/// With the axis `A` from apex to base and the moment `L = (o - apex) × d`, the discriminant of the double cone
/// `|x × A|² ≤ k (x·A)²`, `k = r²/|A|²`, is `|A|² (k |A × L|² - (A·L)²)`.
///
/// Where the formula lies: the equation describes two cones, tip to tip, and a ray that passes above the tip meets the
/// mirror image. A ray along the side makes `a` 0, and one steeper than the side makes it negative: then it is inside
/// *outside* of the roots.
pub fn cone(ray: &Ray, cone: &Cone) -> Option<SolidHit> {
    // <solution>
    if !all_finite(ray, &[cone.base, cone.apex]) || ray.direction == Vec3::ZERO {
        return None;
    }
    let direction = ray.direction.as_dvec3();
    let from_apex = ray.origin.as_dvec3() - cone.apex.as_dvec3();
    let axis = cone.base.as_dvec3() - cone.apex.as_dvec3();
    let (height_squared, start, rate) = (axis.length_squared(), from_apex.dot(axis), direction.dot(axis));
    // This also cuts off the mirror image, whose points lie below 0.
    let below_apex = slab(start, rate, [0.0, height_squared], axis)?;

    let k = f64::from(cone.radius).powi(2) / height_squared;
    let (m, n) = (direction.cross(axis), from_apex.cross(axis));
    let (a, b, c) = (m.dot(m) - k * rate * rate, n.dot(m) - k * start * rate, n.dot(n) - k * start * start);
    let moment = from_apex.cross(direction);
    let discriminant = height_squared * (k * axis.cross(moment).length_squared() - axis.dot(moment).powi(2));
    if a > 0.0 && discriminant < 0.0 {
        return None;
    }
    let (first, second) = roots(a, b, c, discriminant.max(0.0).sqrt());
    let (enter, leave) = match () {
        () if a > 0.0 => (first, second),
        // Steeper than the side: from the tip's side in, and never out of this one of the two cones.
        () if a < 0.0 && rate > 0.0 => (second, f64::INFINITY),
        () if a < 0.0 => (f64::NEG_INFINITY, first),
        // Along the side, 2 b t + c ≤ 0 is left.
        () if b > 0.0 => (f64::NEG_INFINITY, -c / (2.0 * b)),
        () if b < 0.0 => (-c / (2.0 * b), f64::INFINITY),
        () if c <= 0.0 => (f64::NEG_INFINITY, f64::INFINITY),
        () => return None,
    };
    // Half the gradient of |x × A|² - k (x·A)².
    let outwards = |t: f64| {
        let at = from_apex + t * direction;
        let gradient = height_squared * at - at.dot(axis) * (1.0 + k) * axis;
        if gradient == DVec3::ZERO { -axis } else { gradient }
    };
    let round = Span { enter, leave, enter_normal: outwards(enter), leave_normal: outwards(leave) };
    below_apex.and(round)?.first_hit(ray)
    // <stub> todo!("cut the interval between tip and base and the interval in the right one of the two cones")
    // </solution>
}

/// Ray against a flat disk, from either side. The rim belongs to it.
pub fn disk(ray: &Ray, disk: &Disk) -> Option<SolidHit> {
    // <solution>
    let (direction, normal) = (ray.direction.as_dvec3(), disk.normal.as_dvec3());
    let to_center = disk.center.as_dvec3() - ray.origin.as_dvec3();
    let t = to_center.dot(normal) / direction.dot(normal);
    let from_center = t * direction - to_center;
    // Written so that NaN, the t of a ray along the disk, fails.
    let inside = from_center.length_squared() <= f64::from(disk.radius).powi(2);
    let hit = SolidHit { t: t as f32, normal: normal.normalize_or_zero().as_vec3() };
    (inside && ray.contains(hit.t)).then_some(hit)
    // <stub> todo!("meet the plane of the disk, then compare the distance to the centre with the radius")
    // </solution>
}

/// Ray against a flat convex polygon, from either side. Edges and corners belong to it.
///
/// Where the formula lies: a point on the plane is rounded, and the rounding decides at the edges. Ask on which side of each
/// edge the ray passes, `d · (p × q)` for its ends `p` and `q` as seen from the origin, and a neighbour agrees.
pub fn polygon(ray: &Ray, polygon: &Polygon) -> Option<SolidHit> {
    // <solution>
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let seen: Vec<DVec3> = polygon.corners.iter().map(|corner| corner.as_dvec3() - origin).collect();
    let edges = || (0..seen.len()).map(|i| (seen[i], seen[(i + 1) % seen.len()]));

    let passes: Vec<f64> = edges().map(|(p, q)| direction.dot(p.cross(q))).collect();
    let (left, right) = (passes.iter().all(|&side| side >= 0.0), passes.iter().all(|&side| side <= 0.0));
    if !(left || right) {
        return None;
    }
    // Newell: the areas that all edges sweep around a corner add up to the normal, and none of them needs to be large.
    let normal: DVec3 = edges().map(|(p, q)| (p - seen[0]).cross(q - seen[0])).sum();
    let hit = SolidHit {
        t: (seen[0].dot(normal) / direction.dot(normal)) as f32,
        normal: normal.normalize_or_zero().as_vec3(),
    };
    ray.contains(hit.t).then_some(hit)
    // <stub> todo!("the ray must pass all edges on the same side; t comes from the plane of the polygon")
    // </solution>
}
