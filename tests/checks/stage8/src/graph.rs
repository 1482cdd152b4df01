//! Checks of `closest_hit_in_graph` with tables that hold the answers of `enter` and `hit`.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::{compare, known};
use checks::tree::closest_of;
use glam::Vec3;
use oracle::splitmix::Random;
use raykata::bvh::PrimitiveHit;
use raykata::graph::{Graph, GraphNode, Savings};
use raykata::kit::{GraphAnswer, GraphQuery, Table};
use raykata::ray::Ray;

const NOTHING: Savings = Savings { volumes: false, skip: false, sort: false };
const VOLUMES: Savings = Savings { volumes: true, ..NOTHING };
const SKIP: Savings = Savings { volumes: true, skip: true, sort: false };
const SORT: Savings = Savings { volumes: true, skip: false, sort: true };
const ALL: Savings = Savings { volumes: true, skip: true, sort: true };

/// A tree of up to a dozen nodes with hits at multiples of 1/2, so that there are ties, and volumes that contain their
/// hits.
fn random_query(random: &mut Random, savings: Savings) -> GraphQuery {
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

/// Sorts the queries so that the reported failure, which is the first, has the fewest nodes.
fn plainest_first(queries: &mut [GraphQuery]) {
    queries.sort_by_key(|query| (query.graph.nodes.len(), query.table.primitives.len()));
}

fn describe(query: &GraphQuery) -> String {
    let node = |(index, node): (usize, &GraphNode)| {
        let (enter, leave) = query.table.boxes[index];
        let hits: Vec<String> = node
            .primitives
            .iter()
            .map(|&primitive| format!("#{primitive} at {}", query.table.primitives[primitive as usize]))
            .collect();
        format!("{index} ({enter}..{leave}): [{}] children {:?}", hits.join(", "), node.children)
    };
    let nodes: Vec<String> = query.graph.nodes.iter().enumerate().map(node).collect();
    let Savings { volumes, skip, sort } = query.savings;
    format!(
        "closest_hit_in_graph, t in {}..{}, volumes {volumes}, skip {skip}, sort {sort}, nodes\n{}",
        query.ray.t_min,
        query.ray.t_max,
        nodes.join("; ")
    )
}

pub(super) fn graph_finds_the_closest_hit(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 1);
    let mut queries: Vec<GraphQuery> = Vec::new();
    for _ in 0..300 {
        for savings in [NOTHING, VOLUMES, SKIP, SORT, ALL] {
            queries.push(random_query(&mut random, savings));
        }
    }
    queries.push(GraphQuery {
        graph: Graph::default(),
        ray: Ray::new(Vec3::ZERO, Vec3::X),
        savings: ALL,
        table: Table::default(),
    });
    plainest_first(&mut queries);
    let judge = |query: &GraphQuery, yours: GraphAnswer| {
        let expected = closest_of(&query.table.primitives, &query.ray)
            .map(|(primitive, t)| PrimitiveHit { t, primitive });
        let found = yours.search.hit;
        if found == expected {
            return Ok(());
        }
        let diagnosis = match (found, expected) {
            (Some(found), Some(right)) if found.t == right.t => {
                "of two hits at the same t you return the larger number: the smaller one wins"
            }
            (Some(found), Some(right)) if found.t > right.t => {
                "you leave out a nearer hit, or you replace it by a farther one"
            }
            (None, Some(_)) => "you lose a hit: test the node's own primitives and those of its children",
            _ => "",
        };
        let named = |hit: Option<PrimitiveHit>| {
            hit.map_or("None".into(), |hit| format!("#{} at {}", hit.primitive, hit.t))
        };
        Err(Broken::with_texts(describe(query), named(found), named(expected), "brute force")
            .looks_like(known(diagnosis)))
    };
    compare(&queries, trial.kit.closest_hit_in_graph(&queries), judge).into_iter().collect()
}

pub(super) fn graph_asks_for_everything_without_savings(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 2);
    let mut queries: Vec<GraphQuery> = (0..200).map(|_| random_query(&mut random, NOTHING)).collect();
    plainest_first(&mut queries);
    let judge = |query: &GraphQuery, yours: GraphAnswer| {
        let (n_boxes, mut asked) = (yours.search.counts.box_tests, yours.asked);
        asked.sort_unstable();
        let all: Vec<u32> = (0..query.table.primitives.len() as u32).collect();
        if n_boxes == 0 && asked == all {
            return Ok(());
        }
        let diagnosis = match () {
            () if n_boxes > 0 => "you call enter although `volumes` is off",
            () if asked.len() > all.len() => "you test a primitive twice",
            () => "you leave out a primitive: without `volumes` and `skip` every primitive is tested",
        };
        Err(Broken::with_texts(
            describe(query),
            format!("{n_boxes} volumes and the primitives {asked:?}"),
            format!("no volume and the primitives {all:?}"),
            "the definition",
        )
        .looks_like(Some(diagnosis)))
    };
    compare(&queries, trial.kit.closest_hit_in_graph(&queries), judge).into_iter().collect()
}

