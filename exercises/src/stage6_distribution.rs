//! Stage 6 · distribution: distributed ray tracing. Many rays replace one; they are distributed
//! over the pixel, the lens, the area light, the glossy reflection and the time.
//!
//! Slides: `slides/stage06.md`.
//!
//! These functions draw no random numbers: random numbers are arguments, `u` in `0.0..1.0` each. If
//! `u` is uniformly distributed, your results must have the distribution that the doc comment
//! states. Any formula with this distribution passes, unless the doc comment gives the formula.

use glam::{Vec2, Vec3, vec2};
use raykata::aabb::Aabb;
use raykata::camera::{Camera, Lens, Shutter};
use raykata::kit::{FILTER_RADIUS, WeightedColor};
use raykata::random::Stratum;
use raykata::ray::Ray;
use raykata::scene::Sampler;
use raykata::shape::{Disk, Sphere};
use std::f32::consts::{FRAC_PI_4, TAU};

/// Stratified samples: the pixel, whose side is 1, is a grid of cells with one random sample each,
/// at `(cell + u) / grid`. What is 3 + 0.99999994, rounded?
///
/// The result is in its cell, up to rounding, and in `0.0..1.0` along x and y: 1 belongs to the
/// next pixel.
///
/// Source: "Generate pixel samples".
pub fn jittered(stratum: &Stratum) -> Vec2 {
    todo!("scale the position in the cell to the whole grid, and stay below 1")
}

/// The position of a sample, relative to the upper left corner of its pixel, whose side is 1.
///
/// Exactly:
///
/// 1. [`Sampler::Center`]: the centre of the pixel.
/// 2. [`Sampler::Random`] and [`Sampler::LowDiscrepancy`]: `u` unchanged.
/// 3. [`Sampler::Jittered`]: the result of [`jittered`].
/// 4. [`Sampler::Gaussian`]: the result of [`jittered`], scaled to the square that reaches
///    [`FILTER_RADIUS`] from the centre of the pixel on all sides.
///
/// Source: "Antialiasing".
pub fn pixel_position(sampler: Sampler, stratum: &Stratum) -> Vec2 {
    todo!("return the position for each sampler")
}

/// Samples near the centre of the pixel count more, by a Gaussian that falls to 0 at R =
/// [`FILTER_RADIUS`]: `(e^(-2x²) - e^(-2R²)) (e^(-2y²) - e^(-2R²))`. What is the product beyond R
/// along both axes?
///
/// `offset` is (x, y), from the centre. The weight is 0 if `|x|` or `|y|` is R or more, and never
/// negative.
///
/// Source: "Antialiasing".
pub fn gaussian_weight(offset: Vec2) -> f32 {
    todo!("multiply a weight along x by a weight along y, each 0 from R on")
}

/// The colour of a pixel is the weighted mean of its samples. If all samples are white, is the
/// pixel white, for any weights?
///
/// Each weight is at least 0. Without samples, or if the weights sum to 0, the pixel is black. The
/// colour is not clamped.
///
/// Source: "Antialiasing".
pub fn filter_pixel(samples: &[WeightedColor]) -> Vec3 {
    todo!("divide the sum of weighted colours by the sum of weights")
}

/// A uniformly distributed point of the disk of radius 1 around the origin. What part of the disk
/// lies within half of its radius?
///
/// Every `u` gives a point whose distance from the origin is at most 1 (up to rounding), and no `u`
/// gives NaN.
///
/// Source: "Depth of Field".
pub fn sample_disk(u: Vec2) -> Vec2 {
    todo!("map the unit square to the disk, area for area")
}

/// All rays of a pixel meet where the pinhole ray meets the focal plane. Start at the point of the
/// lens and go there. Is that at `focal_distance` along the pinhole ray?
///
/// Exactly:
///
/// 1. The lens is a disk of diameter `lens.aperture` around `camera.position`, spanned by
///    `camera.right` and `camera.up`. `on_lens` is in the disk of radius 1.
/// 2. The focal plane is at right angles to `camera.towards`, at the distance
///    `lens.focal_distance > 0`.
/// 3. The direction has unit length, and is precise far from the origin.
/// 4. From the centre of the lens (`on_lens` or `lens.aperture` is 0) the result is `pinhole`, bit
///    for bit.
///
/// Source: "Depth of Field".
pub fn lens_ray(camera: &Camera, pinhole: &Ray, lens: &Lens, on_lens: Vec2) -> Ray {
    todo!("start on the lens, and aim where the pinhole ray meets the focal plane")
}

