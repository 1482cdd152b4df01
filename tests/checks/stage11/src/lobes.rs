//! The choice of a lobe: `sample_bsdf` and `bsdf_pdf`.

use crate::directions::{AXES, number, place};
use checks::prelude::*;
use checks::statistics::{SAMPLES, covers_each_part, has_mean, measures, pairs, unused_number};
use raykata::light_path::{BsdfSample, Lobe, Scattering};
use std::f64::consts::PI;

/// A surface with this normal and the reflectances of the three lobes. A lobe of reflectance 0 has a secondary ray, too.
fn surface(normal: Vec3, diffuse: Vec3, reflection: Option<Vec3>, transmission: Option<Vec3>) -> Scattering {
    let ray = |bounce, angle, turn, weight| SecondaryRay {
        bounce,
        direction: nasty::tilted(normal, angle, turn),
        weight,
    };
    let reflected = reflection.map(|weight| ray(Bounce::Reflection, 0.7, 0.3, weight));
    let refracted = transmission.map(|weight| ray(Bounce::Transmission, PI - 0.4, 0.8, weight));
    Scattering { diffuse, normal, secondary: reflected.into_iter().chain(refracted).collect() }
}

/// Reflectances in steps of 1/8, black in one of three.
fn reflectance() -> impl Strategy<Value = Vec3> + Clone {
    let channel = || fractions(0..=8, 8.0);
    prop_oneof![
        1 => Just(Vec3::ZERO),
        1 => (0..3usize, 1..=8i32).prop_map(|(axis, n)| n as f32 / 8.0 * Vec3::AXES[axis]),
        2 => (channel(), channel(), channel()).prop_map(|(x, y, z)| vec3(x, y, z)),
    ]
}

/// Surfaces with any of the lobes.
pub(super) fn surfaces() -> impl Strategy<Value = Scattering> + Clone {
    let maybe = || prop_oneof![1 => Just(None), 3 => reflectance().prop_map(Some)];
    (nasty::unit(), reflectance(), maybe(), maybe()).prop_map(
        |(normal, diffuse, reflection, transmission)| surface(normal, diffuse, reflection, transmission),
    )
}

fn bsdf_queries() -> impl Strategy<Value = BsdfQuery> + Clone {
    (surfaces(), number(), number(), number())
        .prop_map(|(scattering, x, y, z)| BsdfQuery { scattering, u: vec3(x, y, z) })
}

/// The secondary ray of a lobe. A diffuse lobe has none.
fn ray_of(scattering: &Scattering, lobe: Lobe) -> Option<&SecondaryRay> {
    scattering.secondary.iter().find(|ray| lobe != Lobe::Diffuse && ray.bounce == lobe.bounce())
}

/// The reflectance of a lobe.
fn reflectance_of(scattering: &Scattering, lobe: Lobe) -> Vec3 {
    match lobe {
        Lobe::Diffuse => scattering.diffuse,
        _ => ray_of(scattering, lobe).map_or(Vec3::ZERO, |ray| ray.weight),
    }
}

const LOBES: [Lobe; 3] = [Lobe::Diffuse, Lobe::Reflection, Lobe::Transmission];

/// The probability of a lobe in proportion to its largest channel.
fn share(scattering: &Scattering, lobe: Lobe) -> f64 {
    let largest = |lobe: Lobe| f64::from(reflectance_of(scattering, lobe).max_element());
    largest(lobe) / LOBES.into_iter().map(largest).sum::<f64>()
}

/// The probability with which the lobe of a sample was chosen, as its weight states it.
fn probability(scattering: &Scattering, sample: &BsdfSample) -> f64 {
    let reflectance = reflectance_of(scattering, sample.lobe);
    f64::from(reflectance.max_element()) / f64::from(sample.weight.max_element())
}

fn is_black(scattering: &Scattering) -> bool {
    LOBES.iter().all(|lobe| reflectance_of(scattering, *lobe) == Vec3::ZERO)
}

/// Judges an answer without a sample: only a surface whose lobes are all black has none.
pub(super) fn missing(query: &BsdfQuery) -> CheckResult {
    if is_black(&query.scattering) {
        return Ok(());
    }
    let broken = Broken::new(query.call("sample_bsdf"), None::<BsdfSample>, "a sample", "the definition");
    Err(broken.because("None only if all lobes are black: choose again, or scale the random number"))
}

