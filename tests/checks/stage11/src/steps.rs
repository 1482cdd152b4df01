//! One step of a path: `step`, from the student's own parts of it.
//!
//! What the parts return is judged by their own checks. So these checks take the student's samples, densities and weights, and
//! judge how `step` puts them together.

use crate::emitters::layouts;
use crate::lobes::{missing, surfaces};
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::magnitude;
use checks::judge::{compare, compare_formulas};
use checks::nasty;
use glam::{DVec3, Vec2, Vec3, vec3};
use proptest::prelude::*;
use raykata::emitter::EmitterSample;
use raykata::kit::{
    BsdfPdfQuery, BsdfQuery, EmitterPdfQuery, EmitterQuery, Kit, RouletteQuery, StepQuery, Surface,
};
use raykata::light_path::{
    BsdfSample, ChosenEmitter, LightCandidate, Lobe, PathState, PathStep, PathVertex, Scattering, StepNumbers,
};
use std::f64::consts::{FRAC_1_PI, PI};

/// A query for a message: the parts that matter here.
fn describe(query: &StepQuery) -> String {
    let StepQuery { path, vertex, max_depth, .. } = query;
    let PathVertex { surface, scattering, emission, emitter, light } = vertex;
    format!(
        "step of a path with weight {}, {} bounces and pdf {:?}, with max_depth {max_depth},\nat a surface with diffuse {}, {} secondary rays, emission {emission} ({}), normals {} and {},\nwith {}",
        path.weight,
        path.bounces,
        path.pdf,
        scattering.diffuse,
        scattering.secondary.len(),
        if emitter.is_some() { "of an emitter that is sampled" } else { "not sampled" },
        surface.geometric_normal,
        surface.shading_normal,
        match light {
            None => "no light to sample".to_owned(),
            Some(LightCandidate::Environment(sample)) =>
                format!("a sample of the environment map along {}", sample.direction),
            Some(LightCandidate::Emitter(chosen)) =>
                format!("a light to sample with probability {}", chosen.probability),
        }
    )
}

fn color() -> impl Strategy<Value = Vec3> + Clone {
    let channel = || (1..=8i32).prop_map(|n| n as f32 / 8.0);
    (channel(), channel(), channel()).prop_map(|(x, y, z)| vec3(x, y, z))
}

fn numbers() -> impl Strategy<Value = StepNumbers> + Clone {
    let number = || (0..256u32).prop_map(|n| (n as f32 + 0.5) / 256.0);
    prop::array::uniform6(number()).prop_map(|u| StepNumbers {
        light: Vec2::new(u[0], u[1]),
        bsdf: vec3(u[2], u[3], u[4]),
        roulette: u[5],
    })
}

fn pdf() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![1 => Just(f32::INFINITY), 3 => magnitude(-2.0, 2.0)]
}

/// The probability with which an emitter is chosen. It is 1 in one of four.
fn probability() -> impl Strategy<Value = f32> + Clone {
    (1..=4i32).prop_map(|n| n as f32 / 4.0)
}

/// A diffuse surface at a point, with both normals.
fn vertex(point: Vec3, geometric_normal: Vec3, shading_normal: Vec3, diffuse: Vec3) -> PathVertex {
    PathVertex {
        surface: Surface { point, error: 1e-6 * point.abs(), geometric_normal, shading_normal },
        scattering: Scattering { diffuse, normal: shading_normal, secondary: Vec::new() },
        emission: Vec3::ZERO,
        emitter: None,
        light: None,
    }
}

/// A path that arrives at a surface from above, after this number of bounces.
fn path(weight: Vec3, bounces: u32, pdf: f32, vertex: &PathVertex) -> PathState {
    let direction = -vertex.surface.geometric_normal;
    PathState { origin: vertex.surface.point - direction, direction, weight, bounces, pdf }
}

