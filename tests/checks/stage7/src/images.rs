//! Colours from images.

use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::judge::{compare, known};
use glam::{DVec3, Vec3, vec2, vec3};
use proptest::prelude::*;
use raykata::kit::{KitError, TexelQuery, TextureQuery, kit_error};
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

/// Colours go from 0 to 1. A place is rounded to a few units of 1e-7 of a coordinate up to 20 pixels.
const NEAR: f64 = 2e-5;

/// A diagnosis may be coarse: gamma makes a rounding of black 1e-4 large.
const NEAR_A_MISTAKE: f64 = 1e-3;

fn apart(yours: Vec3, right: DVec3) -> f64 {
    let apart = (yours.as_dvec3() - right).abs();
    if apart.is_nan() { f64::INFINITY } else { apart.max_element() }
}

fn broken(query: &TextureQuery, yours: Vec3, expected: DVec3, source: &'static str) -> Broken {
    let TextureQuery { texture, uv } = query;
    let input = format!(
        "texture_color of an image of {} by {} pixels, Wrap::{:?}, at {uv:?}",
        texture.width, texture.height, texture.wrap
    );
    Broken::new(input, yours, expected.as_vec3(), source)
}

/// The middle of a pixel, which may lie far outside, moved right and down by shares of a pixel.
fn place(texture: &Texture, [column, row]: [i64; 2], [right, down]: [f64; 2]) -> TextureQuery {
    let u = (column as f64 + 0.5 + right) / f64::from(texture.width);
    let v = 1.0 - (row as f64 + 0.5 + down) / f64::from(texture.height);
    TextureQuery { texture: texture.clone(), uv: vec2(u as f32, v as f32) }
}

pub(super) fn middles_of_pixels_show_the_pixel(trial: &Trial<'_>) -> Outcome {
    let texture = texture(4, 3, Wrap::Clamp);
    let pixels: Vec<[i64; 2]> = (0..12).map(|i| [i % 4, i / 4]).collect();
    let queries: Vec<TextureQuery> = pixels.iter().map(|&pixel| place(&texture, pixel, [0.0, 0.0])).collect();
    let yours = trial.kit.texture_color(&queries);
    let color = |[column, row]: [i64; 2]| at(&texture, column, row);
    let wrong = (0..12).find(|&i| !(apart(yours[i], color(pixels[i])) < NEAR));
    let Some(wrong) = wrong else { return Ok(()) };

    let all = |shown: &dyn Fn([i64; 2]) -> DVec3| {
        (0..12).all(|i| apart(yours[i], shown(pixels[i])) < NEAR_A_MISTAKE)
    };
    // The mean of a pixel and those beside it, as it is seen where four or two of them meet.
    let shifted = |x: i64, y: i64| {
        all(&|[column, row]| {
            let corners = [[0, 0], [x, 0], [0, y], [x, y]];
            corners.map(|[x, y]| color([column + x, row + y])).into_iter().sum::<DVec3>() / 4.0
        })
    };
    let signs = [-1, 1];
    // The colour 3/8 right of and 1/3 below the first middle, worked out once in double precision.
    let corner_to_corner = DVec3::new(0.255_556, 0.402_778, 0.238_889);
    let diagnosis = match () {
        () if all(&|[column, row]| color([column, 2 - row])) => {
            "upside down: v points up, and rows are stored from the top"
        }
        () if all(&|[column, row]| {
            let number = 3 * column + row;
            color([number % 4, number / 4])
        }) =>
        {
            "column by column: the image is stored row by row"
        }
        () if [2.0, 2.2, 0.5, 1.0 / 2.2]
            .into_iter()
            .any(|power| all(&|pixel| color(pixel).map(|channel| channel.powf(power)))) =>
        {
            "gamma: the pixels of the image are linear light already"
        }
        () if signs.iter().any(|&x| signs.iter().any(|&y| shifted(x, y))) => {
            "half a pixel off: the colour of a pixel belongs to its middle"
        }
        () if signs.iter().any(|&one| shifted(one, 0) || shifted(0, one)) => {
            "half a pixel off along one axis: the colour of a pixel belongs to its middle"
        }
        () if apart(yours[0], corner_to_corner) < NEAR_A_MISTAKE => {
            "from the first middle to the last: (0, 0) and (1, 1) are corners of the image"
        }
        () if yours[wrong].is_nan() => "NaN",
        () => "",
    };
    let broken = broken(&queries[wrong], yours[wrong], color(pixels[wrong]), "the pixel");
    Err(broken.looks_like(known(diagnosis)))
}

