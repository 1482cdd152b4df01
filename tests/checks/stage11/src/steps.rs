//! One step of a path: `step`, from the student's own parts of it. `light_steps` judges its light sample.
//!
//! What the parts return is judged by their own checks. So these checks take the student's samples, densities and weights, and
//! judge how `step` puts them together.

use crate::emitters::layouts;
use crate::lobes::{missing, surfaces};
use checks::prelude::*;
use raykata::light_path::{
    BsdfSample, ChosenEmitter, Lobe, NextRay, PathState, PathStep, PathVertex, Scattering, StepNumbers,
};

pub(super) fn describe(query: &StepQuery) -> String {
    format!("step of a path after {} bounces, with max_depth {}", query.path.bounces, query.max_depth)
}

pub(super) fn color() -> impl Strategy<Value = Vec3> + Clone {
    checks::generate::vector(fractions(1..=8, 8.0))
}

/// The weight of a path: in half of the cases as small as 1e-4.
pub(super) fn path_weight() -> impl Strategy<Value = Vec3> + Clone {
    (color(), prop_oneof![Just(1.0f32), magnitude(-4.0, 0.0)]).prop_map(|(color, scale)| scale * color)
}

pub(super) fn numbers() -> impl Strategy<Value = StepNumbers> + Clone {
    let number = || (0..256u32).prop_map(|n| (n as f32 + 0.5) / 256.0);
    // Paths of small weight survive with numbers near an end.
    let roulette = prop_oneof![4 => number(), 1 => Just(1e-5f32), 1 => Just(1.0 - 1e-5f32)];
    (prop::array::uniform5(number()), roulette).prop_map(|(u, roulette)| StepNumbers {
        light: Vec2::new(u[0], u[1]),
        bsdf: vec3(u[2], u[3], u[4]),
        roulette,
    })
}

/// The density of a direction that is certain: so large that its weight is 1 up to rounding, and its square is finite. What
/// `mis_weight` returns for ∞ is judged by a check of its own.
const CERTAIN: f32 = 1e18;

fn pdf() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![1 => Just(CERTAIN), 3 => magnitude(-2.0, 2.0)]
}

/// The probability with which an emitter is chosen. It is 1 in one of four.
pub(super) fn probability() -> impl Strategy<Value = f32> + Clone {
    fractions(1..=4, 4.0)
}

/// A diffuse surface at a point, with both normals.
pub(super) fn vertex(point: Vec3, geometric_normal: Vec3, shading_normal: Vec3, diffuse: Vec3) -> PathVertex {
    PathVertex {
        surface: Surface { point, error: 1e-6 * point.abs(), geometric_normal, shading_normal },
        scattering: Scattering { diffuse, normal: shading_normal, secondary: Vec::new() },
        emission: Vec3::ZERO,
        emitter: None,
        light: None,
    }
}

/// A path that arrives at a surface from above, after this number of bounces.
pub(super) fn path(weight: Vec3, bounces: u32, pdf: f32, vertex: &PathVertex) -> PathState {
    let direction = -vertex.surface.geometric_normal;
    PathState { origin: vertex.surface.point - direction, direction, weight, bounces, pdf }
}