pub(super) fn steps_collect_the_emission(trial: &Trial<'_>) -> CheckResult {
    // The point that the path meets lies on an emitter, which its previous point sees from the front.
    let place = (1..8i32, 1..8i32).prop_map(|(s, t)| (f64::from(s) / 8.0, f64::from(t) / 8.0));
    let emitter = (layouts(), place, probability(), 0..3i32);
    let state = (color(), 0..4u32, pdf(), 0..3u32);
    let strategy = (emitter, state, color(), numbers()).prop_map(
        |((layout, place, probability, is_sampled), state, emission, numbers)| {
            let (weight, bounces, pdf, more) = state;
            let lit = layout.lit();
            let to_point = lit.toward(place);
            let direction = to_point.normalize().as_vec3();
            let point = (lit.from.as_dvec3() + to_point).as_vec3();
            let emitter = ChosenEmitter { emitter: lit.emitter, probability };
            StepQuery {
                path: PathState { origin: lit.from, direction, weight, bounces, pdf },
                vertex: PathVertex {
                    emission,
                    emitter: (is_sampled > 0).then_some(emitter),
                    ..vertex(point, -direction, -direction, Vec3::splat(0.5))
                },
                max_depth: bounces + more,
                numbers,
            }
        },
    );
    trial.forall(500, strategy, |queries| {
        let density = |query: &StepQuery| {
            let emitter = query.vertex.emitter.map(|chosen| chosen.emitter);
            emitter.map(|emitter| EmitterPdfQuery {
                emitter,
                from: query.path.origin,
                direction: query.path.direction,
            })
        };
        let densities = per_some(queries, density, |queries| trial.kit.light_pdf(queries));
        let light_pdfs: Vec<f32> = queries
            .iter()
            .zip(&densities)
            .map(|(query, density)| {
                query.vertex.emitter.map_or(0.0, |chosen| chosen.probability * density.unwrap_or(0.0))
            })
            .collect();
        let pairs: Vec<(f32, f32)> =
            queries.iter().zip(&light_pdfs).map(|(query, light)| (query.path.pdf, *light)).collect();
        let unscaled: Vec<(f32, f32)> = queries
            .iter()
            .zip(&densities)
            .map(|(query, density)| (query.path.pdf, density.unwrap_or(0.0)))
            .collect();
        let answers: Vec<_> = trial
            .kit
            .step(queries)
            .into_iter()
            .zip(trial.kit.mis_weight(&pairs))
            .zip(trial.kit.mis_weight(&unscaled))
            .collect();
        // The roundings of a few products.
        let near = |yours: Vec3, expected: DVec3| {
            (yours.as_dvec3() - expected).abs().max_element() <= 1e-5 * expected.max_element() + 1e-30
        };
        compare_formulas(
            queries,
            answers,
            |query, ((step, weight), _)| {
                let is_whole = query.path.pdf == f32::INFINITY || query.vertex.emitter.is_none();
                let weight = if is_whole { 1.0 } else { f64::from(weight) };
                let expected = weight * (query.path.weight * query.vertex.emission).as_dvec3();
                if near(step.light, expected) {
                    return Ok(());
                }
                let yours = format!("light {}", step.light);
                Err(Broken::with_texts(
                    describe(query),
                    yours,
                    format!("{}", expected.as_vec3()),
                    "weight · emitted_contribution",
                ))
            },
            |query, ((step, weight), unscaled)| {
                let whole = (query.path.weight * query.vertex.emission).as_dvec3();
                let is_whole = query.path.pdf == f32::INFINITY || query.vertex.emitter.is_none();
                let weight = if is_whole { 1.0 } else { f64::from(*weight) };
                let unscaled = if is_whole { 1.0 } else { f64::from(*unscaled) };
                let is_last = query.path.bounces == query.max_depth;
                vec![
                    (step.light.is_nan(), "you return NaN"),
                    (
                        near(step.light, if is_last { DVec3::ZERO } else { weight * whole }),
                        "the light of the last surface is lost: collect it before the path ends",
                    ),
                    (
                        near(step.light, whole),
                        "light that is sampled as well counts in full here, so it counts twice",
                    ),
                    (
                        near(step.light, unscaled * whole),
                        "the probability with which the emitter is chosen is missing in its density",
                    ),
                    (
                        near(step.light, weight * query.vertex.emission.as_dvec3()),
                        "the weight of the path is missing",
                    ),
                    (step.light == Vec3::ZERO, "the emission of the surface is missing"),
                    (
                        near(step.light, if query.path.bounces == 0 { weight * whole } else { DVec3::ZERO }),
                        "emission counts only where the camera sees it",
                    ),
                    (
                        near(step.light, if query.path.pdf == f32::INFINITY { whole } else { DVec3::ZERO }),
                        "emission counts only for camera rays and mirrors: diffuse rays find light, too",
                    ),
                ]
            },
        )
    })
}

