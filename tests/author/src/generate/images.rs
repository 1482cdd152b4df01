//! Generates the textures of the scenes, in linear light.

use glam::{Vec2, Vec3, vec2, vec3};
use raykata::film::Film;
use std::f32::consts::{PI, TAU};

/// Returns every image with its file name. Files that end in `.hdr` hold linear light, the others sRGB.
pub fn all() -> [(&'static str, Film); 11] {
    [
        ("tiles.png", paint(256, 256, tiles)),
        ("bricks.png", paint(256, 128, bricks)),
        ("ball.png", paint(512, 256, sphere)),
        ("checks.png", paint(64, 64, checks)),
        ("marble.png", paint(512, 256, marble)),
        ("billiard1.png", paint(512, 256, |at| billiard(at, 1, vec3(0.85, 0.48, 0.02), false))),
        ("billiard4.png", paint(512, 256, |at| billiard(at, 4, vec3(0.20, 0.03, 0.30), false))),
        ("billiard8.png", paint(512, 256, |at| billiard(at, 8, vec3(0.012, 0.012, 0.014), false))),
        ("billiard9.png", paint(512, 256, |at| billiard(at, 9, vec3(0.85, 0.48, 0.02), true))),
        ("studio.hdr", paint(512, 256, studio)),
        ("sunset.hdr", paint(512, 256, sunset)),
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
pub(super) fn shade(x: i32, y: i32) -> f32 {
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

/// Returns the colour of Whitted's floor: two by two checks in red and yellow.
fn checks(at: Vec2) -> Vec3 {
    if (at.x < 0.5) == (at.y < 0.5) { vec3(0.75, 0.025, 0.02) } else { vec3(0.90, 0.62, 0.02) }
}

/// Returns smooth noise in `0.0..1.0` (value noise, bilinear in cells with smoothstep weights), with period `columns`
/// along x.
fn noise(at: Vec2, columns: i32) -> f32 {
    let cell = at.floor();
    let t = at - cell;
    let t = t * t * (3.0 - 2.0 * t);
    let value = |i: i32, j: i32| shade((cell.x as i32 + i).rem_euclid(columns), cell.y as i32 + j);
    let lower = value(0, 0) + (value(1, 0) - value(0, 0)) * t.x;
    let upper = value(0, 1) + (value(1, 1) - value(0, 1)) * t.x;
    lower + (upper - lower) * t.y
}

/// Returns a sum of five octaves of noise, in `0.0..1.0`, with period 1 along x.
fn turbulence(at: Vec2) -> f32 {
    (0..5)
        .map(|octave| {
            let columns = 6 << octave;
            noise(at * vec2(columns as f32, (columns / 2) as f32) + vec2(0.0, 37.0 * octave as f32), columns)
                / (2 << octave) as f32
        })
        .sum()
}

/// Returns the colour of white marble: grey veins where a warped sine is near 0 (Perlin 1985).
fn marble(at: Vec2) -> Vec3 {
    let warp = turbulence(at) - 0.5;
    let wave = (TAU * (2.0 * at.x + 1.5 * at.y) + 14.0 * warp).sin().abs();
    let vein = (1.0 - wave).powi(5) * (0.35 + 0.65 * turbulence(at + vec2(0.37, 3.1)));
    let cloud = 0.86 + 0.16 * warp;
    vec3(0.93, 0.91, 0.88) * cloud * (1.0 - 0.85 * vein) + vec3(0.10, 0.08, 0.06) * vein
}

/// Returns the colour of a billiard ball: its number in a white circle on two sides, in a plain ball or one with a stripe.
fn billiard(at: Vec2, number: u32, color: Vec3, striped: bool) -> Vec3 {
    let white = vec3(0.86, 0.84, 0.78);
    // Angles from the nearer of the two circles, in radians.
    let side = if at.x < 0.5 { 0.25 } else { 0.75 };
    let place = vec2(TAU * (at.x - side), PI * (at.y - 0.5));
    if place.length() < 0.42 {
        let ink = distance_to_digit(place / 0.24, number) < 0.17;
        return if ink { vec3(0.015, 0.015, 0.015) } else { white };
    }
    if striped && place.y.abs() > 0.62 { white } else { color }
}

/// Returns the distance to a digit of seven segments between (-0.5, -1) and (0.5, 1).
fn distance_to_digit(at: Vec2, number: u32) -> f32 {
    let corners = [-1.0, 0.0, 1.0].map(|y| [vec2(-0.5, y), vec2(0.5, y)]);
    let [[bottom_left, bottom_right], [left, right], [top_left, top_right]] = corners;
    let segments = [
        (top_left, top_right),
        (left, right),
        (bottom_left, bottom_right),
        (top_left, left),
        (left, bottom_left),
        (top_right, right),
        (right, bottom_right),
    ];
    let lit: &[usize] = match number {
        1 => {
            return distance_to_segment(at, vec2(0.05, -1.0), vec2(0.05, 1.0)).min(distance_to_segment(
                at,
                vec2(0.05, 1.0),
                vec2(-0.3, 0.65),
            ));
        }
        4 => &[1, 3, 5, 6],
        9 => &[0, 1, 2, 3, 5, 6],
        _ => &[0, 1, 2, 3, 4, 5, 6],
    };
    lit.iter().map(|&i| distance_to_segment(at, segments[i].0, segments[i].1)).fold(f32::INFINITY, f32::min)
}

fn distance_to_segment(at: Vec2, start: Vec2, end: Vec2) -> f32 {
    let along = end - start;
    let t = ((at - start).dot(along) / along.length_squared()).clamp(0.0, 1.0);
    at.distance(start + t * along)
}

/// Returns the light of a photographer's studio: a dark room with a warm floor, a large softbox on the left, a narrow one on
/// the right and a round one above the camera.
fn studio(at: Vec2) -> Vec3 {
    // The middle of the image lies at -z, and its upper edge at +y.
    let (longitude, latitude) = (TAU * (at.x - 0.5), PI * (at.y - 0.5));
    let height = latitude.sin();
    // The walls are brightest at the horizon. The floor reflects warm light.
    let wall = vec3(0.10, 0.12, 0.16) * (1.0 - height.max(0.0)).powi(2) + vec3(0.015, 0.018, 0.025);
    let floor = vec3(0.10, 0.075, 0.05) * (1.0 + height.min(0.0));
    let room = if height > 0.0 { wall } else { floor + vec3(0.02, 0.022, 0.03) };
    // A softbox is bright in its middle and has a soft edge: `size` in radians along longitude and latitude.
    let softbox = |center: Vec2, size: Vec2, color: Vec3| {
        let away = (vec2(longitude, latitude) - center).abs() / size;
        let inside = (1.0 - away.max_element()).clamp(0.0, 0.08) / 0.08;
        color * inside * (1.0 - 0.35 * away.length_squared() / 2.0)
    };
    room + softbox(vec2(-1.55, 0.55), vec2(0.42, 0.50), vec3(9.0, 7.6, 5.8))
        + softbox(vec2(1.35, 0.45), vec2(0.16, 0.62), vec3(3.6, 4.6, 6.4))
        + softbox(vec2(2.75, 0.95), vec2(0.30, 0.16), vec3(5.0, 4.8, 4.5))
        + softbox(vec2(0.0, 0.05), vec2(1.1, 0.35), vec3(0.30, 0.20, 0.12))
}

/// Returns the light of a sunset: a large sun behind haze, which lights long clouds from behind, above a dark sea.
fn sunset(at: Vec2) -> Vec3 {
    let (longitude, latitude) = (TAU * (at.x - 0.5), PI * (at.y - 0.5));
    let (up, level) = latitude.sin_cos();
    let direction = vec3(level * longitude.sin(), up, -level * longitude.cos());
    let angle = direction.angle_between(vec3(0.50, 0.50, -0.70));
    let glow = (-angle / 0.7).exp();
    // The haze at the horizon is orange towards the sun and mauve on the other side.
    let haze = vec3(0.42, 0.20, 0.22).lerp(vec3(2.1, 0.74, 0.20), (1.6 * glow).min(1.0));
    let sky =
        vec3(0.05, 0.13, 0.36).lerp(haze, (-8.0 * up.abs()).exp()) + vec3(0.9, 0.5, 0.22) * glow.powi(3);
    // Clouds lie in a plane above the sea.
    let place = 0.11 * vec2(direction.x, direction.z) / (up.max(0.0) + 0.10);
    let cover = ((turbulence(place + vec2(0.2, 0.6)) - 0.47) / 0.16).clamp(0.0, 1.0);
    let cloud = vec3(0.16, 0.08, 0.10) + vec3(2.8, 1.0, 0.34) * glow * (1.3 - cover);
    let sky = sky.lerp(cloud, 0.8 * cover * (up / 0.04).clamp(0.0, 1.0));
    let sun = vec3(58.0, 37.0, 18.0) * ((0.25 - angle) / 0.03).clamp(0.0, 1.0);
    if up > 0.0 { sky + sun } else { 0.2 * sky }
}
