//! The difference between two pictures, in linear light and as the eye sees it.

use anyhow::{Context, Result};
use glam::Vec3;
use image::RgbImage;
use raykata::film::{Film, encode_srgb};
use serde::Serialize;

/// Added to the square of the reference, so that black pixels do not dominate (PBRT and others use the same number).
const DARK: f64 = 0.01;

/// The errors of a picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Errors {
    /// Root mean square error over all channels of all pixels, in linear light.
    pub rmse: f64,
    /// Relative mean square error: the mean of `error² / (reference² + 0.01)`, which weights errors in the
    /// dark as the eye does.
    pub relative_mse: f64,
    /// Mean structural similarity of the pictures as a screen shows them (MSSIM, Wang and others, 2004): 1
    /// for equal pictures.
    pub similarity: f64,
    /// The mean of the signed differences over all channels of all pixels, in linear light: noise cancels in it, and what
    /// is left is the bias.
    pub bias: f64,
    /// The standard error of `bias`, from the differences of the pixels, whose random numbers are independent.
    pub bias_error: f64,
    /// The number of pixels with NaN. They count as black.
    pub not_a_number: usize,
}

/// The errors of `film` against the reference `right`, which has the same size.
pub fn errors(film: &Film, right: &Film) -> Result<Errors> {
    let pairs = || film.pixels.iter().zip(&right.pixels).flat_map(|(yours, right)| channels(*yours, *right));
    let count = (3 * right.pixels.len()).max(1) as f64;
    let square: f64 = pairs().map(|(yours, right)| (yours - right).powi(2)).sum();
    let relative: f64 = pairs().map(|(yours, right)| (yours - right).powi(2) / (right * right + DARK)).sum();
    let pixels = right.pixels.len().max(1) as f64;
    let signed = || {
        let of_pixel = |(yours, right): (&Vec3, &Vec3)| {
            channels(*yours, *right).iter().map(|(yours, right)| (yours - right) / 3.0).sum::<f64>()
        };
        film.pixels.iter().zip(&right.pixels).map(of_pixel)
    };
    let bias = signed().sum::<f64>() / pixels;
    let variance = signed().map(|difference| (difference - bias).powi(2)).sum::<f64>() / pixels;
    Ok(Errors {
        bias,
        bias_error: (variance / pixels).sqrt(),
        rmse: (square / count).sqrt(),
        relative_mse: relative / count,
        similarity: similarity(&shown(film)?, &shown(right)?),
        not_a_number: film.not_a_number(),
    })
}

/// Side of the windows of [`similarity`], in pixels.
const WINDOW: u32 = 8;

/// Mean structural similarity of two pictures of the same size, for the worst channel. The windows do not
/// overlap; those at the right and at the bottom may be smaller, and have a smaller weight.
fn similarity(yours: &RgbImage, right: &RgbImage) -> f64 {
    let (width, height) = right.dimensions();
    let corners = || {
        (0..width)
            .step_by(WINDOW as usize)
            .flat_map(|x| (0..height).step_by(WINDOW as usize).map(move |y| (x, y)))
    };
    let of_channel = |channel: usize| {
        let (mut sum, mut pixels) = (0.0, 0.0);
        for (x, y) in corners() {
            let window = move || {
                let rows = y..(y + WINDOW).min(height);
                rows.flat_map(move |y| (x..(x + WINDOW).min(width)).map(move |x| (x, y)))
            };
            let area = window().count() as f64;
            sum += area * similarity_of_window(yours, right, channel, window, area);
            pixels += area;
        }
        sum / pixels
    };
    [0, 1, 2].map(of_channel).into_iter().fold(1.0, f64::min)
}

/// Wang, Bovik, Sheikh and Simoncelli, "Image Quality Assessment: From Error Visibility to Structural Similarity", 2004,
/// equation 13, with sums over the window in place of variances.
fn similarity_of_window<I: Iterator<Item = (u32, u32)>>(
    yours: &RgbImage,
    right: &RgbImage,
    channel: usize,
    window: impl Fn() -> I,
    area: f64,
) -> f64 {
    const C1: f64 = (0.01 * 255.0) * (0.01 * 255.0);
    const C2: f64 = (0.03 * 255.0) * (0.03 * 255.0);
    let value = |picture: &RgbImage, (x, y): (u32, u32)| f64::from(picture.get_pixel(x, y).0[channel]);
    let mean = |picture: &RgbImage| window().map(|at| value(picture, at)).sum::<f64>() / area;
    let [p, q] = [mean(yours), mean(right)];
    let product = |one: &RgbImage, of_one: f64, other: &RgbImage, of_other: f64| {
        window().map(|at| (value(one, at) - of_one) * (value(other, at) - of_other)).sum::<f64>()
    };
    let [of_yours, of_right] = [product(yours, p, yours, p), product(right, q, right, q)];
    let together = product(yours, p, right, q);
    (2.0 * p * q + C1) * (2.0 * together + C2) / ((p.powi(2) + q.powi(2) + C1) * (of_yours + of_right + C2))
}

