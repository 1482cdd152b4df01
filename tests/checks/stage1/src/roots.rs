//! Which of two roots is the hit.

use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::judge::{compare, known};
use checks::paste::Arguments;
use glam::Vec3;
use proptest::prelude::*;
use raykata::kit::RootQuery;
use raykata::ray::Ray;

pub(super) fn nearest_root_is_the_smaller_one_that_counts(trial: &Trial<'_>) -> Outcome {
    // First roots that are clearly out of range: among random ones the smallest that fails lies at an end of it.
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    let behind = "a root behind the ray: ray.contains(t) refuses it";
    let beyond = "a root beyond t_max: ray.contains(t) refuses it";
    for (roots, ray, diagnosis) in
        [([-2.0, -1.0], ray, behind), ([2.0, 3.0], ray.with_range(0.0, 1.0), beyond)]
    {
        let query = RootQuery { roots, ray };
        let yours = trial.kit.nearest_root(&[query])[0];
        if yours.is_some() {
            let broken = Broken::new(query.call("nearest_root"), yours, None::<f32>, "the definition");
            return Err(broken.looks_like(Some(diagnosis)));
        }
    }
    let root = || (-24..=24i32).prop_map(|eighths| eighths as f32 / 8.0);
    let inputs = (root(), root(), 0..=8i32, 0..=24i32).prop_map(|(first, second, start, length)| {
        let (t_min, length) = (start as f32 / 8.0, length as f32 / 8.0);
        RootQuery {
            roots: [first, second],
            ray: Ray::new(Vec3::ZERO, Vec3::X).with_range(t_min, t_min + length),
        }
    });
    trial.forall(2000, inputs, |queries| {
        compare(queries, trial.kit.nearest_root(queries), |query, yours| {
            let [first, second] = query.roots;
            let counting = [first, second].into_iter().filter(|&t| query.ray.contains(t));
            let expected = counting.reduce(f32::min);
            if yours == expected {
                return Ok(());
            }
            let diagnosis = match (yours, expected) {
                (Some(t), _) if t == query.ray.t_min || t == query.ray.t_max => {
                    "the range is open: its ends do not count"
                }
                (Some(t), _) if !query.ray.contains(t) => "a root that ray.contains(t) refuses",
                (None, Some(_)) if !query.ray.contains(first.min(second)) => {
                    "the smaller root does not count, but the larger one does"
                }
                (Some(_), Some(_)) => "the larger root; they come in any order",
                _ => "",
            };
            Err(Broken::new(query.call("nearest_root"), yours, expected, "the definition")
                .looks_like(known(diagnosis)))
        })
    })
}

pub(super) fn nearest_root_of_nan_is_the_other_one(trial: &Trial<'_>) -> Outcome {
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    let cases = [
        ([f32::NAN, f32::NAN], None),
        ([f32::NAN, 2.0], Some(2.0)),
        ([2.0, f32::NAN], Some(2.0)),
        ([f32::NAN, -2.0], None),
        ([f32::INFINITY, f32::NEG_INFINITY], None),
    ];
    let queries = cases.map(|(roots, _)| RootQuery { roots, ray });
    for ((query, yours), (_, expected)) in queries.iter().zip(trial.kit.nearest_root(&queries)).zip(cases) {
        if yours != expected {
            let diagnosis = match yours {
                Some(t) if !t.is_finite() => "NaN and infinity are no hits: ask ray.contains(t)",
                _ => "a comparison with NaN is false, so an if-else put NaN in the place of the other root",
            };
            let broken = Broken::new(query.call("nearest_root"), yours, expected, "the definition");
            return Err(broken.looks_like(Some(diagnosis)));
        }
    }
    Ok(())
}
