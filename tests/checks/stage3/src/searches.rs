//! The three searches, compared with brute force. A table holds the answers of the probe.

use super::search_mistakes::{any_mistakes, mistakes, observations};
use checks::generate::unit;
use checks::prelude::*;
use checks::tree::{self, closest_in_table, tied};
use raykata::bvh::Bvh;

/// Searches: a ray, up to 60 spheres (0 to 29, in some scenes each of them twice), a tree and a table of answers.
pub(super) fn searches() -> impl Strategy<Value = SearchQuery> + Clone {
    let spheres = prop::collection::vec((point(6), fractions(1..=8, 4.0)), 0..30);
    (spheres, point(10), unit(), 1..=4usize, 0..=4i32, 0..=9i32).prop_map(
        |(spheres, origin, direction, leaf_size, t_min, t_max)| {
            // Some scenes have each sphere twice.
            let times = if t_min % 3 == 1 { 2 } else { 1 };
            let sphere = |(center, radius)| std::iter::repeat_n(Sphere { center, radius }, times);
            let mut spheres: Vec<Sphere> = spheres.into_iter().flat_map(sphere).collect();
            let boxes: Vec<Aabb> = spheres.iter().map(tree::sphere_box).collect();
            let mut bvh = tree::joined(&boxes, leaf_size);
            if t_min % 2 == 0 {
                // Number the primitives from the other end.
                let last = spheres.len() as u32;
                bvh.order.iter_mut().for_each(|id| *id = last - 1 - *id);
                spheres.reverse();
            }
            // Aim half of the rays at the middle of the scene.
            let direction = if leaf_size % 2 == 0 && origin != Vec3::ZERO {
                (-origin.normalize() + 0.2 * direction).normalize()
            } else {
                direction
            };
            let t_max = if t_max == 0 { f32::INFINITY } else { 3.0 * t_max as f32 };
            tree::search_query(
                &bvh,
                &spheres,
                &Ray::new(origin, direction).with_range(t_min as f32 / 2.0, t_max),
            )
        },
    )
}

pub(super) fn describe_search(query: &SearchQuery) -> String {
    let [primitives, nodes] = [query.table.primitives.len(), query.bvh.nodes.len()];
    format!(
        "{primitives} primitives in {nodes} nodes\n{}",
        tree::hits_of(&query.ray, &query.table.primitives)
    )
}

fn judge_searches(queries: &[SearchQuery], answers: Vec<SearchAnswer>) -> Vec<CheckResult> {
    let found = |yours: &SearchAnswer| yours.hit.map(|hit| (hit.primitive, hit.t));
    let judge = |query: &SearchQuery, yours: SearchAnswer| {
        let (found, expected) = (found(&yours), closest_in_table(query));
        if found == expected {
            return Ok(());
        }
        Err(Broken::new(describe_search(query), found, expected, "brute force, (primitive, t)")
            .explained_by(observations(query, found, &yours.counts)))
    };
    compare_formulas(queries, answers, judge, |query, yours| mistakes(query, found(yours)))
}

/// Whether each ray hits anything.
fn judge_any(queries: &[SearchQuery], answers: Vec<(bool, SearchAnswer)>) -> Vec<CheckResult> {
    let judge = |query: &SearchQuery, (yours, _)| {
        let expected = closest_in_table(query).is_some();
        if yours == expected {
            return Ok(());
        }
        let nothing = !query.table.primitives.iter().any(|t| t.is_finite());
        Err(Broken::new(describe_search(query), yours, expected, "brute force")
            .explained_by([(nothing, "no primitive is hit: to enter a box is not yet a hit")]))
    };
    compare_formulas(queries, answers, judge, |query, (yours, _)| any_mistakes(query, *yours))
}

