//! Filtered images: what the cone of a ray covers is what many rays see, and the reads are counted.

use crate::scene::{render, scene};
use glam::Vec3;
use raykata::film::Film;
use raykata::material::{Texture, Wrap};
use raykata::scene::{Scene, TextureFilter};
use std::sync::Arc;

/// A scene with a checkerboard of 64 by 64 fields, each of 4 by 4 pixels, on the shape of `node`.
fn checkered(node: &str) -> Scene {
    let mut scene = scene(&format!(
        "[film]\nwidth = 48\nheight = 36\n\
         [camera]\nposition = [0.3, 1, 0]\nlook_at = [0.3, 0.3, -4]\n\
         [environment]\nambient = 1\n\
         [materials.checkered]\ndiffuse = 1\ntexture = \"image\"\n\
         [textures.image]\nfile = \"images/tiles.png\"\n\
         [meshes.poster]\nfile = \"meshes/poster.obj\"\n{node}"
    ));
    let pixel = |index: u32| {
        let (column, row) = (index % 256 / 4, index / 256 / 4);
        Vec3::splat(((column + row) % 2) as f32)
    };
    let pixels = Arc::new((0..256 * 256).map(pixel).collect());
    scene.textures[0] = Texture { width: 256, height: 256, pixels, wrap: Wrap::Repeat };
    scene
}

/// The root of the mean squared difference of two pictures.
fn difference(one: &Film, other: &Film) -> f32 {
    let squares = one.pixels.iter().zip(&other.pixels).map(|(p, q)| (*p - *q).length_squared() / 3.0);
    (squares.sum::<f32>() / one.pixels.len() as f32).sqrt()
}

fn with(scene: &Scene, texture_filter: TextureFilter, samples_per_pixel: u32) -> Scene {
    let mut scene = scene.clone();
    scene.quality.texture_filter = texture_filter;
    scene.quality.samples_per_pixel = samples_per_pixel;
    scene
}

const FLOOR: &str =
    "[[nodes]]\nmaterial = \"checkered\"\nshape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }\n";

#[test]
fn a_filtered_image_shows_what_many_rays_see() {
    let shapes = [
        FLOOR,
        "[[nodes]]\nmaterial = \"checkered\"\n\
         shape = { triangle = { a = [-9, 0, 2], b = [9, 0, 2], c = [-9, 0, -30] } }\n",
        "[[nodes]]\nmaterial = \"checkered\"\nshape = { box = { min = [-5, -1, -20], max = [5, 0, -1] } }\n",
        "[[nodes]]\nmaterial = \"checkered\"\nshape = { sphere = { center = [0, 0, -6], radius = 1.5 } }\n",
        "[[nodes]]\nmaterial = \"checkered\"\nshape = { sphere = { center = [0, 0, 0], radius = 1 } }\n\
         transform = [{ scale = [1.5, 1, 1] }, { translate = [0, 0, -6] }]\n",
        // Two instances of one mesh.
        "[[nodes]]\nname = \"poster\"\nshape = { mesh = \"poster\" }\n\
         [[nodes]]\nmaterial = \"checkered\"\nchildren = [\"poster\"]\ntransform = [{ scale = 3 }, { translate = [-1, -1, -9] }]\n\
         [[nodes]]\nmaterial = \"checkered\"\nchildren = [\"poster\"]\ntransform = [{ scale = 3 }, \
         { rotate = { axis = [0, 1, 0], degrees = 70 } }, { translate = [1, -1, -9] }]\n",
        // A floor in a curved mirror.
        &format!(
            "[materials.mirror]\ndiffuse = 0\nmirror = 1\n{FLOOR}\
             [[nodes]]\nmaterial = \"mirror\"\nshape = {{ sphere = {{ center = [0, 1, -4], radius = 1 }} }}\n"
        ),
    ];
    for node in shapes {
        let scene = checkered(node);
        let many = render(&with(&scene, TextureFilter::Bilinear, 400)).film;
        // One ray per pixel sees black or white where many rays see grey.
        let [plain, filtered] = TextureFilter::NAMES.map(|(_, filter)| render(&with(&scene, filter, 1)));
        let [noise, rest] = [&plain, &filtered].map(|picture| difference(&picture.film, &many));
        println!("{noise:.3} {rest:.3} {} {}", plain.counts.texture_reads, filtered.counts.texture_reads);
        assert!(noise > 0.08 && rest < 0.5 * noise, "{noise} without and {rest} with a filter: {node}");
        // Reads are counted: one per hit that shows the image without a filter, up to 32 with one.
        let (before, after) = (plain.counts.texture_reads, filtered.counts.texture_reads);
        assert!(before < after && after <= 32 * before, "{before} and {after} reads: {node}");
        let rays = |counts: &raykata::count::Counts| (counts.rays(), counts.hits, counts.random_numbers);
        assert_eq!(rays(&plain.counts), rays(&filtered.counts));
    }
}

#[test]
fn an_image_that_is_seen_from_near_is_not_filtered() {
    // One pixel of the image covers several of the picture.
    let scene = checkered(
        "[[nodes]]\nmaterial = \"checkered\"\nshape = { plane = { point = [0, 0, -4], normal = [0, 0, 1] } }\n\
         transform = [{ scale = [99, 99, 1] }]\n",
    );
    let [plain, filtered] = TextureFilter::NAMES.map(|(_, filter)| render(&with(&scene, filter, 1)));
    assert_eq!(plain.film, filtered.film);
    assert_eq!(plain.counts, filtered.counts);
}

#[test]
fn a_scene_without_images_ignores_the_filter() {
    let mut scene = checkered("[[nodes]]\nshape = { sphere = { center = [0, 0, -6], radius = 1.5 } }\n");
    scene.materials.truncate(1);
    let [plain, filtered] = TextureFilter::NAMES.map(|(_, filter)| render(&with(&scene, filter, 1)));
    assert_eq!((plain.film, plain.counts), (filtered.film, filtered.counts));
}
