//! The same questions, answered slowly and simply with big integers: dyadic rationals and textbook formulas;
//! roots are compared by the signs of their polynomials. This module shares no code with the oracle.

mod dyadic;
mod time;

use dyadic::Dyadic;
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cuboid, Cylinder, Disk, Plane, Sphere, Triangle};
use std::cmp::Ordering;
pub use time::Time;

type Vector = [Dyadic; 3];

fn vector(v: Vec3) -> Vector {
    v.to_array().map(|x| Dyadic::new(f64::from(x)))
}

fn number(x: f32) -> Dyadic {
    Dyadic::new(f64::from(x))
}

fn minus(a: &Vector, b: &Vector) -> Vector {
    [0, 1, 2].map(|i| &a[i] - &b[i])
}

fn scaled(s: &Dyadic, a: &Vector) -> Vector {
    [0, 1, 2].map(|i| s * &a[i])
}

fn dot(a: &Vector, b: &Vector) -> Dyadic {
    &(&(&a[0] * &b[0]) + &(&a[1] * &b[1])) + &(&a[2] * &b[2])
}

fn cross(a: &Vector, b: &Vector) -> Vector {
    [(1, 2), (2, 0), (0, 1)].map(|(i, j)| &(&a[i] * &b[j]) - &(&a[j] * &b[i]))
}

/// 0 for a miss, 1 for a touch, 2 for a hit; and the `t` of the hit.
pub type Answer = (u8, Option<Time>);

const MISS: Answer = (0, None);

fn counted(ray: &Ray, time: Time, touches: bool) -> Answer {
    if time.is_in_range(ray) { (if touches { 1 } else { 2 }, Some(time)) } else { MISS }
}

/// Möller and Trumbore 1997.
pub fn triangle(ray: &Ray, triangle: &Triangle) -> Answer {
    let [a, b, c, o, d] = [triangle.a, triangle.b, triangle.c, ray.origin, ray.direction].map(vector);
    let (e1, e2, s) = (minus(&b, &a), minus(&c, &a), minus(&o, &a));
    let (h, q) = (cross(&d, &e2), cross(&s, &e1));
    let det = dot(&e1, &h);
    if det.sign() == 0 {
        return MISS;
    }
    let (beta, gamma) = (dot(&s, &h), dot(&d, &q));
    let alpha = &(&det - &beta) - &gamma;
    let signs = [alpha, beta, gamma].map(|weight| weight.sign() * det.sign());
    if signs.contains(&-1) {
        return MISS;
    }
    counted(ray, Time::ratio(dot(&e2, &q), det), signs.contains(&0))
}

/// The plane through a point.
pub fn plane(ray: &Ray, plane: &Plane) -> Answer {
    let [p, n, o, d] = [plane.point, plane.normal, ray.origin, ray.direction].map(vector);
    let slope = dot(&d, &n);
    if slope.sign() == 0 { MISS } else { counted(ray, Time::ratio(dot(&minus(&p, &o), &n), slope), false) }
}

/// The disk: a plane and a distance.
pub fn disk(ray: &Ray, disk: &Disk) -> Answer {
    let (_, Some(Time::Ratio(n, d))) = plane(ray, &Plane { point: disk.center, normal: disk.normal }) else {
        return MISS;
    };
    let [c, o, direction] = [disk.center, ray.origin, ray.direction].map(vector);
    let (away, along) = (scaled(&d, &minus(&o, &c)), scaled(&n, &direction));
    let offset = [0, 1, 2].map(|i| &away[i] + &along[i]);
    let reach = &d * &number(disk.radius);
    match (&dot(&offset, &offset) - &(&reach * &reach)).sign() {
        _ if disk.radius <= 0.0 => MISS,
        1 => MISS,
        sign => (if sign == 0 { 1 } else { 2 }, Some(Time::Ratio(n, d))),
    }
}

/// The first crossing of a convex solid with these entries and exits.
fn solid(ray: &Ray, entries: Vec<Time>, exits: Vec<Time>) -> Answer {
    let orders: Vec<Ordering> = entries.iter().flat_map(|i| exits.iter().map(move |o| i.cmp(o))).collect();
    if orders.contains(&Ordering::Greater) {
        return MISS;
    }
    let touches = orders.contains(&Ordering::Equal);
    let enter = entries.into_iter().max_by(Time::cmp).expect("a solid has an entry");
    let leave = exits.into_iter().min_by(Time::cmp).expect("a solid has an exit");
    match counted(ray, enter, touches) {
        (0, _) => counted(ray, leave, touches),
        hit => hit,
    }
}

/// Both roots of `a t² + 2 b t + c` with `a > 0`, if there are any.
fn roots(a: Dyadic, b: Dyadic, c: Dyadic) -> Option<[Time; 2]> {
    let disc = &(&b * &b) - &(&a * &c);
    (disc.sign() >= 0)
        .then(|| [false, true].map(|larger| Time::Root(a.clone(), b.clone(), c.clone(), larger)))
}

/// The sphere, by the discriminant `b² - a c`.
pub fn sphere(ray: &Ray, sphere: &Sphere) -> Answer {
    let [center, o, d] = [sphere.center, ray.origin, ray.direction].map(vector);
    let f = minus(&o, &center);
    let r = number(sphere.radius);
    if sphere.radius <= 0.0 || dot(&d, &d).sign() == 0 {
        return MISS;
    }
    let Some([near, far]) = roots(dot(&d, &d), dot(&f, &d), &dot(&f, &f) - &(&r * &r)) else {
        return MISS;
    };
    solid(ray, vec![near], vec![far])
}

