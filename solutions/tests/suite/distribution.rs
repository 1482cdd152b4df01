//! Whole frames of the reference with distributed rays: an extent of 0 changes nothing, the focal plane is
//! sharp, half a visible light gives half the light, and every search finds moving shapes on any number of
//! threads.

use crate::scene::{differing, job, render, rendered, scene};
use glam::Vec3;
use raykata::camera::{Lens, Shutter};
use raykata::kit::RenderJob;
use raykata::scene::{Accelerator, Sampler, Scene};

const SAMPLERS: [Sampler; 5] =
    [Sampler::Center, Sampler::Random, Sampler::Jittered, Sampler::Gaussian, Sampler::LowDiscrepancy];

/// A scene with every distributed effect, over a floor with tiles.
fn full(samples: u32) -> Scene {
    scene(&format!(
        r#"
film = {{ width = 48, height = 30 }}
[camera]
position = [0, 2, 6]
look_at = [0, 0.8, 0]
lens = {{ aperture = 0.2, focal_distance = 6 }}
shutter = {{ open = 0.1, close = 0.9 }}
[environment]
background = 0.3
ambient = 0.1
[quality]
samples_per_pixel = {samples}
light_samples = 2
glossy_samples = 2
max_depth = 3
[textures.tiles]
file = "images/tiles.png"
[materials.floor]
texture = "tiles"
[materials.rough]
diffuse = 0.1
mirror = 0.7
roughness = 0.3
[materials.frosted]
diffuse = 0.1
transmission = 0.8
roughness = 0.2
[[lights]]
area = {{ rectangle = {{ corner = [-3, 5, 2], edges = [[1, 0, 0], [0, 0, 1]] }} }}
intensity = 0.5
[[lights]]
area = {{ disk = {{ center = [3, 4, 2], normal = [-1, -1, 0], radius = 0.5 }} }}
intensity = 0.3
[[lights]]
area = {{ sphere = {{ center = [0, 5, -2], radius = 0.5 }} }}
intensity = 0.2
[meshes.vase]
file = "meshes/vase.ply"
[[nodes]]
material = "floor"
shape = {{ plane = {{ point = [0, 0, 0], normal = [0, 1, 0] }} }}
transform_end = [{{ translate = [0.1, 0, 0] }}]
[[nodes]]
material = "rough"
shape = {{ sphere = {{ center = [-1.4, 0.8, 0], radius = 0.8 }} }}
[[nodes]]
material = "frosted"
shape = {{ sphere = {{ center = [0, 0.5, 1.5], radius = 0.5 }} }}
transform_end = [{{ translate = [0.6, 0.3, 0] }}]
[[nodes]]
shape = {{ mesh = "vase" }}
transform = [{{ scale = 0.7 }}, {{ translate = [1.4, 0, 0] }}]
transform_end = [{{ scale = 0.7 }}, {{ rotate = {{ axis = [0, 0, 1], degrees = 10 }} }}, {{ translate = [1.4, 0.2, 0] }}]
"#
    ))
}

#[test]
fn every_search_finds_what_moves_and_threads_change_nothing() {
    for sampler in SAMPLERS {
        let mut scene = full(3);
        scene.quality.sampler = sampler;
        let found = render(&scene);
        assert!(found.film.not_a_number() == 0 && found.counts.random_numbers > 0);
        for threads in [2, 5] {
            let other = rendered(&RenderJob { threads, ..job(&scene) });
            assert_eq!(
                (&other.film, other.counts),
                (&found.film, found.counts),
                "{sampler:?}, {threads} threads"
            );
        }
        scene.quality.accelerator = Accelerator::BruteForce;
        assert_eq!(render(&scene).film, found.film, "{sampler:?}: brute force finds other hits");
    }
}

#[test]
fn what_has_no_extent_changes_no_bit() {
    for sampler in SAMPLERS {
        let mut plain = full(4);
        plain.quality.sampler = sampler;
        (plain.camera.lens, plain.camera.shutter) = (None, None);
        plain.materials.iter_mut().for_each(|material| material.roughness = 0.0);
        let mut none = plain.clone();
        none.camera.lens = full(4).camera.lens.map(|lens| Lens { aperture: 0.0, ..lens });
        none.camera.shutter = Some(Shutter { open: 0.0, close: 0.0 });
        let (plain, none) = (render(&plain), render(&none));
        assert_eq!(plain.film, none.film, "{sampler:?}");
        assert_eq!(plain.counts, none.counts, "{sampler:?}");
    }
}

/// The points at `distance` along the view that the camera rays of a pixel reach, for many seeds.
fn on_plane(scene: &Scene, x: u32, y: u32, distance: f32) -> Vec<Vec3> {
    let place = |seed| {
        let ray = &solutions::kit().trace(&RenderJob { seed, ..job(scene) }, x, y)[0];
        let along = ray.direction.dot(scene.camera.towards);
        ray.origin
            + (distance - (ray.origin - scene.camera.position).dot(scene.camera.towards)) / along
                * ray.direction
    };
    (0..64).map(place).collect()
}

