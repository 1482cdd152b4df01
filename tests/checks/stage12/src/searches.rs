//! `wide_closest_hit` and `wide_any_hit`: what they find, and which boxes they enter.

use super::wide_tables::{Flaw, closest, describe, flawed_search, overlapped, query, searches, two_leaves};
use checks::prelude::*;

const TIES: [(Flaw, &str); 2] = [
    (
        Flaw::FirstOfEqual,
        "of two hits at the same t the smaller primitive number wins, and not the one that is tested first",
    ),
    (
        Flaw::SkippedAtTheBest,
        "a child that is entered exactly at the best t is skipped: it may hold a hit at the same t with a smaller number",
    ),
];

/// What else may be wrong with the hit that a search returns.
fn mistakes(query: &WideQuery, yours: &WideAnswer, found: Option<(u32, f32)>) -> Vec<(bool, &'static str)> {
    let expected = closest(query);
    let tested = |id: u32| yours.primitives.contains(&id);
    let missed = expected.is_some_and(|(id, _)| !tested(id));
    let mut last = yours.primitives.iter().rev().filter(|&&id| query.ray.contains(query.hits[id as usize]));
    let last = last.next().map(|&id| (id, query.hits[id as usize]));
    let is_first_block = query.tree.blocks.len() > 1 && yours.blocks.len() <= 1;
    vec![
        (
            found.is_some_and(|(_, t)| !query.ray.contains(t)),
            "you return a hit outside of the range of the ray",
        ),
        (
            missed && is_first_block,
            "only the first block of a leaf is tested: a leaf has ⌈count / BLOCK⌉ blocks",
        ),
        (
            !missed && found != expected && found == last,
            "you return the last hit, not the closest: keep the better one",
        ),
        (found.is_none() && !missed, "you test the closest primitive and return None"),
    ]
}

fn judge_hit(query: &WideQuery, yours: &WideAnswer) -> CheckResult {
    let found = yours.hit.map(|hit| (hit.primitive, hit.t));
    let expected = closest(query);
    if found == expected {
        return Ok(());
    }
    let input = format!("wide_closest_hit in {}", describe(query));
    Err(Broken::new(input, found, expected, "brute force, (primitive, t)")
        .explained_by(mistakes(query, yours, found)))
}

/// Judges the hits of searches, and names a wrong rule for ties if it explains all answers.
fn judge_hits(queries: &[WideQuery], answers: Vec<WideAnswer>) -> Vec<CheckResult> {
    compare_formulas(
        queries,
        answers,
        |query, yours| judge_hit(query, &yours),
        |query, yours| {
            let found = yours.hit.map(|hit| (hit.primitive, hit.t));
            let gives = |flaw| [true, false].map(|is_sorted| flawed_search(query, flaw, is_sorted).0);
            TIES.map(|(flaw, text)| (gives(flaw).contains(&found), text)).to_vec()
        },
    )
}

pub(super) fn wide_closest_hit_agrees_with_brute_force(trial: &Trial<'_>) -> CheckResult {
    trial.forall(400, searches(120), |queries| judge_hits(queries, trial.kit.wide_closest_hit(queries)))
}

/// Few different `t`, so that nearly every search has ties.
pub(super) fn wide_closest_hit_prefers_the_smaller_number(trial: &Trial<'_>) -> CheckResult {
    use proptest::strategy::Strategy;
    let tied = searches(30).prop_map(|mut query| {
        // Whole numbers: an entry is never behind a hit, because both are rounded down.
        query.hits.iter_mut().for_each(|t| *t = if t.is_finite() { (*t / 4.0).floor() + 1.0 } else { *t });
        for t in query.entries.iter_mut().flatten() {
            *t = if t.is_finite() { ((*t / 4.0).floor() + 1.0).max(query.ray.t_min) } else { *t };
        }
        query
    });
    // Both leaves have a hit at the same t, and the second one is entered exactly there, or before.
    let drawn = [two_leaves([3.0, 2.0], [3.0, 3.0]), two_leaves([2.0, 3.0], [3.0, 3.0])];
    trial.forall_and(&drawn, 300, tied, |queries| judge_hits(queries, trial.kit.wide_closest_hit(queries)))
}

