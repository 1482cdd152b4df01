//! `wide_closest_hit` and `wide_any_hit`: what they find, and which boxes they enter.

use super::wide_tables::{Flaw, closest, describe, flawed_search, overlapped, query, searches, two_leaves};
use checks::prelude::*;
use raykata::wide::{BLOCK, Child, ChildContents, NO_PRIMITIVE};

const TIES: [(Flaw, &str); 2] = named![
    Flaw::FirstOfEqual => "of two hits at the same t the smaller primitive number wins, and not the one that is tested first",
    Flaw::SkippedAtTheBest =>
        "a child that is entered exactly at the best t is skipped: it may hold a hit at the same t with a smaller number",
];

const FIRST_ENDS: &str = "the first hit in a block ends the test of the block: another lane may be nearer";

/// The blocks of each child of a node that is a leaf: the first one, and one behind the last.
fn leaf_blocks(query: &WideQuery) -> Vec<std::ops::Range<u32>> {
    let children = query.tree.nodes.iter().flat_map(|node| node.children);
    let blocks = children.map(|child| match child.contents() {
        ChildContents::Leaf { block, count } => block..block + count.div_ceil(BLOCK as u32),
        ChildContents::Inner(_) => 0..0,
    });
    blocks.filter(|blocks| !blocks.is_empty()).collect()
}

/// The parts of the tree that a search never asks for, if its answer is right or has `lost` a hit. Right answers refute these rules.
fn never_asked(query: &WideQuery, yours: &WideAnswer, lost: bool) -> Vec<(bool, &'static str)> {
    let lanes = |block: u32| &query.tree.blocks[block as usize];
    let leaves = leaf_blocks(query);
    let is_first = |block: &u32| leaves.iter().any(|leaf| leaf.start == *block);
    let asked = |id: &u32| yours.primitives.contains(id);
    let is_hit = |id: &u32| *id != NO_PRIMITIVE && query.ray.contains(query.hits[*id as usize]);
    let n_asked = |block: u32| lanes(block).iter().filter(|id| asked(id)).count();
    // The lanes behind the first one that is hit.
    let goes_on =
        |block: u32| lanes(block).iter().skip_while(|id| !(asked(id) && is_hit(id))).skip(1).any(asked);
    // The children of a node that are visited, by their places among those that the ray enters.
    let visited = |node: u32, inner_only: bool| -> Vec<bool> {
        let children = query.tree.nodes[node as usize].children.iter().zip(query.entries[node as usize]);
        let entered =
            children.filter(|(child, t)| **child != Child::EMPTY && *t <= query.ray.t_max && t.is_finite());
        let is_visited = |(child, _): (&Child, f32)| match child.contents() {
            ChildContents::Inner(below) => Some(yours.nodes.contains(&below)),
            ChildContents::Leaf { block, .. } => (!inner_only).then(|| yours.blocks.contains(&block)),
        };
        entered.filter_map(is_visited).collect()
    };
    let each = |inner_only: bool, holds: &dyn Fn(&[bool]) -> bool| {
        yours.nodes.iter().all(|&node| holds(&visited(node, inner_only)))
    };
    let is_one = |visited: &[bool]| visited.iter().filter(|is_visited| **is_visited).count() <= 1;
    let blocks = &yours.blocks;
    let rules = named![
        blocks.iter().all(is_first) => "only the first block of a leaf is tested: a leaf has ⌈count / BLOCK⌉ blocks",
        blocks.iter().all(|&block| !lanes(block).contains(&NO_PRIMITIVE)) =>
            "a block that is not full is left out: a leaf has ⌈count / BLOCK⌉ blocks",
        blocks.iter().all(|&block| n_asked(block) <= 1) =>
            "only one lane of a block is tested: test each one of the mask of `candidates`",
        blocks.iter().all(|&block| !goes_on(block)) => FIRST_ENDS,
        each(false, &is_one) => "only one child of a node is visited: the others wait on the stack",
        each(true, &is_one) => "of the inner children of a node only one is visited: the others wait on the stack",
        each(false, &|visited| visited.first() != Some(&true)) => "the first child of a node that the ray enters is never visited",
        each(false, &|visited| visited.last() != Some(&true) || visited.len() == 1) =>
            "the last child of a node that the ray enters is never visited, unless it is the only one",
    ];
    rules.map(|(holds, text)| (holds && lost, text)).to_vec()
}

