//! Checks of `closest_hit_in_graph` with tables that hold the answers of `enter` and `hit`.

use checks::prelude::*;
use checks::tree::{closest_of, move_apart, tie};
use oracle::splitmix::Random;
use raykata::bvh::PrimitiveHit;
use raykata::graph::{Graph, GraphNode, GraphOptimisations};

pub(super) const NOTHING: GraphOptimisations =
    GraphOptimisations { volumes: false, skip: false, sort: false };
pub(super) const VOLUMES: GraphOptimisations = GraphOptimisations { volumes: true, ..NOTHING };
pub(super) const SKIP: GraphOptimisations = GraphOptimisations { volumes: true, skip: true, sort: false };
pub(super) const SORT: GraphOptimisations = GraphOptimisations { volumes: true, skip: false, sort: true };
pub(super) const ALL: GraphOptimisations = GraphOptimisations { volumes: true, skip: true, sort: true };

/// A tree of up to a dozen nodes with hits near multiples of 1/2, of which no two are equal, and volumes that contain their
/// hits.
pub(super) fn random_query(random: &mut Random, savings: GraphOptimisations) -> GraphQuery {
    let n_nodes = 1 + random.below(12) as usize;
    let mut nodes = vec![GraphNode::default(); n_nodes];
    for node in 1..n_nodes {
        let parent = random.below(node as u64) as usize;
        nodes[parent].children.push(node as u32);
    }
    let mut primitives = Vec::new();
    for node in &mut nodes {
        for _ in 0..random.below(3) {
            node.primitives.push(primitives.len() as u32);
            let hit = 0.5 * (1 + random.below(12)) as f32;
            primitives.push(if random.below(3) == 0 { f32::INFINITY } else { hit });
        }
    }
    move_apart(&mut primitives, 0.125);
    let mut boxes = vec![(f32::INFINITY, f32::NEG_INFINITY); n_nodes];
    for index in (0..n_nodes).rev() {
        let hits = nodes[index].primitives.iter().map(|&p| primitives[p as usize]).filter(|t| t.is_finite());
        let (mut near, mut far) = hits.fold(boxes[index], |(near, far), t| (near.min(t), far.max(t)));
        for &child in &nodes[index].children {
            let (enter, leave) = boxes[child as usize];
            (near, far) = (near.min(enter), far.max(leave));
        }
        // Some volumes begin a little before their first hit, and some volumes without hits are entered, too.
        if near <= far {
            near -= 0.5 * random.below(3) as f32;
        } else if random.below(2) == 0 {
            (near, far) = (1.0, 2.0);
        }
        boxes[index] = (near, far);
    }
    let (t_min, t_max) = [(0.0, f32::INFINITY), (1.0, 4.5), (2.5, f32::INFINITY)][random.below(3) as usize];
    let ray = Ray::new(Vec3::ZERO, Vec3::X).with_range(t_min, t_max);
    GraphQuery { graph: Graph { nodes }, ray, savings, table: Table { boxes, primitives } }
}

/// Judges the answers, the plainest queries first, so that the reported failure has the fewest nodes.
fn judge_plainest_first(
    trial: &Trial<'_>,
    mut queries: Vec<GraphQuery>,
    judge: impl Fn(&GraphQuery, GraphAnswer) -> CheckResult,
) -> CheckResult {
    queries.sort_by_key(|query| (query.graph.nodes.len(), query.table.primitives.len()));
    all_hold(compare(&queries, trial.kit.closest_hit_in_graph(&queries), judge))
}

pub(super) fn describe(query: &GraphQuery) -> String {
    let GraphQuery { graph, ray, savings: GraphOptimisations { volumes, skip, sort }, table } = query;
    let sizes = format!("{} nodes and {} primitives", graph.nodes.len(), table.primitives.len());
    format!("closest_hit_in_graph, volumes {volumes}, skip {skip}, sort {sort}, {sizes}\n{}", ray.paste())
}

