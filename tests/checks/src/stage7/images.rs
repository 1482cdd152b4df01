//! Colours from images.

use crate::Trial;
use crate::broken::{Broken, Outcome};
use crate::judge::{compare, known};
use glam::{DVec3, Vec2, Vec3, vec2, vec3};
use proptest::prelude::*;
use raykata::kit::{TexelQuery, TextureQuery};
use raykata::material::{Texture, Wrap};
use std::sync::Arc;

const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror];

/// Goes step by step from 0 to `index`, turning or starting again at the ends.
fn walked(query: &TexelQuery) -> u32 {
    let size = i64::from(query.size);
    let (mut place, mut forwards) = (0i64, true);
    for _ in 0..query.index.abs() {
        let step = if (query.index > 0) == forwards { 1 } else { -1 };
        place += step;
        match query.wrap {
            Wrap::Repeat => place = (place + size) % size,
            Wrap::Clamp => place = place.clamp(0, size - 1),
            Wrap::Mirror if !(0..size).contains(&place) => {
                // The border is shown twice.
                place -= step;
                forwards = !forwards;
            }
            Wrap::Mirror => {}
        }
    }
    place as u32
}

pub(super) fn texels_wrap_as_they_should(trial: &Trial<'_>) -> Outcome {
    let wrap = prop_oneof![Just(Wrap::Repeat), Just(Wrap::Clamp), Just(Wrap::Mirror)];
    let queries =
        (-40..40i64, 1..9u32, wrap).prop_map(|(index, size, wrap)| TexelQuery { index, size, wrap });
    trial.forall(3000, queries, |queries| {
        compare(queries, trial.kit.texel(queries), |query, yours| {
            let expected = walked(query);
            if yours == expected {
                return Ok(());
            }
            let remainder = query.index % i64::from(query.size);
            let diagnosis = match query.wrap {
                Wrap::Repeat if query.index < 0 && i64::from(yours) != remainder => {
                    "the remainder of a negative number is negative: take rem_euclid"
                }
                Wrap::Mirror if yours + 1 == expected || yours == expected + 1 => {
                    "the border is shown twice, once on the way there and once on the way back"
                }
                _ => "",
            };
            let input = format!("texel({}, {}, Wrap::{:?})", query.index, query.size, query.wrap);
            Err(Broken::new(input, yours, expected, "walked step by step").looks_like(known(diagnosis)))
        })
    })
}

fn texture(width: u32, height: u32, wrap: Wrap) -> Texture {
    let pixel = |i: u32| {
        let mix = i.wrapping_mul(0x9e37_79b9);
        vec3((mix >> 28) as f32, (mix >> 24 & 15) as f32, (mix >> 20 & 15) as f32) / 15.0
    };
    Texture { width, height, pixels: Arc::new((0..width * height).map(pixel).collect()), wrap }
}

fn at(texture: &Texture, x: i64, y: i64) -> DVec3 {
    let inside = |index, size| walked(&TexelQuery { index, size, wrap: texture.wrap });
    let (x, y) = (inside(x, texture.width), inside(y, texture.height));
    texture.pixels[(y * texture.width + x) as usize].as_dvec3()
}

/// Bilinear, in double precision.
fn blended(texture: &Texture, u: f64, v: f64) -> DVec3 {
    let (x, y) = (u * f64::from(texture.width) - 0.5, (1.0 - v) * f64::from(texture.height) - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let row = |y: i64| at(texture, left as i64, y).lerp(at(texture, left as i64 + 1, y), x - left);
    row(top as i64).lerp(row(top as i64 + 1), y - top)
}

fn judge(query: &TextureQuery, yours: Vec3) -> Outcome {
    let TextureQuery { texture, uv } = query;
    let (u, v) = (f64::from(uv.x), f64::from(uv.y));
    let expected = blended(texture, u, v);
    // The place is rounded to a few units of 1e-7 of a coordinate up to 3 · 8 pixels; colours go from 0 to 1.
    let near = |color: DVec3| (yours.as_dvec3() - color).abs().max_element() < 2e-5;
    if near(expected) {
        return Ok(());
    }
    let half = (0.5 / f64::from(texture.width), 0.5 / f64::from(texture.height));
    let nearest = at(
        texture,
        (u * f64::from(texture.width)).floor() as i64,
        ((1.0 - v) * f64::from(texture.height)).floor() as i64,
    );
    let diagnosis = match () {
        () if near(nearest) => "the nearest pixel alone: blend the four around",
        () if near(blended(texture, u, 1.0 - v)) => {
            "upside down: v points up, and rows are stored from the top"
        }
        () if near(blended(texture, u + half.0, v - half.1)) => {
            "half a pixel off: the colour of a pixel belongs to its middle"
        }
        () if yours.is_nan() => "NaN",
        () => "",
    };
    let input = format!(
        "texture_color of an image of {} by {} pixels, Wrap::{:?}, at {uv:?}",
        texture.width, texture.height, texture.wrap
    );
    Err(Broken::new(input, yours, expected.as_vec3(), "double precision").looks_like(known(diagnosis)))
}

pub(super) fn middles_of_pixels_show_the_pixel(trial: &Trial<'_>) -> Outcome {
    let texture = texture(4, 3, Wrap::Clamp);
    let queries: Vec<TextureQuery> = (0..12)
        .map(|i| {
            let uv = vec2(((i % 4) as f32 + 0.5) / 4.0, 1.0 - ((i / 4) as f32 + 0.5) / 3.0);
            TextureQuery { texture: texture.clone(), uv }
        })
        .collect();
    queries.iter().zip(trial.kit.texture_color(&queries)).try_for_each(|(query, yours)| judge(query, yours))
}

pub(super) fn images_are_blended(trial: &Trial<'_>) -> Outcome {
    let coordinate = || (-64..128i32).prop_map(|n| n as f32 / 32.0);
    let wrap = (0..3usize).prop_map(|i| WRAPS[i]);
    let queries =
        (coordinate(), coordinate(), 1..6u32, 1..6u32, wrap).prop_map(|(u, v, width, height, wrap)| {
            TextureQuery { texture: texture(width, height, wrap), uv: vec2(u, v) }
        });
    trial.forall(2000, queries, |queries| compare(queries, trial.kit.texture_color(queries), judge))
}

pub(super) fn images_survive_nonsense(trial: &Trial<'_>) -> Outcome {
    let strange = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e30, -0.0, 1e-40];
    for wrap in WRAPS {
        let image = texture(3, 2, wrap);
        let queries: Vec<TextureQuery> = strange
            .iter()
            .flat_map(|&u| strange.map(|v| TextureQuery { texture: image.clone(), uv: Vec2::new(u, v) }))
            .collect();
        for (query, yours) in queries.iter().zip(trial.kit.texture_color(&queries)) {
            if !(yours.min_element() >= -1e-6 && yours.max_element() <= 1.0 + 1e-6) {
                let input = format!("texture_color of 3 by 2 pixels, Wrap::{wrap:?}, at {:?}", query.uv);
                return Err(Broken::new(
                    input,
                    yours,
                    "a colour between those of the image",
                    "a blend of them",
                ));
            }
        }
    }
    Ok(())
}