pub(super) fn graph_asks_for_volumes_first(trial: &Trial<'_>) -> CheckResult {
    let mut random = Random::new(trial.seed, 3);
    let mut queries: Vec<GraphQuery> = (0..200).map(|_| random_query(&mut random, VOLUMES)).collect();
    plainest_first(&mut queries);
    let judge = |query: &GraphQuery, yours: GraphAnswer| {
        let GraphQuery { graph, ray, table, .. } = query;
        // Visit the nodes whose own volume, and all volumes above it, are entered.
        let (mut boxes, mut expected) = (0, Vec::new());
        let mut waiting: Vec<u32> = if graph.nodes.is_empty() { Vec::new() } else { vec![0] };
        while let Some(index) = waiting.pop() {
            boxes += 1;
            let (near, far) = table.boxes[index as usize];
            let enter = near.max(ray.t_min);
            if enter <= far && enter < ray.t_max {
                let node = &graph.nodes[index as usize];
                expected.extend(node.primitives.iter().copied());
                waiting.extend(&node.children);
            }
        }
        expected.sort_unstable();
        let (n_boxes, mut asked) = (yours.search.counts.box_tests, yours.asked);
        asked.sort_unstable();
        if (n_boxes, &asked) == (boxes, &expected) {
            return Ok(());
        }
        let diagnosis = match () {
            () if asked.len() > expected.len() => "you test primitives in a volume that the ray misses",
            () if n_boxes > boxes => "you test a volume twice, or a volume below one that the ray misses",
            () if n_boxes < boxes => {
                "you do not test all volumes: the root has one, too, and so has each leaf"
            }
            () => "you leave out primitives that the ray may hit",
        };
        Err(Broken::with_texts(
            describe(query),
            format!("{n_boxes} volumes, primitives {asked:?}"),
            format!("{boxes} volumes, primitives {expected:?}"),
            "the definition",
        )
        .looks_like(Some(diagnosis)))
    };
    compare(&queries, trial.kit.closest_hit_in_graph(&queries), judge).into_iter().collect()
}

/// A root with `n` children one behind the other along the ray, each with one primitive at its centre. The root lists
/// them in the given order.
fn row(order: &[u32], savings: Savings) -> GraphQuery {
    let n = order.len();
    let mut nodes =
        vec![GraphNode { children: order.iter().map(|child| child + 1).collect(), primitives: vec![] }];
    nodes.extend(
        (0..n as u32).map(|primitive| GraphNode { children: Vec::new(), primitives: vec![primitive] }),
    );
    let mut boxes = vec![(1.0, n as f32 + 1.0)];
    boxes.extend((0..n).map(|i| (i as f32 + 1.0, i as f32 + 1.75)));
    let primitives = (0..n).map(|i| i as f32 + 1.5).collect();
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    GraphQuery { graph: Graph { nodes }, ray, savings, table: Table { boxes, primitives } }
}

/// Compares the primitives that are tested, in order, with the expected ones. Each case has a diagnosis.
fn judge_orders(trial: &Trial<'_>, cases: &[(GraphQuery, Vec<u32>, &'static str)]) -> CheckResult {
    let queries: Vec<GraphQuery> = cases.iter().map(|(query, ..)| query.clone()).collect();
    compare(cases, trial.kit.closest_hit_in_graph(&queries), |(query, expected, diagnosis), yours| {
        if yours.asked == *expected {
            return Ok(());
        }
        Err(Broken::with_texts(
            describe(query),
            format!("tested the primitives {:?}", yours.asked),
            format!("{expected:?}"),
            "the definition",
        )
        .looks_like(known(diagnosis)))
    })
    .into_iter()
    .collect()
}

pub(super) fn graph_skips_what_begins_beyond_the_hit(trial: &Trial<'_>) -> CheckResult {
    let beyond = "skip a volume that begins beyond the closest hit: it cannot contain a closer hit";
    let mut meets_again = row(&[0, 1], SKIP);
    // The second volume begins at the t of the first hit and has a hit at the same t, so it must be visited.
    (meets_again.table.boxes[2], meets_again.table.primitives[1]) = ((1.5, 2.0), 1.5);
    judge_orders(
        trial,
        &[
            (row(&[0, 1, 2, 3], SKIP), vec![0], beyond),
            (
                row(&[3, 2, 1, 0], SKIP),
                vec![3, 2, 1, 0],
                "you sort the children although `sort` is off: visit them as listed",
            ),
            (row(&[1, 3, 0, 2], SKIP), vec![1, 0], beyond),
            (row(&[0, 1, 2], VOLUMES), vec![0, 1, 2], "you skip a volume although `skip` is off"),
            (
                meets_again,
                vec![0, 1],
                "you skip a volume that begins exactly at the closest hit: it may contain a hit at the same \
                 t",
            ),
        ],
    )
}

pub(super) fn graph_looks_into_the_nearest_first(trial: &Trial<'_>) -> CheckResult {
    let order = "visit first the child that the ray enters first";
    judge_orders(
        trial,
        &[
            (row(&[3, 2, 1, 0], ALL), vec![0], order),
            (row(&[1, 3, 0, 2], ALL), vec![0], order),
            (
                row(&[3, 1, 0, 2], SORT),
                vec![0, 1, 2, 3],
                "with `sort` and without `skip`, visit all four children, the nearest first",
            ),
        ],
    )
}