/// A uniformly distributed point of the rectangle at `corner`. `edges` are the vectors along both
/// sides, which need not be at right angles.
///
/// Source: "Area Lights".
pub fn sample_rectangle(corner: Vec3, edges: (Vec3, Vec3), u: Vec2) -> Vec3 {
    todo!("start at the corner and go along both edges")
}

/// A uniformly distributed point of a disk. `disk.normal` need not have unit length.
///
/// Source: "Area Lights".
pub fn sample_light_disk(disk: &Disk, u: Vec2) -> Vec3 {
    todo!("map a point of the unit disk to this disk")
}

/// A unit direction from `from` to the sphere, uniform over its solid angle. From outside, this is
/// a cone of half-angle θ with `sin θ = radius / distance`. What is `1 - cos θ` of a far sphere?
/// The radius is above 0.
///
/// Exactly:
///
/// 1. The directions are uniform over the cone, also of a far sphere, and from inside over all
///    directions.
/// 2. From the centre any unit direction passes, and NaN fails.
///
/// Source: "Soft shadows", "Area Lights".
pub fn sample_sphere(sphere: &Sphere, from: Vec3, u: Vec2) -> Vec3 {
    todo!("choose 1 - cos θ uniformly between 0 and that of the rim, and any angle around the axis")
}

/// A glossy surface reflects into a lobe around `ideal`, the direction for a smooth surface, with a
/// density per solid angle proportional to `cosⁿ θ`. How many numbers are there near `cos θ = 1`?
/// Can a ray go through the surface?
///
/// `roughness` is in `0..=1`, and `normal` on the side to which the ray goes. Returns a unit
/// vector.
///
/// Exactly:
///
/// 1. `n = 2 / roughness² - 2`, θ is at most 90°, and the lobe is the same on all sides.
/// 2. A slightly rough surface gives many different angles.
/// 3. A direction d with `d·normal < 0` becomes `d - 2 (d·normal) normal`.
/// 4. If `roughness` is 0, the result is `ideal`, bit for bit.
///
/// Source: "DRT: Diffuse reflection".
pub fn sample_phong_lobe(ideal: Vec3, normal: Vec3, roughness: f32, u: Vec2) -> Vec3 {
    todo!("turn ideal by a random angle, and keep it on its side of the surface")
}

/// The time slot, from 1 to 16, of the cell in column `x` and row `y`. Each block of 4 by 4 cells
/// has these slots:
///
/// ```text
///  7 11  3 14
///  4 15 13  9
/// 16  1  8 12
///  6 10  5  2
/// ```
///
/// Source: "Temporal Jittering Sampling".
pub fn temporal_slot(x: u32, y: u32) -> u32 {
    todo!("look up the slot: y is the row, x is the column, and blocks repeat")
}

/// Motion blur: the interval in which the shutter is open is divided into `slots` slots of equal
/// length. Which time is at position `u` of slot `slot`? May rounding lead beyond the interval?
///
/// `slot` counts from 1, and `u = 0` is the beginning of the slot. The result is in
/// `shutter.open..=shutter.close`, both ends included.
///
/// Source: "Motion Blur".
pub fn time_in_shutter(shutter: &Shutter, slot: u32, slots: u32, u: f32) -> f32 {
    todo!("add u to the number of slots before this one, and scale from open to close")
}

/// Linear interpolation: a point moves from `start` to `end` while `time` goes from 0 to 1. Does
/// `start + t (end - start)` reach the end? Does `(1 - t) start + t end` stand still if both are
/// equal?
///
/// Exactly:
///
/// 1. The result is exactly `start` at time 0, `end` at time 1, and `start` if `start == end`.
/// 2. Each coordinate is between those of `start` and `end` (both included), because bounding boxes
///    rely on it.
///
/// Source: "Motion Blur".
pub fn lerp(start: Vec3, end: Vec3, time: f32) -> Vec3 {
    todo!("interpolate between start and end, and clamp to the box around them")
}

/// The smallest box around everything that moves linearly from box `start` to box `end`. It is
/// exact: each coordinate is one of those of `start` and `end`.
///
/// Source: "Motion Blur".
pub fn motion_bounds(start: &Aabb, end: &Aabb) -> Aabb {
    todo!("find the smallest and the largest coordinates of both boxes")
}