/// The answers of a function to those queries that are there.
fn per_some<Q, P, A>(
    queries: &[Q],
    ask: impl Fn(&Q) -> Option<P>,
    answer: impl Fn(&[P]) -> Vec<A>,
) -> Vec<Option<A>> {
    let asked: Vec<Option<P>> = queries.iter().map(ask).collect();
    let there: Vec<bool> = asked.iter().map(Option::is_some).collect();
    let mut answers = answer(&asked.into_iter().flatten().collect::<Vec<_>>()).into_iter();
    there.into_iter().map(|there| if there { answers.next() } else { None }).collect()
}

/// Queries for the sample of a light: a surface that has the whole emitter above it, or an environment map.
fn lit_surfaces() -> impl Strategy<Value = StepQuery> + Clone {
    let state = (color(), 0..3u32, 1..3u32);
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
        let pairs = |scaled: bool| -> Vec<(f32, f32)> {
            let own = |sample: &Option<(EmitterSample, f32)>| {
                sample.map_or(1.0, |(sample, choice)| sample.pdf * if scaled { choice } else { 1.0 })
            };
            samples.iter().zip(&bsdf_pdfs).map(|(sample, other)| (own(sample), *other)).collect()
        };
        let weights: Vec<(f32, f32)> =
            trial.kit.mis_weight(&pairs(true)).into_iter().zip(trial.kit.mis_weight(&pairs(false))).collect();
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
            |query, ((step, sample), (weight, _))| {
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
                Err(broken.explained_by([(step.shadow.is_none(), "no shadow ray: the light is not sampled")]))
            },
            |query, ((step, sample), (weight, unscaled))| {
                let (Some((sample, choice)), Some(shadow)) = (sample, &step.shadow) else {
                    return vec![(false, ""); 7];
                };
                let (weight, unscaled) = (f64::from(*weight), f64::from(*unscaled));
                let whole = query.path.weight.as_dvec3() * unweighted(query, sample, *choice);
                let choice = f64::from(*choice);
                vec![
                    (shadow.light.is_nan(), "you return NaN"),
                    (
                        near(shadow.light, choice * unscaled * whole),
                        "the probability with which the emitter is chosen is missing in the density",
                    ),
                    (
                        near(shadow.light, choice * weight * whole),
                        "you do not divide by the probability with which the emitter is chosen",
                    ),
                    (
                        near(shadow.light, whole),
                        "the weight of multiple importance sampling is missing, so light counts twice",
                    ),
                    (
                        near(shadow.light, weight * unweighted(query, sample, choice as f32)),
                        "the weight of the path is missing",
                    ),
                    (
                        near(shadow.light, PI * weight * whole),
                        "a diffuse surface sends kd / π on: the π is missing",
                    ),
                    (
                        (shadow.direction + sample.direction).length() < 1e-5,
                        "your shadow ray points from the light to the surface",
                    ),
                ]
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
            let right = match step.shadow {
                Some(_) => is_needed,
                None => !is_needed || !sample.is_some_and(above),
            };
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
                    (
                        step.shadow.is_some_and(|shadow| shadow.light == Vec3::ZERO),
                        "a shadow ray is traced although its light is 0: compare the light with 0 first",
                    ),
                ]),
            ))
        })
    })
}

