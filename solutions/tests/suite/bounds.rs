//! The size of all structures, and the cost of a search, for lists of triangles that are hard to divide. Everything is
//! counted; no clock is read.

use super::adversarial::{Hard, hard_lists};
use super::partitions::{SceneProbe, Thing, Things};
use glam::Vec3;
use oracle::splitmix::Random;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, DEEPEST_SPLIT, PrimitiveHit};
use raykata::partition::{
    Bsp, BspNode, KdHeuristics, KdNode, KdTree, MOST_REFERENCES, Octree, OctreeNode, PolygonBsp,
};
use raykata::ray::Ray;
use raykata::scene::Split;
use raykata::shape::Triangle;
use solutions::{
    stage2_triangles, stage3_build, stage3_traversal, stage9_bsp, stage9_kd_tree, stage9_neighbours,
    stage9_octree, stage9_polygon_bsp,
};

/// Triangles per list. `N=50000 cargo test -p solutions --test suite bounds` takes more.
fn n_triangles() -> usize {
    std::env::var("N").ok().and_then(|n| n.parse().ok()).unwrap_or(2000)
}

const LEAF_SIZE: usize = 4;

/// The depth that frames use.
const OCTREE_DEPTH: usize = 20;

/// The search of a structure.
type Search<'a> = &'a dyn Fn(&mut SceneProbe<'_>, &Ray) -> Option<PrimitiveHit>;

fn things(hard: &Hard) -> Things {
    Things(hard.triangles.iter().copied().map(Thing::Tile).collect())
}

/// Rays at the triangles, from a distance of about three times their size.
fn rays(triangles: &[Triangle]) -> Vec<Ray> {
    let mut random = Random::new(7, 0);
    let mut ray = || {
        let Triangle { a, b, c } = triangles[random.below(triangles.len() as u64) as usize];
        let size = (b - a).abs().max_element().max((c - a).abs().max_element()).max(1e-3);
        let away = random.direction();
        let target = a + (b - a) / 3.0 + (c - a) / 3.0;
        Ray::new(target + 3.0 * size * away, (0.3 * random.direction() - away).normalize_or(Vec3::X))
    };
    (0..40).map(|_| ray()).collect()
}

/// Fails if a structure has more than `most_nodes` nodes or more than 16 references per triangle, or if a ray visits more nodes or
/// tests more primitives than it has, or finds another hit than brute force. Messages name the structure by `what`.
fn judge(
    hard: &Hard,
    bvh: &Bvh,
    what: &str,
    (n_nodes, most_nodes): (usize, usize),
    n_references: usize,
    search: Search<'_>,
) {
    let (name, n) = (hard.name, hard.triangles.len());
    println!("{what} over {n} {name}: {n_nodes} nodes, {n_references} references");
    assert!(n_nodes <= most_nodes, "{what} over {n} {name}: {n_nodes} nodes, more than {most_nodes}");
    let most = MOST_REFERENCES * n;
    assert!(n_references <= most, "{what} over {n} {name}: {n_references} references, more than {most}");
    let things = things(hard);
    for ray in rays(&hard.triangles) {
        let mut probe = SceneProbe::new(&things, bvh);
        let found = search(&mut probe, &ray);
        assert!(probe.visits <= n_nodes as u64, "{what} over {name}: {} visits, {ray:?}", probe.visits);
        assert!(probe.tests <= n_references as u64, "{what} over {name}: {} tests, {ray:?}", probe.tests);
        let expected = stage2_triangles::brute_force(n as u32, &mut SceneProbe::new(&things, bvh), &ray);
        assert_eq!(found, expected, "{what} over {name}, {ray:?}");
    }
}

#[test]
fn hierarchies_over_hard_triangles_are_shallow() {
    for hard in hard_lists(n_triangles()) {
        let n = hard.triangles.len();
        for split in Split::ALL {
            let bvh = stage3_build::build(&things(&hard).boxes(), split, LEAF_SIZE);
            let most = DEEPEST_SPLIT + n.next_power_of_two().ilog2() as usize + 1;
            let depth = bvh.depth();
            assert!(depth <= most, "{split:?} over {n} {}: {depth} levels, more than {most}", hard.name);
            let search =
                |probe: &mut SceneProbe<'_>, ray: &Ray| stage3_traversal::closest_hit(&bvh, probe, ray);
            let what = format!("a hierarchy by {split:?}");
            judge(&hard, &bvh, &what, (bvh.nodes.len(), 2 * n - 1), bvh.order.len(), &search);
        }
    }
}

/// The most nodes of a tree whose divided nodes have `n_children` children: at each depth the divided nodes list at
/// most 16 references per triangle, and each of them more than `LEAF_SIZE`.
fn most_nodes(n: usize, n_children: usize, depth: usize) -> usize {
    1 + n_children * depth * (MOST_REFERENCES * n / (LEAF_SIZE + 1))
}

#[test]
fn octrees_over_hard_triangles_are_small() {
    for hard in hard_lists(n_triangles()) {
        let octree: Octree = stage9_octree::build(&things(&hard).boxes(), LEAF_SIZE, OCTREE_DEPTH);
        let n_references = octree.items.len();
        let search = |probe: &mut SceneProbe<'_>, ray: &Ray| stage9_octree::closest_hit(&octree, probe, ray);
        let nodes = (octree.nodes.len(), most_nodes(hard.triangles.len(), 8, OCTREE_DEPTH));
        judge(&hard, &Bvh::default(), "an octree", nodes, n_references, &search);
        // The search by neighbours visits each node at most once.
        let by_neighbours = |probe: &mut SceneProbe<'_>, ray: &Ray| {
            stage9_neighbours::closest_hit_by_neighbours(&octree, probe, ray)
        };
        judge(&hard, &Bvh::default(), "an octree, by neighbours,", nodes, n_references, &by_neighbours);
        // The search by cells visits the nodes above a leaf again for each leaf.
        let leaves = octree.nodes.iter().filter(|node| matches!(node, OctreeNode::Leaf { .. })).count();
        let by_cells =
            |probe: &mut SceneProbe<'_>, ray: &Ray| stage9_octree::closest_hit_by_cells(&octree, probe, ray);
        let n_visits = leaves * octree.depth();
        judge(&hard, &Bvh::default(), "an octree, by cells,", (n_visits, n_visits), n_references, &by_cells);
    }
}