const CHOOSES_BLACK: &str = "you choose a lobe whose reflectance is 0";

pub(super) fn bsdf_samples_choose_lobes_that_reflect(trial: &Trial<'_>) -> CheckResult {
    trial.each(800, bsdf_queries(), <dyn Kit>::sample_bsdf, |query, yours| {
        let scattering = &query.scattering;
        let Some(sample) = yours else { return missing(query) };
        if is_black(scattering) {
            let broken = Broken::new(query.call("sample_bsdf"), yours, None::<()>, "the definition");
            return Err(broken.explained_by([
                (true, "all lobes are black: there is nothing to choose"),
                (true, CHOOSES_BLACK),
            ]));
        }
        let reflectance = reflectance_of(scattering, sample.lobe);
        let direction = sample.direction.as_dvec3();
        let is_unit = (direction.length() - 1.0).abs() < 1e-5;
        let keeps = match ray_of(scattering, sample.lobe) {
            // A secondary ray keeps its direction, up to a normalization.
            Some(ray) => (direction - ray.direction.as_dvec3()).length() < 1e-6,
            None => direction.dot(scattering.normal.as_dvec3()) >= -1e-6,
        };
        let is_certain = sample.pdf == f32::INFINITY;
        let certainty = is_certain == (sample.lobe != Lobe::Diffuse);
        if reflectance != Vec3::ZERO && is_unit && keeps && certainty {
            return Ok(());
        }
        let expected = "a lobe that reflects light, and a direction of it";
        Err(Broken::with_texts(query.call("sample_bsdf"), format!("{sample:?}"), expected, "the definition")
            .explained_by([
                (reflectance == Vec3::ZERO, CHOOSES_BLACK),
                (sample.weight.is_nan() || sample.direction.is_nan(), "you return NaN"),
                "a diffuse direction is not certain: its density is finite"
                    .when(sample.lobe == Lobe::Diffuse && is_certain),
                "a reflected or refracted direction is certain: its density is infinite"
                    .when(sample.lobe != Lobe::Diffuse && !is_certain),
                (!keeps && sample.lobe == Lobe::Diffuse, "your diffuse direction goes below the surface"),
                (!keeps, "a reflected or refracted ray keeps its direction"),
                (!is_unit, "your direction does not have unit length"),
            ]))
    })
}

/// Judges the weight of a sample by itself: reflectance divided by one probability, which is large enough, and the density of a
/// diffuse direction that contains the same probability.
fn judge_weight(query: &BsdfQuery, sample: &BsdfSample) -> bool {
    let scattering = &query.scattering;
    let reflectance = reflectance_of(scattering, sample.lobe).as_dvec3();
    let probability = probability(scattering, sample);
    let weight = sample.weight.as_dvec3();
    // Some roundings of single precision.
    let is_scaled =
        (weight * probability - reflectance).abs().max_element() <= 1e-5 * reflectance.max_element();
    let in_range =
        probability <= 1.0 + 1e-5 && probability >= 0.25 * share(scattering, sample.lobe) * (1.0 - 1e-5);
    is_scaled && in_range
}

pub(super) fn bsdf_weights_are_divided_by_the_probability(trial: &Trial<'_>) -> CheckResult {
    trial.each(800, bsdf_queries(), <dyn Kit>::sample_bsdf, |query, yours| {
        let Some(sample) = yours else { return missing(query).map(Into::into) };
        let scattering = &query.scattering;
        let reflectance = reflectance_of(scattering, sample.lobe).as_dvec3();
        let share = share(scattering, sample.lobe);
        let near = |factor: f64| {
            (sample.weight.as_dvec3() - factor * reflectance).abs().max_element()
                <= 1e-4 * factor * reflectance.max_element()
        };
        let largest = reflectance.max_element();
        let broken = || {
            let (yours, least) = (format!("weight {} for {:?}", sample.weight, sample.lobe), 0.25 * share);
            let expected = format!(
                "{} divided by one probability in {least:.3}..=1, for example {share:.3}",
                reflectance.as_vec3()
            );
            let (q, text) = (probability(scattering, &sample), "this lobe is chosen less often than s / 4");
            Broken::with_texts(query.call("sample_bsdf"), yours, expected, "the definition")
                .explained_by([(q < least && near(1.0 / q), text)])
        };
        unless(reflectance.max_element() == 0.0 || judge_weight(query, &sample), broken).formulas(named![
            near(share) => "you multiply by the probability of the choice: divide by it",
            near(1.0 / largest) => "you divide by the reflectance, not by the probability of the choice",
            near(1.0 / share / PI) => "the weight of a diffuse direction has no π: it cancels against the density",
            sample.weight.is_nan() => "you return NaN",
        ])
    })
}

