//! Known hard cases, each with its name.

use crate::exact::{
    Body, Contact, Meeting, Tier, aabb, meet, meet_with, order, polygon, sphere, triangle, verdict,
};
use glam::{Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cylinder, Disk, Plane, Polygon, Sphere, Triangle};
use std::cmp::Ordering;

const UNIT: Triangle = Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y };

fn triangle(a: [f32; 3], b: [f32; 3], c: [f32; 3]) -> Body {
    Body::Triangle(Triangle { a: a.into(), b: b.into(), c: c.into() })
}

fn ray(o: [f32; 3], d: [f32; 3]) -> Ray {
    Ray::new(o.into(), d.into())
}

fn met(ray: &Ray, body: Body) -> (Contact, Option<f32>) {
    let Meeting { verdict, t } = meet(ray, body).expect("all is finite");
    (verdict, t)
}

const MISS: (Contact, Option<f32>) = (Contact::Out, None);

#[test]
fn triangles_edges_corners_and_slivers() {
    // tri/exact-edge, tri/vertex-fan: every edge and corner is part of the triangle.
    for (x, y, verdict) in [
        (0.25, 0.25, Contact::In),
        (0.5, 0.5, Contact::On),
        (0.5, 0.0, Contact::On),
        (0.0, 0.0, Contact::On),
        (1.0, 0.0, Contact::On),
        (0.5, 0.5f32.next_up(), Contact::Out),
        (0.5, -f32::from_bits(1), Contact::Out),
    ] {
        assert_eq!(met(&ray([x, y, 2.0], [0.0, 0.0, -4.0]), Body::Triangle(UNIT)).0, verdict, "{x} {y}");
    }
    // The determinant of the slides is wrong for this triangle.
    let steep = triangle([0.0, 0.0, 0.0], [-1.0, -1.0, 0.0], [-1.0, -1.0, -1.0]);
    assert_eq!(met(&ray([-2.5, -4.5, -6.25], [1.0, 2.0, 3.0]), steep), (Contact::In, Some(2.0)));
    // tri/needle, tri/tiny, tri/scale: the same triangle at any scale.
    for scale in [1.0, (-140f32).exp2(), 100f32.exp2()] {
        let [a, b, c] = [UNIT.a, UNIT.b, UNIT.c].map(|p| p * scale);
        let ray = Ray::new(vec3(0.25, 0.25, 1.0) * scale, Vec3::NEG_Z);
        assert_eq!(met(&ray, Body::Triangle(Triangle { a, b, c })), (Contact::In, Some(scale)));
    }
    // tri/both-windings, tri/permuted-vertices.
    let corners = [vec3(0.1, 0.2, 0.3), vec3(5.0, -1.0, 0.7), vec3(0.3, 4.0, -0.2)];
    let ray = ray([1.0, 1.0, 9.0], [0.01, -0.02, -1.0]);
    let answers = [[0, 1, 2], [1, 2, 0], [2, 1, 0], [0, 2, 1]]
        .map(|[i, j, k]| met(&ray, Body::Triangle(Triangle { a: corners[i], b: corners[j], c: corners[k] })));
    assert!(answers.iter().all(|answer| *answer == answers[0] && answer.0 == Contact::In));
}

