//! Stage 11, light transport: queries.

use crate::emitter::{AreaEmitter, EmitterSample};
use crate::light_path::{PathState, PathVertex, Scattering, StepNumbers};
use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// Asks which point of an emitter two random numbers sample; the answer is an
/// [`EmitterSample`](crate::emitter::EmitterSample).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EmitterQuery {
    /// The emitter.
    pub emitter: AreaEmitter,
    /// The point that the emitter illuminates, in world units.
    pub from: Vec3,
    /// Two random numbers, `0 <= u < 1` each.
    pub u: Vec2,
}

/// Asks for the density with which a direction to an emitter is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EmitterPdfQuery {
    /// The emitter.
    pub emitter: AreaEmitter,
    /// The point that the emitter illuminates, in world units.
    pub from: Vec3,
    /// The direction, of unit length.
    pub direction: Vec3,
}

/// Asks whether a path survives Russian roulette.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RouletteQuery {
    /// The factor per channel with which light that the path finds contributes to the pixel, at least 0.
    pub weight: Vec3,
    /// The number of surfaces that the path has met.
    pub bounce: u32,
    /// A random number, `0 <= u < 1`.
    pub u: f32,
}

/// Asks in which direction a path continues; the answer is a [`BsdfSample`](crate::light_path::BsdfSample).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BsdfQuery {
    /// How the surface scatters light.
    pub scattering: Scattering,
    /// Three random numbers, `0 <= u < 1` each.
    pub u: Vec3,
}

/// Asks for the density with which a direction is sampled at a surface.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BsdfPdfQuery {
    /// How the surface scatters light.
    pub scattering: Scattering,
    /// The direction, of unit length.
    pub direction: Vec3,
}

/// Asks for the light of a sample of a light that a diffuse surface sends on.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightContributionQuery {
    /// The diffuse reflectance of the surface.
    pub diffuse: Vec3,
    /// The unit normal of the surface.
    pub normal: Vec3,
    /// The sample of the light.
    pub sample: EmitterSample,
    /// The density with which the surface samples the direction of the sample, per steradian.
    pub bsdf_pdf: f32,
}

/// Asks for the light of a surface that a ray has hit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EmissionQuery {
    /// The radiance that the surface emits back along the ray.
    pub emission: Vec3,
    /// The density with which the direction of the ray was sampled, per steradian.
    pub pdf: f32,
    /// The density with which a sample of the light has this direction, per steradian.
    pub light_pdf: f32,
}

/// Asks for a step of a path; the answer is a [`PathStep`](crate::light_path::PathStep).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StepQuery {
    /// The path up to the surface.
    pub path: PathState,
    /// The surface.
    pub vertex: PathVertex,
    /// The greatest number of reflections and refractions on a path.
    pub max_depth: u32,
    /// The random numbers of the step.
    pub numbers: StepNumbers,
}