/// Trees so small that the answer shows the mistake: a leaf of four primitives, two boxes that overlap, and the same with a
/// hit in one of them only.
fn drawn_searches() -> [SearchQuery; 4] {
    let bounds = Aabb::new(Vec3::ZERO, Vec3::splat(9.0));
    let ids = tree::references(&[bounds; 4]);
    let ray = Ray::new(Vec3::NEG_X, Vec3::X);
    let mut leaf = Bvh::for_primitives(4);
    let root = leaf.add_node(bounds);
    leaf.set_leaf(root, &ids);
    let mut two = Bvh::for_primitives(2);
    let (root, near, far) = (two.add_node(bounds), two.add_node(bounds), two.add_node(bounds));
    two.set_leaf(near, &ids[..1]);
    two.set_leaf(far, &ids[1..2]);
    two.set_children(root, near, far);
    let table = |boxes: Vec<(f32, f32)>, primitives: Vec<f32>| Table { boxes, primitives };
    let two_boxes = |first: f32, second: f32| SearchQuery {
        bvh: two.clone(),
        ray,
        table: table(vec![(1.0, 9.0), (1.0, 8.0), (2.0, 9.0)], vec![first, second]),
    };
    [
        SearchQuery { bvh: leaf, ray, table: table(vec![(1.0, 9.0)], vec![3.0, 5.0, 4.0, 2.0]) },
        two_boxes(6.0, 4.0),
        two_boxes(f32::INFINITY, 4.0),
        two_boxes(6.0, f32::INFINITY),
    ]
}

pub(super) fn agrees(
    trial: &Trial<'_>,
    ask: fn(&dyn Kit, &[SearchQuery]) -> Vec<SearchAnswer>,
) -> CheckResult {
    trial.forall_and(&drawn_searches(), 1500, searches(), |queries| {
        judge_searches(queries, ask(trial.kit, queries))
    })
}

pub(super) fn hits_at_one_t_prefer_the_smaller_number(trial: &Trial<'_>) -> CheckResult {
    // Without ties first: a search that keeps the farther hit is refuted or confirmed.
    let drawn = [drawn_searches(), drawn_searches().map(tied)].concat();
    trial.forall_and(&drawn, 300, searches().prop_map(tied), |queries| {
        let both = judge_searches(queries, trial.kit.closest_hit_both(queries));
        let ordered = judge_searches(queries, trial.kit.closest_hit(queries));
        both.into_iter().zip(ordered).map(|(both, ordered)| both.and(ordered)).collect()
    })
}

/// A leaf of four primitives that are all missed, and one whose nearest primitive is the last.
fn missed_and_hit() -> [SearchQuery; 2] {
    let [hit, ..] = drawn_searches();
    let mut missed = hit.clone();
    missed.table.primitives.fill(f32::INFINITY);
    [missed, hit]
}

/// Whether a search opens no more nodes than the ray meets boxes. `asks_late` is whether more nodes prove that it asks too late.
fn judge_visits(query: &SearchQuery, yours: &SearchAnswer, asks_late: bool) -> CheckResult {
    let (visits, met) = (yours.counts.node_visits, tree::overlapped(query).len() as u64);
    if visits <= met {
        return Ok(());
    }
    let (yours, most) =
        (format!("{visits} nodes opened"), format!("at most {met}: the ray meets no more boxes"));
    Err(Broken::with_texts(describe_search(query), yours, most, "counted")
        .explained_by([(asks_late, "you open nodes whose box the ray misses: ask probe.enter first")]))
}

pub(super) fn closest_hit_both_enters_only_boxes_it_meets(trial: &Trial<'_>) -> CheckResult {
    // A search that opens nothing finds nothing.
    let simple = missed_and_hit();
    all_hold(judge_searches(&simple, trial.kit.closest_hit_both(&simple)))?;
    trial.each(500, searches(), <dyn Kit>::closest_hit_both, |query, yours| {
        judge_visits(query, &yours, yours.counts.node_visits == query.bvh.nodes.len() as u64)
    })
}

pub(super) fn any_hit_agrees_with_brute_force(trial: &Trial<'_>) -> CheckResult {
    // First test a leaf that the ray enters without hitting any of its primitives.
    let ([nothing, _], [_, two_boxes, ..]) = (missed_and_hit(), drawn_searches());
    trial.forall_and(&[nothing, two_boxes], 1500, searches(), |queries| {
        judge_any(queries, trial.kit.any_hit(queries))
    })
}

pub(super) fn any_hit_stops_at_the_first(trial: &Trial<'_>) -> CheckResult {
    // A search that asks nothing finds nothing.
    let simple = missed_and_hit();
    all_hold(judge_any(&simple, trial.kit.any_hit(&simple)))?;
    trial.each(500, searches(), <dyn Kit>::any_hit, |query, (_, answer)| {
        let describe = |n: u64| format!("{n} primitive tests after the first hit");
        let n = answer.tests_after_hit;
        if n > 0 {
            return Err(Broken::with_texts(describe_search(query), describe(n), describe(0), "counted")
                .because("the search goes on after a hit: return true at once"));
        }
        judge_visits(query, &answer, true)
    })
}
