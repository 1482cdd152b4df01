//! The light sample of a step: its shadow ray and its weight, and when there must be none.
//!
//! As in `steps`, these checks take the student's samples and densities, and judge how `step` puts them together.

use crate::emitters::layouts;
use crate::steps::{color, describe, numbers, path, path_weight, per_some, probability, vertex};
use checks::prelude::*;
use raykata::emitter::EmitterSample;
use raykata::light_path::{ChosenEmitter, LightCandidate, PathVertex};
use std::f64::consts::{FRAC_1_PI, PI};

/// Queries for the sample of a light: a surface that has the whole emitter above it, or an environment map.
fn lit_surfaces() -> impl Strategy<Value = StepQuery> + Clone {
    let state = (path_weight(), 0..3u32, 1..3u32);
    let surface = (color(), nasty::unit(), 0..=6i32, 0..=15i32);
    (layouts(), probability(), 0..3i32, state, surface, numbers()).prop_map(
        |(layout, probability, which, (weight, bounces, more), (diffuse, axis, angle, turn), numbers)| {
            let lit = layout.lit();
            let (normal, light) = if which == 0 {
                let direction = nasty::tilted(axis, f64::from(angle) / 8.0, f64::from(turn) / 16.0);
                let sample = EmitterSample {
                    direction,
                    distance: f32::INFINITY,
                    radiance: vec3(0.5, 2.0, 1.0),
                    pdf: 0.7 * probability,
                };
                (axis, LightCandidate::Environment(sample))
            } else {
                let normal = lit.toward((0.3, 0.5)).normalize().as_vec3();
                (normal, LightCandidate::Emitter(ChosenEmitter { emitter: lit.emitter, probability }))
            };
            // The shading normal differs a little for the environment map, whose sample is above both.
            let shading =
                if which == 0 { nasty::tilted(normal, 0.3, f64::from(turn) / 16.0) } else { normal };
            let vertex = PathVertex { light: Some(light), ..vertex(lit.from, normal, shading, diffuse) };
            StepQuery {
                path: path(weight, bounces, 1.0, &vertex),
                vertex,
                max_depth: bounces + more,
                numbers,
            }
        },
    )
}

/// The sample of the light of each query, by the student's sample_light, with the density of the choice.
fn light_samples(kit: &dyn Kit, queries: &[StepQuery]) -> Vec<Option<(EmitterSample, f32)>> {
    let ask = |query: &StepQuery| match query.vertex.light {
        Some(LightCandidate::Emitter(chosen)) => Some(EmitterQuery {
            emitter: chosen.emitter,
            from: query.vertex.surface.point,
            u: query.numbers.light,
        }),
        _ => None,
    };
    let samples = per_some(queries, ask, |queries| kit.sample_light(queries));
    queries
        .iter()
        .zip(samples)
        .map(|(query, sample)| match query.vertex.light? {
            LightCandidate::Environment(sample) => Some((sample, 1.0)),
            LightCandidate::Emitter(chosen) => Some((sample??, chosen.probability)),
        })
        .collect()
}

