//! Tests of `film`, `camera`, `environment` and `quality`.

use super::{CAMERA, check_refused, scene, scene as scene_from, scene_with};
use crate::camera::{Lens, Shutter};
use crate::files::scene::set;
use crate::film::{Tone, ToneCurve};
use crate::graph::GraphOptimisations;
use crate::partition::KdHeuristics;
use crate::scene::{
    Accelerator, Background, ColorPlace, Encoding, Field, FilmSettings, Gradient, GradientColor,
    MaterialColor, NextEvent, Precision, Quality, Sampler, SphereMethod, Split, TextureFilter,
    TriangleMethod,
};
use glam::Vec3;

#[test]
fn a_scene_of_only_a_camera_is_its_background() {
    let scene = scene_with("");
    assert_eq!(scene.film, FilmSettings::default());
    assert_eq!(scene.camera.position, Vec3::new(0.0, 0.0, 5.0));
    assert_eq!(scene.camera.towards, Vec3::NEG_Z);
    assert_eq!(scene.camera.aspect, 640.0 / 360.0);
    assert_eq!(scene.camera.half_height, 20f32.to_radians().tan());
    assert_eq!((scene.camera.lens, scene.camera.shutter), (None, None));
    assert_eq!(
        (scene.background, scene.ambient, scene.indirect_light),
        (Background::Color(Vec3::ZERO), Vec3::ZERO, false)
    );
    assert_eq!(scene.material_names, ["default"]);
    assert_eq!(scene.quality, Quality::default());
    assert!(scene.nodes.is_empty() && scene.roots.is_empty() && scene.lights.is_empty());
}

#[test]
fn every_setting_arrives() {
    let scene = scene(
        "[film]\nwidth = 0x20\nheight = 16\nencoding = 'gamma2'\nexposure = -1.5\ntone = 'aces'\n\
         [camera]\nposition = [1, 0, 0]\ndirection = [3, 0, 0]\nup = [0, 0, 2]\nvertical_fov = 90\n\
         lens = { aperture = 0.1, focal_distance = 5 }\nshutter = { open = 0.25 }\n\
         [environment]\nbackground = [0, 0.5, 2]\nambient = 0.25\nindirect_light = true\n\
         [quality]\nsamples_per_pixel = 9\nlight_samples = 8\nglossy_samples = 7\ntexture_filter = 'mipmap'\nmax_depth = 0\n\
         min_contribution = 0\nnext_event = 'only'\nclamp = 10\naccelerator = 'kd_tree'\nsplit = 'object_median'\nleaf_size = 1\ncopies = true\nsavings = { skip = false }\nkd_heuristics = { stop_at_overlap = false }\n\
         triangle_method = 'inside_by_areas'\nsphere_method = 'geometric'\ngrid_resolution = 3\nray_offset = 0.5\nlift_shadow_rays = true\n\
         sampler = 'jittered'\nprecision = 'double'\n",
    );
    let tone = Tone { exposure: -1.5, curve: ToneCurve::Aces };
    assert_eq!(
        scene.film,
        FilmSettings { width: 32, height: 16, encoding: Encoding::Gamma2, tone, rows: None }
    );
    assert_eq!((scene.camera.towards, scene.camera.up), (Vec3::X, Vec3::Z));
    assert_eq!((scene.camera.half_height, scene.camera.aspect), (1.0, 2.0));
    assert_eq!(scene.camera.lens, Some(Lens { aperture: 0.1, focal_distance: 5.0 }));
    assert_eq!(scene.camera.shutter, Some(Shutter { open: 0.25, close: 1.0 }));
    assert_eq!(scene.background, Background::Color(Vec3::new(0.0, 0.5, 2.0)));
    assert_eq!(scene.ambient, Vec3::splat(0.25));
    assert!(scene.indirect_light);
    let expected = Quality {
        samples_per_pixel: 9,
        sampler: Sampler::Jittered,
        light_samples: 8,
        glossy_samples: 7,
        texture_filter: TextureFilter::Mipmap,
        max_depth: 0,
        min_contribution: 0.0,
        next_event: NextEvent::Only,
        clamp: 10.0,
        accelerator: Accelerator::KdTree,
        split: Split::ObjectMedian,
        leaf_size: 1,
        copies: true,
        savings: GraphOptimisations { skip: false, ..GraphOptimisations::default() },
        triangle_method: TriangleMethod::InsideByAreas,
        sphere_method: SphereMethod::Geometric,
        precision: Precision::Double,
        grid_resolution: 3,
        ray_offset: 0.5,
        lift_shadow_rays: true,
        kd_heuristics: KdHeuristics { stop_at_overlap: false, ..KdHeuristics::default() },
    };
    assert_eq!(scene.quality, expected);
}

