//! `stream_closest_hits`: what streams find, and what they fetch.

use super::bars::calls_of_streams;
use super::visits::{cloud, search};
use super::wide_tables::{closest, describe, overlapped, searches_of};
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::{compare, compare_formulas};
use glam::Vec3;
use oracle::splitmix::Random;
use proptest::prelude::*;
use raykata::kit::{StreamAnswer, StreamQuery, WideQuery};
use raykata::ray::Ray;
use raykata::wide::STREAM;

/// The search for each ray alone.
fn alone(query: &StreamQuery) -> Vec<WideQuery> {
    let of_ray = |((ray, entries), hits): ((&Ray, &Vec<[f32; 8]>), &Vec<f32>)| WideQuery {
        tree: query.tree.clone(),
        ray: *ray,
        entries: entries.clone(),
        hits: hits.clone(),
    };
    query.rays.iter().zip(&query.entries).zip(&query.hits).map(of_ray).collect()
}

/// The searches of several rays in the same tree as one.
fn together(searches: Vec<WideQuery>) -> StreamQuery {
    let tree = searches.first().map(|one| one.tree.clone()).unwrap_or_default();
    let mut query = StreamQuery { tree, rays: Vec::new(), entries: Vec::new(), hits: Vec::new() };
    for one in searches {
        query.rays.push(one.ray);
        query.entries.push(one.entries);
        query.hits.push(one.hits);
    }
    query
}

/// Streams of up to `most` rays in small trees. Every third ray enters no leaf in which it hits nothing.
fn streams(most: usize) -> impl Strategy<Value = StreamQuery> + Clone {
    searches_of(40, most).prop_map(together)
}

/// One ray, and as many as there may be.
fn chosen() -> Vec<StreamQuery> {
    let all = streams_through_a_cloud();
    let first = |n: usize| together(alone(&all[0]).into_iter().take(n).collect());
    vec![first(1), first(STREAM)]
}

fn found(yours: &StreamAnswer) -> Vec<Option<(u32, f32)>> {
    yours.hits.iter().map(|hit| hit.map(|hit| (hit.primitive, hit.t))).collect()
}

/// Judges the hits of all rays.
fn judge_hits(query: &StreamQuery, yours: &StreamAnswer) -> CheckResult {
    let found = found(yours);
    let alone = alone(query);
    if found.len() != alone.len() {
        let of = |n: usize| format!("{n} hits");
        let input = format!("stream_closest_hits of {} rays", alone.len());
        let broken = Broken::with_texts(input, of(found.len()), of(alone.len()), "one for each ray");
        return Err(broken.explained_by([]));
    }
    for (number, (one, found)) in alone.iter().zip(&found).enumerate() {
        let expected = closest(one);
        if *found != expected {
            let input = format!("stream_closest_hits, ray {number} of {}: {}", alone.len(), describe(one));
            return Err(Broken::new(input, *found, expected, "brute force, (primitive, t)").explained_by([]));
        }
    }
    Ok(())
}

const SAME_RANGE: &str =
    "all rays are searched in the same range: each has its own, from its t_min to its t_max";

/// The known mistakes that give exactly these hits.
fn mistakes(query: &StreamQuery, yours: &StreamAnswer) -> Vec<(bool, &'static str)> {
    let (found, alone) = (found(yours), alone(query));
    let all = |hit: &dyn Fn(&WideQuery) -> Option<(u32, f32)>| {
        found.len() == alone.len() && alone.iter().zip(&found).all(|(one, found)| *found == hit(one))
    };
    // The smallest range of all rays.
    let (t_min, t_max) = query
        .rays
        .iter()
        .fold((0.0f32, f32::INFINITY), |(low, high), ray| (low.max(ray.t_min), high.min(ray.t_max)));
    let by_first = |one: &WideQuery| {
        closest(&WideQuery {
            ray: one.ray.with_range(query.rays[0].t_min, query.rays[0].t_max),
            ..one.clone()
        })
    };
    let by_all =
        |one: &WideQuery| closest(&WideQuery { ray: one.ray.with_range(t_min, t_max), ..one.clone() });
    let largest_of_equal = |one: &WideQuery| {
        let (_, t) = closest(one)?;
        let last = (0..).zip(&one.hits).filter(|(_, hit)| **hit == t).last()?;
        Some((last.0, t))
    };
    vec![
        (all(&by_first), SAME_RANGE),
        (all(&by_all), SAME_RANGE),
        (all(&largest_of_equal), "of two hits at the same t the smaller primitive number wins"),
    ]
}

pub(super) fn stream_closest_hits_agree_with_brute_force(trial: &Trial<'_>) -> CheckResult {
    trial.forall_and(&chosen(), 300, streams(20), |queries| {
        compare_formulas(
            queries,
            trial.kit.stream_closest_hits(queries),
            |query, yours| judge_hits(query, &yours),
            mistakes,
        )
    })
}