/// Places on an image of 4 by 3 pixels with [`Wrap::Mirror`]: between four pixels, at the upper left corner, and outside.
const DRAWN: [(f32, f32); 3] = [(0.55, 0.7), (0.05, 0.95), (1.3, -0.2)];

/// The colours there. Like those of the mistakes they were worked out once in double precision and rounded to 6 digits.
const COLORS: [[f64; 3]; 3] =
    [[0.405_333, 0.653_333, 0.286_667], [0.0; 3], [0.361_333, 0.833_333, 0.226_667]];

/// What mistakes make of the three places.
const MISTAKES: [([[f64; 3]; 3], &str); 12] = [
    (
        [[0.365_333, 0.553_333, 0.186_667], [0.0; 3], [0.481_333, 0.393_333, 0.466_667]],
        "the shares of columns and rows are exchanged",
    ),
    (
        [[0.352, 0.613_333, 0.18], [0.0; 3], [0.468, 0.3, 0.44]],
        "the shares are turned around: the nearer a pixel, the more it counts",
    ),
    (
        [[0.32, 0.84, 0.34], [0.0; 3], [0.333_333, 0.893_333, 0.213_333]],
        "blended along x only: blend the two rows as well",
    ),
    (
        [[0.386_667, 0.746_667, 0.146_667], [0.0; 3], [0.753_333, 0.74, 0.413_333]],
        "blended along y only: blend the two columns as well",
    ),
    (
        [COLORS[0], [-0.448_333, -0.571_667, -0.468_333], COLORS[2]],
        "rounded towards 0: left of the first middle the pixel before begins, so take floor",
    ),
    ([COLORS[0], COLORS[1], [0.8, 0.8, 0.4]], ANOTHER_WRAP),
    ([COLORS[0], COLORS[1], [0.396_667, 0.636_667, 0.156_667]], ANOTHER_WRAP),
    ([COLORS[0], [0.498, 0.230_333, 0.351_667], [0.396_667, 0.636_667, 0.156_667]], ANOTHER_WRAP),
    (
        [COLORS[0], COLORS[1], [0.753_333, 0.74, 0.413_333]],
        "the pixel beside the last one is where the wrap says: take all four through texel",
    ),
    (
        [[0.6, 0.933_333, 0.2], [0.0; 3], [0.8, 0.8, 0.4]],
        "the upper left of the four pixels alone: blend them",
    ),
    (
        [[0.2, 0.8, 0.4], [0.0; 3], [0.133_333, 0.933_333, 0.133_333]],
        "the nearest pixel alone: blend the four around",
    ),
    (
        [[0.365_333, 0.721_333, 0.318_667], [1.0, 0.066_667, 0.733_333], [0.421_333, 0.713_333, 0.466_667]],
        "upside down: v points up, and rows are stored from the top",
    ),
];

const ANOTHER_WRAP: &str = "another wrap than the image has: take each of the four pixels through texel";

/// Half a pixel of an image, in which the colour must change evenly.
#[derive(Clone, Debug)]
struct Stretch {
    texture: Texture,
    /// The pixel whose middle is the upper left corner of the four; it may lie outside.
    pixel: [i64; 2],
    /// Where the stretch begins and ends between two middles, in sixteenths.
    ends: [u32; 2],
    /// Where it is along the other axis, in eighths.
    across: u32,
}

impl Stretch {
    /// The middle of the pixel; then beginning, middle and end along x; then the same along y.
    fn queries(&self) -> [TextureQuery; 7] {
        let [begin, end] = self.ends.map(|end| f64::from(end) / 16.0);
        let across = f64::from(self.across) / 8.0;
        let at = |shares| place(&self.texture, self.pixel, shares);
        let middle = 0.5 * (begin + end);
        [
            at([0.0, 0.0]),
            at([begin, across]),
            at([middle, across]),
            at([end, across]),
            at([across, begin]),
            at([across, middle]),
            at([across, end]),
        ]
    }
}

fn stretches() -> impl Strategy<Value = Stretch> + Clone {
    let ends = (0..16u32, 1..=16u32).prop_map(|(p, q)| if p < q { [p, q] } else { [0, 16] });
    let image = (1..6u32, 1..6u32, (0..3usize).prop_map(|i| WRAPS[i]));
    (image, -12..18i64, -12..18i64, ends, 0..=8u32).prop_map(
        |((width, height, wrap), column, row, ends, across)| Stretch {
            texture: texture(width, height, wrap),
            pixel: [column, row],
            ends,
            across,
        },
    )
}

