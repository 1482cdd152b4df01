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

// <solution>
/// The largest number below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;
// </solution>

/// Stratified samples: the pixel, whose side is 1, is a grid of cells with one random sample each,
/// at `(cell + u) / grid`. What is 3 + 0.99999994, rounded?
///
/// The result is in its cell, up to rounding, and in `0.0..1.0` along x and y: 1 belongs to the
/// next pixel.
///
/// Source: "Generate pixel samples".
pub fn jittered(stratum: &Stratum) -> Vec2 {
    // <solution>
    // Stay below 1: the sum cell + u may be rounded up to the next whole number.
    ((stratum.cell.as_vec2() + stratum.u) / stratum.grid.as_vec2()).min(Vec2::splat(BELOW_ONE))
    // <stub> todo!("scale the position in the cell to the whole grid, and stay below 1")
    // </solution>
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
    // <solution>
    let center = Vec2::splat(0.5);
    match sampler {
        Sampler::Center => center,
        Sampler::Random | Sampler::LowDiscrepancy => stratum.u,
        Sampler::Jittered => jittered(stratum),
        Sampler::Gaussian => center + FILTER_RADIUS * (2.0 * jittered(stratum) - 1.0),
    }
    // <stub> todo!("return the position for each sampler")
    // </solution>
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
    // <solution>
    // Cut each factor off at 0: beyond R along both axes the product of two negative factors would
    // be positive.
    let bell = |x: f32| ((-2.0 * x * x).exp() - (-2.0 * FILTER_RADIUS * FILTER_RADIUS).exp()).max(0.0);
    bell(offset.x) * bell(offset.y)
    // <stub> todo!("multiply a weight along x by a weight along y, each 0 from R on")
    // </solution>
}

/// The colour of a pixel is the weighted mean of its samples. If all samples are white, is the
/// pixel white, for any weights?
///
/// Each weight is at least 0. Without samples, or if the weights sum to 0, the pixel is black. The
/// colour is not clamped.
///
/// Source: "Antialiasing".
pub fn filter_pixel(samples: &[WeightedColor]) -> Vec3 {
    // <solution>
    // Divide by the sum of the weights and not by the number of samples, so that white samples give
    // white.
    let color: Vec3 = samples.iter().map(|sample| sample.weight * sample.color).sum();
    let weight: f32 = samples.iter().map(|sample| sample.weight).sum();
    if weight > 0.0 { color / weight } else { Vec3::ZERO }
    // <stub> todo!("divide the sum of weighted colours by the sum of weights")
    // </solution>
}

/// A uniformly distributed point of the disk of radius 1 around the origin. What part of the disk
/// lies within half of its radius?
///
/// Every `u` gives a point whose distance from the origin is at most 1 (up to rounding), and no `u`
/// gives NaN.
///
/// Source: "Depth of Field".
pub fn sample_disk(u: Vec2) -> Vec2 {
    // <solution>
    // Map concentric squares to circles, so that points far apart in the square stay far apart
    // (Shirley and Chiu, "A low distortion map between disk and square", 1997).
    let square = 2.0 * u - 1.0;
    // Return the centre at once, because the formulas below divide by 0 there.
    if square == Vec2::ZERO {
        return Vec2::ZERO;
    }
    // Compute polar coordinates: the larger coordinate is the radius, and the ratio gives the
    // angle.
    let (radius, angle) = if square.x.abs() > square.y.abs() {
        (square.x, FRAC_PI_4 * (square.y / square.x))
    } else {
        (square.y, 2.0 * FRAC_PI_4 - FRAC_PI_4 * (square.x / square.y))
    };
    radius * vec2(angle.cos(), angle.sin())
    // <stub> todo!("map the unit square to the disk, area for area")
    // </solution>
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
    // <solution>
    // Find the start of the ray, relative to the centre of the lens.
    let lens_point = 0.5 * lens.aperture * on_lens;
    let offset = lens_point.x * camera.right + lens_point.y * camera.up;
    if offset == Vec3::ZERO {
        return *pinhole;
    }
    // Aim at the focal plane, also relative to the centre, so that a large camera.position adds no
    // rounding error. Points at focal_distance along each ray would form a sphere: divide by the
    // cosine.
    let focus = lens.focal_distance / pinhole.direction.dot(camera.towards) * pinhole.direction;
    Ray { origin: camera.position + offset, direction: (focus - offset).normalize(), ..*pinhole }
    // <stub> todo!("start on the lens, and aim where the pinhole ray meets the focal plane")
    // </solution>
}

/// A uniformly distributed point of the rectangle at `corner`. `edges` are the vectors along both
/// sides, which need not be at right angles.
///
/// Source: "Area Lights".
pub fn sample_rectangle(corner: Vec3, edges: (Vec3, Vec3), u: Vec2) -> Vec3 {
    // <solution>
    corner + u.x * edges.0 + u.y * edges.1
    // <stub> todo!("start at the corner and go along both edges")
    // </solution>
}