/// The first number that a list has twice.
fn twice(list: &[u32]) -> Option<u32> {
    let mut sorted = list.to_vec();
    sorted.sort_unstable();
    sorted.windows(2).find(|pair| pair[0] == pair[1]).map(|pair| pair[0])
}

pub(super) fn stream_closest_hits_fetch_nothing_twice(trial: &Trial<'_>) -> CheckResult {
    trial.forall_and(&chosen(), 300, streams(20), |queries| {
        compare(queries, trial.kit.stream_closest_hits(queries), |query, yours| {
            judge_hits(query, &yours)?;
            let (node, block) = (twice(&yours.nodes), twice(&yours.blocks));
            let (kind, list) = match (node, block) {
                (None, None) => return Ok(()),
                (Some(_), _) => ("nodes", &yours.nodes),
                _ => ("blocks", &yours.blocks),
            };
            // If no ray enters the node twice, the second fetch is for another ray than the first.
            let is_for_another = node.is_some_and(|node| {
                let of_node = yours.entered.iter().filter(|(_, entered)| *entered == node);
                twice(&of_node.map(|(ray, _)| *ray).collect::<Vec<u32>>()).is_none()
            });
            let input = format!("stream_closest_hits of {} rays", query.rays.len());
            Err(Broken::with_texts(input, format!("the {kind} {list:?}"), "each at most once", "counted")
                .explained_by([
                    (is_for_another, "a node is fetched again for another ray: enter it with all of its rays, one after the other"),
                    (node.is_none(), "a block is fetched again: test it with all rays before the next block"),
                ]))
        })
    })
}

pub(super) fn stream_closest_hits_test_only_rays_that_enter(trial: &Trial<'_>) -> CheckResult {
    trial.forall_and(&chosen(), 300, streams(20), |queries| {
        compare(queries, trial.kit.stream_closest_hits(queries), |query, yours| {
            judge_hits(query, &yours)?;
            for (number, one) in (0..).zip(&alone(query)) {
                let nodes: Vec<u32> =
                    yours.entered.iter().filter(|(ray, _)| *ray == number).map(|(_, node)| *node).collect();
                let met = overlapped(one);
                let stray = nodes.iter().find(|node| !met.contains(node));
                if stray.is_some() || twice(&nodes).is_some() {
                    let input = format!("stream_closest_hits of {} rays", query.rays.len());
                    let text = format!("ray {number} is tested in the nodes {nodes:?}");
                    let expected = format!("some of the nodes {met:?}, each once");
                    return Err(Broken::with_texts(input, text, expected, "counted").explained_by([(
                        stray.is_some(),
                        "a ray is tested in a node that it does not enter: give each child only the rays in whose mask it is",
                    )]));
                }
            }
            Ok(())
        })
    })
}

/// Twelve streams of 64 rays through a cloud of 600 spheres: six beams of neighbouring rays, and six of rays in all directions.
pub fn streams_through_a_cloud() -> Vec<StreamQuery> {
    let (tree, spheres) = cloud();
    let mut random = Random::new(12, 3);
    let mut streams = Vec::new();
    for i in 0..12 {
        let (origin, at) = (2.0 * random.direction(), 0.5 * random.in_cube());
        let is_beam = i % 2 == 0;
        let ray = |_| {
            let origin = if is_beam { origin } else { 2.0 * random.direction() };
            let at = at + if is_beam { 0.1 } else { 1.0 } * random.in_cube();
            search(&tree, &spheres, &Ray::new(origin, (at - origin).normalize_or(Vec3::X)))
        };
        streams.push(together((0..STREAM).map(ray).collect()));
    }
    streams
}

/// Judges the number of calls: at most `percent` of those of the reference.
fn judge_calls(trial: &Trial<'_>, percent: u64) -> CheckResult {
    let queries = streams_through_a_cloud();
    let answers = trial.kit.stream_closest_hits(&queries);
    for (query, yours) in queries.iter().zip(&answers) {
        judge_hits(query, yours)?;
    }
    let yours: u64 = answers.iter().map(|answer| u64::from(answer.n_calls)).sum();
    let most = calls_of_streams() * percent / 100;
    if yours <= most {
        return Ok(());
    }
    let what = format!("{} streams of {STREAM} rays through a cloud of 600 spheres", queries.len());
    let of = |n: u64| format!("{n} calls of `enter`, `candidates` and `hit`");
    let expected = format!("at most {}, {percent} % of the reference", of(most));
    Err(Broken::with_texts(what, of(yours), expected, "counted").explained_by([]))
}

pub(super) fn stream_closest_hits_take_130_percent_of_the_calls(trial: &Trial<'_>) -> CheckResult {
    judge_calls(trial, 130)
}

pub(super) fn stream_closest_hits_take_105_percent_of_the_calls(trial: &Trial<'_>) -> CheckResult {
    judge_calls(trial, 105)
}