#[test]
fn a_camera_stands_somewhere_and_looks_somewhere() {
    check_refused(
        "",
        "s.toml:1:1: the scene lacks `[camera]`\n\
         help: add `[camera]` with, for example, `position = [0, 1, 5]` and `look_at = [0, 0, 0]`",
    );
    // The difference of far points overflows single precision; a tiny difference still gives a direction.
    scene("camera = { position = [-3e38, 0, 0], look_at = [3e38, 0, 0] }");
    scene("camera = { position = [1e-45, 0, 0], look_at = [0, 0, 0] }");
}

#[test]
fn every_setting_stands_in_the_description_of_the_format() {
    let (_, table) = include_str!("../format.md").split_once("# `[quality]`").expect("the table of settings");
    let mut default = Quality::default();
    for (key, words) in Quality::KEYS.into_iter().zip(Quality::WORDS) {
        let row = table.lines().find(|row| row.starts_with(&format!("| `{key}` | "))).expect(key);
        let (first, more) = words.split_once(';').unwrap_or((words, ""));
        let (names, range) = match default.field(key).expect(key) {
            Field::Whole(_, range) if *range.end() == u32::MAX => {
                (vec![], format!(", at least {}", range.start()))
            }
            Field::Whole(_, range) => (vec![], format!(", {} to {}", range.start(), range.end())),
            Field::Number(_, range) if *range.end() == f32::MAX => {
                (vec![], format!(", at least {}", range.start()))
            }
            Field::Number(_, range) => (vec![], format!(", {} to {}", range.start(), range.end())),
            Field::Truth(_) => (vec![], String::new()),
            Field::Name(name) => {
                (name.names().iter().map(|name| format!("`\"{name}\"`")).collect(), String::new())
            }
            Field::Switches(all) => {
                (all.switches().iter().map(|(name, _)| format!("{name} = true")).collect(), String::new())
            }
        };
        let more = if more.is_empty() { String::new() } else { format!(";{more}") };
        let (initial, rest) = first.split_at(1);
        let start = format!("| `{key}` | {}{rest}{range}{more}", initial.to_lowercase());
        assert!(row.starts_with(&start), "{row}\nbegins otherwise than\n{start}");
        for name in names {
            assert!(row.contains(&name), "{row}\nlacks {name}");
        }
        let text = default.field(key).expect(key).text();
        let value = match default.field(key).expect(key) {
            Field::Truth(_) => format!("`{text}`"),
            Field::Name(_) => format!("`\"{text}\"`"),
            Field::Switches(_) => "all".into(),
            _ => text,
        };
        assert!(row.ends_with(&format!(" | {value} |")), "{row}\nends without {value}");
    }
}

#[test]
fn a_command_line_sets_what_a_scene_sets() {
    let mut quality = Quality::default();
    for (key, text) in
        [("samples-per-pixel", "343"), ("sampler", "jittered"), ("clamp", "1.5"), ("copies", "true")]
    {
        set(&mut quality, key, text).expect(key);
    }
    set(&mut quality, "accelerator", "octree-by-cells").expect("a name with `-`");
    set(&mut quality, "savings", "{ skip = false }").expect("switches");
    let wanted = Quality {
        samples_per_pixel: 343,
        sampler: Sampler::Jittered,
        clamp: 1.5,
        accelerator: Accelerator::OctreeByCells,
        copies: true,
        savings: GraphOptimisations { skip: false, ..GraphOptimisations::default() },
        ..Quality::default()
    };
    assert_eq!(quality, wanted);
    // The text of a setting can be read again.
    let mut same = Quality::default();
    for key in Quality::KEYS {
        set(&mut same, key, &quality.field(key).expect(key).text()).expect(key);
    }
    assert_eq!(same, quality);
    assert_eq!(same.differences(&wanted), Vec::<&str>::new());
    let mut refused = |key, text| set(&mut quality, key, text).map_err(|error| error.message);
    assert_eq!(
        refused("glossy_samples", "0"),
        Err("`glossy_samples` must be a whole number from 1 to 1048576, but is 0".into())
    );
    assert_eq!(refused("clamp", "-1"), Err("`clamp` must be at least 0, but is -1".into()));
    assert_eq!(
        refused("sampler", "jitered"),
        Err("unknown value of `sampler`: `jitered`; did you mean `jittered`?".into())
    );
    assert_eq!(refused("max_deph", "3"), Err("unknown key `max_deph`; did you mean `max_depth`?".into()));
}

