//! Finds hits of rays: the closest of infinite planes and primitives, by the structure that the plan has
//! chosen.
//!
//! A `structure` is built over the boxes of primitives, and searched through a `probe`, which tests triangles and spheres by
//! `intersection` and shapes in spaces of their own by `solids`. What a structure may ask is in `primitives`; `wide` holds and
//! searches trees with eight children per node. `grid_resolution` chooses the cells of a grid, and `outlines` draws structures.

mod grid_resolution;
pub mod hit;
pub mod intersection;
pub mod kept;
pub mod motion;
pub mod outlines;
pub mod packets;
mod primitives;
mod probe;
pub mod solids;
mod structure;
mod wide;

use crate::aabb::Aabb;
use crate::count::{Event, Tally};
use crate::graph::{ChildCache, Graph};
use crate::kit::StudentFunctions;
use crate::ray::Ray;
use crate::scene::{Accelerator, Quality};
use crate::shape::Triangle;
use crate::tracer::plan::Plan;
use crate::world::{Geometry, InfinitePlane, Primitive, World};
use glam::Vec3;
use hit::{Detail, Hit, Target};
use motion::plane_at;
use probe::{GramTable, PacketProbe, ReportedHits, SceneProbe, StructuredWorld};
use solids::{bounds_of_solid, placed_bounds};
use std::marker::PhantomData;
use structure::Structure;
use wide::Wide;

/// What is kept from one ray to the next, for accelerators with a cache. A tile of the film starts with an empty cache, so
/// the number of threads changes no count.
#[derive(Debug, Default)]
pub struct Cache {
    /// The primitive that the previous ray hit.
    last: Option<u32>,
    /// For each node of the scene graph the child that the previous ray hit.
    children: ChildCache,
}

/// Finds the closest hit or any hit of rays with a world.
pub struct Intersector<F> {
    /// The world with an acceleration structure over its primitives and one over each shared mesh.
    pub scene: StructuredWorld,
    /// What the user should know about the structures, at most one sentence.
    pub notes: Vec<String>,
    accelerator: Option<Accelerator>,
    functions: PhantomData<fn() -> F>,
}

impl<F: StudentFunctions> Intersector<F> {
    /// Builds the acceleration structures of `plan` over `world` and over each of its shared meshes, on `threads` threads; 0
    /// takes one per core. Only wide trees are built in parallel.
    pub fn new(mut world: World, plan: &Plan, quality: &Quality, threads: usize) -> Self {
        let graph = world.graph.take();
        // Bound the shared meshes first, because the box of an instance follows from that of its mesh. Brute
        // force needs no boxes.
        let bounded = !matches!(plan.accelerator, None | Some(Accelerator::BruteForce));
        let bounds = |primitives: &[Primitive], mesh_bounds: &[Aabb]| -> Vec<Aabb> {
            let primitives = primitives.iter().filter(|_| bounded);
            primitives.map(|primitive| bounds_of::<F>(&world, mesh_bounds, primitive)).collect()
        };
        let of_meshes: Vec<Vec<Aabb>> =
            world.shared_meshes.iter().map(|mesh| bounds(&mesh.primitives, &[])).collect();
        let around = |boxes: &Vec<Aabb>| boxes.iter().fold(Aabb::EMPTY, |all, one| F::union(&all, one));
        let around: Vec<Aabb> = of_meshes.iter().map(around).collect();
        let of_scene = bounds(&world.primitives, &around);
        // Build one structure over the scene and one over each shared mesh.
        let mut notes = Vec::new();
        let mut over = |bounds: &[Aabb], primitives: &[Primitive], graph: Option<Graph>| {
            if plan.accelerator.is_some_and(Accelerator::is_wide) {
                let triangle = |index: u32| still_triangle(&primitives[index as usize]);
                let build = || Wide::build::<F>(bounds, triangle, plan.wide, quality);
                return Structure::Wide(on_threads(threads, build));
            }
            let hull = |index: usize| hull(&primitives[index]);
            Structure::build::<F>(bounds, graph, hull, plan.accelerator, quality, &mut notes)
        };
        let structure = over(&of_scene, &world.primitives, graph);
        let meshes = world.shared_meshes.iter().zip(&of_meshes);
        let mesh_structures = meshes.map(|(mesh, bounds)| over(bounds, &mesh.primitives, None)).collect();
        // One note is enough, because all structures are of the same kind.
        notes.truncate(1);
        let gram = |primitives: &[Primitive]| GramTable::new::<F>(primitives, plan.tests);
        let scene = StructuredWorld {
            structure,
            mesh_structures,
            gram: gram(&world.primitives),
            mesh_gram: world.shared_meshes.iter().map(|mesh| gram(&mesh.primitives)).collect(),
            tests: plan.tests,
            may_hit: plan.wide.may_hit,
            conservative: plan.conservative,
            savings: quality.savings,
            world,
        };
        Intersector { scene, notes, accelerator: plan.accelerator, functions: PhantomData }
    }

