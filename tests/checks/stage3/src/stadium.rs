//! A teapot in a stadium: the counted costs of trees and searches.

use super::builds::{CHEAPER, judge_by_area};
use super::search_mistakes::order_mistakes;
use checks::prelude::*;
use checks::tree;
use raykata::bvh::{Bvh, Contents, Node};
use raykata::count::Counts;
use raykata::scene::Split;

/// A small, dense object in a huge, sparse surrounding, where the surface area heuristic saves the most work.
pub(super) fn stadium() -> Vec<Sphere> {
    let seats = (0..60).map(|i| {
        let angle = i as f32 / 60.0 * std::f32::consts::TAU;
        Sphere { center: vec3(100.0 * angle.cos(), 2.0 + (i % 4) as f32, 80.0 * angle.sin()), radius: 3.0 }
    });
    let teapot = (0..140).map(|i| {
        let (x, y, z) = (i % 7, i / 7 % 5, i / 35);
        let center = vec3(x as f32, y as f32 + 0.37 * x as f32, z as f32 + 0.21 * y as f32) * 0.3;
        Sphere { center, radius: 0.1 }
    });
    seats.chain(teapot).collect()
}

/// Rays through the stadium from three points: outside, in the seats, and beside the teapot.
pub(super) fn stadium_rays() -> Vec<Ray> {
    let eyes = [vec3(120.0, 8.0, 7.0), vec3(-3.0, 5.0, -90.0), vec3(4.0, 3.0, 4.0)];
    let target = |i: i32| vec3((i % 10) as f32 * 0.3 - 0.5, (i / 10) as f32 * 0.3, 0.5);
    let looks = |eye: Vec3| (0..60).map(move |i| Ray::new(eye, (target(i) - eye).normalize()));
    eyes.into_iter().flat_map(looks).collect()
}

/// The same rays as searches, with a tree and a table of answers.
pub(super) fn stadium_searches() -> Vec<SearchQuery> {
    let spheres = stadium();
    let boxes: Vec<Aabb> = spheres.iter().map(tree::sphere_box).collect();
    let bvh = tree::joined(&boxes, 2);
    stadium_rays().iter().map(|ray| tree::search_query(&bvh, &spheres, ray)).collect()
}

/// The expected cost of a tree over the stadium with at most four primitives per leaf, split by the object median.
const EXPECTED_BY_MEDIAN: f64 = 7.947;

/// The same, split by the cheapest cut at every node.
const EXPECTED_BY_AREA: f64 = 5.341;

/// [`counted_cost`] of the reference's tree over the stadium by each split strategy, at most four primitives per leaf.
fn counted(split: Split) -> u64 {
    match split {
        Split::ObjectMedian => 5780,
        Split::SpatialMedian => 3499,
        Split::SurfaceArea => 3009,
    }
}

/// The numbers of nodes opened and primitives tested by [`stadium_searches`] if the nearer child is searched first.
const SEARCHED: (u64, u64) = (4481, 1178);

pub(super) fn total(answers: &[SearchAnswer]) -> Counts {
    let mut sum = Counts::default();
    answers.iter().for_each(|answer| sum += answer.counts);
    sum
}

pub(super) fn surface_area_heuristic_is_cheap_in_a_stadium(trial: &Trial<'_>) -> CheckResult {
    let bounds = stadium().iter().map(tree::sphere_box).collect();
    let query = BuildQuery { bounds, split: Split::SurfaceArea, leaf_size: 4 };
    let bvh = trial.kit.build(&[query]).remove(0);
    let yours = tree::expected_cost(&bvh);
    // Equally cheap cuts may lead to different trees below. Variants of the reference are within 1 %.
    let (median, most) = (EXPECTED_BY_MEDIAN, 1.05 * EXPECTED_BY_AREA);
    if yours <= most {
        return judge_by_area(trial);
    }
    // Variants of an object median are within 5 % of each other.
    let is_a_median = (yours - median).abs() <= 0.05 * median;
    Err(Broken::with_texts(
        "build of the 200 boxes of a stadium, SurfaceArea, leaf_size 4",
        format!("expected cost {yours:.3} per ray"),
        format!("at most {most:.3} (object median: {median:.3})"),
        "the cheapest cut at every node",
    )
    .explained_by([
        (is_a_median, "your tree costs as much as one by object median"),
        (yours.is_finite() && !divides_few(&bvh), CHEAPER),
    ]))
}

/// Whether two leaves of four primitives or fewer together have the same parent.
fn divides_few(bvh: &Bvh) -> bool {
    let count = |node: u32| match bvh.nodes[node as usize].contents {
        Contents::Leaf { count, .. } => count,
        Contents::Inner { .. } => 5,
    };
    let is_few = |node: &Node| matches!(node.contents, Contents::Inner { left, right } if count(left) + count(right) <= 4);
    bvh.nodes.iter().any(is_few)
}

