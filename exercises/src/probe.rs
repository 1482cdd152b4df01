//! Nothing to do here: what searches may ask about a world.

use crate::camera_rays::geometry_at;
use crate::finder::Finder;
use crate::placed::meet_solid;
use crate::stage8_scene_graph::ray_to_object;
use crate::structure::Structure;
use crate::surfaces::{Hit, meet_triangle};
use crate::{stage1_shapes, stage3_bvh};
use glam::Vec3;
use raykata::bvh::{Contents, Node, PrimitiveHit, Probe};
use raykata::count::{Event, Tally};
use raykata::partition::Cells;
use raykata::ray::Ray;
use raykata::scene::TriangleMethod;
use raykata::world::{Geometry, Primitive, World};

/// Answers the questions of a search about the world or a part of it, and counts them.
///
/// It holds what the inner loop reads, and is inlined there: asked through the finder, a frame took a tenth longer.
pub struct SceneProbe<'a, T> {
    nodes: &'a [Node],
    pub primitives: &'a [Primitive],
    world: &'a World,
    method: TriangleMethod,
    inverse_dir: Vec3,
    tally: &'a mut T,
    finder: &'a Finder,
    structure: &'a Structure,
    /// Whether the first hit is as good as the closest.
    pub any_will_do: bool,
    /// What was hit inside an instance, of the best answer of any instance so far.
    pub inside: Option<(PrimitiveHit, u32)>,
}

impl<'a, T: Tally> SceneProbe<'a, T> {
    #[inline]
    pub fn new(
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
    pub fn told(&mut self, hit: PrimitiveHit, ray: &Ray) -> Hit {
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
    pub fn last_hit(&mut self, ray: &Ray) -> Option<PrimitiveHit> {
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
pub struct PacketProbe<'a, T>(pub SceneProbe<'a, T>);

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
