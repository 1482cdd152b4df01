//! The methods and options that a scene can select: tests of triangles and spheres, planes by coefficients, one-sided
//! meshes, the search that visits both children, and colours that are encoded with gamma 2.

use crate::scene::{differing, render, render_by, scene};
use glam::Vec3;
use raykata::film::Film;
use raykata::scene::{Accelerator, Scene, SphereMethod, TriangleMethod};

const SHAPES: &str = r#"
film = { width = 60, height = 40 }
camera = { position = [0.3, 1.4, 6], look_at = [0, 1, 0] }
[environment]
background = [0.1, 0.2, 0.9]
ambient = 0.3
[[lights]]
point = { position = [4, 6, 5] }
[meshes.cube]
file = "meshes/cube.obj"
[[nodes]]
shape = { mesh = "cube" }
transform = [{ rotate = { axis = [1, 2, 3], degrees = 40 } }, { translate = [-1.2, 1, 0] }]
[[nodes]]
shape = { sphere = { center = [1.2, 1, 0], radius = 1 } }
[[nodes]]
shape = { triangle = { a = [-3, 0.1, -1], b = [3, 0.1, -1], c = [0, 2.6, -2] } }
"#;

/// How many of the 2,400 pixels differ by more than a hundredth in a channel.
fn difference(one: &Film, other: &Film) -> usize {
    differing(one, other, 0.01)
}

#[test]
fn every_method_makes_the_same_picture() {
    let mut scene = scene(SHAPES);
    let expected = render(&scene);
    for (name, method) in TriangleMethod::NAMES {
        scene.quality.triangle_method = method;
        let found = render(&scene);
        // Methods may decide differently about a ray that is aimed at an edge.
        let differ = difference(&found.film, &expected.film);
        assert!(differ <= 1, "{name}: {differ}");
        assert_eq!(found.notes, Vec::<String>::new(), "{name}");
    }
    scene.quality.triangle_method = TriangleMethod::Watertight;
    for (name, method) in SphereMethod::NAMES {
        scene.quality.sphere_method = method;
        let differ = difference(&render(&scene).film, &expected.film);
        assert!(differ <= 1, "{name}: {differ}");
    }
}

#[test]
fn both_children_find_the_same_hits_and_test_more_boxes() {
    let scene = scene(&SHAPES.replace("cube.obj", "vase.ply"));
    let [expected, found] =
        [Accelerator::Bvh, Accelerator::BvhBothChildren].map(|accelerator| render_by(&scene, accelerator));
    assert_eq!(found.film, expected.film);
    assert!(found.counts.box_tests > expected.counts.box_tests);
    assert!(found.counts.primitive_tests > expected.counts.primitive_tests);
}

/// A scene with two walls, each of which is a plane of this text.
fn walls(floor: &str, wall: &str) -> Scene {
    scene(&format!(
        "{SHAPES}\n[[nodes]]\nshape = {{ plane = {{ {floor} }} }}\n\
         [[nodes]]\nshape = {{ plane = {{ {wall} }} }}\ntransform = [{{ scale = [1, 2, 0.5] }}, {{ translate = [0, 0, -4] }}]\n"
    ))
}

#[test]
fn coefficients_and_points_give_the_same_planes() {
    let expected =
        render(&walls("point = [7, 0, 3], normal = [0, 1, 0]", "point = [0, 0, 1], normal = [0, 1, 2]"));
    // 0 = y, and y + 2 z - 2 = 0 with a negative factor.
    let found = render(&walls("coefficients = [0, 3, 0, 0]", "coefficients = [0, -1, -2, 2]"));
    assert_eq!(difference(&found.film, &expected.film), 0);
    assert_eq!(found.counts.primitive_tests, expected.counts.primitive_tests);
    assert_eq!(found.notes, Vec::<String>::new());
}

