//! Checks of `texture_color`.

use super::texels::{WRAPS, row};
use checks::prelude::*;
use raykata::material::{Texture, Wrap};
use std::sync::Arc;

fn texture(width: u32, height: u32, wrap: Wrap) -> Texture {
    texture_from(0, width, height, wrap)
}

/// The same with the colours of the pixels from number `first` on.
fn texture_from(first: u32, width: u32, height: u32, wrap: Wrap) -> Texture {
    let pixel = |i: u32| {
        let mix = first.wrapping_add(i).wrapping_mul(0x9e37_79b9);
        vec3((mix >> 28) as f32, (mix >> 24 & 15) as f32, (mix >> 20 & 15) as f32) / 15.0
    };
    Texture { width, height, pixels: Arc::new((0..width * height).map(pixel).collect()), wrap }
}

fn at(texture: &Texture, x: i64, y: i64) -> DVec3 {
    let inside = |index: i64, size| row(size, texture.wrap, index.abs())[(index + index.abs()) as usize];
    let (x, y) = (inside(x, texture.width), inside(y, texture.height));
    texture.pixels[(y * texture.width + x) as usize].as_dvec3()
}

/// Colours go from 0 to 1. A coordinate of up to 20 pixels is rounded to a few units of 1e-7 of its size.
const NEAR: f64 = 2e-5;

/// Answers this near to those of a mistake get its diagnosis: gamma enlarges a rounding error of black to 1e-4.
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
    Broken::new(input, yours, expected.as_vec3(), source).in_call(Request::TextureColor(vec![query.clone()]))
}

/// The centre of a pixel, which may lie far outside, moved right and down by fractions of a pixel.
fn place(texture: &Texture, [column, row]: [i64; 2], [right, down]: [f64; 2]) -> TextureQuery {
    let u = (column as f64 + 0.5 + right) / f64::from(texture.width);
    let v = 1.0 - (row as f64 + 0.5 + down) / f64::from(texture.height);
    TextureQuery { texture: texture.clone(), uv: vec2(u as f32, v as f32) }
}

pub(super) fn middles_of_pixels_show_the_pixel(trial: &Trial<'_>) -> CheckResult {
    let texture = texture_from(trial.varied(0, any::<u32>()), 4, 3, Wrap::Clamp);
    let pixels: Vec<[i64; 2]> = (0..12).map(|i| [i % 4, i / 4]).collect();
    let queries: Vec<TextureQuery> = pixels.iter().map(|&pixel| place(&texture, pixel, [0.0, 0.0])).collect();
    let yours = trial.kit.texture_color(&queries);
    let color = |[column, row]: [i64; 2]| at(&texture, column, row);
    let wrong = (0..12).find(|&i| !(apart(yours[i], color(pixels[i])) < NEAR));
    let Some(wrong) = wrong else { return Ok(()) };

    let all = |shown: &dyn Fn([i64; 2]) -> DVec3| {
        (0..12).all(|i| apart(yours[i], shown(pixels[i])) < NEAR_A_MISTAKE)
    };
    // The mean of a pixel and its neighbours, which is the colour where four or two of them meet.
    let shifted = |x: i64, y: i64| {
        all(&|[column, row]| {
            let corners = [[0, 0], [x, 0], [0, y], [x, y]];
            corners.map(|[x, y]| color([column + x, row + y])).into_iter().sum::<DVec3>() / 4.0
        })
    };
    let signs = [-1, 1];
    // From the first centre to the last one there are 3 pixels along u and 2 along v.
    let stretched = all(&|[column, row]| {
        let (x, y) = ((column as f64 + 0.5) * 3.0 / 4.0, (row as f64 + 0.5) * 2.0 / 3.0);
        let (left, top) = (x.floor() as i64, y.floor() as i64);
        let along = |row| color([left, row]).lerp(color([left + 1, row]), x.fract());
        along(top).lerp(along(top + 1), y.fract())
    });
    let is_power = |power: f64| all(&|pixel| color(pixel).map(|channel| channel.powf(power)));
    let broken = broken(&queries[wrong], yours[wrong], color(pixels[wrong]), "the pixel's colour");
    // Each mistake is compared with all twelve colours.
    Err(broken.explained_by([
        "your image is upside down: v points up, and rows are stored from the top".when(all(&|[
            column,
            row,
        ]| {
            color([column, 2 - row])
        })),
        (all(&|[column, row]| color([3 - column, row])), "your image is reversed: u points to the right"),
        "you read the pixels column by column: they are stored row by row".when(all(&|[column, row]| {
            let number = 3 * column + row;
            color([number % 4, number / 4])
        })),
        "the rows of your image begin at the wrong place: a row has as many pixels as the image is wide"
            .when(all(&|[column, row]| color([(3 * row + column) % 4, (3 * row + column) / 4]))),
        "you apply gamma: the pixels are linear light already"
            .when([2.0, 2.2, 0.5, 1.0 / 2.2].into_iter().any(is_power)),
        "you are half a pixel off: the colour of a pixel belongs to its centre"
            .when(signs.iter().any(|&x| signs.iter().any(|&y| shifted(x, y)))),
        "you are half a pixel off along one axis: the colour of a pixel belongs to its centre"
            .when(signs.iter().any(|&one| shifted(one, 0) || shifted(0, one))),
        "you stretch uv from the first to the last pixel centre: (0, 0) and (1, 1) are corners of the image"
            .when(stretched),
        ((0..12).all(|i| yours[i].is_nan()), "you return NaN"),
    ]))
}