pub(super) fn steps_sample_the_light(trial: &Trial<'_>) -> CheckResult {
    trial.forall(500, lit_surfaces(), |queries| {
        let samples = light_samples(trial.kit, queries);
        let sampled = |(query, sample): (&StepQuery, &Option<(EmitterSample, f32)>)| {
            let direction = sample.map_or(Vec3::Z, |(sample, _)| sample.direction);
            BsdfPdfQuery { scattering: query.vertex.scattering.clone(), direction }
        };
        let bsdf_pdfs = trial.kit.bsdf_pdf(&queries.iter().zip(&samples).map(sampled).collect::<Vec<_>>());
        // The density times the probability of the choice to this power.
        let pairs = |power: i32| -> Vec<(f32, f32)> {
            let own = |sample: &Option<(EmitterSample, f32)>| {
                sample.map_or(1.0, |(sample, choice)| sample.pdf * choice.powi(power))
            };
            samples.iter().zip(&bsdf_pdfs).map(|(sample, other)| (own(sample), *other)).collect()
        };
        let all = [1, 0, -1].map(|power| trial.kit.mis_weight(&pairs(power)));
        let weights: Vec<[f32; 3]> = (0..queries.len()).map(|n| all.each_ref().map(|of| of[n])).collect();
        let answers: Vec<_> = trial.kit.step(queries).into_iter().zip(samples).zip(weights).collect();
        // The light without the weight of the path and that of multiple importance sampling, and the cosine.
        let unweighted = |query: &StepQuery, sample: &EmitterSample, choice: f32| {
            let cosine = query.vertex.surface.shading_normal.as_dvec3().dot(sample.direction.as_dvec3());
            let density = f64::from(sample.pdf) * f64::from(choice);
            (FRAC_1_PI * cosine / density)
                * query.vertex.scattering.diffuse.as_dvec3()
                * sample.radiance.as_dvec3()
        };
        let near = |yours: Vec3, expected: DVec3| {
            (yours.as_dvec3() - expected).abs().max_element() <= 2e-5 * expected.max_element() + 1e-30
        };
        compare_formulas(
            queries,
            answers,
            |query, ((step, sample), [weight, ..])| {
                // A triangle can be so far to the side that a sample is below the horizon, and is seen from no angle.
                let Some((sample, choice)) = sample else { return Ok(()) };
                let cosine = query.vertex.surface.shading_normal.dot(sample.direction);
                if cosine < 1e-3 || query.vertex.surface.geometric_normal.dot(sample.direction) < 1e-3 {
                    return Ok(());
                }
                let expected =
                    f64::from(weight) * query.path.weight.as_dvec3() * unweighted(query, &sample, choice);
                let is_same = |shadow: &raykata::light_path::ShadowQuestion| {
                    let off = (shadow.direction - sample.direction).length();
                    let is_at = shadow.distance == sample.distance
                        || (shadow.distance / sample.distance - 1.0).abs() < 1e-5;
                    off < 1e-5 && is_at && near(shadow.light, expected)
                };
                if step.shadow.as_ref().is_some_and(is_same) {
                    return Ok(());
                }
                let yours = format!("{:?}", step.shadow);
                let expected = format!(
                    "direction {}, distance {}, light {}",
                    sample.direction,
                    sample.distance,
                    expected.as_vec3()
                );
                let broken =
                    Broken::with_texts(describe(query), yours, expected, "sample_light_contribution");
                let is_endless = |distance: f32| distance > 1e3 * sample.distance;
                let endless = step.shadow.as_ref().is_some_and(|shadow| is_endless(shadow.distance));
                Err(broken.explained_by([
                    (step.shadow.is_none(), "no shadow ray: the light is not sampled"),
                    "the shadow ray has no end: it ends at the distance of the sample"
                        .when(endless && sample.distance.is_finite()),
                ]))
            },
            |query, ((step, sample), weights)| {
                let (Some((sample, choice)), Some(shadow)) = (sample, &step.shadow) else {
                    return vec![(false, ""); 9];
                };
                let [weight, unscaled, divided] = weights.map(f64::from);
                let whole = query.path.weight.as_dvec3() * unweighted(query, sample, *choice);
                let choice = f64::from(*choice);
                let surface = &query.vertex.surface;
                let [by_geometric, by_shading] = [surface.geometric_normal, surface.shading_normal]
                    .map(|normal| f64::from(normal.dot(sample.direction)).max(1e-9));
                named![
                    shadow.light.is_nan() => "you return NaN",
                    near(shadow.light, choice * unscaled * whole) =>
                        "the probability with which the emitter is chosen is missing in the density",
                    near(shadow.light, choice * choice * divided * whole) =>
                        "you divide the density by the probability of the emitter: multiply",
                    near(shadow.light, choice * weight * whole) =>
                        "you do not divide by the probability with which the emitter is chosen",
                    near(shadow.light, whole) => "the weight of multiple importance sampling is missing, so light counts twice",
                    near(shadow.light, weight * unweighted(query, sample, choice as f32)) => "the weight of the path is missing",
                    near(shadow.light, PI * weight * whole) => "a diffuse surface sends kd / π on: the π is missing",
                    near(shadow.light, by_geometric / by_shading * weight * whole) =>
                        "the cosine is that of the geometric normal: use the shading normal",
                    (shadow.direction + sample.direction).length() < 1e-5 => "your shadow ray points from the light to the surface",
                ].to_vec()
            },
        )
    })
}

