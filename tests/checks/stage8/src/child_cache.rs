//! Checks of `closest_hit_with_child_cache` with tables that hold the answers of `enter` and `hit`.

use super::graph::{
    ALL, NOTHING, Row, SKIP, SORT, VOLUMES, closest, describe, judge_order, named, path_to, random_query,
    with_own_hit,
};
use checks::prelude::*;
use checks::tree::tie;
use oracle::splitmix::Random;
use raykata::graph::{ChildCache, Graph, GraphOptimisations};

/// A cache in which each node with children has one of them or, in one of three cases, none.
fn random_cache(random: &mut Random, graph: &Graph) -> ChildCache {
    let mut cache = ChildCache::default();
    for (node, children) in (0..).zip(graph.nodes.iter().map(|node| &node.children)) {
        if !children.is_empty() && random.below(3) > 0 {
            cache.set(node, children[random.below(children.len() as u64) as usize]);
        }
    }
    cache
}

/// Queries of all kinds, the plainest first, so that the reported failure has the fewest nodes.
fn random_queries(seed: u64, stream: u64) -> Vec<CachedGraphQuery> {
    let mut random = Random::new(seed, stream);
    let mut queries = Vec::new();
    for _ in 0..200 {
        for savings in [NOTHING, VOLUMES, SKIP, SORT, ALL] {
            let mut search = random_query(&mut random, savings);
            // Some have all their hits at the same t, where the smaller number decides.
            if random.below(4) == 0 {
                search.ray = search.ray.with_range(0.0, f32::INFINITY);
                tie(&mut search.table, 1.0);
            }
            let cache = random_cache(&mut random, &search.graph);
            queries.push(CachedGraphQuery { search, cache });
        }
    }
    queries.sort_by_key(|query| (query.search.graph.nodes.len(), query.search.table.primitives.len()));
    queries
}

fn describe_cached(query: &CachedGraphQuery) -> String {
    describe(&query.search).replacen("closest_hit_in_graph", "closest_hit_with_child_cache", 1)
}

/// The entries of a cache, with their nodes.
fn entries(cache: &ChildCache) -> impl Iterator<Item = (usize, u32)> {
    cache.children.iter().enumerate().filter_map(|(node, child)| Some((node, (*child)?)))
}

pub(super) fn child_cache_changes_no_answer(trial: &Trial<'_>) -> CheckResult {
    let queries = random_queries(trial.seed, 11);
    let judge = |query: &CachedGraphQuery, yours: CachedGraphAnswer| {
        let (search, found) = (&query.search, yours.found.search.hit);
        let expected = closest(search);
        let mut asked = yours.found.asked;
        asked.sort_unstable();
        let is_again = asked.windows(2).any(|pair| pair[0] == pair[1]);
        let n_boxes = yours.found.search.counts.box_tests;
        let most_boxes = if search.savings.volumes { search.graph.nodes.len() as u64 } else { 0 };
        if found == expected && !is_again && n_boxes <= most_boxes {
            return Ok(());
        }

        let yours = format!("{}, {n_boxes} volumes, tested {asked:?}", named(found));
        let expected_text =
            format!("{}, at most {most_boxes} volumes, each primitive at most once", named(expected));
        // The closest hit of a search that visits some children only: those in the cache, or the others.
        let closest_of = |is_visited: &dyn Fn(u32, u32) -> bool| {
            let mut best: Option<(f32, u32)> = None;
            let mut waiting = if search.graph.nodes.is_empty() { Vec::new() } else { vec![0] };
            while let Some(node) = waiting.pop() {
                for &primitive in &search.graph.nodes[node as usize].primitives {
                    let t = search.table.primitives[primitive as usize];
                    if search.ray.contains(t) && best.is_none_or(|best| (t, primitive) < best) {
                        best = Some((t, primitive));
                    }
                }
                let children = search.graph.nodes[node as usize].children.iter();
                waiting.extend(children.filter(|child| is_visited(node, **child)));
            }
            best
        };
        let is_of = |is_visited: &dyn Fn(u32, u32) -> bool| {
            found.map(|hit| (hit.t, hit.primitive)) == closest_of(is_visited) && found != expected
        };
        let is_cached_only = is_of(&|node, child| query.cache.get(node).is_none_or(|cached| cached == child));
        let is_left_out = is_of(&|node, child| query.cache.get(node) != Some(child));
        Err(Broken::with_texts(describe_cached(query), yours, expected_text, "brute force").explained_by([
            "you visit only the cached child of a node: the others may have a nearer hit, and must be visited, too"
                .when(is_cached_only),
            (is_left_out, "you do not visit the cached child: visit it first, and then the others"),
            "the cached child takes part twice: leave it out of the other children"
                .when(is_again || n_boxes > most_boxes && search.savings.volumes),
        ]))
    };
    all_hold(compare(&queries, trial.kit.closest_hit_with_child_cache(&queries), judge))
}

