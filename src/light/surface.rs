//! A point of a surface, the light that arrives there, and the rays that leave it.

use crate::message;
use glam::Vec3;

/// A point of a surface that is to be shaded, with its normals and its rounding error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Surface {
    /// The point in world units, rounded to single precision.
    pub point: Vec3,
    /// A bound on the rounding error of `point` along each axis, in world units, at least 0.
    pub error: Vec3,
    /// The unit normal of the shape itself, on the viewer's side.
    pub geometric_normal: Vec3,
    /// The unit normal for shading, on the viewer's side. It differs from the geometric one on smooth meshes.
    pub shading_normal: Vec3,
}

message! { Surface { point, error, geometric_normal, shading_normal } }

/// The light that would arrive at a point from one point of a light, without occlusion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSample {
    /// The direction from the point to the light, of unit length.
    pub direction: Vec3,
    /// The distance from the point to the light in world units; infinite for a directional light.
    pub distance: f32,
    /// The light that arrives, in linear light: the light's colour times its intensity and its falloff with
    /// distance.
    pub radiance: Vec3,
}

message! { LightSample { direction, distance, radiance } }

/// How a secondary ray leaves a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Bounce {
    /// The ray is reflected.
    Reflection,
    /// The ray is refracted through the surface.
    Transmission,
}

message! { enum Bounce { Reflection, Transmission } }

/// A secondary ray that leaves a surface: its kind, direction and weight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SecondaryRay {
    /// Whether the ray is reflected or refracted.
    pub bounce: Bounce,
    /// The direction of the ray, of unit length.
    pub direction: Vec3,
    /// The factor, per channel, with which the light along the ray contributes to the pixel.
    pub weight: Vec3,
}

message! { SecondaryRay { bounce, direction, weight } }

/// The limits at which a path ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The greatest number of reflections and refractions on a path from the camera.
    pub max_depth: u32,
    /// The smallest weight: a ray whose weight is below it in every channel is not traced.
    pub min_contribution: f32,
}

message! { Limits { max_depth, min_contribution } }
