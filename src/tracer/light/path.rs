//! A path from the camera: the ray that is followed now.

use super::texture_filter::Cone;
use crate::kit::RayKind;
use crate::random::Points;
use crate::ray::Ray;
use glam::Vec3;

/// A ray that is followed, with the weight of its light in the pixel.
#[derive(Clone, Copy)]
pub struct Path {
    /// The ray, in world space and at one shutter time.
    pub ray: Ray,
    /// Where the random numbers of this path are looked up.
    pub points: Points,
    /// The weight per channel of the light along this ray in the pixel; 1 for a camera ray.
    pub weight: Vec3,
    /// The number of reflections and refractions between the camera and this ray.
    pub depth: u32,
    /// Whether it is a camera ray, a reflected or a transmitted ray.
    pub kind: RayKind,
    /// Index of its parent ray in the record; `None` for a camera ray.
    pub parent: Option<usize>,
    /// The cone that the ray stands for, if images are filtered.
    pub cone: Cone,
}

impl Path {
    /// The path of the camera ray `ray`, with weight 1 and depth 0.
    pub fn from_camera(ray: Ray, points: Points, cone: Cone) -> Path {
        Path { ray, points, weight: Vec3::ONE, depth: 0, kind: RayKind::Primary, parent: None, cone }
    }
}
