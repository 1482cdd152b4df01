//! The counted cost of a search: how many nodes, blocks and primitives it asks for.

use super::bars::calls_of_search;
use super::wide_tables::{Flaw, closest, flawed_search, n_calls};
use checks::double;
use checks::prelude::*;
use checks::tree::{around, sphere_box};
use oracle::splitmix::Random;
use raykata::wide::{BLOCK, Child, ChildContents, WideNode, WideTree};
use std::ops::Range;

/// A wide tree over a list of spheres, whose neighbours in the list are neighbours in the tree: leaves of eight, and up to
/// eight parts of equal size per node.
fn tree_over(spheres: &[Sphere]) -> WideTree {
    let mut tree = WideTree::default();
    add_node(spheres, 0..spheres.len(), &mut tree);
    tree
}

fn add_node(spheres: &[Sphere], range: Range<usize>, tree: &mut WideTree) -> u32 {
    let index = tree.nodes.len();
    tree.nodes.push(WideNode::EMPTY);
    let n_blocks = range.len().div_ceil(BLOCK);
    let n = n_blocks.min(8);
    for place in 0..n {
        let at = |place: usize| (range.start + BLOCK * (place * n_blocks / n)).min(range.end);
        let part = at(place)..at(place + 1);
        let bounds = around(&spheres[part.clone()].iter().map(sphere_box).collect::<Vec<_>>());
        let child = if part.len() <= BLOCK {
            let ids = std::array::from_fn(|lane| (part.start + lane).min(part.end - 1) as u32);
            tree.blocks.push(ids);
            Child::leaf(tree.blocks.len() as u32 - 1, part.len() as u32)
        } else {
            Child::inner(add_node(spheres, part, tree))
        };
        tree.nodes[index].set(place, &bounds, child);
    }
    index as u32
}

/// The search of `ray` in a tree over spheres, with the table of all answers in double precision.
pub(super) fn search(tree: &WideTree, spheres: &[Sphere], ray: &Ray) -> WideQuery {
    let t = |sphere: &Sphere| match double::sphere(ray, sphere) {
        double::Expected::Hit { t, .. } => t as f32,
        _ => f32::INFINITY,
    };
    let entry = |bounds: &Aabb| {
        let (near, far) = double::box_interval(ray, bounds);
        if near <= far && far >= 0.0 { (near as f32).next_down().max(0.0) } else { f32::INFINITY }
    };
    let entries = |node: &WideNode| {
        std::array::from_fn(|place| {
            if node.children[place] != Child::EMPTY {
                entry(&node.child_bounds(place))
            } else {
                f32::INFINITY
            }
        })
    };
    WideQuery {
        tree: tree.clone(),
        ray: *ray,
        entries: tree.nodes.iter().map(entries).collect(),
        hits: spheres.iter().map(t).collect(),
    }
}

/// A cloud of 600 spheres, and a tree over it. The spheres are listed along a curve of Morton, so that neighbours are close.
fn cloud(random: &mut Random) -> (WideTree, Vec<Sphere>) {
    let mut spheres: Vec<Sphere> =
        (0..600).map(|_| Sphere { center: random.in_cube(), radius: 0.08 + 0.12 * random.unit() }).collect();
    let code = |sphere: &Sphere| -> u32 {
        let cell = ((sphere.center + 1.0) * 8.0).as_uvec3();
        (0..4).map(|bit| (0..3).map(|axis| (cell[axis] >> bit & 1) << (3 * bit + axis)).sum::<u32>()).sum()
    };
    spheres.sort_by_key(code);
    (tree_over(&spheres), spheres)
}

/// Rays through a cloud of 600 spheres.
pub fn rays_through_a_cloud() -> Vec<WideQuery> {
    let mut random = Random::new(12, 2);
    let (tree, spheres) = cloud(&mut random);
    let ray = |_| {
        let origin = 2.0 * random.direction();
        search(&tree, &spheres, &Ray::new(origin, (0.8 * random.in_cube() - origin).normalize()))
    };
    (0..150).map(ray).collect()
}

/// A row of 64 spheres along the ray, which hits the first one. No two boxes overlap.
fn row() -> WideQuery {
    let spheres: Vec<Sphere> =
        (0..64).map(|i| Sphere { center: vec3(4.0 * i as f32, 0.0, 0.0), radius: 1.0 }).collect();
    search(&tree_over(&spheres), &spheres, &Ray::new(vec3(-9.0, 0.0, 0.0), Vec3::X))
}

