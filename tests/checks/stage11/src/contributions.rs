//! Light that counts: `sample_light_contribution` and `emitted_contribution`.

use crate::weights::both_ways;
use checks::prelude::*;
use raykata::emitter::EmitterSample;
use std::f64::consts::PI;

fn color() -> impl Strategy<Value = Vec3> + Clone {
    checks::generate::vector(fractions(0..=8, 4.0))
}

/// A density: 0 in one of five.
fn density() -> impl Strategy<Value = f32> + Clone {
    prop_oneof![1 => Just(0.0f32), 2 => fractions(1..=32, 8.0), 2 => magnitude(-3.0, 5.0)]
}

/// Queries with a direction at an angle to the normal.
fn queries(
    angle: impl Strategy<Value = (f64, f64)> + Clone,
) -> impl Strategy<Value = LightContributionQuery> + Clone {
    let pdf = prop_oneof![1 => fractions(1..=32, 8.0), 1 => magnitude(-3.0, 5.0)];
    let distance = prop_oneof![3 => fractions(1..=16, 4.0), 1 => Just(f32::INFINITY)];
    let sample = (nasty::unit(), angle, distance, color(), pdf).prop_map(
        |(normal, (angle, turn), distance, radiance, pdf)| {
            (normal, EmitterSample { direction: nasty::tilted(normal, angle, turn), distance, radiance, pdf })
        },
    );
    (color(), sample, density()).prop_map(|(diffuse, (normal, sample), bsdf_pdf)| LightContributionQuery {
        diffuse,
        normal,
        sample,
        bsdf_pdf,
    })
}

const LEAST: &str = "a small density is replaced by a larger one before you divide, so light is lost: divide by the density itself";

/// The contribution without the weight of multiple importance sampling.
fn unweighted(query: &LightContributionQuery) -> DVec3 {
    let cosine = query.normal.as_dvec3().dot(query.sample.direction.as_dvec3());
    query.diffuse.as_dvec3()
        * query.sample.radiance.as_dvec3()
        * (cosine.max(0.0) / PI / f64::from(query.sample.pdf))
}

pub(super) fn light_contributions_have_their_closed_form(trial: &Trial<'_>) -> CheckResult {
    trial.forall(600, queries(nasty::tilt()), |queries| {
        // The weights of the student's own mis_weight: any heuristic passes.
        let pairs: Vec<(f32, f32)> = queries.iter().map(|query| (query.sample.pdf, query.bsdf_pdf)).collect();
        let weights = both_ways(trial, &pairs);
        let answers: Vec<_> = trial.kit.sample_light_contribution(queries).into_iter().zip(weights).collect();
        // At a grazing angle the cosine is off by some roundings of its products, each at most 1.
        let slack = |query: &LightContributionQuery, factor: f64| {
            let unit =
                query.diffuse.as_dvec3() * query.sample.radiance.as_dvec3() / f64::from(query.sample.pdf);
            1e-6 * factor.max(1e-3) * unit.max_element() + 1e-38
        };
        let near = |query: &LightContributionQuery, yours: Vec3, expected: DVec3, factor: f64| {
            (yours.as_dvec3() - expected).abs().max_element()
                <= slack(query, factor) + 1e-5 * expected.max_element()
        };
        compare(queries, answers, |query, (yours, (weight, swapped))| {
            let (weight, whole) = (f64::from(weight), unweighted(query));
            // Light that rays cannot hit counts in full.
            let factor = if query.bsdf_pdf == 0.0 { 1.0 } else { weight };
            let expected = factor * whole;
            let source = "kd / π · L · cos θ / pdf · mis_weight";
            let broken =
                || Broken::new(query.call("sample_light_contribution"), yours, expected.as_vec3(), source);
            let cosine = query.normal.as_dvec3().dot(query.sample.direction.as_dvec3());
            let (pdf, other) = (f64::from(query.sample.pdf), f64::from(query.bsdf_pdf));
            let is = |expected: DVec3, factor: f64| near(query, yours, expected, factor);
            let least = |least: f64| is(factor * whole * (pdf / pdf.max(least)), 1.0);
            unless(near(query, yours, expected, factor), broken).formulas(named![
                yours.is_nan() => "you return NaN",
                is(whole, 1.0) => "the weight of multiple importance sampling is missing, so light counts twice",
                is(f64::from(swapped) * whole, f64::from(swapped)) =>
                    "own and other are exchanged: own is the density of the light's sample",
                is(PI * weight * whole, PI) => "a diffuse surface sends kd / π on: the π is missing",
                is(weight * whole / cosine.max(1e-9), 1.0 / cosine.max(1e-9)) => "the cosine at the surface is missing",
                is(weight * whole * cosine, 1.0) => "you multiply by the cosine twice",
                is(weight * whole * pdf, pdf) => "you do not divide by the density of the sample",
                is(weight * whole * pdf * pdf, pdf * pdf) => "you multiply by the density of the sample: divide by it",
                other == 0.0 || is(weight * whole * pdf / other, pdf / other) =>
                    "you divide by the density of the surface, not by that of the light",
                is(weight * query.sample.radiance.as_dvec3() * (cosine / PI / pdf), 1.0) => "the diffuse reflectance is missing",
                is(weight * whole / PI, 1.0) => "you divide by π twice",
                is(weight * whole * pdf, pdf) => "you do not divide by the density of the sample",
                is(weight * whole / pdf, 1.0 / pdf) => "you divide by the density twice",
                is(weight * weight * whole, 1.0) => "you multiply by the weight of mis_weight twice",
                least(1e-4) => LEAST,
                least(1e-3) => LEAST,
                least(1e-2) => LEAST,
                least(0.1) => LEAST,
                least(1.0) => LEAST,
                is(weight * whole / f64::from(query.sample.distance).powi(2), 1.0) =>
                    "you divide by the squared distance: it is in the density of the sample",
                is(whole * (pdf / (pdf + other)), 1.0) => "you divide by the sum of both densities and do not weight by mis_weight",
            ])
        })
    })
}