#[test]
fn triangles_missed() {
    // tri/coplanar, tri/degenerate with two and three equal corners, pbrt's collinear one, tri/behind.
    assert_eq!(met(&ray([-1.0, 0.25, 0.0], [1.0, 0.0, 0.0]), Body::Triangle(UNIT)), MISS);
    for (a, b) in [([0.0; 3], [0.0; 3]), ([0.0; 3], [1.0, 1.0, 1.0])] {
        assert_eq!(met(&ray([1.0, 2.0, 3.0], [-1.0, -2.0, -3.0]), triangle(a, a, b)), MISS);
    }
    let line = triangle([0.3, 1.0, 0.7], [0.3, -2.0, 0.7], [0.3, 8.0, 0.7]);
    assert_eq!(met(&ray([0.0, 0.0, 0.0], [0.3, 1.0, 0.7]), line), MISS);
    assert_eq!(met(&ray([0.25, 0.25, 2.0], [0.0, 0.0, 1.0]), Body::Triangle(UNIT)), MISS);
    // tri/on-plane-origin: the range is open, at 0 as elsewhere.
    assert_eq!(met(&ray([0.25, 0.25, 0.0], [0.0, 0.0, 1.0]), Body::Triangle(UNIT)), MISS);
    let third = ray([0.25, 0.25, 1.0], [0.0, 0.0, -3.0]);
    let rounded = 1.0f32 / 3.0;
    assert_eq!(met(&third, Body::Triangle(UNIT)), (Contact::In, Some(rounded)));
    // Above 1/3 when rounded, so that the exact t lies below it.
    assert!(rounded > 1.0 / 3.000_000_2 && f64::from(rounded) > 1.0 / 3.0);
    assert_eq!(met(&third.with_range(0.0, rounded), Body::Triangle(UNIT)).0, Contact::In);
    assert_eq!(met(&third.with_range(rounded, 1.0), Body::Triangle(UNIT)), MISS);
    assert_eq!(met(&third.with_range(0.0, rounded.next_down()), Body::Triangle(UNIT)), MISS);
}

#[test]
fn no_special_value_panics() {
    let values = [0.0, -0.0, f32::from_bits(1), f32::MAX, f32::INFINITY, f32::NAN];
    // Points and directions go through all pairs of values.
    for i in 0..6usize.pow(4) {
        let value = |k: u32| values[i / 6usize.pow(k % 4) % 6];
        let vector = |k| vec3(value(k), value(k + 1), value(k + 3));
        let ray = Ray::new(vector(0), vector(1)).with_range(value(2), value(3));
        let (a, b, c, radius) = (vector(2), vector(3), Vec3::ONE, value(1));
        let finite = |v: &[Vec3]| v.iter().all(|v| v.is_finite());
        let ray_counts = finite(&[ray.origin, ray.direction]) && !ray.t_min.is_nan() && !ray.t_max.is_nan();
        for body in [
            Body::Triangle(Triangle { a, b, c }),
            Body::Plane(Plane { point: a, normal: b }),
            Body::Disk(Disk { center: a, normal: b, radius }),
            Body::Sphere(Sphere { center: a, radius }),
            Body::Cylinder(Cylinder { base: a, top: b, radius }),
            Body::Cone(Cone { base: a, apex: b, radius }),
        ] {
            let answer = meet(&ray, body);
            assert_eq!(answer.is_some(), ray_counts && body.is_finite(), "{ray:?} {body:?}");
            assert!(answer.is_none_or(|answer| !answer.t.is_some_and(f32::is_nan)));
            assert_eq!(crate::exact::t_in_double(&ray, body).is_some(), answer.is_some());
        }
        let _ = aabb::overlap(&ray, &Aabb::new(a, b));
        let _ = sphere::roots(&ray, &Sphere { center: a, radius });
        let _ = (triangle::margin(&ray, &UNIT), triangle::weights(&ray, &Triangle { a, b, c }));
        let _ = polygon::meet_fan(&ray, &Polygon { corners: vec![a, b, c, Vec3::X] });
        let _ = triangle::tie_set(&ray, &[UNIT, Triangle { a, b, c }]);
    }
}

