//! Comparison of pictures of random samples.
//!
//! The metric: two correct pictures have samples at other places, so their pixels differ. The means of blocks of 4 × 4 pixels
//! agree within the standard error that the pixels of the picture show. The bound of six standard errors is exceeded by
//! chance once in 500 million comparisons: for the 54 blocks of a picture of 36 × 24 pixels with three channels once in 3
//! million pictures.
//!
//! The standard error is estimated in two ways, and the smaller one counts, because both are too large: the samples of a pixel
//! vary more than their mean does if they are stratified, and second differences of neighbouring pixels also contain what the
//! picture shows.

use super::{Pair, Size, film_of_width, golden_picture, image_of, input, linear, replay};
use crate::broken::{Broken, CheckResult};
use crate::trial::Trial;
use glam::{DVec3, Vec3};
use image::RgbImage;
use raykata::kit::Kit;

/// The number of columns and rows of a block.
const BLOCK: u32 = 4;

/// The largest difference of two means, in standard errors. A normally distributed number is beyond it once in 500 million
/// times.
const STANDARD_ERRORS: f64 = 6.0;

/// The largest error of a mean by the rounding of the golden picture to bytes. With gamma 2 the codes of bright colours are
/// 2/255 apart, so that a byte is wrong by up to 1/255.
const BYTE_ERROR: f64 = 1.0 / 255.0;

/// The number of samples that are off by 1 which a block may have missed by chance. The standard error of equal samples is 0,
/// although the expected picture may have a rare colour there. If a colour has 8 samples per block on average, none of them is
/// seen, and 17 are expected, which are off by 0.7, once in a million times, and less often if samples are stratified.
const MISSED: f64 = 2.0;

/// A picture of random samples that is composed from answers.
pub struct Sampled<'a> {
    /// The name of the golden picture.
    pub name: &'a str,
    /// The size of the whole picture.
    pub size: Size,
}

/// The pixels of a block: their number, the sum of their means, the sum of the squares of the standard errors of these means,
/// and the sum of the expected colours.
#[derive(Clone, Copy, Default)]
struct Block {
    pixels: f64,
    means: DVec3,
    squared_errors: DVec3,
    /// The sum and the number of the squares of second differences, each divided by 6, its mean for independent pixels.
    squared_differences: (DVec3, f64),
    /// What [`MISSED`] adds to the squares of the standard errors.
    missed: f64,
    expected: DVec3,
}

impl Block {
    /// The largest difference of a channel of both means, in units of the largest difference that may be chance.
    fn score(&self) -> f64 {
        let (sum, count) = self.squared_differences;
        let by_differences = if count > 0.0 { sum / count * self.pixels } else { DVec3::INFINITY };
        let squared_error = self.squared_errors.min(by_differences) + self.missed;
        let error = (2.0 * squared_error).powf(0.5) / self.pixels;
        let off = (self.means - self.expected).abs() / self.pixels;
        let off = off / (STANDARD_ERRORS * error + BYTE_ERROR);
        if off.is_nan() { f64::INFINITY } else { off.max_element() }
    }
}