/// Points on an image of 4 by 3 pixels with [`Wrap::Mirror`]: between four pixels, at the upper left corner, and outside.
const DRAWN: [(f32, f32); 3] = [(0.55, 0.7), (0.05, 0.95), (1.3, -0.2)];

/// The colours there, which were computed once in double precision and rounded to 6 digits.
const COLORS: [[f64; 3]; 3] =
    [[0.405_333, 0.653_333, 0.286_667], [0.0; 3], [0.361_333, 0.833_333, 0.226_667]];

/// How a wrong function reads an image.
#[derive(Clone, Copy, PartialEq)]
enum Reads {
    /// The weights of columns and rows are exchanged, or w and 1 - w; or a weight is 0, or rounded, or smoothed.
    ExchangedAxes,
    ExchangedWeights,
    AlongX,
    AlongY,
    UpperLeft,
    Nearest,
    OneWeightX,
    OneWeightY,
    Smooth,
    TowardsZero,
    /// The image is repeated before its wrap mode is asked.
    Repeated,
    Another(Wrap),
    /// The second column and row are those behind the first ones in the image: the last one, or the first one again.
    NextStays,
    NextStartsAgain,
    /// The second column and row are limited to the image, and not wrapped.
    NextClamped,
    /// The second column (0), row (1), or both (2), is at most the last one.
    NextLimited(usize),
    /// The second column, or row, is that before the first one.
    NextBefore(usize),
    UpsideDown,
}

const MISTAKES: [(Reads, &str); 23] = named![
    Reads::ExchangedAxes => "you exchange the weights of columns and rows",
    Reads::ExchangedWeights => "you exchange the weights w and 1 - w: the nearer a pixel, the larger its weight",
    Reads::OneWeightX => "you blend rows by the weight of columns: each axis has its own",
    Reads::OneWeightY => "you blend columns by the weight of rows: each axis has its own",
    Reads::AlongX => "you interpolate along x only: interpolate between the two rows, too",
    Reads::AlongY => "you interpolate along y only: interpolate between the two columns, too",
    Reads::TowardsZero => "you round towards 0: left of the first pixel's centre x is negative, so use floor",
    Reads::Repeated => ANOTHER_WRAP,
    Reads::Another(Wrap::Repeat) => ANOTHER_WRAP,
    Reads::Another(Wrap::Clamp) => ANOTHER_WRAP,
    Reads::Another(Wrap::Mirror) => ANOTHER_WRAP,
    Reads::NextStays => NEXT,
    Reads::NextStartsAgain => NEXT,
    Reads::NextClamped => NEXT,
    Reads::NextLimited(0) => NEXT,
    Reads::NextLimited(1) => NEXT,
    Reads::NextLimited(2) => NEXT,
    Reads::NextBefore(0) => BEFORE,
    Reads::NextBefore(1) => BEFORE,
    Reads::Smooth => "you smooth the weights: they are the distances themselves",
    Reads::UpperLeft => "you return the upper left of the four pixels: interpolate all four",
    Reads::Nearest => "you return the nearest pixel: interpolate the four around the point",
    Reads::UpsideDown => "your image is upside down: v points up, and rows are stored from the top",
];