#[test]
fn ties_margins_weights_and_errors_of_t() {
    // Two triangles share a diagonal, a third lies in their plane as well, a fourth is farther by an ulp.
    let other = Triangle { a: vec3(1.0, 1.0, 0.0), b: Vec3::Y, c: Vec3::X };
    let covering = Triangle { a: vec3(-9.0, -9.0, 0.0), b: vec3(9.0, -9.0, 0.0), c: vec3(0.0, 9.0, 0.0) };
    let down =
        |t: Triangle| Triangle { a: t.a - 1e-7 * Vec3::Z, b: t.b - 1e-7 * Vec3::Z, c: t.c - 1e-7 * Vec3::Z };
    let soup = [down(covering), UNIT, other, covering, down(UNIT)];
    let at = |x, y| Ray::new(vec3(x, y, 1.0), Vec3::NEG_Z);
    assert_eq!(triangle::tie_set(&at(0.5, 0.5), &soup), [1, 2, 3]);
    assert_eq!(triangle::tie_set(&at(0.75, 0.75), &soup), [2, 3]);
    assert_eq!(triangle::tie_set(&at(50.0, 0.5), &soup), []);
    let bodies = soup.map(Body::Triangle);
    assert_eq!(order(&at(0.5, 0.5), bodies[0], bodies[1]), Some(Ordering::Greater));
    assert_eq!(order(&at(0.5, 0.5), bodies[1], bodies[3]), Some(Ordering::Equal));

    // tri/on an edge: margin 0. One ulp off it: a margin of about one.
    assert_eq!(triangle::margin(&at(0.5, 0.5), &UNIT), Some(0.0));
    let near = triangle::margin(&at(0.5, 0.5f32.next_up()), &UNIT).unwrap();
    assert!(near > 0.2 && near < 4.0, "{near}");
    assert!(triangle::margin(&at(0.25, 0.25), &UNIT).unwrap() > 1e6);
    assert_eq!(triangle::weights(&at(0.25, 0.5), &UNIT), Some(Some([0.25, 0.5])));
    assert_eq!(triangle::weights(&Ray::new(Vec3::ZERO, Vec3::X), &UNIT), Some(None));

    let third = Ray::new(vec3(0.25, 0.25, 1.0), vec3(0.0, 0.0, -3.0));
    let error = crate::exact::t_error_in_ulps(&third, bodies[1], (1.0f32 / 3.0).next_up()).unwrap();
    assert!((error - 4.0 / 3.0).abs() < 1e-6, "{error}");
    assert_eq!(crate::exact::t_error_in_ulps(&at(9.0, 9.0), bodies[1], 1.0), None);
}

