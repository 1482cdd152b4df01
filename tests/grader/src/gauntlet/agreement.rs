//! Compares searches with brute force over exact predicates. A search is right if its hit is one of the triangles that the
//! ray meets first by exact arithmetic.

use crate::kits::Source;
use crate::queue;
use crate::worker::Worker;
use anyhow::Result;
use oracle::exact::{Body, meet, triangle};
use oracle::gauntlet::job::job;
use oracle::gauntlet::scenes::{HardScene, hard_scenes};
use oracle::splitmix::Random;
use raykata::bvh::PrimitiveHit;
use raykata::kit::{
    BuildQuery, Door, Kit, KitError, SearchQuery, SlabQuery, Table, TriangleQuery, kit_error,
};
use raykata::partition::KdHeuristics;
use raykata::ray::Ray;
use raykata::scene::{Accelerator, Quality, Split};
use raykata::shape::Triangle;
use std::time::Duration;

/// The result of one kind of search in one scene.
#[derive(Clone, Debug)]
pub struct Agreement {
    /// The scene.
    pub scene: &'static str,
    /// The kind of search.
    pub search: String,
    /// The number of rays.
    pub rays: u64,
    /// The number of rays that meet a triangle by exact arithmetic.
    pub hits: u64,
    /// The number of rays that meet several triangles first, at the same `t`.
    pub ties: u64,
    /// The number of wrong answers: they differ from the exact result or from brute force.
    pub mismatches: u64,
}

/// A ray and the answers that are right.
struct JudgedRay {
    ray: Ray,
    /// The triangles that are met first by exact arithmetic; several for a tie.
    ties: Vec<usize>,
    /// The hit that brute force finds.
    brute: Option<PrimitiveHit>,
}

impl JudgedRay {
    /// Computes the right answers for a ray. `brute` is the hit of brute force.
    fn new(scene: &HardScene, ray: Ray, brute: Option<PrimitiveHit>) -> JudgedRay {
        let ties = triangle::tie_set(&ray, &scene.triangles);
        JudgedRay { ray, ties, brute }
    }

    /// Whether a search found the right hit, and the same as brute force.
    fn is_right(&self, triangles: &[Triangle], found: Option<PrimitiveHit>) -> bool {
        if found != self.brute {
            return false;
        }
        let Some(found) = found else { return self.ties.is_empty() };
        let first = self.ties.first().and_then(|&first| exact_t(&self.ray, &triangles[first]));
        // Two different `t` may round to the same number. Then the smaller index wins.
        let found = found.primitive as usize;
        self.ties.contains(&found) || (first.is_some() && exact_t(&self.ray, &triangles[found]) == first)
    }

    fn is_any_right(&self, found: bool) -> bool {
        found == self.brute.is_some() && found != self.ties.is_empty()
    }
}

fn exact_t(ray: &Ray, triangle: &Triangle) -> Option<f32> {
    meet(ray, Body::Triangle(*triangle)).and_then(|meeting| meeting.t)
}

/// Time limit for all rays of a scene in one structure, with its build and without much optimisation.
const PATIENCE: Duration = Duration::from_secs(120);

/// Runs every search of the reference on every hard scene, with `rays` rays each.
pub fn all(reference: &Source, seed: u64, rays: u64) -> Result<Vec<Agreement>> {
    let kit = || Door(Worker::new(reference.program.clone(), PATIENCE));
    let kits: Vec<_> = (0..queue::cores()).map(|_| kit()).collect();
    let of_scenes = queue::run(&kits, &hard_scenes(), |kit, scene| {
        Ok(kit_error::catch(|| of_scene(kit, scene, seed, rays))?)
    })?;
    Ok(of_scenes.into_iter().flatten().collect())
}

fn of_scene(kit: &dyn Kit, scene: &HardScene, seed: u64, rays: u64) -> Vec<Agreement> {
    let mut random = Random::new(seed, 21);
    let rays: Vec<Ray> = (0..rays).map(|_| scene.ray(&mut random)).collect();
    let found_by = |quality: Quality| kit.first_hits(&job(&scene.triangles, quality), &rays);
    let with = |accelerator: Accelerator, leaf_size: u32| Quality {
        accelerator,
        leaf_size,
        split: Split::SurfaceArea,
        ..Quality::default()
    };
    let brute = found_by(with(Accelerator::BruteForce, 1));
    let asked: Vec<JudgedRay> =
        rays.iter().zip(&brute).map(|(ray, brute)| JudgedRay::new(scene, *ray, *brute)).collect();
    let compared = |search: String, found: Vec<Option<PrimitiveHit>>| {
        let mut found = found.into_iter();
        agreement(scene, search, &asked, |one| one.is_right(&scene.triangles, found.next().flatten()))
    };
    let mut agreements = vec![compared("brute force".into(), brute.clone())];
    let distances = distances(kit, scene, &rays);
    for (split, leaf_size) in Split::ALL.into_iter().flat_map(|split| [(split, 1), (split, 4)]) {
        let named = |how: &str| format!("{split:?}, leaves of {leaf_size}, {how}");
        let queries = searches(kit, scene, &rays, &distances, split, leaf_size);
        let both = in_batches(&queries, |batch| kit.closest_hit_both(batch));
        agreements.push(compared(named("both children"), both.iter().map(|answer| answer.hit).collect()));
        let quality = Quality { split, ..with(Accelerator::Bvh, leaf_size) };
        agreements.push(compared(named("nearer first"), found_by(quality)));
        let mut any = in_batches(&queries, |batch| kit.any_hit(batch)).into_iter();
        let judge = |one: &JudgedRay| one.is_any_right(any.next().is_some_and(|(found, _)| found));
        agreements.push(agreement(scene, named("any hit"), &asked, judge));
    }
    for (search, quality) in structures(with) {
        agreements.push(compared(search, found_by(quality)));
    }
    agreements
}