pub(super) fn steps_end_at_the_greatest_depth(trial: &Trial<'_>) -> CheckResult {
    // A path whose weight stays 1 does not end before.
    let strategy =
        (nasty::unit(), 0..8u32, 0..8u32, numbers()).prop_map(|(normal, bounces, max_depth, numbers)| {
            let vertex = vertex(Vec3::ONE, normal, normal, Vec3::ONE);
            StepQuery { path: path(Vec3::ONE, bounces, f32::INFINITY, &vertex), vertex, max_depth, numbers }
        });
    trial.forall(300, strategy, |queries| {
        compare(queries, trial.kit.step(queries), |query, step| {
            let (bounces, max_depth) = (query.path.bounces, query.max_depth);
            let goes_on = bounces < max_depth;
            if step.next.is_some() == goes_on {
                return Ok(());
            }
            let says = |goes_on: bool| if goes_on { "the path continues" } else { "the path ends" };
            let broken = Broken::with_texts(
                describe(query),
                says(!goes_on),
                says(goes_on),
                "at most max_depth bounces",
            );
            Err(broken.explained_by([
                (bounces == max_depth, "one bounce too many: a path with max_depth bounces ends"),
                (!goes_on, "paths do not end at max_depth"),
                (
                    bounces + 1 == max_depth,
                    "one bounce too few: a path with fewer than max_depth bounces continues",
                ),
                (goes_on, "a path whose weight is 1 continues"),
            ]))
        })
    })
}

