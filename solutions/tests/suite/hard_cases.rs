//! Hard cases of `tests/cases.toml` that no exercise contains: media that touch, the shadow terminator of smooth meshes, spheres
//! far from the origin and meshes that move.

use crate::scene::{job, render, rendered, scene};
use glam::{DVec3, Vec3};
use oracle::splitmix::Random;
use raykata::camera::{Camera, Shutter};
use raykata::film::Film;
use raykata::kit::{RenderJob, View};
use raykata::mesh::SceneMesh;
use raykata::scene::{Sampler, Scene};
use solutions::stage8_surfaces::loop_subdivide;
use std::sync::Arc;

fn normals_of(scene: &Scene) -> (RenderJob, Film) {
    let job = RenderJob { view: View::Normals, ..job(scene) };
    let film = rendered(&job).film;
    (job, film)
}

/// An emitter of radiance 1 behind the walls of a glass of water, seen along the normal. `max_depth` leaves only the path
/// without reflections, so the light is the product of the transmittances by Fresnel's equations along the normal,
/// 1 - ((n1 - n2) / (n1 + n2))² (Born and Wolf, "Principles of Optics", section 1.5.3).
#[test]
fn touching_media_transmit_what_fresnels_equations_say() {
    for inside in [1.333f64, 1.0, 1.5, 2.4] {
        let scene = scene(&format!(
            "film = {{ width = 1, height = 1 }}\ncamera = {{ position = [0, 0, 9], look_at = [0, 0, 0] }}\n\
             [quality]\nmax_depth = 4\nmin_contribution = 0\n\
             [materials.emitter]\ndiffuse = 0\nemission = 1\n\
             [materials.glass]\ndiffuse = 0\ntransmission = 1\nfresnel = 'exact'\nindex_of_refraction = 1.5\n\
             [materials.inside]\ndiffuse = 0\ntransmission = 1\nfresnel = 'exact'\n\
             index_of_refraction = {inside}\noutside = 1.5\n\
             [[nodes]]\nmaterial = 'glass'\nshape = {{ box = {{ min = [-9, -9, -3], max = [9, 9, 3] }} }}\n\
             [[nodes]]\nmaterial = 'inside'\nshape = {{ box = {{ min = [-8, -8, -2], max = [8, 8, 2] }} }}\n\
             [[nodes]]\nmaterial = 'emitter'\nshape = {{ plane = {{ point = [0, 0, -5], normal = [0, 0, 1] }} }}\n"
        ));
        let through = |n1: f64, n2: f64| 1.0 - ((n1 - n2) / (n1 + n2)).powi(2);
        let expected = (through(1.0, 1.5) * through(1.5, inside)).powi(2);
        let found = f64::from(render(&scene).film.pixels[0].x);
        // The four reflectances are below 0.1 with a dozen roundings each.
        assert!((found - expected).abs() < 1e-6, "{inside}: {found} and not {expected}");
    }
}

/// Spheres of 48 to 12,288 triangles with the normals of the true sphere, under a low sun: how many pixels are dark although the
/// true sphere is lit there, or lit although it is dark.
#[test]
fn lifted_shadow_rays_follow_the_true_shadow_terminator() {
    let mut scene = scene(
        "film = { width = 60, height = 60 }\ncamera = { position = [0, 1, 5], look_at = [0, 0, 0], vertical_fov = 25 }\n\
         [materials.default]\nambient = 0\n[[lights]]\ndirectional = { direction = [-1, -0.2, -0.1] }\n\
         [meshes.ball]\nfile = 'meshes/cube.obj'\n[[nodes]]\nshape = { mesh = 'ball' }\n",
    );
    let sun = Vec3::new(1.0, 0.2, 0.1).normalize();
    let mut table = "triangles  wrong pixels  lifted\n".to_owned();
    for _ in 0..5 {
        let SceneMesh { mesh, places, .. } = &mut scene.meshes[0];
        places.clear();
        let mesh = Arc::make_mut(mesh);
        *mesh = loop_subdivide(mesh);
        mesh.positions.iter_mut().for_each(|position| *position = position.normalize());
        mesh.normals = mesh.positions.clone();
        let triangles = mesh.triangles.len();
        let normals = normals_of(&scene).1;
        let [without, with] = [false, true].map(|lift| {
            scene.quality.lift_shadow_rays = lift;
            let film = render(&scene).film;
            let pixels = film.pixels.iter().zip(&normals.pixels).filter(|(_, normal)| **normal != Vec3::ZERO);
            pixels
                .filter(|(light, normal)| ((2.0 * **normal - 1.0).dot(sun) > 0.0) != (light.x > 0.0))
                .count()
        });
        table += &format!("{triangles:9}  {without:12}  {with:6}\n");
    }
    assert_eq!(table, include_str!("../../../tests/golden/shadow_terminator.txt"), "\n{table}");
}

