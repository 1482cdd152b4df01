//! The watertight triangle test and the slab test of stage 10 against exact arithmetic.
//!
//! The triangle test answers as exact arithmetic does, on every input: it hits where the exact line meets the closed triangle in one
//! point, and its `t` is the exact one, rounded. That is why closed meshes do not leak: see `watertight` in
//! `solutions/src/stage10_stability.rs`.

use glam::{Vec3, vec3};
use oracle::STABLE;
use oracle::exact::aabb::overlap;
use oracle::exact::{Body, meet, triangle};
use oracle::gauntlet::boxes::of_any_size;
use oracle::gauntlet::distributions::DISTRIBUTIONS;
use oracle::splitmix::Random;
use raykata::kit::SlabQuery;
use raykata::ray::Ray;
use raykata::shape::Triangle;
use solutions::stage10_stability::{conservative_slab, watertight};

/// A float with any sign and mantissa and an exponent within `-range..=range`.
fn any_size(random: &mut Random, range: i32) -> f32 {
    let exponent = random.below(2 * range as u64 + 1) as i32 - range;
    let mantissa = 1.0 + f64::from(random.unit());
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    (sign * mantissa * 2f64.powi(exponent)) as f32
}

fn vector(mut number: impl FnMut() -> f32) -> Vec3 {
    vec3(number(), number(), number())
}

/// Whole coordinates from -4 to 4: many rays lie in the plane of the triangle, and through edges and corners.
fn lattice(random: &mut Random) -> (Ray, Triangle) {
    let mut whole = || vector(|| random.below(9) as f32 - 4.0);
    let (o, target, a, b, c) = (whole(), whole(), whole(), whole(), whole());
    (Ray::new(o, target - o), Triangle { a, b, c })
}

/// Each coordinate has a size of its own.
fn mixed(random: &mut Random, range: i32) -> (Ray, Triangle) {
    let mut any = || vector(|| any_size(random, range));
    let (o, d, a, b, c) = (any(), any(), any(), any(), any());
    (Ray::new(o, d), Triangle { a, b, c })
}

/// Corners at very different distances; the ray starts near the triangle and is aimed at it.
fn far_corners(random: &mut Random) -> (Ray, Triangle) {
    let mut corner = || {
        let size = 2f32.powi(random.below(81) as i32 - 40);
        size * random.direction()
    };
    let triangle = Triangle { a: corner(), b: corner(), c: corner() };
    let (beta, gamma) = (random.unit(), random.unit());
    let target = triangle.a.lerp(triangle.b, beta).lerp(triangle.c, gamma * random.below(2) as f32);
    let o = any_size(random, 40).abs() * random.direction();
    (Ray::new(o, target - o), triangle)
}

/// The ray lies in the plane of the triangle up to rounding.
fn edge_on(random: &mut Random) -> (Ray, Triangle) {
    let [a, b, c] = [(); 3].map(|()| random.in_cube());
    let mut within = || a + (4.0 * random.unit() - 2.0) * (b - a) + (4.0 * random.unit() - 2.0) * (c - a);
    let (o, target) = (within(), within());
    (Ray::new(o, target - o), Triangle { a, b, c })
}

/// A triangle as thin as rounding allows, or with corners on one line.
fn thin(random: &mut Random) -> (Ray, Triangle) {
    let [a, b] = [(); 2].map(|()| random.in_cube());
    let c = a.lerp(b, 2.0 * random.unit() - 0.5);
    let triangle = Triangle { a, b, c };
    let o = 2.0 * random.in_cube();
    let target = a.lerp(b, random.unit());
    (Ray::new(o, target - o), triangle)
}

fn check(name: &str, ray: &Ray, triangle: &Triangle) -> bool {
    let line = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
    let Some(exact) = meet(&line, Body::Triangle(*triangle)) else { return false };
    let expected = exact.t.filter(|&t| ray.contains(t));
    let yours = watertight(ray, triangle);
    let input = || format!("{name}: {ray:?} {triangle:?}, exact t {expected:?}, {yours:?}");
    assert_eq!(yours.is_some(), expected.is_some(), "{}", input());
    let (Some(yours), Some(t)) = (yours, expected) else { return false };
    // t is computed in double precision with a relative error of 2⁻²⁵ or less, so it is the rounded exact one or its
    // neighbour.
    assert!(t.next_down() <= yours.t && yours.t <= t.next_up(), "{}", input());
    let weights = triangle::weights(ray, triangle).flatten().unwrap_or_else(|| panic!("{}", input()));
    for (yours, exact) in [yours.beta, yours.gamma].into_iter().zip(weights) {
        // Accept 2⁻²⁴ of the whole: the error bound of the fast path, and a rounding to single precision.
        assert!((f64::from(yours) - exact).abs() <= 2f64.powi(-24), "{} {weights:?}", input());
        assert!((0.0..=1.0).contains(&yours), "{}", input());
    }
    true
}

/// Draws a ray and a triangle.
pub type Draw = fn(&mut Random) -> (Ray, Triangle);

/// All kinds of rays and triangles, by name.
pub fn kinds() -> Vec<(&'static str, Draw)> {
    let own: [(&str, Draw); 7] = [
        ("lattice", lattice),
        ("mixed sizes, 2^±10", |random| mixed(random, 10)),
        ("mixed sizes, 2^±100", |random| mixed(random, 100)),
        ("denormal", |random| {
            let mut tiny = || vector(|| (random.below(33) as f32 - 16.0) * f32::from_bits(1));
            let (o, d, a, b, c) = (tiny(), tiny(), tiny(), tiny(), tiny());
            (Ray::new(o, d), Triangle { a, b, c })
        }),
        ("far corners", far_corners),
        ("edge-on", edge_on),
        ("thin", thin),
    ];
    DISTRIBUTIONS.iter().map(|distribution| (distribution.name, distribution.draw)).chain(own).collect()
}

#[test]
fn watertight_answers_as_exact_arithmetic_does() {
    for (index, (name, draw)) in kinds().into_iter().enumerate() {
        let mut random = Random::new(1, index as u64);
        let mut hits = 0;
        for _ in 0..20_000 {
            let (ray, triangle) = draw(&mut random);
            hits += usize::from(check(name, &ray, &triangle));
        }
        println!("{name}: {hits} hits");
    }
}

/// The slab test loses no box that a ray meets, for any range and direction.
#[test]
fn slabs_lose_no_box_that_is_met() {
    let mut random = Random::new(1, 0);
    let (mut met, mut passed, mut close) = (0, 0, 0);
    for _ in 0..1_000_000 {
        let Some(SlabQuery { ray, bounds }) = of_any_size(&mut random) else { continue };
        let Some(exact) = overlap(&ray, &bounds) else { continue };
        let yours = conservative_slab(&ray, ray.direction.recip(), &bounds);
        if exact.verdict.is_hit() {
            met += 1;
            assert!(yours.is_some(), "lost: {ray:?} {bounds:?}");
        } else if exact.margin > STABLE {
            passed += 1;
            // A box whose exit overflows may be entered at infinity, which costs a visit.
            let yours = yours.filter(|(enter, _)| enter.is_finite());
            assert_eq!(yours, None, "{ray:?} {bounds:?} {}", exact.margin);
        } else {
            close += 1;
        }
    }
    println!("{met} met, {passed} passed, {close} passed by a few roundings");
}
