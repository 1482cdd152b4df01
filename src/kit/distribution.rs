//! Stage 6 in plain data.

use crate::camera::{Camera, Lens, Shutter};
use crate::ray::Ray;
use crate::shape::Sphere;
use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// How far a Gaussian pixel reaches from its centre along x and y, in pixels.
pub const FILTER_RADIUS: f32 = 1.5;

/// What one sample of a pixel found.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct WeightedColor {
    /// In linear light.
    pub color: Vec3,
    /// How much it counts among the samples of its pixel.
    pub weight: f32,
}

/// Which ray leaves the lens here?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LensQuery {
    /// The camera.
    pub camera: Camera,
    /// The ray through the middle of the lens.
    pub pinhole: Ray,
    /// The lens.
    pub lens: Lens,
    /// A place on a disk of radius 1.
    pub on_lens: Vec2,
}

/// Which point of a rectangle?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RectangleQuery {
    /// One corner.
    pub corner: Vec3,
    /// The two edges that leave it.
    pub edges: (Vec3, Vec3),
    /// Two random numbers.
    pub u: Vec2,
}

/// Which way to a ball?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BallQuery {
    /// The ball.
    pub ball: Sphere,
    /// From where.
    pub from: Vec3,
    /// Two random numbers.
    pub u: Vec2,
}

/// Which way off or through a rough surface?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GlossQuery {
    /// Where a smooth surface would send the ray; unit length.
    pub ideal: Vec3,
    /// Unit normal on the side on which the ray goes on.
    pub normal: Vec3,
    /// 0 is sharp, 1 is as blurred as can be.
    pub roughness: f32,
    /// Two random numbers.
    pub u: Vec2,
}

/// When, while the shutter is open?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TimeQuery {
    /// The shutter.
    pub shutter: Shutter,
    /// Which of the slots, from 1.
    pub slot: u32,
    /// Into how many slots of equal length the time is divided.
    pub slots: u32,
    /// Where in the slot: a random number.
    pub u: f32,
}