#[test]
fn what_lies_on_the_focal_plane_is_sharp_for_every_ray_of_the_lens() {
    let mut scene = full(1);
    scene.nodes.clear();
    scene.roots.clear();
    let spread = |scene: &Scene, distance: f32| {
        let places = on_plane(scene, 3, 27, distance);
        places.iter().map(|place| place.distance(places[0])).fold(0.0, f32::max)
    };
    // The rounding error of coordinates up to 6.
    assert!(spread(&scene, 6.0) < 4e-6, "{}", spread(&scene, 6.0));
    // At half the focal distance the circle of confusion is half as wide as the aperture, at twice the
    // distance as wide: about 0.2.
    assert!(spread(&scene, 3.0) > 0.05 && spread(&scene, 12.0) > 0.1);
    if let Some(lens) = &mut scene.camera.lens {
        lens.aperture = 0.0;
    }
    assert_eq!(spread(&scene, 6.0), 0.0);
}

#[test]
fn half_a_light_makes_half_a_shadow() {
    // Each pixel sees a point of the floor straight below. A wall occludes one half of the light for the
    // middle column.
    let light = |shape: &str| {
        scene(&format!(
            r#"
film = {{ width = 41, height = 1 }}
[camera]
position = [0, 1, 0]
direction = [0, -1, 0]
up = [0, 0, -1]
vertical_fov = 1
[quality]
samples_per_pixel = 4096
[materials.floor]
diffuse = 1
[[lights]]
area = {{ {shape} }}
[[nodes]]
material = "floor"
shape = {{ plane = {{ point = [0, 0, 0], normal = [0, 1, 0] }} }}
[[nodes]]
shape = {{ polygon = {{ corners = [[0, 5, -90], [90, 5, -90], [90, 5, 90], [0, 5, 90]] }} }}
"#
        ))
    };
    for shape in [
        "rectangle = { corner = [-1, 10, -1], edges = [[2, 0, 0], [0, 0, 2]] }",
        "disk = { center = [0, 10, 0], normal = [0, -1, 0], radius = 1 }",
        "sphere = { center = [0, 10, 0], radius = 1 }",
    ] {
        for sampler in SAMPLERS {
            let mut scene = light(shape);
            scene.quality.sampler = sampler;
            scene.film.width = 1;
            let shadowed = render(&scene).film.pixels[0].x;
            scene.nodes.pop();
            scene.roots.pop();
            let lit = render(&scene).film.pixels[0].x;
            // The standard deviation of one sample is at most 1/2, that of 4,096 random samples 1/128. Allow
            // four times that.
            assert!((shadowed / lit - 0.5).abs() < 4.0 / 128.0, "{shape}, {sampler:?}: {shadowed} of {lit}");
        }
    }
}

#[test]
fn a_moving_edge_is_blurred_evenly_over_the_time() {
    // A white wall slides over a black background: a pixel is as bright as the time for which the wall covers it.
    let mut scene = scene(
        r#"
film = { width = 16, height = 1 }
[camera]
position = [0, 0, 8]
look_at = [0, 0, 0]
vertical_fov = 14.25
shutter = { open = 0, close = 1 }
[environment]
ambient = 1
[quality]
samples_per_pixel = 4096
[materials.white]
diffuse = 1
[[nodes]]
material = "white"
shape = { polygon = { corners = [[-60, -9, 0], [-16, -9, 0], [-16, 9, 0], [-60, 9, 0]] } }
transform_end = [{ translate = [32, 0, 0] }]
"#,
    );
    for sampler in SAMPLERS {
        scene.quality.sampler = sampler;
        let film = render(&scene).film;
        for (column, pixel) in film.pixels.iter().enumerate() {
            // Pixels are 2 wide (16 of them from -16 to 16); the edge passes this one from start to end of 1/16.
            let expected = 1.0 - (column as f32 + 0.5) / 16.0;
            // Allow four times the standard deviation of random samples, at most 1/128; the Gaussian filter
            // reaches 1.5 pixels.
            assert!(
                (pixel.x - expected).abs() < 4.0 / 128.0,
                "{sampler:?}, column {column}: {pixel} {expected}"
            );
        }
    }
}

#[test]
fn a_shutter_that_does_not_open_shows_the_moment() {
    let mut moving = full(2);
    moving.camera.shutter = Some(Shutter { open: 0.5, close: 0.5 });
    let found = render(&moving);
    // Stop the motion: replace each transform by that of time 0.5.
    moving.nodes.iter_mut().for_each(|node| {
        node.transform = node.transform_at(0.5);
        node.transform_end = None;
    });
    let still = render(&moving);
    // Blended matrices and blended points differ by rounding errors, which may move a ray past an edge.
    assert!(differing(&found.film, &still.film, 0.01) * 100 <= found.film.pixels.len());
}
