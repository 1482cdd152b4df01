//! Known mistakes in the functions for solids, each with the answer that it gives, in double precision.
//!
//! A mistake explains an answer if both are hits at the same `t`, or both are misses.

use checks::double::{LIMITS, slab_interval};
use checks::prelude::*;
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Polygon};

/// Mistakes, each with whether it gives the student's answer.
pub(super) type Mistakes = Vec<(bool, &'static str)>;

/// Wrong normals of any length, each with the mistake that gives it.
pub(super) type WrongNormals = Vec<(DVec3, &'static str)>;

/// Whether `t` is that of a mistake. Mistakes that students make in single precision have an error of a few hundred
/// roundings; two ends of the solids in the checks are farther apart than this.
pub(super) fn is_near(ray: &Ray, t: f32, wrong: f64) -> bool {
    let unit = 1.0 / ray.direction.as_dvec3().length();
    (f64::from(t) - wrong).abs() <= 1e-3 * wrong.abs().max(unit)
}

/// The first of some `t` that lies in the range of the ray.
fn first(ray: &Ray, ts: impl IntoIterator<Item = f64>) -> Option<f64> {
    let contains = |t: &f64| f64::from(ray.t_min) < *t && *t < f64::from(ray.t_max);
    ts.into_iter().filter(contains).reduce(f64::min)
}

/// Whether both are misses, or both are hits that are `near` to each other.
pub(super) fn agree<A, B>(yours: Option<A>, other: Option<B>, near: impl FnOnce(A, B) -> bool) -> bool {
    match (yours, other) {
        (None, None) => true,
        (Some(yours), Some(other)) => near(yours, other),
        _ => false,
    }
}

/// Whether the answer is that of a mistake.
fn is(ray: &Ray, yours: Option<f32>, wrong: Option<f64>) -> bool {
    agree(yours, wrong, |t, wrong| is_near(ray, t, wrong))
}

pub(super) fn of_cuboid(query: &SolidQuery<Cuboid>, yours: Option<f32>, _: f64) -> Mistakes {
    let SolidQuery { ray, solid } = query;
    let bounds = Aabb::new(solid.min, solid.max);
    let without = |axis: usize| {
        let [p, q] = [1, 2].map(|next| slab_interval(ray, &bounds, (axis + next) % 3));
        let (enter, leave) = (p.0.max(q.0), p.1.min(q.1));
        is(ray, yours, first(ray, [enter, leave]).filter(|_| enter <= leave))
    };
    vec![
        (without(0), "you leave out the x axis: intersect the intervals of all three axes"),
        (without(1), "you leave out the y axis: intersect the intervals of all three axes"),
        (without(2), "you leave out the z axis: intersect the intervals of all three axes"),
    ]
}

pub(super) fn normals_of_cuboid(cuboid: &Cuboid, at: DVec3) -> WrongNormals {
    let from_middle = at - 0.5 * (cuboid.min.as_dvec3() + cuboid.max.as_dvec3());
    let farthest = from_middle.abs().max_position();
    let axis = DVec3::AXES[farthest] * from_middle[farthest];
    named![
        from_middle => "you return the direction from the centre of the box to the hit: that is the normal of a sphere",
        axis => "you return the axis along which the hit is farthest from the centre, which is right for a cube only",
    ].to_vec()
}

/// The real roots of `a t² + 2 b t + c`.
fn roots(a: f64, b: f64, c: f64) -> Vec<f64> {
    let discriminant = b * b - a * c;
    // A ray through an apex has a discriminant of 0, up to rounding errors.
    let discriminant = if discriminant.abs() < 1e-12 * b * b { 0.0 } else { discriminant };
    match a == 0.0 {
        true if b == 0.0 => Vec::new(),
        true => vec![-c / (2.0 * b)],
        false if discriminant < 0.0 => Vec::new(),
        false => [-1.0, 1.0].map(|sign| (-b + sign * discriminant.sqrt()) / a).to_vec(),
    }
}

/// The line along a ray, relative to a point of an axis of rotation.
struct AroundAxis {
    start: DVec3,
    direction: DVec3,
    axis: DVec3,
}

impl AroundAxis {
    fn new(ray: &Ray, origin: Vec3, end: Vec3) -> AroundAxis {
        let origin = origin.as_dvec3();
        let (start, direction) = (ray.origin.as_dvec3() - origin, ray.direction.as_dvec3());
        AroundAxis { start, direction, axis: end.as_dvec3() - origin }
    }

    /// The position along the axis: 0 at its origin, 1 at its end.
    fn height(&self, t: f64) -> f64 {
        (self.start + t * self.direction).dot(self.axis) / self.axis.length_squared()
    }

    /// The `t` at a position along the axis.
    fn at_height(&self, height: f64) -> f64 {
        (height - self.height(0.0)) * self.axis.length_squared() / self.direction.dot(self.axis)
    }

    /// The distance from the axis.
    fn distance(&self, t: f64) -> f64 {
        (self.start + t * self.direction).cross(self.axis).length() / self.axis.length()
    }

    /// Where the line meets the double cone whose radius is `slope` per length of the axis.
    fn cone(&self, slope: f64) -> Vec<f64> {
        let (m, n) = (self.direction.cross(self.axis), self.start.cross(self.axis));
        let (rate, start) = (self.direction.dot(self.axis), self.start.dot(self.axis));
        let k = slope * slope;
        roots(m.dot(m) - k * rate * rate, n.dot(m) - k * start * rate, n.dot(n) - k * start * start)
    }
}

const LIMITED: &str =
    "you compare the product of the direction with a limit, but a ray is parallel only if it is 0";

pub(super) fn of_cylinder(query: &SolidQuery<Cylinder>, yours: Option<f32>, scale: f64) -> Mistakes {
    let SolidQuery { ray, solid } = query;
    let line = AroundAxis::new(ray, solid.base, solid.top);
    let radius = f64::from(solid.radius);
    let (m, n) = (line.direction.cross(line.axis), line.start.cross(line.axis));
    let endless = roots(m.dot(m), n.dot(m), n.dot(n) - radius * radius * line.axis.length_squared());
    let side: Vec<f64> = endless.iter().copied().filter(|t| (0.0..=1.0).contains(&line.height(*t))).collect();
    let end = |height: f64| Some(line.at_height(height)).filter(|t| line.distance(*t) <= radius);
    let (base, top) = (end(0.0), end(1.0));
    let only = |ends: &[Option<f64>], side: &[f64]| {
        let all = ends.iter().flatten().chain(side).copied();
        is(ray, yours, first(ray, all))
    };
    // The same cylinder whose radius is not squared.
    let endless_of_root = roots(m.dot(m), n.dot(m), n.dot(n) - radius * line.axis.length_squared());
    let side_of_root = endless_of_root.into_iter().filter(|t| (0.0..=1.0).contains(&line.height(*t)));
    let ends_of_root = [0.0, 1.0].map(|height| line.at_height(height));
    let ends_of_root = ends_of_root.into_iter().filter(|t| line.distance(*t) <= radius.sqrt());
    let of_root = is(ray, yours, first(ray, side_of_root.chain(ends_of_root)));
    // A cylinder with another radius, or with ends at other heights.
    let other = |radius: f64, low: f64, high: f64| {
        let squared = radius * radius * line.axis.length_squared();
        let side = roots(m.dot(m), n.dot(m), n.dot(n) - squared).into_iter();
        let side = side.filter(|t| (low - 1e-9..=high + 1e-9).contains(&line.height(*t)));
        let ends = [low, high].map(|height| line.at_height(height)).into_iter();
        is(ray, yours, first(ray, side.chain(ends.filter(|t| line.distance(*t) <= radius))))
    };
    let unit = 1.0 / line.axis.length();
    let is_between = (0.0..=1.0).contains(&line.height(0.0));
    let rate = scale * line.direction.dot(line.axis).abs();
    let limited = LIMITS.map(|limit| match rate < limit {
        true => only(&[], if is_between { &endless } else { &[] }),
        false => only(&[base, top], &side),
    });
    let mut all = vec![
        (only(&[], &side), "you leave out the ends: a ray can enter or leave through them"),
        (only(&[base], &side), "you leave out the end at `top`: a ray can enter or leave through it"),
        (only(&[top], &side), "you leave out the end at `base`: a ray can enter or leave through it"),
        (only(&[base, top], &[]), "you leave out the side: only the ends are hit"),
        (other(radius, 0.0, unit), "your cylinder has the height 1: its axis goes from `base` to `top`"),
        "your cylinder goes from `base` both ways: its axis goes from `base` to `top`"
            .when(other(radius, -1.0, 1.0)),
        (other(radius, 0.0, 0.5), "your cylinder ends halfway: its axis goes from `base` to `top`"),
        (other(2.0 * radius, 0.0, 1.0), "you take the diameter for the radius"),
        (other(0.5 * radius, 0.0, 1.0), "you take the radius for the diameter"),
        (of_root, "you use the radius in place of its square: the distance from the axis is squared, too"),
        (
            match endless.first().is_none_or(|enter| *enter <= f64::from(ray.t_min)) {
                true => yours.is_none(),
                false => only(&[base, top], &side),
            },
            "you give up because the ray enters the infinite cylinder before t_min: it can still enter through an end, or \
             leave",
        ),
        "your cylinder has no ends: it goes on beyond `base` and `top`"
            .when(only(&[], &endless) || (endless.is_empty() && yours.is_none_or(|t| t > 1e3))),
    ];
    all.extend(limited.map(|gives| (gives, LIMITED)));
    all
}

pub(super) fn normals_of_cylinder(cylinder: &Cylinder, at: DVec3) -> WrongNormals {
    let (base, axis) = (cylinder.base.as_dvec3(), (cylinder.top - cylinder.base).as_dvec3());
    let outwards = (at - base).reject_from(axis);
    let middle = base + 0.5 * axis;
    vec![
        (outwards, "you return the normal of the side for a hit on an end: it is the axis there"),
        (-outwards, "the normal of your side points to the axis: it must point outwards"),
        (at - base, "you return the direction from `base` to the hit: subtract its part along the axis"),
        (at - middle, "you return the direction from the centre to the hit: that is the normal of a sphere"),
    ]
}

pub(super) fn of_cone(query: &SolidQuery<Cone>, yours: Option<f32>, _: f64) -> Mistakes {
    let SolidQuery { ray, solid } = query;
    let line = &AroundAxis::new(ray, solid.apex, solid.base);
    let (radius, height) = (f64::from(solid.radius), line.axis.length());
    let within = |slope: f64, low: f64, high: f64| {
        line.cone(slope).into_iter().filter(move |t| (low - 1e-9..=high + 1e-9).contains(&line.height(*t)))
    };
    let end = |at: f64, radius: f64| Some(line.at_height(at)).filter(|t| line.distance(*t) <= radius);
    let base = |radius: f64| end(1.0, radius);
    let unit = 1.0 / height;
    let slope = radius / height;
    let endless = within(slope, 0.0, f64::INFINITY);
    let double = within(slope, f64::NEG_INFINITY, 1.0).chain(base(radius));
    let exchanged = within(height / radius, 0.0, 1.0).chain(base(height * height / radius));
    let not_squared = within(slope.sqrt(), 0.0, 1.0).chain(base(slope.sqrt() * height));
    let no_end = endless.clone().next().is_none();
    let hits = |ts: &mut dyn Iterator<Item = f64>| is(ray, yours, first(ray, ts));
    let side = |high: f64| within(slope, 0.0, high);
    named![
        hits(&mut side(1.0)) => "you leave out the base: a ray can enter or leave through it",
        hits(&mut base(radius).into_iter()) => "you leave out the side: only the base is hit",
        hits(&mut side(0.5).chain(end(0.5, 0.5 * radius))) => "your base lies halfway to the apex: it is at `base`",
        hits(&mut side(unit).chain(end(unit, radius * unit))) =>
            "your cone has the height 1: its axis goes from `apex` to `base`",
        hits(&mut endless.clone()) || (no_end && yours.is_none_or(|t| t > 1e3)) =>
            "your cone has no base: it goes on beyond `base`",
        hits(&mut not_squared.clone()) => "you do not square the slope of the side, radius / height",
        hits(&mut double.clone()) =>
            "you return a point of the second cone, above the apex, which is not part of the solid",
        hits(&mut exchanged.clone()) =>
            "you exchange radius and height in the slope of the surface: it is radius / height",
    ]
    .to_vec()
}

pub(super) fn normals_of_cone(cone: &Cone, at: DVec3) -> WrongNormals {
    let (apex, axis) = (cone.apex.as_dvec3(), (cone.base - cone.apex).as_dvec3());
    named![
        (at - apex).reject_from(axis) =>
            "you return the normal of a cylinder, perpendicular to the axis: the side of a cone is inclined",
        at - cone.base.as_dvec3() => "you return the direction from `base` to the hit: that is the normal of a sphere",
    ].to_vec()
}

pub(super) const OUTSIDE: &str = "you return a point of the plane that lies outside of the shape";

/// What flat shapes have in common: `t` in the plane, which side the ray comes from, and whether the point is inside.
fn of_flat(ray: &Ray, yours: Option<f32>, t: f64, slope: f64, inside: bool) -> Mistakes {
    let found_if = |is_found: bool| is(ray, yours, first(ray, [t]).filter(|_| is_found));
    vec![
        (found_if(true), OUTSIDE),
        "you lose one of its two sides, the one to which its normal points: a ray can hit it from both"
            .when(found_if(inside && slope > 0.0)),
        "you lose one of its two sides, the one behind its normal: a ray can hit it from both"
            .when(found_if(inside && slope < 0.0)),
    ]
}

pub(super) fn of_disk(query: &SolidQuery<Disk>, yours: Option<f32>, scale: f64) -> Mistakes {
    let SolidQuery { ray, solid } = query;
    let (normal, direction) = (solid.normal.as_dvec3(), ray.direction.as_dvec3());
    let to_center = solid.center.as_dvec3() - ray.origin.as_dvec3();
    let slope = direction.dot(normal);
    let t = to_center.dot(normal) / slope;
    let (squared, radius) = ((t * direction - to_center).length_squared(), f64::from(solid.radius));
    let wrong = |inside: bool| is(ray, yours, first(ray, [t]).filter(|_| inside));
    let mut all = vec![
        (wrong(squared <= radius), "you compare the square of the distance with the radius: square both"),
        "you compare the distance with the square of the radius: square both or none"
            .when(wrong(squared.sqrt() <= radius * radius)),
    ];
    all.extend(of_flat(ray, yours, t, slope, squared <= radius * radius));
    let is_kept = |limit: f64| squared <= radius * radius && scale * slope.abs() >= limit;
    all.extend(LIMITS.map(|limit| (wrong(is_kept(limit)), LIMITED)));
    all
}

pub(super) fn of_polygon(query: &SolidQuery<Polygon>, yours: Option<f32>, _: f64) -> Mistakes {
    let SolidQuery { ray, solid } = query;
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let corners: Vec<DVec3> = solid.corners.iter().map(|corner| corner.as_dvec3() - origin).collect();
    let edges = || (0..corners.len()).map(|i| (corners[i], corners[(i + 1) % corners.len()]));
    let normal: DVec3 = edges().map(|(p, q)| (p - corners[0]).cross(q - corners[0])).sum();
    let slope = direction.dot(normal);
    let t = corners[0].dot(normal) / slope;
    // Whether all of some numbers have the same sign.
    let same_sign =
        |sides: &[f64]| sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0);
    let passes = |[p, q, r]: [DVec3; 3]| {
        same_sign(&[p.cross(q), q.cross(r), r.cross(p)].map(|normal| normal.dot(direction)))
    };
    let fan = |number: usize| passes([corners[0], corners[number], corners[number + 1]]);
    let inside = (1..corners.len() - 1).any(fan);
    let wrong = |inside: bool| is(ray, yours, first(ray, [t]).filter(|_| inside));
    let twice: Vec<f64> = edges()
        .map(|(p, q)| p.cross(q))
        .zip(edges())
        .map(|(n, (p, _))| n.dot(direction) - n.dot(p + origin))
        .collect();
    let mut all = named![
        wrong(fan(1)) => "you test the first triangle of the fan only",
        wrong((1..3.min(corners.len() - 1)).any(fan)) =>
            "you test the first two triangles of the fan only: n corners make n - 2 triangles",
        wrong(same_sign(&twice)) => "you subtract a corner twice: the plane of an edge passes through the ray's origin",
        wrong(inside) || (yours.is_none() && normal.z.abs() < 0.1 * normal.length()) =>
            "you lose upright polygons: drop the axis along which the normal is longest, not always z",
    ].to_vec();
    all.extend(of_flat(ray, yours, t, slope, inside));
    all
}