    /// The number of primitives of the scene and of all its shared meshes.
    pub fn n_primitives(&self) -> usize {
        let world = &self.scene.world;
        world.primitives.len() + world.shared_meshes.iter().map(|mesh| mesh.primitives.len()).sum::<usize>()
    }

    /// Bytes of memory that the structures of all shared meshes take.
    pub fn bytes_of_parts(&self) -> u64 {
        self.scene.mesh_structures.iter().filter_map(Structure::size).map(|size| size.bytes).sum()
    }

    /// The closest hit of `ray` within its range, or `None`. If the accelerator has a cache, `cache` is
    /// used and updated. If no search is written, the result is the last primitive that the ray hits, or else
    /// the last infinite plane.
    #[inline(always)]
    pub fn closest_hit<T: Tally>(&self, ray: &Ray, tally: &mut T, cache: &mut Cache) -> Option<Hit> {
        tally.search();
        // Test the infinite planes. Without any, do not copy the ray, which saves 3 % of a plain frame.
        let (shorter, plane) = match self.scene.world.planes.as_slice() {
            [] => (None, None),
            _ => self.closest_plane(ray, tally),
        };
        let ray = shorter.as_ref().unwrap_or(ray);
        // Search the primitives in front of the closest plane, with the cache if there is one.
        let (structure, savings) = (&self.scene.structure, self.scene.savings);
        let mut reported = ReportedHits::for_closest_hit();
        let mut probe = SceneProbe::<F, T>::new(&self.scene, ray, tally, &mut reported);
        let hit = if self.accelerator == Some(Accelerator::CachedBvh) {
            let search = |probe: &mut SceneProbe<'_, F, T>, ray: &Ray| {
                structure.closest_hit::<F, _>(probe, ray, savings)
            };
            let hit = F::cached_search(cache.last, &mut probe, ray, search);
            cache.last = hit.map_or(cache.last, |hit| Some(hit.primitive));
            hit
        } else if self.accelerator == Some(Accelerator::CachedBoundingBoxes) {
            structure.closest_hit_with_cache::<F, _>(&mut probe, ray, savings, &mut cache.children)
        } else {
            structure.closest_hit::<F, _>(&mut probe, ray, savings)
        };
        hit.map(|hit| probe.hit_of(hit, ray)).or(plane)
    }

    /// The closest hit of each of `rays`, in their order. A structure that searches several rays at once gets
    /// them in one packet.
    pub fn closest_hits<T: Tally>(&self, rays: &[Ray], tally: &mut T) -> Vec<Option<Hit>> {
        let structure = &self.scene.structure;
        let (true, Structure::Hierarchy(bvh), Some(first)) = (self.takes_packets(), structure, rays.first())
        else {
            let mut cache = Cache::default();
            return rays.iter().map(|ray| self.closest_hit(ray, tally, &mut cache)).collect();
        };
        // Shorten each ray to its closest plane.
        let shortened: Vec<(Option<Ray>, Option<Hit>)> =
            rays.iter().map(|ray| self.closest_plane(ray, tally)).collect();
        let rays: Vec<Ray> =
            rays.iter().zip(&shortened).map(|(ray, (shorter, _))| shorter.unwrap_or(*ray)).collect();
        // Search the structure with all rays at once.
        let mut reported = ReportedHits::for_closest_hit();
        let mut probe = PacketProbe(SceneProbe::<F, T>::new(&self.scene, first, tally, &mut reported));
        let found = F::packet_search(bvh, &mut probe, &rays).into_iter().zip(&rays).zip(shortened);
        found.map(|((hit, ray), (_, plane))| hit.map(|hit| probe.hit_of(hit, ray)).or(plane)).collect()
    }

    /// Whether the structure searches several rays at once, so that camera rays should come in packets.
    pub fn takes_packets(&self) -> bool {
        self.accelerator == Some(Accelerator::PacketBvh)
    }

    /// Whether `ray` hits anything for `t_min < t < t_max` (occlusion of a shadow ray).
    #[inline(always)]
    pub fn any_hit<T: Tally>(&self, ray: &Ray, tally: &mut T) -> bool {
        tally.search();
        let in_plane = self.scene.world.planes.iter().any(|plane| {
            tally.note(Event::PrimitiveTest);
            intersect_plane::<F>(plane, ray).is_some()
        });
        let mut reported = ReportedHits::for_any_hit();
        let mut probe = SceneProbe::<F, T>::new(&self.scene, ray, tally, &mut reported);
        in_plane || self.scene.structure.any_hit::<F, _>(&mut probe, ray, self.scene.savings)
    }

    /// The closest hit with an infinite plane, and a copy of the ray that ends there.
    #[inline(always)]
    fn closest_plane<T: Tally>(&self, ray: &Ray, tally: &mut T) -> (Option<Ray>, Option<Hit>) {
        let mut ray = *ray;
        let mut closest = None;
        for (index, plane) in (0..).zip(&self.scene.world.planes) {
            tally.note(Event::PrimitiveTest);
            if let Some(t) = intersect_plane::<F>(plane, &ray) {
                closest = Some(Hit { t, target: Target::Plane(index), detail: Detail::None });
                // Shorten the ray, except without a search: then later shapes cover earlier ones.
                if self.accelerator.is_some() {
                    ray.t_max = t;
                }
            }
        }
        (Some(ray), closest)
    }
}

