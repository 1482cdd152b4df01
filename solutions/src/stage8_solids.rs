//! Stage 8 · solids: boxes, cylinders, cones, disks and polygons, each in its own space.
//!
//! Slides: `slides/stage08.md`.
//!
//! A convex solid is the intersection of simpler convex sets: a box of three slabs, a cylinder of
//! an infinite cylinder and a slab. A line lies in each of them for one interval of `t`, so it lies
//! in the solid where all intervals overlap, and no end cap needs a test of its own. The first end
//! of the overlap in the ray's range is the hit.
//!
//! All functions have the same contract. `t` counts lengths of the direction, which may have any
//! length but 0. A hit counts if [`Ray::contains`] accepts its `t`. From inside a solid the hit is
//! the point where the ray leaves. The normal has unit length and points out of the solid; at
//! edges, rims and tips each of the possible normals is right. Radii are above 0, axes and normals
//! have any length but 0, and `min` is not above `max`: nothing else is asked.

use glam::DVec3;
use raykata::kit::SolidHit;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Polygon};

// <solution>
/// The part of a line that lies in a convex set, with the outward normals at its ends. It is in
/// double precision: the product of two input numbers of single precision is then exact, and enough
/// digits remain after cancellation.
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

    /// The overlap with another span; `None` if there is none. A common end is an overlap.
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

/// The span in which a line of height `start + t rate` lies between two heights. `up` is the
/// direction of height.
fn slab(start: f64, rate: f64, [low, high]: [f64; 2], up: DVec3) -> Option<Span> {
    if rate == 0.0 {
        // A line parallel to the slab is inside for all t or for no t. Do not divide by a rate of 0
        // or -0.0.
        return (low <= start && start <= high).then_some(Span::WHOLE_LINE);
    }
    let (at_low, at_high) = ((low - start) / rate, (high - start) / rate);
    Some(match rate > 0.0 {
        true => Span { enter: at_low, leave: at_high, enter_normal: -up, leave_normal: up },
        false => Span { enter: at_high, leave: at_low, enter_normal: up, leave_normal: -up },
    })
}

/// The roots of `a t² + 2 b t + c` with `root = √(b² - ac)`, the smaller first, without
/// cancellation.
fn roots(a: f64, b: f64, c: f64, root: f64) -> (f64, f64) {
    let q = -(b + root.copysign(b));
    // q is 0 only if b and the root are 0; then both roots of a t² are 0.
    let (first, second) = if q == 0.0 { (0.0, 0.0) } else { (q / a, c / q) };
    (first.min(second), first.max(second))
}
// </solution>

/// A ray is in a box where its intervals in the three slabs overlap:
///
/// ```text
/// x     ├──────────┤
/// y  ├─────────┤
/// z       ├───────────┤
/// box     ├────┤         → t
/// ```
///
/// What if it starts inside? And what is 0/0, for a ray in the plane of a face?
///
/// Faces, edges and corners belong to the box, which may be flat (`min` equal to `max` on an axis).
/// The normal is that of the face that is hit.
pub fn cuboid(ray: &Ray, cuboid: &Cuboid) -> Option<SolidHit> {
    // <solution>
    // Intersect the intervals of the three slabs.
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let (min, max) = (cuboid.min.as_dvec3(), cuboid.max.as_dvec3());
    let mut span = Span::WHOLE_LINE;
    for (axis, up) in DVec3::AXES.into_iter().enumerate() {
        span = span.and(slab(origin[axis], direction[axis], [min[axis], max[axis]], up)?)?;
    }
    span.first_hit(ray)
    // <stub> todo!("intersect the intervals of the three axes; the first end in the ray's range is the hit")
    // </solution>
}

