//! Every search of the reference finds a triangle that the ray meets first by exact arithmetic, on scenes that are hard to search.

use oracle::exact::{Body, meet, triangle};
use oracle::gauntlet::job::job;
use oracle::gauntlet::scenes::{HardScene, hard_scenes};
use oracle::splitmix::Random;
use raykata::bvh::PrimitiveHit;
use raykata::partition::KdHeuristics;
use raykata::ray::Ray;
use raykata::scene::{Accelerator, Quality, Split};

/// The number of rays per scene. Exact arithmetic takes most of the time. `RAYS=20000 cargo test --release -p solutions --test
/// suite agreement` tests more.
fn n_rays() -> u64 {
    std::env::var("RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(200)
}

/// The structures, each with its name.
fn structures() -> Vec<(String, Quality)> {
    let with = |accelerator, leaf_size| Quality { accelerator, leaf_size, ..Quality::default() };
    let mut structures = Vec::new();
    for (split, leaf_size) in Split::ALL.into_iter().flat_map(|split| [(split, 1), (split, 4)]) {
        for accelerator in [Accelerator::BvhBothChildren, Accelerator::Bvh] {
            let quality = Quality { split, ..with(accelerator, leaf_size) };
            structures.push((format!("{accelerator:?}, {split:?}, leaves of {leaf_size}"), quality));
        }
    }
    for grid_resolution in [3, 0] {
        let quality = Quality { grid_resolution, ..with(Accelerator::Grid, 1) };
        structures.push((format!("grid of resolution {grid_resolution}"), quality));
    }
    // With smaller leaves the structure would split copies of a triangle down to the deepest level.
    for leaf_size in [4, 8] {
        for accelerator in [Accelerator::Octree, Accelerator::OctreeByCells, Accelerator::OctreeByNeighbours]
        {
            structures
                .push((format!("{accelerator:?}, leaves of {leaf_size}"), with(accelerator, leaf_size)));
        }
    }
    for kd_heuristics in [KdHeuristics::default(), KdHeuristics::NONE] {
        let quality = Quality { kd_heuristics, ..with(Accelerator::KdTree, 2) };
        structures.push((format!("kd-tree with {kd_heuristics:?}"), quality));
    }
    let others = [
        Accelerator::Bsp,
        Accelerator::PolygonBsp,
        Accelerator::CachedBvh,
        Accelerator::PacketBvh,
        Accelerator::WideBvh,
    ];
    structures.extend(others.map(|accelerator| (format!("{accelerator:?}"), with(accelerator, 2))));
    structures
}

/// A ray, and the answers that are right.
struct JudgedRay {
    ray: Ray,
    /// The triangles that are met first by exact arithmetic; several for a tie.
    ties: Vec<usize>,
    /// The hit that brute force finds.
    brute: Option<PrimitiveHit>,
}

impl JudgedRay {
    /// Whether a hit is that of brute force, and of a triangle that is met first by exact arithmetic.
    fn is_right(&self, scene: &HardScene, found: Option<PrimitiveHit>) -> bool {
        if found != self.brute {
            return false;
        }
        let Some(found) = found else { return self.ties.is_empty() };
        let exact_t = |triangle: usize| {
            meet(&self.ray, Body::Triangle(scene.triangles[triangle])).and_then(|meeting| meeting.t)
        };
        let first = self.ties.first().and_then(|&first| exact_t(first));
        // Two different `t` may round to the same number. Then the smaller index wins.
        let found = found.primitive as usize;
        self.ties.contains(&found) || (first.is_some() && exact_t(found) == first)
    }
}

#[test]
fn every_search_finds_a_triangle_that_is_exactly_met_first() {
    let mut wrong = Vec::new();
    for scene in hard_scenes() {
        let mut random = Random::new(1, 21);
        let rays: Vec<Ray> = (0..n_rays()).map(|_| scene.ray(&mut random)).collect();
        let brute = Quality { accelerator: Accelerator::BruteForce, leaf_size: 1, ..Quality::default() };
        let brute = solutions::kit().first_hits(&job(&scene.triangles, brute), &rays);
        let judge = |(&ray, brute)| JudgedRay { ray, ties: triangle::tie_set(&ray, &scene.triangles), brute };
        let judged: Vec<JudgedRay> = rays.iter().zip(brute).map(judge).collect();
        let mut compare = |search: &str, found: Vec<Option<PrimitiveHit>>| {
            let mistakes = judged.iter().zip(found).filter(|(one, found)| !one.is_right(&scene, *found));
            wrong.extend(mistakes.map(|(one, found)| {
                format!("{}, {search}: {found:?}, not one of {:?}: {:?}", scene.name, one.ties, one.ray)
            }));
        };
        compare("brute force", judged.iter().map(|one| one.brute).collect());
        for (search, quality) in structures() {
            compare(&search, solutions::kit().first_hits(&job(&scene.triangles, quality), &rays));
        }
        // The scenes are as hard as they claim to be.
        let hits = judged.iter().filter(|one| !one.ties.is_empty()).count();
        let ties = judged.iter().filter(|one| one.ties.len() > 1).count();
        match scene.name {
            "nothing" | "in a line, without area" => assert_eq!(hits, 0),
            "each four times" => assert!(ties == hits && 5 * hits > rays.len(), "{hits} hits, {ties} ties"),
            "lattice" => assert!(10 * ties > rays.len(), "{ties} ties"),
            "closed" => assert_eq!(hits, rays.len()),
            _ => {}
        }
    }
    assert!(wrong.is_empty(), "{} wrong hits:\n{}", wrong.len(), wrong.join("\n"));
}
