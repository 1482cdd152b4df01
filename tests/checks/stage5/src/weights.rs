//! The weight that decides whether a secondary ray is traced.

use super::scatter::{FAR, drawn, find, paste, queries};
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::compare;
use glam::Vec3;
use proptest::prelude::*;
use raykata::kit::{Bounce, Limits, ScatterQuery, SecondaryRay};
use raykata::material::{Fresnel, Material};

/// X8: a secondary ray's own weight decides, not that of the incoming ray and not that of the other secondary ray.
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
        material: Material {
            mirror: Vec3::splat(mirror),
            transmission: Vec3::splat(transmission),
            fresnel: Fresnel::None,
            ..slanted.material.clone()
        },
        limits: Limits { min_contribution: least, ..FAR },
        ..slanted.clone()
    };
    let drawn =
        [at(0.25, 0.125, 0.5), at(0.75, 0.25, 0.5), at(0.25, 0.5, 0.5), at(0.5, 0.0, 0.0), at(0.0, 0.5, 0.0)];
    let judge = |queries: &[ScatterQuery]| compare(queries, trial.kit.scatter(queries), judge_own_weight);
    judge(&drawn).into_iter().collect::<CheckResult>()?;
    trial.forall(2000, queries, judge)
}

fn judge_own_weight(query: &ScatterQuery, yours: Vec<SecondaryRay>) -> CheckResult {
    let least = query.limits.min_contribution;
    let [parent, mirror, transmission] = [query.weight, query.material.mirror, query.material.transmission];
    let weights = [mirror, transmission].map(|share| (parent * share).max_element());
    let counts = weights.map(|weight| weight > 0.0 && weight >= least);
    let found = [Bounce::Reflection, Bounce::Transmission].map(|bounce| find(&yours, bounce).is_some());
    if found == counts {
        return Ok(());
    }
    let off = usize::from(found[0] == counts[0]);
    let (weight, other) = (weights[off], weights[1 - off]);
    let diagnosis = match (found[off], weight) {
        (true, 0.0) => "you trace a secondary ray of weight 0, which adds nothing",
        (true, _) if other >= least && parent.max_element() >= least => {
            "you test the weight of the incoming ray or of the other secondary ray: test each ray's own"
        }
        (true, _) if parent.max_element() >= least => {
            "you test the weight of the incoming ray: test the secondary ray's own weight"
        }
        (true, _) => "you leave out min_contribution",
        (false, _) if weight == least => {
            "you leave out a ray whose weight is equal to min_contribution: trace it"
        }
        (false, _) if other < least => {
            "you test the weight of the other secondary ray: test each ray's own weight"
        }
        (false, _) => "you leave out a ray with one channel at the limit or above: test the largest channel",
    };
    let kind = ["Reflection", "Transmission"][off];
    let verdict =
        |traced: bool| format!("{kind} of weight {weight} {}", if traced { "traced" } else { "not traced" });
    Err(Broken::with_texts(
        paste(query),
        verdict(found[off]),
        verdict(counts[off]),
        "its own weight and the limit",
    )
    .looks_like(Some(diagnosis)))
}