#[test]
fn spheres_and_planes() {
    let sphere = |c: [f32; 3], radius| Body::Sphere(Sphere { center: c.into(), radius });
    let unit = sphere([0.0; 3], 1.0);
    let along_x = |x: f32, y: f32| ray([x, y, 0.0], [1.0, 0.0, 0.0]);
    // sph/inside, behind, tangent-exact and one ulp to either side, r = 0 and below.
    assert_eq!(met(&along_x(0.0, 0.0), unit), (Contact::In, Some(1.0)));
    assert_eq!(met(&along_x(5.0, 0.0), unit), MISS);
    assert_eq!(met(&along_x(-5.0, 1.0), unit), (Contact::On, Some(5.0)));
    assert_eq!(met(&along_x(-5.0, 1.0f32.next_up()), unit), MISS);
    assert_eq!(met(&along_x(-5.0, 1.0f32.next_down()), unit).0, Contact::In);
    assert_eq!(met(&along_x(-5.0, 0.0), sphere([0.0; 3], 0.0)), MISS);
    assert_eq!(met(&along_x(-5.0, 0.0), sphere([0.0; 3], -1.0)), MISS);
    // sph/far, ground, on-surface-outward, and a direction that is not of unit length.
    assert_eq!(met(&along_x(-1e5, 0.0), unit), (Contact::In, Some(99_999.0)));
    assert_eq!(
        met(&ray([0.0, 1.0, 0.0], [0.0, -1.0, 0.0]), sphere([0.0, -1e5, 0.0], 1e5)),
        (Contact::In, Some(1.0))
    );
    assert_eq!(met(&along_x(1.0, 0.0), unit), MISS);
    let roots = sphere::roots(&along_x(-1.0, 0.0), &Sphere { center: Vec3::ZERO, radius: 1.0 }).unwrap();
    assert_eq!((roots.discriminant, roots.near_counts, roots.far_counts), (1, false, true));
    for k in [-100, -30, 30, 100] {
        let scale = (k as f32).exp2();
        let (_, t) = met(&Ray::new(vec3(-5.0, 0.3, 0.1), vec3(1.0, 0.01, 0.0) * scale), unit);
        let (_, whole) = met(&Ray::new(vec3(-5.0, 0.3, 0.1), vec3(1.0, 0.01, 0.0)), unit);
        assert_eq!(t.map(|t| t * scale), whole);
    }
    // Spheres in order, equal surds included: √2 from two spheres.
    // Along (1, 1, 0) both are left at t = √½: from 0, and from (-1, 1, 0), which is √2 away from the same point.
    let diagonal = ray([0.0; 3], [1.0, 1.0, 0.0]);
    assert_eq!(met(&diagonal, unit), (Contact::In, Some(0.5f32.sqrt())));
    assert_eq!(order(&diagonal, unit, unit), Some(Ordering::Equal));
    assert_eq!(
        order(&diagonal, unit, sphere([-1.0, 1.0, 0.0], 3f32.sqrt())),
        Some(if f64::from(3f32.sqrt()).powi(2) < 3.0 { Ordering::Greater } else { Ordering::Less })
    );
    assert_eq!(order(&along_x(-5.0, 0.0), sphere([0.5, 0.0, 0.0], 1.5), unit), Some(Ordering::Equal));
    assert_eq!(
        order(&along_x(-5.0, 0.25), unit, sphere([0.0; 3], 1.0f32.next_up())),
        Some(Ordering::Greater)
    );

    // pl/parallel and pl/in-plane.
    let floor = Body::Plane(Plane { point: Vec3::ZERO, normal: vec3(0.0, 3.0, 0.0) });
    assert_eq!(met(&along_x(-5.0, 1.0), floor), MISS);
    assert_eq!(met(&along_x(-5.0, 0.0), floor), MISS);
    assert_eq!(met(&ray([0.0, 1.0, 0.0], [1.0, -4.0, 0.0]), floor), (Contact::In, Some(0.25)));
}

#[test]
fn t_is_rounded_to_nearest_even() {
    let big = 24f32.exp2();
    let wall = |x| Body::Plane(Plane { point: vec3(x, 0.0, 0.0), normal: Vec3::X });
    let sphere = |x| Body::Sphere(Sphere { center: vec3(x + 2.0, 0.0, 0.0), radius: 2.0 });
    // From x = -1 both lie half way between two numbers, at 2^24 + 1 and at 2^24 + 3.
    let along_x = ray([-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]);
    for tier in [Tier::Auto, Tier::Small, Tier::Narrow, Tier::Widest] {
        for (x, rounded) in [(big, big), (big + 2.0, big + 4.0)] {
            let t = |body| meet_with(tier, &along_x, body).and_then(|meeting| meeting.t);
            assert!(t(wall(x)).is_none_or(|t| t == rounded), "{tier:?} {x}");
            assert!(t(sphere(x)).is_none_or(|t| t == rounded), "{tier:?} {x}");
            assert!(t(wall(x)).is_some() || tier == Tier::Small);
        }
    }
    // Beyond the largest number a hit is a hit, and its t is rounded to infinity; below the smallest, to zero.
    let slow = Ray::new(Vec3::ZERO, vec3(1e-30, 0.0, 0.0));
    assert_eq!(met(&slow, wall(1e30)), (Contact::In, Some(f32::INFINITY)));
    assert_eq!(met(&Ray::new(Vec3::ZERO, vec3(1e30, 0.0, 0.0)), wall(1e-30)), (Contact::In, Some(0.0)));
}