#[test]
fn a_background_can_be_a_gradient() {
    let scene = scene_with("[environment]\nbackground = { zenith = [0, 0, 1], horizon = 0.5, nadir = 0.25 }");
    let gradient = Gradient { zenith: Vec3::Z, horizon: Vec3::splat(0.5), nadir: Vec3::splat(0.25) };
    assert_eq!(scene.background, Background::Gradient(gradient));
    // Without a nadir, the ground is as the horizon, also its encoded bytes.
    let text = format!(
        "color_encoding = 'gamma2'\n{CAMERA}[environment]\nbackground = {{ zenith = 0, horizon = '#ff0000' }}"
    );
    let mut scene = scene_from(&text);
    assert_eq!(
        scene.background,
        Background::Gradient(Gradient { zenith: Vec3::ZERO, horizon: Vec3::X, nadir: Vec3::X })
    );
    let place = ColorPlace::Gradient;
    assert_eq!(
        scene.gamma2.colors,
        [(place(GradientColor::Horizon), [255, 0, 0]), (place(GradientColor::Nadir), [255, 0, 0])]
    );
    *scene.color_mut(place(GradientColor::Zenith)).expect("a gradient") = Vec3::Y;
    assert!(matches!(scene.background, Background::Gradient(Gradient { zenith: Vec3::Y, .. })));
    assert_eq!(scene.color_mut(ColorPlace::Background), None);
}

#[test]
fn the_horizontal_field_of_view_is_that_of_the_wider_side() {
    let camera = |size: &str, angle: &str| {
        scene(&format!("[film]\n{size}\n[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n{angle}")).camera
    };
    // Twice as wide as high: a horizontal angle of 90 degrees sees half a unit upwards at distance 1.
    let wide = camera("width = 200\nheight = 100", "horizontal_fov = 90");
    assert!((wide.half_height - 0.5).abs() < 1e-6, "{}", wide.half_height); // a few roundings
    let edge = wide.ray(1.0, 0.5).direction;
    assert!((edge.x + edge.z).abs() < 1e-6, "{edge}"); // 45 degrees from the axis
    // On a square film both angles are the same.
    let square = "width = 64\nheight = 64";
    let (vertical, horizontal) = (camera(square, "vertical_fov = 50"), camera(square, "horizontal_fov = 50"));
    assert!((vertical.half_height - horizontal.half_height).abs() < 1e-6);
}

#[test]
fn colours_as_text_are_decoded() {
    let rest = "[camera]\nposition = [0, 0, 5]\nlook_at = [0, 0, 0]\n[environment]\nbackground = '#ff0080'\n\
                [materials.paint]\ndiffuse = '#FFFFFF'\nmirror = 0.5";
    // 128 is 0.2159 of full light by the sRGB curve.
    let srgb = scene(rest);
    let Background::Color(background) = srgb.background else { panic!("one colour") };
    assert!((background - Vec3::new(1.0, 0.0, 0.2159)).length() < 1e-4);
    assert_eq!(srgb.materials[1].ambient, Vec3::ONE);
    assert!(srgb.gamma2.is_empty());
    // A frame decodes gamma 2; the loader keeps the bytes, also those of the ambient colour that follows from `diffuse`.
    let encoded = scene(&format!("color_encoding = 'gamma2'\n{rest}"));
    assert_eq!(encoded.background, srgb.background);
    let white = [255; 3];
    assert_eq!(
        encoded.gamma2.colors,
        [
            (ColorPlace::Background, [255, 0, 128]),
            (ColorPlace::Material(1, MaterialColor::Diffuse), white),
            (ColorPlace::Material(1, MaterialColor::Ambient), white),
        ]
    );
}