pub(super) fn graph_finds_the_closest_hit(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 1);
    let savings = (0..300).flat_map(|_| [NOTHING, VOLUMES, SKIP, SORT, ALL]);
    let mut queries: Vec<GraphQuery> = savings.map(|savings| random_query(&mut random, savings)).collect();
    queries.push(GraphQuery {
        graph: Graph::default(),
        ray: Ray::new(Vec3::ZERO, Vec3::X),
        savings: ALL,
        table: Table::default(),
    });
    judge_hits(trial, queries)
}

pub(super) fn graph_prefers_the_smaller_number(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 4);
    let mut queries: Vec<GraphQuery> = Vec::new();
    // All hits are at the same t, and the volumes begin exactly there, or before.
    for _ in 0..60 {
        for (savings, near) in [(NOTHING, 1.0), (VOLUMES, 5.0), (SKIP, 1.0), (SKIP, 5.0), (ALL, 5.0)] {
            let mut query = random_query(&mut random, savings);
            query.ray = query.ray.with_range(0.0, f32::INFINITY);
            tie(&mut query.table, near);
            queries.push(query);
        }
    }
    judge_hits(trial, queries)
}

pub(super) fn closest(query: &GraphQuery) -> Option<PrimitiveHit> {
    closest_of(&query.table.primitives, &query.ray).map(|(primitive, t)| PrimitiveHit { t, primitive })
}

pub(super) fn named(hit: Option<PrimitiveHit>) -> String {
    hit.map_or("None".into(), |hit| format!("#{} at {}", hit.primitive, hit.t))
}

/// The nodes from the root to the one that holds a primitive.
pub(super) fn path_to(graph: &Graph, primitive: u32) -> Vec<u32> {
    let holder = graph.nodes.iter().position(|node| node.primitives.contains(&primitive)).unwrap_or(0) as u32;
    let parent = |node: &u32| graph.nodes.iter().position(|other| other.children.contains(node));
    let mut path: Vec<u32> =
        std::iter::successors(Some(holder), |node| parent(node).map(|above| above as u32)).collect();
    path.reverse();
    path
}

fn judge_hits(trial: &Trial<'_>, queries: Vec<GraphQuery>) -> CheckResult {
    judge_plainest_first(trial, queries, |query, yours| {
        let (found, expected) = (yours.search.hit, closest(query));
        if found == expected {
            return Ok(());
        }
        Err(Broken::with_texts(describe(query), named(found), named(expected), "brute force")
            .explained_by(lost_hits(query, found, expected, &yours.asked)))
    })
}

/// The mistakes for a wrong closest hit, each with whether it explains this one. `asked` lists the primitives that were
/// tested.
fn lost_hits(
    query: &GraphQuery,
    found: Option<PrimitiveHit>,
    expected: Option<PrimitiveHit>,
    asked: &[u32],
) -> Vec<(bool, &'static str)> {
    let Some(right) = expected else { return Vec::new() };
    let path = path_to(&query.graph, right.primitive);
    let mut nodes = path.iter().rev().map(|number| &query.graph.nodes[*number as usize]);
    let Some(holder) = nodes.next() else { return Vec::new() };
    let above: Vec<&GraphNode> = nodes.collect();
    let is_tested = asked.contains(&right.primitive);
    named![
        is_tested && found.is_some_and(|found| found.t == right.t && found.primitive > right.primitive) =>
            "of two hits at the same t you return the larger number: the smaller one wins",
        !is_tested && found.is_some_and(|found| found.t == right.t) =>
            "you skip a volume that begins exactly at the closest hit: it may contain a hit at the same t",
        found.is_some_and(|found| found.t == right.t) =>
            "you lose a hit at the t of the closest one so far: the smaller number wins",
        is_tested && found.is_some() =>
            "you test the nearest primitive, but you replace it by another one: keep the nearest hit",
        is_tested && found.is_none() => "you test the nearest primitive, but you do not return its hit",
        !is_tested && !holder.children.is_empty() =>
            "you do not test the own primitives of a node that has children: a node can have both",
        !is_tested && above.len() > 1 =>
            "you do not test primitives more than one level below the root: visit the children of children, too",
        !is_tested && above.iter().any(|node| !node.primitives.is_empty()) =>
            "you do not visit the children of a node that has primitives of its own: a node can have both",
        !is_tested && found.is_some() =>
            "you leave out a nearer hit: you have a hit and do not test a primitive that is nearer",
    ].to_vec()
}

