//! The laws of the kd-tree: which primitives each leaf lists, and the search.

use super::lists::{Fault, ended, infinite, judge_references, lists_fault, some_boxes};
use super::parts;
use super::scenes::{Scene, Thing, closest, sphere, wall};
use super::searches::{Searcher, agrees, judge, judge_visits, queries, spheres_and_rays};
use super::structures::kd_tree;
use checks::Trial;
use checks::broken::CheckResult;
use checks::judge::compare;
use glam::{Vec3, uvec3, vec3};
use proptest::prelude::*;
use raykata::aabb::Aabb;
use raykata::kit::{CellsQuery, KdQuery};
use raykata::partition::{Grid, KdHeuristics, KdNode, KdTree, MOST_REFERENCES};
use raykata::ray::Ray;
use raykata::shape::Sphere;

fn describe(query: &KdQuery) -> String {
    let boxes = checks::paste::list(&query.bounds);
    format!("build(&{boxes},\n&{:?}, {})", query.heuristics, query.leaf_size)
}

const WHAT_MAKES_IT: &str = "the definition of a kd-tree";

fn judge_tree(query: &KdQuery, yours: &KdTree) -> CheckResult {
    let nothing = query.bounds.iter().all(Aabb::is_empty);
    super::lists::judge_tree(
        || describe(query),
        WHAT_MAKES_IT,
        (nothing, yours.nodes.len()),
        || fault(query, yours),
    )
}

fn fault(query: &KdQuery, yours: &KdTree) -> Option<Fault> {
    let mut leaves = Vec::new();
    let mut outside = None;
    yours.walk(64, |node, cell, _| match yours.nodes[node as usize] {
        KdNode::Leaf { first, count } => leaves.push((node, cell, yours.primitives(first, count).to_vec())),
        KdNode::Inner { axis, at, .. } => {
            let (axis, at) = (usize::from(axis), f64::from(at));
            if !(cell.min[axis] <= at && at <= cell.max[axis]) {
                outside =
                    Some((format!("node {node} is cut at {at}"), format!("within {:?}", cell.to_box())));
            }
        }
    });
    let most = KdTree::most_depth(query.bounds.iter().filter(|one| !one.is_empty()).count());
    if yours.depth() > most + 1 {
        let yours = format!("a node at depth {}", yours.depth() - 1);
        return Some((yours, format!("at most {most}"), "the tree is deeper than KdTree::most_depth"));
    }
    if let Some((yours, expected)) = outside {
        return Some((yours, expected, "you cut at a plane outside the cell"));
    }
    lists_fault(&yours.bounds, &query.bounds, &leaves)
}

/// Any of the 32 sets of heuristics.
fn heuristics() -> impl Strategy<Value = KdHeuristics> + Clone {
    (0..32u8).prop_map(|bits| KdHeuristics {
        longest_axis: bits & 1 != 0,
        balanced_counts: bits & 2 != 0,
        few_straddlers: bits & 4 != 0,
        cut_off_empty_space: bits & 8 != 0,
        stop_at_overlap: bits & 16 != 0,
    })
}

pub(super) fn kd_tree_lists_what_reaches_into_leaves(trial: &Trial<'_>) -> CheckResult {
    let inputs = (some_boxes(), heuristics(), 1..=4usize)
        .prop_map(|(bounds, heuristics, leaf_size)| KdQuery { bounds, heuristics, leaf_size });
    trial.forall(300, inputs, |queries| {
        compare(queries, trial.kit.kd_build(queries), |query, yours| judge_tree(query, &yours))
    })
}

pub(super) fn kd_tree_build_ends(trial: &Trial<'_>) -> CheckResult {
    for (name, bounds) in infinite() {
        for heuristics in [KdHeuristics::default(), KdHeuristics::NONE] {
            let query = KdQuery { bounds: bounds.clone(), heuristics, leaf_size: 1 };
            let input = format!("build of {name}, {heuristics:?}, leaf_size 1");
            let too_deep = "stop at KdTree::most_depth, and where all primitives are on both sides";
            let too_many = "you divide primitives that are nearly all on both sides: make a leaf of them";
            let build = || trial.kit.kd_build(std::slice::from_ref(&query)).remove(0);
            let yours = ended(&input, WHAT_MAKES_IT, [too_deep, too_many], build)?;
            judge_tree(&query, &yours)?;
            judge_references(&input, &yours.items, MOST_REFERENCES * bounds.len(), too_many)?;
        }
    }
    Ok(())
}

pub(super) fn kd_search_agrees_with_brute_force(trial: &Trial<'_>) -> CheckResult {
    agrees(trial, Searcher::KdTree)
}

