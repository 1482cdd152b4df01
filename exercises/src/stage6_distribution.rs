//! Stage 6 · distribution: distributed ray tracing. Many rays replace one; they are distributed over the pixel, the
//! lens, the area light, the glossy reflection and the time.
//!
//! Slides: "Antialiasing", "Generate pixel samples", "Distributed Ray Tracing", "Depth of Field", "Soft shadows",
//! "Temporal Jittering Sampling".
//!
//! These functions draw no random numbers: random numbers are arguments, `u` in `0.0..1.0` each. If `u` is uniformly
//! distributed, your results must have the distribution that the doc comment states. Any formula with this distribution
//! passes, unless the doc comment gives the formula.

use glam::{Vec2, Vec3, vec2};
use raykata::aabb::Aabb;
use raykata::camera::{Camera, Lens, Shutter};
use raykata::kit::{FILTER_RADIUS, WeightedColor};
use raykata::random::Stratum;
use raykata::ray::Ray;
use raykata::scene::Sampler;
use raykata::shape::{Disk, Sphere};
use std::f32::consts::{FRAC_PI_4, TAU};

/// The position of a stratified sample in its pixel, whose side is 1: `(cell + u) / grid`.
///
/// The result is in its cell, up to rounding, and in `0.0..1.0` along x and y. It is never 1, because 1 belongs to the
/// next pixel.
///
/// Pitfall: 3 + 0.99999994 is rounded to 4, and then `(cell + u) / grid` is 1.
///
/// Slide "Generate pixel samples".
pub fn jittered(stratum: &Stratum) -> Vec2 {
    todo!("scale the position in the cell to the whole grid, and stay below 1")
}

/// The position of a sample, relative to the upper left corner of its pixel, whose side is 1.
///
/// - [`Sampler::Center`]: the centre of the pixel.
/// - [`Sampler::Random`] and [`Sampler::LowDiscrepancy`]: `u` unchanged. Low-discrepancy numbers are spread already.
/// - [`Sampler::Jittered`]: the result of [`jittered`].
/// - [`Sampler::Gaussian`]: the result of [`jittered`], scaled to the square that reaches [`FILTER_RADIUS`] from the
///   centre of the pixel on all sides.
///
/// Slide "Antialiasing".
pub fn pixel_position(sampler: Sampler, stratum: &Stratum) -> Vec2 {
    todo!("return the position for each sampler")
}

/// The filter weight of a sample at `offset` from the centre of its pixel: the Gaussian
/// `(e^(-2x²) - e^(-2R²)) (e^(-2y²) - e^(-2R²))` with R = [`FILTER_RADIUS`].
///
/// The weight is 0 if `|x|` or `|y|` is R or more. It is never negative.
///
/// Pitfall: a Gaussian does not end. Without the term `e^(-2R²)` the weight has a step at R. Beyond R along both axes,
/// the product of two negative factors is positive.
///
/// Slide "Antialiasing".
pub fn gaussian_weight(offset: Vec2) -> f32 {
    todo!("multiply a weight along x by a weight along y, each 0 from R on")
}

/// The colour of a pixel: the weighted mean of its samples.
///
/// Each weight is at least 0. If there is no sample, or if the weights sum to 0, the pixel is black. The colour is not
/// clamped.
///
/// Pitfall: if you divide by the number of samples instead of the sum of the weights, the picture is too dark or too
/// bright.
///
/// Slide "Antialiasing".
pub fn filter_pixel(samples: &[WeightedColor]) -> Vec3 {
    todo!("divide the sum of weighted colours by the sum of weights")
}

/// A uniformly distributed point of the disk of radius 1 around the origin.
///
/// Every `u` gives a point whose distance from the origin is at most 1 (up to rounding), and no `u` gives NaN.
///
/// Pitfall: if the distance from the centre is uniform in `0..1`, half of the points lie in a quarter of the disk. The
/// corners of the square `-1..1` are outside the disk.
///
/// Slide "Depth of Field".
pub fn sample_disk(u: Vec2) -> Vec2 {
    todo!("map the unit square to the disk, area for area")
}

/// The ray from a point of a thin lens to the point where the pinhole ray meets the focal plane (depth of field).
///
/// The lens is a disk around `camera.position` of diameter `lens.aperture`, spanned by `camera.right` and `camera.up`.
/// `on_lens` is a point of the disk of radius 1, which stands for the lens. The focal plane is at right angles to the
/// view direction `camera.towards`, at distance `lens.focal_distance`, which is above 0. The direction of the result
/// has unit length. If the ray starts at the centre of the lens, because `on_lens` or `lens.aperture` is 0, the result
/// is `pinhole`, bit for bit.
///
/// Pitfall: points at `focal_distance` along each ray form a sphere, and the edges of the picture blur. The difference
/// of two positions far from the origin is imprecise: subtract before you add `camera.position`.
///
/// Slide "Depth of Field".
pub fn lens_ray(camera: &Camera, pinhole: &Ray, lens: &Lens, on_lens: Vec2) -> Ray {
    todo!("start on the lens, and aim where the pinhole ray meets the focal plane")
}

