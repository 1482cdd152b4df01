//! Whole frames of the reference: the picture is the same for every search, no unnecessary ray is traced, and there is no
//! shadow acne at any size.

use crate::scene::{differing, job, render, render_by, rendered, scene};
use glam::Vec3;
use raykata::count::Counts;
use raykata::kit::{RenderJob, View};
use raykata::scene::{Accelerator, Quality, Scene, Split};

const VASES: &str = r#"
film = { width = 72, height = 54 }
camera = { position = [0, 2.4, 6], look_at = [0, 1, 0] }
[environment]
background = 0.3
ambient = 0.1
[[lights]]
point = { position = [4, 6, 5] }
[[lights]]
point = { position = [-4, 3, -5] }
color = [0.5, 0.7, 1]
[meshes.vase]
file = "meshes/vase.ply"
[[nodes]]
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[nodes]]
shape = { mesh = "vase" }
transform = [{ translate = [-1.2, 0, 0] }]
[[nodes]]
shape = { sphere = { center = [1.2, 1, 0], radius = 1 } }
"#;

#[test]
fn a_frame_up_to_a_stage_calls_no_later_function() {
    let render = |view| rendered(&RenderJob { view, ..job(&scene(VASES)) });
    assert_eq!(render(View::UpToStage(12)).film, render(View::Shaded).film);
    let shadow_rays = [3, 4].map(|stage| render(View::UpToStage(stage)).counts.shadow);
    assert!(shadow_rays[0] == 0 && shadow_rays[1] > 0, "{shadow_rays:?}");
}

#[test]
fn every_hierarchy_makes_the_picture_of_brute_force() {
    let mut scene = scene(VASES);
    let expected = render_by(&scene, Accelerator::BruteForce);
    for split in Split::ALL {
        for leaf_size in [1, 4, 16] {
            (scene.quality.split, scene.quality.leaf_size) = (split, leaf_size);
            let found = render_by(&scene, Accelerator::Bvh);
            assert_eq!(found.film, expected.film, "{split:?}, leaves of {leaf_size}");
            assert_eq!(rays(&found.counts), rays(&expected.counts));
            assert!(found.counts.primitive_tests * 20 < expected.counts.primitive_tests);
        }
    }
}

#[test]
fn a_scene_that_names_no_accelerator_gets_the_fastest_hierarchy_that_fits_it() {
    let mut scene = scene(VASES);
    assert_eq!(scene.quality.accelerator, Accelerator::Auto);
    let wide = render(&scene);
    assert_eq!(wide.accelerator, Some(Accelerator::WideBvh));
    // Only the builder of stage 3 has other splits and leaf sizes.
    scene.quality.split = Split::ObjectMedian;
    assert_eq!(render(&scene).accelerator, Some(Accelerator::Bvh));
    (scene.quality.split, scene.quality.leaf_size) = (Split::SurfaceArea, 2);
    assert_eq!(render(&scene).accelerator, Some(Accelerator::Bvh));
    // A structure that the scene names is used, and gives the same picture.
    scene = Scene { quality: Quality { accelerator: Accelerator::Bvh, ..Quality::default() }, ..scene };
    let binary = render(&scene);
    assert_eq!((binary.accelerator, binary.film), (Some(Accelerator::Bvh), wide.film));
    assert_eq!(rays(&binary.counts), rays(&wide.counts));
}

fn rays(counts: &Counts) -> (u64, u64) {
    (counts.primary, counts.shadow)
}

#[test]
fn counting_changes_no_pixel() {
    let scene = scene(VASES);
    let (counted, uncounted) = (render(&scene), rendered(&RenderJob { count: false, ..job(&scene) }));
    assert_eq!(counted.film, uncounted.film);
    assert_eq!(uncounted.counts, Counts::default());
}

#[test]
fn a_plain_scene_costs_one_ray_a_pixel_and_one_a_light_that_matters() {
    let scene = scene(
        r#"
film = { width = 40, height = 30 }
[camera]
position = [0, 5, 0]
direction = [0, -1, 0]
up = [0, 0, -1]
[[lights]]
point = { position = [0, 8, 3] }
[[lights]]
point = { position = [0, -3, 0] }
[[lights]]
point = { position = [3, 8, 3] }
intensity = 0
[[nodes]]
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
"#,
    );
    // Every pixel sees the floor. One light shines on it, one is below it, one has intensity 0.
    assert_eq!(rays(&render(&scene).counts), (1200, 1200));
}

#[test]
fn a_film_of_one_pixel_and_an_empty_scene_are_frames_too() {
    let mut scene =
        scene("[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n[environment]\nbackground = 0.25\n");
    (scene.film.width, scene.film.height) = (1, 1);
    let rendering = render(&scene);
    assert_eq!(rendering.film.pixels, [Vec3::splat(0.25)]);
    assert_eq!(rendering.counts, Counts { primary: 1, ..Counts::default() });
}

/// A floor and a wall in ambient light, with a sphere of this material before them.
fn sphere_of(material: &str) -> Scene {
    scene(&format!(
        r#"
film = {{ width = 60, height = 45 }}
camera = {{ position = [0, 1, 6], look_at = [0, 1, 0] }}
[environment]
background = [0.2, 0.4, 0.8]
ambient = 1
[materials.sphere]
diffuse = 0
{material}
[materials.wall]
diffuse = [0.7, 0.3, 0.1]
[[nodes]]
shape = {{ plane = {{ point = [0, 0, 0], normal = [0, 1, 0] }} }}
[[nodes]]
material = "wall"
shape = {{ box = {{ min = [-1, 0, -4], max = [0.3, 2, -3] }} }}
[[nodes]]
material = "sphere"
shape = {{ sphere = {{ center = [0, 1, 0], radius = 1 }} }}
"#
    ))
}

#[test]
fn glass_that_bends_nothing_is_not_seen() {
    let empty = {
        let mut scene = sphere_of("");
        scene.roots.pop();
        render(&scene)
    };
    let glass = render(&sphere_of("transmission = 1"));
    let off = differing(&empty.film, &glass.film, 5e-4);
    // At the surface of the sphere the ray is moved by a rounding error, which may change pixels at outlines
    // behind it.
    assert!(off <= 3, "{off} of 2700 pixels differ");
    assert_eq!(empty.counts.transmission, 0);
    assert!(glass.counts.transmission > 0 && glass.counts.reflection == 0);
}

#[test]
fn a_mirror_traces_one_ray_for_each_ray_that_meets_it() {
    let mirror = render(&sphere_of("mirror = 0.5"));
    let dull = render(&sphere_of("mirror = 0"));
    assert_eq!(dull.counts.reflection, 0);
    // No reflected ray hits the convex sphere again, so there are as many reflected rays as pixels that show
    // the sphere.
    assert_eq!(mirror.counts.reflection, differing(&mirror.film, &dull.film, 0.0) as u64);
}

#[test]
fn deeper_glass_adds_rays_up_to_the_depth_and_then_none() {
    let rays = |depth: u32| {
        let mut scene = sphere_of("transmission = 1\nindex_of_refraction = 1.5\nfresnel = \"exact\"");
        (scene.quality.max_depth, scene.quality.min_contribution) = (depth, 0.0);
        let counts = render(&scene).counts;
        counts.reflection + counts.transmission
    };
    assert_eq!(rays(0), 0);
    assert!(rays(1) < rays(2) && rays(2) < rays(3));
}
