//! Brute force: the closest hit of many primitives.

use checks::prelude::*;
use checks::tree::move_apart;

type Hit = Option<(u32, f32)>;

/// The answers of wrong searches to a table of primitives.
fn mistakes(query: &SearchQuery, yours: Hit, tests: u64) -> [(bool, &'static str); 9] {
    let all: Vec<(u32, f32)> = (0..).zip(query.table.primitives.iter().copied()).collect();
    let hits = |entries: &[(u32, f32)]| -> Vec<(u32, f32)> {
        entries.iter().copied().filter(|(_, t)| query.ray.contains(*t)).collect()
    };
    let counting = hits(&all);
    let best = |hits: &[(u32, f32)]| {
        hits.iter().copied().reduce(|best, hit| if hit.1 < best.1 { hit } else { best })
    };
    let later = counting.iter().copied().reduce(|best, hit| if hit.1 <= best.1 { hit } else { best });
    let farthest = counting.iter().copied().reduce(|best, hit| if hit.1 > best.1 { hit } else { best });
    let is = |hit: Hit| yours == hit;
    let is_tie = is(later) && !is(best(&counting));
    let (without_last, without_first) = (&all[..all.len().saturating_sub(1)], all.get(1..).unwrap_or(&[]));
    let positive: Vec<(u32, f32)> = all.iter().copied().filter(|(_, t)| *t > 0.0 && t.is_finite()).collect();
    let stopped = tests < all.len() as u64;
    [
        (is_tie, "of two hits at the same t the primitive with the smaller number wins"),
        "the last primitive is left out: their numbers are 0..n_primitives"
            .when(is(best(&hits(without_last))) && (!is(best(&counting)) || tests + 1 == all.len() as u64)),
        "the first primitive is left out: their numbers are 0..n_primitives"
            .when(is(best(&hits(without_first))) && (!is(best(&counting)) || tests + 1 == all.len() as u64)),
        "the closest hit is not kept: the first hit ends the search, but a later primitive may be nearer"
            .when(is(counting.first().copied()) && stopped),
        "the closest hit is not kept: the first hit stays, but a later primitive may be nearer"
            .when(is(counting.first().copied())),
        "the closest hit is not kept: each hit replaces the one before (do you assign it to another variable?)"
            .when(is(counting.last().copied())),
        (is(farthest), "you keep the farther one of two hits"),
        (is(best(&positive)), "you search in the range 0..∞ and not in that of the ray: keep t_min and t_max"),
        (is(best(&counting).map(|(_, t)| (0, t))), "you return primitive 0 in any case"),
    ]
}

fn judge(query: &SearchQuery, yours: &SearchAnswer) -> CheckResult {
    let expected = checks::tree::closest_in_table(query);
    let n = query.table.primitives.len() as u64;
    let input = format!(
        "primitives at t = {:?}, ray range {:?}..{:?}",
        query.table.primitives, query.ray.t_min, query.ray.t_max
    );
    let found = yours.hit.map(|hit| (hit.primitive, hit.t));
    let tests = yours.counts.primitive_tests;
    if found != expected {
        return Err(Broken::new(input, found, expected, "the smallest t in the table")
            .explained_by(mistakes(query, found, tests)));
    }
    if tests == n {
        return Ok(());
    }
    let describe = |n: u64| format!("{n} primitive tests");
    let broken = Broken::with_texts(input, describe(tests), describe(n), "each primitive once");
    // The hit is right here, but the same search may return a wrong one for another input.
    let twice = (tests > n, "you ask for a primitive twice");
    Err(broken.explained_by(mistakes(query, found, tests)).explained_by([twice]))
}

/// A search in a table of hits.
fn query(primitives: Vec<f32>) -> SearchQuery {
    let table = Table { boxes: Vec::new(), primitives };
    SearchQuery { bvh: Default::default(), ray: Ray::new(Vec3::ZERO, Vec3::X), table }
}

pub(super) fn brute_force_finds_the_closest_of_all(trial: &Trial<'_>) -> CheckResult {
    let t = prop_oneof![Just(f32::INFINITY), (0..=20i32).prop_map(|t| t as f32 / 2.0 - 1.0)];
    let inputs =
        (prop::collection::vec(t, 0..12), -2..=4i32, 0..=3i32).prop_map(|(mut primitives, t_min, long)| {
            move_apart(&mut primitives, 0.25);
            let t_max = if long == 0 { f32::INFINITY } else { 8.0 };
            let query = query(primitives);
            SearchQuery { ray: query.ray.with_range(t_min as f32 / 2.0, t_max), ..query }
        });
    trial.each(2000, inputs, <dyn Kit>::brute_force, |query, yours| judge(query, &yours))
}

pub(super) fn brute_force_prefers_the_smaller_number(trial: &Trial<'_>) -> CheckResult {
    // All tables of one to six primitives, each of which is missed or hit at the same t.
    let t = trial.varied(2.0, 0.5f32..8.0);
    let hit = |set: u32, primitive: u32| if set >> primitive & 1 == 1 { t } else { f32::INFINITY };
    let tables = (1..=6).flat_map(|n| (0..1 << n).map(move |set| (0..n).map(|i| hit(set, i)).collect()));
    let queries: Vec<SearchQuery> = tables.map(query).collect();
    all_hold(compare(&queries, trial.kit.brute_force(&queries), |query, yours| judge(query, &yours)))
}
