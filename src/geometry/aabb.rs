//! Axis-aligned boxes as data. Union, centroid, surface area and the slab test are exercises of stage 3.

use crate::message;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// The closed box `min.x..=max.x` by `min.y..=max.y` by `min.z..=max.z`, in world units; a flat box and a
/// single point are boxes too. A box with any `min` above its `max`, or with NaN, is empty.
///
/// ```
/// use glam::Vec3;
/// use raykata::aabb::Aabb;
/// let unit = Aabb::new(Vec3::ZERO, Vec3::ONE);
/// assert!(unit.contains(Vec3::ONE)); // its surface belongs to it
/// assert!(unit.contains_box(&Aabb::EMPTY) && Aabb::EMPTY.is_empty());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Aabb {
    /// The corner with the smallest coordinate on each axis, in world units; it belongs to the box.
    pub min: Vec3,
    /// The corner with the largest coordinate on each axis, in world units; it belongs to the box.
    pub max: Vec3,
}

message! { Aabb { min, max } }

impl Aabb {
    /// The box that contains no point, with `min` = +∞ and `max` = -∞. It is the neutral element of union.
    pub const EMPTY: Aabb = Aabb { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The closed box from `min` to `max`, in world units. The corners are stored as they are: if `min` is
    /// above `max` on some axis, or a coordinate is NaN, then the box is empty.
    pub const fn new(min: Vec3, max: Vec3) -> Self {
        Aabb { min, max }
    }

    /// Whether the box contains no point: `min` is above `max` on some axis, or a coordinate is NaN.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Whether `point` lies in the box or on its surface. The answer is `false` for an empty box and for a
    /// point with NaN.
    pub fn contains(&self, point: Vec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// Whether every point of `inner` lies in this box. The answer is `true` for every empty `inner`.
    pub fn contains_box(&self, inner: &Aabb) -> bool {
        inner.is_empty() || (self.contains(inner.min) && self.contains(inner.max))
    }
}

/// The smallest box around `points`; empty when there are none.
pub(crate) fn bounds_of_points(points: &[Vec3]) -> Aabb {
    let min = points.iter().fold(Vec3::INFINITY, |low, p| low.min(*p));
    let max = points.iter().fold(Vec3::NEG_INFINITY, |high, p| high.max(*p));
    Aabb::new(min, max)
}