impl Sampled<'_> {
    /// Composes the picture from the answers of the trial's kit, and compares it with the golden picture; or, for a hidden
    /// seed and with a reference to ask, with the picture that the answers of the reference make. `samples` returns the
    /// colours, from 0 to 1, of the samples of each pixel. No row is left out, because a block needs its rows.
    #[track_caller]
    pub fn check(&self, trial: &Trial<'_>, samples: impl Fn(&dyn Kit) -> Vec<Vec<Vec3>>) -> CheckResult {
        let mean = |samples: &Vec<Vec3>| samples.iter().sum::<Vec3>() / samples.len().max(1) as f32;
        if let Some(replay) = trial.pixel() {
            return replay.show(self.name, self.size, None, || samples(trial.kit).first().map(mean));
        }
        let yours = samples(trial.kit);
        let film_of =
            |samples: &[Vec<Vec3>]| film_of_width(self.size.width, samples.iter().map(mean).collect());
        let film = film_of(&yours);
        let golden = match trial.expected(&samples) {
            Some(expected) => image_of(&film_of(&expected)),
            None => match golden_picture(1, self.name, &film)? {
                Some(golden) => golden,
                None => return Ok(()),
            },
        };
        self.judge(trial, &yours, &Pair { name: self.name, film: &film, golden: &golden })
    }

    /// Adds up the pixels of each block, and the colours that are expected there.
    fn blocks(&self, samples: &[Vec<Vec3>], golden: &RgbImage) -> Vec<Block> {
        let width = self.size.width;
        let per_row = width.div_ceil(BLOCK);
        let mean = |samples: &Vec<Vec3>| {
            samples.iter().map(|sample| sample.as_dvec3()).sum::<DVec3>() / samples.len() as f64
        };
        let means: Vec<DVec3> = samples.iter().map(mean).collect();
        let mut blocks = vec![Block::default(); (per_row * self.size.height.div_ceil(BLOCK)) as usize];
        for (index, samples) in samples.iter().enumerate() {
            let (x, y) = (index as u32 % width, index as u32 / width);
            let block = &mut blocks[(y / BLOCK * per_row + x / BLOCK) as usize];
            let (n, mean) = (samples.len() as f64, means[index]);
            let squares: DVec3 = samples.iter().map(|sample| (sample.as_dvec3() - mean).powf(2.0)).sum();
            block.pixels += 1.0;
            block.means += mean;
            block.squared_errors += squares / (n * (n - 1.0));
            block.missed = MISSED / (n * (n - 1.0));
            block.expected += linear(golden, x, y).as_dvec3();
            if 0 < x && x + 1 < width {
                let second = means[index - 1] - 2.0 * mean + means[index + 1];
                block.squared_differences.0 += second.powf(2.0) / 6.0;
                block.squared_differences.1 += 1.0;
            }
        }
        blocks
    }

    fn judge(&self, trial: &Trial<'_>, samples: &[Vec<Vec3>], pair: &Pair<'_>) -> CheckResult {
        let per_row = self.size.width.div_ceil(BLOCK);
        let blocks = self.blocks(samples, pair.golden);
        let used: Vec<usize> = (0..blocks.len()).filter(|&block| blocks[block].pixels > 0.0).collect();
        let n_off = used.iter().filter(|&&block| blocks[block].score() > 1.0).count();
        let worst = used.iter().copied().max_by(|&p, &q| blocks[p].score().total_cmp(&blocks[q].score()));
        let Some(worst) = worst.filter(|_| n_off > 0) else { return Ok(()) };
        let block = &blocks[worst];
        let (column, row) = (worst as u32 % per_row * BLOCK, worst as u32 / per_row * BLOCK);
        let rgb = pair.film.to_bytes(super::gamma()).rgb;
        // Of the pixels of the worst block, the one that differs most.
        let pixels = (row..(row + BLOCK).min(self.size.height))
            .flat_map(|y| (column..(column + BLOCK).min(self.size.width)).map(move |x| (x, y)));
        let off = |&(x, y): &(u32, u32)| (pair.film.at(x, y) - linear(pair.golden, x, y)).abs().max_element();
        let (x, y) = pixels.max_by(|p, q| off(p).total_cmp(&off(q))).unwrap_or((column, row));
        let replay = if trial.is_public() { replay::command(trial.name, x, y) } else { String::new() };
        Err(pair.broken(&rgb, |written| {
            Broken::with_texts(
                format!("{}\n{written}{replay}", input(pair.name)).trim_end(),
                format!(
                    "the mean colours of {n_off} of {} blocks of {BLOCK} × {BLOCK} pixels differ, most from ({column}, \
                     {row}) on: {:.3}",
                    used.len(),
                    block.means / block.pixels
                ),
                format!("there: {:.3}", block.expected / block.pixels),
                "the golden picture, 1 false alarm in a million",
            )
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::super::SMALL;
    use super::*;
    use crate::statistics::pairs;

    /// Samples of which each is white with the probability that its column has, from 0 to `most`.
    fn samples(seed: u64, most: f32) -> Vec<Vec<Vec3>> {
        let n_pixels = (SMALL.width * SMALL.height) as usize;
        let numbers = pairs(seed, 16 * n_pixels);
        let share = |pixel: usize| most * (pixel as u32 % SMALL.width) as f32 / SMALL.width as f32;
        let white = |pixel: usize, u: f32| if u < share(pixel) { Vec3::ONE } else { Vec3::ZERO };
        let pixel = |(pixel, us): (usize, &[glam::Vec2])| us.iter().map(|u| white(pixel, u.x)).collect();
        numbers.chunks(16).enumerate().map(pixel).collect()
    }

    #[test]
    fn other_random_numbers_make_an_equal_picture_and_other_probabilities_do_not() {
        let sampled = Sampled { name: "none", size: SMALL };
        let score = |yours: (u64, f32), golden: (u64, f32)| {
            let mean = |samples: &Vec<Vec3>| samples.iter().sum::<Vec3>() / 16.0;
            let golden = samples(golden.0, golden.1).iter().map(mean).collect();
            let golden = image_of(&film_of_width(SMALL.width, golden));
            let blocks = sampled.blocks(&samples(yours.0, yours.1), &golden);
            blocks.iter().map(Block::score).fold(0.0, f64::max)
        };
        // Of 20 pictures with other numbers none comes near the bound, in no block.
        let scores = (1..=20).map(|seed| score((seed, 0.8), (0, 0.8)));
        assert!(scores.clone().all(|score| score < 0.8), "{:?}", scores.collect::<Vec<f64>>());
        assert!(score((1, 0.6), (0, 0.8)) > 1.0);
        assert!(score((1, f32::NAN), (0, 0.8)) > 1.0);
    }
}
