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
// <solution>
use crate::stage11_light_transport::{
    cosine_direction, cosine_pdf, light_pdf, mis_weight, sample_light, survives,
};
use glam::{BVec3, Vec2};
use raykata::kit::Bounce;
use raykata::light_path::{ChosenEmitter, LightCandidate, Lobe, NextRay, ShadowQuestion};
use raykata::scene::{Background, Shown};
use raykata::shape::Shape;
use std::f32::consts::PI;
// </solution>

// <solution>
/// The probability with which a lobe of this reflectance is chosen at a surface: its largest channel, relative to the sum of
/// the largest channels of all lobes. So a lobe of reflectance 0 is never chosen.
fn choice(scattering: &Scattering, reflectance: Vec3) -> f32 {
    let secondary: f32 = scattering.secondary.iter().map(|ray| ray.weight.max_element()).sum();
    let sum = scattering.diffuse.max_element() + secondary;
    if sum > 0.0 { reflectance.max_element() / sum } else { 0.0 }
}
// </solution>

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
    // <solution>
    // Choose the first lobe whose cumulative probability is above u.x. Rounding can leave the sum of the probabilities
    // below u.x; then the last lobe that is not black remains.
    let mut rest = u.x;
    let mut chosen = None;
    let secondary = scattering.secondary.iter().map(|ray| (ray.weight, Some(ray)));
    for (reflectance, ray) in std::iter::once((scattering.diffuse, None)).chain(secondary) {
        let probability = choice(scattering, reflectance);
        if probability > 0.0 {
            chosen = Some((reflectance / probability, probability, ray));
            if rest < probability {
                break;
            }
            rest -= probability;
        }
    }
    // Sample a direction of this lobe.
    let (weight, probability, ray) = chosen?;
    Some(match ray {
        None => {
            let direction = cosine_direction(scattering.normal, Vec2::new(u.y, u.z));
            let pdf = probability * cosine_pdf(scattering.normal, direction);
            BsdfSample { lobe: Lobe::Diffuse, direction, weight, pdf }
        }
        Some(ray) => {
            let lobe = match ray.bounce {
                Bounce::Reflection => Lobe::Reflection,
                Bounce::Transmission => Lobe::Transmission,
            };
            BsdfSample { lobe, direction: ray.direction, weight, pdf: f32::INFINITY }
        }
    })
    // <stub> todo!("choose a lobe, sample a direction of it, and divide by the probability of the choice")
    // </solution>
}

/// The probability density, per steradian, with which [`sample_bsdf`] samples `direction` in the diffuse lobe: the
/// probability that this lobe is chosen, times `cos θ / π`.
///
/// `direction` has unit length. The result is 0 below the surface, and if the diffuse reflectance is 0. For a diffuse direction
/// that `sample_bsdf` returns it is equal to the sample's `pdf` up to rounding.
///
/// Pitfall: without the probability of the choice, the weights of multiple importance sampling do not sum to 1.
pub fn bsdf_pdf(scattering: &Scattering, direction: Vec3) -> f32 {
    // <solution>
    choice(scattering, scattering.diffuse) * cosine_pdf(scattering.normal, direction)
    // <stub> todo!("multiply the density of the direction by the probability of the diffuse lobe")
    // </solution>
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
    // <solution>
    let cos_theta = normal.dot(sample.direction);
    if cos_theta <= 0.0 {
        return Vec3::ZERO;
    }
    let weight = mis_weight(sample.pdf, bsdf_pdf);
    diffuse / PI * sample.radiance * (cos_theta / sample.pdf * weight)
    // <stub> todo!("multiply reflectance, light and cosine, divide by the density, and weight the sample")
    // </solution>
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
    // <solution>
    emission * mis_weight(pdf, light_pdf)
    // <stub> todo!("weight the emission by the two densities")
    // </solution>
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
    // <solution>
    // Collect the light of the surface itself.
    let density = |ChosenEmitter { emitter, probability }: &ChosenEmitter| {
        probability * light_pdf(emitter, path.origin, path.direction)
    };
    let light_pdf = vertex.emitter.as_ref().map_or(0.0, density);
    let light = path.weight * emitted_contribution(vertex.emission, path.pdf, light_pdf);
    if path.bounces >= max_depth {
        return PathStep { light, shadow: None, next: None };
    }
    PathStep { light, shadow: sampled_light(path, vertex, numbers), next: continued(path, vertex, numbers) }
    // <stub> todo!("collect the emission; then sample a light; then sample a direction, and play roulette")
    // </solution>
}