/// Entries and exits of the slabs of a box; `None` if the line misses it.
fn slabs(ray: &Ray, min: Vec3, max: Vec3) -> Option<(Vec<Time>, Vec<Time>)> {
    let (mut entries, mut exits) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        let [low, high, o, d] = [min[axis], max[axis], ray.origin[axis], ray.direction[axis]];
        if low > high || (d == 0.0 && (o < low || o > high)) {
            return None;
        }
        if d != 0.0 {
            let at = |end| Time::ratio(&number(end) - &number(o), number(d));
            let (one, two) = (at(low), at(high));
            let (first, last) = if d > 0.0 { (one, two) } else { (two, one) };
            entries.push(first);
            exits.push(last);
        }
    }
    Some((entries, exits))
}

/// The surface of a box.
pub fn cuboid(ray: &Ray, cuboid: &Cuboid) -> Answer {
    match slabs(ray, cuboid.min, cuboid.max) {
        Some((entries, exits)) if !entries.is_empty() => solid(ray, entries, exits),
        _ => MISS,
    }
}

/// Whether the closed segment of the ray meets the closed box.
pub fn overlaps(ray: &Ray, bounds: &Aabb) -> bool {
    let Some((entries, exits)) = slabs(ray, bounds.min, bounds.max) else {
        return false;
    };
    ray.t_min <= ray.t_max
        && entries.iter().all(|entry| exits.iter().all(|exit| entry.cmp(exit).is_le()))
        && entries.iter().all(|entry| entry.cmp_double(f64::from(ray.t_max)).is_le())
        && exits.iter().all(|exit| exit.cmp_double(f64::from(ray.t_min)).is_ge())
}

/// Adds the ends of `0 <= height + slope t <= full`, and intersects the result.
fn between_planes(
    ray: &Ray,
    (slope, height, full): (Dyadic, Dyadic, Dyadic),
    (mut entries, mut exits): (Vec<Time>, Vec<Time>),
) -> Answer {
    if slope.sign() == 0 {
        if height.sign() < 0 || (&height - &full).sign() > 0 {
            return MISS;
        }
    } else {
        let zero = Time::ratio(-&height, slope.clone());
        let top = Time::ratio(&full - &height, slope.clone());
        let (first, last) = if slope.sign() > 0 { (zero, top) } else { (top, zero) };
        entries.push(first);
        exits.push(last);
    }
    solid(ray, entries, exits)
}

/// The cylinder: the parts of origin and direction at right angles to the axis, times `w·w`, against the radius.
pub fn cylinder(ray: &Ray, cylinder: &Cylinder) -> Answer {
    let [base, top, o, d] = [cylinder.base, cylinder.top, ray.origin, ray.direction].map(vector);
    let (w, f, r) = (minus(&top, &base), minus(&o, &base), number(cylinder.radius));
    let full = dot(&w, &w);
    if cylinder.radius <= 0.0 || full.sign() == 0 || dot(&d, &d).sign() == 0 {
        return MISS;
    }
    let (slope, height) = (dot(&d, &w), dot(&f, &w));
    let u = minus(&scaled(&full, &d), &scaled(&slope, &w));
    let v = minus(&scaled(&full, &f), &scaled(&height, &w));
    let reach = &r * &full;
    let c = &dot(&v, &v) - &(&reach * &reach);
    let slab = (slope, height, full);
    if dot(&u, &u).sign() == 0 {
        return if c.sign() > 0 { MISS } else { between_planes(ray, slab, (vec![], vec![])) };
    }
    match roots(dot(&u, &u), dot(&u, &v), c) {
        None => MISS,
        Some([near, far]) => between_planes(ray, slab, (vec![near], vec![far])),
    }
}

/// The cone: `w·w (|w|² |x|² - (x·w)²) <= r² (x·w)²`.
pub fn cone(ray: &Ray, cone: &Cone) -> Answer {
    let [base, apex, o, d] = [cone.base, cone.apex, ray.origin, ray.direction].map(vector);
    let (w, q, r) = (minus(&base, &apex), minus(&o, &apex), number(cone.radius));
    let full = dot(&w, &w);
    if cone.radius <= 0.0 || full.sign() == 0 || dot(&d, &d).sign() == 0 {
        return MISS;
    }
    let (slope, height) = (dot(&d, &w), dot(&q, &w));
    let square = &full + &(&r * &r);
    let form = |x: &Vector, y: &Vector| {
        let (along_x, along_y) = (dot(x, &w), dot(y, &w));
        &(&(&full * &full) * &dot(x, y)) - &(&square * &(&along_x * &along_y))
    };
    let (a, b, c) = (form(&d, &d), form(&d, &q), form(&q, &q));
    let upward = slope.sign() > 0;
    let slab = (slope, height, full.clone());
    match (a.sign(), b.sign()) {
        (0, 0) if c.sign() > 0 => MISS,
        (0, 0) => between_planes(ray, slab, (vec![], vec![])),
        (0, sign) => {
            let crossing = vec![Time::ratio(-&c, &b + &b)];
            let ends = if sign < 0 { (crossing, vec![]) } else { (vec![], crossing) };
            between_planes(ray, slab, ends)
        }
        (1, _) => match roots(a, b, c) {
            None => MISS,
            Some([near, far]) => between_planes(ray, slab, (vec![near], vec![far])),
        },
        _ => {
            let [near, far] = roots(-&a, -&b, -&c).expect("steeper than the surface");
            let ends = if upward { (vec![far], vec![]) } else { (vec![], vec![near]) };
            between_planes(ray, slab, ends)
        }
    }
}
