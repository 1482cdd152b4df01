//! How many digits of `t` are right, where a doc comment says so.

use glam::Vec3;
use oracle::exact::{Body, t_error_in_ulps};
use oracle::splitmix::Random;
use raykata::ray::Ray;
use raykata::shape::Sphere;
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