/// Where a search loses a primitive that it does not test.
fn loses(query: &WideQuery, yours: &WideAnswer, id: u32) -> Vec<(bool, &'static str)> {
    let holds = |block: &u32| query.tree.blocks[*block as usize].contains(&id);
    let leaf = leaf_blocks(query).into_iter().find(|blocks| blocks.clone().any(|block| holds(&block)));
    let is_lost = !yours.primitives.contains(&id);
    let is_lane = yours.blocks.iter().any(holds);
    let is_block = leaf.is_some_and(|mut blocks| blocks.any(|block| yours.blocks.contains(&block)));
    vec![
        (is_lost && is_lane, "a candidate of a block is never tested: test each lane of the mask"),
        (is_lost && is_block, "a block of a leaf is never asked for: a leaf has ⌈count / BLOCK⌉ blocks"),
        (is_lost, "a child that the ray enters is never visited: each one is visited or waits on the stack"),
    ]
}

/// What else may be wrong with the hit that a search returns.
fn mistakes(query: &WideQuery, yours: &WideAnswer, found: Option<(u32, f32)>) -> Vec<(bool, &'static str)> {
    let expected = closest(query);
    let missed = expected.is_some_and(|(id, _)| !yours.primitives.contains(&id));
    let hits = yours.primitives.iter().filter(|&&id| query.ray.contains(query.hits[id as usize]));
    let hits: Vec<(u32, f32)> = hits.map(|&id| (id, query.hits[id as usize])).collect();
    let is_other = !missed && found != expected && found.is_some();
    let mut mistakes = named![
        found.is_some_and(|(_, t)| !query.ray.contains(t)) => "you return a hit outside of the range of the ray",
        is_other && found == hits.last().copied() => "you return the last hit, not the closest: keep the better one",
        is_other && found == hits.first().copied() => "you return the first hit, not the closest: a later one may be nearer",
        found.is_none() && !missed => "you test the closest primitive and return None",
    ].to_vec();
    mistakes.extend(expected.map(|(id, _)| loses(query, yours, id)).unwrap_or_default());
    mistakes
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
            let ties = TIES.map(|(flaw, text)| (gives(flaw).contains(&found), text));
            let lost = closest(query).is_some_and(|(id, _)| !yours.primitives.contains(&id));
            let rules = never_asked(query, yours, lost || found == closest(query));
            rules.into_iter().chain(ties).collect()
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
    let hit_was_tested = tests_a_hit(query, yours);
    let input = format!("wide_any_hit in {}", describe(query));
    let mut mistakes = vec![
        (!expected && yours.primitives.is_empty(), "you return true where no primitive was tested"),
        (!expected, "a candidate is not a hit: ask `hit` for the exact answer"),
        (hit_was_tested, "you test a primitive that is hit and return false"),
    ];
    mistakes.extend(closest(query).map(|(id, _)| loses(query, yours, id)).unwrap_or_default());
    Err(Broken::new(input, yours.found, expected, "brute force").explained_by(mistakes))
}

fn tests_a_hit(query: &WideQuery, yours: &WideAnswer) -> bool {
    yours.primitives.iter().any(|&id| query.ray.contains(query.hits[id as usize]))
}

pub(super) fn wide_any_hit_agrees_with_brute_force(trial: &Trial<'_>) -> CheckResult {
    trial.forall_and(&hit_before_the_range(), 300, searches(120), |queries| {
        let judge = |query: &WideQuery, yours| judge_any(query, &yours);
        let answers = trial.kit.wide_any_hit(queries);
        compare_formulas(queries, answers, judge, |query, yours| {
            let lost = closest(query).is_some() && !tests_a_hit(query, yours);
            let rules = never_asked(query, yours, lost || yours.found == closest(query).is_some());
            // A right search ends at its first hit.
            rules.into_iter().filter(|(_, text)| *text != FIRST_ENDS).collect()
        })
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
        Err(broken.because("the search goes on after a hit: return true at once"))
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