pub(super) fn steps_continue_with_the_weight_of_the_sample(trial: &Trial<'_>) -> CheckResult {
    let state = (color(), 0..8u32, pdf());
    // The geometric normal is at an angle of up to 1 to the shading normal, so some diffuse directions are below it.
    let turned = (0..=4i32, 0..=15i32)
        .prop_map(|(angle, turn)| (f64::from(angle) / 4.0, f64::from(turn) / 16.0 + 0.01));
    let strategy = (surfaces(), turned, state, numbers()).prop_map(
        |(scattering, (angle, turn), (weight, bounces, pdf), numbers)| {
            let geometric = nasty::tilted(scattering.normal, angle, turn);
            let vertex = PathVertex {
                scattering: scattering.clone(),
                ..vertex(Vec3::ONE, geometric, scattering.normal, Vec3::ZERO)
            };
            StepQuery { path: path(weight, bounces, pdf, &vertex), vertex, max_depth: bounces + 1, numbers }
        },
    );
    trial.forall(800, strategy, |queries| {
        let ask = |query: &StepQuery| BsdfQuery {
            scattering: query.vertex.scattering.clone(),
            u: query.numbers.bsdf,
        };
        let samples = trial.kit.sample_bsdf(&queries.iter().map(ask).collect::<Vec<_>>());
        let roulette = |bounce: u32, query: &StepQuery, sample: &Option<BsdfSample>| {
            let weight = sample.map_or(Vec3::ZERO, |sample| query.path.weight * sample.weight);
            RouletteQuery { weight, bounce: query.path.bounces + bounce, u: query.numbers.roulette }
        };
        let factors = |bounce: u32| {
            let queries: Vec<_> =
                queries.iter().zip(&samples).map(|(query, sample)| roulette(bounce, query, sample)).collect();
            trial.kit.survives(&queries)
        };
        let factors: Vec<[f32; 3]> = factors(1)
            .into_iter()
            .zip(factors(0))
            .zip(factors(2))
            .map(|((right, early), late)| [right, early, late])
            .collect();
        let answers: Vec<_> = trial.kit.step(queries).into_iter().zip(samples).zip(factors).collect();
        // Whether a step continues along the sample with this weight, or ends if the weight is 0.
        let is = |step: &PathStep, sample: &BsdfSample, weight: DVec3| match &step.next {
            None => weight == DVec3::ZERO,
            Some(next) => {
                let near =
                    (next.weight.as_dvec3() - weight).abs().max_element() <= 1e-5 * weight.max_element();
                let same_pdf = next.pdf == sample.pdf || (next.pdf / sample.pdf - 1.0).abs() < 1e-5;
                let same_way =
                    next.lobe == sample.lobe && (next.direction - sample.direction).length() < 1e-5;
                weight != DVec3::ZERO && near && same_pdf && same_way
            }
        };
        let above = |query: &StepQuery, sample: &BsdfSample| {
            query.vertex.surface.geometric_normal.as_dvec3().dot(sample.direction.as_dvec3())
        };
        compare_formulas(
            queries,
            answers,
            |query, ((step, sample), [factor, ..])| {
                let Some(sample) = sample else {
                    return match step.next {
                        None => missing(&ask(query)),
                        Some(_) => Err(Broken::new(
                            describe(query),
                            step.next,
                            None::<()>,
                            "sample_bsdf returns None",
                        )),
                    };
                };
                let height = above(query, &sample);
                // At the horizon a rounding decides.
                if sample.lobe == Lobe::Diffuse && height.abs() < 1e-5 {
                    return Ok(());
                }
                let ends = sample.lobe == Lobe::Diffuse && height < 0.0;
                let weight = f64::from(factor) * (query.path.weight * sample.weight).as_dvec3();
                let weight = if ends { DVec3::ZERO } else { weight };
                if is(&step, &sample, weight) {
                    return Ok(());
                }
                let expected = match weight == DVec3::ZERO {
                    true => "None: the path ends".to_owned(),
                    false => format!(
                        "{:?} along {} with weight {} and pdf {:?}",
                        sample.lobe,
                        sample.direction,
                        weight.as_vec3(),
                        sample.pdf
                    ),
                };
                let source = "path.weight · weight of sample_bsdf · survives";
                let yours = step.next.map_or("None: the path ends".to_owned(), |next| {
                    format!(
                        "{:?} along {} with weight {} and pdf {:?}",
                        next.lobe, next.direction, next.weight, next.pdf
                    )
                });
                Err(Broken::with_texts(describe(query), yours, expected, source))
            },
            |query, ((step, sample), [factor, early, late])| {
                let Some(sample) = sample else {
                    return vec![(step.next.is_none() && missing(&ask(query)).is_ok(), ""); 8];
                };
                let whole = (query.path.weight * sample.weight).as_dvec3();
                let below = sample.lobe == Lobe::Diffuse && above(query, sample) < 0.0;
                let unless_below = |weight: DVec3| if below { DVec3::ZERO } else { weight };
                let by = |factor: &f32| f64::from(*factor);
                let alive = if *factor == 0.0 { 0.0 } else { 1.0 };
                vec![
                    (step.next.is_some_and(|next| next.weight.is_nan()), "you return NaN"),
                    (
                        is(step, sample, by(factor) * whole),
                        "a diffuse ray below the geometric normal hits its own surface: end the path",
                    ),
                    (
                        is(step, sample, unless_below(alive * whole)),
                        "the factor of survives is missing in the weight",
                    ),
                    (is(step, sample, unless_below(whole)), "there is no Russian roulette"),
                    (
                        is(step, sample, unless_below(by(early) * whole)),
                        "the roulette counts surfaces: path.bounces + 1",
                    ),
                    (
                        is(step, sample, unless_below(by(late) * whole)),
                        "the roulette counts one surface too many: path.bounces + 1",
                    ),
                    (
                        is(step, sample, unless_below(by(factor) * sample.weight.as_dvec3())),
                        "the weight of the path is missing",
                    ),
                    (
                        is(
                            step,
                            &BsdfSample { pdf: f32::INFINITY, ..*sample },
                            unless_below(by(factor) * whole),
                        ),
                        "the density of a diffuse ray is that of sample_bsdf",
                    ),
                ]
            },
        )
    })
}
