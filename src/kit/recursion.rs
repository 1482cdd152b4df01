//! Stage 5 in plain data.

use crate::material::Material;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Light that crosses from a medium of index `n1` into one of index `n2`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RefractQuery {
    /// Unit direction of the ray.
    pub dir: Vec3,
    /// Unit normal on the side that the ray comes from.
    pub normal: Vec3,
    /// Index of refraction of the medium that the ray comes from.
    pub n1: f32,
    /// Index of refraction of the medium beyond.
    pub n2: f32,
}

/// How much of the light is mirrored?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FresnelQuery {
    /// Cosine between the normal and the way back along the ray, `0..=1`.
    pub cos_theta: f32,
    /// Index of refraction of the medium that the ray comes from.
    pub n1: f32,
    /// Index of refraction of the medium beyond.
    pub n2: f32,
}

/// When a path ends.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Limits {
    /// How often a ray may be mirrored or refracted on its way from the camera.
    pub max_depth: u32,
    /// A ray whose weight is below this in every channel is not traced.
    pub min_contribution: f32,
}

/// Which way a ray goes on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Bounce {
    /// Off the surface.
    Reflection,
    /// Through it.
    Transmission,
}

/// A ray that goes on from a surface.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Child {
    /// Which way.
    pub bounce: Bounce,
    /// Unit direction.
    pub direction: Vec3,
    /// What the light that it finds counts in the pixel.
    pub weight: Vec3,
}

/// Which rays go on from here?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ChildrenQuery {
    /// Unit direction of the ray that arrived.
    pub dir: Vec3,
    /// Unit normal on the side that the ray comes from.
    pub normal: Vec3,
    /// Whether the ray comes from outside.
    pub entering: bool,
    /// What the surface is made of; outside is index 1.
    pub material: Material,
    /// What the light of this ray counts in the pixel.
    pub weight: Vec3,
    /// How often it was mirrored or refracted: 0 for a ray from the camera.
    pub depth: u32,
    /// When the path ends.
    pub limits: Limits,
}
