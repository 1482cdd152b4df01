//! Brute force: the closest hit of many primitives.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::{compare, known};
use glam::Vec3;
use proptest::prelude::*;
use raykata::kit::{SearchQuery, Table};
use raykata::ray::Ray;

pub(super) fn brute_force_finds_the_closest_of_all(trial: &Trial<'_>) -> CheckResult {
    // First test small tables, on which each mistake gives another answer.
    for (primitives, diagnosis) in [
        (vec![5.0], "the last primitive is left out: their numbers are 0..n"),
        (
            vec![1.0, 3.0],
            "the closest hit is not kept: a later hit replaces it (do you assign it to another variable?)",
        ),
        (vec![3.0, 1.0], "the closest hit is not kept: the first hit stays, or ends the search"),
    ] {
        let ray = Ray::new(Vec3::ZERO, Vec3::X);
        let table = Table { boxes: Vec::new(), primitives };
        let query = SearchQuery { bvh: Default::default(), ray, table };
        let expected = checks::tree::closest_in_table(&query);
        let yours = trial.kit.brute_force(std::slice::from_ref(&query))[0].hit;
        let yours = yours.map(|hit| (hit.primitive, hit.t));
        if yours != expected {
            let input = format!("primitives at t = {:?}", query.table.primitives);
            return Err(Broken::new(input, yours, expected, "the smallest t in the table")
                .looks_like(Some(diagnosis)));
        }
    }
    let t = prop_oneof![Just(f32::INFINITY), (0..=20i32).prop_map(|t| t as f32 / 2.0 - 1.0)];
    let inputs = (prop::collection::vec(t, 0..12), 0..=4i32).prop_map(|(primitives, t_min)| {
        let ray = Ray::new(Vec3::ZERO, Vec3::X).with_range(t_min as f32 / 2.0, 8.0);
        SearchQuery { bvh: Default::default(), ray, table: Table { boxes: Vec::new(), primitives } }
    });
    trial.forall(2000, inputs, |queries| {
        compare(queries, trial.kit.brute_force(queries), |query, yours| {
            let expected = checks::tree::closest_in_table(query);
            let n = query.table.primitives.len() as u64;
            let input = format!(
                "primitives at t = {:?}, ray range {:?}..{:?}",
                query.table.primitives, query.ray.t_min, query.ray.t_max
            );
            let found = yours.hit.map(|hit| (hit.primitive, hit.t));
            if found != expected {
                let diagnosis = match (found, expected) {
                    (_, Some((primitive, _))) if u64::from(primitive) + 1 == n => {
                        "the last primitive is left out"
                    }
                    (Some((_, yours)), Some((_, expected))) if yours == expected => {
                        "of two hits at the same t the primitive with the smaller number wins"
                    }
                    (Some((_, yours)), Some((_, expected))) if yours > expected => {
                        "the closest hit is not kept (do you assign it to another variable?)"
                    }
                    _ => "",
                };
                return Err(Broken::new(input, found, expected, "the smallest t in the table")
                    .looks_like(known(diagnosis)));
            }
            let tests = yours.counts.primitive_tests;
            let describe = |n: u64| format!("{n} primitive tests");
            if tests == n {
                Ok(())
            } else {
                Err(Broken::with_texts(input, describe(tests), describe(n), "each primitive once"))
            }
        })
    })
}
