//! The frame driver: every pixel once, on all cores, with the same result for any number of them.

use crate::count::{Counts, Tally};
use crate::film::Film;
use crate::kit::{Mishap, mishap};
use glam::Vec3;
use rand_core::Rng;
use rand_pcg::Pcg32;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Side of a tile in pixels: small enough to share the work out evenly, large enough that neighbours share caches.
const TILE: u32 = 16;

/// Random numbers of one pixel. They depend on the seed and the pixel alone, never on threads or on neighbours.
pub struct PixelRandom(Pcg32);

impl PixelRandom {
    /// The numbers of pixel number `pixel` under `seed`.
    pub fn new(seed: u64, pixel: u64) -> Self {
        // The pixel picks the stream, so no two pixels share a sequence, however long.
        PixelRandom(Pcg32::new(seed, pixel))
    }

    /// A number in `0.0..1.0`; never 1.0.
    pub fn unit(&mut self) -> f32 {
        // All 32 bits over 2³² would round up to 1.0 for 128 of the values (hard case D1); 24 bits fit exactly.
        (self.0.next_u32() >> 8) as f32 * (1.0 / 16_777_216.0)
    }
}

/// Someone who waits for a frame.
pub trait Watch: Sync {
    /// `done` of `total` pixels are finished. Called from any thread.
    fn progress(&self, done: u64, total: u64);

    /// Whether the frame is no longer wanted.
    fn cancelled(&self) -> bool {
        false
    }
}

/// Waits in silence.
pub struct Unwatched;

impl Watch for Unwatched {
    fn progress(&self, _: u64, _: u64) {}
}

/// What a frame needs to know before its first pixel.
#[derive(Clone, Copy, Debug)]
pub struct FrameSettings {
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Rays a pixel, at least 1.
    pub samples_per_pixel: u32,
    /// Threads; 0 takes one a core, 1 stays on the calling thread.
    pub threads: usize,
    /// Picks the random numbers.
    pub seed: u64,
}

/// Makes a picture by asking `radiance` for the colour at film positions in `0..1`, and adds up what was counted.
/// `None` if the watch cancelled it.
pub fn render<T: Tally>(
    settings: &FrameSettings,
    watch: &dyn Watch,
    radiance: impl Fn(f32, f32, &mut PixelRandom, &mut T) -> Vec3 + Sync,
) -> Option<(Film, Counts)> {
    let FrameSettings { width, height, .. } = *settings;
    let total = u64::from(width) * u64::from(height);
    let done = AtomicU64::new(0);
    let broken = AtomicBool::new(false);
    let tile = |corner: (u32, u32)| -> Result<Option<Tile>, Mishap> {
        if watch.cancelled() || broken.load(Ordering::Relaxed) {
            return Ok(None);
        }
        // Caught where it happens: a panic that crosses threads forgets its file and line.
        let tile = mishap::catch(|| render_tile::<T>(settings, corner, &radiance))
            .inspect_err(|_| broken.store(true, Ordering::Relaxed))?;
        let pixels = tile.pixels.len() as u64;
        watch.progress(done.fetch_add(pixels, Ordering::Relaxed) + pixels, total);
        Ok(Some(tile))
    };
    let corners: Vec<(u32, u32)> = (0..height)
        .step_by(TILE as usize)
        .flat_map(|y| (0..width).step_by(TILE as usize).map(move |x| (x, y)))
        .collect();
    let tiles: Vec<Result<Option<Tile>, Mishap>> = if settings.threads == 1 {
        corners.into_iter().map(tile).collect()
    } else {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(settings.threads).build();
        // Without threads of our own the shared pool does the same work.
        match pool {
            Ok(pool) => pool.install(|| corners.into_par_iter().map(tile).collect()),
            Err(_) => corners.into_par_iter().map(tile).collect(),
        }
    };

    let tiles: Vec<Option<Tile>> =
        tiles.into_iter().collect::<Result<_, _>>().unwrap_or_else(|mishap| mishap::unwind(mishap));
    let mut film = Film::new(width, height);
    let mut counts = Counts::default();
    for tile in tiles {
        let tile = tile?;
        counts += tile.counts;
        for (row, colors) in tile.pixels.chunks(tile.width as usize).enumerate() {
            let start = (tile.y as usize + row) * width as usize + tile.x as usize;
            film.pixels[start..start + colors.len()].copy_from_slice(colors);
        }
    }
    Some((film, counts))
}

