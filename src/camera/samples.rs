//! Random numbers by address: the pixel, the sample, the path and the purpose.
//!
//! Numbers are looked up and not taken from a sequence one after the other. So switching an effect on or off
//! changes no random number of any other effect, and the numbers depend neither on threads nor on
//! neighbouring pixels.

use crate::light::surface::Bounce;
use crate::message;
use glam::{UVec2, Vec2, uvec2};
use serde::{Deserialize, Serialize};
use sobol_burley::parts::sobol_rev;
use std::sync::LazyLock;

/// Where the samples of a pixel lie (stage 6). Lens, shutter time, area lights and rough surfaces are sampled
/// in the same way, and independently at random with [`Sampler::Center`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Sampler {
    /// All samples lie in the centre of the pixel.
    Center,
    /// Independent samples, uniformly distributed over the pixel.
    Random,
    /// Stratified sampling: the pixel is divided into a grid of cells, and each sample lies anywhere in a
    /// cell of its own.
    Jittered,
    /// Stratified samples over a square that reaches 1.5 pixels from the centre along x and y, weighted by a
    /// Gaussian.
    Gaussian,
    /// An Owen-scrambled Sobol sequence, which spreads samples evenly; a single sample lies in the centre.
    LowDiscrepancy,
}

message! { enum Sampler { Center, Random, Jittered, Gaussian, LowDiscrepancy } }

impl Sampler {
    /// Whether any of `samples` samples per pixel lies elsewhere than in the centre of the pixel.
    pub fn spreads(self, samples: u32) -> bool {
        match self {
            Sampler::Center => false,
            Sampler::LowDiscrepancy => samples > 1,
            Sampler::Random | Sampler::Jittered | Sampler::Gaussian => true,
        }
    }
}

/// What a pair of random numbers is used for. Each purpose has numbers of its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The position in the pixel.
    Pixel,
    /// The point on the lens.
    Lens,
    /// The time while the shutter is open; only the first number is used.
    Time,
    /// The point on the area light with this index.
    Light(u32),
    /// The direction of a glossy reflection or refraction.
    Glossy(Bounce),
    /// The choice of the emitter that a vertex of a path samples; only the first number is used.
    EmitterChoice,
    /// The point of that emitter.
    EmitterPoint,
    /// The direction in which a path continues.
    Direction,
    /// The choice of a lobe, and Russian roulette.
    Lobe,
}

/// A sample of the unit square by stratified sampling: it lies in cell `cell` of a grid of `grid.x` columns
/// and `grid.y` rows, at `u` within the cell. Samples that are not stratified have a grid of a single cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stratum {
    /// The column and row of the cell, `0 <= cell.x < grid.x` and `0 <= cell.y < grid.y`.
    pub cell: UVec2,
    /// The number of columns and rows of the grid, at least 1 each.
    pub grid: UVec2,
    /// Two random numbers, `0 <= u < 1` each.
    pub u: Vec2,
}

message! { Stratum { cell, grid, u } }

/// The address of a path's random numbers. Equal addresses give equal numbers.
#[derive(Clone, Copy, Debug)]
pub struct Points {
    sampler: Sampler,
    /// Stands for the seed, the pixel and the bounces so far. It does not depend on the sample, so the
    /// samples of a pixel share a sequence and can be spread evenly.
    key: u64,
    /// The number of this path among the `count` paths with the same key.
    index: u32,
    count: u32,
}

impl Points {
    /// A fixed address, for a frame that needs no random numbers.
    pub const UNUSED: Points = Points { sampler: Sampler::Center, key: 0, index: 0, count: 1 };

    /// The address of sample `sample` (`0 <= sample < samples`) of pixel number `pixel`, for a given sampler
    /// and seed. `samples` is the number of samples per pixel, at least 1.
    #[inline]
    pub fn new(sampler: Sampler, seed: u64, pixel: u64, sample: u32, samples: u32) -> Points {
        Points { sampler, key: mix(seed ^ mix(pixel)), index: sample, count: samples }
    }

