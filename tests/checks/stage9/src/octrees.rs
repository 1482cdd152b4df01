//! The laws of the octree: which primitives each leaf lists, and three searches.

use super::lists::{
    Fault, below, ended, fact, infinite, judge_references, judge_tree, leaves, listing_fault, some_boxes,
    too_deep,
};
use super::parts;
use super::scenes::{Scene, Thing, along, lattice, straight};
use super::searches::{
    Described, OCTREE, OCTREE_BY_CELLS, OCTREE_BY_NEIGHBOURS, Search, Searched, queries, spheres_and_rays,
};
use super::structures::octree;
use checks::prelude::*;
use raykata::partition::{MOST_REFERENCES, Octree, OctreeNode, TreeNode};

fn describe(query: &OctreeQuery) -> String {
    let OctreeQuery { bounds, leaf_size, max_depth } = query;
    format!("build over {} boxes, leaf_size {leaf_size}, max_depth {max_depth}", bounds.len())
}

const WHAT_MAKES_IT: &str = "the definition of an octree";

fn judge_octree(query: &OctreeQuery, yours: &Octree) -> CheckResult {
    let nothing = query.bounds.iter().all(Aabb::is_empty);
    judge_tree(|| describe(query), WHAT_MAKES_IT, (nothing, yours.nodes.len()), || fault(query, yours))
}

fn fault(query: &OctreeQuery, yours: &Octree) -> Option<Fault> {
    let levels = yours.walk(64, |_, _, _| {});
    if let Some(fault) = too_deep(levels, query.max_depth, "the tree is deeper than max_depth") {
        return Some(fault);
    }
    let sides = yours.bounds.max - yours.bounds.min;
    // Rounding changes a side by far less than a hundredth.
    if sides.min_element() < 0.99 * sides.max_element() {
        let yours = format!("bounds with the sides {sides}");
        return Some(fact(yours, "a cube".into(), "the root cell must be a cube"));
    }
    listing_fault("leaf", &yours.bounds, &query.bounds, &leaves(yours))
}

pub(super) fn octree_lists_what_reaches_into_leaves(trial: &Trial<'_>) -> CheckResult {
    let inputs = (some_boxes(), 1..=4usize, 0..=4usize)
        .prop_map(|(bounds, leaf_size, max_depth)| OctreeQuery { bounds, leaf_size, max_depth });
    trial.each(140, inputs, <dyn Kit>::octree_build, |query, yours| judge_octree(query, &yours))
}

pub(super) fn octree_divides_where_there_is_much(trial: &Trial<'_>) -> CheckResult {
    // Two boxes in opposite corners are apart at depth 1.
    let apart = vec![Aabb::new(Vec3::ZERO, Vec3::ONE), Aabb::new(Vec3::splat(9.0), Vec3::splat(10.0))];
    let of_depth = |max_depth| OctreeQuery { bounds: apart.clone(), leaf_size: 1, max_depth };
    let [two, one] = [2, 1].map(|depth| trial.kit.octree_build(&[of_depth(depth)]).remove(0).nodes.len());
    if one == 1 {
        let says = "your tree ends one level above max_depth: the root is at depth 0";
        let input = "build of two boxes in opposite corners, leaf_size 1, max_depth 1";
        return Err(
            Broken::with_texts(input, "a leaf", "eight octants", "counted").explained_by([(two > 1, says)])
        );
    }
    // Eight boxes across the middle are in all octants: 66 of ten together.
    let across = (0..8).map(|i| Aabb::new(Vec3::splat(4.0 - i as f32 / 16.0), Vec3::splat(6.0)));
    let bounds: Vec<Aabb> = apart.iter().copied().chain(across).collect();
    let n =
        trial.kit.octree_build(&[OctreeQuery { bounds, leaf_size: 2, max_depth: 8 }]).remove(0).nodes.len();
    if n > 1 {
        let says = "you divide a cell whose octants together hold more than three times as many primitives";
        let input =
            "build of two boxes in opposite corners and eight across the middle, leaf_size 2, max_depth 8";
        return Err(Broken::with_texts(
            input,
            format!("{n} nodes"),
            "a leaf: octants would hold 66 of 10",
            "counted",
        )
        .because(says));
    }
    // 64 small boxes, one per cell of the third level, and 8 more in one of these cells.
    let at = |i: usize| vec3((i % 4) as f32, (i / 4 % 4) as f32, (i / 16) as f32) * 2.0;
    let even = (0..64).map(|i| Aabb::new(at(i), at(i) + 0.5));
    let dense =
        (0..8).map(|i| Aabb::new(Vec3::splat(6.0) + 0.125 * at(i), Vec3::splat(6.02) + 0.125 * at(i)));
    // A second box in another cell, which then holds exactly leaf_size boxes.
    let pair = [Aabb::new(at(5) + 0.125, at(5) + 0.25)];
    let bounds: Vec<Aabb> = even.chain(dense).chain(pair).collect();
    // Hidden inputs have another order and size. Reversed axes would move the cube of the root relative to the boxes.
    let hidden = (Just(bounds.clone()).prop_shuffle(), nasty::scale(-16..=16)).prop_map(|(bounds, scale)| {
        bounds.into_iter().map(|one| Aabb::new(scale * one.min, scale * one.max)).collect()
    });
    let bounds = trial.varied(bounds, hidden);
    let query = OctreeQuery { bounds, leaf_size: 2, max_depth: 8 };
    let yours = trial.kit.octree_build(std::slice::from_ref(&query)).remove(0);
    judge_octree(&query, &yours)?;
    let leaves = yours.nodes.iter().filter(|node| node.is_leaf()).filter_map(OctreeNode::range);
    let most = leaves.map(|(_, count)| count).max().unwrap_or(0);
    let (depth, n) = (yours.depth(), yours.nodes.len());
    let needless =
        (0..n as u32).find(|&node| !yours.nodes[node as usize].is_leaf() && below(&yours, node).len() <= 2);
    if most <= 2 && depth > 3 && needless.is_none() {
        return Ok(());
    }
    let mistakes = [
        (needless.is_some(), "you divide cells that hold leaf_size or fewer primitives"),
        (most > 2, "you do not divide all cells with more than leaf_size primitives"),
    ];
    let yours = format!("up to {most} primitives per leaf, {depth} levels, {n} nodes");
    let expected =
        "at most 2 per leaf, more levels where boxes are dense, and no division of cells with 2 or fewer";
    let input = "build of 64 boxes in 4 × 4 × 4, and 8 more in one corner, leaf_size 2, max_depth 8";
    Err(Broken::with_texts(input, yours, expected, "counted").explained_by(mistakes))
}

