//! Indirect light in frames: the pictures of scenes whose light is known, both techniques against each other, and what is
//! traced and looked up.

use crate::scene::{assert_counted, job, render, rendered, scene, traced};
use glam::{DVec3, Vec3};
use raykata::film::Film;
use raykata::kit::{RayKind, RenderJob, Rendering, TracedRay};
use raykata::material::{Texture, Wrap};
use raykata::scene::{Background, EnvironmentMap, NextEvent, Scene};
use std::sync::Arc;

/// A small picture with indirect light, with what `rest` adds.
fn indirect(environment: &str, rest: &str) -> Scene {
    let mut scene = scene(&format!(
        "[film]\nwidth = 24\nheight = 18\n\
         [camera]\nposition = [0.1, 0.4, 4]\nlook_at = [0, 0, 0]\n\
         [environment]\nindirect_light = true\n{environment}\n{rest}"
    ));
    scene.quality.samples_per_pixel = 16;
    scene
}

/// The mean of all channels of all pixels and its standard error, from the differences between pixels, which have independent
/// random numbers. So the error is at least that of the mean, in every picture.
fn mean(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let n = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / n;
    let variance = values.map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0);
    (mean, (variance / n).sqrt())
}

fn channels(film: &Film) -> impl Iterator<Item = f64> + Clone {
    film.pixels.iter().map(|pixel| f64::from(pixel.element_sum()) / 3.0)
}

/// The largest score of a test with a false alarm in 10 million, for a normal distribution. The random numbers are fixed, so
/// each test passes always or never.
const LARGEST_SCORE: f64 = 5.33;

/// A closed room, with a sphere and a box in it. All surfaces have albedo 1/2 and emit 1/4: L = 1/2.
fn furnace() -> Scene {
    indirect(
        "ambient = 3",
        "[materials.default]\ndiffuse = 0.5\nemission = 0.25\n\
         [[nodes]]\nshape = { box = { min = [-3, -2, -5], max = [3, 2, 5] } }\n\
         [[nodes]]\nshape = { sphere = { center = [-1, 0, -0.5], radius = 0.8 } }\n\
         [[nodes]]\nshape = { box = { min = [-0.5, -0.5, -0.5], max = [0.5, 0.5, 0.5] } }\n\
         transform = [{ rotate = { axis = [1, 1, 0], degrees = 40 } }, { translate = [1, 0, -0.5] }]\n",
    )
}

#[test]
fn a_furnace_has_the_light_of_all_bounces() {
    for (depth, next_event, brightness) in [
        (0, NextEvent::On, 1.0),
        (1, NextEvent::On, 1.0),
        (2, NextEvent::Off, 1.0),
        (3, NextEvent::On, 1.0),
        (3, NextEvent::Only, 1.0),
        // Light of any brightness that single precision holds, with room for sums and for the ratio of densities.
        (3, NextEvent::Only, 1e35),
        (3, NextEvent::Only, 1e-25),
        (3, NextEvent::On, 1e35),
        (3, NextEvent::On, 1e-30),
        (6, NextEvent::Off, 1.0),
        (12, NextEvent::On, 1.0),
    ] {
        let mut scene = furnace();
        let quality = &mut scene.quality;
        (quality.max_depth, quality.next_event) = (depth, next_event);
        scene.materials[0].emission *= brightness;
        let rendering = render(&scene);
        let expected = 0.5 * (1.0 - 0.5f64.powi(depth as i32 + 1));
        let (mean, error) = mean(channels(&rendering.film).map(|light| light / f64::from(brightness)));
        let case = format!("{mean} ± {error} and not {expected}: {:?}", (depth, next_event, brightness));
        // A rounding of each of the bounces can add up where there is no noise.
        assert!((mean - expected).abs() <= LARGEST_SCORE * error + 1e-6, "{case}");
        let counts = rendering.counts;
        assert_eq!(counts.shadow > 0, next_event != NextEvent::Off && depth > 0, "{case}");
        assert_eq!(counts.absorbed > 0, depth >= 3, "{case}");
        assert!(counts.indirect <= u64::from(depth) * counts.primary, "{case}");
    }
}