/// Reasons for which no shadow ray is needed.
const USELESS: [&str; 8] = [
    "a path that has max_depth bounces ends: it samples no light",
    "a surface without diffuse reflectance sends no light of a sample on",
    "there is no light to sample",
    "the light is below the surface by its shading normal",
    "the light is below the surface by its geometric normal",
    "the emitter sends no light here: its back is dark",
    "the light has no channel that the surface reflects",
    "the path has no weight in a channel of this light",
];

pub(super) fn steps_ask_for_no_useless_shadow_ray(trial: &Trial<'_>) -> CheckResult {
    // One case of nine needs its shadow ray.
    let strategy = (lit_surfaces(), 0..=USELESS.len()).prop_map(|(query, which)| {
        let StepQuery { mut path, mut vertex, mut max_depth, numbers } = query;
        let toward = match vertex.light {
            Some(LightCandidate::Environment(sample)) => sample.direction,
            _ => vertex.surface.geometric_normal,
        };
        match which {
            0 => max_depth = path.bounces,
            1 => vertex.scattering.diffuse = Vec3::ZERO,
            2 => vertex.light = None,
            3 | 4 => {
                // A direction that is above one normal only, at a distance of 0.3 from both horizons.
                let away = nasty::tilted(toward, std::f64::consts::FRAC_PI_2 + 0.3, 0.2);
                let sample = EmitterSample {
                    direction: toward,
                    distance: f32::INFINITY,
                    radiance: Vec3::ONE,
                    pdf: 0.5,
                };
                vertex.light = Some(LightCandidate::Environment(sample));
                let (geometric, shading) = if which == 3 { (toward, away) } else { (away, toward) };
                vertex.surface =
                    Surface { geometric_normal: geometric, shading_normal: shading, ..vertex.surface };
                vertex.scattering.normal = shading;
            }
            5 => {
                if let Some(LightCandidate::Emitter(chosen)) = &mut vertex.light {
                    chosen.emitter.radiance = Vec3::ZERO;
                } else {
                    vertex.light = None;
                }
            }
            6 | 7 => {
                let green = vec3(0.0, 1.0, 0.0);
                match &mut vertex.light {
                    Some(LightCandidate::Emitter(chosen)) => chosen.emitter.radiance = green,
                    Some(LightCandidate::Environment(sample)) => sample.radiance = green,
                    None => {}
                }
                if which == 6 { vertex.scattering.diffuse.y = 0.0 } else { path.weight.y = 0.0 }
            }
            _ => {}
        }
        (StepQuery { path, vertex, max_depth, numbers }, which)
    });
    trial.forall(400, strategy, |cases| {
        let queries: Vec<StepQuery> = cases.iter().map(|(query, _)| query.clone()).collect();
        let samples = light_samples(trial.kit, &queries);
        let answers: Vec<_> = trial.kit.step(&queries).into_iter().zip(samples).collect();
        compare(cases, answers, |(query, which), (step, sample)| {
            // Whether the case that needs a shadow ray has a sample well above both horizons.
            let surface = &query.vertex.surface;
            let above = |(sample, _): (EmitterSample, f32)| {
                surface.geometric_normal.dot(sample.direction) > 1e-3
                    && surface.shading_normal.dot(sample.direction) > 1e-3
            };
            let is_needed = *which == USELESS.len();
            let is_free = !is_needed || !sample.is_some_and(above);
            let right = if step.shadow.is_some() { is_needed } else { is_free };
            if right {
                return Ok(());
            }
            let expected = if is_needed { "a shadow ray" } else { "no shadow ray" };
            let yours = if is_needed {
                "no shadow ray".to_owned()
            } else {
                format!("a shadow ray: {:?}", step.shadow)
            };
            Err(Broken::with_texts(describe(query), yours, expected, "the definition").explained_by(
                USELESS.iter().enumerate().map(|(index, reason)| (index == *which, *reason)).chain([
                    (is_needed, "this light must be sampled"),
                    "a shadow ray is traced although its light is 0: compare the light with 0 first"
                        .when(step.shadow.is_some_and(|shadow| shadow.light == Vec3::ZERO)),
                ]),
            ))
        })
    })
}
