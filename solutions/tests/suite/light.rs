//! Light that rays see directly: surfaces that emit it, area lights that are visible, and the background.

use crate::scene::{render, scene};
use glam::Vec3;
use raykata::count::Counts;
use raykata::material::{Texture, Wrap};
use raykata::scene::{Background, EnvironmentMap, Gradient, Scene};
use std::sync::Arc;

/// The emission of the material `glow`.
const GLOW: Vec3 = Vec3::new(0.5, 0.25, 2.0);

/// A small black picture, with what `rest` adds.
fn dark(rest: &str) -> Scene {
    scene(&format!(
        "[film]\nwidth = 24\nheight = 18\n\
         [camera]\nposition = [0.1, 0.2, 6]\nlook_at = [0, 0, 0]\n\
         [materials.glow]\ndiffuse = 0\nemission = [0.5, 0.25, 2]\n{rest}"
    ))
}

#[test]
fn every_shape_shows_its_emission_and_nothing_else() {
    let patch = "[[-1, -1, 0], [0, -1, 1], [1, -1, 0], [2, -1, 0]], [[-1, 0, 0], [0, 0, 1], [1, 0, 0], [2, 0, 0]], \
                 [[-1, 1, 0], [0, 1, 1], [1, 1, 0], [2, 1, 0]], [[-1, 2, 0], [0, 2, 1], [1, 2, 0], [2, 2, 0]]";
    let shapes = [
        "sphere = { center = [0, 0, 0], radius = 1 }",
        "plane = { point = [0, 0, 0], normal = [0, 1, 1] }",
        "plane = { coefficients = [0, 1, 1, 0.5] }",
        "triangle = { a = [-1, -1, 0], b = [1, -1, 0], c = [0, 1, 0] }",
        "box = { min = [-1, -1, -1], max = [1, 1, 1] }",
        "cylinder = { base = [0, -1, 0], top = [0, 1, 0], radius = 1 }",
        "cone = { base = [0, -1, 0], apex = [0, 1, 0], radius = 1 }",
        "disk = { center = [0, 0, 0], normal = [0, 0.2, -1], radius = 1 }",
        "polygon = { corners = [[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]] }",
        "polygon = { corners = [[-1, -1, 0], [1, -1, 0], [0, 0, 0], [-1, 1, 0]] }",
        &format!("bezier = {{ rows = [{patch}], steps = 4 }}"),
        &format!("bspline = {{ rows = [{patch}], steps = 4 }}"),
        "mesh = \"vase\"",
    ];
    // Each shape alone, turned and stretched, and twice, so that a mesh is shared.
    let nodes = [
        "[[nodes]]\nmaterial = \"glow\"\nshape = { SHAPE }\n",
        "[[nodes]]\nmaterial = \"glow\"\nshape = { SHAPE }\ntransform = [{ scale = [1, 1.5, 1] }]\n",
        "[[nodes]]\nname = \"one\"\nshape = { SHAPE }\n\
         [[nodes]]\nmaterial = \"glow\"\nchildren = [\"one\"]\ntransform = [{ translate = [0.5, 0, 0] }]\n\
         [[nodes]]\nmaterial = \"glow\"\nchildren = [\"one\"]\ntransform = [{ translate = [-0.5, 0, 0] }]\n",
    ];
    for shape in shapes {
        for node in nodes {
            let mesh = "[meshes.vase]\nfile = \"meshes/vase.ply\"\n";
            let scene = dark(&format!("{mesh}{}", node.replace("SHAPE", shape)));
            let rendering = render(&scene);
            let bright = rendering.film.pixels.iter().filter(|pixel| **pixel == GLOW).count();
            let black = rendering.film.pixels.iter().filter(|pixel| **pixel == Vec3::ZERO).count();
            assert!(bright > 10 && bright + black == 24 * 18, "{bright} + {black} pixels of {shape}\n{node}");
            assert_eq!(rendering.counts.hits, bright as u64, "{shape}");
        }
    }
}

#[test]
fn mirror_glass_and_glossy_rays_see_emission_once_with_their_weight() {
    // The wall behind the camera glows. The disk in front of the camera reflects it; glass shows the other wall.
    let walls = "[[nodes]]\nmaterial = \"glow\"\nshape = { plane = { point = [0, 0, 9], normal = [0, 0, -1] } }\n\
                 [[nodes]]\nmaterial = \"glow\"\nshape = { plane = { point = [0, 0, -9], normal = [0, 0, 1] } }\n";
    let disk = "[[nodes]]\nmaterial = \"disk\"\nshape = { disk = { center = [0, 0, 0], normal = [0, 0, 1], radius = 9 } }\n";
    for (material, weight) in [
        ("mirror = 0.5", 0.5),
        ("mirror = [0.5, 0.5, 0.5]\nroughness = 0.2", 0.5),
        ("transmission = 0.25", 0.25),
        ("transmission = 0.25\nmirror = 0.5", 0.75),
        ("emission = [0.5, 0.25, 2]\nmirror = 0.5", 1.5),
    ] {
        let scene = dark(&format!("[materials.disk]\ndiffuse = 0\n{material}\n{walls}{disk}"));
        let film = render(&scene).film;
        for pixel in &film.pixels {
            assert!((*pixel - weight * GLOW).length() < 1e-5, "{pixel} with {material}");
        }
    }
}

