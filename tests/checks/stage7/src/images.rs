//! Colours from images.

use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::judge::{compare, known};
use glam::{DVec3, Vec3, vec2, vec3};
use proptest::prelude::*;
use raykata::kit::{Mishap, TexelQuery, TextureQuery, mishap};
use raykata::material::{Texture, Wrap};
use std::sync::Arc;

const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror];

/// Indices within this of 0 are asked for.
const REACH: i64 = 40;

/// The texels of `-reach..=reach`: one goes step by step from 0 to either side and turns or starts again at the ends.
fn row(size: u32, wrap: Wrap, reach: i64) -> Vec<u32> {
    let walk = |step: i64| {
        let (mut place, mut step) = (0, step);
        let next = move || {
            let here = place;
            match wrap {
                Wrap::Repeat => place = (place + step + i64::from(size)) % i64::from(size),
                Wrap::Clamp => place = (place + step).clamp(0, i64::from(size) - 1),
                // The border is shown twice.
                Wrap::Mirror if !(0..i64::from(size)).contains(&(place + step)) => step = -step,
                Wrap::Mirror => place += step,
            }
            here as u32
        };
        std::iter::repeat_with(next).take(reach as usize + 1).collect::<Vec<u32>>()
    };
    let below = walk(-1);
    below.into_iter().skip(1).rev().chain(walk(1)).collect()
}

