//! The laws of the kd-tree: which primitives each leaf lists, and the search.

use super::lists::{
    Fault, below, ended, fact, infinite, judge_references, leaves, listing_fault, some_boxes, too_deep,
};
use super::scenes::{Scene, Thing, along, wall};
use super::searches::{Described, GRID, KD_TREE, OCTREE, queries, spheres_and_rays};
use super::structures::{filled, kd_tree};
use checks::prelude::*;
use glam::UVec3;
use raykata::partition::{KdHeuristics, KdNode, KdTree, MOST_REFERENCES, Octree};

fn describe(query: &KdQuery) -> String {
    format!("build over {} boxes, leaf_size {}, {:?}", query.bounds.len(), query.leaf_size, query.heuristics)
}

const WHAT_MAKES_IT: &str = "the definition of a kd-tree";

fn judge_tree(query: &KdQuery, yours: &KdTree) -> CheckResult {
    let nothing = query.bounds.iter().all(Aabb::is_empty);
    let mut exchanged = yours.clone();
    for node in &mut exchanged.nodes {
        if let KdNode::Inner { left, right, .. } = node {
            std::mem::swap(left, right);
        }
    }
    let is_exchanged = |(yours, expected, mistakes): Fault| match fault(query, &exchanged) {
        None => fact(yours, expected, "the children are exchanged: the left one has the smaller coordinates"),
        Some(_) => (yours, expected, mistakes),
    };
    let faults = || fault(query, yours).map(is_exchanged);
    super::lists::judge_tree(|| describe(query), WHAT_MAKES_IT, (nothing, yours.nodes.len()), faults)
}

fn fault(query: &KdQuery, yours: &KdTree) -> Option<Fault> {
    let mut outside = None;
    yours.walk(64, |node, cell, _| {
        if let KdNode::Inner { axis, at, .. } = yours.nodes[node as usize] {
            let (axis, at) = (usize::from(axis), f64::from(at));
            if !(cell.min[axis] <= at && at <= cell.max[axis]) {
                outside =
                    Some((format!("node {node} is cut at {at}"), format!("within {:?}", cell.to_box())));
            }
        }
    });
    let most = KdTree::most_depth(query.bounds.iter().filter(|one| !one.is_empty()).count());
    if let Some(fault) = too_deep(yours.depth(), most, "the tree is deeper than KdTree::most_depth") {
        return Some(fault);
    }
    if let Some((yours, expected)) = outside {
        return Some(fact(yours, expected, "you cut at a plane outside the cell"));
    }
    if let Some(node) = (0..yours.nodes.len() as u32).find(|&node| divides_nothing(yours, node)) {
        let described = format!("node {node} is divided, and all its primitives are on both sides");
        let mistake = "you divide primitives that are all on both sides: make a leaf of them";
        return Some(fact(described, "a leaf".into(), mistake));
    }
    listing_fault("leaf", &yours.bounds, &query.bounds, &leaves(yours))
}

/// Whether all primitives of an inner node are on both sides of its plane.
fn divides_nothing(tree: &KdTree, node: u32) -> bool {
    let KdNode::Inner { left, right, .. } = tree.nodes[node as usize] else { return false };
    let [left, right] = [left, right].map(|side| below(tree, side));
    !left.is_empty() && left == right
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
    // Planes at the ends of long boxes, which reach beyond the cells of short ones.
    let bounds = [
        (vec3(4.0, -2.0, 0.0), vec3(6.0, -2.0, 2.0)),
        (vec3(3.0, -2.0, 0.0), vec3(4.5, -2.0, 0.0)),
        (vec3(3.0, 3.0, 0.0), vec3(3.0, 3.0, 0.0)),
        (vec3(3.0, 0.0, 0.0), vec3(3.0, 0.0, 0.0)),
        (vec3(0.0, 2.0, 0.0), vec3(0.0, 4.0, 0.0)),
    ];
    let bounds = bounds.map(|(min, max)| Aabb::new(min, max)).to_vec();
    let heuristics = KdHeuristics { few_straddlers: true, ..KdHeuristics::NONE };
    let long = KdQuery { bounds, heuristics, leaf_size: 1 };
    trial.each_and(&[long], 200, inputs, <dyn Kit>::kd_build, |query, yours| judge_tree(query, &yours))
}

