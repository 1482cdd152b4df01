//! Axis-aligned boxes as data. Union, centroid, surface area and the slab test are exercises of stage 3.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// The box `min.x..=max.x` by `min.y..=max.y` by `min.z..=max.z`; a flat box and a single point are boxes too.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Aabb {
    /// The corner with the smallest coordinates.
    pub min: Vec3,
    /// The corner with the largest coordinates.
    pub max: Vec3,
}

impl Aabb {
    /// The box that holds nothing: the neutral element of union.
    pub const EMPTY: Aabb = Aabb { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The box from `min` to `max`.
    pub const fn new(min: Vec3, max: Vec3) -> Self {
        Aabb { min, max }
    }

    /// Whether no point lies in the box.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Whether `point` lies in the box or on its surface.
    pub fn contains(&self, point: Vec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// Whether every point of `inner` lies in this box.
    pub fn contains_box(&self, inner: &Aabb) -> bool {
        inner.is_empty() || (self.contains(inner.min) && self.contains(inner.max))
    }
}
