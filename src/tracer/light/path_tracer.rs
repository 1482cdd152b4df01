//! The light along one random path (path tracing): at each surface the path collects light and continues in one direction,
//! as the student's `step` says. It takes the place of the tree of rays where a scene asks for indirect light.

use super::indirect::IndirectLight;
use super::interaction::SurfaceInteraction;
use super::path::Path;
use super::random_choices::{distance_before_emitter, sample_rough_surface};
use super::record::Record;
use super::rough_lobe::RoughLobe;
use super::whitted::Scratch;
use crate::count::{Event, Tally};
use crate::emitter::EmitterSample;
use crate::kit::{Bounce, LightSample, Limits, RayKind, SecondaryRay, StudentFunctions};
use crate::light_path::{
    ChosenEmitter, LightCandidate, Lobe, NextRay, PathState, PathVertex, Scattering, ShadowQuestion,
    StepNumbers,
};
use crate::material::Material;
use crate::random::{Points, Purpose};
use crate::ray::Ray;
use crate::tracer::frame::Frame;
use crate::tracer::search::hit::Hit;
use glam::{Vec2, Vec3};
use std::borrow::Cow;

/// The limits of `scatter` for a path, whose length `step` limits.
const UNLIMITED: Limits = Limits { max_depth: u32::MAX, min_contribution: 0.0 };

/// The factor, a power of two, by which the density of light that is only sampled is scaled. So its weight in multiple
/// importance sampling is 1, as if the density of diffuse rays were 0. The light of its samples is scaled back by the same
/// factor. The radiance cannot be scaled in its place: that of bright emitters would be infinite.
///
/// A scaled density is infinite, and its light is lost, if the emitter covers less than 1e-29 steradians: directions in single
/// precision, 6e-8 apart, do not tell such an emitter from a point.
const DENSITY_SCALE: f32 = 4_294_967_296.0;

/// The number of bounces at which the student's `survives` begins to end paths.
const ROULETTE_BEGINS: u32 = 3;

/// The same light with a density that is [`DENSITY_SCALE`] times as large.
fn scaled_up(light: LightCandidate) -> LightCandidate {
    match light {
        LightCandidate::Environment(sample) => {
            LightCandidate::Environment(EmitterSample { pdf: DENSITY_SCALE * sample.pdf, ..sample })
        }
        LightCandidate::Emitter(chosen) => LightCandidate::Emitter(ChosenEmitter {
            probability: DENSITY_SCALE * chosen.probability,
            ..chosen
        }),
    }
}

/// The shadow rays of both lobes. They sample the same light with the same random numbers, so that one ray serves both.
fn merge_shadow_rays(
    diffuse: Option<ShadowQuestion>,
    rough: Option<ShadowQuestion>,
) -> [Option<ShadowQuestion>; 2] {
    match (diffuse, rough) {
        (Some(diffuse), Some(rough)) if diffuse.direction == rough.direction => {
            [Some(ShadowQuestion { light: diffuse.light + rough.light, ..diffuse }), None]
        }
        both => [both.0, both.1],
    }
}

/// Where a ray of a path starts.
struct Start {
    /// The point.
    origin: Vec3,
    /// The density with which the ray was sampled; infinite for a ray whose direction is certain.
    pdf: f32,
    /// Whether a surface sent the ray on in its diffuse lobe.
    is_diffuse: bool,
    /// The emitter on which the point lies.
    emitter: Option<ChosenEmitter>,
}

/// A hit of a path, as the student's `step` sees it.
struct Vertex<'m> {
    at: SurfaceInteraction,
    /// The number of the ray in the record.
    number: usize,
    material: Cow<'m, Material>,
    may_bounce: bool,
    state: PathState,
    vertex: PathVertex,
    numbers: StepNumbers,
    /// The lobe of a rough mirror that samples light.
    rough: Option<RoughLobe>,
    /// The emitter on which the hit lies.
    own: Option<ChosenEmitter>,
}

/// Which light of a hit counts.
struct CountedLight {
    /// The emission of the hit.
    emission: Vec3,
    /// The emitter on which the hit lies.
    own: Option<ChosenEmitter>,
    /// The same emitter, if `step` weighs the emission against samples of it.
    weighed: Option<ChosenEmitter>,
    /// The light that `step` samples.
    sampled: Option<LightCandidate>,
}