#[test]
fn a_white_thing_under_a_white_sky_cannot_be_seen() {
    // Every path is exactly 1: a weight of 1 never plays roulette. Two spheres and a box make a concave thing. A coat
    // reflects a part of the light, and the paint below it the rest.
    for coat in [1.0, 1.5] {
        let mut scene = indirect(
            "background = 1",
            "[materials.default]\ndiffuse = 1\n\
             [[nodes]]\nshape = { sphere = { center = [-0.5, 0, 0], radius = 0.8 } }\n\
             [[nodes]]\nshape = { sphere = { center = [0.7, 0, 0.3], radius = 0.8 } }\n\
             [[nodes]]\nshape = { box = { min = [-2, -1.2, -1], max = [2, -0.8, 1] } }\n",
        );
        scene.materials[0].coat = coat;
        scene.quality.max_depth = 1000;
        let Rendering { counts, film, .. } = render(&scene);
        assert!(counts.indirect > counts.primary / 4 && counts.absorbed == 0);
        assert_eq!(counts.reflection > counts.primary / 100, coat != 1.0);
        for pixel in film.pixels {
            assert!((pixel - 1.0).abs().max_element() < 1e-5, "{pixel}, coat {coat}");
        }
    }
}

/// A floor, a wall and a sphere under an emitter of this shape.
fn lit_by(shape: &str, rest: &str) -> Scene {
    indirect(
        "",
        &format!(
            "[materials.glow]\ndiffuse = 0.2\nemission = [3, 2, 1]\n[materials.mirror]\ndiffuse = 0.2\nmirror = 0.6\n\
             [meshes.cube]\nfile = \"meshes/cube.obj\"\n\
             [[nodes]]\nshape = {{ plane = {{ point = [0, -1, 0], normal = [0, 1, 0] }} }}\n\
             [[nodes]]\nshape = {{ plane = {{ point = [0, 0, -2], normal = [0, 0, 1] }} }}\n\
             [[nodes]]\nmaterial = \"mirror\"\nshape = {{ sphere = {{ center = [-1, -0.4, 0], radius = 0.6 }} }}\n\
             [[nodes]]\nname = \"emitter\"\nmaterial = \"glow\"\nshape = {{ {shape} }}\n{rest}\n"
        ),
    )
}

/// The environment map with a bright patch and dark rest.
fn bright_patch() -> (Texture, EnvironmentMap) {
    let pixel = |index: u32| match (index % 16, index / 16) {
        (9..12, 1..3) => Vec3::new(8.0, 6.0, 3.0),
        (_, row) => Vec3::splat(0.05 * (8 - row) as f32),
    };
    let pixels = Arc::new((0..128).map(pixel).collect());
    let texture = Texture { width: 16, height: 8, pixels, wrap: Wrap::Repeat };
    (texture, EnvironmentMap { texture: 0, rotation: 0.4, scale: 1.5 })
}

/// With samples of emitters, without them and with samples alone the means agree: light that both techniques find counts once.
#[track_caller]
fn techniques_agree(scene: &Scene, case: &str) {
    let film = |next_event: NextEvent| {
        let mut scene = scene.clone();
        (scene.quality.next_event, scene.quality.samples_per_pixel) = (next_event, 256);
        render(&scene).film
    };
    let without = film(NextEvent::Off);
    let (brightness, _) = mean(channels(&without));
    for next_event in [NextEvent::On, NextEvent::Only] {
        let with = film(next_event);
        let differences: Vec<f64> = channels(&with).zip(channels(&without)).map(|(a, b)| a - b).collect();
        let (difference, error) = mean(differences.iter().copied());
        let case = format!("of {brightness}: {case}, {next_event:?}");
        assert!(difference.abs() <= LARGEST_SCORE * error, "{difference} ± {error} {case}");
        // The test is sharp: it sees 8 % of the light.
        assert!(LARGEST_SCORE * error < 0.08 * brightness, "± {error} {case}");
    }
}

#[test]
fn emitters_of_every_shape_count_once() {
    for (shape, rest) in [
        ("sphere = { center = [0.8, 0.6, 0], radius = 0.5 }", ""),
        ("sphere = { center = [0.8, 0.6, 0], radius = 0.5 }", "transform = [{ scale = [1.2, 0.7, 1] }]"),
        ("triangle = { a = [0, 1, -1], b = [2, 1, -1], c = [1, 0.6, 1] }", ""),
        (
            "box = { min = [0.3, 0, -0.5], max = [1.3, 0.6, 0.3] }",
            "transform = [{ rotate = { axis = [1, 2, 3], degrees = 20 } }]",
        ),
        (
            "polygon = { corners = [[0, 0.9, -1], [1.5, 0.9, -1], [1.8, 0.9, 0], [1, 0.9, 1], [0, 0.9, 0.5]] }",
            "",
        ),
        ("polygon = { corners = [[0, 1, -1], [1.5, 1, -1], [1.5, 0.8, 1], [0, 0.8, 1]] }", ""),
        ("disk = { center = [0.8, 0.8, 0], normal = [0, 1, 0.3], radius = 0.8 }", ""),
        ("mesh = \"cube\"", "transform = [{ scale = [0.5, -0.4, 0.5] }, { translate = [0.8, 0.6, 0] }]"),
        (
            "mesh = \"cube\"",
            "transform = [{ scale = 0.4 }, { translate = [0.9, 0.6, 0] }]\n[[nodes]]\nchildren = [\"emitter\"]\n\
             [[nodes]]\nchildren = [\"emitter\"]\ntransform = [{ scale = [-1, 1, 1] }, { translate = [-0.3, 0.5, -0.6] }]",
        ),
    ] {
        techniques_agree(&lit_by(shape, rest), &format!("{shape} {rest}"));
    }
}