#[test]
fn kd_trees_over_hard_triangles_are_small() {
    let without = |change: fn(&mut KdHeuristics)| {
        let mut heuristics = KdHeuristics::default();
        change(&mut heuristics);
        heuristics
    };
    for hard in hard_lists(n_triangles()) {
        for heuristics in [
            KdHeuristics::NONE,
            KdHeuristics::default(),
            without(|all| all.longest_axis = false),
            without(|all| all.balanced_counts = false),
            without(|all| all.few_straddlers = false),
            without(|all| all.cut_off_empty_space = false),
            without(|all| all.stop_at_overlap = false),
        ] {
            let tree = stage9_kd_tree::build(&things(&hard).boxes(), &heuristics, LEAF_SIZE);
            let n = hard.triangles.len();
            let search =
                |probe: &mut SceneProbe<'_>, ray: &Ray| stage9_kd_tree::closest_hit(&tree, probe, ray);
            let what = format!("a kd-tree with {heuristics:?}");
            let nodes = (tree.nodes.len(), most_nodes(n, 2, KdTree::most_depth(n)));
            judge(&hard, &Bvh::default(), &what, nodes, tree.items.len(), &search);
        }
    }
}

#[test]
fn bsp_trees_over_hard_triangles_are_small() {
    for hard in hard_lists(n_triangles()) {
        let hulls = things(&hard).hulls();
        let depth = KdTree::most_depth(hulls.len());
        let bsp: Bsp = stage9_bsp::build(&hulls, LEAF_SIZE, depth);
        let search = |probe: &mut SceneProbe<'_>, ray: &Ray| stage9_bsp::closest_hit(&bsp, probe, ray);
        let nodes = (bsp.nodes.len(), most_nodes(hulls.len(), 2, depth));
        judge(&hard, &Bvh::default(), "a BSP tree", nodes, bsp.items.len(), &search);
        let depth = 2 * depth;
        let bsp: PolygonBsp = stage9_polygon_bsp::build(&hulls, LEAF_SIZE, depth);
        let search =
            |probe: &mut SceneProbe<'_>, ray: &Ray| stage9_polygon_bsp::closest_hit(&bsp, probe, ray);
        let nodes = (bsp.nodes.len(), most_nodes(hulls.len(), 2, depth));
        judge(&hard, &Bvh::default(), "a BSP tree of polygons", nodes, bsp.items.len(), &search);
    }
}

/// The bound must not stop trees over triangles that can be divided: all leaves have at most eight of them.
#[test]
fn trees_over_triangles_apart_are_divided_as_asked() {
    let mut random = Random::new(11, 0);
    let tile = |_| {
        let a = random.in_cube();
        Aabb::new(a, a + 0.002)
    };
    let bounds: Vec<Aabb> = (0..n_triangles()).map(tile).collect();
    let octree = stage9_octree::build(&bounds, LEAF_SIZE, OCTREE_DEPTH);
    let tree = stage9_kd_tree::build(&bounds, &KdHeuristics::default(), LEAF_SIZE);
    let hulls: Vec<Vec<Vec3>> = bounds.iter().map(raykata::partition::corners).collect();
    let bsp = stage9_bsp::build(&hulls, LEAF_SIZE, KdTree::most_depth(hulls.len()));
    let counts = [
        octree.nodes.iter().map(|n| if let OctreeNode::Leaf { count, .. } = n { *count } else { 0 }).max(),
        tree.nodes.iter().map(|n| if let KdNode::Leaf { count, .. } = n { *count } else { 0 }).max(),
        bsp.nodes.iter().map(|n| if let BspNode::Leaf { count, .. } = n { *count } else { 0 }).max(),
    ];
    assert!(counts.iter().all(|count| count.is_some_and(|count| count <= 8)), "{counts:?}");
}
