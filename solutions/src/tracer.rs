//! Nothing to do here: this makes pictures out of the functions of the stage files. What is not written yet is left
//! out, and the picture says so: without stage 4 it shows normals, without stage 3 every ray tests every primitive,
//! and without the search of stage 2 later shapes are painted over earlier ones, near or far.

use crate::fallbacks::{Search, choose_search, choose_view, follows_mirrors, written};
use crate::surfaces::{self, Hit, Place, leave, meet_triangle, sends_on};
use crate::{stage1_shapes, stage2_triangles, stage3_bvh, stage4_shading, stage5_recursion};
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, PrimitiveHit, Probe};
use raykata::count::{Counts, Event, Tally, Uncounted};
use raykata::film::Film;
use raykata::frame::{self, FrameSettings, Watch};
use raykata::kit::{Bounce, LightSample, Limits, RayKind, RenderJob, Rendering, Surface, TracedRay, View};
use raykata::material::Material;
use raykata::mesh::Mesh;
use raykata::ray::Ray;
use raykata::scene::Quality;
use raykata::world::{Geometry, Primitive, World, camera_for};
use std::time::Instant;

pub fn render(job: &RenderJob, watch: &dyn Watch) -> Option<Rendering> {
    let started = Instant::now();
    let tracer = Tracer::new(job);
    let build_seconds = started.elapsed().as_secs_f64();
    let started = Instant::now();
    let (film, counts) = if job.count {
        tracer.frame::<Counts>(job, watch)?
    } else {
        tracer.frame::<Uncounted>(job, watch)?
    };
    Some(Rendering {
        film,
        counts,
        primitives: (tracer.world.primitives.len() + tracer.world.planes.len()) as u64,
        hierarchy: tracer.bvh.as_ref().map(|bvh| (bvh.nodes.len() as u64, bvh.depth() as u64)),
        build_seconds,
        render_seconds: started.elapsed().as_secs_f64(),
        notes: tracer.world.notes,
    })
}

pub fn trace(job: &RenderJob, x: u32, y: u32) -> Vec<TracedRay> {
    let tracer = Tracer::new(job);
    let film = &job.scene.film;
    let ray = camera_for(&job.scene)
        .ray((x as f32 + 0.5) / film.width as f32, (y as f32 + 0.5) / film.height as f32);
    let mut rays = Vec::new();
    tracer.radiance(&ray, &mut Uncounted, &mut |mut ray, material| {
        if let (Some(hit), Some(material)) = (&mut ray.hit, material) {
            hit.1 = job.scene.material_names.get(material).cloned().unwrap_or_default();
        }
        rays.push(ray);
    });
    rays
}

struct Tracer<'a> {
    world: World,
    bvh: Option<Bvh>,
    search: Search,
    view: View,
    /// Whether normals are interpolated over smooth meshes.
    smooth: bool,
    /// Whether mirrors and glass send rays on.
    recursion: bool,
    quality: &'a Quality,
    ambient: Vec3,
    background: Vec3,
}

impl<'a> Tracer<'a> {
    fn new(job: &'a RenderJob) -> Self {
        let quality = &job.scene.quality;
        let average = |mesh: &Mesh| stage2_triangles::vertex_normals(mesh);
        let averages = written(|| stage2_triangles::vertex_normals(&Mesh::default()));
        let mut world = World::new(&job.scene, averages.then_some(&average as &dyn Fn(&Mesh) -> Vec<Vec3>));
        let search = choose_search(quality, &mut world.notes);
        let view = choose_view(job.view, &mut world.notes);
        let smooth = written(|| stage4_shading::shading_normal(Vec3::X, None, Vec3::X));
        let recursion = follows_mirrors(&mut world);
        let bvh = (search == Search::Hierarchy).then(|| {
            let bounds: Vec<Aabb> = world.primitives.iter().map(bounds_of).collect();
            stage3_bvh::build(&bounds, quality.split, quality.leaf_size as usize)
        });
        let (ambient, background) = (job.scene.ambient, job.scene.background);
        Tracer { world, bvh, search, view, smooth, recursion, quality, ambient, background }
    }