/// Decides which light of a hit counts. A path meets an emitter in two ways, by chance and by a sample from the surface before,
/// and both together count its light once:
///
/// | a ray that hits an emitter | the emission | because |
/// |---|---|---|
/// | is diffuse, and the emitter shows one of `[[lights]]` | does not count | the surface before has sampled this light |
/// | starts on the same emitter | counts in full | a point of an emitter does not sample it |
/// | grazes its rim, where its density is rounded to 0 | does not count | samples count it; in full it would be a bright speck |
/// | has no certain direction, and light is only sampled | does not count | samples count in full |
/// | is another one | is weighed by `step` | |
///
/// A point of an emitter does not sample this emitter, because it sees none of it, or the inside of a sphere, and whether it
/// lies inside or outside is a matter of rounding.
fn counted_light<F: StudentFunctions>(
    indirect: &IndirectLight,
    (start, direction): (&Start, Vec3),
    (hit, at, material): (&Hit, &SurfaceInteraction, &Material),
    sampled: Option<LightCandidate>,
) -> CountedLight {
    let is_seen = !(indirect.is_light[at.material] && start.is_diffuse);
    let emission = if is_seen { at.emission(material) } else { Vec3::ZERO };
    let own = if emission == Vec3::ZERO { None } else { indirect.emitter_at(hit, at.surface.point) };
    let weighed = own.filter(|own| start.emitter != Some(*own));
    let is_certain = start.pdf == f32::INFINITY;
    let is_left_to_samples = |chosen: ChosenEmitter| {
        indirect.samples_only || F::light_pdf(&chosen.emitter, start.origin, direction) == 0.0
    };
    let emission = match weighed {
        Some(chosen) if !is_certain && is_left_to_samples(chosen) => Vec3::ZERO,
        _ => emission,
    };
    let sampled = match sampled {
        Some(LightCandidate::Emitter(chosen)) if Some(chosen) == own => None,
        // Where light is only sampled, its samples have the weight 1.
        light if indirect.samples_only => light.map(scaled_up),
        light => light,
    };
    CountedLight { emission, own, weighed, sampled }
}