#[test]
fn a_plane_of_coefficients_can_move() {
    let moving = |plane: &str| {
        let text = SHAPES.replace("look_at", "shutter = { open = 0, close = 1 }, look_at");
        render(&scene(&format!(
            "{text}\n[[nodes]]\nshape = {{ plane = {{ {plane} }} }}\ntransform_end = [{{ translate = [0, 0.5, 0] }}]\n"
        )))
    };
    let (expected, found) =
        (moving("point = [0, 0, 0], normal = [0, 1, 0]"), moving("coefficients = [0, 2, 0, 0]"));
    assert_eq!(difference(&found.film, &expected.film), 0);
}

/// A room whose walls have their fronts inside, seen from outside, with this transform.
fn room(one_sided: bool, transform: &str) -> Film {
    render(&scene(&format!(
        r#"
film = {{ width = 40, height = 40 }}
camera = {{ position = [0, 1.2, 9], look_at = [0, 1.2, 0] }}
[environment]
background = [0, 0, 1]
[[lights]]
point = {{ position = [0, 1.5, 1.2] }}
[meshes.room]
file = "meshes/room.obj"
smooth = false
one_sided = {one_sided}
[materials.wall]
diffuse = [1, 0, 0]
[materials.sphere]
diffuse = [0, 1, 0]
[[nodes]]
material = "wall"
shape = {{ mesh = "room" }}
transform = [{transform}]
[[nodes]]
material = "sphere"
shape = {{ sphere = {{ center = [0, 1.2, 0], radius = 0.5 }} }}
"#
    )))
    .film
}

#[test]
fn a_one_sided_wall_is_seen_from_its_front_only() {
    // A transform that mirrors keeps the front inside.
    for transform in ["", "{ scale = [-1, 1, 1] }", "{ scale = [1, 1, -1] }, { translate = [0, 0.01, 0] }"] {
        let (one, both) = (room(true, transform), room(false, transform));
        let middle = |film: &Film| film.at(20, 20);
        // From outside the camera sees the lit sphere through the back of a wall, or else that wall, which is dark.
        assert!(middle(&one).y > 0.1 && middle(&one).x == 0.0, "{transform}: {}", middle(&one));
        assert_eq!(middle(&both), Vec3::ZERO, "{transform}");
        // Beside the sphere it sees the front of the wall at the back.
        assert!(one.at(12, 20).x > 0.1, "{transform}: {}", one.at(12, 20));
    }
}

#[test]
fn a_shared_mesh_can_be_one_sided() {
    let shared = |one_sided: bool| {
        let mut scene = scene(&format!(
            "{SHAPES}\n[meshes.room]\nfile = \"meshes/room.obj\"\nsmooth = false\none_sided = {one_sided}\n\
             [[nodes]]\nshape = {{ mesh = \"room\" }}\n\
             [[nodes]]\nshape = {{ mesh = \"room\" }}\ntransform = [{{ scale = 0.5 }}, {{ translate = [0.2, 0.3, 0.1] }}]\n"
        ));
        let instances = render(&scene).film;
        scene.quality.copies = true;
        (instances, render(&scene).film)
    };
    let ((instances, copies), (closed, _)) = (shared(true), shared(false));
    assert!(difference(&instances, &copies) <= 1);
    assert!(difference(&instances, &closed) > 240);
}

#[test]
fn gamma_2_is_decoded_by_the_kit() {
    let text = "color_encoding = \"gamma2\"\n[film]\nwidth = 2\nheight = 2\n[camera]\nposition = [0, 0, 5]\n\
                look_at = [0, 0, 0]\n[environment]\nbackground = \"#ff8000\"\n";
    let half = 128.0 / 255.0;
    let decoded = render(&scene(text)).film.at(0, 0);
    assert!((decoded - Vec3::new(1.0, half * half, 0.0)).length() < 1e-6, "{decoded}");
    // By the sRGB curve 128 is 0.2159.
    let srgb = render(&scene(&text.replace("gamma2", "srgb"))).film.at(0, 0);
    assert!((srgb - Vec3::new(1.0, 0.2159, 0.0)).length() < 1e-4, "{srgb}");
}
