//! `cheapest_place`: the place of a subtree, and how many nodes are opened to find it.

use super::bars::nodes_opened;
use super::scenes::scenes;
use super::trees::{drawn_trees, in_morton_order};
use checks::Trial;
use checks::broken::{Broken, CheckResult, all_hold};
use checks::judge::compare_formulas;
use checks::tree::{around, half_area};
use proptest::prelude::*;
use raykata::aabb::Aabb;
use raykata::kit::{PlaceAnswer, PlaceQuery};
use raykata::wide::{FlatTree, OpenedNode};

/// The search for the place of a subtree with the box `subtree` in a tree. Node `i` of the tree has the number `number(i)`.
fn query(tree: &FlatTree, subtree: &Aabb, number: impl Fn(usize) -> usize) -> PlaceQuery {
    let closed = OpenedNode { area: 0.0, united: 0.0, children: None };
    let mut nodes = vec![closed; tree.nodes.len()];
    for (index, node) in tree.nodes.iter().enumerate() {
        let bounds = node.bounds();
        let pair = || [node.first as usize, node.first as usize + 1].map(|child| number(child) as u32);
        nodes[number(index)] = OpenedNode {
            area: half_area(&bounds),
            united: half_area(&around([&bounds, subtree])),
            children: (!node.is_leaf()).then(pair),
        };
    }
    PlaceQuery { nodes, root: number(0) as u32, area: half_area(subtree) }
}

/// Small trees, of which half have their nodes in the reverse order, so that the root is the last one.
fn small() -> impl Strategy<Value = PlaceQuery> + Clone {
    let subtree = (checks::generate::point(7), 0..=4i32)
        .prop_map(|(low, size)| Aabb::new(low, low + glam::vec3(size as f32, 1.0, size as f32 / 2.0) / 4.0));
    (drawn_trees(40), subtree, any::<bool>())
        .prop_filter("a tree", |((_, tree), ..)| !tree.nodes.is_empty())
        .prop_map(|((_, tree), subtree, is_reversed)| {
            let n = tree.nodes.len();
            query(&tree, &subtree, |index| if is_reversed { n - 1 - index } else { index })
        })
}

/// For each node the growth of all nodes above it.
fn growths(query: &PlaceQuery) -> Vec<f64> {
    let mut growths = vec![0.0; query.nodes.len()];
    let mut waiting = vec![query.root as usize];
    while let Some(node) = waiting.pop() {
        let OpenedNode { area, united, children } = query.nodes[node];
        for child in children.into_iter().flatten().map(|child| child as usize) {
            growths[child] = growths[node] + (united - area);
            waiting.push(child);
        }
    }
    growths
}

/// For each node the increase of all areas if the subtree is inserted beside it.
fn increases(query: &PlaceQuery) -> Vec<f64> {
    growths(query).iter().zip(&query.nodes).map(|(growth, node)| growth + node.united).collect()
}