    fn frame<T: Tally>(&self, job: &RenderJob, watch: &dyn Watch) -> Option<(Film, Counts)> {
        let camera = camera_for(&job.scene);
        let settings = FrameSettings {
            width: job.scene.film.width,
            height: job.scene.film.height,
            samples_per_pixel: self.quality.samples_per_pixel,
            threads: job.threads,
            seed: job.seed,
        };
        frame::render::<T>(&settings, watch, |x, y, _, tally| {
            tally.note(Event::Primary);
            self.radiance(&camera.ray(x, y), tally, &mut |_, _| {})
        })
    }

    /// The light that comes back along `ray` from the camera: follows the tree of rays and adds up what each finds,
    /// times its weight. `record` is told of each ray, and of the material that it hit.
    fn radiance<T: Tally>(
        &self,
        ray: &Ray,
        tally: &mut T,
        record: &mut impl FnMut(TracedRay, Option<usize>),
    ) -> Vec3 {
        let limits =
            Limits { max_depth: self.quality.max_depth, min_contribution: self.quality.min_contribution };
        let mut color = Vec3::ZERO;
        let mut waiting = Vec::new();
        let mut next =
            Some(Path { ray: *ray, weight: Vec3::ONE, depth: 0, kind: RayKind::Primary, parent: None });
        let mut n_rays = 0;
        while let Some(path) = next {
            let this = n_rays;
            n_rays += 1;
            let hit = self.closest_hit(&path.ray, tally);
            let found = hit.map(|hit| (hit.t(), self.surface(&path.ray, &hit)));
            record(
                path.told(found.as_ref().map(|found| found.0)),
                found.as_ref().map(|found| found.1.material),
            );
            match found {
                None => color += path.weight * self.background,
                Some((_, at)) => {
                    let material = &self.world.materials[at.material];
                    let dir = path.ray.dir.normalize();
                    let shadows = &mut |ray: &Ray, blocked: bool| {
                        n_rays += 1;
                        let shadow = Path { ray: *ray, kind: RayKind::Shadow, parent: Some(this), ..path };
                        record(shadow.told(blocked.then_some(0.0)), None);
                    };
                    color += path.weight * self.shade(&at.surface, -dir, material, tally, shadows);
                    if self.recursion && self.view == View::Shaded && sends_on(material) {
                        let normal = at.surface.shading_normal;
                        let Path { weight, depth, .. } = path;
                        for child in stage5_recursion::children(
                            dir,
                            normal,
                            at.entering,
                            material,
                            weight,
                            depth,
                            &limits,
                        ) {
                            let (event, kind) = match child.bounce {
                                Bounce::Reflection => (Event::Reflection, RayKind::Reflection),
                                Bounce::Transmission => (Event::Transmission, RayKind::Transmission),
                            };
                            tally.note(event);
                            let ray = leave(&at.surface, &child);
                            let (weight, depth) = (child.weight, depth + 1);
                            waiting.push(Path { ray, weight, depth, kind, parent: Some(this) });
                        }
                    }
                }
            }
            next = waiting.pop();
        }
        color
    }

    fn shade<T: Tally>(
        &self,
        surface: &Surface,
        to_viewer: Vec3,
        material: &Material,
        tally: &mut T,
        record: &mut impl FnMut(&Ray, bool),
    ) -> Vec3 {
        if self.view == View::Normals {
            return 0.5 * surface.shading_normal + 0.5;
        }
        let lights: Vec<LightSample> =
            self.world.lights.iter().map(|light| light.sample(surface.point)).collect();
        stage4_shading::shade(surface, to_viewer, material, self.ambient, &lights, |_, shadow_ray| {
            tally.note(Event::Shadow);
            let blocked = self.any_hit(shadow_ray, tally);
            record(shadow_ray, blocked);
            !blocked
        })
    }

    fn surface(&self, ray: &Ray, hit: &Hit) -> Place {
        surfaces::surface(&self.world, self.quality.triangle_method, self.smooth, ray, hit)
    }