/// A tree of one cut across x, with these primitives on the two sides.
fn two_leaves(bounds: Aabb, at: f32, left: &[u32], right: &[u32]) -> KdTree {
    let mut tree = KdTree::new(bounds);
    let root = tree.add_node(0, 1);
    let [below, above] = [tree.add_node(1, 1), tree.add_node(1, 1)];
    tree.set_leaf(below, left);
    tree.set_leaf(above, right);
    tree.set_children(root, 0, at, below, above);
    tree
}

fn ask(trial: &Trial<'_>, cells: &KdTree, scene: &Scene, ray: &Ray, what: &str, says: &str) -> CheckResult {
    let hits = scene.hits(ray);
    let query = CellsQuery { cells: cells.clone(), ray: *ray, hits: hits.clone() };
    let yours = trial.kit.kd_search(&[query]).remove(0);
    judge(what, ray, &hits, &yours).map_err(|broken| broken.looks_like(Some(says)))
}

/// Traps A4 and A6: the hit lies on the face at which its cell ends, and `t` and `t'` are rounded differently.
pub(super) fn kd_finds_a_wall_on_the_face_of_the_box(trial: &Trial<'_>) -> CheckResult {
    let says = "traps A4 and A6: `hit.distance < t'` loses a hit on the far face, and the two t are rounded differently; keep the best hit, wherever its cell ends";
    for (size, rough) in [(1.0, false), (1.0, true), (100.0, true), (1e5, true)] {
        let walls = [wall(0, size, size), wall(0, 0.0, size)];
        let scene = Scene { things: walls.into_iter().flatten().collect(), rough };
        let bounds = Aabb::new(Vec3::splat(-size), Vec3::splat(size));
        let whole = two_leaves(bounds, 0.0, &[2, 3], &[0, 1, 2, 3]);
        for i in 0..12 {
            let y = (i as f32 - 5.5) * 0.07;
            // Aim at the far wall, and at the wall in the plane of the cut, which is listed on both sides.
            let right = Ray::new(size * vec3(0.2, y, 0.3 * y), vec3(1.0, 0.2 * y, 0.1).normalize());
            let through = Ray::new(size * vec3(-0.7, y, 0.3 * y), vec3(1.0, 0.2 * y, 0.1).normalize());
            for ray in [right, through] {
                ask(
                    trial,
                    &whole,
                    &scene,
                    &ray,
                    &format!("kd-tree of two leaves with walls on faces, size {size}"),
                    says,
                )?;
            }
        }
    }
    Ok(())
}

/// Trap A6 alone: two primitives lie in one face; that of the right cell has a `t` one float smaller than that of the
/// left.
pub(super) fn hits_at_a_face_are_compared_with_each_other(trial: &Trial<'_>) -> CheckResult {
    let says = "trap A6: t of a hit and t of a cell are rounded differently; stop only if the hit is before the cell by more than the rounding error";
    for (at, x) in [(1.0f32, -2.0f32), (0.75, -5.3), (-3.125, -7.7)] {
        let bounds = Aabb::new(Vec3::splat(-8.0), Vec3::splat(2.0 * at + 8.0));
        let exact = at - x;
        let hits = vec![exact.next_down(), exact.next_down().next_down()];
        let ray = Ray::new(vec3(x, 0.0, 0.0), Vec3::X);
        let tree = CellsQuery { cells: two_leaves(bounds, at, &[0], &[1]), ray, hits: hits.clone() };
        let grid = Grid { bounds, resolution: uvec3(2, 1, 1), starts: vec![0, 1, 2], items: vec![0, 1] };
        let grid = CellsQuery { cells: grid, ray, hits: hits.clone() };
        for (name, yours) in
            [("kd-tree", trial.kit.kd_search(&[tree])), ("grid", trial.kit.grid_search(&[grid]))]
        {
            let what = format!("{name} of two cells, a primitive of each in the face between them");
            judge(&what, &ray, &hits, &yours[0]).map_err(|broken| broken.looks_like(Some(says)))?;
        }
    }
    Ok(())
}