/// A ray hits a closed cylinder where its intervals in the infinite cylinder and between the end
/// planes overlap. With `A` from base to top and `L = (o - base) × d`, the discriminant is
/// `|d × A|² r² - (A·L)²`. What is `a = |d × A|²` for a ray along the axis?
///
/// Side, ends and rims belong to the cylinder; a ray that only touches the side hits it.
pub fn cylinder(ray: &Ray, cylinder: &Cylinder) -> Option<SolidHit> {
    // <solution>
    // Compute the interval between the planes of the two ends.
    let direction = ray.direction.as_dvec3();
    let from_base = ray.origin.as_dvec3() - cylinder.base.as_dvec3();
    let axis = cylinder.top.as_dvec3() - cylinder.base.as_dvec3();
    let between_caps = slab(from_base.dot(axis), direction.dot(axis), [0.0, axis.length_squared()], axis)?;

    // Compute the quadratic's coefficients for the infinite cylinder |(p + t d) × A|² ≤ r² |A|².
    let radius_squared = f64::from(cylinder.radius).powi(2);
    let (m, n) = (direction.cross(axis), from_base.cross(axis));
    let (a, b, c) = (m.dot(m), n.dot(m), n.dot(n) - radius_squared * axis.length_squared());
    let round = if a == 0.0 {
        // A line parallel to the axis is inside for all t or for no t.
        if c > 0.0 {
            return None;
        }
        Span::WHOLE_LINE
    } else {
        // Compute the discriminant from the distance to the axis, and the two roots.
        let discriminant = a * radius_squared - axis.dot(from_base.cross(direction)).powi(2);
        if discriminant < 0.0 {
            return None;
        }
        let (enter, leave) = roots(a, b, c, axis.length() * discriminant.sqrt());
        // The normal of the side is the part of the point that is perpendicular to the axis.
        let outwards = |t: f64| {
            let at = from_base + t * direction;
            at - at.project_onto(axis)
        };
        Span { enter, leave, enter_normal: outwards(enter), leave_normal: outwards(leave) }
    };
    between_caps.and(round)?.first_hit(ray)
    // <stub> todo!("intersect the interval between the ends with the interval in the infinite cylinder")
    // </solution>
}

/// A closed cone is the part of a double cone between apex and base:
///
/// ```text
/// \ /
///  •  apex
/// /_\ base
/// ```
///
/// With `x` from the apex, `A` from apex to base and `k = r²/|A|²`, it is `|x × A|² ≤ k (x·A)²`;
/// the discriminant is `|A|² (k |A × L|² - (A·L)²)`, `L = (o - apex) × d`. What if `a < 0`?
///
/// Side, base, rim and apex belong to the cone.
pub fn cone(ray: &Ray, cone: &Cone) -> Option<SolidHit> {
    // <solution>
    let direction = ray.direction.as_dvec3();
    let from_apex = ray.origin.as_dvec3() - cone.apex.as_dvec3();
    let axis = cone.base.as_dvec3() - cone.apex.as_dvec3();
    let (height_squared, start, rate) = (axis.length_squared(), from_apex.dot(axis), direction.dot(axis));
    // Compute the interval between apex and base. It excludes the second cone, whose points have
    // negative heights.
    let below_apex = slab(start, rate, [0.0, height_squared], axis)?;

    // Compute the quadratic's coefficients for the double cone, and its discriminant.
    let k = f64::from(cone.radius).powi(2) / height_squared;
    let (m, n) = (direction.cross(axis), from_apex.cross(axis));
    let (a, b, c) = (m.dot(m) - k * rate * rate, n.dot(m) - k * start * rate, n.dot(n) - k * start * start);
    let moment = from_apex.cross(direction);
    let discriminant = height_squared * (k * axis.cross(moment).length_squared() - axis.dot(moment).powi(2));
    if a > 0.0 && discriminant < 0.0 {
        return None;
    }
    // Choose the interval in which the line lies in this cone.
    let (first, second) = roots(a, b, c, discriminant.max(0.0).sqrt());
    let (enter, leave) = if a > 0.0 {
        (first, second)
    } else if a < 0.0 {
        // A ray steeper than the side enters this cone at the larger root, or leaves it at the
        // smaller one.
        if rate > 0.0 { (second, f64::INFINITY) } else { (f64::NEG_INFINITY, first) }
    } else if b != 0.0 {
        // For a ray parallel to the side, 2 b t + c ≤ 0 remains.
        let root = -c / (2.0 * b);
        if b > 0.0 { (f64::NEG_INFINITY, root) } else { (root, f64::INFINITY) }
    } else if c <= 0.0 {
        (f64::NEG_INFINITY, f64::INFINITY)
    } else {
        return None;
    };
    // Compute the normal: half the gradient of |x × A|² - k (x·A)², or -axis at the apex, where the
    // gradient is 0.
    let outwards = |t: f64| {
        let at = from_apex + t * direction;
        let gradient = height_squared * at - at.dot(axis) * (1.0 + k) * axis;
        if gradient == DVec3::ZERO { -axis } else { gradient }
    };
    let round = Span { enter, leave, enter_normal: outwards(enter), leave_normal: outwards(leave) };
    below_apex.and(round)?.first_hit(ray)
    // <stub> todo!("intersect the interval between apex and base with the interval in the right one of the cones")
    // </solution>
}