/// A surface with three lobes, whose shares are all at least 1/4.
fn layered(trial: &Trial<'_>) -> Scattering {
    let hidden = (nasty::unit(), 0.5..0.7f32, 0.45..0.6f32);
    let (normal, diffuse, mirror) = trial.varied((vec3(0.6, 0.0, -0.8), 0.6, 0.5), hidden);
    surface(normal, vec3(diffuse, 0.2, 0.1), Some(vec3(0.3, mirror, 0.1)), Some(vec3(0.2, 0.1, 0.5)))
}

/// A sample without its direction: the lobe and its weight.
type Choice = Option<(Lobe, [f32; 3])>;

pub(super) fn bsdf_samples_keep_the_light(trial: &Trial<'_>) -> CheckResult {
    let layered = layered(trial);
    let mut surfaces = vec![Scattering { secondary: layered.secondary[..1].to_vec(), ..layered.clone() }];
    // Lobes that are rarely chosen, down to one of 10,000 times at a quarter of the share.
    for dim in [0.1, 0.01, 0.001, 0.0004] {
        surfaces.push(surface(layered.normal, Vec3::splat(0.9), Some(vec3(0.0, dim, 0.0)), None));
        surfaces.push(surface(layered.normal, vec3(dim, 0.0, 0.0), None, Some(Vec3::splat(0.9))));
    }
    surfaces.push(layered);
    for scattering in &surfaces {
        // The lobe is a function of one of the three numbers, or of their sum.
        let choices_along = |axis: usize| {
            measures(|numbers| {
                let query = |number: &f32| {
                    let mut u = vec3(0.3, 0.4, 0.6);
                    u[axis] = *number;
                    BsdfQuery { scattering: scattering.clone(), u }
                };
                let samples = trial.kit.sample_bsdf(&numbers.iter().map(query).collect::<Vec<_>>());
                let choice = |sample: BsdfSample| (sample.lobe, sample.weight.to_array());
                samples.into_iter().map(|sample| sample.map(choice)).collect::<Vec<Choice>>()
            })
        };
        let mut measured = [0, 1, 2].into_iter().map(choices_along);
        let (choices, slack) = measured.find(|(sets, _)| sets.len() > 1).unwrap_or_else(|| choices_along(0));
        // A lobe that is never chosen first, because the others then get its share.
        let is_chosen =
            |lobe: &Lobe| choices.iter().any(|(choice, _)| choice.is_some_and(|(other, _)| other == *lobe));
        let (chosen, never): (Vec<Lobe>, Vec<Lobe>) = LOBES.into_iter().partition(is_chosen);
        for lobe in never.into_iter().chain(chosen) {
            let reflectance = f64::from(reflectance_of(scattering, lobe).max_element());
            let of_lobe = choices.iter().filter_map(|(choice, measure)| {
                choice.filter(|(other, _)| *other == lobe).map(|(_, weight)| (weight, *measure))
            });
            let largest = |weight: [f32; 3]| f64::from(Vec3::from(weight).max_element()) / reflectance;
            let frequency: f64 = of_lobe.clone().fold(0.0, |sum, (_, measure)| sum + measure);
            let mean: f64 =
                of_lobe.clone().fold(0.0, |sum, (weight, measure)| sum + measure * largest(weight));
            // Borders of the sets are rounded, as is the weight.
            let most = of_lobe.map(|(weight, _)| largest(weight)).fold(1.0, f64::max);
            if reflectance == 0.0 || (mean - 1.0).abs() <= slack * most + 1e-5 {
                continue;
            }
            let input = format!("sample_bsdf of {} for all numbers u", scattering.paste());
            let yours = format!(
                "{:.3} % of the samples are {lobe:?}, and their weights sum to {mean:.4} of the reflectance",
                100.0 * frequency
            );
            let source = "measured by bisection";
            return Err(Broken::with_texts(input, yours, "1.0000 of the reflectance", source).explained_by(
                [
                    (frequency == 0.0, "you never choose this lobe"),
                    (mean.is_nan(), "you return NaN"),
                    "your weight is not divided by the probability of the choice"
                        .when((mean - frequency).abs() < 1e-5),
                    (true, "the lobe is not chosen with the probability by which its weight is divided"),
                ],
            ));
        }
    }
    Ok(())
}

