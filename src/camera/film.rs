//! The film: one colour per pixel in linear light, and the files that it can be written to.

use crate::message;
use glam::Vec3;
use image::codecs::hdr::HdrEncoder;
use image::{ExtendedColorType, ImageEncoder, codecs::png::PngEncoder};
use serde::{Deserialize, Serialize};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// A picture in linear light, without limit above. Pixels are stored row by row from the top, each row from
/// the left.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Film {
    /// The number of pixels per row.
    pub width: u32,
    /// The number of rows.
    pub height: u32,
    /// The `width * height` colours, red, green and blue in linear radiance.
    pub pixels: Vec<Vec3>,
}

message! { Film { width, height, pixels } }

/// The radius of the Gaussian pixel filter along x and along y, in pixels.
pub const FILTER_RADIUS: f32 = 1.5;

/// The colour of a sample and its weight in the pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WeightedColor {
    /// The colour of the sample, in linear radiance.
    pub color: Vec3,
    /// The weight of the sample among those of its pixel, at least 0.
    pub weight: f32,
}

message! { WeightedColor { color, weight } }

/// How radiance above 1 is brought into the range that a screen can show. A curve is applied to each channel by itself, so
/// that no channel exceeds 1; very bright colours become white.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ToneCurve {
    /// `min(x, 1)`: no curve. All graded pictures are made with it.
    #[default]
    Clamp,
    /// `x / (1 + x)`, equation 3 of Reinhard, Stark, Shirley and Ferwerda, "Photographic Tone Reproduction for Digital
    /// Images", 2002, where it is applied to the luminance.
    Reinhard,
    /// `x (2.51 x + 0.03) / (x (2.43 x + 0.59) + 0.14)`, at most 1: a fit to the curve of the Academy Color Encoding System
    /// (ACES), which has more contrast, by Narkowicz, "ACES Filmic Tone Mapping Curve", 2015.
    Aces,
}

message! { enum ToneCurve { Clamp, Reinhard, Aces } }

impl ToneCurve {
    /// All curves, with their names in scene files.
    pub const ALL: [(&str, ToneCurve); 3] =
        [("clamp", ToneCurve::Clamp), ("reinhard", ToneCurve::Reinhard), ("aces", ToneCurve::Aces)];

    /// The value in `0..=1` that is shown for `x` of linear light. Negative values count as 0; NaN stays NaN.
    pub fn apply(self, x: f32) -> f32 {
        // At 1e6 all curves are within two millionths of their end, and the square of a much larger number overflows.
        let x = x.clamp(0.0, 1e6);
        let shown = match self {
            ToneCurve::Clamp => x,
            ToneCurve::Reinhard => x / (1.0 + x),
            ToneCurve::Aces => x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14),
        };
        shown.clamp(0.0, 1.0)
    }
}

/// Exposure and tone curve of a picture: `curve(2^exposure · x)` for each channel x of linear light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Tone {
    /// Exposure in stops: each stop doubles the light; 0 by default.
    pub exposure: f32,
    /// The curve, clamp by default.
    pub curve: ToneCurve,
}

message! { Tone { exposure, curve } }

impl Tone {
    /// The value in `0..=1` that is shown for `x` of linear light. Negative values count as 0; NaN stays NaN.
    pub fn apply(self, x: f32) -> f32 {
        self.curve.apply(self.exposure.exp2() * x)
    }
}

/// A picture of 8 bits per component and three components per pixel, as in a PNG file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Bytes {
    /// Red, green and blue of each pixel, row by row from the top.
    pub rgb: Vec<u8>,
    /// The number of pixels that had a NaN component; they are magenta in `rgb`.
    pub not_a_number: usize,
}

impl Film {
    /// A black film of `width` by `height` pixels.
    pub fn new(width: u32, height: u32) -> Self {
        Film { width, height, pixels: vec![Vec3::ZERO; width as usize * height as usize] }
    }

    /// The colour at column `x` and row `y`, `0 <= x < width` from the left and `0 <= y < height` from the
    /// top.
    ///
    /// # Panics
    ///
    /// If `y * width + x` is not an index of `pixels`. An `x` of `width` or more reads from a later row if
    /// there is one.
    pub fn at(&self, x: u32, y: u32) -> Vec3 {
        self.pixels[y as usize * self.width as usize + x as usize]
    }

    /// The number of pixels that have a NaN component.
    pub fn not_a_number(&self) -> usize {
        self.pixels.iter().filter(|pixel| pixel.is_nan()).count()
    }

    /// The number of pixels that have an infinite component and no NaN.
    pub fn infinite(&self) -> usize {
        self.pixels.iter().filter(|pixel| !pixel.is_finite() && !pixel.is_nan()).count()
    }