/// The `t` of the hit of `ray` with an infinite plane within its range, by the form in which the plane is given.
#[inline(always)]
fn intersect_plane<F: StudentFunctions>(plane: &InfinitePlane, ray: &Ray) -> Option<f32> {
    if let Some(equation) = &plane.equation {
        return F::plane_by_coefficients(ray, equation.normal, equation.d);
    }
    let plane = plane_at::<F>(plane, ray.time).0;
    F::plane(ray, plane.point, plane.normal)
}

/// The corners of a triangle that does not move; `None` for any other primitive.
fn hull(primitive: &Primitive) -> Option<Vec<Vec3>> {
    let still = primitive.end.get().is_none();
    primitive.geometry.triangle().filter(|_| still).map(|triangle| vec![triangle.a, triangle.b, triangle.c])
}

/// The triangle of a primitive that can be hit from both sides and does not move; `None` for any other primitive.
fn still_triangle(primitive: &Primitive) -> Option<Triangle> {
    match primitive.geometry {
        Geometry::Triangle(triangle) if primitive.end.get().is_none() => Some(triangle),
        _ => None,
    }
}

/// Runs `build` on a pool of this number of threads. Where no thread can be started, as in a sandbox, this thread does all the
/// work.
fn on_threads<R: Send>(threads: usize, build: impl FnOnce() -> R + Send) -> R {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    let pool = if threads == 1 { pool.use_current_thread().build() } else { pool.build() };
    match pool {
        Ok(pool) => pool.install(build),
        Err(_) => build(),
    }
}

/// The box around all positions of the primitive between times 0 and 1.
fn bounds_of<F: StudentFunctions>(world: &World, mesh_bounds: &[Aabb], primitive: &Primitive) -> Aabb {
    let bounds = |geometry: &Geometry| match geometry {
        Geometry::Sphere(sphere) => F::sphere_bounds(sphere),
        Geometry::Triangle(triangle) | Geometry::OneSided(triangle) => F::triangle_bounds(triangle),
        Geometry::Solid(index) => bounds_of_solid::<F>(&world.solids[*index as usize]),
        Geometry::Instance(index) => {
            let instance = &world.instances[*index as usize];
            placed_bounds::<F>(&mesh_bounds[instance.shared_mesh as usize], &instance.placement)
        }
    };
    let start = bounds(&primitive.geometry);
    match primitive.end.get() {
        None => start,
        Some(end) => F::motion_bounds(&start, &bounds(&world.ends[end])),
    }
}
