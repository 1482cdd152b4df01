//! Nothing to do here: rays from the camera in packets, one pixel beside the other.

use crate::camera_rays::Eye;
use crate::finder::Finder;
use crate::surfaces::Hit;
use raykata::count::Tally;
use raykata::frame::{CameraSample, FrameSettings, TILE};
use raykata::ray::Ray;
use std::collections::HashMap;

/// Columns and rows of pixels that share a packet. They divide a tile evenly, so that no two threads trace the same one.
const BLOCK: (u32, u32) = (4, 2);
const _: () = assert!(TILE.is_multiple_of(BLOCK.0) && TILE.is_multiple_of(BLOCK.1));

/// What the packets of a tile have met so far.
#[derive(Default)]
pub struct Packets {
    /// By column, row and number of the sample.
    hits: HashMap<(u32, u32, u32), Option<Hit>>,
}

impl Packets {
    /// What the ray of a sample meets. The first sample of a block traces the rays of all its pixels.
    pub fn first_hit<T: Tally>(
        &mut self,
        sample: &CameraSample,
        settings: &FrameSettings,
        eye: &Eye,
        finder: &Finder,
        tally: &mut T,
    ) -> Option<Hit> {
        let place = (sample.column, sample.row, sample.sample);
        if let Some(hit) = self.hits.remove(&place) {
            return hit;
        }
        let (left, top) = (sample.column - sample.column % BLOCK.0, sample.row - sample.row % BLOCK.1);
        let (right, bottom) = (settings.width.min(left + BLOCK.0), settings.height.min(top + BLOCK.1));
        let pixels = (top..bottom).flat_map(|row| (left..right).map(move |column| (column, row)));
        let samples: Vec<CameraSample> =
            pixels.map(|(column, row)| CameraSample::draw(settings, column, row, sample.sample)).collect();
        let rays: Vec<Ray> = samples.iter().map(|sample| eye.ray(sample)).collect();
        let hits = finder.closest_hits(&rays, tally);
        self.hits.extend(samples.iter().zip(hits).map(|(s, hit)| ((s.column, s.row, s.sample), hit)));
        self.hits.remove(&place).flatten()
    }
}