    /// The same picture as a screen shows it: each component is passed through `tone`, and lies in `0..=1` afterwards. Pixels
    /// with NaN components stay as they are.
    pub fn toned(&self, tone: Tone) -> Film {
        let shown = |pixel: &Vec3| if pixel.is_nan() { *pixel } else { pixel.map(|x| tone.apply(x)) };
        Film { pixels: self.pixels.iter().map(shown).collect(), ..*self }
    }

    /// The mean of each block of `scale` by `scale` pixels. What is left of a block at the right and below is left out.
    pub fn means(&self, scale: u32) -> Film {
        let mut means = Film::new(self.width / scale, self.height / scale);
        for (index, mean) in (0..).zip(&mut means.pixels) {
            let (x, y) = (index % means.width * scale, index / means.width * scale);
            let block = (0..scale * scale).map(|i| self.at(x + i % scale, y + i / scale));
            *mean = block.sum::<Vec3>() / (scale * scale) as f32;
        }
        means
    }

    /// The picture in bytes, each component of linear light passed through `encode`, for example
    /// [`encode_srgb`].
    ///
    /// NaN would turn black and would not be noticed. So pixels with NaN turn magenta and are counted;
    /// `encode` is not called for them.
    pub fn to_bytes(&self, encode: impl Fn(f32) -> u8) -> Bytes {
        let magenta = [255, 0, 255];
        let byte = |pixel: &Vec3| if pixel.is_nan() { magenta } else { pixel.to_array().map(&encode) };
        Bytes { rgb: self.pixels.iter().flat_map(byte).collect(), not_a_number: self.not_a_number() }
    }

    /// Writes the picture as a PNG file of 8 bits per component; see [`Film::to_bytes`] for `encode`.
    ///
    /// # Errors
    ///
    /// If the file cannot be written, or the picture has no pixels.
    ///
    /// # Panics
    ///
    /// If `pixels` does not have `width * height` colours.
    pub fn write_png(&self, file: &Path, encode: impl Fn(f32) -> u8) -> io::Result<()> {
        self.write_rgb(file, &self.to_bytes(encode).rgb)
    }

    /// The picture in sRGB bytes, rounded by ordered dithering, so that a smooth sky shows no bands: each pixel is rounded up from
    /// its own threshold in an 8 by 8 Bayer matrix (Bayer 1973). Red, green and blue of a pixel share it.
    pub fn dithered_srgb(&self) -> Vec<u8> {
        let bytes = |(index, pixel): (u32, &Vec3)| {
            // Interleave the lowest three bits of x ^ y and of y, the lowest bits first.
            let (x, y) = (index % self.width, index / self.width);
            let rank = (0..3).fold(0, |rank, bit| rank << 2 | ((x ^ y) >> bit & 1) << 1 | y >> bit & 1);
            let threshold = (rank as f32 + 0.5) / 64.0;
            pixel.to_array().map(|linear| (srgb_curve(linear) + threshold) as u8)
        };
        (0..).zip(&self.pixels).flat_map(bytes).collect()
    }

    /// Writes a PNG file of components that were encoded by the caller: `components` has red, green and blue
    /// of each pixel of this film, in the same order. Pixels that are NaN in the film turn magenta, as in
    /// [`Film::to_bytes`].
    ///
    /// # Errors
    ///
    /// If `components` does not have three bytes per pixel, if the file cannot be written, or if the picture
    /// has no pixels.
    ///
    /// # Panics
    ///
    /// If `pixels` does not have `width * height` colours.
    pub fn write_png_bytes(&self, file: &Path, components: &[u8]) -> io::Result<()> {
        if components.len() != 3 * self.pixels.len() {
            let (n_bytes, n_pixels) = (components.len(), self.pixels.len());
            return Err(io::Error::other(format!("{n_bytes} bytes for {n_pixels} pixels")));
        }
        let seen = self.to_bytes(|_| 0).rgb;
        let magenta = |(pixel, ours): (&[u8], &[u8])| {
            if pixel[0] > 0 { [255, 0, 255] } else { [ours[0], ours[1], ours[2]] }
        };
        let rgb: Vec<u8> = seen.chunks(3).zip(components.chunks(3)).flat_map(magenta).collect();
        self.write_rgb(file, &rgb)
    }

    fn write_rgb(&self, file: &Path, rgb: &[u8]) -> io::Result<()> {
        write_atomically(file, |out| {
            PngEncoder::new(out)
                .write_image(rgb, self.width, self.height, ExtendedColorType::Rgb8)
                .map_err(io::Error::other)
        })
    }

