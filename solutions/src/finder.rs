//! Nothing to do here: what a ray meets, by the search that the plan has chosen.

use crate::camera_rays::{geometry_at, plane_at};
use crate::placed::{bounds_of_shape, meet_solid, placed_bounds};
use crate::plan::Plan;
use crate::search::Search;
use crate::stage8_scene_graph::{closest_hit_in_graph, ray_to_object};
use crate::stage9_coherence::{closest_hit_cached, closest_hit_packet};
use crate::structure::Structure;
use crate::surfaces::{Hit, meet_triangle};
use crate::{
    stage1_shapes, stage2_triangles, stage3_bvh, stage6_distribution, stage9_bsp, stage9_grid,
    stage9_kd_tree, stage9_octree,
};
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Contents, Node, PrimitiveHit, Probe};
use raykata::count::{Event, Tally};
use raykata::graph::{Graph, Savings};
use raykata::partition::Cells;
use raykata::ray::Ray;
use raykata::scene::{Quality, TriangleMethod};
use raykata::world::{Geometry, Primitive, World};

/// A world, and the structures by which rays find what is in it.
pub struct Finder {
    pub world: World,
    /// Over the primitives of the world.
    pub structure: Structure,
    /// One for each part, over its triangles.
    parts: Vec<Structure>,
    search: Search,
    savings: Savings,
    method: TriangleMethod,
}

impl Finder {
    pub fn new(world: World, plan: &Plan, quality: &Quality) -> Finder {
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
        let over = |bounds: &[Aabb], primitives: &[Primitive], graph: Option<&Graph>| {
            Structure::new(bounds, graph, |index| hull(&primitives[index]), plan.search, quality)
        };
        let structure = over(&of_scene, &world.primitives, Some(&world.graph));
        let parts = world.parts.iter().zip(&of_parts);
        let parts = parts.map(|(part, bounds)| over(bounds, &part.primitives, None)).collect();
        let (search, savings, method) = (plan.search, quality.savings, quality.triangle_method);
        Finder { world, structure, parts, search, savings, method }
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
        let mut probe = SceneProbe::new(self, &self.structure, &self.world.primitives, ray, tally);
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
        let probe = SceneProbe::new(self, &self.structure, &self.world.primitives, first, tally);
        let mut probe = PacketProbe(probe);
        let hits = closest_hit_packet(bvh, &mut probe, &rays);
        let told = hits.into_iter().zip(&rays).zip(shortened).map(|((hit, ray), (_, plane))| {
            // What is inside an instance was written down for whichever ray came last.
            probe.0.inside = None;
            hit.map(|hit| probe.0.told(hit, ray)).or(plane)
        });
        told.collect()
    }

    /// The closest hit in the scene or in a part.
    #[inline(always)]
    fn closest<T: Tally>(
        &self,
        structure: &Structure,
        probe: &mut SceneProbe<'_, T>,
        ray: &Ray,
    ) -> Option<PrimitiveHit> {
        match structure {
            Structure::Hierarchy(bvh) => stage3_bvh::closest_hit(bvh, probe, ray),
            Structure::Graph { graph, .. } => closest_hit_in_graph(graph, probe, ray, self.savings),
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
        let mut probe = SceneProbe::new(self, &self.structure, &self.world.primitives, ray, tally);
        probe.any_will_do = true;
        in_plane || self.any(&self.structure, &mut probe, ray)
    }

    /// Whether there is any hit in the scene or in a part.
    #[inline(always)]
    fn any<T: Tally>(&self, structure: &Structure, probe: &mut SceneProbe<'_, T>, ray: &Ray) -> bool {
        match structure {
            Structure::Hierarchy(bvh) => stage3_bvh::any_hit(bvh, probe, ray),
            Structure::None => probe.last_hit(ray).is_some(),
            other => self.closest(other, probe, ray).is_some(),
        }
    }
}

/// Answers the questions of a search about the world or a part of it, and counts them.
///
/// It holds what the inner loop reads, and is inlined there: asked through the finder, a frame took a tenth longer.
struct SceneProbe<'a, T> {
    nodes: &'a [Node],
    primitives: &'a [Primitive],
    world: &'a World,
    method: TriangleMethod,
    inverse_dir: Vec3,
    tally: &'a mut T,
    finder: &'a Finder,
    structure: &'a Structure,
    /// Whether the first hit is as good as the closest.
    any_will_do: bool,
    /// What was hit inside an instance, of the best answer of any instance so far.
    inside: Option<(PrimitiveHit, u32)>,
}