pub(super) fn octree_build_ends(trial: &Trial<'_>) -> CheckResult {
    for (name, bounds) in infinite(trial.about(1000)) {
        let n = bounds.len();
        let query = OctreeQuery { bounds, leaf_size: 1, max_depth: 12 };
        let input = format!("build of {name}, leaf_size 1, max_depth 12");
        let too_deep = "stop at max_depth, and where dividing does not help";
        let too_many =
            "you divide primitives that are in most octants: make a leaf if dividing does not help";
        let build = || trial.kit.octree_build(std::slice::from_ref(&query)).remove(0);
        let yours = ended(&input, WHAT_MAKES_IT, [too_deep, too_many], build)?;
        judge_octree(&query, &yours)?;
        judge_references(&input, &yours.items, MOST_REFERENCES * n, too_many)?;
    }
    Ok(())
}

/// Rays along the edges and through the corners at which octants meet, with zeros of both signs in their directions.
pub(super) fn along_edges(trial: &Trial<'_>, search: &Search<Octree>) -> CheckResult {
    let mut things = lattice(4.0);
    // Leave out the sphere in the middle, where octants meet.
    things.remove(13);
    let scene = Scene::new(things);
    let rays: Vec<Ray> = straight()
        .flat_map(|direction| {
            let through = |at: f32| Ray::new(Vec3::splat(at) - 12.0 * direction, direction);
            [through(0.0), through(2.0), through(4.0), Ray::new(Vec3::splat(4.0), direction)]
        })
        .collect();
    let name = "26 spheres, rays along axes and diagonals".to_owned();
    let judge = || search.judge(trial.kit, &[Searched::new(&name, &scene, &rays)]);
    match kit_error::catch(judge) {
        Ok(outcomes) => all_hold(outcomes),
        Err(kit_error::KitError::Panicked { message, .. }) => {
            let endless = message.contains("does not end");
            let input = search.over(&name);
            Err(Broken::with_texts(input, message, "an answer", "brute force")
                .explained_by(["your search goes on without an end: a step leads back into the cell that the ray has left, or stays in it"
                    .when(endless)]))
        }
        Err(error) => kit_error::unwind(error),
    }
}

/// A large sphere that overlaps the first octant is hit in the second, behind a small one.
pub(super) fn octree_hit_beyond_its_octant_waits(trial: &Trial<'_>) -> CheckResult {
    overlapping_two_octants("from the root down").judge(trial.kit, &OCTREE)?;
    overlapping_two_octants("cell by cell").judge(trial.kit, &OCTREE_BY_CELLS)?;
    overlapping_two_octants("by neighbours").judge(trial.kit, &OCTREE_BY_NEIGHBOURS)
}