const BEFORE: &str = "the second column and row are those before the first: they are those behind it";
const NEXT: &str =
    "you do not wrap the pixel next to the last one: get the column and row of all four from texel";

impl Reads {
    /// Whether this colour is that of the mistake. A point at the centre of a pixel may belong to the pixel before.
    fn gives(self, query: &TextureQuery, yours: Vec3) -> bool {
        let near = |x: f64, y: f64| apart(yours, self.color(query, x, y)) < NEAR_A_MISTAKE;
        let shifts = [-1e-5, 0.0, 1e-5];
        shifts.into_iter().any(|x| shifts.into_iter().any(|y| near(x, y)))
    }

    fn color(self, TextureQuery { texture, uv }: &TextureQuery, right: f64, down: f64) -> DVec3 {
        let [u, v] = [uv.x, uv.y].map(f64::from);
        let [u, v] = if self == Reads::Repeated { [u.rem_euclid(1.0), v.rem_euclid(1.0)] } else { [u, v] };
        let v = if self == Reads::UpsideDown { v } else { 1.0 - v };
        let (x, y) = (u * f64::from(texture.width) - 0.5 + right, v * f64::from(texture.height) - 0.5 + down);
        let first = [x, y].map(|x| if self == Reads::TowardsZero { x.trunc() } else { x.floor() });
        let (dx, dy) = (x - first[0], y - first[1]);
        let smooth = |w: f64| w * w * (3.0 - 2.0 * w);
        let (dx, dy) = match self {
            Reads::ExchangedAxes => (dy, dx),
            Reads::ExchangedWeights => (1.0 - dx, 1.0 - dy),
            Reads::OneWeightX => (dx, dx),
            Reads::OneWeightY => (dy, dy),
            Reads::AlongX => (dx, 0.0),
            Reads::AlongY => (0.0, dy),
            Reads::UpperLeft => (0.0, 0.0),
            Reads::Nearest => (dx.round(), dy.round()),
            Reads::Smooth => (smooth(dx), smooth(dy)),
            _ => (dx, dy),
        };
        let wrap = if let Reads::Another(wrap) = self { wrap } else { texture.wrap };
        let index = |at: i64, size: u32| row(size, wrap, at.abs())[(at + at.abs()) as usize];
        let both = |axis: usize, size: u32| {
            let at = first[axis] as i64;
            let next = match self {
                Reads::NextStays => (index(at, size) + 1).min(size - 1),
                Reads::NextStartsAgain => (index(at, size) + 1) % size,
                Reads::NextClamped => (at + 1).clamp(0, i64::from(size) - 1) as u32,
                Reads::NextLimited(other) if other == axis || other == 2 => {
                    index((at + 1).min(i64::from(size) - 1), size)
                }
                Reads::NextBefore(other) if other == axis => index(at - 1, size),
                _ => index(at + 1, size),
            };
            [index(at, size), next]
        };
        let ([left, right], [top, bottom]) = (both(0, texture.width), both(1, texture.height));
        let pixel = |x: u32, y: u32| texture.pixels[(y * texture.width + x) as usize].as_dvec3();
        let along = |y: u32| pixel(left, y).lerp(pixel(right, y), dx);
        along(top).lerp(along(bottom), dy)
    }
}

const ANOTHER_WRAP: &str = "your pixels are those of another wrap mode than that of the image: all four come from texel with texture.wrap";

