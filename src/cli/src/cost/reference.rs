//! The reference: the same scene with so many samples that its own error is small. It is kept between runs.
//!
//! It consists of batches with different seeds. Even and odd batches are summed separately; half of the
//! difference between the two means estimates the error of the reference. Each batch is kept, so a stopped
//! run continues where it was.

use super::ladder::least_depth;
use super::measure::Bench;
use super::measured::Reference;
use crate::fingerprint::fingerprint;
use crate::report::bar_of_steps;
use anyhow::{Context, Result};
use glam::{DVec3, Vec3};
use raykata::film::{Film, write_atomically};
use raykata::frame::Unwatched;
use raykata::message::to_bytes;
use raykata::scene::{Accelerator, NextEvent, Quality, Sampler, Scene, Split, TextureFilter};
use std::io::Write;
use std::path::Path;

/// Samples per pixel and batch.
const BATCH: u32 = 64;

/// The seed of the first batch, which differs from the seeds of all measurements.
const FIRST_SEED: u64 = 1 << 40;

/// Sums over batches.
struct Sums {
    batches: u32,
    /// The sums of the even batches and of the odd ones.
    halves: [Vec<DVec3>; 2],
}

/// The first bytes of a reference file. The number of batches follows, then the sums of the even batches and
/// of the odd ones, as little-endian numbers of 8 bytes.
const KEPT: &[u8; 8] = b"raykata1";

/// The scene with the most accurate value of every setting that changes the picture.
pub fn converged(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.quality = Quality {
        samples_per_pixel: BATCH,
        sampler: Sampler::LowDiscrepancy,
        light_samples: scene.quality.light_samples.max(1),
        texture_filter: TextureFilter::Bilinear,
        max_depth: scene.quality.max_depth.max(least_depth(&scene)),
        min_contribution: scene.quality.min_contribution.min(0.0003),
        next_event: NextEvent::On,
        clamp: 0.0,
        accelerator: Accelerator::Auto,
        split: Split::SurfaceArea,
        ray_offset: 0.0,
        ..scene.quality
    };
    scene
}

/// Renders the reference of `scene`, or continues the one in `cache`, until it has `samples` samples per
/// pixel. `code` names the code that renders. `None` if the program is being stopped; the finished batches
/// are kept.
pub fn reference(
    bench: &Bench<'_>,
    scene: &Scene,
    samples: u32,
    cache: &Path,
    code: &str,
) -> Result<Option<Reference>> {
    // The sums are kept in a file of their own.
    let bench = &Bench { kept: None, ..bench.of_reference() };
    let scene = converged(scene);
    let name = fingerprint([code.as_bytes(), &to_bytes(&scene)]);
    let file = cache.join(format!("{name}.sums"));
    let pixels = scene.film.width as usize * scene.film.height as usize;
    let mut sums = read(&file, pixels).unwrap_or_else(|| Sums {
        batches: 0,
        halves: [vec![DVec3::ZERO; pixels], vec![DVec3::ZERO; pixels]],
    });
    // The estimate of the error needs two batches.
    let wanted = samples.div_ceil(BATCH).max(2);
    let bar = bar_of_steps(wanted.saturating_sub(sums.batches) as usize);
    bar.set_message("reference");
    // A kept reference may have more batches than requested.
    while sums.batches < wanted {
        let job = bench.job(&scene, FIRST_SEED + u64::from(sums.batches), false);
        let Some(frame) = bench.render(&job, None, &Unwatched)? else {
            bar.finish_and_clear();
            return Ok(None);
        };
        let half = &mut sums.halves[sums.batches as usize % 2];
        half.iter_mut().zip(&frame.film.pixels).for_each(|(sum, pixel)| *sum += pixel.as_dvec3());
        sums.batches += 1;
        write(&file, &sums)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(Some(sums.reference(scene.film.width, scene.film.height)))
}

impl Sums {
    fn reference(&self, width: u32, height: u32) -> Reference {
        let odd = f64::from(self.batches / 2);
        let even = f64::from(self.batches) - odd;
        let [evens, odds] = &self.halves;
        let pairs = || evens.iter().zip(odds);
        let mean = |(a, b): (&DVec3, &DVec3)| -> Vec3 { ((a + b) / (even + odd)).as_vec3() };
        // The error of the mean is half of the difference between the means of the two halves.
        let square: f64 = pairs().map(|(a, b)| ((a / even - b / odd) / 2.0).length_squared()).sum();
        Reference {
            film: Film { width, height, pixels: pairs().map(mean).collect() },
            samples: self.batches * BATCH,
            own_error: (square / (3 * evens.len()).max(1) as f64).sqrt(),
        }
    }
}

/// The kept sums; `None` if there is no file or it cannot be used, so that the reference starts again.
fn read(file: &Path, pixels: usize) -> Option<Sums> {
    let bytes = std::fs::read(file).ok()?;
    let (batches, numbers) = bytes.strip_prefix(KEPT)?.split_first_chunk::<4>()?;
    let (words, rest) = numbers.as_chunks::<8>();
    let numbers: Vec<f64> = words.iter().map(|word| f64::from_le_bytes(*word)).collect();
    let whole = rest.is_empty() && numbers.len() == 2 * 3 * pixels;
    let sums: Vec<DVec3> = numbers.chunks_exact(3).map(DVec3::from_slice).collect();
    let (even, odd) = sums.split_at_checked(pixels)?;
    whole.then(|| Sums { batches: u32::from_le_bytes(*batches), halves: [even.to_vec(), odd.to_vec()] })
}

fn write(file: &Path, sums: &Sums) -> Result<()> {
    crate::report::make_folder_of(file)?;
    let numbers = sums.halves.iter().flatten().flat_map(|sum| sum.to_array()).flat_map(f64::to_le_bytes);
    let bytes: Vec<u8> = KEPT.iter().copied().chain(sums.batches.to_le_bytes()).chain(numbers).collect();
    write_atomically(file, |out| out.write_all(&bytes))
        .with_context(|| format!("cannot keep the reference in {}", file.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_kept_comes_back_to_the_last_bit() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("deeper/one.sums");
        let sum = DVec3::new(0.1, 1.0 / 3.0, -1e-300);
        write(&file, &Sums { batches: 3, halves: [vec![sum; 2], vec![-sum; 2]] }).unwrap();
        let back = read(&file, 2).unwrap();
        assert_eq!((back.batches, back.halves), (3, [vec![sum; 2], vec![-sum; 2]]));
        assert!(read(&file, 3).is_none(), "it belongs to another picture");
        std::fs::write(&file, "half a fi").unwrap();
        assert!(read(&file, 2).is_none());
    }

    #[test]
    fn the_error_of_a_reference_is_that_of_its_mean() {
        let sums = Sums { batches: 2, halves: [vec![DVec3::splat(1.0)], vec![DVec3::splat(3.0)]] };
        let reference = sums.reference(1, 1);
        assert_eq!((reference.film.pixels[0], reference.own_error), (Vec3::splat(2.0), 1.0));
    }
}