// <solution>
/// The shadow ray of a step, and the light that it finds.
fn sampled_light(path: &PathState, vertex: &PathVertex, numbers: &StepNumbers) -> Option<ShadowQuestion> {
    let PathVertex { surface, scattering, .. } = vertex;
    // Sample the light, unless no diffuse light would be sent on.
    if scattering.diffuse == Vec3::ZERO {
        return None;
    }
    let sample = match vertex.light.as_ref()? {
        LightCandidate::Environment(sample) => *sample,
        LightCandidate::Emitter(ChosenEmitter { emitter, probability }) => {
            let sample = sample_light(emitter, surface.point, numbers.light)?;
            EmitterSample { pdf: probability * sample.pdf, ..sample }
        }
    };
    // Ask for a shadow ray only if it can bring light.
    let EmitterSample { direction, distance, .. } = sample;
    let above = surface.geometric_normal.dot(direction) > 0.0 && surface.shading_normal.dot(direction) > 0.0;
    if !above {
        return None;
    }
    let (diffuse, normal) = (scattering.diffuse, surface.shading_normal);
    let light =
        path.weight * sample_light_contribution(diffuse, normal, &sample, bsdf_pdf(scattering, direction));
    (light != Vec3::ZERO).then_some(ShadowQuestion { direction, distance, light })
}

/// The ray along which a path continues, unless it ends.
fn continued(path: &PathState, vertex: &PathVertex, numbers: &StepNumbers) -> Option<NextRay> {
    let BsdfSample { lobe, direction, weight, pdf } = sample_bsdf(&vertex.scattering, numbers.bsdf)?;
    // Below the true surface a diffuse ray would hit this surface again.
    if lobe == Lobe::Diffuse && vertex.surface.geometric_normal.dot(direction) <= 0.0 {
        return None;
    }
    // Play Russian roulette with the weight that the path would have.
    let weight = path.weight * weight;
    let weight = weight * survives(weight, path.bounces + 1, numbers.roulette);
    (weight != Vec3::ZERO).then_some(NextRay { lobe, direction, weight, pdf })
}
// </solution>

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
    // <solution>
    // Find the channels in which anything emits light.
    let shown = scene.shown();
    let is_lit = |color: Vec3| color.cmpne(Vec3::ZERO);
    let has = |shape: &Shown, material: usize| shape.materials.contains(&material);
    let is_shown = |material: usize| shown.iter().any(|shape| has(shape, material));
    let mut lit = match scene.background {
        Background::Color(color) => is_lit(color),
        Background::Gradient(gradient) => is_lit(gradient.zenith + gradient.horizon + gradient.nadir),
        Background::Map(map) => BVec3::splat(map.scale != 0.0),
    };
    for light in &scene.lights {
        lit |= is_lit(light.radiance());
    }
    let emission = |material: usize| is_lit(scene.materials[material].emission);
    for material in (0..scene.materials.len()).filter(|&material| is_shown(material)) {
        lit |= emission(material);
    }

    // Diffuse rays leave the materials that reflect light of such a channel.
    let bounces = scene.indirect_light && scene.quality.max_depth > 0;
    let reflects = |material: usize| is_lit(scene.materials[material].diffuse);
    let diffuse: Vec<bool> = (0..scene.materials.len())
        .map(|material| bounces && is_shown(material) && (reflects(material) & lit).any())
        .collect();

    // Sample the emitters of finite shapes whose light these materials reflect.
    let reflected = (0..diffuse.len()).filter(|&material| diffuse[material]).map(reflects);
    let reflected = reflected.fold(BVec3::FALSE, |all, channels| all | channels);
    let shutter_moves = scene.camera.shutter.is_some_and(|shutter| shutter.close > shutter.open);
    let can_be_sampled = |shape: &Shown| {
        let plane = matches!(scene.nodes[shape.node].shape, Some(Shape::Plane(_) | Shape::PlaneEquation(_)));
        !(plane || shape.moves && shutter_moves)
    };
    let sampled = |material: usize| {
        let is_light = scene.visible_lights.iter().any(|light| light.material == material);
        !is_light
            && (emission(material) & reflected).any()
            && shown.iter().any(|shape| has(shape, material) && can_be_sampled(shape))
    };
    let is_map = matches!(scene.background, Background::Map(map) if map.scale != 0.0);
    PathEffects {
        sampled: (0..diffuse.len()).map(sampled).collect(),
        environment: is_map && diffuse.contains(&true),
        diffuse,
    }
    // <stub> todo!("find the channels with light; then the materials that reflect it, and the emitters they see")
    // </solution>
}
