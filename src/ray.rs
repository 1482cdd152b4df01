//! Rays: `o + t d` over an open range of `t`, at one moment of time.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A ray `origin + t * dir` for `t_min < t < t_max`.
///
/// ```
/// use glam::vec3;
/// use raykata::ray::Ray;
/// let ray = Ray::new(vec3(1.0, 0.0, 0.0), vec3(0.0, 0.0, -2.0));
/// assert_eq!(ray.at(3.0), vec3(1.0, 0.0, -6.0)); // t counts lengths of the direction
/// let shorter = ray.with_range(0.5, 3.0);
/// assert!(shorter.contains(1.0) && !shorter.contains(0.5) && !shorter.contains(3.0)); // both ends are open
/// ```
///
/// `dir` need not be of unit length: `t` counts lengths of `dir`, so that a ray can be carried into the space
/// of an instance and back without touching `t`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Ray {
    /// Where the ray starts, in world units.
    pub origin: Vec3,
    /// Where it goes; any length but zero.
    pub dir: Vec3,
    /// Hits at or before this `t` do not count.
    pub t_min: f32,
    /// Hits at or beyond this `t` do not count; shrinks while the closest hit is sought.
    pub t_max: f32,
    /// The moment at which the ray flies, `0..=1` over the shutter interval.
    pub time: f32,
}

impl Ray {
    /// A ray from `origin` along `dir` that counts every hit in front of it.
    #[inline]
    pub fn new(origin: Vec3, dir: Vec3) -> Self {
        Ray { origin, dir, t_min: 0.0, t_max: f32::INFINITY, time: 0.0 }
    }

    /// The same ray, counting hits in `t_min < t < t_max` only.
    #[inline]
    pub fn with_range(self, t_min: f32, t_max: f32) -> Self {
        Ray { t_min, t_max, ..self }
    }

    /// The point `origin + t * dir`.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + t * self.dir
    }

    /// Whether a hit at `t` counts. Both ends are open, and NaN never counts.
    #[inline]
    pub fn contains(&self, t: f32) -> bool {
        self.t_min < t && t < self.t_max
    }
}
