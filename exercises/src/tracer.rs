//! Nothing to do here: this makes pictures out of the functions of the stage files. What is not written yet is left
//! out, and the picture says so: without stage 4 it shows normals, without stage 3 every ray tests every primitive,
//! and without the search of stage 2 later shapes are painted over earlier ones, near or far.

use crate::fallbacks::{Search, choose_search, choose_view, follows_mirrors, written};
use crate::{stage1_shapes, stage2_triangles, stage3_bvh, stage4_shading, stage5_recursion};
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, PrimitiveHit, Probe};
use raykata::count::{Counts, Event, Tally, Uncounted};
use raykata::film::Film;
use raykata::frame::{self, FrameSettings, Watch};
use raykata::kit::{Bounce, Child, LightSample, Limits, RenderJob, Rendering, Surface, View};
use raykata::material::Material;
use raykata::mesh::Mesh;
use raykata::ray::Ray;
use raykata::scene::{Quality, TriangleMethod};
use raykata::shape::{Plane, Triangle};
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
            self.radiance(&camera.ray(x, y), tally)
        })
    }

    /// The light that comes back along `ray` from the camera: follows the tree of rays and adds up what each finds,
    /// times its weight.
    fn radiance<T: Tally>(&self, ray: &Ray, tally: &mut T) -> Vec3 {
        let limits =
            Limits { max_depth: self.quality.max_depth, min_contribution: self.quality.min_contribution };
        let mut color = Vec3::ZERO;
        let mut waiting = Vec::new();
        let mut next = Some((*ray, Vec3::ONE, 0));
        while let Some((ray, weight, depth)) = next {
            match self.closest_hit(&ray, tally) {
                None => color += weight * self.background,
                Some(hit) => {
                    let (surface, entering, material) = self.surface(&ray, &hit);
                    let dir = ray.dir.normalize();
                    color += weight * self.shade(&surface, -dir, material, tally);
                    if self.recursion && self.view == View::Shaded && sends_on(material) {
                        let normal = surface.shading_normal;
                        for child in stage5_recursion::children(
                            dir, normal, entering, material, weight, depth, &limits,
                        ) {
                            tally.note(match child.bounce {
                                Bounce::Reflection => Event::Reflection,
                                Bounce::Transmission => Event::Transmission,
                            });
                            waiting.push((leave(&surface, &child), child.weight, depth + 1));
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
    ) -> Vec3 {
        if self.view == View::Normals {
            return 0.5 * surface.shading_normal + 0.5;
        }
        let lights: Vec<LightSample> =
            self.world.lights.iter().map(|light| light.sample(surface.point)).collect();
        stage4_shading::shade(surface, to_viewer, material, self.ambient, &lights, |_, shadow_ray| {
            tally.note(Event::Shadow);
            !self.any_hit(shadow_ray, tally)
        })
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

    /// The point that was hit, with a bound on its error and its normals; whether the ray comes from outside; and what
    /// the surface is made of.
    fn surface(&self, ray: &Ray, hit: &Hit) -> (Surface, bool, &Material) {
        let (point, error, geometric, smooth, material) = match *hit {
            Hit::Plane { t, index } => {
                let (plane, material) = &self.world.planes[index];
                let (point, error) = point_on_plane(ray, t, plane);
                (point, error, plane.normal, None, *material)
            }
            Hit::Primitive(hit) => {
                let primitive = &self.world.primitives[hit.primitive as usize];
                let (point, error, geometric, smooth) = self.on_primitive(ray, hit.t, primitive);
                (point, error, geometric, smooth, primitive.material)
            }
        };
        let geometric_normal = stage1_shapes::face_viewer(geometric, ray.dir);
        let shading_normal = if self.smooth && smooth.is_some() {
            stage4_shading::shading_normal(geometric_normal, smooth, ray.dir)
        } else {
            geometric_normal
        };
        let surface = Surface { point, error, geometric_normal, shading_normal };
        (surface, geometric.dot(ray.dir) < 0.0, &self.world.materials[material as usize])
    }

    fn on_primitive(&self, ray: &Ray, t: f32, primitive: &Primitive) -> (Vec3, Vec3, Vec3, Option<Vec3>) {
        match primitive.geometry {
            Geometry::Sphere(sphere) => {
                // Pulled back onto the sphere: five roundings of the way from the centre, one of the sum.
                let normal = stage1_shapes::sphere_normal(sphere.center, ray.at(t));
                let point = sphere.center + sphere.radius * normal;
                let error = rounding(5) * (sphere.radius * normal).abs() + rounding(1) * point.abs();
                (point, error, normal, None)
            }
            Geometry::Triangle(triangle) => {
                let unbounded = ray.with_range(f32::NEG_INFINITY, f32::INFINITY);
                let (beta, gamma) = self
                    .meet_triangle(&unbounded, &triangle)
                    .map_or((1.0 / 3.0, 1.0 / 3.0), |(_, beta, gamma)| (beta, gamma));
                let weights = Vec3::new((1.0 - beta - gamma).max(0.0), beta, gamma);
                let Triangle { a, b, c } = triangle;
                // A weighted sum of the corners lies in the triangle to seven roundings of its terms, however far
                // the ray came from.
                let terms = [weights.x * a, weights.y * b, weights.z * c];
                let point = terms[0] + terms[1] + terms[2];
                let error = rounding(7) * (terms[0].abs() + terms[1].abs() + terms[2].abs());
                let flat = (b - a).cross(c - a).normalize_or(Vec3::Z);
                let smooth = primitive.normals.map(|normals| {
                    stage2_triangles::interpolate(weights, self.world.normals[normals as usize])
                });
                (point, error, flat, smooth)
            }
        }
    }

    /// `(t, β, γ)` by the method that the scene asks for.
    fn meet_triangle(&self, ray: &Ray, triangle: &Triangle) -> Option<(f32, f32, f32)> {
        let hit = match self.quality.triangle_method {
            TriangleMethod::Watertight => stage2_triangles::triangle_choice(ray, triangle),
            TriangleMethod::Cramer => stage2_triangles::triangle_cramer(ray, triangle),
            TriangleMethod::Gram => {
                stage2_triangles::triangle_gram(ray, triangle, &stage2_triangles::gram_scalars(triangle))
            }
        };
        hit.map(|hit| (hit.t, hit.beta, hit.gamma))
    }
}

/// Whether a surface can send rays on at all: most cannot, and need not be asked.
fn sends_on(material: &Material) -> bool {
    material.mirror != Vec3::ZERO || material.transmission != Vec3::ZERO
}

/// A ray that goes on, starting as far from the surface as a shadow ray does.
fn leave(surface: &Surface, child: &Child) -> Ray {
    let side = match child.bounce {
        Bounce::Reflection => surface.geometric_normal,
        Bounce::Transmission => -surface.geometric_normal,
    };
    let from = Surface { geometric_normal: side, shading_normal: side, ..*surface };
    let ahead = LightSample { direction: side, distance: f32::INFINITY, radiance: Vec3::ONE };
    let start = stage4_shading::shadow_ray(&from, &ahead).map_or(surface.point, |ray| ray.at(ray.t_min));
    Ray::new(start, child.direction)
}

enum Hit {
    Plane { t: f32, index: usize },
    Primitive(PrimitiveHit),
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
            Geometry::Triangle(triangle) => self.tracer.meet_triangle(ray, triangle).map(|(t, ..)| t),
        }
    }
}

fn bounds_of(primitive: &Primitive) -> Aabb {
    match &primitive.geometry {
        Geometry::Sphere(sphere) => stage3_bvh::sphere_bounds(sphere),
        Geometry::Triangle(triangle) => stage3_bvh::triangle_bounds(triangle),
    }
}

/// The hit moved onto the plane: what is left is the rounding of the point and of its distance to the plane.
fn point_on_plane(ray: &Ray, t: f32, plane: &Plane) -> (Vec3, Vec3) {
    let rough = ray.at(t);
    let normal = plane.normal.normalize();
    let offset = rough - plane.point;
    let point = rough - offset.dot(normal) * normal;
    (point, rounding(8) * (point.abs() + plane.point.abs() + Vec3::splat(offset.abs().max_element())))
}

/// `γ_n`, the largest relative error that `n` roundings can add up to (Higham).
fn rounding(n: u32) -> f32 {
    let nu = n as f32 * f32::EPSILON / 2.0;
    nu / (1.0 - nu)
}
