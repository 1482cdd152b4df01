//! Paths in an integrating sphere (Ulbricht): the inside of a sphere whose patches have different albedos, one of which emits.
//!
//! A chord from a point of a sphere whose direction has the density `cos θ / π` ends uniformly on the sphere. So all points get
//! the same mean radiance `E = Σ aᵢ Lᵢ / (1 - Σ aᵢ ρᵢ)` over such directions, with the share aᵢ of the area, the emission Lᵢ and
//! the albedo ρᵢ of each patch. A closed room of one albedo, the furnace, has this value for any distribution of directions;
//! here wrong directions find too much or too little light.

use crate::rooms::are_endless;
use checks::prelude::*;
use checks::statistics::{SAMPLES, has_mean, pairs};

/// A part of the sphere: all points with `p · axis` above `height`, for the unit sphere.
struct Cap {
    axis: DVec3,
    height: f64,
    albedo: f64,
    emission: f64,
}

/// The number of paths. With half of them the test misses paths that end after 5 bounces, with 9 % of the light missing, for
/// one seed in ten.
const PATHS: usize = 2 * SAMPLES;

pub(super) fn paths_in_an_integrating_sphere_find_its_light(trial: &Trial<'_>) -> CheckResult {
    let hidden = (nasty::unit(), 0.1..0.3f64, 0.85..0.9f64, 0.5..0.65f64);
    let (axis, dark, bright, rest) = trial.varied((Vec3::Y, 0.2, 0.9, 0.6), hidden);
    let axis = axis.as_dvec3().normalize();
    // The caps are 120 degrees apart, and reach 37 and 73 degrees from their middles, so they do not overlap.
    let other = -0.5 * axis + 0.75f64.sqrt() * axis.any_orthonormal_vector();
    let caps = [
        Cap { axis, height: 0.8, albedo: dark, emission: 1.0 },
        Cap { axis: other, height: 0.3, albedo: bright, emission: 0.0 },
    ];
    // A cap has the share (1 - height) / 2 of the area (Archimedes).
    let shares = caps.each_ref().map(|cap| 0.5 * (1.0 - cap.height));
    let reflected: f64 = caps.iter().zip(shares).map(|(cap, share)| share * cap.albedo).sum::<f64>()
        + (1.0 - shares[0] - shares[1]) * rest;
    let expected = shares[0] / (1.0 - reflected);
    // All paths at once, one bounce after the other.
    struct Path {
        index: usize,
        point: DVec3,
        weight: f64,
    }
    // Start opposite the emitting cap: directions that are too flat reach it too rarely, and those that are too steep too
    // often. From starts all over the sphere the two would cancel.
    let start = |index: usize| nasty::tilted((-axis).as_vec3(), 0.3, index as f64 / 16.0).as_dvec3();
    let mut light = vec![0.0; PATHS];
    let mut paths: Vec<Path> =
        (0..PATHS).map(|index| Path { index, point: start(index), weight: 1.0 }).collect();
    let what = "49,152 paths by cosine_direction and survives in an integrating sphere";
    let (mut bounce, mut steps, mut before) = (0, 0, 0);
    while !paths.is_empty() {
        if are_endless(PATHS, steps) {
            let yours = format!("{} paths are alive after {bounce} bounces", paths.len());
            let broken = Broken::with_texts(what, yours, "no path", "Russian roulette");
            return Err(broken.looks_like(Some("your roulette ends too few paths")));
        }
        bounce += 1;
        before = paths.len();
        steps += before;
        let u = pairs(trial.seed ^ (u64::from(bounce) << 40), 2 * paths.len());
        let (to_hit, to_survive) = u.split_at(paths.len());
        let queries: Vec<_> =
            paths.iter().zip(to_hit).map(|(path, u)| ((-path.point).as_vec3(), *u)).collect();
        for (path, direction) in paths.iter_mut().zip(trial.kit.cosine_direction(&queries)) {
            let direction = direction.as_dvec3().normalize_or_zero();
            path.point = (path.point - 2.0 * path.point.dot(direction) * direction).normalize();
            let cap = caps.iter().find(|cap| path.point.dot(cap.axis) > cap.height);
            light[path.index] += path.weight * cap.map_or(0.0, |cap| cap.emission);
            path.weight *= cap.map_or(rest, |cap| cap.albedo);
        }
        let queries: Vec<RouletteQuery> = paths
            .iter()
            .zip(to_survive)
            .map(|(path, u)| RouletteQuery { weight: Vec3::splat(path.weight as f32), bounce, u: u.x })
            .collect();
        for (path, factor) in paths.iter_mut().zip(trial.kit.survives(&queries)) {
            path.weight *= f64::from(factor);
        }
        // A weight that is NaN stays, and makes the sum NaN.
        for path in paths.iter().filter(|path| path.weight.is_nan()) {
            light[path.index] = f64::NAN;
        }
        paths.retain(|path| path.weight > 0.0);
    }
    has_mean(what, &light, expected, |mean| {
        vec![
            (mean.is_nan(), "a direction or a factor is NaN"),
            // By roulette the last paths end one by one.
            (before > PATHS / 100, "all paths end at the same bounce: let roulette end them, each at random"),
        ]
    })
}
