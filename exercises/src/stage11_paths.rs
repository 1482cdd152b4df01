//! Stage 11 · paths: the steps of a path tracer, and which paths a scene needs.
//!
//! A path starts at the camera and continues at each surface in a random direction. At each surface it also samples a light
//! (next event estimation). Light of an emitter is found in both ways, by a sample of the emitter and by a ray that happens to
//! hit it, and multiple importance sampling weights them, so that all light counts once. The scaffold traces the rays
//! and calls [`step`] at each surface. The parts of a step are in [`stage11_light_transport`](crate::stage11_light_transport).
//!
//! Like the rest of stage 11, this goes beyond the slides. Sources: Kajiya, "The Rendering Equation" (1986), Veach, "Robust
//! Monte Carlo Methods for Light Transport Simulation" (1997), and "Physically Based Rendering" (pbr-book.org).
//!
//! Random numbers are arguments in `0.0..1.0`. A density (pdf) is per steradian; it is infinite for a direction that is
//! certain. A weight is a factor per channel.

use glam::Vec3;
use raykata::emitter::EmitterSample;
use raykata::light_path::{
    BsdfSample, PathEffects, PathState, PathStep, PathVertex, Scattering, StepNumbers,
};
use raykata::scene::Scene;

/// A random direction in which a path continues, by the choice of one lobe of the surface.
///
/// The lobes are the diffuse one with the reflectance `scattering.diffuse`, and the rays of `scattering.secondary` with the
/// reflectance `weight`. A diffuse direction has the density `cos θ / π`, as that of
/// `cosine_direction` has; a secondary ray keeps its direction.
///
/// The lobe is chosen at random. A lobe whose reflectance is 0 in all channels is never chosen; `None` if there is no other
/// lobe. A lobe whose largest channel is the fraction s of the sum of the largest channels of all lobes is chosen with a
/// probability of at least `s / 4`, for example s. The probabilities do not depend on `u`.
///
/// The weight of the sample is the reflectance of the lobe, divided by the probability of its choice. So the mean of the
/// weights over all samples is the sum of all reflectances. `pdf` is the density of the direction times the probability of
/// the choice, and infinite for a reflected or refracted ray.
///
/// Pitfall: if the number that chose the lobe is used again for the direction, the directions of the lobe are not
/// distributed as they must be.
///
/// "Physically Based Rendering", "Layered Materials" and "BSDF Representation".
pub fn sample_bsdf(scattering: &Scattering, u: Vec3) -> Option<BsdfSample> {
    todo!("choose a lobe, sample a direction of it, and divide by the probability of the choice")
}

/// The probability density, per steradian, with which [`sample_bsdf`] samples `direction` in the diffuse lobe: the
/// probability that this lobe is chosen, times `cos θ / π`.
///
/// `direction` has unit length. The result is 0 below the surface, and if the diffuse reflectance is 0. For a diffuse direction
/// that `sample_bsdf` returns it is equal to the sample's `pdf` up to rounding.
///
/// Pitfall: without the probability of the choice, the weights of multiple importance sampling do not sum to 1.
pub fn bsdf_pdf(scattering: &Scattering, direction: Vec3) -> f32 {
    todo!("multiply the density of the direction by the probability of the diffuse lobe")
}

/// The radiance that a diffuse surface sends on from one sample of a light, if no object is in the way:
/// `kd / π · L · cos θ / pdf · w`, channel by channel.
///
/// `diffuse` is kd, θ is the angle between `normal` and the direction of the sample, and L and pdf are the sample's radiance and
/// density. w is `mis_weight` of two densities: own is `sample.pdf`, and other
/// is `bsdf_pdf`, with which a ray of the surface has the same direction. A light that rays cannot hit has `bsdf_pdf`
/// 0, and w is 1. The result is 0 if the sample is not above the surface. `sample.pdf` is above 0 and finite.
///
/// Pitfall: the light that arrives is `L cos θ`, and a diffuse surface sends the fraction `kd / π` of it on per steradian. The
/// same cosine is in the density of a diffuse ray, where it cancels; here it does not.
///
/// Veach and Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering" (1995).
pub fn sample_light_contribution(diffuse: Vec3, normal: Vec3, sample: &EmitterSample, bsdf_pdf: f32) -> Vec3 {
    todo!("multiply reflectance, light and cosine, divide by the density, and weight the sample")
}

