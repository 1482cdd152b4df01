//! A small frame whose accuracy is set by hand.

use crate::Touch;
use anyhow::{Context, Result};
use raykata::film::Film;
use raykata::frame::Unwatched;
use raykata::kit::{Kit, RenderJob, Rendering, View};

use raykata::scene::{Accelerator, Precision, Quality, Scene, TriangleMethod, load};
use std::cell::OnceCell;
use std::fmt::Write;
use std::path::Path;

/// The tests of triangles and spheres, in the order of the page.
const TESTS: [(TriangleMethod, Precision); 3] = [
    (TriangleMethod::Cramer, Precision::Single),
    (TriangleMethod::Watertight, Precision::Single),
    (TriangleMethod::Cramer, Precision::Double),
];

/// The offsets of secondary rays, in the order of the page; 0 takes the error bound of each point.
const OFFSETS: [f32; 6] = [0.0, 1e-8, 1e-6, 1e-4, 1e-2, 0.3];

/// The structures, in the order of the page.
const STRUCTURES: [Accelerator; 7] = [
    Accelerator::Bvh,
    Accelerator::WideBvh,
    Accelerator::Grid,
    Accelerator::Octree,
    Accelerator::KdTree,
    Accelerator::Bsp,
    Accelerator::BruteForce,
];

thread_local! {
    /// The picture of the reference's best quality.
    static BEST: OnceCell<Film> = const { OnceCell::new() };
}

/// The frame, the reference, and their difference, as canvases whose pixels are hexadecimal numbers. The handles are the numbers
/// of test, offset and structure, the samples per pixel, and the depth.
pub fn draw(kit: &dyn Kit, touch: &mut Touch) -> Result<String> {
    let scene = load::parse(Path::new("frame.toml"), include_str!("frame.toml"))?;
    let frame = |quality: Quality| -> Result<Rendering> {
        let scene = Scene { quality, ..scene.clone() };
        let job = RenderJob { scene, view: View::Shaded, seed: 0, threads: 1, count: true, reuse: false };
        kit.render(&job, &Unwatched).context("the frame was cancelled")
    };
    // Render the frame with the accuracy of the handles.
    let (triangle_method, precision) = TESTS[touch.whole(0, 0, 2) as usize];
    // Without a structure, a sample per pixel takes a second.
    let accelerator = STRUCTURES[touch.whole(2, 0, 6) as usize];
    let most_samples = if accelerator == Accelerator::BruteForce { 1 } else { 16 };
    let quality = Quality {
        triangle_method,
        precision,
        ray_offset: OFFSETS[touch.whole(1, 0, 5) as usize],
        accelerator,
        samples_per_pixel: touch.whole(3, 1, most_samples),
        max_depth: touch.whole(4, 0, 8),
        ..Quality::default()
    };
    let made = frame(quality)?;
    // Render the reference the first time.
    let best = BEST.with(|best| best.get().cloned());
    let best = best.map_or_else(
        || Ok(frame(Quality { samples_per_pixel: 64, max_depth: 12, ..Quality::default() })?.film),
        anyhow::Ok,
    )?;
    BEST.with(|kept| kept.set(best.clone()).ok());
    // Compare what a screen shows.
    let [shown, expected] = [&made.film, &best].map(bytes);
    let differences: Vec<u8> = shown.iter().zip(&expected).map(|(a, b)| a.abs_diff(*b)).collect();
    let squares: u64 = differences.iter().map(|&d| u64::from(d).pow(2)).sum();
    let error = (squares as f64 / differences.len() as f64).sqrt() / 255.0;

    let counts = made.counts;
    touch.value("rays", counts.rays());
    touch.value("rays that leave the scene", counts.rays() - counts.shadow - counts.hits);
    touch.value("box tests", counts.box_tests);
    touch.value("tests of primitives", counts.primitive_tests);
    touch.value("shadow acne, light leaks", format!("{}, {}", counts.shadow_acne, counts.light_leaks));
    touch.value("error (RMSE)", format!("{error:.5}"));
    let canvas = |name: &str, bytes: &[u8]| {
        let mut text =
            format!("<figure><canvas width=\"{}\" height=\"{}\" data-pixels=\"", best.width, best.height);
        bytes.iter().for_each(|byte| _ = write!(text, "{byte:02x}"));
        text + &format!("\"></canvas><figcaption>{name}</figcaption></figure>")
    };
    let parts = [("your frame", &shown), ("reference", &expected), ("difference", &differences)];
    Ok(parts.map(|(name, bytes)| canvas(name, bytes)).concat())
}

/// Red, green and blue of all pixels, with a gamma of 2: a square root is rounded in the same way everywhere.
fn bytes(film: &Film) -> Vec<u8> {
    let encode = |linear: f32| (255.0 * linear.clamp(0.0, 1.0).sqrt()).round() as u8;
    film.pixels.iter().flat_map(|pixel| pixel.to_array()).map(encode).collect()
}
