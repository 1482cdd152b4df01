//! No ray leaks out of a closed mesh, in any structure of the reference.

use oracle::gauntlet::families::families;
use oracle::gauntlet::job::job;
use oracle::gauntlet::leaks::{Aim, aimed};
use oracle::splitmix::Random;
use raykata::ray::Ray;
use raykata::scene::{Accelerator, Quality, Split};

/// The number of rays per mesh and structure. `RAYS=100000 cargo test --release -p solutions --test suite leaks`
/// tests more.
fn n_rays() -> usize {
    std::env::var("RAYS").ok().and_then(|n| n.parse().ok()).unwrap_or(200)
}

#[test]
fn no_ray_leaks_in_any_structure() {
    // The other structures are hierarchies of whole objects, which search a mesh as `Bvh` does.
    let of_objects = [
        Accelerator::Auto,
        Accelerator::BoundingBoxes,
        Accelerator::BoundingSpheres,
        Accelerator::CachedBoundingBoxes,
    ];
    let others = Accelerator::ALL.into_iter().filter(|accelerator| !of_objects.contains(accelerator));
    let structures = others.map(|accelerator| Quality { accelerator, ..Quality::default() });
    let medians = [Split::ObjectMedian, Split::SpatialMedian];
    let structures = structures.chain(medians.map(|split| Quality { split, ..Quality::default() }));
    let structures: Vec<Quality> = structures.collect();
    let mut leaks = Vec::new();
    for mesh in families() {
        let mut random = Random::new(1, mesh.positions.len() as u64);
        let rays: Vec<Ray> = (0..n_rays()).map(|n| aimed(&mesh, Aim::ALL[n % 2], &mut random).0).collect();
        for &quality in &structures {
            let Quality { accelerator, split, .. } = quality;
            let hits = solutions::kit().first_hits(&job(&mesh.all(), quality), &rays);
            let lost: Vec<&Ray> =
                rays.iter().zip(&hits).filter(|(_, hit)| hit.is_none()).map(|(ray, _)| ray).collect();
            if let Some(ray) = lost.first() {
                leaks.push(format!(
                    "{}, {accelerator:?}, {split:?}: {} rays, for example {ray:?}",
                    mesh.name,
                    lost.len()
                ));
            }
        }
    }
    assert!(leaks.is_empty(), "{} leaks:\n{}", leaks.len(), leaks.join("\n"));
}