pub(super) fn graph_asks_for_everything_without_savings(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 2);
    // Without volumes there are no entries by which nodes could be skipped or sorted.
    let savings = (0..100).flat_map(|_| [NOTHING, GraphOptimisations { volumes: false, ..ALL }]);
    let queries = savings.map(|savings| random_query(&mut random, savings)).collect();
    judge_plainest_first(trial, queries, |query, yours| {
        let (n_boxes, mut asked) = (yours.search.counts.box_tests, yours.asked);
        asked.sort_unstable();
        let all: Vec<u32> = (0..query.table.primitives.len() as u32).collect();
        if n_boxes == 0 && asked == all {
            return Ok(());
        }
        let is_twice = asked.windows(2).any(|pair| pair[0] == pair[1]);
        let left_out = all.iter().any(|primitive| !asked.contains(primitive));
        let below_a_hit = all.iter().filter(|primitive| !asked.contains(primitive)).all(|primitive| {
            let hits = |node: &u32| {
                let own = &query.graph.nodes[*node as usize].primitives;
                own.iter().any(|&p| query.ray.contains(query.table.primitives[p as usize]))
            };
            path_to(&query.graph, *primitive).iter().rev().skip(1).any(hits)
        });
        let yours = format!("{n_boxes} volumes and the primitives {asked:?}");
        let expected = format!("no volume and the primitives {all:?}");
        Err(Broken::with_texts(describe(query), yours, expected, "the definition").explained_by(named![
            n_boxes > 0 => "you call enter although `volumes` is off",
            is_twice => "you test a primitive twice",
            left_out && below_a_hit && n_boxes == 0 =>
                "you leave out a primitive below a node with a hit of its own: its children can be nearer",
            left_out && n_boxes == 0 => "you leave out a primitive: without `volumes` every primitive is tested",
        ]))
    })
}

const LEAVES_UNTESTED: &str = "you do not test the volumes of leaves: the root has one, and so has each leaf";

pub(super) fn graph_asks_for_volumes_first(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 3);
    let queries = (0..200).map(|_| random_query(&mut random, VOLUMES)).collect();
    judge_plainest_first(trial, queries, |query, yours| {
        let GraphQuery { graph, ray, table, .. } = query;
        // Visit the nodes whose own volume, and all volumes above it, are entered; or the root in any case.
        let search = |is_root_open: bool| {
            let (mut boxes, mut leaves, mut expected) = (0, 0, Vec::new());
            let mut waiting: Vec<u32> = if graph.nodes.is_empty() { Vec::new() } else { vec![0] };
            while let Some(index) = waiting.pop() {
                let is_open = is_root_open && index == 0;
                boxes += u64::from(!is_open);
                leaves += u64::from(graph.nodes[index as usize].children.is_empty());
                let (near, far) = table.boxes[index as usize];
                let enter = near.max(ray.t_min);
                if is_open || (enter <= far && enter < ray.t_max) {
                    let node = &graph.nodes[index as usize];
                    expected.extend(node.primitives.iter().copied());
                    waiting.extend(&node.children);
                }
            }
            expected.sort_unstable();
            (boxes, leaves, expected)
        };
        let (boxes, leaves, expected) = search(false);
        let (n_boxes, mut asked) = (yours.search.counts.box_tests, yours.asked);
        asked.sort_unstable();
        if (n_boxes, &asked) == (boxes, &expected) {
            return Ok(());
        }
        let (boxes_below_root, _, below_root) = search(true);
        let is_twice = asked.windows(2).any(|pair| pair[0] == pair[1]);
        let is_root_a_leaf = graph.nodes.first().is_some_and(|root| root.children.is_empty());
        let extra = asked.iter().any(|primitive| !expected.contains(primitive));
        let is_all = n_boxes == graph.nodes.len() as u64 && asked.len() == table.primitives.len();
        let of = |n: u64, primitives: &[u32]| format!("{n} volumes, primitives {primitives:?}");
        let (yours, right) = (of(n_boxes, &asked), of(boxes, &expected));
        Err(Broken::with_texts(describe(query), yours, right, "the definition").explained_by([
            (is_twice, "you test a primitive twice"),
            "you do not test the volume of the root: the root has one, too"
                .when(n_boxes + 1 == boxes || (n_boxes, &asked) == (boxes_below_root, &below_root)),
            // The root may be a leaf. Some test its volume nevertheless.
            (n_boxes + leaves == boxes, LEAVES_UNTESTED),
            (n_boxes + leaves == boxes + u64::from(is_root_a_leaf), LEAVES_UNTESTED),
            (is_all, "you open volumes that the ray misses, too"),
            (extra, "you test primitives in a volume that the ray misses"),
            (n_boxes > boxes && !extra, "you test a volume twice, or a volume below one that the ray misses"),
        ]))
    })
}