pub(super) fn kd_tree_build_ends(trial: &Trial<'_>) -> CheckResult {
    for (name, bounds) in infinite(trial.about(1000)) {
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

/// A tree of one cut across an axis, with these primitives on the two sides.
fn two_leaves(bounds: Aabb, (axis, at): (usize, f32), left: &[u32], right: &[u32]) -> KdTree {
    let mut tree = KdTree::new(bounds);
    let root = tree.add_node(0, 1);
    let [below, above] = [tree.add_node(1, 1), tree.add_node(1, 1)];
    tree.set_leaf(below, left);
    tree.set_leaf(above, right);
    tree.set_children(root, axis, at, below, above);
    tree
}

/// The hit lies on the face at which its cell ends, and `t` and `t'` are rounded differently.
pub(super) fn kd_finds_a_wall_on_the_face_of_the_box(trial: &Trial<'_>) -> CheckResult {
    let mut asked = Described::new();
    for (axis, (size, rough)) in (0..3)
        .flat_map(|axis| [(1.0, false), (1.0, true), (100.0, true), (1e5, true)].map(|kind| (axis, kind)))
    {
        let walls = [wall(axis, size, size), wall(axis, 0.0, size)];
        let scene = Scene { things: walls.into_iter().flatten().collect(), rough };
        let bounds = Aabb::new(Vec3::splat(-size), Vec3::splat(size));
        let whole = two_leaves(bounds, (axis, 0.0), &[2, 3], &[0, 1, 2, 3]);
        let control = two_leaves(bounds, (axis, 0.0), &[0, 1, 2], &[]);
        let start = Ray::new(size * along(axis, vec3(-0.5, 0.1, 0.2)), along(axis, Vec3::X));
        asked.control("kd-tree", control, start, (0.0, 0.5 * size));
        let what = format!("kd-tree of two leaves with walls on faces, size {size}");
        for i in 0..12 {
            let y = (i as f32 - 5.5) * 0.07;
            let direction = along(axis, vec3(1.0, 0.2 * y, 0.1)).normalize();
            // Aim at the far wall, and at the wall in the plane of the cut, which is listed on both sides.
            let origins = [0.2, -0.7].map(|x| size * along(axis, vec3(x, y, 0.3 * y)));
            asked.ask_all(&what, &whole, &scene, origins.map(|origin| Ray::new(origin, direction)));
        }
    }
    asked.judge(trial.kit, &KD_TREE)
}

/// Two primitives lie in one face; that of the right cell has a `t` one float smaller than that of the
/// left.
pub(super) fn hits_at_a_face_are_compared_with_each_other(trial: &Trial<'_>) -> CheckResult {
    let (mut trees, mut grids) = (Described::new(), Described::new());
    for axis in 0..3 {
        for (at, x) in [(1.0f32, -2.0f32), (0.75, -5.3), (-3.125, -7.7), (512.0, 1.0)] {
            let bounds = Aabb::new(Vec3::splat(-8.0), Vec3::splat(2.0 * at + 8.0));
            let resolution = along(axis, vec3(2.0, 1.0, 1.0)).as_uvec3();
            let tree = |lists: [&[u32]; 2]| two_leaves(bounds, (axis, at), lists[0], lists[1]);
            let grid = |lists: [&[u32]; 2]| filled(bounds, resolution, &lists.map(<[u32]>::to_vec));
            let exact = at - x;
            let ray = Ray::new(along(axis, vec3(x, 0.0, 0.0)), along(axis, Vec3::X));
            trees.control("kd-tree", tree([&[0, 1, 2], &[]]), ray, (0.0, exact));
            grids.control("grid", grid([&[0, 1, 2], &[]]), ray, (0.0, exact));
            let cases: [(_, [&[u32]; 2], _); 3] = [
                // A hit behind the end of the first cell waits, because the second cell has a nearer one.
                (
                    ["; a hit behind the first cell, and a nearer one in the second"; 2],
                    [&[0], &[0, 1]],
                    vec![exact + 2.0, exact + 1.0],
                ),
                // A hit behind the end of the first cell counts, because the second cell lists nothing.
                (
                    ["; the only hit is behind its leaf", "; the only hit is behind its cell"],
                    [&[0], &[]],
                    vec![exact + 1.0],
                ),
                (
                    [" of two cells, a primitive of each in the face between them"; 2],
                    [&[0], &[1]],
                    vec![exact.next_down(), exact.next_down().next_down()],
                ),
            ];
            for ([in_tree, in_grid], lists, hits) in cases {
                let query = CellsQuery { cells: tree(lists), ray, hits: hits.clone() };
                trees.add(format!("kd-tree{in_tree}"), query);
                grids.add(format!("grid{in_grid}"), CellsQuery { cells: grid(lists), ray, hits });
            }
        }
    }
    trees.judge(trial.kit, &KD_TREE)?;
    grids.judge(trial.kit, &GRID)
}

/// Primitives with hits at the same `t`: in one cell, whose list begins with the larger number or with the smaller one, and in
/// two cells, at the face between them.
pub(super) fn hits_at_one_t_in_cells_prefer_the_smaller_number(trial: &Trial<'_>) -> CheckResult {
    let (mut trees, mut grids, mut octrees) = (Described::new(), Described::new(), Described::new());
    let bounds = Aabb::new(Vec3::splat(-8.0), Vec3::splat(8.0));
    let (ray, hits) = (Ray::new(vec3(-2.0, 1.0, 1.0), Vec3::X), vec![2.0; 3]);
    let cases: [(_, [&[u32]; 2]); 4] = [
        ("in one cell, the smaller number first", [&[0, 1, 2], &[]]),
        ("in one cell, the smaller number second", [&[2, 0, 1], &[]]),
        ("at the face between two cells", [&[0], &[1, 2]]),
        ("at the face between two cells, the smaller number behind", [&[2, 1], &[0]]),
    ];
    trees.control("kd-tree", two_leaves(bounds, (0, 0.0), &[0, 1, 2], &[]), ray, (0.0, 2.0));
    for (what, lists) in cases {
        let cells = two_leaves(bounds, (0, 0.0), lists[0], lists[1]);
        trees.add(format!("kd-tree; {what}"), CellsQuery { cells, ray, hits: hits.clone() });
        let cells = filled(bounds, UVec3::new(2, 1, 1), &lists.map(<[u32]>::to_vec));
        grids.add(format!("grid; {what}"), CellsQuery { cells, ray, hits: hits.clone() });
        let mut cells = Octree::new(bounds);
        cells.set_leaf(0, &lists.concat());
        octrees.add(format!("octree of one leaf; {what}"), CellsQuery { cells, ray, hits: hits.clone() });
    }
    trees.judge(trial.kit, &KD_TREE)?;
    grids.judge(trial.kit, &GRID)?;
    octrees.judge(trial.kit, &OCTREE)
}

pub(super) fn kd_hit_beyond_its_leaf_waits(trial: &Trial<'_>) -> CheckResult {
    let mut asked = Described::new();
    for axis in 0..3 {
        let place = |center: Vec3, radius: f32| Thing::Sphere(Sphere { center: along(axis, center), radius });
        let large = place(vec3(5.0, 2.0, 0.0), 2.25);
        let scene = Scene::new(vec![large, place(vec3(3.5, 0.0, 0.0), 0.25)]);
        let bounds = Aabb::new(along(axis, vec3(0.0, -4.0, -4.0)), along(axis, vec3(8.0, 5.0, 4.0)));
        let ray = Ray::new(along(axis, vec3(-1.0, 0.0, 0.0)), along(axis, Vec3::X));
        let tree = two_leaves(bounds, (axis, 2.0), &[0], &[0, 1]);
        asked.ask("kd-tree; primitive 0 overlaps both leaves", &tree, &scene, ray);
        let control = two_leaves(bounds, (axis, 2.0), &[0, 1, 2], &[]);
        asked.control("kd-tree", control, ray, (1.0, 3.0));
        // Without the small sphere, the hit counts although it lies beyond the first leaf and the second does not list it.
        let tree = two_leaves(bounds, (axis, 2.0), &[0], &[]);
        let alone = Scene::new(vec![large]);
        asked.ask("kd-tree; primitive 0 is listed in the first leaf only", &tree, &alone, ray);
    }
    asked.judge(trial.kit, &KD_TREE)
}

/// A ray in the plane of a cut, or that starts on it, is on both sides.
pub(super) fn kd_rays_in_the_plane_search_both_sides(trial: &Trial<'_>) -> CheckResult {
    let bounds = Aabb::new(Vec3::splat(-8.0), Vec3::splat(8.0));
    let mut asked = Described::new();
    for axis in 0..3 {
        let place = |x: f32, y: f32, z: f32, radius: f32| {
            Thing::Sphere(Sphere { center: along(axis, vec3(x, y, z)), radius })
        };
        let from_plane = |direction: Vec3| Ray::new(along(axis, Vec3::X), along(axis, direction));
        for (left, right) in [(&[0u32, 1][..], &[2u32][..]), (&[2][..], &[0, 1][..]), (&[0][..], &[1, 2][..])]
        {
            let tree = two_leaves(bounds, (axis, 1.0), left, right);
            // Three spheres whose centres lie in the plane.
            let spheres = Scene::new(vec![
                place(1.0, 5.0, 0.0, 0.5),
                place(1.0, 0.0, 5.0, 0.5),
                place(1.0, -5.0, 0.0, 0.5),
            ]);
            for zero in [0.0, -0.0] {
                let directions = [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0)].map(|(y, z)| vec3(zero, y, z));
                let what = "kd-tree of two leaves, and a ray in the plane between them";
                asked.ask_all(what, &tree, &spheres, directions.map(from_plane));
            }
            // Rays from a point of the plane to spheres on each side.
            let beside = Scene::new(vec![
                place(-3.0, 0.5, 0.0, 0.5),
                place(-5.0, -0.5, 0.5, 1.0),
                place(5.0, 0.5, 0.0, 0.5),
            ]);
            let sides = two_leaves(bounds, (axis, 1.0), &[0, 1], &[2]);
            let directions = [vec3(-8.0, 1.0, 0.0), vec3(-8.0, -1.0, 0.5), vec3(8.0, 1.0, 0.0)];
            let what = "kd-tree of two leaves, and a ray from the plane between them";
            asked.ask_all(what, &sides, &beside, directions.map(from_plane));
        }
        // A wall in the plane, listed on one side only, and rays at it from both sides, from far and near.
        let wall = Scene::new(wall(axis, 1.0, 4.0).to_vec());
        for (left, right) in [(&[0u32, 1][..], &[][..]), (&[][..], &[0, 1][..])] {
            let tree = two_leaves(bounds, (axis, 1.0), left, right);
            let rays = [-7.5, 0.3, 1.7, 7.5].map(|x| {
                let direction = along(axis, vec3(1.0 - x, 0.1, 0.2)).normalize();
                Ray::new(along(axis, vec3(x, 0.3, 0.4)), direction)
            });
            let what = "kd-tree of two leaves, and a wall in the plane, listed on one side";
            asked.ask_all(what, &tree, &wall, rays);
            // From the plane itself, the rounded t of a primitive in it may be just above 0.
            for way in [-1.0, 1.0] {
                let ray = Ray::new(along(axis, Vec3::X), along(axis, vec3(way, 0.1, 0.2)));
                asked.add(what, CellsQuery { cells: tree.clone(), ray, hits: vec![(-20f32).exp2(); 2] });
            }
        }
    }
    asked.judge(trial.kit, &KD_TREE)
}

pub(super) fn kd_search_visits_what_the_ray_enters_before_its_hit(trial: &Trial<'_>) -> CheckResult {
    let (scene, rays) = spheres_and_rays(128, 9, (16, 1.5));
    let cells = kd_tree(&scene.boxes(), 10);
    KD_TREE.visits(trial.kit, "kd-tree over 128 spheres", &queries(&cells, &scene, &rays))
}