/// The number of nodes and primitives that the rays through the stadium have to visit in this tree.
pub(super) fn counted_cost(bvh: &Bvh, spheres: &[Sphere]) -> u64 {
    let cost = |ray: &Ray| {
        let (nodes, primitives) = tree::needed(&tree::search_query(bvh, spheres, ray));
        nodes.len() as u64 + primitives
    };
    stadium_rays().iter().map(cost).sum()
}

pub(super) fn each_split_strategy_is_worth_its_cost(trial: &Trial<'_>) -> CheckResult {
    let spheres = stadium();
    let bounds: Vec<Aabb> = spheres.iter().map(tree::sphere_box).collect();
    for split in Split::ALL {
        let query = BuildQuery { bounds: bounds.clone(), split, leaf_size: 4 };
        let bvh = trial.kit.build(std::slice::from_ref(&query)).remove(0);
        // A tree that leaves out primitives costs less.
        if let Some((yours, expected)) = tree::fault(&bvh, &bounds, query.leaf_size) {
            let input = format!("build of the 200 boxes of a stadium, {split:?}, leaf_size 4");
            return Err(Broken::with_texts(input, yours, expected, "the invariants of a hierarchy"));
        }
        let yours = counted_cost(&bvh, &spheres);
        // The cost changes by a tenth with the axis of a nearly cubic box and with the side that gets one more.
        let most = counted(split) * 5 / 4;
        if yours > most {
            let describe = |n: u64| format!("{n} nodes opened and primitives tested");
            let input = format!("180 rays through a stadium of 200 spheres, tree by {split:?}, leaf_size 4");
            let (yours, expected) = (describe(yours), format!("at most {}", describe(most)));
            let broken = Broken::with_texts(input, yours, expected, "the reference tree, plus a quarter");
            let is_padded = bvh.nodes[0].bounds != tree::around(&bounds);
            return Err(broken
                .explained_by([(is_padded, "the boxes of the tree are larger than what is below them")]));
        }
    }
    Ok(())
}

/// A row of 64 spheres along the ray. The first one is hit, and of each pair of nodes the farther one lies behind it.
fn nothing_behind_in_a_row(trial: &Trial<'_>) -> CheckResult {
    let spheres: Vec<Sphere> =
        (0..64).map(|i| Sphere { center: vec3(4.0 * i as f32, 0.0, 0.0), radius: 1.0 }).collect();
    let bvh = tree::joined(&spheres.iter().map(tree::sphere_box).collect::<Vec<_>>(), 1);
    let query = tree::search_query(&bvh, &spheres, &Ray::new(vec3(-9.0, 0.0, 0.0), Vec3::X));
    let needed = tree::needed(&query).0.len() as u64;
    let answer = trial.kit.closest_hit(std::slice::from_ref(&query)).remove(0);
    let (yours, found) = (answer.counts.node_visits, answer.hit.map(|hit| (hit.primitive, hit.t)));
    let describe = |n: u64| format!("{n} nodes opened");
    let input = "a ray along a row of 64 spheres, of which it hits the first";
    // A search that finds nothing opens few nodes.
    let expected = tree::closest_in_table(&query);
    if found != expected {
        return Err(Broken::new(input, found, expected, "brute force, (primitive, t)"));
    }
    // No two boxes overlap, so there is only one order of search and only one right count.
    if yours <= needed {
        return Ok(());
    }
    let most = format!("at most {}", describe(needed));
    Err(Broken::with_texts(input, describe(yours), most, "counted")
        .explained_by(order_mistakes(std::slice::from_ref(&query), yours)))
}

pub(super) fn closest_hit_skips_what_lies_behind(trial: &Trial<'_>) -> CheckResult {
    nothing_behind_in_a_row(trial)?;
    let queries = stadium_searches();
    let yours = total(&trial.kit.closest_hit(&queries));
    // If a ray enters both children at the same t, either may come first. This changes the counts by less than a tenth.
    let (most_visits, most_tests) = (SEARCHED.0 * 11 / 10, SEARCHED.1 * 11 / 10);
    if yours.node_visits <= most_visits && yours.primitive_tests <= most_tests {
        return Ok(());
    }
    let mistakes = order_mistakes(&queries, yours.node_visits);
    let describe = |visits: u64, tests: u64| format!("{visits} nodes opened, {tests} primitives tested");
    let (yours, most) =
        (describe(yours.node_visits, yours.primitive_tests), describe(most_visits, most_tests));
    let (input, expected) = (format!("{} rays through a stadium", queries.len()), format!("at most {most}"));
    Err(Broken::with_texts(input, yours, expected, "the nearer child first").explained_by(mistakes))
}