pub(super) fn child_cache_goes_first(trial: &Trial<'_>) -> CheckResult {
    let row = Row::all(trial).swap_remove(0);
    let ignored = "you do not visit the cached child first";
    let cached_only = "you visit the cached child only";
    let own_later = "you visit the cached child before the node's own primitives";
    let as_listed = "you do not sort the other children although `sort` is on";
    let unasked = "you visit the cached child without asking for its volume";
    let never = "you do not skip a child that begins beyond the closest hit";
    // A root with four children at the places 0 to 3 along the ray, as listed; the place in the cache; the tests expected.
    type Case<'a> = (&'a [u32], Option<u32>, GraphOptimisations, &'a [u32], &'a [(&'a [u32], &'static str)]);
    let cases: [Case<'_>; 8] = [
        (&[3, 1, 0, 2], Some(2), NOTHING, &[2, 3, 1, 0], &[(&[3, 1, 0, 2], ignored), (&[2], cached_only)]),
        (&[1, 3, 0, 2], Some(0), VOLUMES, &[0, 1, 3, 2], &[(&[1, 3, 0, 2], ignored), (&[0], cached_only)]),
        (
            &[3, 1, 0, 2],
            Some(1),
            SORT,
            &[1, 0, 2, 3],
            &[(&[0, 1, 2, 3], ignored), (&[1], cached_only), (&[1, 3, 0, 2], as_listed)],
        ),
        (
            &[3, 2, 1, 0],
            Some(2),
            SKIP,
            &[2, 1, 0],
            &[(&[3, 2, 1, 0], ignored), (&[2], cached_only), (&[2, 3, 1, 0], never)],
        ),
        (
            &[3, 2, 1, 0],
            Some(2),
            ALL,
            &[2, 0],
            &[(&[0], ignored), (&[2], cached_only), (&[2, 1, 0], as_listed), (&[2, 0, 1, 3], never)],
        ),
        (&[3, 2, 1, 0], Some(0), SKIP, &[0], &[(&[3, 2, 1, 0], ignored), (&[0, 3, 2, 1], never)]),
        (
            &[3, 1, 0, 2],
            Some(2),
            SKIP,
            &[4],
            &[(&[2, 4], own_later), (&[4, 2], unasked), (&[4, 2, 3, 1, 0], never)],
        ),
        (&[3, 1, 0, 2], None, ALL, &[0], &[(&[0, 1, 2, 3], never)]),
    ];
    let query = |(order, cached, savings, expected, _): &Case<'_>| {
        let search = row.query(order, *savings);
        // Primitive 4 belongs to the root itself.
        let search = if expected.contains(&4) { with_own_hit(search) } else { search };
        // Each child holds the primitive with the number of its place.
        let holder = |place: u32| search.graph.nodes.iter().position(|node| node.primitives.contains(&place));
        let mut cache = ChildCache::default();
        if let Some(child) = cached.and_then(holder) {
            cache.set(0, child as u32);
        }
        CachedGraphQuery { search, cache }
    };
    let queries: Vec<CachedGraphQuery> = cases.iter().map(query).collect();
    let answers = queries.iter().zip(trial.kit.closest_hit_with_child_cache(&queries)).collect();
    all_hold(compare(&cases, answers, |(.., expected, mistakes), (query, yours)| {
        judge_order(describe_cached(query), &yours.found.asked, expected, mistakes)
    }))
}

pub(super) fn child_cache_stores_the_way_to_the_hit(trial: &Trial<'_>) -> CheckResult {
    let queries = random_queries(trial.seed, 12);
    let judge = |query: &CachedGraphQuery, yours: CachedGraphAnswer| {
        let graph = &query.search.graph;
        // A ray that hits nothing may leave the cache as it is.
        let Some(hit) = closest(&query.search) else { return Ok(()) };
        let path = path_to(graph, hit.primitive);
        let steps = || path.windows(2).map(|step| (step[0], step[1]));
        let is_child = |(node, child): (usize, u32)| {
            graph.nodes.get(node).is_some_and(|node| node.children.contains(&child))
        };
        let stray = entries(&yours.cache).find(|entry| !is_child(*entry));
        let wrong = steps().find(|(node, child)| yours.cache.get(*node) != Some(*child));
        let (text, expected) = match (stray, wrong) {
            (None, None) => return Ok(()),
            (Some((node, child)), _) => {
                (format!("{child} for node {node}"), "one of its children".to_owned())
            }
            (None, Some((node, child))) => {
                let stored = yours.cache.get(node).map_or("nothing".into(), |child| child.to_string());
                (format!("{stored} for node {node}"), format!("{child}, which leads to #{}", hit.primitive))
            }
        };
        let unchanged = yours.cache.children.iter().eq(&query.cache.children)
            || entries(&yours.cache).eq(entries(&query.cache));
        let root_only = path.len() > 2
            && yours.cache.get(path[0]) == Some(path[1])
            && steps().skip(1).all(|(node, _)| yours.cache.get(node) == query.cache.get(node));
        Err(Broken::with_texts(describe_cached(query), text, expected, "the definition").explained_by([
            (unchanged, "you do not change the cache: store the child with the closest hit"),
            (root_only, "you store the child of the root only: each node on the path has an entry"),
            "you store another child of the node than the one with the closest hit"
                .when(stray.is_none() && wrong.is_some_and(|(node, _)| yours.cache.get(node).is_some())),
        ]))
    };
    all_hold(compare(&queries, trial.kit.closest_hit_with_child_cache(&queries), judge))
}