/// A large sphere and a small one along each axis, in both directions, for the search of this name.
fn overlapping_two_octants(name: &str) -> Described<Octree> {
    let mut asked = Described::new();
    for axis in 0..3 {
        for flipped in [false, true] {
            let turn = |v: Vec3| along(axis, if flipped { vec3(8.0 - v.x, v.y, v.z) } else { v });
            let place = |center: Vec3, radius: f32| Thing::Sphere(Sphere { center: turn(center), radius });
            let scene = Scene::new(vec![place(vec3(7.0, 4.0, 1.0), 3.75), place(vec3(4.5, 1.0, 1.0), 0.25)]);
            let (from, to) = (turn(vec3(-1.0, 1.0, 1.0)), turn(vec3(0.0, 1.0, 1.0)));
            let ray = Ray::new(from, to - from);
            let mut cells = Octree::new(Aabb::new(Vec3::ZERO, Vec3::splat(8.0)));
            let first = cells.divide(0, 1, 1);
            let octant = 1 << axis;
            let (near, far) = if flipped { (first + octant, first) } else { (first, first + octant) };
            cells.set_leaf(near, &[0]);
            cells.set_leaf(far, &[0, 1]);
            let what = format!("octree, {name}; primitive 0 overlaps two octants");
            asked.ask(what, &cells, &scene, ray);
            let mut control = Octree::new(cells.bounds);
            control.divide(0, 1, 1);
            control.set_leaf(near, &[0, 1, 2]);
            asked.control(&format!("octree, {name}"), control, ray, (1.0, 5.0));
        }
    }
    asked
}

fn octree_over_spheres() -> Vec<CellsQuery<Octree>> {
    let (scene, rays) = spheres_and_rays(128, 9, (8, 1.0));
    queries(&octree(&scene.boxes(), 4), &scene, &rays)
}

/// The visits to leaves that the ray enters.
fn to_leaves(query: &CellsQuery<Octree>, visits: &[u32]) -> Vec<u32> {
    let parts = parts::of_cells(&query.cells, &query.ray);
    let is_entered = |node: u32| parts.iter().any(|(entered, ..)| *entered == node);
    let is_leaf = |node: u32| is_entered(node) && query.cells.nodes[node as usize].is_leaf();
    visits.iter().copied().filter(|&node| is_leaf(node)).collect()
}

pub(super) fn octree_visits_what_the_ray_enters_before_its_hit(trial: &Trial<'_>) -> CheckResult {
    let queries = octree_over_spheres();
    OCTREE.visits(trial.kit, "octree over 128 spheres, from the root down", &queries)?;
    OCTREE_BY_CELLS.all_visits(trial.kit, &queries, |query, yours| {
        // Judge the visits to leaves only: each way down to a leaf visits the nodes above it again.
        let visits = to_leaves(query, &yours.visits);
        let what = "octree over 128 spheres, cell by cell";
        let n_ways = yours.visits.iter().filter(|visit| **visit == 0).count();
        if n_ways < visits.len() {
            let broken = Broken::new(what, n_ways, visits.len(), "one visit of the root per leaf");
            return Err(broken.because("the way down to a leaf begins at the root: visit every node on it"));
        }
        OCTREE_BY_CELLS.judge_visits(what, query, &CellsAnswer { visits, ..yours })
    })
}

pub(super) fn octree_by_neighbours_visits_no_node_again(trial: &Trial<'_>) -> CheckResult {
    // Rays that end halfway to their hits visit what they reach.
    let short = octree_over_spheres().into_iter().map(|query| {
        let t = checks::tree::closest_of(&query.hits, &query.ray).map_or(f32::INFINITY, |(_, t)| t);
        CellsQuery { ray: query.ray.with_range(0.0, 0.5 * t), ..query }
    });
    OCTREE_BY_NEIGHBOURS.all_visits(trial.kit, &short.collect::<Vec<_>>(), |query, yours| {
        let parts = parts::of_cells(&query.cells, &query.ray);
        let beyond =
            yours.visits.iter().filter(|visit| parts.iter().all(|(node, ..)| node != *visit)).count();
        let input = format!("octree over 128 spheres, by neighbours\n{}", query.ray.paste());
        let broken = || {
            Broken::with_texts(input, format!("{beyond} visits"), "none", "nodes that the ray does not enter")
        };
        if beyond == 0 {
            Ok(())
        } else {
            Err(broken().because("the search goes on behind the end of the ray"))
        }
    })?;
    OCTREE_BY_NEIGHBOURS.all_visits(trial.kit, &octree_over_spheres(), |query, yours| {
        // A search that returns to the root visits the root once per leaf.
        let returns = yours.visits.iter().filter(|visit| **visit == 0).count();
        let mistake = (
            returns > 1 && returns >= to_leaves(query, &yours.visits).len(),
            "you go back to the root for each leaf: go up only to the smallest cell that contains the next leaf, too",
        );
        let outcome =
            OCTREE_BY_NEIGHBOURS.judge_visits("octree over 128 spheres, by neighbours", query, &yours);
        outcome.map_err(|broken| broken.explained_by([mistake]))
    })
}