#[test]
fn light_in_rough_mirrors_counts_once() {
    let (texture, map) = bright_patch();
    for roughness in [0.1, 0.4, 1.0] {
        let mut scene = lit_by("sphere = { center = [0.8, 0.6, 0], radius = 0.5 }", "");
        for material in scene.materials.iter_mut().filter(|material| material.mirror != Vec3::ZERO) {
            // One without a diffuse lobe, beside the one that has both.
            material.roughness = roughness;
            material.diffuse = if roughness == 0.4 { Vec3::ZERO } else { material.diffuse };
        }
        techniques_agree(&scene, &format!("a sphere and roughness {roughness}"));
        scene.textures.push(texture.clone());
        scene.background = Background::Map(map);
        techniques_agree(&scene, &format!("a map, a sphere and roughness {roughness}"));
    }
}

#[test]
fn both_techniques_have_less_noise_in_rough_mirrors_than_either() {
    // A rough mirror and a large light near it, for which reflected rays are best, and a small light, for which samples are.
    let scene = indirect(
        "",
        "[materials.mirror]\ndiffuse = [0.01, 0.01, 0.01]\nmirror = 0.9\nroughness = 0.08\n\
         [materials.large]\ndiffuse = 0\nemission = 1\n[materials.small]\ndiffuse = 0\nemission = 100\n\
         [[nodes]]\nmaterial = \"mirror\"\nshape = { plane = { point = [0, -1, 0], normal = [0, 1, 0.3] } }\n\
         [[nodes]]\nmaterial = \"large\"\nshape = { sphere = { center = [-1.6, 0.3, -1], radius = 1.2 } }\n\
         [[nodes]]\nmaterial = \"small\"\nshape = { sphere = { center = [1.6, 0.5, -1], radius = 0.04 } }\n",
    );
    let film = |next_event: NextEvent, seed: u64, samples: u32| {
        let mut scene = scene.clone();
        let quality = &mut scene.quality;
        (quality.next_event, quality.max_depth, quality.samples_per_pixel) = (next_event, 1, samples);
        rendered(&RenderJob { seed, ..job(&scene) }).film
    };
    let right = film(NextEvent::On, 1, 4096);
    let error = |next_event| {
        let film = film(next_event, 2, 16);
        let squares = film.pixels.iter().zip(&right.pixels).map(|(a, b)| (*a - *b).length_squared());
        squares.map(f64::from).sum::<f64>()
    };
    let [both, chance, samples] = [NextEvent::On, NextEvent::Off, NextEvent::Only].map(error);
    assert!(both < chance && both < samples, "{both}, by chance {chance}, by samples {samples}");
}

#[test]
fn an_environment_map_and_an_emitter_count_once() {
    let (texture, map) = bright_patch();
    let mut with_both = lit_by("sphere = { center = [0.8, 0.6, 0], radius = 0.4 }", "");
    with_both.textures.push(texture);
    with_both.background = Background::Map(map);
    techniques_agree(&with_both, "map and sphere");
    let mut alone = with_both.clone();
    alone.materials.iter_mut().for_each(|material| material.emission = Vec3::ZERO);
    techniques_agree(&alone, "map");
}

#[test]
fn an_even_environment_map_lights_a_convex_thing_evenly() {
    // A diffuse sphere of albedo 1/2 under light of radiance 1 from all sides sends 1/2 back.
    let mut scene = indirect(
        "",
        "[materials.default]\ndiffuse = 0.5\n[[nodes]]\nshape = { sphere = { center = [0, 0, 0], radius = 1 } }\n",
    );
    let pixels = Arc::new(vec![Vec3::ONE; 128]);
    scene.textures.push(Texture { width: 16, height: 8, pixels, wrap: Wrap::Repeat });
    scene.background = Background::Map(EnvironmentMap { texture: 0, rotation: 0.0, scale: 1.0 });
    let film = render(&scene).film;
    let on_sphere: Vec<f64> = channels(&film).filter(|&value| value < 0.9).collect();
    assert!(on_sphere.len() > 100 && channels(&film).any(|value| value == 1.0));
    // A pixel at the rim is part sphere, part sky.
    let inside: Vec<f64> = on_sphere.into_iter().filter(|&value| value < 0.7).collect();
    let (mean, error) = mean(inside.iter().copied());
    assert!((mean - 0.5).abs() <= LARGEST_SCORE * error, "{mean} ± {error}");
}

