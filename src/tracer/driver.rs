//! The frame driver: renders every pixel exactly once, on all cores, with the same result for any number of
//! threads. It looks up no random number that the scene does not need.

use crate::count::{Counts, Event, Tally, exact_tests};
use crate::effects::{Effect, Effects};
use crate::film::{Film, WeightedColor};
use crate::kit::{KitError, kit_error};
use crate::progress::{Tile, Watch};
use crate::random::{Points, Purpose, Sampler, Stratum};
use crate::rows::{Rows, TILE};
use glam::Vec3;
use rayon::prelude::*;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// What the frame driver needs to know before the first pixel: size, sampling, threads and seed.
#[derive(Clone, Copy, Debug)]
pub struct FrameSettings {
    /// The number of pixels per row.
    pub width: u32,
    /// The number of rows of the whole picture.
    pub height: u32,
    /// The rows to render, `end <= height`. Others than those of [`Rows::check`] change counts.
    pub rows: Rows,
    /// The number of rays from the camera per pixel, at least 1.
    pub samples_per_pixel: u32,
    /// How the samples are distributed over the pixel.
    pub sampler: Sampler,
    /// Whether rays start at random points of the lens.
    pub lens: bool,
    /// Whether each ray has a random time.
    pub motion: bool,
    /// Whether secondary rays or shadow rays need random numbers (area lights, glossy reflection).
    pub on_the_way: bool,
    /// The number of threads: 0 takes one per core, 1 stays on the calling thread.
    pub threads: usize,
    /// The seed of the random numbers: equal seeds give equal pictures.
    pub seed: u64,
}

impl FrameSettings {
    /// The same settings, with random numbers for those effects that `effects` lists and for no other.
    pub fn for_effects(self, effects: &Effects) -> Self {
        let on_the_way = effects.calls_for(Effect::AreaLights) || effects.calls_for(Effect::Glossy);
        FrameSettings { lens: effects.lens, motion: effects.motion, on_the_way, ..self }
    }
}

/// A sample of a pixel: which one it is, and the random numbers for its ray.
#[derive(Clone, Copy, Debug)]
pub struct CameraSample {
    /// The column of the pixel, from 0 at the left.
    pub column: u32,
    /// The row of the pixel, from 0 at the top.
    pub row: u32,
    /// The number of the sample within its pixel, from 0.
    pub sample: u32,
    /// The random numbers for the position in the pixel; `None` stands for its centre.
    pub pixel: Option<Stratum>,
    /// The random numbers for the point on the lens; `None` stands for its centre.
    pub lens: Option<Stratum>,
    /// The random number for the time, of which only `u.x` is used; `None` stands for the time at which the
    /// shutter opens.
    pub time: Option<Stratum>,
    /// Where the random numbers for lights and secondary rays are looked up; [`Points::UNUSED`] if the sample
    /// needs none.
    pub points: Points,
}

impl CameraSample {
    /// Looks up the random numbers for sample `sample` of the pixel in this column and row. The result
    /// depends on the arguments alone, so all threads agree.
    #[inline(always)]
    pub fn draw(settings: &FrameSettings, column: u32, row: u32, sample: u32) -> CameraSample {
        let samples = settings.samples_per_pixel.max(1);
        let FrameSettings { sampler, seed, lens, motion, on_the_way, .. } = *settings;
        let spread = sampler.spreads(samples);
        // Skip the address if no number is needed, which saves 5 % of a plain frame.
        let points = if spread || lens || motion || on_the_way {
            let pixel = u64::from(row) * u64::from(settings.width) + u64::from(column);
            Points::new(sampler, seed, pixel, sample, samples)
        } else {
            Points::UNUSED
        };
        let draw = |wanted: bool, purpose| wanted.then(|| points.stratum(purpose, 0, 1));
        CameraSample {
            column,
            row,
            sample,
            pixel: draw(spread, Purpose::Pixel),
            lens: draw(lens, Purpose::Lens),
            time: draw(motion, Purpose::Time),
            points,
        }
    }

    /// The number of random numbers that were looked up.
    fn random_numbers(&self) -> usize {
        2 * usize::from(self.pixel.is_some())
            + 2 * usize::from(self.lens.is_some())
            + usize::from(self.time.is_some())
    }
}