fn least(values: &[f64]) -> f64 {
    values.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Sums in another order round otherwise, by less than this part.
const ROUNDING: f64 = 1e-9;

fn is_near(yours: f64, expected: f64) -> bool {
    (yours - expected).abs() <= ROUNDING * expected
}

fn describe(query: &PlaceQuery) -> String {
    let node = |(index, node): (usize, &OpenedNode)| match node.children {
        Some([left, right]) => format!("{index}: A {} U {} above {left} and {right}", node.area, node.united),
        None => format!("{index}: A {} U {}", node.area, node.united),
    };
    let shown: Vec<String> = query.nodes.iter().enumerate().take(7).map(node).collect();
    let more = if query.nodes.len() > 7 { ", …" } else { "" };
    format!("cheapest_place of area {} from node {}: {}{more}", query.area, query.root, shown.join(", "))
}

/// Judges the node: its increase is the smallest.
fn judge_node(query: &PlaceQuery, yours: &PlaceAnswer) -> CheckResult {
    let increases = increases(query);
    let best = least(&increases);
    let of = |node: u32| increases.get(node as usize).copied();
    if of(yours.place.node).is_some_and(|increase| is_near(increase, best)) {
        return Ok(());
    }
    let expected = increases.iter().position(|&increase| increase == best).unwrap_or_default();
    let text = |node: u32| match of(node) {
        Some(increase) => format!("node {node}, where the increase is {increase}"),
        None => format!("node {node}, which does not exist"),
    };
    Err(Broken::with_texts(
        describe(query),
        text(yours.place.node),
        text(expected as u32),
        "the increase of each place",
    )
    .explained_by([]))
}

/// The known mistakes that give this node.
fn mistakes(query: &PlaceQuery, yours: &PlaceAnswer) -> Vec<(bool, &'static str)> {
    let node = yours.place.node as usize;
    let increases = increases(query);
    let is_least = |values: &[f64]| values.get(node).is_some_and(|&value| is_near(value, least(values)));
    let united: Vec<f64> = query.nodes.iter().map(|node| node.united).collect();
    let growths = growths(query);
    // Go down to the child with the smaller increase, and take the best node on the way.
    let mut way = vec![query.root as usize];
    while let Some(pair) = query.nodes[way[way.len() - 1]].children {
        let [left, right] = pair.map(|child| child as usize);
        way.push(if increases[right] < increases[left] { right } else { left });
    }
    let leaves: Vec<f64> = (0..increases.len())
        .map(|i| if query.nodes[i].children.is_none() { increases[i] } else { f64::INFINITY })
        .collect();
    let on_the_way = least(&way.iter().map(|&node| increases[node]).collect::<Vec<_>>());
    vec![
        (is_least(&united), "the nodes above a place grow as well: add U - A of each of them"),
        (is_least(&growths), "the new inner node costs something as well: add U of the place itself"),
        (is_least(&leaves), "an inner node can be the sibling as well, not only a leaf"),
        (
            way.contains(&node) && is_near(increases[node], on_the_way),
            "the child with the smaller increase may be the wrong way down: keep both, with their bounds",
        ),
    ]
}

pub(super) fn cheapest_place_has_the_smallest_increase(trial: &Trial<'_>) -> CheckResult {
    trial.forall(400, small(), |queries| {
        compare_formulas(
            queries,
            trial.kit.cheapest_place(queries),
            |query, yours| judge_node(query, &yours),
            mistakes,
        )
    })
}

pub(super) fn cheapest_place_returns_its_increase(trial: &Trial<'_>) -> CheckResult {
    trial.forall(300, small(), |queries| {
        let judge = |query: &PlaceQuery, yours: PlaceAnswer| {
            judge_node(query, &yours)?;
            let expected = increases(query)[yours.place.node as usize];
            if is_near(yours.place.increase, expected) {
                return Ok(());
            }
            let of = |increase: f64| format!("node {}, increase {increase}", yours.place.node);
            Err(Broken::with_texts(
                describe(query),
                of(yours.place.increase),
                of(expected),
                "U and the growth above",
            )
            .explained_by([]))
        };
        let formulas = |query: &PlaceQuery, yours: &PlaceAnswer| {
            let node = yours.place.node as usize;
            let (growth, united) = match query.nodes.get(node) {
                Some(opened) => (growths(query)[node], opened.united),
                None => (f64::NAN, f64::NAN),
            };
            let is = |increase: f64| is_near(yours.place.increase, increase);
            vec![
                (is(united), "the increase is U of the place only: add the growth of all nodes above"),
                (is(growth), "the increase is the growth above only: add U of the place"),
                (
                    is(growth + query.area),
                    "the increase is the bound: take U of the place, not the area of the subtree",
                ),
            ]
        };
        compare_formulas(queries, trial.kit.cheapest_place(queries), judge, formulas)
    })
}

/// The searches for new places of many leaves in the trees of all scenes.
pub fn places_in_scenes() -> Vec<PlaceQuery> {
    let of_scene = |(_, boxes): (&str, Vec<Aabb>)| -> Vec<PlaceQuery> {
        let tree = in_morton_order(&boxes, 4);
        let leaves = tree.nodes.iter().filter(|node| node.is_leaf());
        leaves.step_by(40).map(|leaf| query(&tree, &leaf.bounds(), |index| index)).collect()
    };
    scenes().into_iter().flat_map(of_scene).collect()
}

/// Judges the number of opened nodes: at most `percent` of those of the reference.
fn judge_opened(trial: &Trial<'_>, percent: usize) -> CheckResult {
    let queries = places_in_scenes();
    let answers = trial.kit.cheapest_place(&queries);
    all_hold(queries.iter().zip(&answers).map(|(query, yours)| judge_node(query, yours)).collect())?;
    let yours: usize = answers.iter().map(|answer| answer.opened.len()).sum();
    let most = nodes_opened() * percent / 100;
    if yours <= most {
        return Ok(());
    }
    let all: usize = queries.iter().map(|query| query.nodes.len()).sum();
    let what = format!("the places of {} leaves in the trees of six scenes", queries.len());
    let of = |n: usize| format!("{n} calls of `open`");
    let expected = format!("at most {}, {percent} % of the reference", of(most));
    Err(Broken::with_texts(what, of(yours), expected, "counted").explained_by([(
        yours == all,
        "every node is opened: leave out a node whose bound is not below the best increase so far",
    )]))
}

pub(super) fn cheapest_place_opens_150_percent_of_the_nodes(trial: &Trial<'_>) -> CheckResult {
    judge_opened(trial, 150)
}

pub(super) fn cheapest_place_opens_105_percent_of_the_nodes(trial: &Trial<'_>) -> CheckResult {
    judge_opened(trial, 105)
}