    /// Writes the picture as a Radiance HDR file: linear, with eight bits per component and a common
    /// exponent, each rounded to nearest, so that the largest component of a pixel is exact to 0.4 percent. Negative and
    /// NaN components become 0. The format has no infinity: components above 1e38 become 1e38.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    ///
    /// # Panics
    ///
    /// If `pixels` has fewer than `width * height` colours.
    pub fn write_hdr(&self, file: &Path) -> io::Result<()> {
        let pixels: Vec<image::Rgb<f32>> =
            self.pixels.iter().map(|pixel| image::Rgb(nearest_rgbe(*pixel).to_array())).collect();
        write_atomically(file, |out| {
            HdrEncoder::new(out)
                .encode(&pixels, self.width as usize, self.height as usize)
                .map_err(io::Error::other)
        })
    }
}

/// The sRGB byte for a component of linear light, by the curve of IEC 61966-2-1, rounded to nearest. Input
/// below 0 gives 0, input above 1 gives 255, and NaN gives 0.
pub fn encode_srgb(linear: f32) -> u8 {
    (srgb_curve(linear) + 0.5) as u8
}

/// The component of linear light, from 0 to 1, for one of sRGB in this range: the inverse of [`encode_srgb`]. Linear near black, a
/// power above.
pub fn decode_srgb(encoded: f32) -> f32 {
    if encoded <= 0.04045 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}

