//! Generates the textures of the scenes, in linear light.

use glam::{Vec2, Vec3, vec2, vec3};
use raykata::film::Film;

/// Returns every image with its file name.
pub fn all() -> [(&'static str, Film); 3] {
    [
        ("tiles.png", paint(256, 256, tiles)),
        ("bricks.png", paint(256, 128, bricks)),
        ("sphere.png", paint(512, 256, sphere)),
    ]
}

/// Makes an image from the colours at the pixel centres. Coordinates start at the lower left corner.
fn paint(width: u32, height: u32, color: fn(Vec2) -> Vec3) -> Film {
    let mut film = Film::new(width, height);
    for (index, pixel) in film.pixels.iter_mut().enumerate() {
        let (x, y) = (index as u32 % width, index as u32 / width);
        *pixel = color(vec2((x as f32 + 0.5) / width as f32, 1.0 - (y as f32 + 0.5) / height as f32));
    }
    film
}

/// Returns a pseudo-random number in `0.0..1.0` for a cell, the same on every machine.
fn shade(x: i32, y: i32) -> f32 {
    let mut bits = (x as u32).wrapping_mul(0x9e37_79b9) ^ (y as u32).wrapping_mul(0x85eb_ca6b);
    bits = (bits ^ (bits >> 15)).wrapping_mul(0x2c1b_3c6d);
    bits = (bits ^ (bits >> 12)).wrapping_mul(0x297a_2d39);
    ((bits ^ (bits >> 15)) >> 8) as f32 / (1 << 24) as f32
}

/// Returns the colour of four by four tiles in two colours, with varied brightness and with joints between them.
fn tiles(at: Vec2) -> Vec3 {
    let place = 4.0 * at;
    let (column, row) = (place.x as i32, place.y as i32);
    let from_edge = (0.5 - (place - place.floor() - 0.5).abs()).min_element();
    if from_edge < 0.02 {
        return vec3(0.16, 0.15, 0.14);
    }
    let tile = if (column + row) % 2 == 0 { vec3(0.74, 0.68, 0.57) } else { vec3(0.20, 0.27, 0.33) };
    tile * (0.82 + 0.24 * shade(column, row))
}

/// Returns the colour of eight courses of bricks, with every second one shifted by half a brick.
fn bricks(at: Vec2) -> Vec3 {
    let course = (8.0 * at.y).floor();
    let along = 4.0 * at.x + 0.5 * (course % 2.0);
    let place = vec2(along - along.floor(), 8.0 * at.y - course);
    let from_edge = (0.5 - (place - 0.5).abs()) * vec2(1.0, 0.5);
    if from_edge.min_element() < 0.025 {
        return vec3(0.62, 0.60, 0.56);
    }
    let brick = (along.floor() as i32).rem_euclid(4);
    vec3(0.44, 0.13, 0.075) * (0.7 + 0.6 * shade(brick, course as i32))
}

/// Returns the colour of a beach ball: six segments from pole to pole, in three colours and white.
fn sphere(at: Vec2) -> Vec3 {
    let white = vec3(0.82, 0.80, 0.76);
    if !(0.07..0.93).contains(&at.y) {
        return white;
    }
    match (6.0 * at.x) as u32 {
        0 => vec3(0.72, 0.06, 0.05),
        2 => vec3(0.78, 0.46, 0.03),
        4 => vec3(0.04, 0.20, 0.56),
        _ => white,
    }
}