/// A ray hits a flat disk, from both sides, if it meets the disk's plane at most the radius away
/// from the centre. What is this `t` for a ray parallel to the disk?
///
/// The rim belongs to the disk. The normal is `disk.normal` as a unit vector on both sides. The
/// result is `None` for a ray parallel to the disk.
pub fn disk(ray: &Ray, disk: &Disk) -> Option<SolidHit> {
    // <solution>
    let (direction, normal) = (ray.direction.as_dvec3(), disk.normal.as_dvec3());
    let to_center = disk.center.as_dvec3() - ray.origin.as_dvec3();
    let t = to_center.dot(normal) / direction.dot(normal);
    let from_center = t * direction - to_center;
    // This comparison is false for NaN, which is the t of a ray in the plane of the disk.
    let inside = from_center.length_squared() <= f64::from(disk.radius).powi(2);
    let hit = SolidHit { t: t as f32, normal: normal.normalize_or_zero().as_vec3() };
    (inside && ray.contains(hit.t)).then_some(hit)
    // <stub> todo!("intersect the plane of the disk, then compare the distance from the centre with the radius")
    // </solution>
}

/// A ray hits a flat convex polygon, from both sides, if it passes all edges on the same side: the
/// sign of `d · (p × q)`, for the ends of an edge relative to the ray's origin. Which number does
/// the neighbour at this edge compute? If rounding moved corners off their plane, the triangles of
/// a fan may give other hits near the rim.
///
/// Exactly:
///
/// 1. Edges and corners belong to the polygon; three corners may lie on a line.
/// 2. The normal points to the side from which the corners run anticlockwise, also for rays from
///    behind.
/// 3. A ray in its plane misses it.
/// 4. No ray passes between two polygons that share an edge.
pub fn polygon(ray: &Ray, polygon: &Polygon) -> Option<SolidHit> {
    // <solution>
    // Express the corners relative to the ray's origin.
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let seen: Vec<DVec3> = polygon.corners.iter().map(|corner| corner.as_dvec3() - origin).collect();
    let edges = || (0..seen.len()).map(|i| (seen[i], seen[(i + 1) % seen.len()]));

    // A neighbour computes the same values for the shared edge, up to the sign, so no ray passes
    // between them. A point on the plane would be rounded, and near an edge this decides.
    // Test whether the ray passes all edges on the same side.
    let passes: Vec<f64> = edges().map(|(p, q)| direction.dot(p.cross(q))).collect();
    let (left, right) = (passes.iter().all(|&side| side >= 0.0), passes.iter().all(|&side| side <= 0.0));
    if !(left || right) {
        return None;
    }
    // Compute the normal by Newell's method: sum the areas between each edge and one corner. Single
    // areas may be 0.
    let normal: DVec3 = edges().map(|(p, q)| (p - seen[0]).cross(q - seen[0])).sum();
    // Intersect the plane of the polygon.
    let hit = SolidHit {
        t: (seen[0].dot(normal) / direction.dot(normal)) as f32,
        normal: normal.normalize_or_zero().as_vec3(),
    };
    ray.contains(hit.t).then_some(hit)
    // <stub> todo!("test that the ray passes all edges on the same side; take t from the polygon's plane")
    // </solution>
}