/// Nodes one behind the other along the ray.
pub(super) struct Row {
    /// The order of the numbers of the nodes. It differs from the order along the ray, so that a search that sorts by number
    /// is noticed.
    numbers: [u32; 4],
    /// The distance from one node to the next one.
    step: f32,
}

impl Row {
    /// One row for the public seed, and four for a hidden one.
    pub(super) fn all(trial: &Trial<'_>) -> Vec<Row> {
        let public = [2, 4, 1, 3];
        let hidden = (Just(public).prop_shuffle(), 0.25f32..8.0);
        let drawn = trial.varied(vec![(public, 1.0)], prop::collection::vec(hidden, 4));
        drawn.into_iter().map(|(numbers, step)| Row { numbers, step }).collect()
    }

    /// A root with up to four children one behind the other along the ray, each with one primitive at its centre. The root
    /// lists them in the given order.
    pub(super) fn query(&self, order: &[u32], savings: GraphOptimisations) -> GraphQuery {
        let n = order.len() as u32;
        // The places along the ray in the order of their nodes' numbers.
        let mut places: Vec<u32> = (0..n).collect();
        places.sort_by_key(|place| self.numbers[*place as usize]);
        let number = |place: u32| places.iter().position(|other| *other == place).unwrap_or(0) as u32 + 1;
        let children = order.iter().map(|place| number(*place)).collect();
        let mut nodes = vec![GraphNode { children, primitives: vec![] }];
        nodes.extend(places.iter().map(|place| GraphNode { children: Vec::new(), primitives: vec![*place] }));
        let t = |steps: f32| self.step * steps;
        let mut boxes = vec![(t(1.0), t(n as f32 + 1.0))];
        boxes.extend(places.iter().map(|place| (t(*place as f32 + 1.0), t(*place as f32 + 1.75))));
        let primitives = (0..n).map(|place| t(place as f32 + 1.5)).collect();
        let ray = Ray::new(Vec3::ZERO, Vec3::X);
        GraphQuery { graph: Graph { nodes }, ray, savings, table: Table { boxes, primitives } }
    }
}

/// The same query with one more primitive in the root, whose hit lies before all others.
pub(super) fn with_own_hit(mut query: GraphQuery) -> GraphQuery {
    let near = 0.5 * query.table.boxes[0].0;
    query.graph.nodes[0].primitives.push(query.table.primitives.len() as u32);
    query.table.primitives.push(near);
    query.table.boxes[0].0 = near;
    query
}

/// A query, the primitives to test in order, and the orders that mistakes give.
type Case<'a> = (GraphQuery, &'a [u32], &'a [(&'a [u32], &'static str)]);

