//! The weight that decides whether a secondary ray is traced.

use super::scatter::{FAR, drawn, find, grey, paste, queries};
use checks::prelude::*;
use raykata::material::{Fresnel, Material};

/// A secondary ray's own weight decides, not that of the incoming ray and not that of the other secondary ray.
pub(super) fn scatter_tests_the_weight_of_each_ray(trial: &Trial<'_>) -> CheckResult {
    let [slanted, ..] = drawn();
    let (direction, normal) = (slanted.direction, slanted.normal);
    // Weights are exact and often equal to the limit, because they are products of eighths. The index is 1, so that
    // there is no total internal reflection.
    let queries = (queries(), 0..=64i32).prop_map(move |(query, least)| ScatterQuery {
        direction,
        normal,
        material: Material { index_of_refraction: 1.0, fresnel: Fresnel::None, ..query.material },
        limits: Limits { min_contribution: least as f32 / 64.0, ..FAR },
        ..query
    });
    let at = |mirror: f32, transmission: f32, least: f32| ScatterQuery {
        weight: Vec3::ONE,
        material: Material { index_of_refraction: 1.5, fresnel: Fresnel::None, ..grey(mirror, transmission) },
        limits: Limits { min_contribution: least, ..FAR },
        ..slanted.clone()
    };
    let drawn =
        [at(0.25, 0.125, 0.5), at(0.75, 0.25, 0.5), at(0.25, 0.5, 0.5), at(0.5, 0.0, 0.0), at(0.0, 0.5, 0.0)];
    trial.forall_and(&drawn, 1000, queries, |queries| {
        let formulas = |query: &ScatterQuery, yours: &Vec<_>| formulas(query, yours);
        compare_formulas(queries, trial.kit.scatter(queries), judge_own_weight, formulas)
    })?;
    // Along the normal Schlick's F is 0.04 for an index of 1.5. The reflected ray has mirror + F transmission.
    let along = [(0.3, 0.5, 0.31), (0.0, 0.5, 0.49), (0.0, 1.0, 0.97), (0.0, 0.5, 0.45), (0.1, 0.5, 0.11)];
    let queries = along.map(|(mirror, transmission, least)| {
        let query = at(mirror, transmission, least);
        let material = Material { index_of_refraction: 1.5, fresnel: Fresnel::Schlick, ..query.material };
        ScatterQuery { direction: -normal, material, ..query }
    });
    all_hold(compare(&queries, trial.kit.scatter(&queries), |query, yours| {
        let [mirror, transmission] = [query.material.mirror.x, query.material.transmission.x];
        let least = query.limits.min_contribution;
        let traced =
            |f: [f32; 2]| [mirror + f[0] * transmission >= least, (1.0 - f[1]) * transmission >= least];
        let [yours, expected] = [found(&yours), traced([0.04; 2])];
        let words =
            |[reflected, refracted]: [bool; 2]| format!("reflected: {reflected}, refracted: {refracted}");
        let source = "mirror + F transmission, (1 - F) transmission, and the limit";
        let broken = || Broken::with_texts(paste(query), words(yours), words(expected), source);
        let says = "you test a weight without F: the reflected ray gains F · transmission, and the refracted one loses it";
        let without = [[0.0, 0.0], [0.0, 0.04], [0.04, 0.0]].map(|f| (yours == traced(f), says));
        unless(yours == expected, broken).formulas(without)
    }))
}

/// The weights of the reflected and of the refracted ray.
fn weights(query: &ScatterQuery) -> [Vec3; 2] {
    [query.weight * query.material.mirror, query.weight * query.material.transmission]
}

fn found(yours: &[SecondaryRay]) -> [bool; 2] {
    [Bounce::Reflection, Bounce::Transmission].map(|bounce| find(yours, bounce).is_some())
}

fn judge_own_weight(query: &ScatterQuery, yours: Vec<SecondaryRay>) -> CheckResult {
    let least = query.limits.min_contribution;
    let own = weights(query);
    let counts = own.map(|weight| weight.max_element() > 0.0 && weight.max_element() >= least);
    let found = found(&yours);
    if found == counts {
        return Ok(());
    }
    let off = usize::from(found[0] == counts[0]);
    let verdict = |traced: bool| {
        let (kind, weight) = (["Reflection", "Transmission"][off], own[off]);
        format!("{kind} of weight {weight} {}", if traced { "traced" } else { "not traced" })
    };
    let (yours, expected) = (verdict(found[off]), verdict(counts[off]));
    Err(Broken::with_texts(paste(query), yours, expected, "its own weight and the limit"))
}

/// What other rules trace. Each rule gets the own weight of a ray and that of the other ray, and may also test that the own
/// one is above 0.
fn formulas(query: &ScatterQuery, yours: &[SecondaryRay]) -> Vec<(bool, &'static str)> {
    let (least, parent, own, found) =
        (query.limits.min_contribution, query.weight, weights(query), found(yours));
    let largest = |weight: Vec3| weight.max_element();
    let plain = |rule: &dyn Fn(Vec3, Vec3) -> bool| found == [rule(own[0], own[1]), rule(own[1], own[0])];
    let above = |rule: &dyn Fn(Vec3, Vec3) -> bool| {
        found == [0, 1].map(|i| rule(own[i], own[1 - i]) && largest(own[i]) > 0.0)
    };
    let counts = |weight: Vec3| largest(weight) > 0.0 && largest(weight) >= least;
    const PARENT: &str = "you test the weight of the incoming ray: test the secondary ray's own weight";
    named![
        above(&|own, _| largest(own) > least) => "you leave out a ray whose weight is equal to min_contribution: trace it",
        above(&|_, _| true) => "you leave out min_contribution",
        plain(&|own, _| largest(own) >= least) => "you trace a secondary ray of weight 0, which adds nothing",
        plain(&|_, _| counts(parent)) => PARENT,
        found == [counts(parent) && largest(own[0]) > 0.0, counts(own[1])] => PARENT,
        found == [counts(own[0]), counts(parent) && largest(own[1]) > 0.0] => PARENT,
        above(&|_, _| largest(parent) >= least) => PARENT,
        above(&|_, _| largest(parent) > least) => PARENT,
        plain(&|own, other| counts(own) || counts(other)) =>
            "you trace both rays if one is large enough: test each ray's own weight",
        above(&|own, other| counts(own) || counts(other)) =>
            "you trace both rays if one is large enough: test each ray's own weight",
        plain(&|own, other| counts(own) && counts(other)) => "you trace both rays or none: test each ray's own weight",
        above(&|own, other| largest(own + other) >= least) => "you test the sum of both weights: test each ray's own weight",
        above(&|own, _| own.min_element() >= least) => "you test the smallest channel: test the largest one",
        plain(&|own, _| own.min_element() > 0.0 && own.min_element() >= least) =>
            "you test the smallest channel: test the largest one",
        above(&|own, _| own.element_sum() / 3.0 >= least) => "you test the mean of the channels: test the largest one",
        above(&|own, _| own.element_sum() >= least) => "you test the sum of the channels: test the largest one",
        above(&|own, _| own.length() >= least) => "you test the length of the weight: test the largest channel",
    ].to_vec()
}