pub(super) fn light_from_below_adds_nothing(trial: &Trial<'_>) -> CheckResult {
    // One direction of four is above the surface. No direction is closer to the horizon than 0.1.
    let angle = (0..=12i32, 0..=15i32, 0..4i32).prop_map(|(angle, turn, which)| {
        let angle = f64::from(angle) / 8.5;
        (if which == 0 { angle } else { PI - angle }, f64::from(turn) / 16.0 + 0.01)
    });
    let queries =
        queries(angle).prop_map(|query| LightContributionQuery { diffuse: query.diffuse + 0.25, ..query });
    trial.each(300, queries, <dyn Kit>::sample_light_contribution, |query, yours| {
        let above = query.normal.dot(query.sample.direction) > 0.0;
        let can_add = above && query.sample.radiance != Vec3::ZERO;
        // The balance and the power heuristic give a weight of at least 1e-16 for these densities, in f32 not 0.
        let adds = yours.max_element() > 0.0;
        if yours.min_element() >= 0.0
            && (!adds || can_add)
            && (adds || !above || !can_add || query.bsdf_pdf > 0.0)
        {
            return Ok(());
        }
        let expected = if can_add { "light above 0" } else { "0 in all channels" };
        let input = query.call("sample_light_contribution");
        Err(Broken::with_texts(input, format!("{yours:?}"), expected, "the definition").explained_by([
            (yours.is_nan(), "you return NaN"),
            (!above && yours.min_element() < 0.0, "light from below the surface is negative: it must be 0"),
            (!above && adds, "light from below the surface counts: take no absolute value of the cosine"),
            (above && !adds, "light from above the surface counts"),
            "your test is reversed: light from above the surface counts, not light from below"
                .when(if above { !adds } else { yours.min_element() < 0.0 }),
        ]))
    })
}

pub(super) fn emission_counts_by_its_weight(trial: &Trial<'_>) -> CheckResult {
    let pdf = prop_oneof![1 => Just(f32::INFINITY), 3 => density().prop_filter("a direction that is sampled", |pdf| *pdf > 0.0)];
    let queries = (color(), pdf, density()).prop_map(|(emission, pdf, light_pdf)| EmissionQuery {
        emission,
        pdf,
        light_pdf,
    });
    // A camera ray that sees a light which is sampled, and a diffuse ray that sees one which is not.
    let first = [
        EmissionQuery { emission: vec3(1.0, 2.0, 0.5), pdf: f32::INFINITY, light_pdf: 2.0 },
        EmissionQuery { emission: vec3(1.0, 2.0, 0.5), pdf: 2.0, light_pdf: 0.0 },
        EmissionQuery { emission: vec3(1.0, 2.0, 0.5), pdf: 1.0, light_pdf: 3.0 },
    ];
    trial.forall_and(&first, 500, queries, |queries| {
        let pairs: Vec<(f32, f32)> = queries.iter().map(|query| (query.pdf, query.light_pdf)).collect();
        let weights = both_ways(trial, &pairs);
        let answers: Vec<_> = trial.kit.emitted_contribution(queries).into_iter().zip(weights).collect();
        // One rounding of the product, and those of another way to compute the same weight.
        let near = |yours: Vec3, expected: DVec3| {
            (yours.as_dvec3() - expected).abs().max_element() <= 1e-5 * expected.max_element() + 1e-38
        };
        compare(queries, answers, |query, (yours, (own, swapped))| {
            // These two cases follow from the definition alone.
            let is_whole = query.pdf == f32::INFINITY || query.light_pdf == 0.0;
            let weight = if is_whole { 1.0 } else { f64::from(own) };
            let expected = weight * query.emission.as_dvec3();
            // A wrong weight of a certain direction is judged by a check of mis_weight.
            let by_own = own * query.emission;
            let is_by_own = yours == by_own || yours.is_nan() && by_own.is_nan();
            let input = || query.call("emitted_contribution");
            let broken = || {
                Broken::new(input(), yours, expected.as_vec3(), "emission · mis_weight")
                    .explained_by([(yours.is_nan(), "you return NaN: ∞ / ∞, or 0 · ∞")])
            };
            let right = near(yours, expected) || query.pdf == f32::INFINITY && is_by_own;
            let whole = query.emission.as_dvec3();
            let is_certain = query.pdf == f32::INFINITY;
            let unless_certain = |weight: f64| if is_certain { whole } else { weight * whole };
            let weight = f64::from(own);
            unless(right, broken).formulas(named![
                near(yours, whole) => "all emission counts in full, so light that is sampled counts twice",
                yours == Vec3::ZERO => "no emission counts, so mirrors show no lights",
                near(yours, f64::from(swapped) * whole) => "own and other are exchanged: own is the density of the ray",
                near(yours, unless_certain(0.0)) =>
                    "light that a diffuse ray finds counts by its weight, and in full if it is not sampled",
                near(yours, if is_certain { DVec3::ZERO } else { weight * whole }) =>
                    "light of camera rays and mirrors counts in full, because no sample finds it",
                near(yours, if query.light_pdf == 0.0 { DVec3::ZERO } else { weight * whole }) =>
                    "light of an emitter that is not sampled counts in full",
            ])
        })
    })
}
