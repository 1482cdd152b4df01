//! Paths by `step` in rooms whose light has a closed form.
//!
//! E is the mean radiance that arrives over directions with density `cos θ / π`: the irradiance divided by π. A surface of
//! diffuse reflectance kd sends kd E back.

use crate::emitters::lambert;
use crate::rooms::{Form, Paint, Room, Roulette, Wall, follow};
use checks::prelude::*;
use checks::radiosity::EmptyBox;
use checks::statistics::{Mistakes, SAMPLES, has_mean_within};
use glam::dvec3;
use std::f64::consts::PI;

/// A depth that no path reaches: Russian roulette ends it before.
const DEEP: u32 = 1_000_000;

fn grey(share: f64) -> Vec3 {
    Vec3::splat(share as f32)
}

/// Checks that a channel of all paths has this mean, which itself is only known up to the second number.
fn channel_has_mean(
    what: &str,
    light: &[DVec3],
    channel: usize,
    expected: (f64, f64),
    mistakes: impl Fn(f64) -> Mistakes,
) -> CheckResult {
    let what = format!("{} paths by step in {what}, {}", light.len(), ["red", "green", "blue"][channel]);
    let values: Vec<f64> = light.iter().map(|light| light[channel]).collect();
    has_mean_within(&what, &values, expected, |mean| {
        let mut all = vec![(mean.is_nan(), "a weight, a density or a direction is NaN")];
        all.extend(mistakes(mean));
        all
    })
}

/// Whether a mean is this number. A mean of thousands of paths is within a few percent of it.
fn is(mean: f64, expected: f64) -> bool {
    (mean / expected - 1.0).abs() < 0.02
}

/// The sum of the first `n` powers of the albedo, from its power 0 on.
fn powers(albedo: f64, n: u32) -> f64 {
    (0..n).map(|power| albedo.powi(power as i32)).sum()
}

pub(super) fn paths_in_a_furnace_count_every_bounce(trial: &Trial<'_>) -> CheckResult {
    // A channel that loses no light keeps every path alive, so no random number matters: each path has the light of the
    // closed form, and not only their mean.
    let (albedo, emission) = trial.varied(
        (vec3(0.5, 1.0, 0.25), vec3(1.0, 0.5, 2.0)),
        ((0.1..0.9f32, 0.1..0.9f32).prop_map(|(x, z)| vec3(x, 1.0, z)), (0.2..3.0f32).prop_map(Vec3::splat)),
    );
    let wall =
        Wall::new(Form::Sphere(DVec3::ZERO, 1.0), Paint { diffuse: albedo, emission, ..Paint::default() });
    let room = Room { walls: vec![wall], sky: Vec3::ZERO };
    let starts: Vec<_> =
        nasty::directions().iter().map(|to| (DVec3::ZERO, to.as_dvec3().normalize())).collect();
    let mut outcomes = Vec::new();
    for depth in [0, 1, 2, 3, 5, 12] {
        let found = follow(trial.kit, trial.seed, &room, &starts, depth, Roulette::LeftOut)?;
        for light in &found {
            let sum = |n: u32| {
                DVec3::from_array(albedo.as_dvec3().to_array().map(|albedo| powers(albedo, n)))
                    * emission.as_dvec3()
            };
            // The roundings of some products and sums per bounce.
            let near =
                |expected: DVec3| (*light - expected).abs().max_element() <= 1e-5 * expected.max_element();
            let expected = sum(depth + 1);
            if near(expected) {
                outcomes.push(Ok(()));
                continue;
            }
            let what = format!(
                "a path by step with max_depth {depth} in a closed room of albedo {albedo} whose walls emit {emission}"
            );
            let (yours, right) = (format!("{light:.4}"), format!("{expected:.4}"));
            let broken = Broken::with_texts(what, yours, right, "Le (1 + ρ + … + ρⁿ)");
            outcomes.push(Err(broken.explained_by(named![
                light.is_nan() => "you return NaN",
                near(sum(depth)) => "the light of the last surface is missing: collect it before the path ends",
                near(sum(depth + 2)) => "your paths have one bounce more than max_depth",
                near(emission.as_dvec3()) => "only the first surface counts",
                near(sum(depth + 1) - emission.as_dvec3()) => "the light of the first surface is missing",
            ])));
        }
    }
    all_hold(outcomes)
}