#[test]
fn cylinders_and_cones() {
    let can = Body::Cylinder(Cylinder { base: Vec3::ZERO, top: vec3(0.0, 0.0, 2.0), radius: 1.0 });
    let tip = Body::Cone(Cone { base: Vec3::ZERO, apex: Vec3::Z, radius: 1.0 });
    // cyl/axis-parallel with either zero, cyl/rim, cyl/tangent-side.
    for zero in [0.0, -0.0] {
        assert_eq!(met(&ray([0.5, 0.0, -1.0], [zero, zero, 1.0]), can), (Contact::In, Some(1.0)));
        assert_eq!(met(&ray([1.0, 0.0, -1.0], [zero, zero, 1.0]), can).0, Contact::In);
        assert_eq!(met(&ray([1.0f32.next_up(), 0.0, -1.0], [zero, zero, 1.0]), can), MISS);
    }
    assert_eq!(met(&ray([2.0, 0.0, -1.0], [-1.0, 0.0, 1.0]), can), (Contact::In, Some(1.0)));
    assert_eq!(met(&ray([2.0, 0.0, 1.0], [-1.0, 0.0, -1.0]), can), (Contact::On, Some(1.0)));
    assert_eq!(met(&ray([-3.0, 1.0, 1.0], [1.0, 0.0, 0.0]), can), (Contact::On, Some(3.0)));
    assert_eq!(met(&ray([-3.0, 1.0f32.next_up(), 1.0], [1.0, 0.0, 0.0]), can), MISS);
    // cone/apex, mirror-nappe, generator-parallel and along a generator.
    assert_eq!(met(&ray([-3.0, 0.0, 1.0], [1.0, 0.0, 0.0]), tip), (Contact::On, Some(3.0)));
    assert_eq!(met(&ray([-3.0, 0.0, 1.5], [1.0, 0.0, 0.0]), tip), MISS);
    assert_eq!(met(&ray([-1.5, 0.0, 0.0], [1.0, 0.0, 0.5]), tip).0, Contact::In);
    assert_eq!(met(&ray([-1.0, 0.0, 0.5], [1.0, 0.0, -1.0]), tip), (Contact::In, Some(0.25)));
    assert_eq!(met(&ray([-1.0, 0.0, 2.0], [1.0, 0.0, -1.0]), tip), (Contact::In, Some(1.0)));
    assert_eq!(met(&ray([0.0, 0.0, 3.0], [0.0, 0.0, -1.0]), tip), (Contact::In, Some(2.0)));
}

#[test]
fn polygons() {
    let square = Polygon {
        corners: vec![vec3(-1.0, -1.0, 0.0), vec3(1.0, -1.0, 0.0), vec3(1.0, 1.0, 0.0), vec3(-1.0, 1.0, 0.0)],
    };
    let at = |x: f32, y: f32| {
        let (meeting, index) = polygon::meet_fan(&ray([x, y, 2.0], [0.0, 0.0, -1.0]), &square).unwrap();
        (meeting.verdict, index)
    };
    // poly/fan-diagonal is inside, poly/vertex and edges are on it.
    assert_eq!(at(0.0, 0.0), (Contact::In, Some(0)));
    assert_eq!(at(0.5, 0.0), (Contact::In, Some(0)));
    assert_eq!(at(0.0, 0.5), (Contact::In, Some(1)));
    assert_eq!(at(1.0, 1.0), (Contact::On, Some(0)));
    assert_eq!(at(-1.0, -1.0), (Contact::On, Some(0)));
    assert_eq!(at(1.0, 0.25), (Contact::On, Some(0)));
    assert_eq!(at(1.0f32.next_up(), 0.25), (Contact::Out, None));
    // poly/collinear-vertex.
    let mut bent = square.clone();
    bent.corners.insert(1, vec3(0.0, -1.0, 0.0));
    let (meeting, _) = polygon::meet_fan(&ray([0.0, 0.0, 2.0], [0.0, 0.0, -1.0]), &bent).unwrap();
    assert_eq!(meeting, Meeting { verdict: Contact::In, t: Some(2.0) });
}

