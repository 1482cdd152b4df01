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
        (
            all(&|[column, row]| color([column, 2 - row])),
            "your image is upside down: v points up, and rows are stored from the top",
        ),
        (all(&|[column, row]| color([3 - column, row])), "your image is reversed: u points to the right"),
        (
            all(&|[column, row]| {
                let number = 3 * column + row;
                color([number % 4, number / 4])
            }),
            "you read the pixels column by column: they are stored row by row",
        ),
        (
            [2.0, 2.2, 0.5, 1.0 / 2.2].into_iter().any(is_power),
            "you apply gamma: the pixels are linear light already",
        ),
        (
            signs.iter().any(|&x| signs.iter().any(|&y| shifted(x, y))),
            "you are half a pixel off: the colour of a pixel belongs to its centre",
        ),
        (
            signs.iter().any(|&one| shifted(one, 0) || shifted(0, one)),
            "you are half a pixel off along one axis: the colour of a pixel belongs to its centre",
        ),
        (
            stretched,
            "you stretch uv from the first to the last pixel centre: (0, 0) and (1, 1) are corners of the \
             image",
        ),
        ((0..12).all(|i| yours[i].is_nan()), "you return NaN"),
    ]))
}

/// Points on an image of 4 by 3 pixels with [`Wrap::Mirror`]: between four pixels, at the upper left corner, and outside.
const DRAWN: [(f32, f32); 3] = [(0.55, 0.7), (0.05, 0.95), (1.3, -0.2)];

/// The colours there. These and the colours of the mistakes were computed once in double precision and rounded to 6
/// digits.
const COLORS: [[f64; 3]; 3] =
    [[0.405_333, 0.653_333, 0.286_667], [0.0; 3], [0.361_333, 0.833_333, 0.226_667]];

/// The colours that mistakes give at the three points, each with its diagnosis.
const MISTAKES: [([[f64; 3]; 3], &str); 12] = [
    (
        [[0.365_333, 0.553_333, 0.186_667], [0.0; 3], [0.481_333, 0.393_333, 0.466_667]],
        "you exchange the weights of columns and rows",
    ),
    (
        [[0.352, 0.613_333, 0.18], [0.0; 3], [0.468, 0.3, 0.44]],
        "you exchange the weights w and 1 - w: the nearer a pixel, the larger its weight",
    ),
    (
        [[0.32, 0.84, 0.34], [0.0; 3], [0.333_333, 0.893_333, 0.213_333]],
        "you interpolate along x only: interpolate between the two rows, too",
    ),
    (
        [[0.386_667, 0.746_667, 0.146_667], [0.0; 3], [0.753_333, 0.74, 0.413_333]],
        "you interpolate along y only: interpolate between the two columns, too",
    ),
    (
        [COLORS[0], [-0.448_333, -0.571_667, -0.468_333], COLORS[2]],
        "you round towards 0: left of the first pixel's centre x is negative, so use floor",
    ),
    ([COLORS[0], COLORS[1], [0.8, 0.8, 0.4]], ANOTHER_WRAP),
    ([COLORS[0], COLORS[1], [0.396_667, 0.636_667, 0.156_667]], ANOTHER_WRAP),
    ([COLORS[0], [0.498, 0.230_333, 0.351_667], [0.396_667, 0.636_667, 0.156_667]], ANOTHER_WRAP),
    (
        [COLORS[0], COLORS[1], [0.753_333, 0.74, 0.413_333]],
        "you do not wrap the pixel next to the last one: get the column and row of all four from texel",
    ),
    (
        [[0.6, 0.933_333, 0.2], [0.0; 3], [0.8, 0.8, 0.4]],
        "you return the upper left of the four pixels: interpolate all four",
    ),
    (
        [[0.2, 0.8, 0.4], [0.0; 3], [0.133_333, 0.933_333, 0.133_333]],
        "you return the nearest pixel: interpolate the four around the point",
    ),
    (
        [[0.365_333, 0.721_333, 0.318_667], [1.0, 0.066_667, 0.733_333], [0.421_333, 0.713_333, 0.466_667]],
        "your image is upside down: v points up, and rows are stored from the top",
    ),
];

const ANOTHER_WRAP: &str =
    "you use another wrap mode than the image: call texel with texture.wrap for all four";

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
    let unlike = |colors: &[[f64; 3]; 3], near: f64| {
        (0..3).find(|&i| !(apart(yours[i], DVec3::from_array(colors[i])) < near))
    };
    if let Some(wrong) = unlike(&COLORS, NEAR) {
        let mistakes =
            MISTAKES.iter().map(|(colors, text)| (unlike(colors, NEAR_A_MISTAKE).is_none(), *text));
        let expected = DVec3::from_array(COLORS[wrong]);
        let broken = broken(&drawn[wrong], yours[wrong], expected, "double precision");
        return Err(broken.explained_by(mistakes));
    }
    trial.forall(2000, stretches(), |stretches| {
        let queries: Vec<TextureQuery> = stretches.iter().flat_map(Stretch::queries).collect();
        let yours = trial.kit.texture_color(&queries);
        let each = stretches.iter().zip(queries.chunks(7)).zip(yours.chunks(7));
        each.map(|((stretch, queries), yours)| judge_stretch(stretch, queries, yours)).collect()
    })
}