/// The curve of [`encode_srgb`] before it is rounded, from 0 to 255.
fn srgb_curve(linear: f32) -> f32 {
    let linear = linear.clamp(0.0, 1.0);
    255.0 * if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

/// Writes a file so that it is complete or absent: `write` fills a temporary file in the same folder, which
/// is then renamed to `file`. A failure removes the temporary file and leaves an existing `file` as it was.
///
/// # Errors
///
/// If `file` has no file name, if the temporary file cannot be created, if `write` fails, or if the file
/// cannot be renamed.
pub fn write_atomically(
    file: &Path,
    write: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
) -> io::Result<()> {
    let name = file.file_name().ok_or_else(|| io::Error::other("the path names no file"))?;
    let beside = file.with_file_name(format!(".{}.{}.part", name.to_string_lossy(), std::process::id()));
    let written = File::create(&beside).and_then(|out| {
        let mut out = BufWriter::new(out);
        write(&mut out)?;
        out.flush()
    });
    let placed = written.and_then(|()| fs::rename(&beside, file));
    if placed.is_err() {
        // Remove the incomplete file. If that fails as well, return the first error.
        let _ = fs::remove_file(&beside);
    }
    placed
}

/// The nearest colour that a pixel of four bytes can hold: whole steps, of which the largest component has 128 to 255. The
/// encoder rounds down, which changes such a colour no more.
fn nearest_rgbe(color: Vec3) -> Vec3 {
    // The largest exponent of the format is that of 1.7e38. A NaN is not above 0.
    let bounded = |value: f32| if value > 0.0 { value.min(1e38) } else { 0.0 };
    let color = Vec3::from_array(color.to_array().map(bounded));
    let largest = f64::from(color.max_element());
    // Numbers near the smallest of the format have fewer digits in single precision.
    if largest < 1e-38 {
        return Vec3::ZERO;
    }
    let mut step = (largest.log2().floor() - 7.0).exp2();
    if (largest / step).round() >= 256.0 {
        step *= 2.0;
    }
    ((color.as_dvec3() / step).round() * step).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tests::folder::Folder;

    #[test]
    fn the_srgb_curve_meets_its_published_points() {
        assert_eq!(encode_srgb(0.0), 0);
        assert_eq!(encode_srgb(1.0), 255);
        assert_eq!(encode_srgb(0.5), 188); // 0.7354 of the way up
        assert_eq!(encode_srgb(-1.0), 0);
        assert_eq!(encode_srgb(7.0), 255);
        assert_eq!(encode_srgb(0.002), 7); // on the straight part: 12.92 · 0.002 · 255 = 6.6
        assert!((0..=255u8).all(|byte| encode_srgb(decode_srgb(f32::from(byte) / 255.0)) == byte));
    }

    #[test]
    fn tone_curves_meet_the_points_of_their_formulas() {
        let [clamp, reinhard, aces] = ToneCurve::ALL.map(|(_, curve)| move |x: f32| curve.apply(x));
        assert_eq!([0.0, 0.25, 1.0, 7.0].map(clamp), [0.0, 0.25, 1.0, 1.0]);
        assert_eq!([0.0, 1.0, 3.0].map(reinhard), [0.0, 0.5, 0.75]);
        assert!((reinhard(f32::INFINITY) - 1.0).abs() < 2e-6);
        // 2.54 / 3.16 at 1; middle grey, 0.18, at 0.086724 / 0.324932; the curve reaches 1 a little above 7.
        for (x, shown) in [(0.0, 0.0), (0.18, 0.266_899), (1.0, 0.803_797), (8.0, 1.0), (f32::INFINITY, 1.0)]
        {
            assert!((aces(x) - shown).abs() < 1e-6, "{} at {x}", aces(x));
        }
        for (_, curve) in ToneCurve::ALL {
            assert_eq!(curve.apply(-1.0), 0.0);
            assert!(curve.apply(f32::NAN).is_nan());
            let values: Vec<f32> = (-40..=40).map(|stop| curve.apply((stop as f32 / 2.0).exp2())).collect();
            assert!(values.is_sorted() && values.iter().all(|shown| (0.0..=1.0).contains(shown)));
        }
    }

    #[test]
    fn a_stop_of_exposure_doubles_the_light() {
        let mut film = Film::new(3, 1);
        film.pixels[0] = Vec3::new(0.1, 0.2, 0.7);
        film.pixels[1] = Vec3::new(f32::NAN, 2.0, 0.5);
        film.pixels[2] = Vec3::splat(f32::INFINITY);
        let toned = film.toned(Tone { exposure: 1.0, curve: ToneCurve::Clamp });
        assert_eq!(toned.pixels[0], Vec3::new(0.2, 0.4, 1.0));
        assert_eq!((toned.not_a_number(), toned.pixels[2]), (1, Vec3::ONE));
        let darker = film.toned(Tone { exposure: -1.0, curve: ToneCurve::Reinhard });
        assert!((darker.pixels[0].z - 0.35 / 1.35).abs() < 1e-7);
        // Without exposure and curve the bytes are those of the film.
        assert_eq!(film.toned(Tone::default()).to_bytes(encode_srgb), film.to_bytes(encode_srgb));
    }

    #[test]
    fn a_pixel_that_is_not_a_number_is_seen_and_counted() {
        let mut film = Film::new(2, 1);
        film.pixels[1] = Vec3::new(0.5, f32::NAN, 0.5);
        let bytes = film.to_bytes(encode_srgb);
        assert_eq!(bytes.rgb, [0, 0, 0, 255, 0, 255]);
        assert_eq!(bytes.not_a_number, 1);
    }

    #[test]
    fn hdr_files_hold_the_nearest_colours() {
        let colors = [
            (Vec3::new(0.8, 0.05, 0.0099), Vec3::new(205.0, 13.0, 3.0) / 256.0),
            // 0.999 rounds to 256 steps, which the next exponent has as 128 steps of twice the size.
            (Vec3::new(0.999, 0.4990, 0.0117), Vec3::new(128.0, 64.0, 1.0) / 128.0),
            (Vec3::new(1.0, 255.0 / 256.0, -1.0), Vec3::new(1.0, 1.0, 0.0)),
            (Vec3::new(4.0, f32::NAN, 0.02), Vec3::new(4.0, 0.0, 1.0 / 32.0)),
            (Vec3::splat(1e-45), Vec3::ZERO),
        ];
        let folder = Folder::new("hdr");
        let mut film = Film::new(colors.len() as u32, 1);
        film.pixels = colors.map(|(color, _)| color).to_vec();
        film.write_hdr(&folder.path("colors.hdr")).expect("a picture");
        let back = image::open(folder.path("colors.hdr")).expect("a picture").into_rgb32f();
        for (pixel, (color, nearest)) in back.pixels().zip(colors) {
            assert_eq!(Vec3::from_array(pixel.0), nearest, "{color}");
        }
    }

    #[test]
    fn a_failed_write_leaves_nothing_behind() {
        let folder = Folder::new("film");
        let file = folder.path("picture.png");
        let result = write_atomically(&file, |_| Err(io::Error::other("no more light")));
        assert_eq!(result.unwrap_err().to_string(), "no more light");
        assert_eq!(fs::read_dir(folder.path("")).expect("the folder").count(), 0);
        let mut bright = Film::new(3, 2);
        bright.pixels[1] = Vec3::new(f32::INFINITY, f32::NAN, -1.0);
        bright.write_hdr(&folder.path("picture.hdr")).expect("a picture");
        fs::remove_file(folder.path("picture.hdr")).expect("the file");
        Film::new(3, 2).write_png(&file, encode_srgb).expect("a picture");
        assert_eq!(fs::read_dir(folder.path("")).expect("the folder").count(), 1);
    }
}