fn channels(yours: Vec3, right: Vec3) -> [(f64, f64); 3] {
    let number = |x: f32| if x.is_finite() { f64::from(x) } else { 0.0 };
    [0, 1, 2].map(|channel| (number(yours[channel]), number(right[channel])))
}

/// The picture as a screen shows it.
pub fn shown(film: &Film) -> Result<RgbImage> {
    let bytes = film.to_bytes(encode_srgb).rgb;
    RgbImage::from_raw(film.width, film.height, bytes).context("a film with too few pixels")
}

/// An image of the errors: black where there is none, then purple, orange, and white for `most` and more.
pub fn heat(film: &Film, right: &Film, most: f64) -> RgbImage {
    let mut map = RgbImage::new(right.width, right.height);
    for (pixel, (yours, right)) in map.pixels_mut().zip(film.pixels.iter().zip(&right.pixels)) {
        let square: f64 = channels(*yours, *right).iter().map(|(yours, right)| (yours - right).powi(2)).sum();
        *pixel = image::Rgb(glow(((square / 3.0).sqrt() / most.max(1e-12)).sqrt()));
    }
    map
}

/// A colour scale whose lightness grows steadily, so that it can be read in grey as well.
fn glow(share: f64) -> [u8; 3] {
    const STOPS: [[f64; 3]; 5] = [
        [0.0, 0.0, 0.0],
        [75.0, 15.0, 110.0],
        [200.0, 60.0, 75.0],
        [250.0, 165.0, 40.0],
        [255.0, 255.0, 235.0],
    ];
    let at = share.clamp(0.0, 1.0) * 4.0;
    let below = (at.floor() as usize).min(3);
    let part = at - below as f64;
    [0, 1, 2].map(|i| (STOPS[below][i] + part * (STOPS[below + 1][i] - STOPS[below][i])).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(value: f32) -> Film {
        Film { width: 16, height: 16, pixels: vec![Vec3::splat(value); 256] }
    }

    #[test]
    fn what_is_the_same_has_no_error() {
        let same = errors(&grey(0.5), &grey(0.5)).unwrap();
        assert_eq!((same.rmse, same.relative_mse, same.not_a_number), (0.0, 0.0, 0));
        // The mean over windows is taken in floating point.
        assert!((same.similarity - 1.0).abs() < 1e-9, "{same:?}");
    }

    #[test]
    fn an_error_everywhere_is_its_own_mean() {
        let off = errors(&grey(0.75), &grey(0.5)).unwrap();
        assert_eq!((off.rmse, off.bias, off.bias_error), (0.25, 0.25, 0.0));
        assert_eq!(errors(&grey(0.5), &grey(0.75)).unwrap().bias, -0.25);
        assert!((off.relative_mse - 0.0625 / 0.26).abs() < 1e-12);
        assert!(off.similarity < 1.0);
        assert_eq!(heat(&grey(0.75), &grey(0.5), 0.25).get_pixel(3, 3).0, [255, 255, 235]);
        assert_eq!(heat(&grey(0.5), &grey(0.5), 0.25).get_pixel(3, 3).0, [0, 0, 0]);
    }

    /// The expected values come from the crate image-compare 0.5.
    #[test]
    fn similarity_is_that_of_known_pictures() {
        let picture = |a: u32, b: u32| {
            RgbImage::from_fn(19, 13, |x, y| {
                image::Rgb([(x * a + y * b) as u8, (x * y * a) as u8, (x * x + b * y) as u8])
            })
        };
        for (yours, right, expected) in [
            ((3, 5), (3, 5), 1.0),
            ((3, 5), (4, 5), 0.364_119_339_277_121_76),
            ((7, 1), (2, 9), 0.184_997_282_288_125_98),
            ((10, 20), (11, 20), 0.214_850_935_070_057_67),
        ] {
            let found = similarity(&picture(yours.0, yours.1), &picture(right.0, right.1));
            assert!((found - expected).abs() < 1e-12, "{found} and not {expected}");
        }
    }

    #[test]
    fn what_is_no_number_is_counted() {
        let mut film = grey(0.5);
        film.pixels[0] = Vec3::NAN;
        let errors = errors(&film, &grey(0.5)).unwrap();
        assert_eq!(errors.not_a_number, 1);
        assert_eq!(errors.rmse, (0.25f64 / 256.0).sqrt());
    }
}