/// A uniformly distributed point of the rectangle with the corner `corner`.
///
/// `edges` are the vectors from this corner along both sides. They need not be at right angles.
///
/// Slide "Area Lights".
pub fn sample_rectangle(corner: Vec3, edges: (Vec3, Vec3), u: Vec2) -> Vec3 {
    todo!("start at the corner and go along both edges")
}

/// A uniformly distributed point of a disk.
///
/// `disk.normal` need not have unit length.
///
/// Slide "Area Lights".
pub fn sample_light_disk(disk: &Disk, u: Vec2) -> Vec3 {
    todo!("map a point of the unit disk to this disk")
}

/// A unit direction from `from` to the sphere, uniformly distributed over the solid angle of the sphere.
///
/// The radius is above 0. From outside, the directions fill a cone around the direction to the centre. The angle θ
/// between its axis and its rim has `sin θ = radius / distance`. From inside the sphere the directions are uniform
/// over all directions. From the centre any unit direction passes, and NaN fails.
///
/// Pitfall: for a far sphere `1 - cos θ` is rounded to 0, and its shadows become sharp. It is `sin²θ / (1 + cos θ)`.
///
/// Slides "Soft shadows" and "Area Lights".
pub fn sample_sphere(sphere: &Sphere, from: Vec3, u: Vec2) -> Vec3 {
    todo!("choose 1 - cos θ uniformly between 0 and that of the rim, and any angle around the axis")
}

/// A direction for glossy reflection: a sample of the Phong lobe around `ideal`, the direction for a smooth surface.
///
/// `roughness` is in `0..=1`. At an angle θ to `ideal`, up to 90°, the density per solid angle is proportional to
/// `cosⁿ θ`, with `n = 2 / roughness² - 2`, and the same on all sides. `normal` is on the side to which the ray goes.
/// A direction d that would go through the surface (`d·normal < 0`) is reflected back to this side:
/// `d - 2 (d·normal) normal`. The result has unit length. If `roughness` is 0, it is `ideal`, bit for bit.
///
/// Pitfall: for a slightly rough surface `cos θ = u^(1 / (n + 1))` is close to 1, and `√(1 - cos² θ)` gives only a few
/// different angles. `-exp_m1(ln(u) / (n + 1))` is `1 - cos θ` with all its digits.
///
/// Slide "DRT: Diffuse reflection".
pub fn sample_phong_lobe(ideal: Vec3, normal: Vec3, roughness: f32, u: Vec2) -> Vec3 {
    todo!("turn ideal by a random angle, and keep it on its side of the surface")
}

/// The time slot, from 1 to 16, of the cell in column `x` and row `y`. Cells form blocks of 4 by 4, and each block has
/// the slots of this table (slide "Temporal Jittering Sampling"):
///
/// ```text
///  7 11  3 14
///  4 15 13  9
/// 16  1  8 12
///  6 10  5  2
/// ```
pub fn temporal_slot(x: u32, y: u32) -> u32 {
    todo!("look up the slot: y is the row, x is the column, and blocks repeat")
}

/// The time at position `u` of a time slot, for motion blur.
///
/// The interval from `shutter.open` to `shutter.close` is divided into `slots` slots of equal length. `slot` counts
/// them from 1. At `u = 0` the time is the beginning of the slot. The result is in `shutter.open..=shutter.close`,
/// both ends included.
///
/// Pitfall: the rounded sum may lie outside this interval.
///
/// Slide "Motion Blur".
pub fn time_in_shutter(shutter: &Shutter, slot: u32, slots: u32, u: f32) -> f32 {
    todo!("add u to the number of slots before this one, and scale from open to close")
}

/// Linear interpolation: the position at `time`, in `0..=1`, of a point that moves from `start` to `end` at constant
/// speed.
///
/// The result is exactly `start` at time 0 and exactly `end` at time 1. If `start == end`, it is exactly this point.
/// Each coordinate is between those of `start` and `end` (both included), because bounding boxes rely on it.
///
/// Pitfall: `start + t (end - start)` misses the end by a rounding error, and `(1 - t) start + t end` moves a point
/// that stands still.
///
/// Slide "Motion Blur".
pub fn lerp(start: Vec3, end: Vec3, time: f32) -> Vec3 {
    todo!("interpolate between start and end, and clamp to the box around them")
}

/// The motion bounds: the smallest box around everything that moves linearly from box `start` to box `end`.
///
/// It is exact: each coordinate is one of those of `start` and `end`.
///
/// Slide "Motion Blur".
pub fn motion_bounds(start: &Aabb, end: &Aabb) -> Aabb {
    todo!("find the smallest and the largest coordinates of both boxes")
}