pub(super) fn steps_collect_the_emission(trial: &Trial<'_>) -> CheckResult {
    // The point that the path meets lies on an emitter, which its previous point sees from the front.
    let place = (1..8i32, 1..8i32).prop_map(|(s, t)| (f64::from(s) / 8.0, f64::from(t) / 8.0));
    let emitter = (layouts(), place, probability(), 0..3i32);
    let state = (path_weight(), 0..4u32, pdf(), 0..3u32);
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
        // The densities from the point that the ray left, or from the one that it met.
        let densities = [true, false].map(|is_origin| {
            let density = |query: &StepQuery| {
                let from = if is_origin { query.path.origin } else { query.vertex.surface.point };
                let direction = query.path.direction;
                let emitter = query.vertex.emitter.map(|chosen| chosen.emitter);
                emitter.map(|emitter| EmitterPdfQuery { emitter, from, direction })
            };
            per_some(queries, density, |queries| trial.kit.light_pdf(queries))
        });
        // The densities of the path and of the emitter's sample, the latter with the probability of the choice or without it.
        let weights = |from: usize, by_choice: bool| {
            let pair = |(query, density): (&StepQuery, &Option<f32>)| {
                let probability = query.vertex.emitter.map_or(0.0, |chosen| chosen.probability);
                let factor = if by_choice { probability } else { 1.0 };
                (query.path.pdf, factor * density.unwrap_or(0.0))
            };
            trial.kit.mis_weight(&queries.iter().zip(&densities[from]).map(pair).collect::<Vec<_>>())
        };
        let answers: Vec<_> = trial
            .kit
            .step(queries)
            .into_iter()
            .zip(weights(0, true))
            .zip(weights(0, false))
            .zip(weights(1, true))
            .collect();
        // Light counts in full if the ray is certain, or if no sample finds the emitter.
        let counting = |query: &StepQuery, weight: f32| {
            let is_whole = query.path.pdf == CERTAIN || query.vertex.emitter.is_none();
            if is_whole { 1.0 } else { f64::from(weight) }
        };
        // The roundings of a few products.
        let near = |yours: Vec3, expected: DVec3| {
            (yours.as_dvec3() - expected).abs().max_element() <= 1e-5 * expected.max_element() + 1e-30
        };
        compare(queries, answers, |query, (((step, weight), unscaled), from_hit)| {
            let whole = (query.path.weight * query.vertex.emission).as_dvec3();
            let [weight, unscaled, from_hit] =
                [weight, unscaled, from_hit].map(|weight| counting(query, weight));
            let broken = || {
                let (yours, expected) = (format!("light {}", step.light), (weight * whole).as_vec3());
                let expected = format!("{expected}");
                Broken::with_texts(describe(query), yours, expected, "weight · emitted_contribution")
            };
            let is_last = query.path.bounces == query.max_depth;
            unless(near(step.light, weight * whole), broken).formulas([
                (step.light.is_nan(), "you return NaN"),
                "the light of the last surface is lost: collect it before the path ends"
                    .when(near(step.light, if is_last { DVec3::ZERO } else { weight * whole })),
                "light that is sampled as well counts in full here, so it counts twice"
                    .when(near(step.light, whole)),
                "the probability with which the emitter is chosen is missing in its density"
                    .when(near(step.light, unscaled * whole)),
                "light_pdf is asked from the surface that the ray met: ask it from path.origin"
                    .when(near(step.light, from_hit * whole)),
                "the weight of the path is missing"
                    .when(near(step.light, weight * query.vertex.emission.as_dvec3())),
                (step.light == Vec3::ZERO, "the emission of the surface is missing"),
                "emission counts only where the camera sees it".when(near(
                    step.light,
                    if query.path.bounces == 0 { weight * whole } else { DVec3::ZERO },
                )),
                "emission counts only for camera rays and mirrors: diffuse rays find light, too"
                    .when(near(step.light, if query.path.pdf == CERTAIN { whole } else { DVec3::ZERO })),
            ])
        })
    })
}

/// The answers of a function to those queries that are there.
pub(super) fn per_some<Q, P, A>(
    queries: &[Q],
    ask: impl Fn(&Q) -> Option<P>,
    answer: impl Fn(&[P]) -> Vec<A>,
) -> Vec<Option<A>> {
    let asked: Vec<Option<P>> = queries.iter().map(ask).collect();
    let there: Vec<bool> = asked.iter().map(Option::is_some).collect();
    let mut answers = answer(&asked.into_iter().flatten().collect::<Vec<_>>()).into_iter();
    there.into_iter().map(|there| if there { answers.next() } else { None }).collect()
}

