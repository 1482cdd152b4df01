//! The irradiance of a point by an emitter, which has a closed form: the mean of `cos θ / density` over the samples.

use crate::emitters::{KINDS, Lit};
use crate::light_densities::seen_well;
use crate::lights::with_corners;
use checks::prelude::*;
use checks::statistics::has_mean;

/// A normal for which the whole emitter is above the horizon: not far from the direction to its middle.
fn normal(lit: &Lit, lean: f64) -> DVec3 {
    let middle = lit.toward((0.3, 0.5)).normalize();
    let (x, y) = middle.any_orthonormal_pair();
    let normal = (middle + lean * (0.6 * x + 0.8 * y)).normalize();
    let below = |at: &DVec3| at.dot(normal) <= 0.0;
    if lit.corners().iter().any(below) { middle } else { normal }
}

fn irradiance(trial: &Trial<'_>, kind: usize, lit: &Lit) -> CheckResult {
    let u = with_corners(trial.seed);
    let queries: Vec<EmitterQuery> = u.iter().map(|u: &Vec2| lit.sample(*u)).collect();
    let samples = trial.kit.sample_light(&queries);
    for lean in [0.0, 0.3] {
        let normal = normal(lit, lean);
        let mut values = Vec::new();
        for sample in &samples {
            let Some(sample) = sample else {
                let what = format!("sample_light of {}", KINDS[kind]);
                return Err(Broken::new(what, None::<()>, "a sample", "the emitter sends light here"));
            };
            let cosine = sample.direction.as_dvec3().dot(normal).max(0.0);
            values.push(f64::from(sample.radiance.x) * cosine / f64::from(sample.pdf));
        }
        let expected = f64::from(lit.emitter.radiance.x) * lit.irradiance(normal);
        let what = format!("the irradiance by {}, cos θ · radiance / density", KINDS[kind]);
        has_mean(&what, &values, expected, |mean| {
            let corners = lit.corners();
            let (area, flat) = (lit.area().unwrap_or(1.0), !corners.is_empty());
            // Whether all densities are those of a formula of the distance and the cosine at the emitter.
            let all = |formula: &dyn Fn(f64, f64) -> f64| {
                flat && samples.iter().flatten().all(|sample| {
                    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
                    let facing = sample.direction.as_dvec3().dot(normal).abs();
                    let density = formula(f64::from(sample.distance), facing);
                    (f64::from(sample.pdf) / density - 1.0).abs() < 1e-3
                })
            };
            let is = |found: f64| (found / expected - 1.0).abs() < 0.02;
            vec![
                (all(&|_, _| 1.0 / area), "your density is per area: multiply it by distance² / cos θ"),
                (all(&|d, _| d * d / area), "the cosine at the emitter is missing in your density"),
                (all(&|_, c| 1.0 / (area * c)), "the squared distance is missing in your density"),
                (all(&|d, c| d / (area * c)), "your density has the distance in place of its square"),
                (all(&|d, c| d * d / c), "the area of the emitter is missing in your density"),
                "your solid angle is that of a flat disk: a sphere fills 2π (1 - cos θ), sin θ = R / d".when(
                    kind == 2
                        && samples.iter().flatten().all(|sample| {
                            let disk = lit.irradiance(lit.toward_center().normalize());
                            (f64::from(sample.pdf) * disk - 1.0).abs() < 1e-4
                        }),
                ),
                (is(mean / 2.0), "the irradiance is twice too large"),
                (is(2.0 * mean), "the irradiance is half of what it must be"),
            ]
        })?;
    }
    Ok(())
}

pub(super) fn polygon_lights_give_lamberts_irradiance(trial: &Trial<'_>) -> CheckResult {
    let [parallelogram, triangle, _] = seen_well(trial);
    irradiance(trial, 0, &parallelogram)?;
    irradiance(trial, 1, &triangle)
}

pub(super) fn sphere_lights_give_their_irradiance(trial: &Trial<'_>) -> CheckResult {
    let [_, _, sphere] = seen_well(trial);
    irradiance(trial, 2, &sphere)
}
