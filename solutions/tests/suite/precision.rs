//! `precision = "double"` in whole frames: the same picture in easy scenes, and the correct one in hard scenes.

use crate::scene::{differing, render, scene, small};
use glam::{Vec3, vec3};
use oracle::exact::{Body, verdict};
use raykata::count::Counts;
use raykata::kit::Rendering;
use raykata::scene::{Accelerator, Precision, Scene, TriangleMethod};
use raykata::shape::{Shape, Sphere};
use raykata::world::camera_for;

fn in_precision(scene: &Scene, precision: Precision) -> Rendering {
    let mut scene = scene.clone();
    scene.quality.precision = precision;
    let frame = render(&scene);
    assert!(frame.notes.is_empty(), "{:?}", frame.notes);
    frame
}

/// The counts of rays and of tests.
fn work(counts: &Counts) -> [u64; 5] {
    [counts.rays(), counts.hits, counts.node_visits, counts.box_tests, counts.primitive_tests]
}

#[test]
fn more_digits_move_few_pixels_and_hardly_any_count() {
    for name in ["effects", "stage8", "stage5"] {
        let mut scene = small(name, 48, 32);
        let methods = [
            TriangleMethod::Watertight,
            TriangleMethod::Choice,
            TriangleMethod::Cramer,
            TriangleMethod::Gram,
        ];
        for method in methods {
            scene.quality.triangle_method = method;
            let [single, double] = [Precision::Single, Precision::Double].map(|p| in_precision(&scene, p));
            // Count pixels that show another surface, which happens at outlines, also behind glass.
            let other = differing(&single.film, &double.film, 0.01);
            assert!(other <= 8, "{name}, {method:?}: {other} of 1536 pixels differ");
            for (single, double) in work(&single.counts).into_iter().zip(work(&double.counts)) {
                assert!(single.abs_diff(double) <= single / 200, "{name}, {method:?}: {single} and {double}");
            }
        }
    }
}

/// A wall of two triangles per column in front of a bright background. The edges between columns run through
/// the centres of pixels from top to bottom.
fn wall() -> Scene {
    const COLUMNS: u32 = 40;
    let mut text = format!(
        "[film]\nwidth = {COLUMNS}\nheight = 30\n[camera]\nposition = [0.1, 0.2, 0.3]\nlook_at = [1.3, -0.4, 2.1]\n\
         [environment]\nbackground = 1\n"
    );
    let camera = camera_for(&scene(&text));
    let [below, above] = [1.0, 0.0].map(|y| {
        let corner = |column: u32| {
            let ray = camera.ray((column as f32 + 0.5) / COLUMNS as f32, y);
            ray.at(3.0 + (column as f32).sin())
        };
        (0..COLUMNS).map(corner).collect::<Vec<Vec3>>()
    });
    for (left, right) in (0..).zip(1..COLUMNS as usize) {
        // A corner with the barycentric coordinate γ on one side of an edge has 1 - β - γ on the other side.
        text += &triangle([below[left], above[left], below[right]]);
        text += &triangle([above[left], above[right], below[right]]);
    }
    scene(&text)
}

fn triangle(corners: [Vec3; 3]) -> String {
    let [a, b, c] = corners.map(|corner| format!("{:?}", corner.to_array()));
    format!("[[nodes]]\nshape = {{ triangle = {{ a = {a}, b = {b}, c = {c} }} }}\n")
}

#[test]
fn light_leaks_through_a_wall_in_single_precision_only() {
    let mut scene = wall();
    for method in [TriangleMethod::Cramer, TriangleMethod::Gram] {
        scene.quality.triangle_method = method;
        let leaks = |precision: Precision| {
            let frame = in_precision(&scene, precision);
            // Leave out the outermost columns and rows, where the wall ends.
            let inner = |index: usize| (1..39).contains(&(index % 40)) && (1..29).contains(&(index / 40));
            let lit = |(index, color): &(usize, &Vec3)| inner(*index) && **color != Vec3::ZERO;
            frame.film.pixels.iter().enumerate().filter(lit).count()
        };
        let single = leaks(Precision::Single);
        assert!(single >= 20, "{method:?}: {single} of 1064 pixels are lit");
        assert_eq!(leaks(Precision::Double), 0, "{method:?}");
    }
}