pub(super) fn diffuse_samples_use_fresh_numbers(trial: &Trial<'_>) -> CheckResult {
    let scattering = layered(trial);
    let u = pairs(trial.seed, 4 * SAMPLES);
    let query = |u: &[Vec2]| BsdfQuery { scattering: scattering.clone(), u: u[0].extend(u[1].x) };
    let samples = trial.kit.sample_bsdf(&u.chunks(2).map(query).collect::<Vec<_>>());
    let diffuse = samples.iter().flatten().filter(|sample| sample.lobe == Lobe::Diffuse);
    let places: Vec<_> = diffuse.map(|sample| place(scattering.normal, sample.direction)).collect();
    // Each lobe is chosen with a probability of at least a quarter of 1/4.
    if places.len() < 64 * 20 {
        let input = format!("sample_bsdf of {} for {} numbers u", scattering.paste(), 2 * SAMPLES);
        let yours = format!("{} diffuse samples", places.len());
        return Err(Broken::with_texts(input, yours, "at least a sixteenth", "the definition"));
    }
    let (rings, turns): (Vec<f64>, Vec<f64>) = places.iter().copied().unzip();
    for (axis, shares) in AXES.iter().zip([rings, turns]) {
        has_mean(&format!("the diffuse directions of sample_bsdf, {axis}"), &shares, 0.5, |_| {
            let is_empty = |eighth: i32| !shares.iter().any(|share| (8.0 * share) as i32 == eighth);
            vec![((0..8).any(is_empty), "your directions cover only a part: is a number used twice?")]
        })?;
    }
    // Without other lobes every sample is diffuse. A direction depends on two of the three numbers: judge each pair of which it does.
    let scattering = surface(scattering.normal, scattering.diffuse, None, None);
    let places = |pair: [usize; 2], u: &[Vec2]| {
        let query = |u: &Vec2| {
            let mut numbers = Vec3::splat(0.3);
            (numbers[pair[0]], numbers[pair[1]]) = (u.x, u.y);
            BsdfQuery { scattering: scattering.clone(), u: numbers }
        };
        let samples = trial.kit.sample_bsdf(&u.iter().map(query).collect::<Vec<_>>());
        samples.iter().flatten().map(|sample| place(scattering.normal, sample.direction)).collect::<Vec<_>>()
    };
    let is_used = |pair: &[usize; 2]| unused_number(|u| places(*pair, u)).iter().all(|(unused, _)| !unused);
    let what = "the diffuse directions of sample_bsdf";
    let Some(pair) = [[1, 2], [0, 1], [0, 2]].into_iter().find(is_used) else {
        let broken = Broken::with_texts(what, "depend on one number", "depend on two", "the definition");
        return Err(broken.looks_like(Some("one random number for both coordinates: use u.y and u.z")));
    };
    covers_each_part(what, AXES, trial.seed, None, |u| Ok(places(pair, u)), |_| Vec::new())
}

