//! Random inputs that shrink to small numbers.

use glam::Vec3;
use proptest::prelude::*;
use raykata::ray::Ray;
use raykata::shape::{Sphere, Triangle};

/// A coordinate in `-reach..=reach`, on a grid of 1/8. Such numbers are short in messages, and sums and products of a
/// few of them are exact.
fn coordinate(reach: i32) -> impl Strategy<Value = f32> + Clone {
    (-8 * reach..=8 * reach).prop_map(|eighths| eighths as f32 / 8.0)
}

/// A point on a grid of 1/8, each coordinate in `-reach..=reach`.
pub fn point(reach: i32) -> impl Strategy<Value = Vec3> + Clone {
    (coordinate(reach), coordinate(reach), coordinate(reach)).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

/// A point with full mantissas, each coordinate in `-reach..reach`.
pub fn rough_point(reach: f32) -> impl Strategy<Value = Vec3> + Clone {
    let range = -reach..reach;
    (range.clone(), range.clone(), range).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

/// A direction on a grid of 1/8, of any length except zero.
pub fn direction() -> impl Strategy<Value = Vec3> + Clone {
    point(4).prop_map(|v| if v == Vec3::ZERO { Vec3::X } else { v })
}

/// A direction of length 1.
pub fn unit() -> impl Strategy<Value = Vec3> + Clone {
    direction().prop_map(Vec3::normalize)
}

/// A sphere near the origin.
pub fn sphere() -> impl Strategy<Value = Sphere> + Clone {
    (point(4), 1..=32i32).prop_map(|(center, eighths)| Sphere { center, radius: eighths as f32 / 8.0 })
}

/// A ray with a unit direction from a point near the origin.
pub fn ray() -> impl Strategy<Value = Ray> + Clone {
    (point(8), unit()).prop_map(|(origin, direction)| Ray::new(origin, direction))
}

/// A triangle near the origin, with an area.
pub fn triangle() -> impl Strategy<Value = Triangle> + Clone {
    let corners = (point(4), point(4), point(4));
    let has_area = |(a, b, c): &(Vec3, Vec3, Vec3)| (*b - *a).cross(*c - *a) != Vec3::ZERO;
    corners.prop_filter("no area", has_area).prop_map(|(a, b, c)| Triangle { a, b, c })
}

/// A positive number between `10^low` and `10^high`, uniform in its logarithm.
pub fn magnitude(low: f32, high: f32) -> impl Strategy<Value = f32> + Clone {
    (low..high).prop_map(|exponent| 10f32.powf(exponent))
}