pub(super) fn paths_in_a_furnace_find_all_light(trial: &Trial<'_>) -> CheckResult {
    // The walls of a cube emit light and are sampled: all light counts once, in both ways together.
    // Not 1/2, where a path with two surfaces of emission 1 and nothing else has the right light.
    let albedo = trial.varied(0.55, 0.4..0.6f64);
    let corners = [DVec3::ZERO, DVec3::ONE];
    let faces = (0..6).map(|face| {
        let (axis, corner) = (face % 3, corners[face / 3]);
        let sign = if face < 3 { 1.0 } else { -1.0 };
        let edge = |turn: usize| sign * DVec3::AXES[(axis + turn) % 3];
        let paint = Paint { diffuse: grey(albedo), emission: Vec3::ONE, ..Paint::default() };
        Wall::new(Form::Parallelogram(corner, edge(1), edge(2)), paint).sampled(1.0 / 6.0)
    });
    let room = Room { walls: faces.collect(), sky: Vec3::ZERO };
    let starts: Vec<_> = (0..SAMPLES)
        .map(|index| (DVec3::splat(0.5), nasty::tilted(Vec3::Y, 0.2, index as f64 / 16.0).as_dvec3()))
        .collect();
    let found = follow(trial.kit, trial.seed, &room, &starts, DEEP, Roulette::Played)?;
    let expected = 1.0 / (1.0 - albedo);
    channel_has_mean(
        "a closed box whose walls all emit light and are sampled",
        &found,
        0,
        (expected, 0.0),
        |mean| {
            vec![
                "light that is sampled and light that is found both count in full"
                    .when(is(mean, 1.0 + 2.0 * albedo / (1.0 - albedo))),
                (is(mean, 1.0), "only the light that the camera sees counts"),
            ]
        },
    )?;
    // Without samples, rays find all light by chance.
    let walls = room.walls.iter().map(|wall| Wall { emitter: None, ..wall.clone() }).collect();
    let room = Room { walls, ..room };
    let found = follow(trial.kit, trial.seed ^ (1 << 39), &room, &starts, DEEP, Roulette::Played)?;
    channel_has_mean(
        "a closed box whose walls all emit light, without samples",
        &found,
        0,
        (expected, 0.0),
        |_| Vec::new(),
    )
}

pub(super) fn paths_of_a_white_corner_lose_nothing(trial: &Trial<'_>) -> CheckResult {
    // Two white planes under a white sky: for all directions, each path ends in the sky with all of its light.
    let angle = trial.varied(1.2, 0.9..1.5f64);
    let white = Paint { diffuse: Vec3::ONE, ..Paint::default() };
    let mirror = Paint { mirror: Vec3::ONE, ..Paint::default() };
    let mut outcomes = Vec::new();
    for (name, paint) in [("white planes", white), ("a white plane and a mirror", mirror)] {
        let (room, start) = corner(angle, white, paint);
        let found = follow(trial.kit, trial.seed, &room, &[start; 256], 500, Roulette::LeftOut)?;
        for light in &found {
            // The roundings of a weight per bounce.
            if (*light - 1.0).abs().max_element() <= 1e-4 {
                outcomes.push(Ok(()));
                continue;
            }
            let what = format!("a path by step in a corner of {name} under a white sky");
            let (yours, source) = (format!("{light:.4}"), "no light is lost or added");
            let broken = Broken::with_texts(what, yours, "1.0000 per channel", source);
            outcomes.push(Err(broken.explained_by([
                (light.is_nan(), "you return NaN"),
                (light.max_element() == 0.0, "the path ends, although it has all of its light"),
            ])));
        }
    }
    all_hold(outcomes)
}