pub(super) fn texels_wrap_as_they_should(trial: &Trial<'_>) -> Outcome {
    let wrap = prop_oneof![Just(Wrap::Repeat), Just(Wrap::Clamp), Just(Wrap::Mirror)];
    let queries =
        (-REACH..REACH, 1..9u32, wrap).prop_map(|(index, size, wrap)| TexelQuery { index, size, wrap });
    let judge = |queries: &[TexelQuery]| {
        compare(queries, trial.kit.texel(queries), |query, yours| {
            let expected = row(query.size, query.wrap, REACH)[(query.index + REACH) as usize];
            if yours == expected {
                return Ok(());
            }
            let remainder = query.index % i64::from(query.size);
            let size = i64::from(query.size);
            let yours_64 = i64::from(yours);
            let diagnosis = match query.wrap {
                _ if yours_64 >= size && query.wrap != Wrap::Repeat => "the last one is size - 1",
                Wrap::Repeat | Wrap::Mirror if yours_64 == query.index.clamp(0, size - 1) => {
                    "that is Wrap::Clamp, which draws out the border"
                }
                Wrap::Clamp | Wrap::Mirror if yours_64 == query.index.rem_euclid(size) => {
                    "that is Wrap::Repeat, which begins again"
                }
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
    };
    // Indices at which all mistakes give different columns.
    let drawn = [(-1, Wrap::Repeat), (5, Wrap::Clamp), (-1, Wrap::Mirror), (5, Wrap::Mirror)];
    judge(&drawn.map(|(index, wrap)| TexelQuery { index, size: 4, wrap }))
        .into_iter()
        .collect::<Outcome>()?;
    trial.forall(3000, queries, judge)
}

fn texture(width: u32, height: u32, wrap: Wrap) -> Texture {
    let pixel = |i: u32| {
        let mix = i.wrapping_mul(0x9e37_79b9);
        vec3((mix >> 28) as f32, (mix >> 24 & 15) as f32, (mix >> 20 & 15) as f32) / 15.0
    };
    Texture { width, height, pixels: Arc::new((0..width * height).map(pixel).collect()), wrap }
}

fn at(texture: &Texture, x: i64, y: i64) -> DVec3 {
    let inside = |index: i64, size| row(size, texture.wrap, index.abs())[(index + index.abs()) as usize];
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

/// Blended around the pixel that rounding towards 0 gives.
fn truncated(texture: &Texture, x: f64, y: f64) -> DVec3 {
    let (left, top) = (x.trunc(), y.trunc());
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
    let [width, height] = [texture.width, texture.height].map(f64::from);
    let (x, y) = (u * width - 0.5, (1.0 - v) * height - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let mixed = |right: f64, down: f64| {
        let row = |y: i64| at(texture, left as i64, y).lerp(at(texture, left as i64 + 1, y), right);
        row(top as i64).lerp(row(top as i64 + 1), down)
    };
    let beside = {
        let row = |y: i64| {
            let next = (left as i64 + 1).min(i64::from(texture.width) - 1);
            at(texture, left as i64, y).lerp(at(texture, next, y), x - left)
        };
        row(top as i64).lerp(row(top as i64 + 1), y - top)
    };
    let wrapped = |wrap| blended(&Texture { wrap, ..texture.clone() }, u, v);
    let by_columns = ((u * width).floor() * height + ((1.0 - v) * height).floor()) as usize;
    let powered = |power: f64| expected.map(|channel| channel.powf(power));
    let aligned = {
        let (u, v) = (u * (width - 1.0) / width, v * (height - 1.0) / height);
        blended(texture, u + half.0, v + half.1)
    };
    let diagnosis = match () {
        () if near(mixed(y - top, x - left)) => "the shares of columns and rows are exchanged",
        () if near(mixed(1.0 - (x - left), 1.0 - (y - top))) => {
            "the shares are turned around: the nearer a pixel, the more it counts"
        }
        () if near(mixed(x - left, 0.0)) => "blended along x only: blend the two rows as well",
        () if near(mixed(x - x.trunc(), y - y.trunc())) || near(truncated(texture, x, y)) => {
            "rounded towards 0: left of the first middle the pixel before begins, so take floor"
        }
        () if WRAPS.into_iter().any(|wrap| wrap != texture.wrap && near(wrapped(wrap))) => {
            "another wrap than the image has: take each of the four pixels through texel"
        }
        () if near(beside) => {
            "the pixel beside the last one is where the wrap says: take all four through texel"
        }
        () if near(aligned) => {
            "from the first middle to the last: (0, 0) and (1, 1) are corners of the image"
        }
        () if near(powered(2.0)) || near(powered(2.2)) || near(powered(0.5)) || near(powered(1.0 / 2.2)) => {
            "gamma: the pixels of the image are linear light already"
        }
        () if near(mixed(0.0, 0.0)) => "the upper left of the four pixels alone: blend them",
        () if near(nearest) => "the nearest pixel alone: blend the four around",
        () if near(blended(texture, u, 1.0 - v)) => {
            "upside down: v points up, and rows are stored from the top"
        }
        () if near(blended(texture, u + half.0, v - half.1)) => {
            "half a pixel off: the colour of a pixel belongs to its middle"
        }
        () if near(blended(texture, u + half.0, v)) || near(blended(texture, u, v - half.1)) => {
            "half a pixel off along one axis: the colour of a pixel belongs to its middle"
        }
        () if texture.pixels.get(by_columns).is_some_and(|pixel| near(pixel.as_dvec3())) => {
            "column by column: the image is stored row by row"
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
    // Between four pixels of an image that is not square, and then around its border.
    let drawn = [(0.55, 0.7), (0.05, 0.95), (1.3, -0.2)]
        .map(|(u, v)| TextureQuery { texture: texture(4, 3, Wrap::Mirror), uv: vec2(u, v) });
    compare(&drawn, trial.kit.texture_color(&drawn), judge).into_iter().collect::<Outcome>()?;
    trial.forall(2000, queries, |queries| compare(queries, trial.kit.texture_color(queries), judge))
}

pub(super) fn images_survive_nonsense(trial: &Trial<'_>) -> Outcome {
    let strange = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, f32::MAX, f32::MIN, 1e30, -0.0, 1e-40];
    for wrap in WRAPS {
        let image = texture(3, 2, wrap);
        let query = |u, v| TextureQuery { texture: image.clone(), uv: vec2(u, v) };
        // One at a time first, so that it is clear which coordinate it is.
        let single = strange.iter().flat_map(|&share| [(share, 0.5), (0.5, share)]);
        for (u, v) in single.chain(strange.iter().flat_map(|&u| strange.map(|v| (u, v)))) {
            let input = format!("texture_color of 3 by 2 pixels, Wrap::{wrap:?}, at {:?}", vec2(u, v));
            let yours = match mishap::catch(|| trial.kit.texture_color(&[query(u, v)])[0]) {
                Ok(color) => color,
                Err(Mishap::Panicked { message, place }) => {
                    let yours = format!("a panic at {place}: {message}");
                    let broken = Broken::told(input, yours, "a colour", "the definition");
                    let overflow = message.contains("overflow");
                    return Err(broken
                        .looks_like(overflow.then_some(
                            "the column beside the last number there is: add with saturating_add",
                        )));
                }
                Err(mishap) => mishap::unwind(mishap),
            };
            if !(yours.min_element() >= -1e-6 && yours.max_element() <= 1.0 + 1e-6) {
                let broken =
                    Broken::new(input, yours, "a colour between those of the image", "a blend of them");
                return Err(broken.looks_like(Some(match (u.is_finite(), v.is_finite()) {
                    (true, true) => "NaN: the place overflows, so look at it after multiplying by the size",
                    _ => "NaN: a coordinate that is not finite counts as 0",
                })));
            }
            let finite = [u, v].map(|share| if share.is_finite() { share } else { 0.0 });
            if (u.is_finite() && v.is_finite()) || finite.iter().any(|share| share.abs() > 1.0) {
                continue;
            }
            let expected = blended(&image, f64::from(finite[0]), f64::from(finite[1])).as_vec3();
            if (yours - expected).abs().max_element() > 2e-5 {
                let broken =
                    Broken::new(input, yours, expected, "a coordinate that is not finite counts as 0");
                let top = blended(&image, f64::from(finite[0]), 1.0).as_vec3();
                let upper = !v.is_finite() && (yours - top).abs().max_element() <= 2e-5;
                return Err(
                    broken.looks_like(upper.then_some("v counts as 1: 0 is the lower border of the image"))
                );
            }
        }
    }
    Ok(())
}
