//! Paths of light through a scene, as data (stage 11): the state of a path, a surface that it meets, and what happens there.
//!
//! The scaffold traces the rays, finds the surfaces and chooses an emitter. The student's `step` decides what light the path
//! collects at a surface and how it continues. So one step needs no scene: a renderer follows one path after the other, and
//! a check asks for the next step of many paths at once.

use crate::emitter::{AreaEmitter, EmitterSample};
use crate::light::surface::{Bounce, SecondaryRay, Surface};
use crate::message;
use glam::{Vec2, Vec3};

/// A way in which a surface sends light on: a part (lobe) of its bidirectional scattering distribution function (BSDF).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lobe {
    /// Diffuse (Lambertian) reflection in all directions above the surface.
    Diffuse,
    /// Reflection in one direction, that of the reflected ray of stage 5.
    Reflection,
    /// Transmission in one direction, that of the refracted ray of stage 5.
    Transmission,
}

message! { enum Lobe { Diffuse, Reflection, Transmission } }

impl Lobe {
    /// On which side of the surface rays of the lobe leave it: a diffuse ray leaves on the side of a reflected ray.
    pub fn bounce(self) -> Bounce {
        match self {
            Lobe::Diffuse | Lobe::Reflection => Bounce::Reflection,
            Lobe::Transmission => Bounce::Transmission,
        }
    }
}

/// How a surface scatters light that arrives along one ray.
#[derive(Clone, Debug, PartialEq)]
pub struct Scattering {
    /// `kd`, the diffuse reflectance, at least 0 in each channel.
    pub diffuse: Vec3,
    /// The unit normal for shading, on the side that the ray comes from.
    pub normal: Vec3,
    /// The secondary rays that `scatter` of stage 5 returns for a ray of weight 1: at most one reflected and one refracted
    /// ray. The weight of each is the fraction of light per channel that goes this way, at least 0.
    pub secondary: Vec<SecondaryRay>,
}

message! { Scattering { diffuse, normal, secondary } }

/// A direction in which a path continues, sampled at random.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BsdfSample {
    /// The lobe that was chosen.
    pub lobe: Lobe,
    /// The direction, of unit length.
    pub direction: Vec3,
    /// The factor, per channel, with which light from this direction contributes to the light of the path. The probability of
    /// the choice of the lobe is included.
    pub weight: Vec3,
    /// The probability density of the direction per steradian, the probability of the choice of the lobe included.
    /// Infinite for a reflected or refracted ray, whose direction is certain.
    pub pdf: f32,
}

message! { BsdfSample { lobe, direction, weight, pdf } }

/// A path from the camera up to a ray that has just hit a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathState {
    /// The point of the surface that the ray left, or its origin at the camera, in world units.
    pub origin: Vec3,
    /// The direction of the ray, of unit length.
    pub direction: Vec3,
    /// The factor, per channel, with which light along the ray contributes to the pixel, at least 0; 1 for a camera ray.
    pub weight: Vec3,
    /// The number of reflections and refractions so far, diffuse ones included; 0 for a camera ray.
    pub bounces: u32,
    /// The probability density per steradian with which `direction` was sampled. Infinite for a camera ray and for reflected
    /// and refracted rays, whose direction is certain. For a ray that a rough mirror reflects, the scaffold gives the density of
    /// its lobe if it has sampled a light for this lobe, too.
    pub pdf: f32,
}

message! { PathState { origin, direction, weight, bounces, pdf } }

/// An emitter of the scene, and how often it is chosen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChosenEmitter {
    /// The emitter.
    pub emitter: AreaEmitter,
    /// The probability, above 0 and at most 1, with which the scaffold chooses this emitter to be sampled. It is the same at
    /// all surfaces.
    pub probability: f32,
}

message! { ChosenEmitter { emitter, probability } }

/// A light that the scaffold has chosen to be sampled at a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightCandidate {
    /// A surface that emits light, to be sampled by `sample_light`.
    Emitter(ChosenEmitter),
    /// A direction of the environment map, sampled by the scaffold. Its distance is infinite. Its `pdf` includes the
    /// probability of the choice.
    Environment(EmitterSample),
}

message! { enum LightCandidate { Emitter(a), Environment(a) } }

/// A point of a surface that a path meets.
#[derive(Clone, Debug, PartialEq)]
pub struct PathVertex {
    /// The point and its normals, on the side that the path comes from.
    pub surface: Surface,
    /// How the surface scatters light. Its normal is that of `surface` for shading.
    pub scattering: Scattering,
    /// The radiance that the surface emits back along the path, at least 0.
    pub emission: Vec3,
    /// The emitter to which the point belongs, if it is one that is sampled.
    pub emitter: Option<ChosenEmitter>,
    /// The light that may be sampled here; `None` if the scene has none to sample.
    pub light: Option<LightCandidate>,
}

message! { PathVertex { surface, scattering, emission, emitter, light } }

/// The random numbers of a step, `0 <= u < 1` each.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepNumbers {
    /// For the sample of a light.
    pub light: Vec2,
    /// For the choice of a lobe and its direction.
    pub bsdf: Vec3,
    /// For Russian roulette.
    pub roulette: f32,
}

message! { StepNumbers { light, bsdf, roulette } }

/// A ray to a light, and the light that the path collects if no object is in the way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadowQuestion {
    /// The direction from the surface to the light, of unit length.
    pub direction: Vec3,
    /// The distance to the light in world units; infinite for an environment map.
    pub distance: f32,
    /// The light in the pixel, the weight of the path included.
    pub light: Vec3,
}

message! { ShadowQuestion { direction, distance, light } }

/// The ray along which a path continues.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NextRay {
    /// The lobe of the surface in which the ray leaves it.
    pub lobe: Lobe,
    /// The direction of the ray, of unit length.
    pub direction: Vec3,
    /// The factor, per channel, with which light along the ray contributes to the pixel.
    pub weight: Vec3,
    /// The probability density of the direction, for [`PathState::pdf`].
    pub pdf: f32,
}

message! { NextRay { lobe, direction, weight, pdf } }

/// What a path does at a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathStep {
    /// Light that the path collects at once, the weight of the path included.
    pub light: Vec3,
    /// A ray to a light, whose light is collected if no object is in the way.
    pub shadow: Option<ShadowQuestion>,
    /// The ray along which the path continues; `None` if it ends here.
    pub next: Option<NextRay>,
}

message! { PathStep { light, shadow, next } }

/// What the paths of a scene need. The default needs nothing.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PathEffects {
    /// For each material of the scene, by its index, whether diffuse rays leave its surfaces.
    pub diffuse: Vec<bool>,
    /// For each material of the scene, by its index, whether points of the surfaces that emit its light are sampled. The
    /// scaffold samples spheres, triangles and parallelograms; rays find other shapes by chance.
    pub sampled: Vec<bool>,
    /// Whether directions of the environment map are sampled.
    pub environment: bool,
}

message! { PathEffects { diffuse, sampled, environment } }

impl PathEffects {
    /// Whether any path bounces off a diffuse surface. If none does, direct light and the rays of stage 5 find all light.
    pub fn bounces(&self) -> bool {
        self.diffuse.contains(&true)
    }
}