/// Returns the structures of stage 9 and the other traversals of a hierarchy.
fn structures(with: impl Fn(Accelerator, u32) -> Quality) -> Vec<(String, Quality)> {
    let mut structures: Vec<(String, Quality)> = Vec::new();
    for (name, grid_resolution) in [("of 3 cells along", 3), ("by the formula", 0)] {
        let quality = Quality { grid_resolution, ..with(Accelerator::Grid, 1) };
        structures.push((format!("grid {name}"), quality));
    }
    // With smaller leaves the structure would split copies of a triangle down to the deepest level.
    for leaf_size in [4, 8] {
        for (how, accelerator) in [
            ("by cells", Accelerator::OctreeByCells),
            ("by neighbours", Accelerator::OctreeByNeighbours),
            ("from the root", Accelerator::Octree),
        ] {
            structures.push((format!("octree, leaves of {leaf_size}, {how}"), with(accelerator, leaf_size)));
        }
    }
    for (name, kd_heuristics) in
        [("all heuristics", KdHeuristics::default()), ("no heuristic", KdHeuristics::NONE)]
    {
        let quality = Quality { kd_heuristics, ..with(Accelerator::KdTree, 2) };
        structures.push((format!("kd-tree, {name}"), quality));
    }
    structures.push(("BSP tree".into(), with(Accelerator::Bsp, 2)));
    structures.push(("BSP tree of polygons".into(), with(Accelerator::PolygonBsp, 2)));
    structures.push(("hierarchy, last hit first".into(), with(Accelerator::CachedBvh, 2)));
    structures.push(("hierarchy, packets".into(), with(Accelerator::PacketBvh, 2)));
    structures.push(("wide hierarchy".into(), with(Accelerator::WideBvh, 2)));
    structures.push(("wide hierarchy, subtrees moved".into(), with(Accelerator::ReinsertedBvh, 2)));
    structures.push(("wide hierarchy, streams".into(), with(Accelerator::StreamBvh, 2)));
    structures
}

/// Returns for each ray the `t` of each triangle, in the format of the search tables.
fn distances(kit: &dyn Kit, scene: &HardScene, rays: &[Ray]) -> Vec<Vec<f32>> {
    let of_ray = |ray: &Ray| {
        let query = |&triangle: &Triangle| TriangleQuery { ray: *ray, triangle };
        let queries: Vec<TriangleQuery> = scene.triangles.iter().map(query).collect();
        // Frames use the watertight test as soon as it is written.
        let hits = match kit_error::catch(|| kit.watertight(&queries)) {
            Err(KitError::NotWritten { .. }) => kit.triangle_choice(&queries),
            hits => hits.unwrap_or_else(|error| kit_error::unwind(error)),
        };
        hits.into_iter().map(|hit| hit.map_or(f32::INFINITY, |hit| hit.t)).collect()
    };
    rays.iter().map(of_ray).collect()
}

/// Returns one search per ray in a hierarchy of the kit, with the kit's answers to all questions about boxes and triangles.
fn searches(
    kit: &dyn Kit,
    scene: &HardScene,
    rays: &[Ray],
    distances: &[Vec<f32>],
    split: Split,
    leaf_size: u32,
) -> Vec<SearchQuery> {
    let bounds = kit.triangle_bounds(&scene.triangles);
    let query = BuildQuery { bounds, split, leaf_size: leaf_size as usize };
    let bvh = kit.build(std::slice::from_ref(&query)).pop().unwrap_or_default();
    let of_ray = |(ray, distances): (&Ray, &Vec<f32>)| {
        let queries: Vec<SlabQuery> =
            bvh.nodes.iter().map(|node| SlabQuery { ray: *ray, bounds: node.bounds }).collect();
        let miss = (f32::INFINITY, f32::NEG_INFINITY);
        let boxes = kit.slab(&queries).into_iter().map(|span| span.unwrap_or(miss)).collect();
        let table = Table { boxes, primitives: distances.clone() };
        SearchQuery { bvh: bvh.clone(), ray: *ray, table }
    };
    rays.iter().zip(distances).map(of_ray).collect()
}

/// Runs the searches in small batches, because each search contains its hierarchy.
fn in_batches<A>(queries: &[SearchQuery], ask: impl Fn(&[SearchQuery]) -> Vec<A>) -> Vec<A> {
    queries.chunks(100).flat_map(ask).collect()
}

fn agreement(
    scene: &HardScene,
    search: String,
    asked: &[JudgedRay],
    mut is_right: impl FnMut(&JudgedRay) -> bool,
) -> Agreement {
    Agreement {
        scene: scene.name,
        search,
        rays: asked.len() as u64,
        hits: asked.iter().filter(|one| !one.ties.is_empty()).count() as u64,
        ties: asked.iter().filter(|one| one.ties.len() > 1).count() as u64,
        mismatches: asked.iter().map(|one| u64::from(!is_right(one))).sum(),
    }
}