    fn closest_hit<T: Tally>(&self, ray: &Ray, tally: &mut T) -> Option<Hit> {
        let mut ray = *ray;
        let mut closest = None;
        for (index, (plane, _)) in self.world.planes.iter().enumerate() {
            tally.note(Event::PrimitiveTest);
            if let Some(t) = stage1_shapes::plane(&ray, plane.point, plane.normal) {
                closest = Some(Hit::Plane { t, index });
                if self.search != Search::Painter {
                    ray.t_max = t;
                }
            }
        }
        let mut probe = SceneProbe::new(self, &ray, tally);
        let hit = match (&self.bvh, self.search) {
            (Some(bvh), _) => stage3_bvh::closest_hit(bvh, &mut probe, &ray),
            (None, Search::Painter) => probe.last_hit(&ray),
            (None, _) => stage2_triangles::brute_force(self.world.primitives.len() as u32, &mut probe, &ray),
        };
        hit.map(Hit::Primitive).or(closest)
    }

    fn any_hit<T: Tally>(&self, ray: &Ray, tally: &mut T) -> bool {
        let in_plane = self.world.planes.iter().any(|(plane, _)| {
            tally.note(Event::PrimitiveTest);
            stage1_shapes::plane(ray, plane.point, plane.normal).is_some()
        });
        let mut probe = SceneProbe::new(self, ray, tally);
        in_plane
            || match &self.bvh {
                Some(bvh) => stage3_bvh::any_hit(bvh, &mut probe, ray),
                None => probe.last_hit(ray).is_some(),
            }
    }
}

/// A ray that is to be followed.
#[derive(Clone, Copy)]
struct Path {
    ray: Ray,
    weight: Vec3,
    depth: u32,
    kind: RayKind,
    parent: Option<usize>,
}

impl Path {
    fn told(&self, t: Option<f32>) -> TracedRay {
        let Path { ray, weight, depth, kind, parent } = *self;
        let hit = t.map(|t| (t, String::new()));
        TracedRay { kind, parent, depth, weight, origin: ray.origin, dir: ray.dir, hit }
    }
}

/// Answers the questions of a search about the world, and counts them.
struct SceneProbe<'a, T> {
    tracer: &'a Tracer<'a>,
    inverse_dir: Vec3,
    tally: &'a mut T,
}

impl<'a, T: Tally> SceneProbe<'a, T> {
    fn new(tracer: &'a Tracer<'a>, ray: &Ray, tally: &'a mut T) -> Self {
        SceneProbe { tracer, inverse_dir: ray.dir.recip(), tally }
    }

    /// The last primitive in the order of the scene that the ray meets.
    fn last_hit(&mut self, ray: &Ray) -> Option<PrimitiveHit> {
        let n_primitives = self.tracer.world.primitives.len() as u32;
        (0..n_primitives)
            .rev()
            .find_map(|primitive| self.hit(primitive, ray).map(|t| PrimitiveHit { t, primitive }))
    }
}

impl<T: Tally> Probe for SceneProbe<'_, T> {
    fn open(&mut self, node: u32) -> Contents {
        self.tally.note(Event::NodeVisit);
        match &self.tracer.bvh {
            Some(bvh) => bvh.nodes[node as usize].contents,
            None => Contents::Leaf { first: 0, count: 0 },
        }
    }

    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        self.tally.note(Event::BoxTest);
        let bounds = &self.tracer.bvh.as_ref()?.nodes[node as usize].bounds;
        stage3_bvh::slab(ray, self.inverse_dir, bounds).map(|(enter, _)| enter)
    }

    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.tally.note(Event::PrimitiveTest);
        match &self.tracer.world.primitives[primitive as usize].geometry {
            Geometry::Sphere(sphere) => stage1_shapes::sphere_algebraic(ray, sphere.center, sphere.radius),
            Geometry::Triangle(triangle) => {
                meet_triangle(self.tracer.quality.triangle_method, ray, triangle).map(|(t, ..)| t)
            }
        }
    }
}

fn bounds_of(primitive: &Primitive) -> Aabb {
    match &primitive.geometry {
        Geometry::Sphere(sphere) => stage3_bvh::sphere_bounds(sphere),
        Geometry::Triangle(triangle) => stage3_bvh::triangle_bounds(triangle),
    }
}
