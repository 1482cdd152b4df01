//! `nearest_root`: which of two roots is the hit.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::{compare, known};
use checks::paste::Arguments;
use glam::Vec3;
use proptest::prelude::*;
use raykata::kit::RootQuery;
use raykata::ray::Ray;

pub(super) fn nearest_root_is_the_smaller_one_that_counts(trial: &Trial<'_>) -> CheckResult {
    // First test roots that are clearly out of range, because random roots shrink to an end of the range.
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    let behind = "you return a root behind the ray, which ray.contains(t) refuses";
    let beyond = "you return a root beyond t_max, which ray.contains(t) refuses";
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
                    "you return an end of the range; the range is open: t_min and t_max do not count"
                }
                (Some(t), _) if !query.ray.contains(t) => "you return a root that ray.contains(t) refuses",
                (None, Some(_)) if !query.ray.contains(first.min(second)) => {
                    "you return None: the smaller root does not count, but the larger one does"
                }
                (Some(_), Some(_)) => {
                    "you return the larger root (the roots are not sorted: they come in any order)"
                }
                _ => "",
            };
            Err(Broken::new(query.call("nearest_root"), yours, expected, "the definition")
                .looks_like(known(diagnosis)))
        })
    })
}

pub(super) fn nearest_root_of_nan_is_the_other_one(trial: &Trial<'_>) -> CheckResult {
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
                Some(t) if !t.is_finite() => "you return NaN or infinity, which ray.contains(t) refuses",
                _ => "comparisons with NaN are false: an if-else can put NaN in the place of the other root",
            };
            let broken = Broken::new(query.call("nearest_root"), yours, expected, "the definition");
            return Err(broken.looks_like(Some(diagnosis)));
        }
    }
    Ok(())
}