#[test]
fn emission_costs_no_ray_and_no_random_number() {
    let rest = "[quality]\nsamples_per_pixel = 4\n[materials.glass]\ndiffuse = 0.3\ntransmission = 0.5\nmirror = 0.3\n\
                roughness = 0.1\n[[lights]]\narea = { sphere = { center = [3, 5, 4], radius = 1 } }\n\
                [[nodes]]\nmaterial = \"glow\"\nshape = { sphere = { center = [-1, 0, 0], radius = 1 } }\n\
                [[nodes]]\nmaterial = \"glass\"\nshape = { sphere = { center = [1, 0, 0], radius = 1 } }\n\
                [[nodes]]\nshape = { plane = { point = [0, -1, 0], normal = [0, 1, 0] } }\n";
    let mut scene = dark(rest);
    let with = render(&scene);
    scene.materials.iter_mut().for_each(|material| material.emission = Vec3::ZERO);
    let without = render(&scene);
    assert!(with.counts.shadow > 0 && with.counts.reflection > 0 && with.counts.random_numbers > 0);
    assert_eq!(with.counts, without.counts);
    assert_ne!(with.film, without.film);
    assert_ne!(with.counts, Counts::default());
}

/// A floor under an area light, the floor straight below, and the light seen in a mirror; `visible` is a line of the light.
fn under_a_light(area: &str, visible: &str) -> Scene {
    let mut scene = dark(&format!(
        "[materials.mirror]\ndiffuse = 0\nmirror = 0.5\n\
         [[lights]]\narea = {{ {area}, falloff = \"inverse_square\" }}\nintensity = 3\n{visible}\n\
         [[nodes]]\nshape = {{ plane = {{ point = [0, -2, 0], normal = [0, 1, 0] }} }}\n\
         [[nodes]]\nmaterial = \"mirror\"\nshape = {{ plane = {{ point = [0, 0, -5], normal = [0, 0, 1] }} }}\n\
         [quality]\nlight_samples = 4\n"
    ));
    (scene.film.width, scene.film.height) = (72, 54);
    scene
}

#[test]
fn a_visible_light_shows_its_radiance_and_blocks_none_of_its_own_light() {
    let areas = [
        ("sphere = { center = [1.2, 0.5, 0], radius = 0.5 }", 12.0),
        ("disk = { center = [1.2, 0.5, 0], normal = [0, 1, 3], radius = 0.5 }", 12.0),
        (
            "rectangle = { corner = [0.7, 0.2, 0], edges = [[1, 0, 0], [0, 0.5, 0.1]] }",
            3.0 * std::f32::consts::PI / 0.26f32.sqrt(),
        ),
    ];
    for (area, radiance) in areas {
        let scenes = ["", "visible = false", "visible = true"].map(|visible| under_a_light(area, visible));
        assert_eq!(scenes[0], scenes[1]);
        let [hidden, _, seen] = scenes.map(|scene| render(&scene));
        let (mut direct, mut mirrored, mut same) = (0, 0, 0);
        for (hidden, seen) in hidden.film.pixels.iter().zip(&seen.film.pixels) {
            match () {
                () if (*seen - radiance).abs().max_element() < 1e-4 * radiance => direct += 1,
                () if (*seen - 0.5 * radiance).abs().max_element() < 1e-4 * radiance => mirrored += 1,
                () => {
                    assert!((*seen - *hidden).abs().max_element() <= 1e-5, "{hidden} and {seen} of {area}");
                    same += 1;
                }
            }
        }
        assert!(direct >= 20 && mirrored >= 5 && same > 3000, "{direct}, {mirrored}, {same} of {area}");
    }
}

