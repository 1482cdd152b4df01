//! Measuring: each picture once with counts, then all pictures in turn for times.

use super::rows::Row;
use crate::report::{bar_of_steps, job, quartiles, render};
use anyhow::Result;
use glam::Vec3;
use raykata::count::Counts;
use raykata::film::Film;
use raykata::kit::{Kit, RenderJob, Rendering, StructureSize};
use raykata::scene::{Accelerator, Scene, Split};
use serde::Serialize;
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// The most tests for one picture; where it needs more, a smaller picture is measured.
const MOST_QUESTIONS: u64 = 60_000_000;

/// The kit that is measured, and the number of rounds.
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
    /// The size of the structure; `None` for brute force.
    pub size: Option<StructureSize>,
    /// Bytes of the structure and of those of shared meshes.
    pub bytes: u64,
    pub counts: Counts,
    pub rays: u64,
    /// Nanoseconds per ray on all threads together, the median.
    pub nanoseconds: f64,
    /// Half the distance between the quartiles of the times, as a fraction of the median.
    pub spread: f64,
    /// The factor by which columns and rows were divided, because the whole picture would take too long; 1 if
    /// they were not.
    pub slice: u32,
    /// Number of pixels that differ from the picture of the hierarchy by surface area at the same size.
    pub different_pixels: u64,
    /// The largest difference of a channel of these pixels, in linear brightness.
    pub largest_difference: f32,
    /// What the picture lacks, one sentence each.
    pub notes: Vec<String>,
    #[serde(skip)]
    pub film: Film,
}

impl Bench<'_> {
    /// Renders every picture once with counts, then all of them in turn without counts.
    pub fn measure(&self, scene: &Scene, rows: &[Row]) -> Result<Vec<Measured>> {
        // Render each picture once with counts, as large as is affordable.
        let bar = bar_of_steps(rows.len() * (1 + self.rounds as usize));
        let mut measured: Vec<Measured> = Vec::new();
        let mut references = BTreeMap::new();
        for row in rows {
            bar.set_message(row.name.clone());
            match self.affordable_slice(scene, row)? {
                Some(slice) => measured.push(self.counted(scene, row, slice, &mut references)?),
                None => bar.suspend(|| {
                    println!("left out: {}, which would take minutes for a single pixel", row.name)
                }),
            }
            bar.inc(1);
        }
        // Time all pictures in turn.
        let mut times = vec![(Vec::new(), Vec::new()); measured.len()];
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
        // Take medians and quartiles.
        for (one, (builds, renders)) in measured.iter_mut().zip(times) {
            one.build_seconds = quartiles(builds)[1];
            let [low, median, high] = quartiles(renders);
            one.nanoseconds = 1e9 * median / one.rays.max(1) as f64;
            one.spread = (high - low) / (2.0 * median);
        }
        Ok(measured)
    }

    /// Renders one picture with counts; `references` are the pictures of the hierarchy, by slice.
    fn counted(
        &self,
        scene: &Scene,
        row: &Row,
        slice: u32,
        references: &mut BTreeMap<u32, Film>,
    ) -> Result<Measured> {
        let frame = self.frame(scene, row, slice, true)?;
        // Compare the picture with that of the hierarchy at the same size, bit by bit.
        let reference = match references.entry(slice) {
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(place) => {
                let mut quality = scene.quality;
                (quality.accelerator, quality.split) = (Accelerator::Bvh, Split::SurfaceArea);
                let row = Row { name: String::new(), quality };
                place.insert(self.frame(scene, &row, slice, false)?.film)
            }
        };
        let bits = |pixel: &Vec3| pixel.to_array().map(f32::to_bits);
        let pairs = frame.film.pixels.iter().zip(&reference.pixels);
        let different = pairs.clone().filter(|(yours, right)| bits(yours) != bits(right)).count();
        let distances = pairs.map(|(yours, right)| (*yours - *right).abs().max_element());
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
            different_pixels: different as u64,
            largest_difference: distances.fold(0.0, f32::max),
            notes: frame.notes,
            film: frame.film,
        })
    }

    /// The factor by which columns and rows are divided so that the picture takes seconds. It is estimated
    /// from a tiny picture, and before that from a single pixel where even the tiny picture may take minutes;
    /// `None` if one pixel takes minutes.
    fn affordable_slice(&self, scene: &Scene, row: &Row) -> Result<Option<u32>> {
        let longer = scene.film.width.max(scene.film.height);
        let tiny = (longer / 10).max(1);
        let tried = match row.quality.accelerator {
            // Each primitive is in one leaf, and a ray tests some tens even in the forest, so whole pictures
            // take seconds.
            Accelerator::Auto
            | Accelerator::Bvh
            | Accelerator::BvhBothChildren
            | Accelerator::CachedBvh
            | Accelerator::PacketBvh
            | Accelerator::WideBvh => return Ok(Some(1)),
            // A ray may test all primitives, or all in a node or a cell.
            Accelerator::BruteForce
            | Accelerator::BoundingBoxes
            | Accelerator::BoundingSpheres
            | Accelerator::CachedBoundingBoxes
            | Accelerator::Grid => &[longer, tiny][..],
            // Each has a scene on which it is slow; at worst a ray tests some ten thousand (a BSP tree in the
            // forest).
            Accelerator::Octree
            | Accelerator::OctreeByCells
            | Accelerator::OctreeByNeighbours
            | Accelerator::KdTree
            | Accelerator::Bsp
            | Accelerator::PolygonBsp => &[tiny][..],
        };
        // Render smaller pictures first, and extrapolate their numbers of tests.
        for &slice in tried {
            let frame = self.frame(scene, row, slice, true)?;
            let Counts { node_visits, box_tests, primitive_tests, .. } = frame.counts;
            let questions = (node_visits + box_tests + primitive_tests) as f64;
            if questions > MOST_QUESTIONS as f64 {
                return Ok((slice < longer).then_some(slice));
            }
            if slice < longer || longer < 2 {
                let pixels = f64::from(scene.film.width) * f64::from(scene.film.height);
                let share = pixels / frame.film.pixels.len() as f64;
                let least = (questions * share / MOST_QUESTIONS as f64).sqrt().ceil() as u32;
                return Ok(Some(least.clamp(1, slice)));
            }
        }
        Ok(Some(1))
    }

    fn frame(&self, scene: &Scene, row: &Row, slice: u32, count: bool) -> Result<Rendering> {
        let mut scene = scene.clone();
        scene.quality = row.quality;
        scene.film.width = (scene.film.width / slice).max(1);
        scene.film.height = (scene.film.height / slice).max(1);
        render(self.kit, &RenderJob { threads: self.threads, count, reuse: false, ..job(scene) })
    }
}