#[test]
fn lights_light_as_without_indirect_light_and_ambient_light_is_not_added() {
    // One plane cannot light itself: the picture is that of direct light, bit for bit, and the paths find nothing else.
    for visible in [false, true] {
        let mut with = indirect(
            "ambient = 0.5",
            &format!(
                "[[lights]]\narea = {{ sphere = {{ center = [1, 1, 0], radius = 0.4 }}, falloff = \"inverse_square\" }}\n\
                 intensity = 2\nvisible = {visible}\n\
                 [[nodes]]\nshape = {{ plane = {{ point = [0, -1, 0], normal = [0, 1, 0] }} }}\n"
            ),
        );
        (with.quality.samples_per_pixel, with.quality.light_samples) = (4, 2);
        let mut without = with.clone();
        (without.indirect_light, without.ambient) = (false, Vec3::ZERO);
        let [with, without] = [with, without].map(|scene| render(&scene));
        assert!(with.counts.indirect > 0 && without.counts.indirect == 0);
        assert_eq!(with.film, without.film, "visible = {visible}");
    }
}

#[test]
fn a_scene_without_light_or_without_a_diffuse_surface_traces_no_diffuse_ray() {
    let shapes = "[[nodes]]\nshape = { sphere = { center = [0, 0, 0], radius = 1 } }\n";
    for (environment, rest) in [
        ("ambient = 1", shapes.to_owned()),
        ("background = 1", format!("[materials.default]\ndiffuse = 0\nmirror = 0.5\n{shapes}")),
        ("background = 1", format!("[quality]\nmax_depth = 0\n{shapes}")),
    ] {
        let with = indirect(environment, &rest);
        let mut without = with.clone();
        (without.indirect_light, without.ambient) = (false, Vec3::ZERO);
        let [with, without] = [with, without].map(|scene| render(&scene));
        assert_eq!((with.film, with.counts), (without.film, without.counts), "{environment} {rest}");
    }
}

/// A scene with everything: textures, glass, a rough mirror, a lens, a shutter, a moving emitter, an instance and lights.
fn everything() -> Scene {
    let (texture, map) = bright_patch();
    let mut scene = scene(
        "[film]\nwidth = 40\nheight = 30\n\
         [camera]\nposition = [0, 1, 5]\nlook_at = [0, 0, 0]\nlens = { aperture = 0.1, focal_distance = 5 }\n\
         shutter = { open = 0, close = 1 }\n[environment]\nindirect_light = true\n\
         [quality]\nsamples_per_pixel = 4\nmax_depth = 7\n\
         [textures.tiles]\nfile = \"images/tiles.png\"\n[materials.floor]\ndiffuse = 0.8\ntexture = \"tiles\"\n\
         [materials.glass]\ndiffuse = 0\ntransmission = 0.95\nindex_of_refraction = 1.5\nfresnel = \"exact\"\n\
         [materials.brass]\ndiffuse = 0.1\nmirror = [0.7, 0.6, 0.3]\nroughness = 0.08\n\
         [materials.glow]\nemission = [2, 3, 4]\n[meshes.vase]\nfile = \"meshes/vase.ply\"\nsmooth = true\n\
         [[lights]]\npoint = { position = [2, 4, 3] }\nintensity = 0.4\n\
         [[lights]]\narea = { sphere = { center = [-2, 3, 1], radius = 0.3 } }\nintensity = 0.3\nvisible = true\n\
         [[nodes]]\nmaterial = \"floor\"\nshape = { plane = { point = [0, -1, 0], normal = [0, 1, 0] } }\n\
         [[nodes]]\nmaterial = \"glass\"\nshape = { sphere = { center = [1, -0.3, 1], radius = 0.7 } }\n\
         [[nodes]]\nmaterial = \"brass\"\nshape = { sphere = { center = [-1, -0.3, 0.6], radius = 0.7 } }\n\
         [[nodes]]\nname = \"vase\"\nshape = { mesh = \"vase\" }\ntransform = [{ scale = 0.6 }, { translate = [0, -1, -0.5] }]\n\
         [[nodes]]\nchildren = [\"vase\"]\ntransform = [{ translate = [1.5, 0, -0.5] }]\n\
         [[nodes]]\nmaterial = \"glow\"\nshape = { sphere = { center = [0, 1.2, 0], radius = 0.2 } }\n\
         transform_end = [{ translate = [0.5, 0, 0] }]\n\
         [[nodes]]\nmaterial = \"glow\"\nshape = { box = { min = [-1.6, 0.9, -0.4], max = [-1.2, 1.2, 0] } }\n",
    );
    scene.background = Background::Map(EnvironmentMap { texture: scene.textures.len(), ..map });
    scene.textures.push(texture);
    scene
}