#[test]
fn a_sphere_that_shows_its_radiance_gives_its_light() {
    // Light from a sphere of radiance L and radius R, at distance d: L (R / d)² cos θ.
    let scene = dark(
        "[[lights]]\narea = { sphere = { center = [0, 3, 0], radius = 0.5 }, falloff = \"inverse_square\" }\n\
         intensity = 5\nvisible = true\n[materials.white]\ndiffuse = 1\n\
         [[nodes]]\nmaterial = \"white\"\nshape = { plane = { point = [0, 0, 0], normal = [0, 1, 0] } }\n",
    );
    let radiance = scene.materials.last().expect("the light").emission;
    assert_eq!(radiance, Vec3::splat(20.0));
    let mut below = scene.clone();
    below.camera.position = Vec3::new(0.0, 0.5, 0.0);
    (below.camera.towards, below.camera.right, below.camera.up) = (Vec3::NEG_Y, Vec3::X, Vec3::Z);
    (below.film.width, below.film.height, below.quality.light_samples) = (1, 1, 4096);
    // The mean over the cone of directions is that of a point in the centre up to (R / d)².
    let seen = render(&below).film.pixels[0];
    let expected = radiance * (0.5f32 / 3.0).powi(2);
    assert!((seen - expected).length() < 0.02 * expected.length(), "{seen}, and {expected} is expected");
}

/// A scene without lights in which everything that is seen is the background: behind, in a mirror on the left, and through
/// glass that does not bend light on the right.
fn only_background() -> Scene {
    let mut scene = dark(
        "[materials.mirror]\ndiffuse = 0\nmirror = 1\n[materials.glass]\ndiffuse = 0\ntransmission = 1\n\
         [[nodes]]\nmaterial = \"mirror\"\nshape = { sphere = { center = [-1.5, 0, 0], radius = 1 } }\n\
         [[nodes]]\nmaterial = \"glass\"\nshape = { sphere = { center = [1.5, 0, 0], radius = 1 } }\n",
    );
    (scene.film.width, scene.film.height) = (48, 36);
    scene
}

#[test]
fn every_ray_that_leaves_the_scene_sees_the_gradient() {
    let mut with = only_background();
    let gradient = Gradient { zenith: Vec3::X, horizon: Vec3::Y, nadir: Vec3::Z };
    with.background = Background::Gradient(gradient);
    let seen = render(&with);
    // The camera is a little above the middle: its rays look at their own elevation, and glass changes nothing.
    let camera = raykata::world::camera_for(&with);
    let (mut straight, mut reflected) = (0, 0);
    for row in 0..36 {
        for column in 0..48 {
            let ray = camera.ray((column as f32 + 0.5) / 48.0, (row as f32 + 0.5) / 36.0);
            let off = (seen.film.at(column, row) - gradient.color(ray.direction)).length();
            if off < 1e-3 { straight += 1 } else { reflected += 1 }
        }
    }
    assert!(reflected > 100 && straight > 1200, "{straight} and {reflected}");
    // Every pixel is a mixture of the three colours.
    assert!(seen.film.pixels.iter().all(|pixel| (pixel.element_sum() - 1.0).abs() < 1e-3));
    // A constant gradient is the colour, at the same cost.
    with.background = Background::Gradient(Gradient { zenith: GLOW, horizon: GLOW, nadir: GLOW });
    let constant = render(&with);
    with.background = Background::Color(GLOW);
    let color = render(&with);
    assert_eq!(constant.counts, color.counts);
    let same = |(p, q): (&Vec3, &Vec3)| (*p - *q).length() < 1e-5;
    assert!(constant.film.pixels.iter().zip(&color.film.pixels).all(same));
}

#[test]
fn every_ray_that_leaves_the_scene_sees_the_environment_map() {
    // The left half of the image is red, the right half green, and the rows get darker downwards.
    let mut with = only_background();
    let pixel = |index: u32| {
        let (column, row) = (index % 16, index / 16);
        (1.0 - row as f32 / 8.0) * if column < 8 { Vec3::X } else { Vec3::Y }
    };
    let pixels = Arc::new((0..128).map(pixel).collect());
    with.textures.push(Texture { width: 16, height: 8, pixels, wrap: Wrap::Repeat });
    with.background = Background::Map(EnvironmentMap { texture: 0, rotation: 0.0, scale: 2.0 });
    let seen = render(&with);
    // The middle of the image lies straight ahead: red is on the left, and the upper edge of the picture is brighter.
    let (left, right) = (seen.film.at(8, 1), seen.film.at(40, 1));
    assert!(left.x > 0.5 && left.y == 0.0 && right.y > 0.5 && right.x == 0.0, "{left} and {right}");
    assert!(seen.film.at(40, 34).y < right.y);
    assert!(seen.film.pixels.iter().all(|pixel| pixel.max_element() > 0.0 && pixel.z == 0.0));
    // One image read for each ray that hits nothing.
    let counts = &seen.counts;
    let rays = counts.primary + counts.reflection + counts.transmission;
    assert_eq!(counts.texture_reads, rays - counts.hits);
    // Half a turn exchanges the colours.
    with.background =
        Background::Map(EnvironmentMap { texture: 0, rotation: std::f32::consts::PI, scale: 1.0 });
    let turned = render(&with).film.at(8, 1);
    assert!((turned.y - 0.5 * left.x).abs() < 1e-3, "{turned} and {left}");
}
