//! Nothing to do here: by which search a frame finds what rays meet, and what stands in for one that is not written yet.

use crate::plan::written;
use crate::{
    stage2_triangles, stage3_bvh, stage8_scene_graph, stage9_bsp, stage9_cells, stage9_coherence,
    stage9_grid, stage9_kd_tree, stage9_octree,
};
use glam::{UVec3, Vec3};
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, Probe};
use raykata::graph::{Graph, Savings};
use raykata::partition::{Bsp, Cell, Cells, Grid, KdHeuristics, KdTree, Octree};
use raykata::ray::Ray;
use raykata::scene::{Accelerator, Quality};
use raykata::shape::Sphere;

/// How the closest hit is sought.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Search {
    Hierarchy,
    BruteForce,
    /// The last primitive that the ray meets, near or far.
    Painter,
    /// The scene graph, with boxes or balls around its nodes.
    GraphOfBoxes,
    GraphOfBalls,
    /// A hierarchy, after what the ray before met.
    Cached,
    /// A hierarchy, with rays from the camera in packets.
    Packets,
    Grid,
    Octree,
    OctreeByCells,
    KdTree,
    Bsp,
}

/// The search that the scene asks for, as far as it is written.
pub fn choose(quality: &Quality, notes: &mut Vec<String>) -> Search {
    let ray = Ray::new(Vec3::ZERO, Vec3::X);
    let hierarchy = written(|| stage3_bvh::build(&[], quality.split, 1))
        && written(|| stage3_bvh::closest_hit(&Bvh::default(), &mut Nothing, &ray))
        && written(|| stage3_bvh::any_hit(&Bvh::default(), &mut Nothing, &ray))
        && written(|| stage3_bvh::slab(&ray, Vec3::X, &Aabb::EMPTY));
    let brute_force = written(|| stage2_triangles::brute_force(0, &mut Nothing, &ray));
    let wanted = quality.accelerator;
    if hierarchy && wanted != Accelerator::BruteForce {
        let (search, written) = special(wanted, &ray);
        if written {
            return search;
        }
        let stage = match search {
            Search::GraphOfBoxes | Search::GraphOfBalls => 8,
            _ => 9,
        };
        let name = wanted.name();
        notes.push(format!("a hierarchy stands in for `{name}`: stage {stage} is not written yet"));
        return Search::Hierarchy;
    }
    if wanted != Accelerator::BruteForce {
        notes.push("every ray tests every primitive: stage 3 is not written yet".into());
    }
    if brute_force {
        return Search::BruteForce;
    }
    notes.push(
        "later shapes are painted over earlier ones, near or far: `brute_force` of stage 2 is not written yet".into(),
    );
    Search::Painter
}

/// The search of an accelerator, and whether its own functions are written.
fn special(accelerator: Accelerator, ray: &Ray) -> (Search, bool) {
    let probe = &mut Nothing;
    let graph = |probe: &mut Nothing| {
        let (graph, savings) = (Graph::default(), Savings::default());
        written(|| stage8_scene_graph::closest_hit_in_graph(&graph, probe, ray, savings))
    };
    let octree = || cells_are_written(ray) && written(|| stage9_octree::build(&[], 1, 1));
    match accelerator {
        Accelerator::BruteForce | Accelerator::Bvh => (Search::Hierarchy, true),
        Accelerator::BoundingBoxes => (Search::GraphOfBoxes, graph(probe)),
        Accelerator::BoundingSpheres => {
            let ball = Sphere { center: Vec3::ZERO, radius: 1.0 };
            let balls = written(|| stage8_scene_graph::bounding_ball(&[Vec3::ZERO]))
                && written(|| stage8_scene_graph::enter_ball(ray, &ball));
            (Search::GraphOfBalls, graph(probe) && balls)
        }
        Accelerator::CachedBvh => {
            let nothing = |_: &mut Nothing, _: &Ray| None;
            let cached = written(|| stage9_coherence::closest_hit_cached(None, probe, ray, nothing));
            (Search::Cached, cached)
        }
        Accelerator::PacketBvh => {
            let packets = written(|| stage9_coherence::closest_hit_packet(&Bvh::default(), probe, &[]));
            (Search::Packets, packets)
        }
        Accelerator::Grid => {
            let grid =
                Grid { bounds: Aabb::EMPTY, resolution: UVec3::ONE, starts: vec![0, 0], items: Vec::new() };
            let grids = cells_are_written(ray)
                && written(|| stage9_grid::resolution(&Aabb::EMPTY, 0, 1.0))
                && written(|| stage9_grid::build(&[], UVec3::ONE))
                && written(|| stage9_grid::closest_hit(&grid, probe, ray));
            (Search::Grid, grids)
        }
        Accelerator::Octree => {
            let search = written(|| stage9_octree::closest_hit(&Octree::empty(), probe, ray));
            (Search::Octree, octree() && search)
        }
        Accelerator::OctreeByCells => {
            let search = written(|| stage9_octree::closest_hit_by_cells(&Octree::empty(), probe, ray));
            (Search::OctreeByCells, octree() && search)
        }
        Accelerator::KdTree => {
            let tree = KdTree::new(Aabb::EMPTY);
            let trees = cells_are_written(ray)
                && written(|| stage9_kd_tree::build(&[], &KdHeuristics::default(), 1))
                && written(|| stage9_kd_tree::closest_hit(&tree, probe, ray));
            (Search::KdTree, trees)
        }
        Accelerator::Bsp => {
            let trees = cells_are_written(ray)
                && written(|| stage9_bsp::build(&[], 1, 1))
                && written(|| stage9_bsp::closest_hit(&Bsp::default(), probe, ray));
            (Search::Bsp, trees)
        }
    }
}

/// What all searches of cells share.
fn cells_are_written(ray: &Ray) -> bool {
    let cell = Cell::new(&Aabb::new(Vec3::ZERO, Vec3::ONE));
    written(|| stage9_cells::widened(&[]))
        && written(|| stage9_cells::part_above(0.0, 1.0, 0.0, (0.0, 1.0)))
        && written(|| stage9_cells::span(ray, &cell))
        && written(|| stage9_cells::look_into(&[], &mut Nothing, &mut ray.clone(), &mut None))
        && written(|| stage9_cells::settled(&None, 0.0))
}

/// A world without anything in it.
struct Nothing;

impl Probe for Nothing {
    fn open(&mut self, _: u32) -> Contents {
        Contents::Leaf { first: 0, count: 0 }
    }
    fn enter(&mut self, _: u32, _: &Ray) -> Option<f32> {
        None
    }
    fn hit(&mut self, _: u32, _: &Ray) -> Option<f32> {
        None
    }
}

impl Cells for Nothing {
    fn visit(&mut self, _: u32) {}
    fn hit(&mut self, _: u32, _: &Ray) -> Option<f32> {
        None
    }
}