#[test]
fn threads_change_no_pixel_and_no_count_of_indirect_light() {
    let frame = |threads: usize| {
        let rendering = rendered(&RenderJob { threads, ..job(&everything()) });
        (rendering.film, rendering.counts)
    };
    let one = frame(1);
    assert!(one.0.pixels.iter().all(|pixel| pixel.is_finite() && pixel.min_element() >= 0.0));
    for threads in [2, 3, 5] {
        assert_eq!(frame(threads), one, "{threads} threads");
    }
}

#[test]
fn the_counts_of_paths_are_those_of_their_rays() {
    let mut scene = everything();
    scene.quality.samples_per_pixel = 1;
    let job = job(&scene);
    let counts = rendered(&job).counts;
    let paths = traced(&job);
    assert_counted(&counts, &paths, "everything");
    assert!(counts.indirect > 0 && counts.reflection > 0 && counts.transmission > 0 && counts.absorbed > 0);
    for path in &paths {
        // One ray per bounce, and at each hit at most one shadow ray beside those to the two lights.
        let rays: Vec<&TracedRay> = path.iter().filter(|ray| ray.kind != RayKind::Shadow).collect();
        assert!(rays.len() <= 8 && rays.iter().enumerate().all(|(bounce, ray)| ray.depth == bounce as u32));
        for (index, ray) in path.iter().enumerate().filter(|(_, ray)| ray.kind != RayKind::Shadow) {
            let shadows = path.iter().filter(|one| one.kind == RayKind::Shadow && one.parent == Some(index));
            let most = if ray.depth < 7 { 3 } else { 2 };
            assert!(shadows.count() <= most, "{ray:?}");
        }
    }
}

#[test]
fn the_limit_of_samples_darkens_only_what_is_brighter() {
    let mut scene = lit_by("sphere = { center = [0.8, 0.6, 0], radius = 0.5 }", "");
    scene.quality.samples_per_pixel = 1;
    let free = render(&scene);
    scene.quality.clamp = 0.4;
    let limited = render(&scene);
    assert_eq!(free.counts, limited.counts);
    let (mut darker, mut same) = (0, 0);
    for (free, limited) in free.film.pixels.iter().zip(&limited.film.pixels) {
        let wanted = free.max_element().max(0.4);
        assert!((*limited - 0.4 / wanted * *free).abs().max_element() < 1e-6, "{free} {limited}");
        if free == limited { same += 1 } else { darker += 1 }
    }
    assert!(darker > 20 && same > 20, "{darker} {same}");
}

#[test]
fn the_light_of_a_corner_under_a_sky_is_that_of_its_closed_form() {
    // Two endless planes at a right angle: each point sees the other plane in half of its directions, weighted by the cosine,
    // so B = kd (L/2 + B/2), and B = kd L / (2 - kd).
    let (kd, sky) = (0.6, DVec3::new(1.0, 0.5, 0.25));
    let mut scene = indirect(
        "background = [1, 0.5, 0.25]",
        &format!(
            "[materials.default]\ndiffuse = {kd}\n\
             [[nodes]]\nshape = {{ plane = {{ point = [0, -1, 0], normal = [0, 1, 0] }} }}\n\
             [[nodes]]\nshape = {{ plane = {{ point = [0, 0, -1], normal = [0, 0, 1] }} }}\n"
        ),
    );
    (scene.quality.max_depth, scene.quality.samples_per_pixel) = (60, 64);
    scene.camera.position = Vec3::new(0.0, 0.0, 1.0);
    let film = render(&scene).film;
    for channel in 0..3 {
        let expected = kd * sky[channel] / (2.0 - kd);
        let (mean, error) = mean(film.pixels.iter().map(|pixel| f64::from(pixel[channel])));
        assert!((mean - expected).abs() <= LARGEST_SCORE * error, "{mean} ± {error}, {expected}");
    }
}