/// The part of the radiance `emission` that counts for a ray that has happened to hit the emitter:
/// `mis_weight` of the densities `pdf` and `light_pdf`, times `emission`.
///
/// `pdf` is the density with which the direction of the ray was sampled. It is infinite for rays of the camera and for
/// reflected and refracted rays, whose light counts in full, because no sample of a light can find it. `light_pdf` is the
/// density with which a sample of the light has this direction. It is finite, and 0 if the emitter is not sampled; then
/// the light counts in full as well.
///
/// Pitfall: light that is counted in full here and also by [`sample_light_contribution`] makes the picture too bright. Light that is
/// never counted here leaves mirrors without lights.
pub fn emitted_contribution(emission: Vec3, pdf: f32, light_pdf: f32) -> Vec3 {
    todo!("weight the emission by the two densities")
}

/// What a path does at the surface `vertex`: the light that it collects, the shadow ray that it needs, and the ray along which it
/// continues.
///
/// - `light`: [`emitted_contribution`] of `vertex.emission`, times the weight of the path. The density of the ray is
///   `path.pdf`. That of the light is the probability of `vertex.emitter` times its
///   `light_pdf` from `path.origin` along `path.direction`; without such an
///   emitter it is 0.
/// - If the path has `max_depth` bounces, it ends here: there is neither `shadow` nor `next`.
/// - `shadow`: a sample of `vertex.light`, by `sample_light` from the point of the
///   surface with `numbers.light`, or as it is for an environment map. The density of a sample of an emitter is multiplied
///   by the probability of the emitter. `shadow.light` is [`sample_light_contribution`] times the weight of the path, with
///   [`bsdf_pdf`] of the surface for the sample's direction. There is no shadow ray if this light is 0 in all channels,
///   or if the direction is not above the surface by both normals of `vertex.surface`.
/// - `next`: a sample by [`sample_bsdf`] with `numbers.bsdf`. Its weight is multiplied by the weight of the path, and by the
///   factor of `survives` for this product, `path.bounces + 1` surfaces and
///   `numbers.roulette`. The path ends if the weight is 0 in all channels, or if a diffuse direction is not above
///   `vertex.surface.geometric_normal`.
///
/// Pitfall: the light of this surface counts before the path can end. Otherwise the light of the last bounce is lost.
///
/// "Physically Based Rendering", "A Better Path Tracer".
pub fn step(path: &PathState, vertex: &PathVertex, max_depth: u32, numbers: &StepNumbers) -> PathStep {
    todo!("collect the emission; then sample a light; then sample a direction, and play roulette")
}

/// Computes what the paths of the scene need. [`Scene::shown`] lists the shapes that a root of the scene reaches, with their
/// materials and whether they move.
///
/// Light comes from the [`Light::radiance`](raykata::material::Light::radiance) of each light, from the emission of each shown
/// material, and from the background: its colour, the three colours of a gradient, or an environment map, which counts as
/// white times its `scale`.
///
/// - `diffuse`: for each material, whether a shown shape has it, and in some channel both its `diffuse` and some light are
///   not 0. Images are not looked at. All are `false` without `indirect_light` or if `quality.max_depth` is 0.
/// - `sampled`: for each material, whether points of its surfaces are sampled. Its emission and the `diffuse` of some
///   material with diffuse rays are not 0 in the same channel, and some shown shape that has it is neither an infinite plane nor
///   moves while the shutter is open. The material of a visible light is never sampled, because the light is.
/// - `environment`: whether the background is an environment map with a `scale` other than 0, and some material has diffuse
///   rays.
///
/// Pitfall: a red light adds nothing to a green wall, although neither is black. Compare channel by channel. A shape that could
/// move stands still without a shutter, or with one that closes when it opens.
pub fn paths_called_for(scene: &Scene) -> PathEffects {
    todo!("find the channels with light; then the materials that reflect it, and the emitters they see")
}
