//! Nothing to do here: the light along one ray, through the tree of rays that it makes.

use crate::camera_rays::{blurred, from_area, outline};
use crate::packets::Packets;
use crate::surfaces::{self, Hit, Place, texture_coordinates};
use crate::tracer::Tracer;
use crate::{stage4_shading, stage5_recursion, stage7_effects};
use glam::Vec3;
use raykata::count::{Counts, Event, Tally};
use raykata::kit::{Bounce, LightSample, RayKind, TracedRay, View};
use raykata::material::Material;
use raykata::random::Points;
use raykata::ray::Ray;
use std::borrow::Cow;

/// What one thread works with: its counts, and lists that it fills anew for every hit.
#[derive(Default)]
pub struct Desk<T> {
    pub tally: T,
    lights: Vec<LightSample>,
    /// For each of `lights`, whether it casts shadows.
    shadows: Vec<bool>,
    waiting: Vec<Path>,
    /// What the ray before met.
    last: Option<u32>,
    pub packets: Packets,
}

impl<T: Tally> Tally for Desk<T> {
    fn note(&mut self, event: Event) {
        self.tally.note(event);
    }
    fn counts(&self) -> Counts {
        self.tally.counts()
    }
}

impl Tracer<'_> {
    /// The light that comes back along `ray` from the camera: follows the tree of rays and adds up what each finds,
    /// times its weight. `hit` is what `ray` hits. `record` is told of each ray, and of the material that it hit.
    #[inline(always)]
    pub fn radiance<T: Tally>(
        &self,
        ray: Ray,
        points: Points,
        mut hit: Option<Hit>,
        desk: &mut Desk<T>,
        record: &mut impl FnMut(TracedRay, Option<usize>),
    ) -> Vec3 {
        let mut path =
            Path { ray, points, weight: Vec3::ONE, depth: 0, kind: RayKind::Primary, parent: None };
        let mut color = Vec3::ZERO;
        let mut n_rays = 0;
        loop {
            let this = n_rays;
            n_rays += 1;
            match hit {
                None => {
                    record(path.told(None), None);
                    color += path.weight * self.job.scene.background;
                }
                Some(hit) => {
                    desk.note(Event::Hit);
                    let at = surfaces::surface(&self.finder.world, self.looks, &path.ray, &hit);
                    record(path.told(Some(hit.t())), Some(at.material));
                    let material = self.material(&path.ray, &hit, &at, &mut desk.tally);
                    let shadows = &mut |ray: &Ray, blocked: bool| {
                        n_rays += 1;
                        let shadow = Path { ray: *ray, kind: RayKind::Shadow, parent: Some(this), ..path };
                        record(shadow.told(blocked.then_some(0.0)), None);
                    };
                    color += path.weight * self.shade(&path, &at, &material, desk, shadows);
                    self.go_on(&path, this, &at, &material, desk);
                }
            }
            match desk.waiting.pop() {
                Some(next) => {
                    path = next;
                    hit = self.closest_hit(&path.ray, desk);
                }
                None => return color,
            }
        }
    }

    #[inline(always)]
    pub fn closest_hit<T: Tally>(&self, ray: &Ray, desk: &mut Desk<T>) -> Option<Hit> {
        self.finder.closest_hit(ray, &mut desk.tally, &mut desk.last)
    }

    /// What the surface is made of, with its image.
    #[inline(always)]
    fn material<T: Tally>(&self, ray: &Ray, hit: &Hit, at: &Place, tally: &mut T) -> Cow<'_, Material> {
        let material = &self.finder.world.materials[at.material];
        let image = match material.texture {
            Some(texture) if self.plan.effects.materials[at.material].texture => {
                &self.finder.world.textures[texture]
            }
            _ => return Cow::Borrowed(material),
        };
        tally.note(Event::TextureRead);
        let uv = texture_coordinates(&self.finder.world, self.looks.tests, ray, hit, at.surface.point);
        let color = stage7_effects::texture_color(image, uv);
        let (ambient, diffuse) = (color * material.ambient, color * material.diffuse);
        Cow::Owned(Material { ambient, diffuse, ..material.clone() })
    }

    /// Adds the rays that go on from a surface to those that wait.
    #[inline(always)]
    fn go_on<T: Tally>(&self, path: &Path, this: usize, at: &Place, material: &Material, desk: &mut Desk<T>) {
        let takes = &self.plan.effects.materials[at.material];
        if !(takes.mirror || takes.transmission) || self.plan.view == View::Normals {
            return;
        }
        let dir = path.ray.dir.normalize();
        let normal = at.surface.shading_normal;
        let children = stage5_recursion::children(
            dir,
            normal,
            at.entering,
            material,
            path.weight,
            path.depth,
            &self.limits,
        );
        let parts = if takes.gloss { self.quality().gloss_samples } else { 1 };
        for child in children {
            let (event, kind) = match child.bounce {
                Bounce::Reflection => (Event::Reflection, RayKind::Reflection),
                Bounce::Transmission => (Event::Transmission, RayKind::Transmission),
            };
            for part in 0..parts {
                desk.note(event);
                let child = if takes.gloss {
                    desk.note(Event::RandomNumber);
                    desk.note(Event::RandomNumber);
                    blurred(&child, &at.surface, material.roughness, &path.points, part, parts)
                } else {
                    child
                };
                let ray = Ray { time: path.ray.time, ..stage5_recursion::leave(&at.surface, &child) };
                let points = path.points.beyond(child.bounce, part, parts);
                let (weight, depth) = (child.weight, path.depth + 1);
                desk.waiting.push(Path { ray, points, weight, depth, kind, parent: Some(this) });
            }
        }
    }

    #[inline(always)]
    fn shade<T: Tally>(
        &self,
        path: &Path,
        at: &Place,
        material: &Material,
        desk: &mut Desk<T>,
        record: &mut impl FnMut(&Ray, bool),
    ) -> Vec3 {
        let surface = &at.surface;
        if self.plan.view == View::Normals {
            return 0.5 * surface.shading_normal + 0.5;
        }
        self.light_up(path, at, desk);
        let Desk { tally, lights, shadows, .. } = desk;
        let to_viewer = -path.ray.dir.normalize();
        let ambient = self.job.scene.ambient;
        stage4_shading::shade(surface, to_viewer, material, ambient, lights, |light, shadow_ray| {
            if !shadows[light] {
                return true;
            }
            tally.note(Event::Shadow);
            let ray = Ray { time: path.ray.time, ..*shadow_ray };
            let blocked = self.finder.any_hit(&ray, tally);
            record(&ray, blocked);
            !blocked
        })
    }

    /// Puts the light that can arrive at a surface on the desk.
    #[inline(always)]
    fn light_up<T: Tally>(&self, path: &Path, at: &Place, desk: &mut Desk<T>) {
        desk.lights.clear();
        desk.shadows.clear();
        let effects = &self.plan.effects;
        for &index in &effects.materials[at.material].lights {
            let (light, takes) = (&self.finder.world.lights[index], effects.lights[index]);
            match outline(light) {
                Some(shape) if takes.area => {
                    for part in 0..takes.samples {
                        desk.note(Event::RandomNumber);
                        desk.note(Event::RandomNumber);
                        let points = &path.points;
                        let sample = from_area(light, shape, &at.surface, points, index, part, takes.samples);
                        desk.lights.push(sample);
                    }
                }
                _ if takes.samples > 0 => desk.lights.push(light.from_its_middle(at.surface.point)),
                _ => {}
            }
            desk.shadows.resize(desk.lights.len(), takes.shadows);
        }
    }
}

/// A ray that is to be followed.
#[derive(Clone, Copy)]
pub struct Path {
    ray: Ray,
    points: Points,
    weight: Vec3,
    depth: u32,
    kind: RayKind,
    parent: Option<usize>,
}

impl Path {
    fn told(&self, t: Option<f32>) -> TracedRay {
        let Path { ray, weight, depth, kind, parent, .. } = *self;
        let hit = t.map(|t| (t, String::new()));
        TracedRay { kind, parent, depth, weight, origin: ray.origin, dir: ray.dir, hit }
    }
}
