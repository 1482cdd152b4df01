//! No ray leaks out of a closed mesh, in any structure of the reference.

use oracle::gauntlet::families::families;
use oracle::gauntlet::job::job;
use oracle::gauntlet::leaks::{Aim, aimed};
use oracle::splitmix::Random;
use raykata::ray::Ray;
use raykata::scene::{Accelerator, Quality};

/// The number of rays per mesh and structure. `RAYS=100000 cargo test --release -p solutions --test suite leaks --
/// --nocapture` tests more, and `grader gauntlet --rays N` hundreds of millions.
fn n_rays() -> usize {
    std::env::var("RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(200)
}

#[test]
fn no_ray_leaks_in_any_structure() {
    let structures = [
        Accelerator::BruteForce,
        Accelerator::Bvh,
        Accelerator::Grid,
        Accelerator::Octree,
        Accelerator::OctreeByCells,
        Accelerator::OctreeByNeighbours,
        Accelerator::KdTree,
        Accelerator::Bsp,
        Accelerator::PolygonBsp,
    ];
    let mut leaks = Vec::new();
    for mesh in families() {
        let mut random = Random::new(1, mesh.positions.len() as u64);
        let rays: Vec<Ray> = (0..n_rays()).map(|n| aimed(&mesh, Aim::ALL[n % 2], &mut random).0).collect();
        for accelerator in structures {
            let started = std::time::Instant::now();
            let quality = Quality { accelerator, ..Quality::default() };
            let hits = solutions::kit().first_hits(&job(&mesh.all(), quality), &rays);
            let lost: Vec<&Ray> =
                rays.iter().zip(&hits).filter(|(_, hit)| hit.is_none()).map(|(ray, _)| ray).collect();
            if std::env::var("TIMES").is_ok() {
                println!("{} {accelerator:?} {} ms", mesh.name, started.elapsed().as_millis());
            }
            if let Some(ray) = lost.first() {
                leaks.push(format!(
                    "{}, {accelerator:?}: {} rays, for example {ray:?}",
                    mesh.name,
                    lost.len()
                ));
            }
        }
    }
    assert!(leaks.is_empty(), "{} leaks:\n{}", leaks.len(), leaks.join("\n"));
}
