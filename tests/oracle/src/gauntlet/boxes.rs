//! Rays at boxes.

use crate::splitmix::Random;
use glam::{BVec3, Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::kit::SlabQuery;
use raykata::ray::Ray;

/// A ray at the corner of a box. The box is small or large, near or far, sometimes flat; the direction may
/// have zeros.
pub fn at_a_corner(random: &mut Random) -> Option<SlabQuery> {
    let place = [Vec3::ZERO, Vec3::ONE, Vec3::splat(1e5)][random.below(3) as usize];
    let size = [1.0, 1e-3, 1e3][random.below(3) as usize];
    let (p, mut q) = (place + size * random.in_cube(), place + size * random.in_cube());
    if random.below(4) == 0 {
        let axis = random.below(3) as usize;
        q[axis] = p[axis];
    }
    let bounds = Aabb::new(p.min(q), p.max(q));
    let low = BVec3::from_array([(); 3].map(|()| random.below(2) == 0));
    let corner = Vec3::select(low, bounds.min, bounds.max);
    let mut origin = place + 4.0 * size * random.in_cube();
    if random.below(4) == 0 {
        let axis = random.below(3) as usize;
        origin[axis] = corner[axis];
    }
    let mut direction = corner - origin;
    if random.below(2) == 0 {
        // -0.0 is a zero as well.
        direction = Vec3::select(direction.cmpeq(Vec3::ZERO), Vec3::splat(-0.0), direction);
    }
    (direction != Vec3::ZERO).then(|| SlabQuery { ray: Ray::new(origin, direction), bounds })
}

/// A float with any sign and mantissa and an exponent from `low` to `high`.
fn number(random: &mut Random, low: i32, high: i32) -> f32 {
    let exponent = low + random.below((high - low) as u64 + 1) as i32;
    let sign = if random.below(2) == 0 { 1.0 } else { -1.0 };
    (sign * (1.0 + f64::from(random.unit())) * 2f64.powi(exponent)) as f32
}

/// A box and a ray through one of its corners, or through a point of it: coordinates of one size or of very different
/// ones, directions down to the denormal numbers, zeros of both signs, and ranges on both sides of 0 that may end near
/// the corner.
pub fn of_any_size(random: &mut Random) -> Option<SlabQuery> {
    let spread = [0, 10, 60][random.below(3) as usize];
    let size = random.below(121) as i32 - 60;
    let coordinate = |random: &mut Random| number(random, size - spread, size);
    let vector = |random: &mut Random| vec3(coordinate(random), coordinate(random), coordinate(random));
    let (p, mut q) = (vector(random), vector(random));
    for axis in 0..3 {
        if random.below(6) == 0 {
            q[axis] = p[axis];
        }
    }
    let bounds = Aabb::new(p.min(q), p.max(q));
    let mut origin = vector(random);
    for axis in 0..3 {
        if random.below(6) == 0 {
            origin[axis] = p[axis];
        }
    }
    let target = if random.below(3) == 0 { p.lerp(q, random.unit()) } else { p };
    let way = target - origin;
    // Scale the direction exactly, such that t is within the range of `f32`, and 1 / d often is not.
    let scale = [0, -70, -89, 40][random.below(4) as usize];
    let mut direction = way * 2f32.powi(scale);
    if random.below(4) == 0 {
        direction[random.below(3) as usize] = if random.below(2) == 0 { 0.0 } else { -0.0 };
    }
    if random.below(2) == 0 {
        direction = -direction;
    }
    let t = 2f32.powi(-scale);
    let end = |random: &mut Random| match random.below(5) {
        0 => f32::INFINITY,
        1 => t,
        2 => t.next_up(),
        3 => t * (2.0 * random.unit()),
        _ => -t * (2.0 * random.unit()),
    };
    let (one, other) = (end(random), end(random));
    let ray = match random.below(3) {
        0 => Ray::new(origin, direction),
        1 => Ray::new(origin, direction).with_range(f32::NEG_INFINITY, f32::INFINITY),
        _ => Ray::new(origin, direction).with_range(-one.max(other), one.max(other)),
    };
    (direction != Vec3::ZERO).then_some(SlabQuery { ray, bounds })
}