    /// The address of secondary ray `part` of `parts` rays of the same kind (`0 <= part < parts`) that leave
    /// the surface at which this path arrives.
    pub fn beyond(&self, bounce: Bounce, part: u32, parts: u32) -> Points {
        let key = mix(self.key ^ mix(1 + bounce as u64));
        Points { key, index: self.nth(part, parts), count: self.count.saturating_mul(parts), ..*self }
    }

    /// The address of the ray that continues this path, of which there is one, whichever lobe it belongs to. So the
    /// samples of a pixel share a sequence at each bounce.
    pub fn beyond_vertex(&self) -> Points {
        Points { key: mix(self.key ^ mix(3)), ..*self }
    }

    /// The random numbers of draw `part` of `parts` (`0 <= part < parts`) for `purpose`, with both numbers in
    /// `0 <= u < 1`. Among all samples of the pixel, the draws for one purpose are distributed as the sampler
    /// says: stratified, by a Sobol sequence, or independent.
    #[inline(always)]
    pub fn stratum(&self, purpose: Purpose, part: u32, parts: u32) -> Stratum {
        let index = self.nth(part, parts);
        let key = || self.key ^ mix(address(purpose));
        let alone = |u| Stratum { cell: UVec2::ZERO, grid: UVec2::ONE, u };
        match self.sampler {
            Sampler::Center | Sampler::Random => alone(random_pair(key(), index)),
            // Stratified sampling: give each sample a cell of its own, in random order.
            Sampler::Jittered | Sampler::Gaussian => {
                let grid = grid_of(self.count.saturating_mul(parts));
                let (cells, key) = (grid.x * grid.y, key());
                let cell = permute(index % cells, cells, mix(key));
                Stratum { cell: uvec2(cell % grid.x, cell / grid.x), grid, u: random_pair(key, index) }
            }
            Sampler::LowDiscrepancy => alone(self.sobol(purpose, index)),
        }
    }

    #[inline]
    fn nth(&self, part: u32, parts: u32) -> u32 {
        self.index.wrapping_mul(parts).wrapping_add(part)
    }

    /// A point of an Owen-scrambled Sobol sequence. The position in the pixel, the lens and the time use five
    /// dimensions of one sequence, so that they are spread evenly together; each other purpose has a sequence
    /// of its own.
    #[inline(always)]
    fn sobol(&self, purpose: Purpose, index: u32) -> Vec2 {
        let (key, dimension) = match purpose {
            Purpose::Pixel => (self.key, 0),
            Purpose::Lens => (self.key, 2),
            Purpose::Time => (self.key, 4),
            other => (mix(self.key ^ mix(address(other))), 0),
        };
        // The sequence has 2¹⁶ points; use another sequence after that.
        two_dimensions(index & 0xffff, dimension, (key ^ mix(u64::from(index >> 16))) as u32)
    }
}

/// Dimensions `dimension` and `dimension + 1` of `sobol_burley::sample`, bit for bit, without the loop over the bits of the index:
/// each bit of the index adds a vector modulo 2, and a table of all bytes adds eight vectors at once.
///
/// `index` is below 2¹⁶, and `dimension` is 0, 2 or 4.
#[inline(always)]
fn two_dimensions(index: u32, dimension: u32, seed: u32) -> Vec2 {
    use sobol_burley::parts::{hash, owen_scramble_rev, u32_to_f32_norm};
    let shuffled = owen_scramble_rev(index.reverse_bits(), hash(seed ^ 0x79c6_8e4a));
    let [upper, lower] = &SOBOL[dimension as usize / 2];
    let bits = upper[(shuffled >> 24) as usize] ^ lower[(shuffled >> 16 & 0xff) as usize];
    let scrambled = |bits: u32, of_dimension: u32| {
        owen_scramble_rev(bits, hash(seed.wrapping_mul(0x9c8f_2d3b) ^ dimension >> 2 ^ of_dimension))
    };
    let constants = if dimension == 2 { [0x691e_72ca, 0xb40c_c1b8] } else { [0x912f_69ba, 0x174f_18ab] };
    let [x, y] = [scrambled(bits & 0xffff, constants[0]), scrambled(bits >> 16, constants[1])];
    // Reverse the bits of both numbers at once.
    let reversed = (u64::from(x) << 32 | u64::from(y)).reverse_bits();
    Vec2::new(u32_to_f32_norm(reversed as u32), u32_to_f32_norm((reversed >> 32) as u32))
}

