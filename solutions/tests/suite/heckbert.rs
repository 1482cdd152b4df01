//! Heckbert's business card: the picture of `scenes/heckbert.toml` is that of the formulas on the slide.
//!
//! The formulas are written down here independently of the kit, in double precision, one sentence per statement of the
//! slide. Only the positions of the samples are those of the kit: the card samples the corners of pixels, the kit their
//! centres.

use crate::frames::render;
use glam::{DVec3, dvec3};
use raykata::scene::load;
use std::path::Path;

/// A sphere of the card: centre, colour, radius, diffuse, specular, transmitted and emitted share, index.
struct Sphere {
    center: DVec3,
    color: DVec3,
    radius: f64,
    kd: f64,
    ks: f64,
    kt: f64,
    kl: f64,
    ir: f64,
}

const fn sphere(center: [f64; 3], color: [f64; 3], rest: [f64; 6]) -> Sphere {
    let [radius, kd, ks, kt, kl, ir] = rest;
    Sphere { center: DVec3::from_array(center), color: DVec3::from_array(color), radius, kd, ks, kt, kl, ir }
}

/// `sph[]`.
const SPHERES: [Sphere; 5] = [
    sphere([0.0, 6.0, 0.5], [1.0, 1.0, 1.0], [0.9, 0.05, 0.2, 0.85, 0.0, 1.7]),
    sphere([-1.0, 8.0, -0.5], [1.0, 0.5, 0.2], [1.0, 0.7, 0.3, 0.0, 0.05, 1.2]),
    sphere([1.0, 8.0, -0.5], [0.1, 0.8, 0.8], [1.0, 0.3, 0.7, 0.0, 0.0, 1.2]),
    sphere([3.0, -6.0, 15.0], [1.0, 0.8, 1.0], [7.0, 0.0, 0.0, 0.0, 0.6, 1.5]),
    sphere([-3.0, -3.0, 12.0], [0.8, 1.0, 1.0], [5.0, 0.0, 0.0, 0.0, 0.5, 1.5]),
];

/// `amb`.
const AMBIENT: DVec3 = DVec3::splat(0.02);

/// `intersect`: the sphere that the ray hits first, and `tmin`.
fn intersect(p: DVec3, d: DVec3) -> Option<(usize, f64)> {
    let mut best = None;
    let mut t_min = 1e30;
    for (index, sphere) in SPHERES.iter().enumerate().rev() {
        let u = sphere.center - p;
        let b = d.dot(u);
        let discriminant = b * b - u.dot(u) + sphere.radius * sphere.radius;
        let root = if discriminant > 0.0 { discriminant.sqrt() } else { 1e31 };
        let t = if b - root > 1e-7 { b - root } else { b + root };
        if t >= 1e-7 && t < t_min {
            best = Some((index, t));
            t_min = t;
        }
    }
    best
}

/// `trace`: the colour of a ray with a unit direction.
fn trace(level: u32, p: DVec3, d: DVec3) -> DVec3 {
    if level == 0 {
        return DVec3::ZERO;
    }
    let level = level - 1;
    let Some((index, t)) = intersect(p, d) else { return AMBIENT };
    let sphere = &SPHERES[index];
    // Turn the normal towards the ray; from inside, the ratio of the indices is the inverse.
    let p = p + t * d;
    let mut n = (p - sphere.center).normalize();
    let (mut cosine, mut eta) = (-d.dot(n), sphere.ir);
    if cosine < 0.0 {
        (n, eta, cosine) = (-n, 1.0 / eta, -cosine);
    }
    // Add the light of each sphere that the ray to its centre hits first.
    let mut color = AMBIENT;
    for (index, light) in SPHERES.iter().enumerate() {
        let u = (light.center - p).normalize();
        let e = light.kl * n.dot(u);
        if e > 0.0 && intersect(p, u).is_some_and(|(hit, _)| hit == index) {
            color += e * light.color;
        }
    }
    color *= sphere.color;
    // Refract, reflect, and add the emitted light.
    let e = 1.0 - eta * eta * (1.0 - cosine * cosine);
    let refracted = || trace(level, p, eta * d + (eta * cosine - e.sqrt()) * n);
    let transmitted = if e > 0.0 { refracted() } else { DVec3::ZERO };
    let reflected = trace(level, p, 2.0 * cosine * n + d);
    sphere.kt * transmitted + sphere.ks * reflected + sphere.kd * color + sphere.kl * sphere.color
}

/// `main`: the direction through the pixel at column `x` and row `y`.
fn direction(x: f64, y: f64) -> DVec3 {
    dvec3(x - 16.0, 16.0 / (25.0 / 114.591_559_026_1_f64).tan(), 16.0 - y).normalize()
}

#[test]
fn the_business_card_is_the_picture_of_its_formulas() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenes/heckbert.toml");
    let scene = load::load(&file).expect("the scene");
    let film = render(&scene).film;
    assert_eq!((film.width, film.height), (32, 32));
    let mut agreeing = 0;
    let mut worst = (0.0, 0, 0);
    for (index, pixel) in film.pixels.iter().enumerate() {
        let (x, y) = (index % 32, index / 32);
        let expected = trace(3, DVec3::ZERO, direction(x as f64 + 0.5, y as f64 + 0.5));
        let difference = (pixel.as_dvec3() - expected).abs().max_element();
        agreeing += u32::from(difference <= 1.0 / 255.0);
        if difference > worst.0 {
            worst = (difference, x, y);
        }
    }
    // Rays that graze a sphere may be decided by rounding: single precision here, double precision there.
    assert!(agreeing >= 1014, "{agreeing} of 1024 pixels agree; the worst is {worst:?}");
}
