//! Comparison of pictures with golden pictures.
//!
//! The metric: a pixel differs if one of its channels is off by more than 8 of 255 after gamma 2. Only a stated
//! fraction of the pixels may differ, because correct methods round differently along outlines. Pictures of random samples
//! are compared by the means of blocks of pixels (`blocks`).

mod blocks;
mod replay;

pub use blocks::Sampled;
pub use replay::{Replay, Replayed};

use crate::broken::{Broken, CheckResult, Png};
use crate::golden as golden_texts;
use crate::paste::Paste;
use crate::trial::Trial;
use glam::Vec3;
use image::RgbImage;
use raykata::camera::Camera;
use raykata::film::{Film, write_atomically};
use raykata::kit::Kit;
use raykata::ray::Ray;
use std::io::{self, Write};
use std::path::PathBuf;

/// The largest accepted error of a channel, of 255.
const CHANNEL_TOLERANCE: u8 = 8;

/// The size of a picture in pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// The number of columns.
    pub width: u32,
    /// The number of rows.
    pub height: u32,
}

/// The size of pictures whose pixels need few answers.
pub const LARGE: Size = Size { width: 80, height: 60 };
/// The size of pictures whose pixels need many answers.
pub const SMALL: Size = Size { width: 48, height: 32 };

/// One ray through the middle of each pixel of a picture, row by row from the top. If the trial judges only a part of
/// its inputs, rows are left out.
///
/// Graded pictures are assembled here from the answers for many rays at once. So they show one stage only, and an error
/// in another stage does not change them.
pub fn rays(trial: &Trial<'_>, size: Size, eye: Vec3, target: Vec3) -> Vec<Ray> {
    let camera = camera(size, eye, target);
    let (width, height) = (size.width as f32, size.height as f32);
    pixels_of(trial, size)
        .filter(|(_, y)| (*y as usize).is_multiple_of(trial.row_step()))
        .map(|(x, y)| camera.ray((x as f32 + 0.5) / width, (y as f32 + 0.5) / height))
        .collect()
}

/// The camera of the pictures.
pub fn camera(size: Size, eye: Vec3, target: Vec3) -> Camera {
    let camera = Camera::new(eye, target - eye, Vec3::Y, 45.0, size.width as f32 / size.height as f32);
    camera.expect("the eye is not above its target")
}

/// The pixels of a picture, `(column, row)`, row by row from the top.
pub fn pixels(size: Size) -> impl Iterator<Item = (u32, u32)> {
    (0..size.height).flat_map(move |y| (0..size.width).map(move |x| (x, y)))
}

/// The pixels of a picture for which the trial asks: all, or the one that is [asked for again](Replay).
pub fn pixels_of(trial: &Trial<'_>, size: Size) -> impl Iterator<Item = (u32, u32)> {
    let only = trial.pixel().map(|replay| (replay.x, replay.y));
    pixels(size).filter(move |pixel| only.is_none_or(|only| only == *pixel))
}

/// The column of the ray `index` of [`rays`].
pub fn column(trial: &Trial<'_>, size: Size, index: usize) -> usize {
    trial.pixel().map_or(index % size.width as usize, |replay| replay.x as usize)
}

/// The picture that these colours make, in the order of [`rays`].
fn film_of_width(width: u32, pixels: Vec<Vec3>) -> Film {
    Film { width, height: pixels.len() as u32 / width, pixels }
}

/// A picture that is composed from answers.
pub struct Composed<'a> {
    /// The name of the golden picture.
    pub name: &'a str,
    /// The size of the whole picture.
    pub size: Size,
    /// The rays, of which each makes a pixel.
    pub rays: &'a [Ray],
    /// The fraction of pixels that may differ.
    pub may_differ: f64,
}