#[test]
fn filters_decide_what_is_clear() {
    let clear = Ray::new(vec3(0.3, 0.3, 1.0), vec3(0.01, 0.02, -1.0));
    let bodies = [
        Body::Triangle(UNIT),
        Body::Sphere(Sphere { center: Vec3::ZERO, radius: 0.9 }),
        Body::Cylinder(Cylinder { base: Vec3::ZERO, top: vec3(0.1, 0.2, 0.5), radius: 0.7 }),
        Body::Cone(Cone { base: Vec3::ZERO, apex: vec3(0.3, 0.3, 0.5), radius: 0.7 }),
    ];
    for body in bodies {
        assert!(meet_with(Tier::Filter, &clear, body).is_some_and(|meeting| meeting.t.is_some()), "{body:?}");
        assert_eq!(verdict(&clear, body), Some(Contact::In));
    }
}

#[test]
fn boxes() {
    let unit = Aabb::new(Vec3::ZERO, Vec3::ONE);
    let verdict = |ray: Ray, bounds: &Aabb| aabb::overlap(&ray, bounds).unwrap().verdict;
    let hits = |ray: Ray, bounds: &Aabb| verdict(ray, bounds).is_hit();
    // box/inside, box/o-on-face d-in-face, box/exit-at-0, box/-0.0 in all patterns.
    assert_eq!(verdict(ray([0.5, 0.5, 0.5], [1.0, 2.0, 3.0]), &unit), Contact::In);
    for pattern in 0..4 {
        let zero = |bit: u32| if pattern >> bit & 1 == 1 { -0.0 } else { 0.0 };
        assert!(hits(ray([0.0, 1.0, -2.0], [zero(0), zero(1), 1.0]), &unit));
        assert!(!hits(ray([-f32::from_bits(1), 0.5, -2.0], [zero(0), zero(1), 1.0]), &unit));
    }
    assert_eq!(verdict(ray([1.0, 0.5, 0.5], [1.0, 0.0, 0.0]), &unit), Contact::On);
    assert!(!hits(ray([1.0f32.next_up(), 0.5, 0.5], [1.0, 0.0, 0.0]), &unit));
    // box/flat, box/point, box/empty, box/flat-far, box/corner-aimed, box/denormal-d.
    let flat = Aabb::new(vec3(0.0, 0.0, 1e5), vec3(1.0, 1.0, 1e5));
    assert_eq!(verdict(ray([0.5, 0.5, 0.0], [0.0, 0.0, 1.0]), &flat), Contact::In);
    assert!(hits(ray([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]), &Aabb::new(Vec3::Z, Vec3::Z)));
    assert!(!hits(ray([0.0, 0.0, 0.0], [0.0, 0.0, 1.0]), &Aabb::EMPTY));
    assert_eq!(verdict(ray([-1.0, -1.0, 0.5], [1.0, 1.0, 0.0]), &unit), Contact::In);
    assert_eq!(verdict(ray([-1.0, 1.0, 0.5], [1.0, -1.0, 0.0]), &unit), Contact::On);
    let tiny = f32::from_bits(1);
    assert_eq!(verdict(ray([-1.0, 0.5, 0.5], [tiny, 0.0, tiny]), &unit), Contact::Out);
    assert_eq!(verdict(ray([-0.5, 0.5, 0.25], [tiny, 0.0, tiny]), &unit), Contact::In);
    // The segment is closed at both ends.
    let segment = |t_min, t_max| ray([-1.0, 0.5, 0.5], [1.0, 0.0, 0.0]).with_range(t_min, t_max);
    assert_eq!(verdict(segment(0.0, 1.0), &unit), Contact::On);
    assert_eq!(verdict(segment(2.0, 3.0), &unit), Contact::On);
    assert_eq!(verdict(segment(0.0, 1.0f32.next_down()), &unit), Contact::Out);
    assert_eq!(verdict(segment(1.5, 1.0), &unit), Contact::Out);
    assert!(aabb::overlap(&segment(0.0, 1.0), &unit).unwrap().margin < 1e-6);
    assert!(aabb::overlap(&segment(0.0, 1.5), &unit).unwrap().margin > 1e5);
}
