//! The light along one ray, through the tree of its secondary rays: Whitted's algorithm with a list of
//! waiting rays instead of recursion.

use super::interaction::{SurfaceInteraction, is_sphere, texture_coordinates};
use super::path::Path;
use super::random_choices::{area_of, sample_area_light, sample_rough_surface, shortened_to_surface};
use super::record::Record;
use super::texture_filter::{Cone, Pyramids, curvature, footprint, uv_change};
use crate::count::{Counts, Event, Tally, Uncounted};
use crate::kit::{Bounce, LightSample, RayKind, StudentFunctions, Surface};
use crate::material::Material;
use crate::ray::Ray;
use crate::scene::{Background, EnvironmentMap};
use crate::shape::between_poles;
use crate::tracer::frame::Frame;
use crate::tracer::search::Cache;
use crate::tracer::search::hit::Hit;
use crate::tracer::search::packets::Packets;
use glam::{Vec2, Vec3};
use std::borrow::Cow;

/// The state of one thread: its counts, and lists that are reused for every hit.
#[derive(Default)]
pub struct Scratch<T> {
    /// The events that this thread has counted.
    pub tally: T,
    lights: Vec<LightSample>,
    /// For each of `lights`, whether it casts shadows.
    shadows: Vec<bool>,
    waiting: Vec<Path>,
    /// What accelerators with a cache keep from the previous ray.
    cache: Cache,
    /// The hits of camera rays that were traced ahead in packets.
    pub packets: Packets,
}

impl<T: Tally> Tally for Scratch<T> {
    const COUNTS: bool = T::COUNTS;

    fn note(&mut self, event: Event) {
        self.tally.note(event);
    }
    fn counts(&self) -> Counts {
        self.tally.counts()
    }
}

