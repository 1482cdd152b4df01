//! Frames that use the structures of earlier frames again are the same frames.

use crate::scene::{self, rendered, scene};
use raykata::kit::RenderJob;
use raykata::ray::Ray;
use raykata::scene::{Accelerator, Precision, Scene, Split};

const SCENE: &str = r#"
film = { width = 40, height = 30 }
camera = { position = [0, 2.4, 6], look_at = [0, 1, 0] }
[environment]
ambient = 0.1
[[lights]]
area = { sphere = { center = [4, 6, 5], radius = 1 } }
[materials.mirror]
mirror = 0.4
[meshes.vase]
file = "meshes/vase.ply"
[[nodes]]
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[nodes]]
shape = { mesh = "vase" }
material = "mirror"
transform = [{ translate = [-1.2, 0, 0] }]
[[nodes]]
shape = { mesh = "vase" }
transform = [{ translate = [1.2, 0, 0.5] }]
"#;

fn job(scene: &Scene, seed: u64, reuse: bool) -> RenderJob {
    RenderJob { seed, reuse, ..scene::job(scene) }
}

#[test]
fn a_structure_that_is_used_again_changes_no_pixel_and_no_count() {
    // Change one setting at a time, of those that decide how hits are found and of those that do not.
    let first = scene(SCENE);
    let changed = |change: &dyn Fn(&mut Scene)| {
        let mut scene = first.clone();
        change(&mut scene);
        scene
    };
    let scenes = [
        first.clone(),
        changed(&|scene| scene.quality.samples_per_pixel = 2),
        changed(&|scene| scene.quality.max_depth = 0),
        changed(&|scene| scene.quality.ray_offset = 1e-3),
        changed(&|scene| scene.quality.split = Split::ObjectMedian),
        changed(&|scene| scene.quality.leaf_size = 1),
        changed(&|scene| scene.quality.accelerator = Accelerator::Octree),
        changed(&|scene| scene.quality.accelerator = Accelerator::PacketBvh),
        changed(&|scene| scene.quality.precision = Precision::Double),
        changed(&|scene| scene.quality.copies = true),
        changed(&|scene| scene.nodes.iter_mut().for_each(|node| node.transform.translation.y += 0.5)),
        changed(&|scene| scene.camera.position.x = 1.0),
        changed(&|scene| scene.film.width = 20),
        changed(&|scene| scene.meshes[0].smooth ^= true),
    ];
    // Twice, so that the second time every structure has been kept.
    for seed in 0..2 {
        for (index, scene) in scenes.iter().enumerate() {
            let [again, alone] = [true, false].map(|reuse| rendered(&job(scene, seed, reuse)));
            assert_eq!(again.film, alone.film, "scene {index}");
            assert_eq!((again.counts, again.notes), (alone.counts, alone.notes), "scene {index}");
            assert!(again.build_seconds > 0.0);
        }
    }
}

#[test]
fn a_plain_world_is_not_that_of_a_frame() {
    let scene = scene(SCENE);
    let rays: Vec<Ray> = (0..200)
        .map(|n| Ray {
            direction: glam::Vec3::new(0.01 * (n - 100) as f32, -0.2, -1.0),
            ..Ray::new(scene.camera.position, glam::Vec3::NEG_Z)
        })
        .collect();
    rendered(&job(&scene, 0, true));
    let kit = solutions::kit();
    let [alone, first, again] =
        [false, true, true].map(|reuse| kit.first_hits(&job(&scene, 0, reuse), &rays));
    assert!(alone.iter().flatten().count() > 50);
    assert_eq!(first, alone);
    assert_eq!(again, alone);
}
