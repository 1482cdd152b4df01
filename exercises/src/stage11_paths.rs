//! Stage 11 · paths: the steps of a path tracer, and which paths a scene needs.
//!
//! A path starts at the camera and continues at each surface in a random direction. At each surface
//! it also samples a light (next event estimation). Light of an emitter is found in both ways, by a
//! sample of the emitter and by a ray that happens to hit it, and multiple importance sampling
//! weights them, so that all light counts once. The scaffold traces the rays and calls [`step`] at
//! each surface. The parts of a step are in
//! [`stage11_light_transport`](crate::stage11_light_transport).
//!
//! Like the rest of stage 11, this goes beyond the slides. Sources: Kajiya, "The Rendering
//! Equation" (1986), Veach, "Robust Monte Carlo Methods for Light Transport Simulation" (1997), and
//! "Physically Based Rendering" (pbr-book.org).
//!
//! Random numbers are arguments in `0.0..1.0`. A density (pdf) is per steradian; it is infinite for
//! a direction that is certain. A weight is a factor per channel.

use glam::Vec3;
use raykata::emitter::EmitterSample;
use raykata::light_path::{
    BsdfSample, PathEffects, PathState, PathStep, PathVertex, Scattering, StepNumbers,
};
use raykata::scene::Scene;

/// A random direction in which a path continues. A path does not branch: it chooses one lobe with
/// probability q, and divides by q. Which values can `u.x` still have after it chose the lobe?
///
/// The diffuse lobe has the reflectance `scattering.diffuse` and the density `cos θ / π`; a ray of
/// `scattering.secondary` has the reflectance `weight` and its own direction.
///
/// Exactly:
///
/// 1. A lobe with reflectance 0 in all channels is never chosen; `None` if there is no other.
/// 2. q is at least `s / 4`, for example s: the largest channel of the lobe divided by the sum of
///    those of all lobes. It does not depend on `u`.
/// 3. `weight` is reflectance / q, so its mean is the sum of all reflectances.
/// 4. `pdf` is q times the density of the direction, and ∞ for a secondary ray.
///
/// Source: "Physically Based Rendering", "Layered Materials" and "BSDF Representation".
pub fn sample_bsdf(scattering: &Scattering, u: Vec3) -> Option<BsdfSample> {
    todo!("choose a lobe, sample a direction of it, and divide by the probability of the choice")
}

/// The density with which [`sample_bsdf`] samples `direction` in the diffuse lobe: the probability
/// q of this lobe times `cos θ / π`. Why is q needed, if weights must sum to 1?
///
/// `direction` has unit length. The result is 0 below the surface, and if the diffuse reflectance
/// is 0. For a diffuse direction of `sample_bsdf` it is the sample's `pdf`, up to rounding.
pub fn bsdf_pdf(scattering: &Scattering, direction: Vec3) -> f32 {
    todo!("multiply the density of the direction by the probability of the diffuse lobe")
}

/// The radiance that a diffuse surface sends on from one sample of a light, if nothing is in the
/// way: `kd / π · L · cos θ / pdf · w`. Does the cosine cancel here?
///
/// `diffuse` is kd, θ the angle between `normal` and the sample's direction, and w the `mis_weight`
/// of `sample.pdf` (above 0 and finite) and `bsdf_pdf` (0 if rays cannot hit the light). The result
/// is 0 if the sample is not above the surface.
///
/// Source: Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering"
/// (1995).
pub fn sample_light_contribution(diffuse: Vec3, normal: Vec3, sample: &EmitterSample, bsdf_pdf: f32) -> Vec3 {
    todo!("multiply reflectance, light and cosine, divide by the density, and weight the sample")
}

/// The part of the radiance `emission` that counts for a ray that hits an emitter by chance:
/// `emission` times `mis_weight` of `pdf` and `light_pdf`. How much counts if samples find it, too?
///
/// `pdf` is the density of the ray's direction, ∞ for camera rays and reflected or refracted rays.
/// `light_pdf` is that of a sample of the light: finite, and 0 if the emitter is not sampled. Where
/// `pdf` is ∞ or `light_pdf` is 0, all light counts.
pub fn emitted_contribution(emission: Vec3, pdf: f32, light_pdf: f32) -> Vec3 {
    todo!("weight the emission by the two densities")
}

/// At `vertex` a path collects light, asks a light by a shadow ray, and continues. Which of these
/// remain at its last bounce?
///
/// Exactly:
///
/// 1. `light` is the weight of the path times [`emitted_contribution`] of `vertex.emission`, with
///    `path.pdf` and the probability of `vertex.emitter` times its `light_pdf` from `path.origin`
///    along `path.direction`; 0 without an emitter.
/// 2. A path with `max_depth` bounces has neither `shadow` nor `next`.
/// 3. `shadow` samples `vertex.light`: by `sample_light` from `vertex.surface` with
///    `numbers.light`, its density times the emitter's probability; or an environment map's sample.
/// 4. `shadow.light` is the path's weight times [`sample_light_contribution`], with the shading
///    normal, and with [`bsdf_pdf`] of its direction.
/// 5. No shadow ray if this light is 0, or its direction not above both normals of the surface.
/// 6. `next` is a sample by [`sample_bsdf`] with `numbers.bsdf`. Its weight is multiplied by the
///    path's, and by `survives` of the product, `path.bounces + 1` and `numbers.roulette`.
/// 7. No `next` if this weight is 0, or a diffuse direction is not above `geometric_normal`.
///
/// Source: "Physically Based Rendering", "A Better Path Tracer".
pub fn step(path: &PathState, vertex: &PathVertex, max_depth: u32, numbers: &StepNumbers) -> PathStep {
    todo!("collect the emission; then sample a light; then sample a direction, and play roulette")
}

/// Which paths a scene needs: none where a surface reflects no light. How much red light does a
/// green wall reflect? What moves if the shutter closes when it opens?
///
/// [`Scene::shown`] lists the shapes that a root reaches. Images are not looked at.
///
/// Exactly:
///
/// 1. Light is the [`Light::radiance`](raykata::material::Light::radiance) of lights, the emission
///    of shown materials, and the background: its colour, a gradient's three colours, or a map as
///    white times `scale`.
/// 2. `diffuse`, per material: a shown shape has it, and its `diffuse` and some light are not 0 in
///    the same channel.
/// 3. All are `false` without `indirect_light`, or if `quality.max_depth` is 0.
/// 4. `sampled`, per material: its emission and the `diffuse` of a material with diffuse rays are
///    not 0 in the same channel, and a shown shape with it is no infinite plane and stands still
///    while the shutter is open.
/// 5. The material of a visible light is never sampled.
/// 6. `environment`: the background is a map, its `scale` is not 0, and some material has diffuse
///    rays.
pub fn paths_called_for(scene: &Scene) -> PathEffects {
    todo!("find the channels with light; then the materials that reflect it, and the emitters they see")
}
