//! A small frame whose accuracy is set by hand.

use crate::Touch;
use anyhow::{Context, Result};
use raykata::film::Film;
use raykata::frame::Unwatched;
use raykata::kit::{Kit, RenderJob, Rendering, View};
use raykata::scene::{Accelerator, Precision, Quality, Scene, TriangleMethod, load};
use std::cell::RefCell;
use std::path::Path;

thread_local! {
    /// The picture of the reference's best quality.
    static BEST: RefCell<Option<Vec<u8>>> = const { RefCell::new(None) };
}

/// The pixels of the frame and of the reference, as hexadecimal numbers. The handles are the places of triangle test and precision
/// in the lists of their names, the offset of rays, the place of the structure, the samples per pixel and the depth.
pub fn draw(kit: &dyn Kit, touch: &mut Touch) -> Result<String> {
    let scene = load::parse(Path::new("frame.toml"), include_str!("frame.toml"))?;
    let frame = |quality: Quality| -> Result<Rendering> {
        let scene = Scene { quality, ..scene.clone() };
        let job = RenderJob { scene, view: View::Shaded, seed: 0, threads: 1, count: true, reuse: false };
        kit.render(&job, &Unwatched).context("the frame was cancelled")
    };
    // Render the frame with the accuracy of the handles. Without a structure, one sample per pixel takes a second.
    let accelerator = Accelerator::NAMES[touch.whole(3, 0, 16) as usize].1;
    let most_samples = if accelerator == Accelerator::BruteForce { 1 } else { 16 };
    let quality = Quality {
        triangle_method: TriangleMethod::NAMES[touch.whole(0, 0, 6) as usize].1,
        precision: Precision::NAMES[touch.whole(1, 0, 1) as usize].1,
        ray_offset: touch.handles[2].clamp(0.0, 1.0) as f32,
        accelerator,
        samples_per_pixel: touch.whole(4, 1, most_samples),
        max_depth: touch.whole(5, 0, 8),
        ..Quality::default()
    };
    let made = frame(quality)?;
    // Render the reference the first time.
    if BEST.with_borrow(Option::is_none) {
        let quality = Quality { samples_per_pixel: 64, max_depth: 12, ..Quality::default() };
        BEST.set(Some(bytes(&frame(quality)?.film)));
    }
    // Compare what a screen shows.
    let (shown, expected) = (bytes(&made.film), BEST.with_borrow(Option::clone).unwrap_or_default());
    let squares = shown.iter().zip(&expected).map(|(a, b)| f64::from(a.abs_diff(*b)).powi(2));
    let error = (squares.sum::<f64>() / shown.len() as f64).sqrt() / 255.0;
    let counts = made.counts;
    touch.value("rays", counts.rays());
    touch.value("rays that leave the scene", counts.rays() - counts.shadow - counts.hits);
    touch.value("node visits", counts.node_visits);
    touch.value("box tests", counts.box_tests);
    touch.value("tests of primitives", counts.primitive_tests);
    touch.value("shadow acne, light leaks", format!("{}, {}", counts.shadow_acne, counts.light_leaks));
    touch.value("error (RMSE)", format!("{error:.5}"));
    let pixels = |bytes: &[u8]| bytes.iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    let (shown, expected) = (pixels(&shown), pixels(&expected));
    Ok(format!("<div class=\"frame\" data-shown=\"{shown}\" data-expected=\"{expected}\"></div>"))
}

/// Red, green and blue of all pixels, with a gamma of 2: a square root is rounded in the same way everywhere.
fn bytes(film: &Film) -> Vec<u8> {
    let encode = |linear: f32| (255.0 * linear.clamp(0.0, 1.0).sqrt()).round() as u8;
    film.pixels.iter().flat_map(|pixel| pixel.to_array()).map(encode).collect()
}