/// Renders a picture: calls `radiance` for the colour and weight of each sample, and `filter` for the colour
/// that the samples of a pixel make. Colours are linear radiance. The picture has only the rows that the settings ask for; they
/// are equal to these rows of the whole picture, because each pixel depends on its own samples only. Each tile has a tally of its own; the
/// counts of the result are their sum. The same settings give the same picture for any number of threads.
/// `None` if `watch` cancelled the frame.
///
/// # Panics
///
/// A panic of `radiance` or `filter` is passed on to the caller, as a [`KitError`] with the place where it
/// happened.
pub fn render<T: Tally>(
    settings: &FrameSettings,
    watch: &dyn Watch,
    radiance: impl Fn(&CameraSample, &mut T) -> WeightedColor + Sync,
    filter: impl Fn(&[WeightedColor]) -> Vec3 + Sync,
) -> Option<(Film, Counts)> {
    let FrameSettings { width, rows, .. } = *settings;
    let total = u64::from(width) * u64::from(rows.n_rows());
    let done = AtomicU64::new(0);
    let broken = AtomicBool::new(false);
    let wants_tiles = watch.wants_tiles();
    let tile = |corner: (u32, u32)| -> Result<Option<(Tile, Counts)>, KitError> {
        if watch.cancelled() || broken.load(Ordering::Relaxed) {
            return Ok(None);
        }
        // Catch the panic in its own thread, because a panic that crosses threads loses its file and line.
        let tile = kit_error::catch(|| render_tile::<T>(settings, corner, &radiance, &filter))
            .inspect_err(|_| broken.store(true, Ordering::Relaxed))?;
        let pixels = tile.0.pixels.len() as u64;
        if wants_tiles {
            watch.tile(&tile.0);
        }
        watch.progress(done.fetch_add(pixels, Ordering::Relaxed) + pixels, total);
        Ok(Some(tile))
    };
    // Render all tiles, on a pool of threads unless one thread is enough.
    let corners: Vec<(u32, u32)> = (rows.start..rows.end)
        .step_by(TILE as usize)
        .flat_map(|y| (0..width).step_by(TILE as usize).map(move |x| (x, y)))
        .collect();
    let tiles: Vec<Result<Option<(Tile, Counts)>, KitError>> = if settings.threads == 1 {
        corners.into_iter().map(tile).collect()
    } else {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(settings.threads).build();
        // Where no thread can be started, as in a sandbox, this thread does all the work.
        match pool {
            Ok(pool) => pool.install(|| corners.into_par_iter().map(tile).collect()),
            Err(_) => corners.into_iter().map(tile).collect(),
        }
    };

    // Pass a panic of a tile on.
    let tiles: Vec<Option<(Tile, Counts)>> =
        tiles.into_iter().collect::<Result<_, _>>().unwrap_or_else(|error| kit_error::unwind(error));
    // Copy the tiles into the film, and add up their counts.
    let mut film = Film::new(width, rows.n_rows());
    let mut counts = Counts::default();
    for tile in tiles {
        let (mut tile, of_tile) = tile?;
        counts += of_tile;
        tile.y -= rows.start;
        tile.copy_to(&mut film);
    }
    Some((film, counts))
}

