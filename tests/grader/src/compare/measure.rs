//! Measuring: counts once, times by turns.

use super::rows::Row;
use anyhow::{Context, Result};
use indicatif::{ProgressBar, ProgressStyle};
use raykata::count::Counts;
use raykata::film::Film;
use raykata::frame::Unwatched;
use raykata::kit::{Kit, RenderJob, Rendering, StructureSize, View, mishap};
use raykata::scene::{Accelerator, Scene};
use serde::Serialize;

/// More tests than this are not made for one picture; a smaller one has to tell.
const MOST_TESTS: u64 = 400_000_000;

/// Who is measured, and how often.
pub struct Bench<'a> {
    pub kit: &'a dyn Kit,
    pub rounds: u32,
    pub threads: usize,
}

/// A row with what was measured.
#[derive(Clone, Debug, Serialize)]
pub struct Measured {
    #[serde(skip)]
    pub row: Row,
    pub name: String,
    /// Seconds to build, the median.
    pub build_seconds: f64,
    /// How large the structure is; nothing for brute force.
    pub size: Option<StructureSize>,
    /// Memory of the structure and of those inside instances.
    pub bytes: u64,
    pub counts: Counts,
    pub rays: u64,
    /// Nanoseconds a ray on all threads together, the median.
    pub nanoseconds: f64,
    /// Half the distance between the quartiles, as a share of the median.
    pub spread: f64,
    /// The picture was made at this many times fewer columns and rows, because it would take too long.
    pub slice: u32,
    /// Pixels that differ from those of the first picture of full size; nothing for a slice.
    pub different_pixels: Option<u64>,
    /// What the picture lacks.
    pub notes: Vec<String>,
    #[serde(skip)]
    pub film: Film,
}

impl Bench<'_> {
    /// Makes every picture once with counts, then all of them by turns without.
    pub fn measure(&self, scene: &Scene, rows: &[Row]) -> Result<Vec<Measured>> {
        let bar = ProgressBar::new(rows.len() as u64 * u64::from(1 + self.rounds));
        if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos} of {len}, {eta} left  {msg}") {
            bar.set_style(style);
        }
        let mut measured: Vec<Measured> = Vec::new();
        for row in rows {
            bar.set_message(row.name.clone());
            let one = self.counted(scene, row, &measured)?;
            measured.push(one);
            bar.inc(1);
        }
        let mut times = vec![(Vec::new(), Vec::new()); rows.len()];
        for _ in 0..self.rounds {
            for (one, (builds, renders)) in measured.iter().zip(&mut times) {
                bar.set_message(one.name.clone());
                let frame = self.frame(scene, &one.row, one.slice, false)?;
                builds.push(frame.build_seconds);
                renders.push(frame.render_seconds);
                bar.inc(1);
            }
        }
        bar.finish_and_clear();
        for (one, (mut builds, mut renders)) in measured.iter_mut().zip(times) {
            one.build_seconds = quartiles(&mut builds)[1];
            let [low, median, high] = quartiles(&mut renders);
            one.nanoseconds = 1e9 * median / one.rays.max(1) as f64;
            one.spread = (high - low) / (2.0 * median);
        }
        Ok(measured)
    }

    fn counted(&self, scene: &Scene, row: &Row, before: &[Measured]) -> Result<Measured> {
        let slice = match row.quality.accelerator {
            Accelerator::BruteForce => self.affordable_slice(scene, row)?,
            _ => 1,
        };
        let frame = self.frame(scene, row, slice, true)?;
        let reference = before.iter().find(|other| other.slice == 1);
        let different = |other: &Measured| {
            let same = |(p, q): &(&glam::Vec3, &glam::Vec3)| {
                p.to_array().map(f32::to_bits) == q.to_array().map(f32::to_bits)
            };
            let pairs = frame.film.pixels.iter().zip(&other.film.pixels);
            pairs.filter(|pair| !same(pair)).count() as u64
        };
        let different_pixels = (slice == 1).then(|| reference.map_or(0, different));
        Ok(Measured {
            row: row.clone(),
            name: row.name.clone(),
            build_seconds: frame.build_seconds,
            size: frame.structure,
            bytes: frame.structure.map_or(0, |size| size.bytes) + frame.bytes_of_parts,
            counts: frame.counts,
            rays: frame.counts.rays(),
            nanoseconds: 0.0,
            spread: 0.0,
            slice,
            different_pixels,
            notes: frame.notes,
            film: frame.film,
        })
    }

    /// By how much columns and rows are to be divided so that brute force ends today: asked of a tiny picture.
    fn affordable_slice(&self, scene: &Scene, row: &Row) -> Result<u32> {
        let film = scene.film;
        let tiny = (film.width.max(film.height) / 24).max(1);
        let frame = self.frame(scene, row, tiny, true)?;
        let tests = frame.counts.primitive_tests * u64::from(tiny) * u64::from(tiny);
        let slice = (tests as f64 / MOST_TESTS as f64).sqrt().ceil() as u32;
        Ok(slice.clamp(1, tiny))
    }

    fn frame(&self, scene: &Scene, row: &Row, slice: u32, count: bool) -> Result<Rendering> {
        let mut scene = scene.clone();
        scene.quality = row.quality;
        scene.film.width = (scene.film.width / slice).max(1);
        scene.film.height = (scene.film.height / slice).max(1);
        let job = RenderJob { scene, view: View::Shaded, seed: 0, threads: self.threads, count };
        mishap::catch(|| self.kit.render(&job, &Unwatched))?.context("the frame was cancelled")
    }
}

/// The lower quartile, the median and the upper quartile.
fn quartiles(times: &mut [f64]) -> [f64; 3] {
    times.sort_by(f64::total_cmp);
    let last = times.len().saturating_sub(1);
    [last / 4, last / 2, last - last / 4].map(|index| times.get(index).copied().unwrap_or_default())
}
