//! Nothing to do here: what a ray meets, by the search that the plan has chosen.

use crate::camera_rays::plane_at;
use crate::placed::{bounds_of_shape, placed_bounds};
use crate::plan::Plan;
use crate::probe::{GraphProbe, Inside, PacketProbe, SceneProbe};
use crate::search::Search;
use crate::shape_tests::ShapeTests;
use crate::stage8_scene_graph::closest_hit_in_graph;
use crate::stage9_coherence::{closest_hit_cached, closest_hit_packet};
use crate::structure::Structure;
use crate::surfaces::Hit;
use crate::{
    stage1_shapes, stage2_triangles, stage3_bvh, stage6_distribution, stage9_bsp, stage9_grid,
    stage9_kd_tree, stage9_octree,
};
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::count::{Event, Tally};
use raykata::graph::{Graph, Savings};
use raykata::ray::Ray;
use raykata::scene::Quality;
use raykata::world::{Geometry, Primitive, World};

/// A world, and the structures by which rays find what is in it.
pub struct Finder {
    pub world: World,
    /// Over the primitives of the world.
    pub structure: Structure,
    /// One for each part, over its triangles.
    pub parts: Vec<Structure>,
    search: Search,
    savings: Savings,
    pub tests: ShapeTests,
}

impl Finder {
    pub fn new(mut world: World, plan: &Plan, quality: &Quality) -> Finder {
        let graph = world.graph.take();
        // Parts first: an instance is as large as its part. Without a structure nobody asks how large anything is.
        let bounded = !matches!(plan.search, Search::BruteForce | Search::Painter);
        let bounds = |primitives: &[Primitive], parts: &[Aabb]| -> Vec<Aabb> {
            let primitives = primitives.iter().filter(|_| bounded);
            primitives.map(|primitive| bounds_of(&world, parts, primitive)).collect()
        };
        let of_parts: Vec<Vec<Aabb>> = world.parts.iter().map(|part| bounds(&part.primitives, &[])).collect();
        let around =
            |boxes: &Vec<Aabb>| boxes.iter().fold(Aabb::EMPTY, |all, one| stage3_bvh::union(&all, one));
        let around: Vec<Aabb> = of_parts.iter().map(around).collect();
        let of_scene = bounds(&world.primitives, &around);
        let over = |bounds: &[Aabb], primitives: &[Primitive], graph: Option<Graph>| {
            Structure::new(bounds, graph, |index| hull(&primitives[index]), plan.search, quality)
        };
        let structure = over(&of_scene, &world.primitives, graph);
        let parts = world.parts.iter().zip(&of_parts);
        let parts = parts.map(|(part, bounds)| over(bounds, &part.primitives, None)).collect();
        let (search, savings, tests) = (plan.search, quality.savings, plan.tests);
        Finder { world, structure, parts, search, savings, tests }
    }

    /// Bytes of the structures of all parts.
    pub fn bytes_of_parts(&self) -> u64 {
        self.parts.iter().filter_map(Structure::size).map(|size| size.bytes).sum()
    }

    /// `last` is the primitive that the ray before met.
    #[inline(always)]
    pub fn closest_hit<T: Tally>(&self, ray: &Ray, tally: &mut T, last: &mut Option<u32>) -> Option<Hit> {
        // Most scenes have no endless plane, and then the ray need not be copied: 3 % of a plain frame.
        let (shorter, plane) = match self.world.planes.as_slice() {
            [] => (None, None),
            _ => self.closest_plane(ray, tally),
        };
        let ray = shorter.as_ref().unwrap_or(ray);
        let mut inside = Inside::default();
        let mut probe =
            SceneProbe::new(self, &self.structure, &self.world.primitives, ray, tally, &mut inside);
        let hit = if self.search == Search::Cached {
            let search = |probe: &mut SceneProbe<'_, T>, ray: &Ray| self.closest(&self.structure, probe, ray);
            let hit = closest_hit_cached(*last, &mut probe, ray, search);
            *last = hit.map_or(*last, |hit| Some(hit.primitive));
            hit
        } else {
            self.closest(&self.structure, &mut probe, ray)
        };
        hit.map(|hit| probe.told(hit, ray)).or(plane)
    }

    /// Whether rays from the camera are to come in packets.
    pub fn likes_packets(&self) -> bool {
        self.search == Search::Packets
    }