/// Two planes under a sky of radiance 1: y = 0, and one at this angle to it. A ray of the camera to the first plane, which starts
/// at the distance 1 from the edge.
fn corner(angle: f64, first: Paint, second: Paint) -> (Room, (DVec3, DVec3)) {
    let walls = vec![
        Wall::new(Form::Plane(DVec3::ZERO, DVec3::Y), first),
        Wall::new(Form::Plane(DVec3::ZERO, dvec3(angle.sin(), -angle.cos(), 0.0)), second),
    ];
    let eye = dvec3(1.0, 0.5 * angle.tan().abs().min(1.0), 0.0);
    (Room { walls, sky: Vec3::ONE }, (eye, DVec3::NEG_Y))
}

pub(super) fn paths_in_a_corner_find_its_sky(trial: &Trial<'_>) -> CheckResult {
    // At a right angle half of the directions meet the other plane, however they lean, so this would be blind to wrong ones.
    let hidden = (0.95..1.15f64, 0.55..0.7f64, 0.5..0.9f32);
    let (first, second, kd) = trial.varied((1.0, 0.6, 0.7), hidden);
    for (index, angle) in [first, second].into_iter().enumerate() {
        let (floor, wall) = (vec3(kd, 0.8, 0.6), vec3(0.9, 0.2, 0.6));
        let paint = |diffuse: Vec3| Paint { diffuse, ..Paint::default() };
        let (room, start) = corner(angle, paint(floor), paint(wall));
        let seed = trial.seed ^ ((index as u64) << 39);
        let found = follow(trial.kit, seed, &room, &vec![start; SAMPLES], DEEP, Roulette::Played)?;
        // Each plane sees the other in this share of its view, because nothing in the scene has a size.
        let share = (1.0 + angle.cos()) / 2.0;
        for channel in [0, 1] {
            let (k1, k2) = (f64::from(floor[channel]), f64::from(wall[channel]));
            // B₁ = k₁ ((1 - F) + F B₂), and the same for B₂.
            let expected = k1 * (1.0 - share) * (1.0 + share * k2) / (1.0 - k1 * k2 * share * share);
            let what = format!("a corner of {:.0} degrees under a sky of radiance 1", angle.to_degrees());
            channel_has_mean(&what, &found, channel, (expected, 0.0), |mean| {
                vec![
                    (is(mean, k1 * (1.0 - share)), "light that the other plane reflects is missing"),
                    (is(mean, k1), "the other plane does not darken the sky"),
                ]
            })?;
        }
    }
    Ok(())
}

pub(super) fn steps_in_an_integrating_sphere_find_its_light(trial: &Trial<'_>) -> CheckResult {
    let hidden = (nasty::unit(), 0.1..0.3f64, 0.85..0.9f64, 0.5..0.65f64);
    let (axis, dark, bright, rest) = trial.varied((Vec3::Z, 0.2, 0.9, 0.6), hidden);
    let axis = axis.as_dvec3().normalize();
    let other = -0.5 * axis + 0.75f64.sqrt() * axis.any_orthonormal_vector();
    let paint = |albedo: f64, emission: f64| Paint {
        diffuse: grey(albedo),
        emission: grey(emission),
        ..Paint::default()
    };
    // The same caps as those of paths_in_an_integrating_sphere_find_its_light, and the same closed form.
    let caps = vec![(axis, 0.8, paint(dark, 1.0)), (other, 0.3, paint(bright, 0.0))];
    let wall = Wall { caps, ..Wall::new(Form::Sphere(DVec3::ZERO, 1.0), paint(rest, 0.0)) };
    let room = Room { walls: vec![wall], sky: Vec3::ZERO };
    let (first, second) = (0.5 * (1.0 - 0.8), 0.5 * (1.0 - 0.3));
    let reflected = first * dark + second * bright + (1.0 - first - second) * rest;
    // The camera sees the middle of the bright cap's side that is opposite of the emitting cap.
    let starts: Vec<_> = (0..2 * SAMPLES)
        .map(|index| (DVec3::ZERO, nasty::tilted((-axis).as_vec3(), 0.15, index as f64 / 16.0).as_dvec3()))
        .collect();
    let found = follow(trial.kit, trial.seed, &room, &starts, DEEP, Roulette::Played)?;
    let expected = bright * first / (1.0 - reflected);
    channel_has_mean("an integrating sphere", &found, 0, (expected, 0.0), |_| Vec::new())
}