impl Composed<'_> {
    /// Composes the picture from the answers of the trial's kit, and compares it with the golden picture; or, for a hidden
    /// seed and with a reference to ask, with the picture that the answers of the reference make. `colors` returns the
    /// colour of each ray.
    #[track_caller]
    pub fn check(&self, trial: &Trial<'_>, colors: impl Fn(&dyn Kit) -> Vec<Vec3>) -> CheckResult {
        if let Some(replay) = trial.pixel() {
            let ray = self.rays.first().copied();
            return replay.show(self.name, self.size, ray, || colors(trial.kit).first().copied());
        }
        let film = film_of_width(self.size.width, colors(trial.kit));
        let golden = match trial.expected(&colors) {
            Some(expected) => image_of(&film_of_width(self.size.width, (*expected).clone())),
            None => match golden_picture(trial.row_step(), self.name, &film)? {
                Some(golden) => golden,
                None => return Ok(()),
            },
        };
        judge(trial, self, &Pair { name: self.name, film: &film, golden: &golden })
    }
}

/// A normal as a colour.
pub fn normal_color(normal: Vec3) -> Vec3 {
    0.5 * normal + 0.5
}

/// The rows of the golden picture `name` that are compared, one in `row_step`: [`rays`] left out the others. `None` if the
/// golden picture was just written from `film`: `INSTA_UPDATE=always cargo test -p solutions` writes it again.
fn golden_picture(row_step: usize, name: &str, film: &Film) -> Result<Option<RgbImage>, Broken> {
    if !golden_texts::is_sealed() && std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        let written = film.write_png(&golden_file(name), gamma());
        let broken = |error: io::Error| {
            Broken::with_texts(name, "cannot be written", error.to_string(), "the file system")
        };
        return written.map(|()| None).map_err(broken);
    }
    let golden = every_row(row_step, &read_golden(name)?);
    if (golden.width(), golden.height()) != (film.width, film.height) {
        let size = |width: u32, height: u32| format!("{width} × {height} pixels");
        let (yours, theirs) = (size(film.width, film.height), size(golden.width(), golden.height()));
        return Err(Broken::with_texts(input(name), yours, theirs, "the golden picture"));
    }
    Ok(Some(golden))
}

fn golden_file(name: &str) -> PathBuf {
    PathBuf::from(format!("{}/../golden/{name}.png", env!("CARGO_MANIFEST_DIR")))
}

fn read_golden(name: &str) -> Result<RgbImage, Broken> {
    let golden = image::open(golden_file(name)).map_err(|error| {
        Broken::with_texts(input(name), "a picture", error.to_string(), "the golden picture")
    })?;
    Ok(golden.to_rgb8())
}

fn input(name: &str) -> String {
    format!("the picture tests/golden/{name}.png")
}

/// A picture and the one that is expected.
struct Pair<'a> {
    name: &'a str,
    film: &'a Film,
    golden: &'a RgbImage,
}

impl Pair<'_> {
    /// The message, with the pictures side by side: as a part of the message for the grader, else as a file that a line of
    /// the message names. `text` gets that line.
    fn broken(&self, yours: &[u8], text: impl FnOnce(String) -> Broken) -> Broken {
        let wide = side_by_side(yours, self.golden);
        let (picture, written) = match golden_texts::is_sealed() {
            true => (png(&wide).ok().map(|bytes| Box::new(Png(bytes))), String::new()),
            false => (None, write_side_by_side(self.name, &wide)),
        };
        Broken { picture, ..text(written) }
    }
}