/// The nodes whose boxes the ray enters before its closest hit, the root included: what every search must visit.
fn needed(query: &WideQuery) -> usize {
    let end = closest(query).map_or(query.ray.t_max, |(_, t)| t);
    let inner = |(child, t): (&Child, f32)| {
        t <= end && matches!(child.contents(), ChildContents::Inner(_)) && *child != Child::EMPTY
    };
    let below = |(node, entries): (&WideNode, &[f32; 8])| {
        node.children.iter().zip(*entries).filter(|pair| inner(*pair)).count()
    };
    1 + query.tree.nodes.iter().zip(&query.entries).map(below).sum::<usize>()
}

/// The known mistakes that make exactly so many calls.
fn mistakes(queries: &[WideQuery], n: usize) -> Vec<(bool, &'static str)> {
    let calls = |flaw: Flaw, is_sorted| -> usize {
        queries.iter().map(|query| flawed_search(query, flaw, is_sorted).1).sum()
    };
    let by = |flaw: Flaw| [true, false].map(|is_sorted| calls(flaw, is_sorted)).contains(&n);
    COSTLY.map(|(flaw, text)| (by(flaw), text)).to_vec()
}

const COSTLY: [(Flaw, &str); 6] = named![
    Flaw::Unsorted => "the children are visited in the order of their places: visit the nearest first",
    Flaw::FarthestFirst => "the farthest child is visited first: put the nearest on top of the stack",
    Flaw::NothingSkipped => "a child beyond the best hit is visited: compare its entry again when it comes from the stack",
    Flaw::NotShortened => "the ray is not shortened, so nothing is skipped: after a hit it ends there",
    Flaw::EveryLane => "each lane of a block is tested exactly: only those of the mask of `candidates` may be hit",
    Flaw::Everything =>
        "each lane of a block is tested exactly, and children beyond the best hit are visited: use the masks, and compare again",
];

/// Judges the hits of searches, so that no search is cheap because it finds nothing.
fn judge_hits(queries: &[WideQuery], answers: &[WideAnswer], what: &str) -> CheckResult {
    for (query, answer) in queries.iter().zip(answers) {
        let (found, expected) = (answer.hit.map(|hit| (hit.primitive, hit.t)), closest(query));
        if found != expected {
            return Err(Broken::new(what, found, expected, "brute force, (primitive, t)"));
        }
    }
    Ok(())
}

pub(super) fn wide_closest_hit_skips_what_lies_behind(trial: &Trial<'_>) -> CheckResult {
    let queries = [row()];
    let answers = trial.kit.wide_closest_hit(&queries);
    let what = "a ray along a row of 64 spheres, of which it hits the first";
    judge_hits(&queries, &answers, what)?;
    let (yours, most) = (answers[0].nodes.len(), needed(&queries[0]));
    if yours <= most && answers[0].blocks.len() == 1 {
        return Ok(());
    }
    let of = |nodes: usize, blocks: usize| format!("{nodes} nodes and {blocks} blocks");
    let (yours, expected) = (of(yours, answers[0].blocks.len()), format!("at most {}", of(most, 1)));
    Err(Broken::with_texts(what, yours, expected, "counted")
        .explained_by(mistakes(&queries, n_calls(&answers[0]))))
}

/// Judges the number of calls: at most `percent` of those of the reference.
pub(super) fn judge_calls(trial: &Trial<'_>, percent: usize) -> CheckResult {
    let queries = rays_through_a_cloud();
    let answers = trial.kit.wide_closest_hit(&queries);
    let what = format!("{} rays through a cloud of 600 spheres", queries.len());
    judge_hits(&queries, &answers, &what)?;
    let yours: usize = answers.iter().map(n_calls).sum();
    let most = calls_of_search() * percent / 100;
    if yours <= most {
        return Ok(());
    }
    let of = |n: usize| format!("{n} calls of `enter`, `candidates` and `hit`");
    let expected = format!("at most {}, {percent} % of the reference", of(most));
    Err(Broken::with_texts(what, of(yours), expected, "counted").explained_by(mistakes(&queries, yours)))
}