/// The mean radiance that arrives at the origin, of a surface with normal +y, from a parallelogram of radiance 1 that is
/// wholly above it.
fn from_parallelogram(corner: DVec3, first: DVec3, second: DVec3) -> f64 {
    lambert(&[corner, corner + first, corner + first + second, corner + second], DVec3::Y) / PI
}

/// The ray of the camera to the origin, from above.
const DOWN: (DVec3, DVec3) = (DVec3::new(0.0, 0.25, 0.0), DVec3::NEG_Y);

pub(super) fn steps_count_sampled_light_once(trial: &Trial<'_>) -> CheckResult {
    // A large light close to the point is found as often by chance as by samples; a small light by samples only.
    let (near, kd) = trial.varied((0.5, 0.7), (0.4..0.7f64, 0.4..0.8f64));
    let large = (dvec3(-1.0, near, -1.5), dvec3(1.2, 0.2, 0.0), dvec3(0.0, 0.0, 2.5));
    let (center, radius) = (dvec3(1.2, 0.9, 0.3), 0.15);
    let walls = vec![
        Wall::new(Form::Plane(DVec3::ZERO, DVec3::Y), Paint { diffuse: grey(kd), ..Paint::default() }),
        Wall::light(Form::Parallelogram(large.0, large.1, large.2), vec3(1.0, 0.0, 0.0), 0.4),
        Wall::light(Form::Sphere(center, radius), vec3(0.0, 20.0, 0.0), 0.6),
    ];
    let room = Room { walls, sky: Vec3::ZERO };
    let found = follow(trial.kit, trial.seed, &room, &vec![DOWN; SAMPLES], 1, Roulette::Played)?;
    let kd = f64::from(kd as f32);
    let of_sphere = 20.0 * radius * radius / center.length_squared() * center.y / center.length();
    for (channel, light, expected) in [
        (0, "a large light", from_parallelogram(large.0, large.1, large.2)),
        (1, "a small sphere", of_sphere),
    ] {
        let expected = kd * expected;
        channel_has_mean(&format!("a room with {light}"), &found, channel, (expected, 0.0), |mean| {
            named![
                is(mean, 2.0 * expected) => "light counts twice: once by samples and once by chance",
                is(mean, PI * expected) => "your light is π times too bright: a diffuse surface sends kd / π on",
                is(mean, expected / kd) => "the diffuse reflectance is missing",
                mean == 0.0 => "no light arrives",
            ].to_vec()
        })?;
    }
    Ok(())
}

