//! Packets of camera rays through neighbouring pixels.

use super::Intersector;
use super::hit::Hit;
use crate::count::Tally;
use crate::kit::StudentFunctions;
use crate::ray::Ray;
use crate::rows::TILE;
use crate::tracer::camera_sampler::CameraSampler;
use crate::tracer::driver::{CameraSample, FrameSettings};
use std::collections::HashMap;

/// The columns and rows of neighbouring pixels whose camera rays share a packet. Both divide a tile evenly, so that no two
/// threads trace the same packet.
const COLUMNS: u32 = 4;
const ROWS: u32 = 2;
const _: () = assert!(TILE.is_multiple_of(COLUMNS) && TILE.is_multiple_of(ROWS));

/// The number of rays in a packet.
pub const PACKET: usize = (COLUMNS * ROWS) as usize;

/// The hits of packets whose pixels have not all been asked for yet.
#[derive(Default)]
pub struct Packets {
    /// The hits, by column, row and number of the sample.
    hits: HashMap<(u32, u32, u32), Option<Hit>>,
}

impl Packets {
    /// The closest hit of the camera ray of `sample`. The first sample of a block of pixels traces the rays
    /// of all its pixels; the other samples find their hit stored.
    pub fn first_hit<F: StudentFunctions, T: Tally>(
        &mut self,
        sample: &CameraSample,
        settings: &FrameSettings,
        camera: &CameraSampler<F>,
        intersector: &Intersector<F>,
        tally: &mut T,
    ) -> Option<Hit> {
        // Return the hit if another sample of the block has traced this ray.
        let place = (sample.column, sample.row, sample.sample);
        if let Some(hit) = self.hits.remove(&place) {
            return hit;
        }
        // Make the camera rays of all pixels of the block that lie on the film.
        let (left, top) = (sample.column - sample.column % COLUMNS, sample.row - sample.row % ROWS);
        let (right, bottom) = (settings.width.min(left + COLUMNS), settings.height.min(top + ROWS));
        let pixels = (top..bottom).flat_map(|row| (left..right).map(move |column| (column, row)));
        let samples: Vec<CameraSample> =
            pixels.map(|(column, row)| CameraSample::draw(settings, column, row, sample.sample)).collect();
        let rays: Vec<Ray> = samples.iter().map(|sample| camera.ray(sample)).collect();
        // Trace them as one packet, and store their hits.
        let hits = intersector.closest_hits(&rays, tally);
        self.hits.extend(samples.iter().zip(hits).map(|(s, hit)| ((s.column, s.row, s.sample), hit)));
        self.hits.remove(&place).flatten()
    }
}