/// An interval between two pixel centres, in which the colour must change linearly.
#[derive(Clone, Debug)]
struct Stretch {
    texture: Texture,
    /// The upper left of the four pixels around the interval; it may lie outside of the image.
    pixel: [i64; 2],
    /// The ends of the interval between the two centres, in sixteenths.
    ends: [u32; 2],
    /// The position along the other axis, in eighths.
    across: u32,
}

impl Stretch {
    /// The centre of the pixel; then begin, middle and end of the interval along x; then the same along y.
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

fn judge_stretch(stretch: &Stretch, queries: &[TextureQuery], yours: &[Vec3]) -> CheckResult {
    let [column, row] = stretch.pixel;
    let pixel = at(&stretch.texture, column, row);
    if !(apart(yours[0], pixel) < NEAR) {
        let other = |wrap: &Wrap| at(&Texture { wrap: *wrap, ..stretch.texture.clone() }, column, row);
        let another = WRAPS.iter().any(|wrap| apart(yours[0], other(wrap)) < NEAR);
        let broken = broken(&queries[0], yours[0], pixel, "the pixel's colour, at its centre");
        return Err(broken.explained_by([(another, ANOTHER_WRAP)]));
    }
    for (first, law) in [
        (1, "linear along x between the centres of two columns"),
        (4, "linear along y between the centres of two rows"),
    ] {
        let mean = 0.5 * (yours[first].as_dvec3() + yours[first + 2].as_dvec3());
        // Each of the three is rounded as NEAR allows.
        if !(apart(yours[first + 1], mean) < NEAR) {
            let ends = [&queries[first], &queries[first + 2]].map(|query| query.uv);
            let source = "the mean of your colours at the ends of an interval";
            let mut broken = broken(&queries[first + 1], yours[first + 1], mean, source);
            let [begin, end] = ends;
            broken.input +=
                &format!(",\nin the middle between {begin:?} and {end:?}: the colour must be {law}");
            return Err(broken);
        }
    }
    Ok(())
}

/// Checks the two laws of bilinear interpolation: at the centre of each pixel, also outside of the image, the colour is
/// that of the pixel, and between four centres it changes linearly along both axes.
pub(super) fn images_are_blended(trial: &Trial<'_>) -> CheckResult {
    let image = texture(4, 3, Wrap::Mirror);
    let drawn = DRAWN.map(|(u, v)| TextureQuery { texture: image.clone(), uv: vec2(u, v) });
    let yours = trial.kit.texture_color(&drawn);
    let judge = |(query, right): &(TextureQuery, [f64; 3]), yours: Vec3| {
        let expected = DVec3::from_array(*right);
        let broken = || broken(query, yours, expected, "double precision");
        if apart(yours, expected) < NEAR { Ok(()) } else { Err(broken()) }
    };
    let cases: Vec<(TextureQuery, [f64; 3])> = drawn.iter().cloned().zip(COLORS).collect();
    all_hold(compare_formulas(&cases, yours, judge, |(query, _), yours| {
        MISTAKES.map(|(reads, text)| (reads.gives(query, *yours), text)).to_vec()
    }))?;
    trial.forall(2000, stretches(), |stretches| {
        let queries: Vec<TextureQuery> = stretches.iter().flat_map(Stretch::queries).collect();
        let yours = trial.kit.texture_color(&queries);
        let cases: Vec<(&Stretch, &[TextureQuery])> = stretches.iter().zip(queries.chunks(7)).collect();
        let judge = |(stretch, queries): &(&Stretch, &[TextureQuery]), yours: &[Vec3]| {
            judge_stretch(stretch, queries, yours)
        };
        compare_formulas(&cases, yours.chunks(7).collect(), judge, |(_, queries), yours| {
            let all =
                |reads: Reads| queries.iter().zip(*yours).all(|(query, yours)| reads.gives(query, *yours));
            MISTAKES.map(|(reads, text)| (all(reads), text)).to_vec()
        })
    })
}
