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

// <solution>
/// The largest number below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;
// </solution>

/// The sample in its cell: `(cell + u) / grid`, in `0.0..1.0` along x and y.
///
/// Where the formula lies: 3 + 0.99999994 is rounded to 4, and then the sample lies in the next pixel. Never return 1.
pub fn jittered(stratum: &Stratum) -> Vec2 {
    // <solution>
    ((stratum.cell.as_vec2() + stratum.u) / stratum.grid.as_vec2()).min(Vec2::splat(BELOW_ONE))
    // <stub> todo!("scale the place in the cell to the whole grid, and stay below 1")
    // </solution>
}

/// Where a sample lies, seen from the upper left corner of its pixel, whose side is 1: in the centre; at `u`
/// ([`Sampler::Random`] and [`Sampler::LowDiscrepancy`], whose numbers are spread already); [`jittered`]; or
/// ([`Sampler::Gaussian`]) jittered over a square that reaches [`FILTER_RADIUS`] from the centre.
pub fn pixel_position(sampler: Sampler, stratum: &Stratum) -> Vec2 {
    // <solution>
    let center = Vec2::splat(0.5);
    match sampler {
        Sampler::Center => center,
        Sampler::Random | Sampler::LowDiscrepancy => stratum.u,
        Sampler::Jittered => jittered(stratum),
        Sampler::Gaussian => center + FILTER_RADIUS * (2.0 * jittered(stratum) - 1.0),
    }
    // <stub> todo!("one place for each sampler")
    // </solution>
}

/// How much a sample counts that lies `offset` from the centre of its pixel:
/// `(e^(-2x²) - e^(-2R²)) (e^(-2y²) - e^(-2R²))` with R = [`FILTER_RADIUS`], and 0 beyond R along x or y.
///
/// Where the formula lies: the bell of Gauss never ends. Cut off without the second term it leaves a step, and the
/// product of two negative factors counts where nothing should.
pub fn gaussian_weight(offset: Vec2) -> f32 {
    // <solution>
    let bell = |x: f32| ((-2.0 * x * x).exp() - (-2.0 * FILTER_RADIUS * FILTER_RADIUS).exp()).max(0.0);
    bell(offset.x) * bell(offset.y)
    // <stub> todo!("a bell along x times a bell along y, each 0 from R on")
    // </solution>
}

/// The colour of a pixel: the mean of its samples, each as much as its weight. Without any weight it is black.
///
/// Where the formula lies: divided by their number instead of by the sum of their weights, samples make the picture
/// darker or brighter.
pub fn filter_pixel(samples: &[WeightedColor]) -> Vec3 {
    // <solution>
    let color: Vec3 = samples.iter().map(|sample| sample.weight * sample.color).sum();
    let weight: f32 = samples.iter().map(|sample| sample.weight).sum();
    if weight > 0.0 { color / weight } else { Vec3::ZERO }
    // <stub> todo!("divide the sum of weighted colours by the sum of weights")
    // </solution>
}

/// A place on the disk of radius 1 around the origin, everywhere equally likely.
///
/// Where the formula lies: with the distance from the middle even in `0..1`, half of all places lie on a quarter of the
/// disk. And corners of the square are not on the disk.
pub fn sample_disk(u: Vec2) -> Vec2 {
    // <solution>
    // Squares around the middle become circles, so that places far apart in the square stay far apart (Shirley and
    // Chiu, "A low distortion map between disk and square", 1997).
    let square = 2.0 * u - 1.0;
    if square == Vec2::ZERO {
        return Vec2::ZERO;
    }
    let (radius, angle) = if square.x.abs() > square.y.abs() {
        (square.x, FRAC_PI_4 * (square.y / square.x))
    } else {
        (square.y, 2.0 * FRAC_PI_4 - FRAC_PI_4 * (square.x / square.y))
    };
    radius * vec2(angle.cos(), angle.sin())
    // <stub> todo!("map the unit square to the disk, area for area")
    // </solution>
}

/// The ray that leaves the lens at `on_lens`, a place on a disk of radius 1 that stands for the opening, and meets
/// `pinhole`, the ray through the middle, on the plane of focus: at right angles to the view direction,
/// `lens.focal_distance` away. Of unit length. From the middle it is `pinhole` itself, bit for bit.
///
/// Where the formula lies: `focal_distance` along the ray is a sphere, and edges of the picture blur. And far from the
/// origin the difference of two far points has few digits left: subtract before you add `camera.position`.
pub fn lens_ray(camera: &Camera, pinhole: &Ray, lens: &Lens, on_lens: Vec2) -> Ray {
    // <solution>
    let place = 0.5 * lens.aperture * on_lens;
    let offset = place.x * camera.right + place.y * camera.up;
    if offset == Vec3::ZERO {
        return *pinhole;
    }
    // Both seen from the middle of the lens, so that camera.position, however large, takes no part.
    let focus = lens.focal_distance / pinhole.direction.dot(camera.towards) * pinhole.direction;
    Ray { origin: camera.position + offset, direction: (focus - offset).normalize(), ..*pinhole }
    // <stub> todo!("start on the lens and aim where the pinhole ray meets the plane of focus")
    // </solution>
}

/// A point of the rectangle with this corner and these edges, everywhere equally likely.
pub fn sample_rectangle(corner: Vec3, edges: (Vec3, Vec3), u: Vec2) -> Vec3 {
    // <solution>
    corner + u.x * edges.0 + u.y * edges.1
    // <stub> todo!("go along both edges")
    // </solution>
}