pub(super) fn steps_find_light_in_a_mirror(trial: &Trial<'_>) -> CheckResult {
    // A mirror shows the image of a light. No sample of a light finds this light (a caustic, LSDE in Heckbert's notation).
    let (shift, kd) = trial.varied((0.0, 0.7), (-0.2..0.2f64, 0.4..0.8f64));
    let (corner, first, second) = (dvec3(0.5, 0.8, -0.7 + shift), dvec3(0.5, 0.5, 0.0), dvec3(0.0, 0.0, 1.4));
    let weight = vec3(0.9, 0.0, 0.5);
    let walls = vec![
        Wall::new(Form::Plane(DVec3::ZERO, DVec3::Y), Paint { diffuse: grey(kd), ..Paint::default() }),
        Wall::new(Form::Plane(1.5 * DVec3::X, DVec3::NEG_X), Paint { mirror: weight, ..Paint::default() }),
        Wall::light(Form::Parallelogram(corner, first, second), Vec3::splat(4.0), 1.0),
    ];
    let room = Room { walls, sky: Vec3::ZERO };
    // With two bounces: the floor, the mirror, the light. Light from the floor to the mirror and back needs three.
    let found = follow(trial.kit, trial.seed, &room, &vec![DOWN; SAMPLES], 2, Roulette::Played)?;
    let kd = f64::from(kd as f32);
    let direct = 4.0 * kd * from_parallelogram(corner, first, second);
    // The mirror is at x = 1.5, so its image of x is 3 - x.
    let image = |v: DVec3| dvec3(-v.x, v.y, v.z);
    let in_mirror =
        4.0 * kd * from_parallelogram(image(corner) + 3.0 * DVec3::X, image(first), image(second));
    // First the channel in which the mirror is black: what is lost there is not lost in the mirror.
    for channel in [1, 0] {
        let weight = f64::from(weight[channel]);
        let expected = direct + weight * in_mirror;
        let of_mirror = weight * in_mirror;
        channel_has_mean("a room with a light and a mirror", &found, channel, (expected, 0.0), |mean| {
            named![
                of_mirror > 0.05 * direct && is(mean, direct) =>
                    "light that a mirror reflects is lost: no sample finds it, so it counts in full",
                is(mean, 2.0 * direct + of_mirror) => "light counts twice: once by samples and once by chance",
                is(mean, direct + in_mirror) && weight != 1.0 => "the weight of the mirror is missing",
            ].to_vec()
        })?;
    }
    Ok(())
}

/// A bound on the error of the radiosity solution, in units of the light's radiance. The tests of `EmptyBox` measure less than a
/// tenth of it.
const RADIOSITY_ERROR: f64 = 2e-4;

pub(super) fn steps_in_an_empty_cornell_box_agree_with_radiosity(trial: &Trial<'_>) -> CheckResult {
    let (left, others) = trial.varied((0.3f32, 0.7f32), (0.2..0.4f32, 0.6..0.75f32));
    // Red is brighter on the wall -x, and green on the wall +x.
    let colors = |face: usize| match face {
        0 => vec3(others, left, others),
        1 => vec3(left, others, others),
        _ => Vec3::splat(others),
    };
    let mut walls = Vec::new();
    for face in 0..6 {
        let (axis, is_upper) = (face / 2, face % 2 == 1);
        let corner = if is_upper { DVec3::AXES[axis] } else { DVec3::ZERO };
        let form = Form::Parallelogram(corner, DVec3::AXES[(axis + 1) % 3], DVec3::AXES[(axis + 2) % 3]);
        walls.push(Wall::new(form, Paint { diffuse: colors(face), ..Paint::default() }));
    }
    // The light lies in front of the ceiling, by much less than it is wide, and reflects light like the ceiling.
    let paint = Paint { diffuse: colors(3), emission: Vec3::ONE, ..Paint::default() };
    let light = Form::Parallelogram(dvec3(0.25, 1.0 - 1e-6, 0.25), 0.5 * DVec3::X, 0.5 * DVec3::Z);
    walls.push(Wall::new(light, paint).sampled(1.0));
    let room = Room { walls, sky: Vec3::ZERO };
    let middle = dvec3(0.5, 0.0, 0.5);
    let starts = vec![(middle + 0.5 * DVec3::Y, DVec3::NEG_Y); SAMPLES];
    let found = follow(trial.kit, trial.seed, &room, &starts, DEEP, Roulette::Played)?;
    for channel in [0, 2] {
        let albedo = [0, 1, 2, 3, 4, 5].map(|face| f64::from(colors(face)[channel]));
        let empty = EmptyBox { albedo, light_albedo: albedo[3], emission: 1.0 };
        let expected = albedo[2] * empty.arriving(middle, DVec3::Y);
        let what = "a Cornell box without blocks";
        channel_has_mean(what, &found, channel, (expected, RADIOSITY_ERROR), |mean| {
            let direct =
                albedo[2] * from_parallelogram(dvec3(-0.25, 1.0, -0.25), 0.5 * DVec3::X, 0.5 * DVec3::Z);
            vec![
                (is(mean, direct), "only direct light counts: indirect light is missing"),
                (is(mean, expected - direct), "direct light is missing"),
            ]
        })?;
    }
    Ok(())
}
