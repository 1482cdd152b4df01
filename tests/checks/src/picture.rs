//! Comparison of pictures with golden pictures.
//!
//! The metric: a pixel differs if one of its channels is off by more than 8 of 255 after gamma 2. Only a stated
//! fraction of the pixels may differ, because correct methods round differently along outlines.

use crate::broken::{Broken, CheckResult, Png};
use crate::golden as golden_texts;
use crate::paste::Paste;
use crate::trial::Trial;
use glam::Vec3;
use image::RgbImage;
use raykata::camera::Camera;
use raykata::film::{Film, write_atomically};
use raykata::ray::Ray;
use std::io::{self, Write};
use std::path::PathBuf;

/// The largest accepted error of a channel, of 255.
const CHANNEL_TOLERANCE: u8 = 8;

/// The size of the pictures that are assembled here.
const WIDTH: u32 = 80;
const HEIGHT: u32 = 60;

/// One ray through the middle of each pixel of a small picture, row by row from the top. If the trial judges only a part of
/// its inputs, rows are left out.
///
/// Graded pictures are assembled here from the answers for many rays at once. So they show one stage only, and an error
/// in another stage does not change them.
pub fn rays(trial: &Trial<'_>, eye: Vec3, target: Vec3) -> Vec<Ray> {
    let camera = Camera::new(eye, target - eye, Vec3::Y, 45.0, WIDTH as f32 / HEIGHT as f32);
    let camera = camera.expect("the eye is not above its target");
    let pixels = (0..HEIGHT).step_by(trial.row_step()).flat_map(|y| (0..WIDTH).map(move |x| (x, y)));
    pixels
        .map(|(x, y)| camera.ray((x as f32 + 0.5) / WIDTH as f32, (y as f32 + 0.5) / HEIGHT as f32))
        .collect()
}

/// The picture that these colours make, in the order of [`rays`].
pub fn film_of(pixels: Vec<Vec3>) -> Film {
    Film { width: WIDTH, height: pixels.len() as u32 / WIDTH, pixels }
}

/// A normal as a colour.
pub fn normal_color(normal: Vec3) -> Vec3 {
    0.5 * normal + 0.5
}

/// Compares `film`, whose pixels belong to `rays`, with the golden picture `name`. A fraction `may_differ` of the
/// pixels of the whole picture may differ. Rows that [`rays`] left out are not compared. `INSTA_UPDATE=always cargo test -p
/// solutions` writes the golden picture again.
pub fn compare(trial: &Trial<'_>, name: &str, film: &Film, rays: &[Ray], may_differ: f64) -> CheckResult {
    let golden_file =
        PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../golden")).join(format!("{name}.png"));
    let yours = film.to_bytes(gamma());
    if !golden_texts::is_sealed() && std::env::var("INSTA_UPDATE").is_ok_and(|update| update == "always") {
        let written = film.write_png(&golden_file, gamma());
        return written.map_err(|error| {
            Broken::with_texts(name, "cannot be written", error.to_string(), "the file system")
        });
    }
    let input = format!("the picture tests/golden/{name}.png");
    let golden = match image::open(&golden_file) {
        Ok(golden) => every_row(trial.row_step(), &golden.to_rgb8()),
        Err(error) => {
            return Err(Broken::with_texts(input, "a picture", error.to_string(), "the golden picture"));
        }
    };
    if (golden.width(), golden.height()) != (film.width, film.height) {
        let size = |width: u32, height: u32| format!("{width} × {height} pixels");
        let (yours, theirs) = (size(film.width, film.height), size(golden.width(), golden.height()));
        return Err(Broken::with_texts(input, yours, theirs, "the golden picture"));
    }
    let off: Vec<u8> = yours
        .rgb
        .chunks(3)
        .zip(golden.chunks(3))
        .map(|(yours, golden)| yours.iter().zip(golden).map(|(a, b)| a.abs_diff(*b)).max().unwrap_or(0))
        .collect();
    let n_off = off.iter().filter(|&&off| off > CHANNEL_TOLERANCE).count();
    // The rows that are compared may contain all pixels that may differ.
    let may_differ = may_differ * f64::from(WIDTH * HEIGHT);
    if n_off as f64 <= may_differ && yours.not_a_number == 0 {
        return Ok(());
    }
    let worst = (0..off.len()).max_by_key(|&pixel| off[pixel]).unwrap_or(0);
    let (x, y) = (worst as u32 % film.width, worst as u32 / film.width);
    let wide = side_by_side(&yours.rgb, &golden);
    let (picture, written) = match golden_texts::is_sealed() {
        true => (png(&wide).ok().map(|bytes| Box::new(Png(bytes))), String::new()),
        false => (None, write_side_by_side(name, &wide)),
    };
    let not_a_number = match yours.not_a_number {
        0 => String::new(),
        n => format!(", and {n} are NaN"),
    };
    let broken = Broken::with_texts(
        format!("{input}\n{written}the ray of the worst pixel: {}", rays[worst].paste()),
        format!(
            "{n_off} of {} pixels differ, most at ({x}, {y}): {:?}{not_a_number}",
            off.len(),
            film.at(x, y)
        ),
        format!("at most {may_differ:.0} differ; there: {:?}", linear(&golden, x, y)),
        "the golden picture",
    );
    Err(Broken { picture, ..broken })
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
