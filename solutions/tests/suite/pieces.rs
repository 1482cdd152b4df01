//! A picture that is rendered in pieces, each by itself, is equal to the picture that is rendered at once: each pixel to the
//! last bit, and the counts of the pieces add up to those of the whole.

use crate::scene::{job, rendered, scene};
use raykata::count::Counts;
use raykata::kit::{RenderJob, Rendering};
use raykata::rows::Rows;
use raykata::scene::{Accelerator, Scene};

/// Every effect that looks up random numbers, and a height that is no multiple of the tiles.
const EFFECTS: &str = r#"
film = { width = 36, height = 70 }
[quality]
samples_per_pixel = 4
[camera]
position = [0, 2, 6]
look_at = [0, 1, 0]
lens = { aperture = 0.2, focal_distance = 6 }
shutter = { open = 0, close = 1 }
[environment]
background = 0.3
ambient = 0.1
[[lights]]
area = { rectangle = { corner = [-1, 4, -1], edges = [[2, 0, 0], [0, 0, 2]] } }
[materials.rough]
diffuse = 0.2
specular = 0.3
mirror = 0.6
roughness = 0.2
[materials.glass]
transmission = 0.9
index_of_refraction = 1.5
[[nodes]]
shape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }
[[nodes]]
shape = { sphere = { center = [-1, 1, 0], radius = 1 } }
material = "rough"
[[nodes]]
shape = { sphere = { center = [1, 1, 1], radius = 0.7 } }
material = "glass"
[[nodes]]
shape = { sphere = { center = [0, 2.2, -1], radius = 0.5 } }
transform_end = [{ translate = [0.4, 0, 0] }]
"#;

fn render(scene: &Scene, rows: Option<Rows>) -> Rendering {
    let mut scene = scene.clone();
    scene.film.rows = rows;
    rendered(&RenderJob { threads: 0, ..job(&scene) })
}

fn bits(rendering: &Rendering) -> Vec<[u32; 3]> {
    rendering.film.pixels.iter().map(|pixel| pixel.to_array().map(f32::to_bits)).collect()
}

/// Renders the scene at once and in each of several divisions.
#[track_caller]
fn check(scene: &Scene, what: &str) {
    let whole = render(scene, None);
    let height = scene.film.height;
    for n in [1, 2, 3, u32::MAX] {
        let mut counts = Counts::default();
        let mut pixels = Vec::new();
        for rows in Rows::divide(height, n) {
            let piece = render(scene, Some(rows));
            assert_eq!((piece.film.width, piece.film.height), (scene.film.width, rows.n_rows()));
            assert_eq!(piece.notes, whole.notes, "{what}");
            counts += piece.counts;
            pixels.extend(bits(&piece));
        }
        assert!(pixels == bits(&whole), "{what}: {n} pieces make another picture");
        assert_eq!(counts, whole.counts, "{what}: {n} pieces");
    }
}

#[test]
fn pieces_make_the_whole_picture_for_every_structure() {
    let mut scene = scene(EFFECTS);
    // Some of these keep what the previous ray has hit, or search for several rays at once.
    for accelerator in Accelerator::ALL {
        scene.quality.accelerator = accelerator;
        check(&scene, accelerator.name());
    }
}

#[test]
fn pieces_make_the_whole_picture_with_indirect_light() {
    let mut scene = scene(EFFECTS);
    scene.indirect_light = true;
    scene.film.height = 40;
    check(&scene, "indirect light");
}