pub(super) fn steps_end_at_the_greatest_depth(trial: &Trial<'_>) -> CheckResult {
    // A path whose weight stays 1 does not end before.
    let strategy =
        (nasty::unit(), 0..8u32, 0..8u32, numbers()).prop_map(|(normal, bounces, max_depth, numbers)| {
            let vertex = vertex(Vec3::ONE, normal, normal, Vec3::ONE);
            let numbers = StepNumbers { roulette: 0.5, ..numbers };
            StepQuery { path: path(Vec3::ONE, bounces, CERTAIN, &vertex), vertex, max_depth, numbers }
        });
    trial.each(300, strategy, <dyn Kit>::step, |query, step| {
        let (bounces, max_depth) = (query.path.bounces, query.max_depth);
        let goes_on = bounces < max_depth;
        if step.next.is_some() == goes_on {
            return Ok(());
        }
        let says = |goes_on: bool| if goes_on { "the path continues" } else { "the path ends" };
        let broken =
            Broken::with_texts(describe(query), says(!goes_on), says(goes_on), "at most max_depth bounces");
        Err(broken.explained_by(named![
            bounces == max_depth => "one bounce too many: a path with max_depth bounces ends",
            !goes_on => "paths do not end at max_depth",
            bounces + 1 == max_depth => "one bounce too few: a path with fewer than max_depth bounces continues",
            goes_on => "a path whose weight is 1 continues",
        ]))
    })
}

/// The density of a diffuse sample without the probability of its lobe.
fn cosine_pdf(query: &StepQuery, sample: &BsdfSample) -> f32 {
    let cosine = query.vertex.scattering.normal.dot(sample.direction).max(0.0);
    if sample.lobe == Lobe::Diffuse { cosine / std::f32::consts::PI } else { sample.pdf }
}

/// The ray along which a path continues, in words.
fn says(next: Option<NextRay>) -> String {
    next.map_or("None: the path ends".to_owned(), |NextRay { lobe, direction, weight, pdf }| {
        format!("{lobe:?} along {direction} with weight {weight} and pdf {pdf:?}")
    })
}

/// What a step gives to Russian roulette: the right arguments first.
#[derive(Clone, Copy)]
enum Roulette {
    Bounce(u32),
    OfPath,
    OfSample,
    OfSurface,
    Number(usize),
}

const ROULETTES: [(Roulette, &str); 11] = named![
    Roulette::Bounce(1) => "",
    Roulette::Bounce(0) => "the roulette counts surfaces: path.bounces + 1",
    Roulette::Bounce(2) => "the roulette counts one surface too many: path.bounces + 1",
    Roulette::OfPath => "the roulette gets the weight before the bounce: multiply by that of the sample first",
    Roulette::OfSample => "the roulette gets the weight of the surface alone: multiply by that of the path first",
    Roulette::OfSurface => "the roulette gets the reflectance of the surface: it gets the weight that the path would have",
    Roulette::Number(0) => REUSED,
    Roulette::Number(1) => REUSED,
    Roulette::Number(2) => REUSED,
    Roulette::Number(3) => REUSED,
    Roulette::Number(4) => REUSED,
];

const REUSED: &str =
    "the roulette uses a random number again that chose the direction or the light: use numbers.roulette";

