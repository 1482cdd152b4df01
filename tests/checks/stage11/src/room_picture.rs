//! The picture of a room, composed from `step`: two spheres under a panel of light and beside a small spherical light, with
//! all light of three bounces.
//!
//! The metric and the bound are those of [`Sampled`]: the means of blocks of 4 × 4 pixels differ by at most six standard
//! errors. The walls and emitters are dim, and multiple importance sampling limits what one sample can add, so that the mean
//! of the 384 samples of a block is close to normally distributed.

use super::rooms::{Form, Paint, Room, Roulette, Wall, follow};
use checks::picture::{self, Sampled, Size};
use checks::prelude::*;
use checks::statistics;
use glam::dvec3;
use raykata::camera::Camera;

/// The size of the picture. It is small, because each pixel has many samples.
const SIZE: Size = Size { width: 36, height: 24 };
/// The number of paths per pixel.
const SAMPLES: usize = 24;
/// The largest depth. What a further bounce adds is more than the bound of most blocks.
const MAX_DEPTH: u32 = 3;

fn wall(corner: DVec3, first: DVec3, second: DVec3, diffuse: Vec3) -> Wall {
    Wall::new(Form::Parallelogram(corner, first, second), Paint { diffuse, ..Paint::default() })
}

/// A room that is open towards the camera. `mirror` and `glazed` are the radii of the two spheres, `height` is that of the
/// small spherical light, and `color` the reflectance of the left wall.
fn room(mirror: f64, glazed: f64, height: f64, color: Vec3) -> Room {
    let (white, right) = (vec3(0.72, 0.7, 0.66), vec3(0.2, 0.45, 0.6));
    let (x, y, z) = (3.0 * DVec3::X, 2.0 * DVec3::Y, 3.0 * DVec3::Z);
    let corner = dvec3(-1.5, 0.0, -1.5);
    let sphere = |center: DVec3, radius: f64, diffuse: Vec3, mirror: Vec3| {
        Wall::new(Form::Sphere(center, radius), Paint { diffuse, mirror, ..Paint::default() })
    };
    let panel = Form::Parallelogram(dvec3(-1.0, 1.75, -1.1), 2.0 * DVec3::X, 1.9 * DVec3::Z);
    let walls = vec![
        wall(corner, z, x, white),
        wall(corner + y, x, z, white),
        wall(corner, x, y, white),
        wall(corner, y, z, color),
        wall(corner + x, z, y, right),
        sphere(dvec3(-0.6, mirror, -0.6), mirror, Vec3::ZERO, vec3(0.85, 0.82, 0.75)),
        sphere(dvec3(0.65, glazed, -0.1), glazed, vec3(0.5, 0.3, 0.1), Vec3::splat(0.3)),
        Wall::light(panel, vec3(0.9, 0.8, 0.65), 0.7),
        Wall::light(Form::Sphere(dvec3(-0.1, height, 0.5), 0.15), vec3(0.5, 0.7, 0.9), 0.3),
    ];
    Room { walls, sky: Vec3::ZERO }
}

/// The samples of all pixels. Paths that do not end are NaN, and so differ from every picture.
fn samples(kit: &dyn Kit, camera: &Camera, pixels: &[(u32, u32)], room: &Room) -> Vec<Vec<Vec3>> {
    let (width, height) = (SIZE.width as f32, SIZE.height as f32);
    let places = statistics::pairs(12, SAMPLES * pixels.len());
    let starts: Vec<(DVec3, DVec3)> = places
        .iter()
        .enumerate()
        .map(|(index, place)| {
            let (x, y) = pixels[index / SAMPLES];
            let ray = camera.ray((x as f32 + place.x) / width, (y as f32 + place.y) / height);
            (ray.origin.as_dvec3(), ray.direction.as_dvec3().normalize())
        })
        .collect();
    let light = follow(kit, 13, room, &starts, MAX_DEPTH, Roulette::Played)
        .unwrap_or_else(|_| vec![DVec3::NAN; starts.len()]);
    light.chunks(SAMPLES).map(|pixel| pixel.iter().map(|light| light.as_vec3()).collect()).collect()
}

pub(super) fn picture_of_a_room(trial: &Trial<'_>) -> CheckResult {
    let public = room(0.55, 0.45, 0.35, vec3(0.65, 0.2, 0.15));
    let radii = (0.45..0.65f64, 0.35..0.5f64, 0.25..0.6f64);
    let hidden = (radii, 0.2..0.6f32, 0.1..0.3f32);
    let hidden = hidden.prop_map(|((mirror, glazed, height), green, blue)| {
        room(mirror, glazed, height, vec3(0.65, green, blue))
    });
    let room = trial.composed(public, hidden);
    let camera = picture::camera(SIZE, vec3(0.0, 1.05, 3.3), vec3(0.0, 0.95, 0.0));
    let picture = Sampled { name: "stage11_room", size: SIZE };
    let pixels: Vec<(u32, u32)> = picture::pixels_of(trial, SIZE).collect();
    picture.check(trial, |kit| samples(kit, &camera, &pixels, &room))
}