/// Judges whether a search visits only nodes that the ray enters, each at most once.
fn judge_nodes(query: &WideQuery, yours: &WideAnswer, function: &str) -> CheckResult {
    let met = overlapped(query);
    let mut seen = yours.nodes.clone();
    seen.sort_unstable();
    let twice = seen.windows(2).any(|pair| pair[0] == pair[1]);
    let stray = seen.iter().find(|node| !met.contains(node));
    if !twice && stray.is_none() && yours.nodes.first() == Some(&0) {
        return Ok(());
    }
    let input = format!("{function} in {}", describe(query));
    let expected = format!("some of the nodes {met:?}, each once, the root first");
    Err(Broken::with_texts(input, format!("the nodes {:?}", yours.nodes), expected, "counted").explained_by(
        [
            (stray.is_some(), "you visit a child that the ray does not enter: use the mask of `enter`"),
            (twice, "you visit a node twice"),
        ],
    ))
}

pub(super) fn wide_closest_hit_enters_only_boxes_it_meets(trial: &Trial<'_>) -> CheckResult {
    trial.each(300, searches(120), <dyn Kit>::wide_closest_hit, |query, yours| {
        judge_hit(query, &yours)?;
        judge_nodes(query, &yours, "wide_closest_hit")
    })
}

/// A search whose only hit lies before the range of the ray.
fn hit_before_the_range() -> [WideQuery; 1] {
    [query(&[1.0], &[1], &[0], two_leaves([1.0; 2], [1.0; 2]).ray.with_range(2.0, f32::INFINITY))]
}

fn judge_any(query: &WideQuery, yours: &WideAnswer) -> CheckResult {
    let expected = closest(query).is_some();
    if yours.found == expected {
        return Ok(());
    }
    let is_first_block = expected && query.tree.blocks.len() > 1 && yours.blocks.len() <= 1;
    let hit_was_tested = yours.primitives.iter().any(|&id| query.ray.contains(query.hits[id as usize]));
    let input = format!("wide_any_hit in {}", describe(query));
    Err(Broken::new(input, yours.found, expected, "brute force").explained_by([
        (!expected && yours.primitives.is_empty(), "you return true where no primitive was tested"),
        (!expected, "a candidate is not a hit: ask `hit` for the exact answer"),
        (hit_was_tested, "you test a primitive that is hit and return false"),
        (is_first_block, "only the first block of a leaf is tested: a leaf has ⌈count / BLOCK⌉ blocks"),
    ]))
}

pub(super) fn wide_any_hit_agrees_with_brute_force(trial: &Trial<'_>) -> CheckResult {
    trial.each_and(&hit_before_the_range(), 300, searches(120), <dyn Kit>::wide_any_hit, |query, yours| {
        judge_any(query, &yours)
    })
}

pub(super) fn wide_any_hit_stops_at_the_first(trial: &Trial<'_>) -> CheckResult {
    trial.each_and(&hit_before_the_range(), 300, searches(120), <dyn Kit>::wide_any_hit, |query, yours| {
        // A search that asks nothing finds nothing.
        judge_any(query, &yours)?;
        if yours.calls_after_hit == 0 {
            return Ok(());
        }
        let [yours, none] = [yours.calls_after_hit, 0].map(|n| format!("{n} calls after the first hit"));
        let broken =
            Broken::with_texts(format!("wide_any_hit in {}", describe(query)), yours, none, "counted");
        Err(broken.explained_by([(true, "the search goes on after a hit: return true at once")]))
    })
}

pub(super) fn wide_any_hit_enters_only_boxes_it_meets(trial: &Trial<'_>) -> CheckResult {
    // Where nothing is hit, the search has to go through all boxes that the ray enters.
    let half_missed = searches(120).prop_map(|query| {
        let hits =
            if query.ray.t_min > 0.0 { vec![f32::INFINITY; query.hits.len()] } else { query.hits.clone() };
        WideQuery { hits, ..query }
    });
    trial.each_and(&hit_before_the_range(), 300, half_missed, <dyn Kit>::wide_any_hit, |query, yours| {
        judge_any(query, &yours)?;
        judge_nodes(query, &yours, "wide_any_hit")
    })
}