struct Tile {
    x: u32,
    y: u32,
    width: u32,
    pixels: Vec<Vec3>,
    counts: Counts,
}

fn render_tile<T: Tally>(
    settings: &FrameSettings,
    (x, y): (u32, u32),
    radiance: &(impl Fn(f32, f32, &mut PixelRandom, &mut T) -> Vec3 + Sync),
) -> Tile {
    let right = settings.width.min(x + TILE);
    let bottom = settings.height.min(y + TILE);
    let mut tally = T::default();
    let pixels = (y..bottom)
        .flat_map(|row| (x..right).map(move |column| (column, row)))
        .map(|(column, row)| render_pixel(settings, column, row, &mut tally, radiance))
        .collect();
    Tile { x, y, width: right - x, pixels, counts: tally.counts() }
}

fn render_pixel<T: Tally>(
    settings: &FrameSettings,
    column: u32,
    row: u32,
    tally: &mut T,
    radiance: &(impl Fn(f32, f32, &mut PixelRandom, &mut T) -> Vec3 + Sync),
) -> Vec3 {
    let pixel = u64::from(row) * u64::from(settings.width) + u64::from(column);
    let mut random = PixelRandom::new(settings.seed, pixel);
    let samples = settings.samples_per_pixel.max(1);
    let mut sum = Vec3::ZERO;
    for sample in 0..samples {
        let (u, v) = position_in_pixel(sample, samples);
        let film_x = (column as f32 + u) / settings.width as f32;
        let film_y = (row as f32 + v) / settings.height as f32;
        sum += radiance(film_x, film_y, &mut random, tally);
    }
    sum / samples as f32
}

/// Where sample `sample` of `samples` lies in its pixel: on a Fibonacci lattice, the centre when there is one.
/// The patterns of the lecture (random, jittered, Gaussian) are exercises of stage 6.
fn position_in_pixel(sample: u32, samples: u32) -> (f32, f32) {
    const GOLDEN: f64 = 0.618_033_988_749_894_8;
    let u = (f64::from(sample) + 0.5) / f64::from(samples);
    let v = (0.5 + f64::from(sample) * GOLDEN).fract();
    (u as f32, v as f32)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::count::Event;

    fn noise(threads: usize) -> (Film, Counts) {
        let settings = FrameSettings { width: 50, height: 33, samples_per_pixel: 3, threads, seed: 7 };
        render::<Counts>(&settings, &Unwatched, |x, y, random, tally| {
            tally.note(Event::Primary);
            Vec3::new(x, y, random.unit())
        })
        .expect("nobody cancels")
    }

    #[test]
    fn any_number_of_threads_makes_the_same_picture() {
        let one = noise(1);
        assert_eq!(one.1.primary, 50 * 33 * 3);
        assert!(one.0.pixels.iter().all(|p| p.z < 1.0));
        assert_ne!(one.0.at(0, 0).z, one.0.at(1, 0).z);
        for threads in [2, 3, 8] {
            assert_eq!(noise(threads), one);
        }
    }

    #[test]
    fn a_single_sample_sits_in_the_middle_of_its_pixel() {
        assert_eq!(position_in_pixel(0, 1), (0.5, 0.5));
    }

    #[test]
    fn a_cancelled_frame_ends_early_and_gives_nothing() {
        struct Impatient(AtomicU64);
        impl Watch for Impatient {
            fn progress(&self, done: u64, _: u64) {
                self.0.store(done, Ordering::Relaxed);
            }
            fn cancelled(&self) -> bool {
                self.0.load(Ordering::Relaxed) > 0
            }
        }
        let settings = FrameSettings { width: 64, height: 64, samples_per_pixel: 1, threads: 1, seed: 0 };
        let watch = Impatient(AtomicU64::new(0));
        let frame = render::<Counts>(&settings, &watch, |_, _, _, _| Vec3::ONE);
        assert!(frame.is_none());
        assert_eq!(watch.0.load(Ordering::Relaxed), 256); // one tile and no more
    }
}