impl<F: StudentFunctions> Frame<'_, F> {
    /// The linear radiance that arrives along `path`, whose closest hit is `hit`: an unbiased random estimate of all light,
    /// direct and indirect, up to the largest depth. With a limit on the light of a sample it is darkened to that limit.
    ///
    /// Source: Kajiya, "The Rendering Equation", 1986.
    #[inline(never)]
    pub fn radiance_of_path<T: Tally>(
        &self,
        indirect: &IndirectLight,
        path: Path,
        hit: Option<Hit>,
        scratch: &mut Scratch<T>,
        record: &mut impl Record,
    ) -> Vec3 {
        let color = self.follow(indirect, path, hit, scratch, record);
        let (limit, largest) = (self.quality().clamp, color.max_element());
        if limit > 0.0 && largest > limit { limit / largest * color } else { color }
    }

    /// Follows `path` from hit to hit, and adds up the light that it collects.
    fn follow<T: Tally>(
        &self,
        indirect: &IndirectLight,
        mut path: Path,
        mut hit: Option<Hit>,
        scratch: &mut Scratch<T>,
        record: &mut impl Record,
    ) -> Vec3 {
        let mut color = Vec3::ZERO;
        let mut start =
            Start { origin: path.ray.origin, pdf: f32::INFINITY, is_diffuse: false, emitter: None };
        loop {
            let Some(found) = hit else {
                record.miss(&path);
                return color + path.weight * self.background_of_path(indirect, &path, start.pdf, scratch);
            };
            // What is here, and which of its light counts?
            let here = self.vertex(indirect, &path, &start, &found, scratch, record);
            // Add the light of `[[lights]]`, which no ray finds by chance, without ambient light.
            if !self.plan.effects.materials[here.at.material].lights.is_empty() {
                let Vertex { at, number, material, .. } = &here;
                color += path.weight * self.direct_light(&path, *number, at, material, scratch, record);
            }
            // Let the student's `step` collect other light and choose how the path continues.
            let step = F::step(&here.state, &here.vertex, self.limits.max_depth, &here.numbers);
            color += step.light;
            // Trace the shadow ray to the light that was sampled, which the diffuse and the rough lobe share.
            let in_lobe = self.light_in_lobe(indirect, &here);
            for mut question in merge_shadow_rays(step.shadow, in_lobe).into_iter().flatten() {
                if indirect.samples_only {
                    question.light *= DENSITY_SCALE;
                }
                color += self.unoccluded(&question, &path, &here, scratch, |ray, blocked| {
                    record.shadow(&path, here.number, ray, blocked);
                });
            }
            // Continue with the next ray.
            let Some(next) = step.next else {
                let Scattering { diffuse, secondary, .. } = &here.vertex.scattering;
                if here.may_bounce && (*diffuse != Vec3::ZERO || !secondary.is_empty()) {
                    scratch.note(Event::Absorbed);
                }
                return color;
            };
            (path, start) = self.next_path(&next, &path, &found, &here, scratch);
            hit = self.closest_hit(&path.ray, scratch);
        }
    }

    /// The surface that `path` hits, how it scatters light, and which of its light counts.
    fn vertex<T: Tally>(
        &self,
        indirect: &IndirectLight,
        path: &Path,
        start: &Start,
        hit: &Hit,
        scratch: &mut Scratch<T>,
        record: &mut impl Record,
    ) -> Vertex<'_> {
        let direction = self.unit(path.ray.direction);
        let (at, number) = self.surface_at(path, hit, scratch, record);
        let material = self.material(path, hit, &at, &mut scratch.tally);
        let state = PathState {
            origin: start.origin,
            direction,
            weight: path.weight,
            bounces: path.depth,
            pdf: start.pdf,
        };
        let may_bounce = path.depth < self.limits.max_depth;
        let scattering = self.scattering(indirect, direction, &at, &material, may_bounce);
        let rough = self.rough_lobe(indirect, &at, &material, &scattering);
        let asks = rough.is_some() || scattering.diffuse != Vec3::ZERO;
        let (light, numbers) =
            self.numbers_of_step(indirect, &scattering, asks, &path.points, &state, scratch);
        let CountedLight { emission, own, weighed, sampled } =
            counted_light::<F>(indirect, (start, direction), (hit, &at, &material), light);
        let vertex =
            PathVertex { surface: at.surface, scattering, emission, emitter: weighed, light: sampled };
        Vertex { at, number, material, may_bounce, state, vertex, numbers, rough, own }
    }

    /// How the surface scatters light that arrives in `direction`; it scatters none at the end of the longest path.
    fn scattering(
        &self,
        indirect: &IndirectLight,
        direction: Vec3,
        at: &SurfaceInteraction,
        material: &Material,
        may_bounce: bool,
    ) -> Scattering {
        let takes = &self.plan.effects.materials[at.material];
        let normal = at.surface.shading_normal;
        let secondary = match may_bounce && (takes.mirror || takes.transmission) {
            true => F::scatter(direction, normal, at.entering, material, Vec3::ONE, 0, &UNLIMITED),
            false => Vec::new(),
        };
        let is_diffuse = may_bounce && indirect.diffuse.get(at.material) == Some(&true);
        let diffuse = if is_diffuse { material.diffuse } else { Vec3::ZERO };
        Scattering { diffuse, normal, secondary }
    }

    /// The lobe of a rough mirror, if any light is sampled; `None` for other surfaces. A refracted ray finds light by chance
    /// only, because the shape that it enters is in the way of shadow rays.
    fn rough_lobe(
        &self,
        indirect: &IndirectLight,
        at: &SurfaceInteraction,
        material: &Material,
        scattering: &Scattering,
    ) -> Option<RoughLobe> {
        let is_rough = self.plan.effects.materials[at.material].glossy && material.roughness > 0.0;
        if !(is_rough && indirect.samples()) {
            return None;
        }
        let reflected = scattering.secondary.iter().find(|ray| ray.bounce == Bounce::Reflection)?;
        Some(RoughLobe::new(&at.surface, reflected.direction, reflected.weight, material.roughness))
    }

    /// The light that a rough mirror reflects from one sample, with the random numbers with which `step` samples the light; the
    /// weight is that of multiple importance sampling against the reflected ray.
    fn light_in_lobe(&self, indirect: &IndirectLight, here: &Vertex<'_>) -> Option<ShadowQuestion> {
        let lobe = here.rough.as_ref()?;
        let sample = match here.vertex.light.as_ref()? {
            LightCandidate::Environment(sample) => *sample,
            LightCandidate::Emitter(ChosenEmitter { emitter, probability }) => {
                let sample = F::sample_light(emitter, here.at.surface.point, here.numbers.light)?;
                EmitterSample { pdf: probability * sample.pdf, ..sample }
            }
        };
        let EmitterSample { direction, distance, radiance, pdf } = sample;
        let of_lobe = lobe.pdf(direction)?;
        let weight = if indirect.samples_only { 1.0 } else { F::mis_weight(pdf, of_lobe) };
        let light = here.state.weight * lobe.reflectance * radiance * (of_lobe / pdf * weight);
        (light != Vec3::ZERO).then_some(ShadowQuestion { direction, distance, light })
    }

    /// The light that may be sampled at a vertex that `asks` for it, and the random numbers of its step. Numbers that cannot
    /// matter are 0 and are not looked up.
    fn numbers_of_step<T: Tally>(
        &self,
        indirect: &IndirectLight,
        scattering: &Scattering,
        asks: bool,
        points: &Points,
        state: &PathState,
        scratch: &mut Scratch<T>,
    ) -> (Option<LightCandidate>, StepNumbers) {
        let mut numbers = StepNumbers { light: Vec2::ZERO, bsdf: Vec3::ZERO, roulette: 0.0 };
        let is_diffuse = scattering.diffuse != Vec3::ZERO;
        // Choose a light, and sample the environment map; `step` samples any other light.
        let mut light = None;
        if asks && indirect.samples() {
            let choice = match indirect.has_choice() {
                true => self.numbers(points, Purpose::EmitterChoice, 1, scratch).x,
                false => 0.0,
            };
            numbers.light = self.numbers(points, Purpose::EmitterPoint, 2, scratch);
            light = self.choose_light(indirect, choice, numbers.light, scratch);
        }
        // Look up the numbers of the direction, of the lobe if there are several, and of Russian roulette.
        let lobes = usize::from(is_diffuse) + scattering.secondary.len();
        let roulette = lobes > 0 && state.bounces + 1 >= ROULETTE_BEGINS;
        let used = u64::from(lobes > 1) + u64::from(roulette);
        if used > 0 {
            let pair = self.numbers(points, Purpose::Lobe, used, scratch);
            (numbers.bsdf.x, numbers.roulette) = (pair.x, pair.y);
        }
        if is_diffuse {
            let pair = self.numbers(points, Purpose::Direction, 2, scratch);
            (numbers.bsdf.y, numbers.bsdf.z) = (pair.x, pair.y);
        }
        (light, numbers)
    }

    /// Two random numbers for `purpose`, `0 <= u < 1` each, of which `used` are used and counted.
    fn numbers<T: Tally>(
        &self,
        points: &Points,
        purpose: Purpose,
        used: u64,
        scratch: &mut Scratch<T>,
    ) -> Vec2 {
        (0..used).for_each(|_| scratch.note(Event::RandomNumber));
        let stratum = points.stratum(purpose, 0, 1);
        if self.plan.jittered { F::jittered(&stratum) } else { stratum.u }
    }

    /// The light that the random number `choice` chooses; `u` samples the environment map.
    fn choose_light<T: Tally>(
        &self,
        indirect: &IndirectLight,
        choice: f32,
        u: Vec2,
        scratch: &mut Scratch<T>,
    ) -> Option<LightCandidate> {
        let share = indirect.share_of_environment();
        if let Some((map, table, _)) = indirect.environment.as_ref().filter(|_| choice < share) {
            let mut sample = table.sample(u)?;
            sample.radiance = self.environment_color(map, sample.direction, scratch);
            sample.pdf *= share;
            return Some(LightCandidate::Environment(sample));
        }
        let mut chosen = indirect.emitters.choose((choice - share) / (1.0 - share))?;
        chosen.probability *= 1.0 - share;
        Some(LightCandidate::Emitter(chosen))
    }

    /// The part of the background that counts for a path which leaves the scene in a direction sampled with density `pdf`: a
    /// sampled environment map has been counted in part.
    fn background_of_path<T: Tally>(
        &self,
        indirect: &IndirectLight,
        path: &Path,
        pdf: f32,
        scratch: &mut Scratch<T>,
    ) -> Vec3 {
        let direction = self.unit(path.ray.direction);
        let background = self.background(direction, scratch);
        match &indirect.environment {
            None => background,
            Some(_) if indirect.samples_only && pdf < f32::INFINITY => Vec3::ZERO,
            Some((_, table, share)) => F::emitted_contribution(background, pdf, share * table.pdf(direction)),
        }
    }

    /// The light of a shadow ray, or none if an object is in the way; `record` receives a ray that is traced.
    fn unoccluded<T: Tally>(
        &self,
        question: &ShadowQuestion,
        path: &Path,
        here: &Vertex<'_>,
        scratch: &mut Scratch<T>,
        mut record: impl FnMut(&Ray, bool),
    ) -> Vec3 {
        let at = &here.at;
        // End the ray before the surface of its own emitter.
        let ShadowQuestion { direction, distance, light: radiance } = *question;
        let distance = match &here.vertex.light {
            Some(LightCandidate::Emitter(chosen)) => {
                distance_before_emitter(&chosen.emitter.shape, direction, distance, at.surface.point)
            }
            _ => distance,
        };
        let sample = LightSample { direction, distance, radiance };
        let Some(ray) = F::shadow_ray(&at.surface, &sample) else { return Vec3::ZERO };
        if self.is_blocked(&ray, path, at, &mut scratch.tally, &mut record) { Vec3::ZERO } else { radiance }
    }

    /// The path along the ray `next`, which the student's `step` has chosen, and where this ray starts.
    fn next_path<T: Tally>(
        &self,
        next: &NextRay,
        path: &Path,
        hit: &Hit,
        here: &Vertex<'_>,
        scratch: &mut Scratch<T>,
    ) -> (Path, Start) {
        let Vertex { at, material, .. } = here;
        let takes = &self.plan.effects.materials[at.material];
        let NextRay { lobe, direction, weight, mut pdf } = *next;
        let bounce = lobe.bounce();
        let mut secondary = SecondaryRay { bounce, direction, weight };
        let (event, kind) = match lobe {
            Lobe::Diffuse => (Event::Indirect, RayKind::Indirect),
            Lobe::Reflection => (Event::Reflection, RayKind::Reflection),
            Lobe::Transmission => (Event::Transmission, RayKind::Transmission),
        };
        // Spread the ideal reflected or refracted ray of a rough surface.
        if lobe != Lobe::Diffuse && takes.glossy {
            scratch.note(Event::RandomNumber);
            scratch.note(Event::RandomNumber);
            let (surface, points) = (&at.surface, &path.points);
            secondary = sample_rough_surface::<F>(&secondary, surface, material.roughness, points, (0, 1));
        }
        scratch.note(event);
        let ray = match self.plan.offsets {
            true => Ray::new(at.surface.point, secondary.direction),
            false => F::spawn_ray(&at.surface, &secondary),
        };
        let ray = self.off_surface(at, Ray { time: path.ray.time, ..ray });
        let cone = self.cone_beyond(path, hit, at, material, bounce);
        let (points, depth) = (path.points.beyond_vertex(), path.depth + 1);
        if let Some(rough) = here.rough.as_ref().filter(|_| lobe == Lobe::Reflection) {
            pdf = rough.pdf(ray.direction).unwrap_or(pdf);
        }
        let is_diffuse = lobe == Lobe::Diffuse;
        (
            Path { ray, points, weight: secondary.weight, depth, kind, parent: Some(here.number), cone },
            Start { origin: at.surface.point, pdf, is_diffuse, emitter: here.own },
        )
    }
}
