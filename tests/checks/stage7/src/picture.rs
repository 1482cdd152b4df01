//! The picture of stage 7: an image on spheres, with each of the wrap modes, and on the floor below them.

use super::texels::WRAPS;
use checks::picture::{self, Composed, LARGE};
use checks::prelude::*;
use raykata::material::{Texture, Wrap};
use std::f32::consts::TAU;
use std::sync::Arc;

/// The side of the image in pixels.
const SIDE: u32 = 8;

/// A heart, and a pixel in the corner at the lower left, so that no turn and no reflection gives the same image.
const ROWS: [&[u8; 8]; 8] =
    [b".hh.hh..", b"hhhhhhh.", b"hhhhhhh.", b".hhhhh..", b"..hhh...", b"...h....", b"........", b"c......."];

/// The pixels of the image. `hue` changes its colours.
fn image(hue: f32) -> Vec<Vec3> {
    let pixel = |i: u32| {
        let (column, row) = (i % SIDE, i / SIDE);
        let down = row as f32 / SIDE as f32;
        match ROWS[row as usize][column as usize] {
            b'h' => vec3(0.85 - 0.25 * down, 0.08 + 0.3 * hue, 0.1 + 0.5 * hue),
            b'c' => vec3(0.05, 0.25, 0.45),
            _ => vec3(0.9, 0.8 - 0.2 * down, 0.5 - 0.2 * hue),
        }
    };
    (0..SIDE * SIDE).map(pixel).collect()
}

/// The light of a point, its image coordinates, and the wrap mode of the image there.
type Spot = (f32, Vec2, Wrap);

/// What a ray sees: one of three spheres, or the floor. Nothing is seen above the horizon.
fn spot(ray: &Ray, spins: [f32; 3]) -> Option<Spot> {
    let light = vec3(-0.4, 0.8, 0.55).normalize();
    let spheres = (0..3).filter_map(|index| {
        let center = vec3(2.1 * index as f32 - 2.1, 1.0, if index == 1 { -0.5 } else { 0.0 });
        let to_center = center - ray.origin;
        let middle = to_center.dot(ray.direction);
        let half = 1.0 - (to_center - middle * ray.direction).length_squared();
        (half > 0.0).then(|| (middle - half.sqrt(), center, index))
    });
    if let Some((t, center, index)) = spheres.min_by(|(p, ..), (q, ..)| p.total_cmp(q)) {
        let normal = ray.at(t) - center;
        // Longitude and latitude: the image lies on a quarter of the equator, and continues as its wrap mode says.
        let longitude = 4.0 * (normal.x.atan2(normal.z) / TAU + spins[index]);
        let uv = vec2(0.5 + longitude, 0.5 + 4.0 * normal.y.clamp(-1.0, 1.0).asin() / TAU);
        let wrap = WRAPS[index];
        return Some((0.25 + 0.75 * normal.dot(light).max(0.0), uv, wrap));
    }
    let point = ray.at(-ray.origin.y / ray.direction.y);
    // Far away, pixels are smaller than the image, and the floor fades.
    let fade = (1.3 - 0.09 * (point - ray.origin).length()).clamp(0.0, 1.0);
    let near = (0..3).map(|index| {
        let below = vec3(2.1 * index as f32 - 2.1, 0.0, if index == 1 { -0.5 } else { 0.0 });
        1.0 - 0.75 / (1.0 + 2.0 * (point - below).length_squared())
    });
    let shade: f32 = near.product();
    (ray.direction.y < 0.0).then_some((
        0.7 * fade * shade,
        0.8 * vec2(point.x + 0.6, 2.2 - point.z),
        Wrap::Mirror,
    ))
}

pub(super) fn picture_of_an_image_on_spheres(trial: &Trial<'_>) -> CheckResult {
    let public = (0.0, -0.065, -0.014, 0.038);
    let (hue, a, b, c) = trial.composed(public, (0.1..1f32, -0.2..0.2f32, -0.2..0.2f32, -0.2..0.2f32));
    let pixels = Arc::new(image(hue));
    let rays = picture::rays(trial, LARGE, vec3(0.6, 2.2, 6.2), vec3(0.0, 0.8, 0.0));
    let spots: Vec<Option<Spot>> = rays.iter().map(|ray| spot(ray, [a, b, c])).collect();
    let query = |(_, uv, wrap): &Spot| TextureQuery {
        texture: Texture { width: SIDE, height: SIDE, pixels: pixels.clone(), wrap: *wrap },
        uv: *uv,
    };
    let queries: Vec<TextureQuery> = spots.iter().flatten().map(query).collect();
    let colors = |kit: &dyn Kit| {
        let mut shown = kit.texture_color(&queries).into_iter();
        let color = |spot: &Option<Spot>| match spot {
            Some((light, ..)) => *light * shown.next().unwrap_or_default(),
            None => Vec3::ZERO,
        };
        spots.iter().map(color).collect()
    };
    // The hits are given, and the image is continuous everywhere except where it repeats: there, at most a pixel or two may
    // show the other side.
    let composed = Composed { name: "stage7_image_on_spheres", size: LARGE, rays: &rays, may_differ: 0.0005 };
    composed.check(trial, colors)
}
