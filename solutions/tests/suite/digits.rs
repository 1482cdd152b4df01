//! How many digits of `t` are right, where a doc comment says so.

use checks::double::{self, Expected};
use glam::Vec3;
use oracle::exact::{Body, t_error_in_ulps, t_in_double};
use oracle::splitmix::Random;
use raykata::aabb::Aabb;
use raykata::ray::Ray;
use raykata::shape::{Cuboid, Plane, Sphere};
use solutions::stage10_stability::sphere_in_double;

#[test]
fn t_of_a_sphere_in_double_precision_is_rounded_correctly() {
    let mut random = Random::new(1, 0);
    let mut worst = 0f64;
    for _ in 0..200_000 {
        let radius = 10f32.powf(3.0 * random.signed());
        let center = radius * 10f32.powf(3.0 * random.signed()) * random.in_cube();
        // The origin is inside or outside, by a millionth of a radius or more.
        let away = 10f32.powf(-5.9 + 10.0 * random.unit());
        let side = if random.below(2) == 0 { 1.0 + away } else { (1.0 - away).max(0.0) };
        let origin = center + side * radius * random.direction();
        let to_center = center - origin;
        let target = center + 0.9 * radius * random.direction() * random.unit();
        let ray = Ray::new(origin, target - origin);
        // Rounded coordinates may have moved the origin nearer to the sphere.
        let distance = (to_center.as_dvec3().length() / f64::from(radius) - 1.0).abs();
        if distance < 1e-6 || ray.direction == Vec3::ZERO {
            continue;
        }
        let Some(t) = sphere_in_double(&ray, center, radius) else { continue };
        let Some(error) = t_error_in_ulps(&ray, Body::Sphere(Sphere { center, radius }), t) else { continue };
        worst = worst.max(error.abs());
    }
    println!("{worst}");
    assert!(worst <= 0.51, "{worst} ulps");
}

/// The checks of stages 1 and 3 compare with formulas in double precision. Exact integers are a second source.
#[test]
fn references_in_double_precision_agree_with_exact_arithmetic() {
    let mut random = Random::new(2, 0);
    let mut n_hits = [0; 3];
    for _ in 0..100_000 {
        let [a, b, c] = [0; 3].map(|_| 4.0 * random.in_cube());
        let ray = Ray::new(a, b - a);
        let sphere = Sphere { center: b + random.in_cube(), radius: 2.0 * random.unit() };
        let plane = Plane { point: c, normal: random.direction() };
        let bounds =
            Aabb { min: b + random.in_cube().min(Vec3::ZERO), max: b + random.in_cube().max(Vec3::ZERO) };
        let exact = |body| t_in_double(&ray, body).expect("finite inputs");
        let of_box = match double::box_interval(&ray, &bounds) {
            (near, far) if near.max(0.0) > far || far <= 0.0 => Expected::Miss,
            (near, far) => Expected::Hit { t: if near > 0.0 { near } else { far }, tolerance: 0.0 },
        };
        let pairs = [
            (double::sphere(&ray, &sphere), exact(Body::Sphere(sphere))),
            (double::plane(&ray, &plane), exact(Body::Plane(plane))),
            (of_box, exact(Body::Cuboid(Cuboid { min: bounds.min, max: bounds.max }))),
        ];
        for (n_hits, (expected, exact)) in n_hits.iter_mut().zip(pairs) {
            match (expected, exact) {
                // Roundings of the discriminant in double precision, at most some 1e-15, grow near the rim to their root.
                (Expected::Hit { t, .. }, Some(exact)) if (t - exact).abs() <= 1e-7 * exact.abs() => {
                    *n_hits += 1
                }
                (Expected::Miss, None) | (Expected::Open, _) => {}
                _ => {
                    panic!("{ray:?} at {sphere:?}, {plane:?} or {bounds:?}: {expected:?}, exactly {exact:?}")
                }
            }
        }
    }
    assert!(n_hits.iter().all(|n| *n > 10_000), "{n_hits:?}");
}