/// For each pair of dimensions and each byte of a reversed index the point of the Sobol sequence: 16 bits of the first
/// dimension, and above them 16 bits of the second.
static SOBOL: LazyLock<[[[u32; 256]; 2]; 3]> = LazyLock::new(|| {
    let point = |dimension: u32, byte: u32| {
        sobol_rev(byte, dimension) & 0xffff | (sobol_rev(byte, dimension + 1) & 0xffff) << 16
    };
    [0, 2, 4].map(|dimension| {
        [24, 16].map(|shift| std::array::from_fn(|byte| point(dimension, (byte as u32) << shift)))
    })
});

/// A distinct number for each purpose.
#[inline(always)]
fn address(purpose: Purpose) -> u64 {
    match purpose {
        Purpose::Pixel => 1,
        Purpose::Lens => 2,
        Purpose::Time => 3,
        Purpose::Glossy(bounce) => 4 + bounce as u64,
        Purpose::EmitterChoice => 6,
        Purpose::EmitterPoint => 7,
        Purpose::Direction => 8,
        Purpose::Lobe => 9,
        Purpose::Light(index) => 16 + u64::from(index),
    }
}

/// The columns and rows of a grid with at least `samples` cells that is as close to a square as possible.
/// `samples` counts as at least 1 and at most 2³⁰.
pub fn grid_of(samples: u32) -> UVec2 {
    // With 2^15 cells per side and more, the cells could not be numbered in 32 bits.
    let samples = samples.clamp(1, 1 << 30);
    let columns = f64::from(samples).sqrt().ceil() as u32;
    uvec2(columns, samples.div_ceil(columns))
}

/// Two random numbers, `0 <= u < 1` each, of 24 bits, which an `f32` holds exactly. With 32 bits, 128 of the
/// values would round up to 1.0.
fn random_pair(key: u64, index: u32) -> Vec2 {
    let bits = mix(key.wrapping_add(mix(u64::from(index))));
    let unit = |bits: u32| (bits >> 8) as f32 * (1.0 / 16_777_216.0);
    Vec2::new(unit(bits as u32), unit((bits >> 32) as u32))
}