fn judge_stretch(stretch: &Stretch, queries: &[TextureQuery], yours: &[Vec3]) -> Outcome {
    let [column, row] = stretch.pixel;
    let pixel = at(&stretch.texture, column, row);
    if !(apart(yours[0], pixel) < NEAR) {
        let other = |wrap: &Wrap| at(&Texture { wrap: *wrap, ..stretch.texture.clone() }, column, row);
        let another = WRAPS.iter().any(|wrap| apart(yours[0], other(wrap)) < NEAR);
        let broken = broken(&queries[0], yours[0], pixel, "the pixel, in its middle");
        return Err(broken.looks_like(another.then_some(ANOTHER_WRAP)));
    }
    for (first, diagnosis) in [
        (1, "between the middles of two columns the colour must change evenly along x"),
        (4, "between the middles of two rows the colour must change evenly along y"),
    ] {
        let mean = 0.5 * (yours[first].as_dvec3() + yours[first + 2].as_dvec3());
        // Each of the three is rounded as in NEAR, which leaves room for that.
        if !(apart(yours[first + 1], mean) < NEAR) {
            let ends = [&queries[first], &queries[first + 2]].map(|query| query.uv);
            let source = "the mean of your colours at both ends of a stretch around it";
            let broken = broken(&queries[first + 1], yours[first + 1], mean, source);
            let diagnosis = format!("{diagnosis}; the ends are {:?} and {:?}", ends[0], ends[1]);
            return Err(broken.looks_like(Some(diagnosis)));
        }
    }
    Ok(())
}

/// What makes an image bilinear: in the middle of each pixel, also outside, it has the colour of the pixel, and between
/// four middles the colour changes evenly along both axes.
pub(super) fn images_are_blended(trial: &Trial<'_>) -> Outcome {
    let image = texture(4, 3, Wrap::Mirror);
    let drawn = DRAWN.map(|(u, v)| TextureQuery { texture: image.clone(), uv: vec2(u, v) });
    let yours = trial.kit.texture_color(&drawn);
    let unlike = |colors: &[[f64; 3]; 3], near: f64| {
        (0..3).find(|&i| !(apart(yours[i], DVec3::from_array(colors[i])) < near))
    };
    if let Some(wrong) = unlike(&COLORS, NEAR) {
        let mistake = MISTAKES.iter().find(|(colors, _)| unlike(colors, NEAR_A_MISTAKE).is_none());
        let expected = DVec3::from_array(COLORS[wrong]);
        let broken = broken(&drawn[wrong], yours[wrong], expected, "recorded, from double precision");
        return Err(broken.looks_like(mistake.map(|(_, diagnosis)| *diagnosis)));
    }
    trial.forall(2000, stretches(), |stretches| {
        let queries: Vec<TextureQuery> = stretches.iter().flat_map(Stretch::queries).collect();
        let yours = trial.kit.texture_color(&queries);
        let each = stretches.iter().zip(queries.chunks(7)).zip(yours.chunks(7));
        each.map(|((stretch, queries), yours)| judge_stretch(stretch, queries, yours)).collect()
    })
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
            let yours = match kit_error::catch(|| trial.kit.texture_color(&[query(u, v)])[0]) {
                Ok(color) => color,
                Err(KitError::Panicked { message, place }) => {
                    let yours = format!("a panic at {place}: {message}");
                    let broken = Broken::with_texts(input, yours, "a colour", "the definition");
                    let overflow = message.contains("overflow");
                    return Err(broken
                        .looks_like(overflow.then_some(
                            "the column beside the last number there is: add with saturating_add",
                        )));
                }
                Err(error) => kit_error::unwind(error),
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
            let [expected, top] =
                [finite[1], 1.0].map(|v| trial.kit.texture_color(&[query(finite[0], v)])[0]);
            if !(apart(yours, expected.as_dvec3()) < NEAR) {
                let source =
                    "your own colour with 0 in its place: a coordinate that is not finite counts as 0";
                let broken = Broken::new(input, yours, expected, source);
                let upper = !v.is_finite() && apart(yours, top.as_dvec3()) < NEAR;
                return Err(
                    broken.looks_like(upper.then_some("v counts as 1: 0 is the lower border of the image"))
                );
            }
        }
    }
    Ok(())
}