pub(super) fn kd_hit_beyond_its_leaf_waits(trial: &Trial<'_>) -> CheckResult {
    let large = Thing::Sphere(Sphere { center: vec3(5.0, 2.0, 0.0), radius: 2.25 });
    let scene = Scene::new(vec![large, sphere(3.5, 0.0, 0.0, 0.25)]);
    let bounds = Aabb::new(vec3(0.0, -4.0, -4.0), vec3(8.0, 5.0, 4.0));
    let tree = two_leaves(bounds, 2.0, &[0], &[0, 1]);
    let says = "the first hit lies beyond its leaf, and the next leaf has a nearer one: `Some hit → Some hit` stops too early";
    ask(
        trial,
        &tree,
        &scene,
        &Ray::new(vec3(-1.0, 0.0, 0.0), Vec3::X),
        "kd-tree; primitive 0 overlaps both leaves",
        says,
    )?;
    // Without the small sphere, the hit counts although it lies beyond the first leaf and the second does not list it.
    let tree = two_leaves(bounds, 2.0, &[0], &[]);
    let alone = Scene::new(vec![large]);
    let says = "the only hit lies beyond its leaf: a hit counts wherever its leaf ends";
    ask(
        trial,
        &tree,
        &alone,
        &Ray::new(vec3(-1.0, 0.0, 0.0), Vec3::X),
        "kd-tree; primitive 0 is listed in the first leaf only",
        says,
    )
}

/// Trap A5: a ray in the plane of a cut, or that starts on it, is on both sides.
pub(super) fn kd_rays_in_the_plane_search_both_sides(trial: &Trial<'_>) -> CheckResult {
    let says = "trap A5: a ray in the plane, or that starts on it, is on both sides, and a primitive in the plane may be listed on one side only: search both";
    let bounds = Aabb::new(Vec3::splat(-8.0), Vec3::splat(8.0));
    for (left, right) in [(&[0u32, 1][..], &[2u32][..]), (&[2][..], &[0, 1][..]), (&[0][..], &[1, 2][..])] {
        let tree = two_leaves(bounds, 1.0, left, right);
        // Three spheres whose centres lie in the plane.
        let spheres = Scene::new(vec![
            sphere(1.0, 5.0, 0.0, 0.5),
            sphere(1.0, 0.0, 5.0, 0.5),
            sphere(1.0, -5.0, 0.0, 0.5),
        ]);
        for zero in [0.0, -0.0] {
            for (y, z) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0)] {
                let ray = Ray::new(vec3(1.0, 0.0, 0.0), vec3(zero, y, z));
                ask(
                    trial,
                    &tree,
                    &spheres,
                    &ray,
                    "kd-tree of two leaves, and a ray in the plane between them",
                    says,
                )?;
            }
        }
        // Rays from a point of the plane to spheres on each side.
        let beside = Scene::new(vec![
            sphere(-3.0, 0.5, 0.0, 0.5),
            sphere(-5.0, -0.5, 0.5, 1.0),
            sphere(5.0, 0.5, 0.0, 0.5),
        ]);
        let sides = two_leaves(bounds, 1.0, &[0, 1], &[2]);
        for direction in [vec3(-8.0, 1.0, 0.0), vec3(-8.0, -1.0, 0.5), vec3(8.0, 1.0, 0.0)] {
            ask(
                trial,
                &sides,
                &beside,
                &Ray::new(Vec3::X, direction),
                "kd-tree of two leaves, and a ray from the plane between them",
                says,
            )?;
        }
    }
    // A wall in the plane, listed on one side only, and rays at it from both sides, from far and near.
    let wall = Scene::new(wall(0, 1.0, 4.0).to_vec());
    for (left, right) in [(&[0u32, 1][..], &[][..]), (&[][..], &[0, 1][..])] {
        let tree = two_leaves(bounds, 1.0, left, right);
        for x in [-7.5, 0.3, 1.7, 7.5] {
            let ray = Ray::new(vec3(x, 0.3, 0.4), vec3(1.0 - x, 0.1, 0.2).normalize());
            ask(
                trial,
                &tree,
                &wall,
                &ray,
                "kd-tree of two leaves, and a wall in the plane, listed on one side",
                says,
            )?;
        }
    }
    Ok(())
}

pub(super) fn kd_search_visits_what_the_ray_enters_before_its_hit(trial: &Trial<'_>) -> CheckResult {
    let place = |i: usize| vec3((i % 16) as f32, (i / 16 % 4) as f32, (i / 64) as f32 * 1.5);
    let (scene, rays) = spheres_and_rays(&(0..128).map(place).collect::<Vec<Vec3>>(), 9, 20.0);
    let cells = kd_tree(&scene.boxes(), 10);
    let queries = queries(&cells, &scene, &rays);
    for (query, yours) in queries.iter().zip(trial.kit.kd_search(&queries)) {
        assert!(closest(&query.hits, &query.ray).is_some(), "each ray is aimed at a sphere");
        judge_visits(
            "kd-tree over 128 spheres",
            &query.ray,
            &parts::of_kd_tree(&cells, &query.ray),
            &yours,
            true,
        )?;
    }
    Ok(())
}
