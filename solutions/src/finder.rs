//! Nothing to do here: what a ray meets, by the search that the plan has chosen.

use crate::camera_rays::{geometry_at, plane_at};
use crate::plan::{Plan, Search};
use crate::surfaces::{Hit, meet_triangle};
use crate::{stage1_shapes, stage2_triangles, stage3_bvh, stage6_distribution};
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, Node, PrimitiveHit, Probe};
use raykata::count::{Event, Tally};
use raykata::ray::Ray;
use raykata::scene::{Quality, TriangleMethod};
use raykata::world::{Geometry, Primitive, World};

/// A world, and the structure by which rays find what is in it.
pub struct Finder {
    pub world: World,
    pub bvh: Option<Bvh>,
    search: Search,
    method: TriangleMethod,
}

impl Finder {
    pub fn new(world: World, plan: &Plan, quality: &Quality) -> Finder {
        let bvh = (plan.search == Search::Hierarchy).then(|| {
            let bounds: Vec<Aabb> =
                world.primitives.iter().map(|primitive| bounds_of(&world, primitive)).collect();
            stage3_bvh::build(&bounds, quality.split, quality.leaf_size as usize)
        });
        Finder { world, bvh, search: plan.search, method: quality.triangle_method }
    }

    #[inline(always)]
    pub fn closest_hit<T: Tally>(&self, ray: &Ray, tally: &mut T) -> Option<Hit> {
        // Most scenes have no endless plane, and then the ray need not be copied: 3 % of a plain frame.
        let (shorter, plane) = match self.world.planes.as_slice() {
            [] => (None, None),
            _ => self.closest_plane(ray, tally),
        };
        let ray = shorter.as_ref().unwrap_or(ray);
        let mut probe = SceneProbe::new(self, ray, tally);
        let hit = match (&self.bvh, self.search) {
            (Some(bvh), _) => stage3_bvh::closest_hit(bvh, &mut probe, ray),
            (None, Search::Painter) => probe.last_hit(ray),
            (None, _) => stage2_triangles::brute_force(self.world.primitives.len() as u32, &mut probe, ray),
        };
        hit.map(Hit::Primitive).or(plane)
    }

    /// The closest of the endless planes, and the ray that ends there.
    fn closest_plane<T: Tally>(&self, ray: &Ray, tally: &mut T) -> (Option<Ray>, Option<Hit>) {
        let mut ray = *ray;
        let mut closest = None;
        for (index, plane) in self.world.planes.iter().enumerate() {
            tally.note(Event::PrimitiveTest);
            let plane = plane_at(plane, ray.time).0;
            if let Some(t) = stage1_shapes::plane(&ray, plane.point, plane.normal) {
                closest = Some(Hit::Plane { t, index });
                if self.search != Search::Painter {
                    ray.t_max = t;
                }
            }
        }
        (Some(ray), closest)
    }

    #[inline(always)]
    pub fn any_hit<T: Tally>(&self, ray: &Ray, tally: &mut T) -> bool {
        let in_plane = self.world.planes.iter().any(|plane| {
            tally.note(Event::PrimitiveTest);
            let plane = plane_at(plane, ray.time).0;
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

/// Answers the questions of a search about the world, and counts them.
///
/// It holds what the inner loop reads, and is inlined there: asked through the finder, a frame took a tenth longer.
struct SceneProbe<'a, T> {
    nodes: &'a [Node],
    world: &'a World,
    method: TriangleMethod,
    inverse_dir: Vec3,
    tally: &'a mut T,
}

impl<'a, T: Tally> SceneProbe<'a, T> {
    #[inline]
    fn new(finder: &'a Finder, ray: &Ray, tally: &'a mut T) -> Self {
        SceneProbe {
            nodes: finder.bvh.as_ref().map_or(&[], |bvh| &bvh.nodes),
            world: &finder.world,
            method: finder.method,
            inverse_dir: ray.dir.recip(),
            tally,
        }
    }

    #[inline(always)]
    fn meet(&self, ray: &Ray, geometry: &Geometry) -> Option<f32> {
        match geometry {
            Geometry::Sphere(sphere) => stage1_shapes::sphere_algebraic(ray, sphere.center, sphere.radius),
            Geometry::Triangle(triangle) => meet_triangle(self.method, ray, triangle).map(|(t, ..)| t),
        }
    }

    /// The last primitive in the order of the scene that the ray meets.
    fn last_hit(&mut self, ray: &Ray) -> Option<PrimitiveHit> {
        let n_primitives = self.world.primitives.len() as u32;
        (0..n_primitives)
            .rev()
            .find_map(|primitive| self.hit(primitive, ray).map(|t| PrimitiveHit { t, primitive }))
    }
}

impl<T: Tally> Probe for SceneProbe<'_, T> {
    #[inline]
    fn open(&mut self, node: u32) -> Contents {
        self.tally.note(Event::NodeVisit);
        self.nodes[node as usize].contents
    }

    #[inline]
    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        self.tally.note(Event::BoxTest);
        let bounds = &self.nodes[node as usize].bounds;
        stage3_bvh::slab(ray, self.inverse_dir, bounds).map(|(enter, _)| enter)
    }

    #[inline(always)]
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.tally.note(Event::PrimitiveTest);
        let primitive = &self.world.primitives[primitive as usize];
        match primitive.end.get() {
            None => self.meet(ray, &primitive.geometry),
            Some(_) => self.meet(ray, &geometry_at(self.world, primitive, ray.time)),
        }
    }
}

/// The box around all places where the primitive is.
fn bounds_of(world: &World, primitive: &Primitive) -> Aabb {
    let bounds = |geometry: &Geometry| match geometry {
        Geometry::Sphere(sphere) => stage3_bvh::sphere_bounds(sphere),
        Geometry::Triangle(triangle) => stage3_bvh::triangle_bounds(triangle),
    };
    let start = bounds(&primitive.geometry);
    match primitive.end.get() {
        None => start,
        Some(end) => stage6_distribution::sweep(&start, &bounds(&world.ends[end])),
    }
}