/// A uniformly distributed point of a disk. `disk.normal` need not have unit length.
///
/// Source: "Area Lights".
pub fn sample_light_disk(disk: &Disk, u: Vec2) -> Vec3 {
    // <solution>
    let (x, y) = disk.normal.normalize().any_orthonormal_pair();
    let point = disk.radius * sample_disk(u);
    disk.center + point.x * x + point.y * y
    // <stub> todo!("map a point of the unit disk to this disk")
    // </solution>
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
    // <solution>
    // Measure lengths in radii, so that the square of a tiny one does not underflow.
    let to_center = (sphere.center - from) / sphere.radius;
    let sin_squared = to_center.length_squared().recip();
    // Compute 1 - cos θ of the rim. From inside it is 2, up to the direction away from the centre.
    let one_minus_cos_max =
        if sin_squared < 1.0 { sin_squared / (1.0 + (1.0 - sin_squared).sqrt()) } else { 2.0 };
    // Choose 1 - cos θ uniformly, because slices of a sphere of equal height have equal area
    // (Archimedes).
    around(to_center.normalize_or(Vec3::Y), u.x * one_minus_cos_max, u.y)
    // <stub> todo!("choose 1 - cos θ uniformly between 0 and that of the rim, and any angle around the axis")
    // </solution>
}

// <solution>
/// The unit vector at the angle θ to `axis`, turned around `axis` by the fraction `turn` of a full
/// turn. For a small angle `cos θ` is imprecise, so θ is given as `1 - cos θ`, from which `sin θ`
/// follows without cancellation.
pub fn around(axis: Vec3, one_minus_cos: f32, turn: f32) -> Vec3 {
    let sin_theta = (one_minus_cos * (2.0 - one_minus_cos)).max(0.0).sqrt();
    let (x, y) = axis.any_orthonormal_pair();
    let (sin_phi, cos_phi) = (TAU * turn).sin_cos();
    ((1.0 - one_minus_cos) * axis + sin_theta * (cos_phi * x + sin_phi * y)).normalize()
}
// </solution>

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
    // <solution>
    if roughness <= 0.0 {
        return ideal;
    }
    // Choose 1 - cos θ such that cos θ = u^(1 / (n + 1)), and turn by any angle around ideal.
    // `-exp_m1(ln(u) / (n + 1))` is 1 - cos θ with all its digits, also near 0, where √(1 - cos² θ)
    // has few values.
    let exponent = 2.0 / (roughness * roughness) - 2.0;
    let one_minus_cos = -(u.x.ln() / (exponent + 1.0)).exp_m1();
    let direction = around(ideal, one_minus_cos, u.y);
    // Reflect a direction below the surface back to its side.
    let above = direction.dot(normal);
    if above < 0.0 { direction - 2.0 * above * normal } else { direction }
    // <stub> todo!("turn ideal by a random angle, and keep it on its side of the surface")
    // </solution>
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
    // <solution>
    const TABLE: [[u32; 4]; 4] = [[7, 11, 3, 14], [4, 15, 13, 9], [16, 1, 8, 12], [6, 10, 5, 2]];
    TABLE[y as usize % 4][x as usize % 4]
    // <stub> todo!("look up the slot: y is the row, x is the column, and blocks repeat")
    // </solution>
}

/// Motion blur: the interval in which the shutter is open is divided into `slots` slots of equal
/// length. Which time is at position `u` of slot `slot`? May rounding lead beyond the interval?
///
/// `slot` counts from 1, and `u = 0` is the beginning of the slot. The result is in
/// `shutter.open..=shutter.close`, both ends included.
///
/// Source: "Motion Blur".
pub fn time_in_shutter(shutter: &Shutter, slot: u32, slots: u32, u: f32) -> f32 {
    // <solution>
    let share = ((slot - 1) as f32 + u) / slots as f32;
    // The rounded sum may lie outside the interval.
    (shutter.open + share * (shutter.close - shutter.open)).clamp(shutter.open, shutter.close)
    // <stub> todo!("add u to the number of slots before this one, and scale from open to close")
    // </solution>
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
    // <solution>
    // This form reaches both ends exactly, which start + t (end - start) does not. It may leave the
    // box by a rounding, also for a point that stands still: clamp to the box.
    let blended = (1.0 - time) * start + time * end;
    blended.max(start.min(end)).min(start.max(end))
    // <stub> todo!("interpolate between start and end, and clamp to the box around them")
    // </solution>
}

/// The smallest box around everything that moves linearly from box `start` to box `end`. It is
/// exact: each coordinate is one of those of `start` and `end`.
///
/// Source: "Motion Blur".
pub fn motion_bounds(start: &Aabb, end: &Aabb) -> Aabb {
    // <solution>
    // Corners move along straight lines, so each coordinate is largest and smallest at one of the
    // two ends.
    Aabb::new(start.min.min(end.min), start.max.max(end.max))
    // <stub> todo!("find the smallest and the largest coordinates of both boxes")
    // </solution>
}