/// Compares two pictures pixel by pixel.
fn judge(trial: &Trial<'_>, composed: &Composed<'_>, pair: &Pair<'_>) -> CheckResult {
    let Pair { film, golden, .. } = pair;
    let Composed { size, rays, .. } = composed;
    let yours = film.to_bytes(gamma());
    let off: Vec<u8> = yours
        .rgb
        .chunks(3)
        .zip(golden.chunks(3))
        .map(|(yours, golden)| yours.iter().zip(golden).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0))
        .collect();
    let n_off = off.iter().filter(|&&off| off > CHANNEL_TOLERANCE).count();
    // The rows that are compared may contain all pixels that may differ.
    let may_differ = composed.may_differ * f64::from(size.width * size.height);
    if n_off as f64 <= may_differ && yours.not_a_number == 0 {
        return Ok(());
    }
    let worst = (0..off.len()).max_by_key(|&pixel| off[pixel]).unwrap_or(0);
    let (x, y) = (worst as u32 % film.width, worst as u32 / film.width);
    let not_a_number = match yours.not_a_number {
        0 => String::new(),
        n => format!(", and {n} are NaN"),
    };
    // A hidden picture cannot be asked for again, so its message has the ray.
    let replay = match trial.is_public() && trial.row_step() == 1 {
        true => replay::command(trial.name, x, y),
        false => format!("the ray of the worst pixel: {}", rays[worst].paste()),
    };
    Err(pair.broken(&yours.rgb, |written| {
        Broken::with_texts(
            format!("{}\n{written}{replay}", input(pair.name)),
            format!(
                "{n_off} of {} pixels differ, most at ({x}, {y}): {:?}{not_a_number}",
                off.len(),
                film.at(x, y)
            ),
            format!("at most {may_differ:.0} differ; there: {:?}", linear(golden, x, y)),
            "the golden picture",
        )
    }))
}

/// A film as a picture of bytes.
fn image_of(film: &Film) -> RgbImage {
    let bytes = film.to_bytes(gamma()).rgb;
    RgbImage::from_raw(film.width, film.height, bytes).unwrap_or_default()
}

/// The encoding with gamma 2: each code stands for the colours from halfway to the code below to halfway to the code
/// above.
fn gamma() -> impl Fn(f32) -> u8 {
    let starts: Vec<f32> = (1..=255).map(|code| ((code as f32 - 0.5) / 255.0).powi(2)).collect();
    move |linear| starts.partition_point(|start| *start <= linear) as u8
}

/// The picture with only one in `step` rows.
fn every_row(step: usize, picture: &RgbImage) -> RgbImage {
    let height = picture.height().div_ceil(step as u32);
    RgbImage::from_fn(picture.width(), height, |x, y| *picture.get_pixel(x, y * step as u32))
}

fn linear(picture: &RgbImage, x: u32, y: u32) -> Vec3 {
    Vec3::from_array(picture.get_pixel(x, y).0.map(|byte| (f32::from(byte) / 255.0).powi(2)))
}

/// The golden picture, yours, and four times their difference, side by side.
fn side_by_side(yours: &[u8], golden: &RgbImage) -> RgbImage {
    let (width, height) = golden.dimensions();
    let mut wide = RgbImage::new(3 * width + 8, height);
    for y in 0..height {
        for x in 0..width {
            let at = 3 * (y * width + x) as usize;
            let mine = [yours[at], yours[at + 1], yours[at + 2]];
            let theirs = golden.get_pixel(x, y).0;
            // Show four times the difference, so that a small one is visible.
            let difference = [0, 1, 2].map(|i| mine[i].abs_diff(theirs[i]).saturating_mul(4));
            for (column, pixel) in [theirs, mine, difference].into_iter().enumerate() {
                wide.put_pixel(column as u32 * (width + 4) + x, y, image::Rgb(pixel));
            }
        }
    }
    wide
}

fn png(picture: &RgbImage) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    let encoder = image::codecs::png::PngEncoder::new(&mut bytes);
    picture.write_with_encoder(encoder).map_err(io::Error::other)?;
    Ok(bytes)
}

/// Writes the pictures side by side, and returns a line with the name of the file.
fn write_side_by_side(name: &str, wide: &RgbImage) -> String {
    let folder = PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../out"));
    let file = folder.join(format!("{name}.png"));
    let written = png(wide).and_then(|bytes| {
        std::fs::create_dir_all(&folder)?;
        write_atomically(&file, |out| out.write_all(&bytes))
    });
    match written {
        Ok(()) => format!("reference | yours | difference: out/{name}.png\n"),
        Err(error) => format!("(out/{name}.png could not be written: {error})\n"),
    }
}