fn render_tile<T: Tally>(
    settings: &FrameSettings,
    (x, y): (u32, u32),
    radiance: &(impl Fn(&CameraSample, &mut T) -> WeightedColor + Sync),
    filter: &(impl Fn(&[WeightedColor]) -> Vec3 + Sync),
) -> (Tile, Counts) {
    let right = settings.width.min(x + TILE);
    let bottom = settings.rows.end.min(y + TILE);
    let mut tally = T::default();
    let before = exact_tests();
    let mut samples = Vec::new();
    // Compute the radiance of one sample, and count its random numbers.
    let mut sample_pixel = |column, row, sample| {
        let sample = CameraSample::draw(settings, column, row, sample);
        for _ in 0..sample.random_numbers() {
            tally.note(Event::RandomNumber);
        }
        radiance(&sample, &mut tally)
    };
    // Filter the samples of one pixel.
    let mut render_pixel = |(column, row)| {
        if settings.samples_per_pixel == 1 {
            return filter(&[sample_pixel(column, row, 0)]);
        }
        samples.clear();
        samples.extend((0..settings.samples_per_pixel).map(|sample| sample_pixel(column, row, sample)));
        filter(&samples)
    };
    let pixels = (y..bottom)
        .flat_map(|row| (x..right).map(move |column| (column, row)))
        .map(&mut render_pixel)
        .collect();
    let exact_tests = if T::COUNTS { exact_tests() - before } else { 0 };
    (Tile { x, y, width: right - x, pixels }, Counts { exact_tests, ..tally.counts() })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn settings(width: u32, height: u32, samples_per_pixel: u32, threads: usize) -> FrameSettings {
        let sampler = Sampler::LowDiscrepancy;
        FrameSettings {
            width,
            height,
            rows: Rows::all(height),
            samples_per_pixel,
            sampler,
            lens: false,
            motion: false,
            on_the_way: false,
            threads,
            seed: 7,
        }
    }

    fn mean(samples: &[WeightedColor]) -> Vec3 {
        samples.iter().map(|sample| sample.color).sum::<Vec3>() / samples.len() as f32
    }

    #[test]
    fn only_what_is_called_for_is_drawn() {
        let plain = settings(4, 4, 1, 1);
        let drawn = |settings: &FrameSettings| {
            let sample = CameraSample::draw(settings, 1, 2, 0);
            (sample.pixel.is_some(), sample.lens.is_some(), sample.time.is_some(), sample.random_numbers())
        };
        // One low-discrepancy sample lies in the centre.
        assert_eq!(drawn(&plain), (false, false, false, 0));
        assert_eq!(drawn(&FrameSettings { samples_per_pixel: 2, ..plain }), (true, false, false, 2));
        assert_eq!(
            drawn(&FrameSettings { samples_per_pixel: 2, sampler: Sampler::Center, ..plain }),
            (false, false, false, 0)
        );
        let effects = Effects { lens: true, motion: true, ..Effects::default() };
        assert_eq!(drawn(&plain.for_effects(&effects)), (false, true, true, 3));
    }

    #[test]
    fn what_else_is_drawn_changes_no_number() {
        for sampler in [Sampler::Random, Sampler::Jittered, Sampler::LowDiscrepancy] {
            let plain = FrameSettings { sampler, ..settings(4, 4, 8, 1) };
            let all = FrameSettings { lens: true, motion: true, ..plain };
            for sample in 0..8 {
                let [plain, all] = [plain, all].map(|settings| CameraSample::draw(&settings, 3, 1, sample));
                assert_eq!(plain.pixel, all.pixel);
                let light = |sample: &CameraSample| sample.points.stratum(Purpose::Light(0), 1, 4);
                assert_eq!(light(&plain), light(&all));
            }
        }
    }

    #[test]
    fn tiles_make_the_picture_and_fit_into_it() {
        struct Tiles(std::sync::Mutex<Film>);
        impl Watch for Tiles {
            fn progress(&self, _: u64, _: u64) {}
            fn wants_tiles(&self) -> bool {
                true
            }
            fn tile(&self, tile: &Tile) {
                assert!(
                    tile.fits(50, 33) && !tile.fits(tile.x + tile.width - 1, 33) && !tile.fits(50, tile.y)
                );
                tile.copy_to(&mut self.0.lock().unwrap());
            }
        }
        let watch = Tiles(std::sync::Mutex::new(Film::new(50, 33)));
        let place = |sample: &CameraSample, _: &mut Counts| WeightedColor {
            color: Vec3::new(sample.column as f32, sample.row as f32, 1.0),
            weight: 1.0,
        };
        let (film, _) = render::<Counts>(&settings(50, 33, 1, 2), &watch, place, mean).unwrap();
        assert_eq!(*watch.0.lock().unwrap(), film);
        for wrong in [
            Tile { x: 0, y: 0, width: 0, pixels: vec![] },
            Tile { x: 0, y: 0, width: 2, pixels: vec![Vec3::ONE] },
        ] {
            assert!(!wrong.fits(50, 33));
        }
        assert!(!Tile { x: u32::MAX, y: 0, width: u32::MAX, pixels: vec![] }.fits(50, 33));
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
        let watch = Impatient(AtomicU64::new(0));
        let white = |_: &CameraSample, _: &mut Counts| WeightedColor { color: Vec3::ONE, weight: 1.0 };
        assert!(render::<Counts>(&settings(64, 64, 1, 1), &watch, white, mean).is_none());
        assert_eq!(watch.0.load(Ordering::Relaxed), 256); // one tile and no more
    }
}