pub(super) fn steps_continue_with_the_weight_of_the_sample(trial: &Trial<'_>) -> CheckResult {
    let state = (path_weight(), 0..8u32, pdf());
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
        let roulette = |kind: Roulette, query: &StepQuery, sample: &Option<BsdfSample>| {
            let (StepNumbers { bsdf, roulette, light, .. }, path) = (query.numbers, &query.path);
            let of_sample = sample.map_or(Vec3::ZERO, |sample| sample.weight);
            let weight = match kind {
                Roulette::OfPath => sample.map_or(Vec3::ZERO, |_| path.weight),
                Roulette::OfSample => of_sample,
                Roulette::OfSurface => sample.map_or(Vec3::ZERO, |_| query.vertex.scattering.diffuse),
                _ => path.weight * of_sample,
            };
            let more = if let Roulette::Bounce(more) = kind { more } else { 1 };
            let u = if let Roulette::Number(n) = kind { [bsdf.x, bsdf.y, bsdf.z, light.x, light.y][n] } else { roulette };
            RouletteQuery { weight, bounce: path.bounces + more, u }
        };
        let factors = |kind: Roulette| {
            let queries: Vec<_> =
                queries.iter().zip(&samples).map(|(query, sample)| roulette(kind, query, sample)).collect();
            trial.kit.survives(&queries)
        };
        let all: Vec<Vec<f32>> = ROULETTES.iter().map(|(kind, _)| factors(*kind)).collect();
        let factors: Vec<Vec<f32>> = (0..queries.len()).map(|n| all.iter().map(|of| of[n]).collect()).collect();
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
        compare(queries, answers, |query, ((step, sample), factors)| {
            let factor = factors[0];
            let Some(sample) = sample else {
                return match step.next {
                    None => missing(&ask(query)).map(Into::into),
                    Some(_) => {
                        Err(Broken::new(describe(query), step.next, None::<()>, "sample_bsdf returns None"))
                    }
                };
            };
            let height = above(query, &sample);
            // At the horizon a rounding decides, but not for a direction of length 0.
            if sample.lobe == Lobe::Diffuse && height.abs() < 1e-5 * sample.direction.as_dvec3().length() {
                return Ok(().into());
            }
            let ends = sample.lobe == Lobe::Diffuse && height < 0.0;
            let weight = f64::from(factor) * query.path.weight.as_dvec3() * sample.weight.as_dvec3();
            let weight = if ends { DVec3::ZERO } else { weight };
            let broken = || {
                let BsdfSample { lobe, direction, pdf, .. } = sample;
                let expected = NextRay { lobe, direction, weight: weight.as_vec3(), pdf };
                let expected = (weight != DVec3::ZERO).then_some(expected);
                let source = "path.weight · weight of sample_bsdf · survives";
                let ended = expected.is_some() && step.next.is_none();
                Broken::with_texts(describe(query), says(step.next), says(expected), source)
                    .explained_by(["a path ends that survives its roulette, and is above the surface"
                        .when(ended)])
            };
            let whole = (query.path.weight * sample.weight).as_dvec3();
            let is_next = |sample: &BsdfSample, weight: DVec3| is(&step, sample, weight);
            let unless_below = |weight: DVec3| if ends { DVec3::ZERO } else { weight };
            let by = |factor: f32| f64::from(factor);
            let alive = if factor == 0.0 { 0.0 } else { 1.0 };
            let others = factors.iter().zip(ROULETTES).skip(1);
            let others = others.map(|(other, (_, text))| (is_next(&sample, unless_below(by(*other) * whole)), text));
            let formulas = [
                (step.next.is_some_and(|next| next.weight.is_nan()), "you return NaN"),
                "a diffuse ray below the geometric normal hits its own surface: end the path"
                    .when(is_next(&sample, by(factor) * whole)),
                "the factor of survives is missing in the weight"
                    .when(is_next(&sample, unless_below(alive * whole))),
                (is_next(&sample, unless_below(whole)), "there is no Russian roulette"),
                "the weight of the path is missing"
                    .when(is_next(&sample, unless_below(by(factor) * sample.weight.as_dvec3()))),
                "reflected and refracted rays end, too: only diffuse ones must stay above the geometric normal"
                    .when(is_next(&sample, if height < 0.0 { DVec3::ZERO } else { by(factor) * whole })),
                "the density lacks the probability of the diffuse lobe: pass on that of sample_bsdf"
                    .when(is_next(
                        &BsdfSample { pdf: cosine_pdf(query, &sample), ..sample },
                        unless_below(by(factor) * whole),
                    )
                    ),
                "the density of a diffuse ray is that of sample_bsdf"
                    .when(is_next(&BsdfSample { pdf: f32::INFINITY, ..sample }, unless_below(by(factor) * whole))),
            ];
            unless(is_next(&sample, weight), broken).formulas(formulas.into_iter().chain(others))
        })
    })
}