impl<'a, T: Tally> SceneProbe<'a, T> {
    #[inline]
    fn new(
        finder: &'a Finder,
        structure: &'a Structure,
        primitives: &'a [Primitive],
        ray: &Ray,
        tally: &'a mut T,
    ) -> Self {
        SceneProbe {
            nodes: structure.nodes(),
            primitives,
            world: &finder.world,
            method: finder.method,
            inverse_dir: ray.dir.recip(),
            tally,
            finder,
            structure,
            any_will_do: false,
            inside: None,
        }
    }

    #[inline(always)]
    fn meet(&mut self, index: u32, ray: &Ray, geometry: &Geometry) -> Option<f32> {
        match geometry {
            Geometry::Sphere(sphere) => stage1_shapes::sphere_algebraic(ray, sphere.center, sphere.radius),
            Geometry::Triangle(triangle) => meet_triangle(self.method, ray, triangle).map(|(t, ..)| t),
            Geometry::Solid(solid) => meet_solid(ray, &self.world.solids[*solid as usize]).map(|hit| hit.t),
            Geometry::Instance(instance) => self.meet_instance(index, *instance, ray),
        }
    }

    /// Carries the ray into the space of a part and searches there.
    #[inline(never)]
    fn meet_instance(&mut self, index: u32, instance: u32, ray: &Ray) -> Option<f32> {
        let instance = &self.world.instances[instance as usize];
        let ray = ray_to_object(ray, &instance.placement.to_object);
        let part = instance.part as usize;
        let (structure, primitives) = (&self.finder.parts[part], &self.world.parts[part].primitives);
        let mut probe = SceneProbe::new(self.finder, structure, primitives, &ray, self.tally);
        if self.any_will_do {
            return self.finder.any(structure, &mut probe, &ray).then_some(ray.t_min.next_up());
        }
        let hit = self.finder.closest(structure, &mut probe, &ray)?;
        if self.inside.is_none_or(|(best, _)| (hit.t, index) < (best.t, best.primitive)) {
            self.inside = Some((PrimitiveHit { t: hit.t, primitive: index }, hit.primitive));
        }
        Some(hit.t)
    }

    /// What the search has found, with the primitive inside if it is an instance.
    fn told(&mut self, hit: PrimitiveHit, ray: &Ray) -> Hit {
        let PrimitiveHit { t, primitive } = hit;
        let Geometry::Instance(_) = self.primitives[primitive as usize].geometry else {
            return Hit::Primitive(hit);
        };
        if self.inside.is_none_or(|(best, _)| best.primitive != primitive) {
            // A search may prefer another hit than the closest; then that instance is asked again.
            self.inside = None;
            let _ = self.test(primitive, ray);
        }
        let inner = self.inside.map_or(0, |(_, inner)| inner);
        Hit::Inner { t, outer: primitive, inner }
    }

    #[inline(always)]
    fn test(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.tally.note(Event::PrimitiveTest);
        let index = primitive;
        let primitive = &self.primitives[primitive as usize];
        match primitive.end.get() {
            None => self.meet(index, ray, &primitive.geometry),
            Some(_) => self.meet(index, ray, &geometry_at(self.world, primitive, ray.time)),
        }
    }

    /// The last primitive in the order of the scene that the ray meets.
    fn last_hit(&mut self, ray: &Ray) -> Option<PrimitiveHit> {
        let n_primitives = self.primitives.len() as u32;
        (0..n_primitives)
            .rev()
            .find_map(|primitive| self.test(primitive, ray).map(|t| PrimitiveHit { t, primitive }))
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
        match self.nodes.get(node as usize) {
            Some(node) => stage3_bvh::slab(ray, self.inverse_dir, &node.bounds).map(|(enter, _)| enter),
            None => self.structure.enter_volume(node, ray, self.inverse_dir),
        }
    }

    #[inline(always)]
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.test(primitive, ray)
    }
}

impl<T: Tally> Cells for SceneProbe<'_, T> {
    #[inline]
    fn visit(&mut self, _: u32) {
        self.tally.note(Event::NodeVisit);
    }

    #[inline(always)]
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.test(primitive, ray)
    }
}

/// The same for a packet, whose rays have directions of their own.
struct PacketProbe<'a, T>(SceneProbe<'a, T>);

impl<T: Tally> Probe for PacketProbe<'_, T> {
    #[inline]
    fn open(&mut self, node: u32) -> Contents {
        self.0.open(node)
    }

    #[inline]
    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        self.0.inverse_dir = ray.dir.recip();
        self.0.enter(node, ray)
    }

    #[inline]
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.0.test(primitive, ray)
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