#[test]
fn the_rim_of_a_far_sphere_is_exact_in_double() {
    let text = r#"
film = { width = 48, height = 48 }
[camera]
position = [61234.5, 4321.25, -73456.75]
look_at = [0.3, 0.1, -0.2]
vertical_fov = 0.0014
[environment]
background = 1
[[nodes]]
shape = { sphere = { center = [0.3, 0.1, -0.2], radius = 1 } }
"#;
    let mut scene = scene(text);
    let (camera, sphere) = (camera_for(&scene), Sphere { center: vec3(0.3, 0.1, -0.2), radius: 1.0 });
    assert_eq!(scene.nodes[0].shape, Some(Shape::Sphere(sphere)));
    let wrong = |frame: &Rendering| {
        let pixel = |index: u32| [index % 48, index / 48].map(|place| (place as f32 + 0.5) / 48.0);
        let is_wrong = |index: &u32| {
            let [x, y] = pixel(*index);
            let hit =
                verdict(&camera.ray(x, y), Body::Sphere(sphere)).is_some_and(|verdict| verdict.is_hit());
            hit != (frame.film.pixels[*index as usize] == Vec3::ZERO)
        };
        (0..48 * 48).filter(is_wrong).count()
    };
    for accelerator in [Accelerator::BruteForce, Accelerator::Bvh] {
        scene.quality.accelerator = accelerator;
        let [single, double] =
            [Precision::Single, Precision::Double].map(|precision| wrong(&in_precision(&scene, precision)));
        assert!(single > 0, "{accelerator:?}");
        assert_eq!(double, 0, "{accelerator:?}");
    }
}

/// A floor of tiles with two triangles each, in steps along x: every third column is `rise` higher, and a riser stands before it.
fn tiles(rise: f32) -> Scene {
    const SIDE: i32 = 12;
    let mut text = "[film]\nwidth = 64\nheight = 48\n[camera]\nposition = [4.3, 7.1, -5.9]\nlook_at = [6, 1, 6]\n\
                    [environment]\nbackground = 0.5\nindirect_light = true\n[quality]\nsamples_per_pixel = 4\n\
                    [[lights]]\ndirectional = { direction = [1, -3, 2] }\nintensity = 2\n"
        .to_owned();
    let mut square = |[a, b, c, d]: [Vec3; 4]| text += &(triangle([a, b, c]) + &triangle([a, c, d]));
    let height = |column: i32| rise * (column / 3) as f32;
    for (column, row) in (0..SIDE).flat_map(|column| (0..SIDE).map(move |row| (column, row))) {
        let (x, z, y) = (column as f32, row as f32, height(column));
        square([vec3(x, y, z), vec3(x, y, z + 1.0), vec3(x + 1.0, y, z + 1.0), vec3(x + 1.0, y, z)]);
        let below = height(column - 1);
        if below != y {
            square([vec3(x, below, z), vec3(x, below, z + 1.0), vec3(x, y, z + 1.0), vec3(x, y, z)]);
        }
    }
    scene(&text)
}

#[test]
fn exact_arithmetic_is_rare() {
    let mut room = small("cornell", 64, 64);
    room.quality.samples_per_pixel = 4;
    for (name, scene) in [("room", room), ("grid", tiles(0.0)), ("terrace", tiles(0.25))] {
        let counts = in_precision(&scene, Precision::Single).counts;
        // Some rays graze a tile or meet an edge.
        let per_ray = counts.exact_tests as f64 / counts.rays() as f64;
        assert!(per_ray < 0.01, "{name}: {per_ray} exact tests per ray");
    }
}