/// Compares the primitives that are tested, in order, with the expected ones and with those of the mistakes.
pub(super) fn judge_order(
    input: String,
    asked: &[u32],
    expected: &[u32],
    mistakes: &[(&[u32], &'static str)],
) -> CheckResult {
    if asked == expected {
        return Ok(());
    }
    let (yours, right) = (format!("tested the primitives {asked:?}"), format!("{expected:?}"));
    Err(Broken::with_texts(input, yours, right, "the definition")
        .explained_by(mistakes.iter().map(|(wrong, text)| (asked == *wrong, *text))))
}

fn judge_orders(trial: &Trial<'_>, cases: &[Case<'_>]) -> CheckResult {
    let queries: Vec<GraphQuery> = cases.iter().map(|(query, ..)| query.clone()).collect();
    let answers = trial.kit.closest_hit_in_graph(&queries);
    all_hold(compare(cases, answers, |(query, expected, mistakes), yours| {
        judge_order(describe(query), &yours.asked, expected, mistakes)
    }))
}

pub(super) fn graph_skips_what_begins_beyond_the_hit(trial: &Trial<'_>) -> CheckResult {
    let never = "skip a volume that begins beyond the closest hit: it cannot contain a closer hit, and you decide that when \
        you are about to visit it";
    let sorted = "you sort the children although `sort` is off: visit them as listed";
    let always = "you skip a volume although `skip` is off";
    let own_last = "you visit the children before a node's own primitives: their hits may save the children";
    Row::all(trial).iter().try_for_each(|row| {
        let cases: [Case<'_>; 5] = [
            (with_own_hit(row.query(&[1, 0], SKIP)), &[2], &[(&[1, 0, 2], own_last), (&[2, 1, 0], never)]),
            (row.query(&[0, 1, 2, 3], SKIP), &[0], &[(&[0, 1, 2, 3], never)]),
            (row.query(&[3, 2, 1, 0], SKIP), &[3, 2, 1, 0], &[(&[0], sorted), (&[0, 1, 2, 3], never)]),
            (row.query(&[1, 3, 0, 2], SKIP), &[1, 0], &[(&[1, 3, 0, 2], never), (&[0], sorted)]),
            (row.query(&[2, 0, 3, 1], VOLUMES), &[2, 0, 3, 1], &[(&[2, 0], always), (&[0, 1, 2, 3], sorted)]),
        ];
        judge_orders(trial, &cases)
    })
}

pub(super) fn graph_looks_into_the_nearest_first(trial: &Trial<'_>) -> CheckResult {
    let listed =
        "you visit the children as listed: with `sort`, visit first the child that the ray enters first";
    let backwards = "you visit the farthest child first: visit first the child that the ray enters first";
    let numbers = "you sort the children by their numbers: visit first the child that the ray enters first";
    let never = "you sort, but you do not skip: skip a volume that begins beyond the closest hit";
    let to_skip = "you sort only if `skip` is on: with `sort` and without `skip`, visit all four children, the nearest first";
    let nearest_only = "you bring only the nearest child to the front: with `sort` and without `skip`, visit all four \
        children, the nearest first";
    let always = "you skip a volume although `skip` is off";
    Row::all(trial).iter().try_for_each(|row| {
        let cases: [Case<'_>; 3] = [
            (
                row.query(&[3, 2, 1, 0], ALL),
                &[0],
                &[
                    (&[3, 2, 1, 0], listed),
                    (&[3, 2, 1, 0], backwards),
                    (&[2, 0], numbers),
                    (&[1, 0], numbers),
                    (&[0, 1, 2, 3], never),
                ],
            ),
            (
                row.query(&[1, 3, 0, 2], ALL),
                &[0],
                &[
                    (&[1, 0], listed),
                    (&[3, 2, 1, 0], backwards),
                    (&[2, 0], numbers),
                    (&[1, 0], numbers),
                    (&[0, 1, 2, 3], never),
                    (&[1, 3, 0, 2], "you neither sort nor skip"),
                ],
            ),
            (
                row.query(&[3, 1, 0, 2], SORT),
                &[0, 1, 2, 3],
                &[
                    (&[3, 1, 0, 2], to_skip),
                    (&[3, 1, 0, 2], listed),
                    (&[3, 2, 1, 0], backwards),
                    (&[2, 0, 3, 1], numbers),
                    (&[1, 3, 0, 2], numbers),
                    (&[0, 3, 1, 2], nearest_only),
                    (&[0, 1, 3, 2], nearest_only),
                    (&[0], always),
                ],
            ),
        ];
        judge_orders(trial, &cases)
    })
}