    /// What several rays meet, each by itself.
    pub fn closest_hits<T: Tally>(&self, rays: &[Ray], tally: &mut T) -> Vec<Option<Hit>> {
        let Structure::Hierarchy(bvh) = &self.structure else {
            return rays.iter().map(|ray| self.closest_hit(ray, tally, &mut None)).collect();
        };
        let shortened: Vec<(Option<Ray>, Option<Hit>)> =
            rays.iter().map(|ray| self.closest_plane(ray, tally)).collect();
        let rays: Vec<Ray> =
            rays.iter().zip(&shortened).map(|(ray, (shorter, _))| shorter.unwrap_or(*ray)).collect();
        let Some(first) = rays.first() else { return Vec::new() };
        let mut inside = Inside::default();
        let probe = SceneProbe::new(self, &self.structure, &self.world.primitives, first, tally, &mut inside);
        let mut probe = PacketProbe(probe);
        let hits = closest_hit_packet(bvh, &mut probe, &rays);
        let told = hits.into_iter().zip(&rays).zip(shortened);
        told.map(|((hit, ray), (_, plane))| hit.map(|hit| probe.told(hit, ray)).or(plane)).collect()
    }

    /// The closest hit in the scene or in a part.
    #[inline(always)]
    pub fn closest<T: Tally>(
        &self,
        structure: &Structure,
        probe: &mut SceneProbe<'_, T>,
        ray: &Ray,
    ) -> Option<PrimitiveHit> {
        match structure {
            Structure::Hierarchy(bvh) => stage3_bvh::closest_hit(bvh, probe, ray),
            Structure::Graph { graph, volumes } => {
                closest_hit_in_graph(graph, &mut GraphProbe { probe, volumes }, ray, self.savings)
            }
            Structure::Grid(grid) => stage9_grid::closest_hit(grid, probe, ray),
            Structure::Octree(tree) if self.search == Search::OctreeByCells => {
                stage9_octree::closest_hit_by_cells(tree, probe, ray)
            }
            Structure::Octree(tree) => stage9_octree::closest_hit(tree, probe, ray),
            Structure::KdTree(tree) => stage9_kd_tree::closest_hit(tree, probe, ray),
            Structure::Bsp { tree, .. } => stage9_bsp::closest_hit(tree, probe, ray),
            Structure::None if self.search == Search::Painter => probe.last_hit(ray),
            Structure::None => stage2_triangles::brute_force(probe.primitives.len() as u32, probe, ray),
        }
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
        let mut inside = Inside::any_will_do();
        let mut probe =
            SceneProbe::new(self, &self.structure, &self.world.primitives, ray, tally, &mut inside);
        in_plane || self.any(&self.structure, &mut probe, ray)
    }

    /// Whether there is any hit in the scene or in a part.
    #[inline(always)]
    pub fn any<T: Tally>(&self, structure: &Structure, probe: &mut SceneProbe<'_, T>, ray: &Ray) -> bool {
        match structure {
            Structure::Hierarchy(bvh) => stage3_bvh::any_hit(bvh, probe, ray),
            Structure::None => probe.last_hit(ray).is_some(),
            other => self.closest(other, probe, ray).is_some(),
        }
    }
}

/// The corners of a triangle that stands still.
fn hull(primitive: &Primitive) -> Option<Vec<Vec3>> {
    match (primitive.end.get(), &primitive.geometry) {
        (None, Geometry::Triangle(triangle)) => Some(vec![triangle.a, triangle.b, triangle.c]),
        _ => None,
    }
}

/// The box around all places where the primitive is.
fn bounds_of(world: &World, parts: &[Aabb], primitive: &Primitive) -> Aabb {
    let bounds = |geometry: &Geometry| match geometry {
        Geometry::Sphere(sphere) => stage3_bvh::sphere_bounds(sphere),
        Geometry::Triangle(triangle) => stage3_bvh::triangle_bounds(triangle),
        Geometry::Solid(index) => {
            let solid = &world.solids[*index as usize];
            placed_bounds(&bounds_of_shape(&solid.shape), &solid.placement)
        }
        Geometry::Instance(index) => {
            let instance = &world.instances[*index as usize];
            placed_bounds(&parts[instance.part as usize], &instance.placement)
        }
    };
    let start = bounds(&primitive.geometry);
    match primitive.end.get() {
        None => start,
        Some(end) => stage6_distribution::sweep(&start, &bounds(&world.ends[end])),
    }
}