impl<F: StudentFunctions> Frame<'_, F> {
    /// The linear radiance that arrives along `path`, whose closest hit is `hit`, times the weight of the
    /// path: light of the surface, of the secondary rays, and the background where nothing is hit.
    ///
    /// Source: Whitted, "An improved illumination model for shaded display", 1980.
    #[inline(always)]
    pub fn radiance<T: Tally>(
        &self,
        mut path: Path,
        mut hit: Option<Hit>,
        scratch: &mut Scratch<T>,
        record: &mut impl Record,
    ) -> Vec3 {
        let mut color = Vec3::ZERO;
        loop {
            // Add the light from the end of the path, and queue its secondary rays.
            if let Some(hit) = hit {
                color += path.weight * self.light_from(&path, &hit, scratch, record);
            } else {
                record.miss(&path);
                color += path.weight * self.background(path.ray.direction, scratch);
            }
            // Continue with the ray that was queued last.
            let Some(next) = scratch.waiting.pop() else { return color };
            path = next;
            hit = self.closest_hit(&path.ray, scratch);
        }
    }

    /// The radiance of a ray along `direction` that hits nothing.
    #[inline(always)]
    pub(super) fn background<T: Tally>(&self, direction: Vec3, scratch: &mut Scratch<T>) -> Vec3 {
        match &self.job.scene.background {
            Background::Color(color) => *color,
            Background::Gradient(gradient) => gradient.color(direction),
            Background::Map(map) => self.environment_color(map, direction, scratch),
        }
    }

    /// The colour of the environment map in `direction`, by `texture_color` of stage 7. Until that is written, it is the
    /// colour of the pixel in which the direction lies.
    #[cold]
    pub(super) fn environment_color<T: Tally>(
        &self,
        map: &EnvironmentMap,
        direction: Vec3,
        scratch: &mut Scratch<T>,
    ) -> Vec3 {
        scratch.note(Event::TextureRead);
        let image = &self.intersector.scene.world.textures[map.texture];
        let uv = map.texture_coordinates(direction, image.height);
        map.scale * if self.plan.images { F::texture_color(image, uv) } else { image.pixel_at(uv) }
    }

    /// The closest hit of `ray` within its range, or `None`; counted in `scratch`.
    #[inline(always)]
    pub fn closest_hit<T: Tally>(&self, ray: &Ray, scratch: &mut Scratch<T>) -> Option<Hit> {
        self.intersector.closest_hit(ray, &mut scratch.tally, &mut scratch.cache)
    }

    /// The light that the surface at `hit` sends back along the path, its own emission included; its secondary rays
    /// are added to the waiting rays.
    #[inline(always)]
    fn light_from<T: Tally>(
        &self,
        path: &Path,
        hit: &Hit,
        scratch: &mut Scratch<T>,
        record: &mut impl Record,
    ) -> Vec3 {
        // Compute the surface interaction and its material.
        let (at, number) = self.surface_at(path, hit, scratch, record);
        let material = self.material(path, hit, &at, &mut scratch.tally);
        // Shade the point with direct light, tracing shadow rays.
        let mut color = self.direct_light(path, number, &at, &material, scratch, record);
        // Add the light that the surface emits by itself. The plan knows whether any surface does.
        if self.plan.emission {
            color += at.emission(&material);
        }
        // Queue the secondary rays.
        self.scatter(path, hit, number, &at, &material, scratch);
        color
    }

    /// The surface interaction at `hit`, and the index of the path in the record.
    #[inline(always)]
    pub(super) fn surface_at<T: Tally>(
        &self,
        path: &Path,
        hit: &Hit,
        scratch: &mut Scratch<T>,
        record: &mut impl Record,
    ) -> (SurfaceInteraction, usize) {
        scratch.note(Event::Hit);
        let at =
            SurfaceInteraction::new::<F>(&self.intersector.scene.world, self.surface_options, &path.ray, hit);
        let number = record.hit(path, hit.t, at.material);
        (at, number)
    }

    /// The light of `[[lights]]` that the surface sends back along the path; `number` is the index of the path in the record.
    #[inline(always)]
    pub(super) fn direct_light<T: Tally>(
        &self,
        path: &Path,
        number: usize,
        at: &SurfaceInteraction,
        material: &Material,
        scratch: &mut Scratch<T>,
        record: &mut impl Record,
    ) -> Vec3 {
        let lifted = at.lifted();
        let at = lifted.as_ref().unwrap_or(at);
        self.sample_lights(path, at, scratch);
        self.shade(path, at, material, scratch, |ray, blocked| record.shadow(path, number, ray, blocked))
    }

    /// The material of the surface as it is seen along the path: with `ambient` and `diffuse` multiplied by its image, and
    /// under its coat.
    #[inline(always)]
    pub(super) fn material<T: Tally>(
        &self,
        path: &Path,
        hit: &Hit,
        at: &SurfaceInteraction,
        tally: &mut T,
    ) -> Cow<'_, Material> {
        let world = &self.intersector.scene.world;
        let mut material = Cow::Borrowed(&world.materials[at.material]);
        if let Some(texture) = material.texture
            && self.plan.effects.materials[at.material].texture
        {
            // Look up the colour of the image at the hit, or around it.
            let uv =
                texture_coordinates::<F>(world, self.surface_options.tests, &path.ray, hit, at.surface.point);
            let color = match &self.pyramids {
                Some(pyramids) => self.filtered_color(pyramids, (texture, uv), path, hit, at, tally),
                None => {
                    tally.note(Event::TextureRead);
                    let image = &world.textures[texture];
                    let uv = if is_sphere(world, hit) { between_poles(uv, image.height) } else { uv };
                    F::texture_color(image, uv)
                }
            };
            let textured = material.to_mut();
            textured.ambient *= color;
            textured.diffuse *= color;
        }
        match self.plan.coats && material.coat != 1.0 && at.entering {
            true => Cow::Owned(self.coated(path.ray.direction, at, &material)),
            false => material,
        }
    }

    /// The material under its coat: what the coat reflects is added to `mirror`, and what lies below gets the rest.
    #[cold]
    fn coated(&self, direction: Vec3, at: &SurfaceInteraction, material: &Material) -> Material {
        let cosine = self.unit(direction).dot(at.surface.shading_normal).abs().min(1.0);
        let reflected = F::fresnel_exact(cosine, 1.0, material.coat);
        let below = 1.0 - reflected;
        Material {
            ambient: below * material.ambient,
            diffuse: below * material.diffuse,
            mirror: Vec3::splat(reflected) + below * material.mirror,
            ..material.clone()
        }
    }

    /// The mean colour of the image `texture` around `uv`, over the part of the surface that the cone of `path` covers.
    #[cold]
    fn filtered_color<T: Tally>(
        &self,
        pyramids: &Pyramids,
        (texture, uv): (usize, Vec2),
        path: &Path,
        hit: &Hit,
        at: &SurfaceInteraction,
        tally: &mut T,
    ) -> Vec3 {
        let world = &self.intersector.scene.world;
        let width = path.cone.width_at(hit.t * path.ray.direction.length());
        let axes = footprint(path.ray.direction, at.surface.geometric_normal, width);
        let axes = axes.map(|axis| uv_change::<F>(world, &path.ray, hit, at, axis));
        pyramids.color::<F, T>(world, (texture, is_sphere(world, hit)), uv, axes, tally)
    }

    /// The cone of a secondary ray, if images are filtered.
    #[inline(always)]
    pub(super) fn cone_beyond(
        &self,
        path: &Path,
        hit: &Hit,
        at: &SurfaceInteraction,
        material: &Material,
        bounce: Bounce,
    ) -> Cone {
        if self.pyramids.is_none() {
            return path.cone;
        }
        let turn = match (bounce, at.entering) {
            (Bounce::Reflection, _) => 2.0,
            (Bounce::Transmission, true) => (1.0 / material.index_of_refraction - 1.0).abs(),
            (Bounce::Transmission, false) => (material.index_of_refraction - 1.0).abs(),
        };
        let curvature = curvature::<F>(&self.intersector.scene.world, &path.ray, hit);
        path.cone.beyond(hit.t * path.ray.direction.length(), curvature, turn)
    }

    /// Puts a sample of each light that can reach the surface into `scratch.lights`.
    #[inline(always)]
    fn sample_lights<T: Tally>(&self, path: &Path, at: &SurfaceInteraction, scratch: &mut Scratch<T>) {
        scratch.lights.clear();
        scratch.shadows.clear();
        let effects = &self.plan.effects;
        for &index in &effects.materials[at.material].lights {
            let (light, takes) = (&self.intersector.scene.world.lights[index], effects.lights[index]);
            let first = scratch.lights.len();
            match area_of(light) {
                // Sample random points of an area light.
                Some(shape) if takes.area => {
                    for part in 0..takes.samples {
                        scratch.note(Event::RandomNumber);
                        scratch.note(Event::RandomNumber);
                        let parts = (part, takes.samples);
                        let light = (index, light, shape);
                        scratch.lights.push(sample_area_light::<F>(light, &at.surface, &path.points, parts));
                    }
                }
                // Sample the centre of any other light.
                _ if takes.samples > 0 => scratch.lights.push(light.sample_center(at.surface.point)),
                _ => {}
            }
            scratch.shadows.resize(scratch.lights.len(), takes.shadows);
            // Keep the surface that shows a visible light out of its own shadow rays.
            if let Some(shape) = area_of(light).filter(|_| self.plan.visible_lights[index]) {
                for sample in &mut scratch.lights[first..] {
                    *sample = shortened_to_surface(*sample, shape, at.surface.point);
                }
            }
        }
    }

    /// Direct light by the student's `shade`, which asks for a shadow ray per light; `record` receives those
    /// that are traced.
    #[inline(always)]
    fn shade<T: Tally>(
        &self,
        path: &Path,
        at: &SurfaceInteraction,
        material: &Material,
        scratch: &mut Scratch<T>,
        mut record: impl FnMut(&Ray, bool),
    ) -> Vec3 {
        let Scratch { tally, lights, shadows, .. } = scratch;
        let to_viewer = -self.unit(path.ray.direction);
        let ambient = self.plan.ambient;
        F::shade(&at.surface, to_viewer, material, ambient, lights, |light, shadow_ray| {
            !shadows[light] || !self.is_blocked(shadow_ray, path, at, tally, &mut record)
        })
    }

    /// Whether an object blocks the shadow ray `ray` that leaves the surface `at`; `record` receives the ray that is traced.
    #[inline(always)]
    pub(super) fn is_blocked<T: Tally>(
        &self,
        ray: &Ray,
        path: &Path,
        at: &SurfaceInteraction,
        tally: &mut T,
        record: &mut impl FnMut(&Ray, bool),
    ) -> bool {
        tally.note(Event::Shadow);
        let own = Ray { time: path.ray.time, ..*ray };
        let ray = self.off_surface(at, own);
        let blocked = self.intersector.any_hit(&ray, tally);
        record(&ray, blocked);
        // Compare a fixed offset with the error bound, without counting the work of this comparison.
        if T::COUNTS && self.quality().ray_offset > 0.0 {
            let bound = self.at_the_error_bound(at, own);
            match (blocked, self.intersector.any_hit(&bound, &mut Uncounted)) {
                (true, false) => tally.note(Event::ShadowAcne),
                (false, true) => tally.note(Event::LightLeak),
                _ => {}
            }
        }
        blocked
    }

    /// Adds the secondary rays of a surface to the waiting rays; `number` is the index of the path in the
    /// record.
    #[inline(always)]
    fn scatter<T: Tally>(
        &self,
        path: &Path,
        hit: &Hit,
        number: usize,
        at: &SurfaceInteraction,
        material: &Material,
        scratch: &mut Scratch<T>,
    ) {
        let takes = &self.plan.effects.materials[at.material];
        if !(takes.mirror || takes.transmission) {
            return;
        }
        // Let the student's `scatter` choose the ideal secondary rays and their weights.
        let direction = self.unit(path.ray.direction);
        let normal = at.surface.shading_normal;
        let (weight, depth) = (path.weight, path.depth);
        let children = F::scatter(direction, normal, at.entering, material, weight, depth, &self.limits);
        let parts = if takes.glossy { self.quality().glossy_samples } else { 1 };
        for child in children {
            let (event, kind) = match child.bounce {
                Bounce::Reflection => (Event::Reflection, RayKind::Reflection),
                Bounce::Transmission => (Event::Transmission, RayKind::Transmission),
            };
            let cone = self.cone_beyond(path, hit, at, material, child.bounce);
            // Spread each ideal ray over the glossy lobe, and queue the rays.
            for part in 0..parts {
                scratch.note(event);
                let child = if takes.glossy {
                    scratch.note(Event::RandomNumber);
                    scratch.note(Event::RandomNumber);
                    let (surface, points) = (&at.surface, &path.points);
                    sample_rough_surface::<F>(&child, surface, material.roughness, points, (part, parts))
                } else {
                    child
                };
                let ray = Ray { time: path.ray.time, ..F::spawn_ray(&at.surface, &child) };
                let ray = self.off_surface(at, ray);
                let points = path.points.beyond(child.bounce, part, parts);
                let (weight, depth) = (child.weight, path.depth + 1);
                scratch.waiting.push(Path { ray, points, weight, depth, kind, parent: Some(number), cone });
            }
        }
    }

    /// The unit vector along `direction`, by `safe_normalize` of stage 10 if it is written.
    #[inline(always)]
    pub(super) fn unit(&self, direction: Vec3) -> Vec3 {
        match self.plan.safe_units {
            true => F::safe_normalize(direction).unwrap_or(direction),
            false => direction.normalize(),
        }
    }

    /// `ray`, which leaves the surface, with the origin at the fixed `ray_offset` of the scene along the normal, on the side
    /// of the ray; if that is 0, at the error bound.
    #[inline(always)]
    pub(super) fn off_surface(&self, at: &SurfaceInteraction, ray: Ray) -> Ray {
        let (offset, normal) = (self.quality().ray_offset, at.surface.geometric_normal);
        if offset > 0.0 {
            let offset = offset.copysign(normal.dot(ray.direction));
            return Ray { origin: at.surface.point + offset * normal, ..ray };
        }
        self.at_the_error_bound(at, ray)
    }

    /// `ray` with the origin that `offset_origin` of stage 10 gives if it is written; otherwise with its own.
    #[inline(always)]
    fn at_the_error_bound(&self, at: &SurfaceInteraction, ray: Ray) -> Ray {
        let Surface { point, error, geometric_normal, .. } = at.surface;
        match self.plan.offsets {
            true => Ray { origin: F::offset_origin(point, error, geometric_normal, ray.direction), ..ray },
            false => ray,
        }
    }

    /// The shading normal at `hit` as the colour `0.5 n + 0.5`, in world space; the background if nothing is
    /// hit.
    pub fn normal_as_color<T: Tally>(
        &self,
        path: &Path,
        hit: Option<Hit>,
        scratch: &mut Scratch<T>,
        record: &mut impl Record,
    ) -> Vec3 {
        let Some(hit) = hit else {
            record.miss(path);
            return self.background(path.ray.direction, scratch);
        };
        let (at, _) = self.surface_at(path, &hit, scratch, record);
        0.5 * at.surface.shading_normal + 0.5
    }
}