/// A point of the disk, everywhere equally likely.
pub fn sample_light_disk(disk: &Disk, u: Vec2) -> Vec3 {
    // <solution>
    let (x, y) = disk.normal.normalize().any_orthonormal_pair();
    let place = disk.radius * sample_disk(u);
    disk.center + place.x * x + place.y * y
    // <stub> todo!("carry a place on the unit disk to this one")
    // </solution>
}

/// A unit direction in which the sphere is seen from `from`, each equally likely; from inside the sphere any direction.
///
/// Where the formula lies: `1 - cos θ` of a far sphere is rounded to 0, and its shadows turn sharp. With
/// `sin θ = radius / distance` it is `sin²θ / (1 + cos θ)`.
pub fn sample_sphere(sphere: &Sphere, from: Vec3, u: Vec2) -> Vec3 {
    // <solution>
    let to_center = sphere.center - from;
    let sin_squared = sphere.radius * sphere.radius / to_center.length_squared();
    // 1 - cos θ of the directions along the rim; 2 is the direction away from the centre.
    let widest = if sin_squared < 1.0 { sin_squared / (1.0 + (1.0 - sin_squared).sqrt()) } else { 2.0 };
    // Slices of equal height have equal area on a sphere (Archimedes).
    around(to_center.normalize_or(Vec3::Y), u.x * widest, u.y)
    // <stub> todo!("a direction in the cone around the centre: 1 - cos θ even between 0 and that of the rim")
    // </solution>
}

// <solution>
/// The unit vector at an angle to `axis` whose cosine is `1 - below_one`, turned around it by the share `turn` of a
/// circle. The sine comes from `below_one` and not from the cosine, which has lost its digits for small angles.
fn around(axis: Vec3, below_one: f32, turn: f32) -> Vec3 {
    let sine = (below_one * (2.0 - below_one)).max(0.0).sqrt();
    let (x, y) = axis.any_orthonormal_pair();
    let (sin_turn, cos_turn) = (TAU * turn).sin_cos();
    ((1.0 - below_one) * axis + sine * (cos_turn * x + sin_turn * y)).normalize()
}
// </solution>

/// Where a rough surface sends a ray that a smooth one would send along `ideal`: at an angle θ to it with a likelihood
/// that falls with `cosⁿ θ`, `n = 2 / roughness² - 2`, alike on all sides. `normal` is on the side on which the ray goes
/// on; what would go through the surface is mirrored on it, back to that side. Of unit length; `ideal` itself, bit for
/// bit, if roughness is 0.
///
/// Where the formula lies: `cos θ = u^(1 / (n + 1))` of a slightly rough surface is 1 but for its last digits, and
/// `√(1 - cos² θ)` knows but a few angles. `-expm1(ln(u) / (n + 1))` is `1 - cos θ` with all its digits.
pub fn sample_phong_lobe(ideal: Vec3, normal: Vec3, roughness: f32, u: Vec2) -> Vec3 {
    // <solution>
    if roughness <= 0.0 {
        return ideal;
    }
    let exponent = 2.0 / (roughness * roughness) - 2.0;
    let below_one = -(u.x.ln() / (exponent + 1.0)).exp_m1();
    let direction = around(ideal, below_one, u.y);
    let above = direction.dot(normal);
    if above < 0.0 { direction - 2.0 * above * normal } else { direction }
    // <stub> todo!("turn ideal by a random angle, and keep it on its side of the surface")
    // </solution>
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
    // <solution>
    const TABLE: [[u32; 4]; 4] = [[7, 11, 3, 14], [4, 15, 13, 9], [16, 1, 8, 12], [6, 10, 5, 2]];
    TABLE[y as usize % 4][x as usize % 4]
    // <stub> todo!("look it up: the row is y, the column x, and blocks repeat")
    // </solution>
}

/// A moment in slot `slot` (from 1) of `slots` slots of equal length into which `shutter` divides its time, at `u`
/// within the slot; never before it opens or after it closes.
pub fn time_in_shutter(shutter: &Shutter, slot: u32, slots: u32, u: f32) -> f32 {
    // <solution>
    let share = ((slot - 1) as f32 + u) / slots as f32;
    (shutter.open + share * (shutter.close - shutter.open)).clamp(shutter.open, shutter.close)
    // <stub> todo!("the slots before, and u of this one, between open and close")
    // </solution>
}

/// Where a point is at `time` in `0..=1` that moves evenly from `start` to `end`.
///
/// Where the formula lies: `start + t (end - start)` misses the end by a rounding, and
/// `(1 - t) start + t end` moves a point that stands still. Be exact at both ends, stand still where nothing moves, and
/// never leave the way between: boxes rely on it.
pub fn lerp(start: Vec3, end: Vec3, time: f32) -> Vec3 {
    // <solution>
    let blended = (1.0 - time) * start + time * end;
    blended.max(start.min(end)).min(start.max(end))
    // <stub> todo!("blend start and end, and stay between them")
    // </solution>
}

/// The box around all places of something that moves evenly from box `start` to box `end`.
pub fn motion_bounds(start: &Aabb, end: &Aabb) -> Aabb {
    // <solution>
    // Corners move along straight lines, so whatever lies within both boxes' bounds at the ends does so in between.
    Aabb::new(start.min.min(end.min), start.max.max(end.max))
    // <stub> todo!("where can a corner be between the two?")
    // </solution>
}
