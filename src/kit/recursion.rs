//! Stage 5, reflection and refraction: queries and answers.

use crate::light::surface::Limits;
use crate::material::Material;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Asks in which direction light is refracted that crosses from a medium of index `n1` into one of
/// index `n2`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RefractQuery {
    /// The direction of the ray, of unit length.
    pub direction: Vec3,
    /// The unit normal on the side that the ray comes from.
    pub normal: Vec3,
    /// The index of refraction of the medium that the ray comes from, above 0.
    pub n1: f32,
    /// The index of refraction of the medium behind the surface, above 0.
    pub n2: f32,
}

/// Asks which fraction of the light is reflected (Fresnel reflectance).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FresnelQuery {
    /// The cosine of the angle of incidence, between the normal and the reversed ray, `0..=1`.
    pub cos_theta: f32,
    /// The index of refraction of the medium that the ray comes from, above 0.
    pub n1: f32,
    /// The index of refraction of the medium behind the surface, above 0.
    pub n2: f32,
}

/// Asks which secondary rays leave a surface; the answer is a list of
/// [`SecondaryRay`](super::SecondaryRay).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ScatterQuery {
    /// The direction of the incoming ray, of unit length.
    pub direction: Vec3,
    /// The unit normal on the side that the ray comes from.
    pub normal: Vec3,
    /// Whether the ray comes from outside of the material.
    pub entering: bool,
    /// The material of the surface; the index of refraction outside is 1.
    pub material: Material,
    /// The factor, per channel, with which the light along the incoming ray contributes to the pixel.
    pub weight: Vec3,
    /// The number of reflections and refractions so far: 0 for a ray from the camera.
    pub depth: u32,
    /// The limits at which the path ends.
    pub limits: Limits,
}