/// The finalizer of SplitMix64 (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014): every
/// bit of the input affects every bit of the output.
#[inline(always)]
fn mix(key: u64) -> u64 {
    let key = key.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let key = (key ^ (key >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let key = (key ^ (key >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    key ^ (key >> 31)
}

/// The position of `index` in a shuffled `0..length`, without a table: in each round the indices are paired,
/// and a random bit says for each pair whether its two members are exchanged (Hoang, Morris and Rogaway, "An
/// enciphering scheme based on a card shuffle", 2012).
fn permute(mut index: u32, length: u32, seed: u64) -> u32 {
    /// Enough rounds that all orders of a few cells are equally frequent.
    const ROUNDS: u64 = 12;
    let length = u64::from(length);
    for round in 0..ROUNDS {
        let key = mix(seed ^ round);
        let partner = ((key % length + length - u64::from(index)) % length) as u32;
        // Both members of a pair use the same random bit.
        if mix(key ^ u64::from(index.max(partner))) & 1 == 1 {
            index = partner;
        }
    }
    index
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Sampler; 5] =
        [Sampler::Center, Sampler::Random, Sampler::Jittered, Sampler::Gaussian, Sampler::LowDiscrepancy];

    #[test]
    fn numbers_lie_below_one_and_do_not_repeat() {
        for sampler in ALL {
            let mut seen = Vec::new();
            for pixel in 0..50 {
                for sample in 0..20 {
                    let points = Points::new(sampler, 7, pixel, sample, 20);
                    for purpose in [Purpose::Pixel, Purpose::Lens, Purpose::Light(0), Purpose::Light(1)] {
                        let u = points.stratum(purpose, 0, 1).u;
                        assert!(u.min_element() >= 0.0 && u.max_element() < 1.0, "{u}");
                        seen.push((u.x.to_bits(), u.y.to_bits()));
                    }
                }
            }
            let drawn = seen.len();
            seen.sort_unstable();
            seen.dedup();
            assert!(seen.len() > drawn - 3, "{sampler:?}: {} of {drawn} are different", seen.len());
        }
    }

    #[test]
    fn each_jittered_draw_has_a_cell_of_its_own() {
        for (samples, parts) in [(1, 1), (16, 1), (7, 1), (4, 4), (5, 3)] {
            let mut cells = Vec::new();
            for sample in 0..samples {
                let points = Points::new(Sampler::Jittered, 1, 99, sample, samples);
                for part in 0..parts {
                    let stratum = points.stratum(Purpose::Lens, part, parts);
                    assert!(stratum.cell.cmplt(stratum.grid).all());
                    cells.push((stratum.cell.x, stratum.cell.y));
                }
            }
            cells.sort_unstable();
            cells.dedup();
            assert_eq!(cells.len(), (samples * parts) as usize);
        }
    }

    #[test]
    fn shuffles_are_shuffles() {
        for length in [1, 2, 3, 7, 16, 100] {
            let mut places: Vec<u32> = (0..length).map(|index| permute(index, length, 5)).collect();
            places.sort_unstable();
            assert_eq!(places, (0..length).collect::<Vec<_>>());
        }
        // All 24 orders of four things come up about equally often: 24,000 shuffles, 1,000 each, σ = 31.
        let mut orders = std::collections::BTreeMap::new();
        for seed in 0..24_000 {
            *orders.entry([0, 1, 2, 3].map(|index| permute(index, 4, seed))).or_insert(0) += 1;
        }
        assert_eq!(orders.len(), 24);
        assert!(orders.values().all(|n| (700..1300).contains(n)), "{orders:?}");
    }

    #[test]
    fn the_low_discrepancy_points_fill_all_elementary_intervals() {
        // 16 points: one in each of 16 cells, whether 4 × 4, 2 × 8, 8 × 2, 1 × 16 or 16 × 1.
        for grid in [uvec2(4, 4), uvec2(2, 8), uvec2(8, 2), uvec2(1, 16), uvec2(16, 1)] {
            let mut filled = [false; 16];
            for sample in 0..16 {
                let u =
                    Points::new(Sampler::LowDiscrepancy, 3, 8, sample, 16).stratum(Purpose::Pixel, 0, 1).u;
                let cell = (u * grid.as_vec2()).as_uvec2();
                filled[(cell.y * grid.x + cell.x) as usize] = true;
            }
            assert!(filled.iter().all(|filled| *filled), "{grid}");
        }
    }

    #[test]
    fn the_dimensions_are_those_of_the_library() {
        for index in (0..256).chain((256..1 << 16).step_by(97)) {
            let seed = (mix(u64::from(index)) >> 7) as u32;
            for dimension in [0, 2, 4] {
                let expected = [0, 1].map(|next| sobol_burley::sample(index, dimension + next, seed));
                assert_eq!(two_dimensions(index, dimension, seed).to_array(), expected, "{index}, {seed}");
            }
        }
    }

    #[test]
    fn grids_have_room_for_all() {
        assert_eq!(grid_of(1), uvec2(1, 1));
        assert_eq!(grid_of(16), uvec2(4, 4));
        assert_eq!(grid_of(7), uvec2(3, 3));
        assert_eq!(grid_of(2), uvec2(2, 1));
        assert!(grid_of(u32::MAX).x >= 1 << 15);
    }
}
