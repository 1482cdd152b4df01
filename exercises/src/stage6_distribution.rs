//! Stage 6 · distribution: many rays where one was, spread over the pixel, the lens, the light, the mirror and the time.
//!
//! Slides: "Antialiasing", "Generate pixel samples", "Distributed Ray Tracing", "Depth of Field", "Soft shadows",
//! "Temporal Jittering Sampling".
//!
//! Nothing here is random: random numbers come as arguments, `u` in `0.0..1.0` each, and what you return has to be
//! distributed as it should when they are distributed evenly. Which of the many right formulas you take is yours to
//! choose.

use glam::{Vec2, Vec3, vec2};
use raykata::aabb::Aabb;
use raykata::camera::{Camera, Lens, Shutter};
use raykata::kit::{FILTER_RADIUS, WeightedColor};
use raykata::random::Stratum;
use raykata::ray::Ray;
use raykata::scene::Sampler;
use raykata::shape::{Disk, Sphere};
use std::f32::consts::{FRAC_PI_4, TAU};

/// The sample in its cell: `(cell + u) / grid`, in `0.0..1.0` along x and y.
///
/// Where the formula lies: 3 + 0.99999994 is rounded to 4, and then the sample lies in the next pixel. Never return 1.
pub fn jittered(stratum: &Stratum) -> Vec2 {
    todo!("scale the place in the cell to the whole grid, and stay below 1")
}

/// Where a sample lies, seen from the upper left corner of its pixel, whose side is 1: in the centre; at `u`
/// ([`Sampler::Random`] and [`Sampler::LowDiscrepancy`], whose numbers are spread already); [`jittered`]; or
/// ([`Sampler::Gaussian`]) jittered over a square that reaches [`FILTER_RADIUS`] from the centre.
pub fn pixel_position(sampler: Sampler, stratum: &Stratum) -> Vec2 {
    todo!("one place for each sampler")
}

/// How much a sample counts that lies `offset` from the centre of its pixel:
/// `(e^(-2x²) - e^(-2R²)) (e^(-2y²) - e^(-2R²))` with R = [`FILTER_RADIUS`], and 0 beyond R along x or y.
///
/// Where the formula lies: the bell of Gauss never ends. Cut off without the second term it leaves a step, and the
/// product of two negative factors counts where nothing should.
pub fn gaussian_weight(offset: Vec2) -> f32 {
    todo!("a bell along x times a bell along y, each 0 from R on")
}

/// The colour of a pixel: the mean of its samples, each as much as its weight. Without any weight it is black.
///
/// Where the formula lies: divided by their number instead of by the sum of their weights, samples make the picture
/// darker or brighter.
pub fn filter_pixel(samples: &[WeightedColor]) -> Vec3 {
    todo!("divide the sum of weighted colours by the sum of weights")
}

/// A place on the disk of radius 1 around the origin, everywhere equally likely.
///
/// Where the formula lies: with the distance from the middle even in `0..1`, half of all places lie on a quarter of the
/// disk. And corners of the square are not on the disk.
pub fn sample_disk(u: Vec2) -> Vec2 {
    todo!("map the unit square to the disk, area for area")
}

/// The ray that leaves the lens at `on_lens`, a place on a disk of radius 1 that stands for the opening, and meets
/// `pinhole`, the ray through the middle, on the plane of focus: at right angles to the view direction,
/// `lens.focal_distance` away. Of unit length. From the middle it is `pinhole` itself, bit for bit.
///
/// Where the formula lies: `focal_distance` along the ray is a sphere, and edges of the picture blur. And far from the
/// origin the difference of two far points has few digits left: subtract before you add `camera.position`.
pub fn lens_ray(camera: &Camera, pinhole: &Ray, lens: &Lens, on_lens: Vec2) -> Ray {
    todo!("start on the lens and aim where the pinhole ray meets the plane of focus")
}

/// A point of the rectangle with this corner and these edges, everywhere equally likely.
pub fn sample_rectangle(corner: Vec3, edges: (Vec3, Vec3), u: Vec2) -> Vec3 {
    todo!("go along both edges")
}

/// A point of the disk, everywhere equally likely.
pub fn sample_light_disk(disk: &Disk, u: Vec2) -> Vec3 {
    todo!("carry a place on the unit disk to this one")
}

/// A unit direction in which the sphere is seen from `from`, each equally likely; from inside the sphere any direction.
///
/// Where the formula lies: `1 - cos θ` of a far sphere is rounded to 0, and its shadows turn sharp. With
/// `sin θ = radius / distance` it is `sin²θ / (1 + cos θ)`.
pub fn sample_sphere(sphere: &Sphere, from: Vec3, u: Vec2) -> Vec3 {
    todo!("a direction in the cone around the centre: 1 - cos θ even between 0 and that of the rim")
}

/// Where a rough surface sends a ray that a smooth one would send along `ideal`: at an angle θ to it with a likelihood
/// that falls with `cosⁿ θ`, `n = 2 / roughness² - 2`, alike on all sides. `normal` is on the side on which the ray goes
/// on; what would go through the surface is mirrored on it, back to that side. Of unit length; `ideal` itself, bit for
/// bit, if roughness is 0.
///
/// Where the formula lies: `cos θ = u^(1 / (n + 1))` of a slightly rough surface is 1 but for its last digits, and
/// `√(1 - cos² θ)` knows but a few angles. `-expm1(ln(u) / (n + 1))` is `1 - cos θ` with all its digits.
pub fn sample_phong_lobe(ideal: Vec3, normal: Vec3, roughness: f32, u: Vec2) -> Vec3 {
    todo!("turn ideal by a random angle, and keep it on its side of the surface")
}

/// The time slot, from 1 to 16, of the cell in column `x` and row `y`. Cells are divided into blocks of 4 by 4, and in
/// each block slots are handed out by this table (slide "Temporal Jittering Sampling"):
///
/// ```text
///  7 11  3 14
///  4 15 13  9
/// 16  1  8 12
///  6 10  5  2
/// ```
pub fn temporal_slot(x: u32, y: u32) -> u32 {
    todo!("look it up: the row is y, the column x, and blocks repeat")
}

/// A moment in slot `slot` (from 1) of `slots` slots of equal length into which `shutter` divides its time, at `u`
/// within the slot; never before it opens or after it closes.
pub fn time_in_shutter(shutter: &Shutter, slot: u32, slots: u32, u: f32) -> f32 {
    todo!("the slots before, and u of this one, between open and close")
}

/// Where a point is at `time` in `0..=1` that moves evenly from `start` to `end`.
///
/// Where the formula lies: `start + t (end - start)` misses the end by a rounding, and
/// `(1 - t) start + t end` moves a point that stands still. Be exact at both ends, stand still where nothing moves, and
/// never leave the way between: boxes rely on it.
pub fn lerp(start: Vec3, end: Vec3, time: f32) -> Vec3 {
    todo!("blend start and end, and stay between them")
}

/// The box around all places of something that moves evenly from box `start` to box `end`.
pub fn motion_bounds(start: &Aabb, end: &Aabb) -> Aabb {
    todo!("where can a corner be between the two?")
}