/// Spheres of radius 1 at 10⁶ from the origin, seen from nearby, and at the origin, seen from 10⁶: normals are within 1e-5 of those of
/// the exact hit. The colour `0.5 n + 0.5` and the rounding of the normal itself take 2e-7 of that.
#[test]
fn normals_of_spheres_are_exact_at_a_million_radii() {
    for (camera, center) in [("[1e6, -1e6, 1000004]", [1e6, -1e6, 1e6]), ("[6e5, 0, 8e5]", [0.0; 3])] {
        let fov = if center[0] > 0.0 { 30.0 } else { 1e-4 };
        let mut scene = scene(&format!(
            "film = {{ width = 40, height = 40 }}\n\
             camera = {{ position = {camera}, look_at = {center:?}, vertical_fov = {fov} }}\n\
             [[nodes]]\nshape = {{ sphere = {{ center = {center:?}, radius = 1 }} }}\n"
        ));
        scene.quality.sampler = Sampler::Center;
        let (job, film) = normals_of(&scene);
        let mut hits = 0;
        for (index, pixel) in film.pixels.iter().enumerate().filter(|(_, pixel)| **pixel != Vec3::ZERO) {
            let ray = &solutions::kit().trace(&job, index as u32 % 40, index as u32 / 40)[0];
            // The first root of the quadratic equation, with the offset beside the centre in place of a discriminant that cancels.
            let (origin, direction) = (ray.origin.as_dvec3() - DVec3::from(center), ray.direction.as_dvec3());
            let direction = direction.normalize();
            let beside = origin - origin.dot(direction) * direction;
            let expected = beside - (1.0 - beside.length_squared()).max(0.0).sqrt() * direction;
            let found = 2.0 * pixel.as_dvec3() - 1.0;
            assert!((found - expected).length() < 1e-5, "{found} and not {expected}");
            hits += 1;
        }
        assert!(hits > 200, "{hits} hits");
    }
}

/// Camera rays from inside a black mesh that moves, turns and shrinks, aimed at points of its edges where these are at the time of
/// the picture: the white background is never seen.
#[test]
fn no_ray_leaks_out_of_a_moving_mesh() {
    let mut scene = scene(
        "film = { width = 1, height = 1 }\nenvironment = { background = 1 }\n\
         camera = { position = [0, 0, 9], look_at = [0, 0, 0], shutter = { open = 0, close = 1 } }\n\
         [materials.default]\ndiffuse = 0\n[meshes.cube]\nfile = 'meshes/cube.obj'\n\
         [[nodes]]\nshape = { mesh = 'cube' }\n\
         transform_end = [{ scale = 0.7 }, { rotate = { axis = [1, 2, 3], degrees = 50 } }, { translate = [3, 1, -2] }]\n",
    );
    let (start, end) = (scene.nodes[0].transform, scene.nodes[0].transform_end.expect("a motion"));
    let mesh = scene.meshes[0].mesh.clone();
    let mut random = Random::new(3, 0);
    for _ in 0..2000 {
        let time = random.unit();
        let at = |point: Vec3| start.transform_point3(point).lerp(end.transform_point3(point), time);
        let corners = mesh.corners(random.below(mesh.triangles.len() as u64) as usize).map(at);
        let (origin, target) = (at(0.2 * random.in_cube()), corners[0].lerp(corners[1], random.unit()));
        scene.camera = Camera {
            shutter: Some(Shutter { open: time, close: time }),
            ..Camera::new(origin, target - origin, Vec3::Y, 1e-3, 1.0).expect("a direction")
        };
        let film = render(&scene).film;
        assert_eq!(film.pixels[0], Vec3::ZERO, "{:?}", scene.camera);
    }
    // The same ray at another time starts outside and misses.
    scene.camera.shutter = Some(Shutter { open: 0.0, close: 0.0 });
    scene.camera.position = Vec3::splat(9.0);
    assert_eq!(render(&scene).film.pixels[0], Vec3::ONE);
}
