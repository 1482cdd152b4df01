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
/// The probability with which a lobe of this reflectance is chosen at a surface: its largest
/// channel, relative to the sum of the largest channels of all lobes. So a lobe of reflectance 0 is
/// never chosen.
fn choice(scattering: &Scattering, reflectance: Vec3) -> f32 {
    let secondary: f32 = scattering.secondary.iter().map(|ray| ray.weight.max_element()).sum();
    let sum = scattering.diffuse.max_element() + secondary;
    if sum > 0.0 { reflectance.max_element() / sum } else { 0.0 }
}
// </solution>

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
    // <solution>
    // Choose the first lobe whose cumulative probability is above u.x. Rounding can leave the sum
    // of the probabilities below u.x; then the last lobe that is not black remains.
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
    // Sample a direction of this lobe by fresh numbers: u.x, which chose it, is no longer uniform.
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

/// The density with which [`sample_bsdf`] samples `direction` in the diffuse lobe: the probability
/// q of this lobe times `cos θ / π`. Why is q needed, if weights must sum to 1?
///
/// `direction` has unit length. The result is 0 below the surface, and if the diffuse reflectance
/// is 0. For a diffuse direction of `sample_bsdf` it is the sample's `pdf`, up to rounding.
pub fn bsdf_pdf(scattering: &Scattering, direction: Vec3) -> f32 {
    // <solution>
    choice(scattering, scattering.diffuse) * cosine_pdf(scattering.normal, direction)
    // <stub> todo!("multiply the density of the direction by the probability of the diffuse lobe")
    // </solution>
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

/// The part of the radiance `emission` that counts for a ray that hits an emitter by chance:
/// `emission` times `mis_weight` of `pdf` and `light_pdf`. How much counts if samples find it, too?
///
/// `pdf` is the density of the ray's direction, ∞ for camera rays and reflected or refracted rays.
/// `light_pdf` is that of a sample of the light: finite, and 0 if the emitter is not sampled. Where
/// `pdf` is ∞ or `light_pdf` is 0, all light counts.
pub fn emitted_contribution(emission: Vec3, pdf: f32, light_pdf: f32) -> Vec3 {
    // <solution>
    emission * mis_weight(pdf, light_pdf)
    // <stub> todo!("weight the emission by the two densities")
    // </solution>
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
    // <solution>
    // Collect the light of the surface itself before the path can end: it counts at the last
    // bounce, too.
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
    // <solution>
    // Find the channels in which anything emits light.
    let shown = scene.shown();
    let has = |shape: &Shown, material: usize| shape.materials.contains(&material);
    let is_shown = |material: usize| shown.iter().any(|shape| has(shape, material));
    let emission = |material: usize| is_lit(scene.materials[material].emission);
    let shown_materials = (0..scene.materials.len()).filter(|&material| is_shown(material));
    let lit = shown_materials.fold(light_from_outside(scene), |lit, material| lit | emission(material));

    // Diffuse rays leave the materials that reflect light of such a channel: a red light adds
    // nothing to a green wall.
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

// <solution>
/// The channels of a colour that are not 0.
fn is_lit(color: Vec3) -> BVec3 {
    color.cmpne(Vec3::ZERO)
}

/// The channels in which the background or a light of the scene emits light.
fn light_from_outside(scene: &Scene) -> BVec3 {
    let background = match scene.background {
        Background::Color(color) => is_lit(color),
        Background::Gradient(gradient) => is_lit(gradient.zenith + gradient.horizon + gradient.nadir),
        Background::Map(map) => BVec3::splat(map.scale != 0.0),
    };
    scene.lights.iter().fold(background, |lit, light| lit | is_lit(light.radiance()))
}
// </solution>