pub(super) fn bsdf_pdf_is_that_of_the_sample(trial: &Trial<'_>) -> CheckResult {
    let strategy =
        bsdf_queries().prop_filter("a diffuse surface", |query| query.scattering.diffuse != Vec3::ZERO);
    trial.forall(800, strategy, |queries| {
        let samples = trial.kit.sample_bsdf(queries);
        // Among hundreds of samples of diffuse surfaces some are diffuse.
        let diffuse = |sample: &Option<BsdfSample>| sample.filter(|sample| sample.lobe == Lobe::Diffuse);
        let none_is_diffuse = queries.len() > 100 && samples.iter().all(|sample| diffuse(sample).is_none());
        let of_sample = |(query, sample): (&BsdfQuery, &Option<BsdfSample>)| BsdfPdfQuery {
            scattering: query.scattering.clone(),
            direction: sample.map_or(Vec3::Z, |sample| sample.direction),
        };
        let pdf_queries: Vec<BsdfPdfQuery> = queries.iter().zip(&samples).map(of_sample).collect();
        // The cosine, and the probability of the diffuse lobe, which follows from the weight of the sample.
        let factors = |query: &BsdfPdfQuery, sample: &BsdfSample| {
            let cosine = query.scattering.normal.as_dvec3().dot(sample.direction.as_dvec3()).max(0.0);
            (cosine, probability(&query.scattering, sample))
        };
        // Roundings of the products in the cosine, and of the probability.
        let near = |pdf: f32, expected: f64| (f64::from(pdf) - expected).abs() <= 1e-6 + 1e-5 * expected;
        let answers: Vec<_> = samples.into_iter().zip(trial.kit.bsdf_pdf(&pdf_queries)).collect();
        compare(&pdf_queries, answers, |query, (sample, yours)| {
            let Some(sample) = diffuse(&sample) else {
                let input = format!("sample_bsdf for {} diffuse surfaces", queries.len());
                let broken =
                    Broken::with_texts(input, "no diffuse sample", "some diffuse samples", "the definition");
                return if none_is_diffuse { Err(broken) } else { Ok(().into()) };
            };
            let (cosine, probability) = factors(query, &sample);
            let expected = probability * cosine / PI;
            let both = |expected: f64| near(yours, expected) && near(sample.pdf, expected);
            let sum = |lobe: Lobe| f64::from(reflectance_of(&query.scattering, lobe).element_sum());
            let by_mean = sum(Lobe::Diffuse) / LOBES.into_iter().map(sum).sum::<f64>() * cosine / PI;
            let broken = || {
                let input = query.call("bsdf_pdf");
                let yours = format!("{yours:?}, and pdf {:?} of sample_bsdf", sample.pdf);
                Broken::with_texts(input, yours, format!("{expected:?} for both"), "probability · cos θ / π")
            };
            unless(both(expected), broken).formulas(named![
                both(cosine / PI) => "the probability of the diffuse lobe is missing in both densities",
                near(yours, cosine / PI) => "the probability of the diffuse lobe is missing in bsdf_pdf",
                near(sample.pdf, cosine / PI) => "the probability of the diffuse lobe is missing in the pdf of sample_bsdf",
                near(yours, by_mean) && near(sample.pdf, expected) =>
                    "bsdf_pdf chooses by the means of the channels, and sample_bsdf does not: use one q",
                near(yours, cosine / PI / probability) => "you divide by the probability of the diffuse lobe: multiply by it",
            ])
        })
    })
}

pub(super) fn bsdf_pdf_of_other_directions_is_zero(trial: &Trial<'_>) -> CheckResult {
    // Below the surface, by at least 0.1; and all directions of a surface without diffuse reflection. One direction of four is
    // above a diffuse surface.
    let queries = (surfaces(), 0..=12i32, 0..=15i32, 0..4i32).prop_map(|(scattering, angle, turn, which)| {
        let direction =
            nasty::tilted(scattering.normal, f64::from(angle) / 8.5, f64::from(turn) / 16.0 + 0.01);
        let diffuse = match which {
            0 => Vec3::ZERO,
            _ if scattering.diffuse == Vec3::ZERO => Vec3::ONE,
            _ => scattering.diffuse,
        };
        let direction = if which < 2 || which == 3 && angle % 2 == 0 { direction } else { -direction };
        BsdfPdfQuery { scattering: Scattering { diffuse, ..scattering }, direction }
    });
    trial.each(400, queries, <dyn Kit>::bsdf_pdf, |query, yours| {
        let scattering = &query.scattering;
        let above = scattering.normal.dot(query.direction) > 0.0;
        let reflects = above && scattering.diffuse != Vec3::ZERO;
        if if reflects { yours > 0.0 && yours.is_finite() } else { yours == 0.0 } {
            return Ok(());
        }
        let input = query.call("bsdf_pdf");
        let expected = if reflects { "a density above 0" } else { "0.0" };
        Err(Broken::with_texts(input, format!("{yours:?}"), expected, "the definition").explained_by(named![
            yours.is_nan() => "you return NaN: a black surface has no probabilities",
            !above && yours < 0.0 => "your density is negative below the surface",
            !above && yours > 0.0 => "a direction below the surface is never sampled: its density is 0",
            above && !reflects && yours > 0.0 => "a surface without diffuse reflection samples no diffuse direction",
            reflects && yours == 0.0 => "this direction is sampled: its density is above 0",
        ]))
    })
}
