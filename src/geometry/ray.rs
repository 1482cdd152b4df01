//! Rays: `o + t d` over an open range of `t`, at one moment of time.

use crate::message;
use glam::Vec3;

/// A ray `origin + t * direction` for `t_min < t < t_max`.
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
/// `direction` need not be of unit length: `t` counts lengths of `direction`, so that a ray can be transformed into the
/// space of an instance and back without a change of `t`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// The point at `t` = 0, in world units.
    pub origin: Vec3,
    /// The direction, of any length but zero.
    pub direction: Vec3,
    /// The lower end of the range, open: a hit at or before this `t` does not count. It may be negative.
    pub t_min: f32,
    /// The upper end of the range, open: a hit at or beyond this `t` does not count. A search lowers it to
    /// the closest hit.
    pub t_max: f32,
    /// The time of the ray, `0..=1`, at which moving nodes are intersected.
    pub time: f32,
}

message! { Ray { origin, direction, t_min, t_max, time } }

impl Ray {
    /// A ray from `origin` along `direction` (any length but zero) with the range `0 < t < ∞`, at time 0.
    #[inline]
    pub fn new(origin: Vec3, direction: Vec3) -> Self {
        Ray { origin, direction, t_min: 0.0, t_max: f32::INFINITY, time: 0.0 }
    }

    /// The same ray with the open range `t_min < t < t_max`. If `t_min >= t_max` or one of them is NaN, no
    /// hit counts.
    #[inline]
    pub fn with_range(self, t_min: f32, t_max: f32) -> Self {
        Ray { t_min, t_max, ..self }
    }

    /// The point `origin + t * direction`, in world units. The range of the ray plays no role.
    #[inline]
    pub fn at(&self, t: f32) -> Vec3 {
        self.origin + t * self.direction
    }

    /// Whether a hit at `t` counts: `t_min < t < t_max`. Both ends are open, and NaN never counts.
    #[inline]
    pub fn contains(&self, t: f32) -> bool {
        self.t_min < t && t < self.t_max
    }
}
