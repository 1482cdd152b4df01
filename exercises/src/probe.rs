//! Nothing to do here: what searches may ask about a world.

use crate::camera_rays::geometry_at;
use crate::finder::Finder;
use crate::placed::meet_solid;
use crate::shape_tests::ShapeTests;
use crate::stage3_bvh;
use crate::stage8_scene_graph::ray_to_object;
use crate::structure::{Structure, Volumes};
use crate::surfaces::Hit;
use glam::Vec3;
use raykata::bvh::{Contents, Node, PrimitiveHit, Probe};
use raykata::count::{Event, Tally};
use raykata::partition::Cells;
use raykata::ray::Ray;
use raykata::world::{Geometry, Primitive, World};

/// Answers the questions of a search about the world or a part of it, and counts them.
///
/// It holds what the inner loop reads, and is inlined there: asked through the finder, a frame took a tenth longer. What
/// it writes it writes through references, so that a compiler may keep the rest in registers: with `inside` as a part of
/// it, hierarchies took 5 % more instructions.
pub struct SceneProbe<'a, T> {
    nodes: &'a [Node],
    pub primitives: &'a [Primitive],
    world: &'a World,
    tests: ShapeTests,
    inverse_dir: Vec3,
    tally: &'a mut T,
    finder: &'a Finder,
    inside: &'a mut Inside,
}

impl<'a, T: Tally> SceneProbe<'a, T> {
    #[inline]
    pub fn new(
        finder: &'a Finder,
        structure: &'a Structure,
        primitives: &'a [Primitive],
        ray: &Ray,
        tally: &'a mut T,
        inside: &'a mut Inside,
    ) -> Self {
        SceneProbe {
            nodes: structure.nodes(),
            primitives,
            world: &finder.world,
            tests: finder.tests,
            inverse_dir: ray.dir.recip(),
            tally,
            finder,
            inside,
        }
    }

    #[inline(always)]
    fn meet(&mut self, index: u32, ray: &Ray, geometry: &Geometry) -> Option<f32> {
        match geometry {
            Geometry::Sphere(sphere) => self.tests.sphere(ray, sphere),
            Geometry::Triangle(triangle) => self.tests.triangle(ray, triangle).map(|hit| hit.t),
            other => self.inside.meet(self.finder, self.tally, index, ray, other),
        }
    }

    /// What the search has found, with the primitive inside if it is an instance.
    pub fn told(&mut self, hit: PrimitiveHit, ray: &Ray) -> Hit {
        let PrimitiveHit { t, primitive } = hit;
        let Geometry::Instance(_) = self.primitives[primitive as usize].geometry else {
            return Hit::Primitive(hit);
        };
        if self.inside.best.is_none_or(|(best, _)| best.primitive != primitive) {
            // A search may prefer another hit than the closest; then that instance is asked again.
            self.inside.best = None;
            let _ = self.test(primitive, ray);
        }
        let inner = self.inside.best.map_or(0, |(_, inner)| inner);
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
        let bounds = &self.nodes[node as usize].bounds;
        stage3_bvh::slab(ray, self.inverse_dir, bounds).map(|(enter, _)| enter)
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

/// How instances are asked, and what was met inside them.
#[derive(Default)]
pub struct Inside {
    /// Whether the first hit is as good as the closest.
    any_will_do: bool,
    /// The best answer of any instance so far, and the primitive of its part.
    best: Option<(PrimitiveHit, u32)>,
}

impl Inside {
    /// For rays that only ask whether there is anything.
    pub fn any_will_do() -> Inside {
        Inside { any_will_do: true, best: None }
    }

    /// Meets what has a space of its own. Out of line, because few scenes have any.
    #[cold]
    fn meet<T: Tally>(
        &mut self,
        finder: &Finder,
        tally: &mut T,
        index: u32,
        ray: &Ray,
        geometry: &Geometry,
    ) -> Option<f32> {
        let instance = match geometry {
            Geometry::Instance(instance) => &finder.world.instances[*instance as usize],
            Geometry::Solid(solid) => {
                let solid = &finder.world.solids[*solid as usize];
                return meet_solid(finder.tests, ray, solid).map(|hit| hit.t);
            }
            Geometry::Sphere(_) | Geometry::Triangle(_) => return None,
        };
        // Carries the ray into the space of the part and searches there.
        let ray = ray_to_object(ray, &instance.placement.to_object);
        let part = instance.part as usize;
        let (structure, primitives) = (&finder.parts[part], &finder.world.parts[part].primitives);
        let mut deeper = Inside { any_will_do: self.any_will_do, best: None };
        let mut probe = SceneProbe::new(finder, structure, primitives, &ray, tally, &mut deeper);
        if self.any_will_do {
            return finder.any(structure, &mut probe, &ray).then_some(ray.t_min.next_up());
        }
        let hit = finder.closest(structure, &mut probe, &ray)?;
        if self.best.is_none_or(|(best, _)| (hit.t, index) < (best.t, best.primitive)) {
            self.best = Some((PrimitiveHit { t: hit.t, primitive: index }, hit.primitive));
        }
        Some(hit.t)
    }
}

/// The same for a scene graph, whose nodes have volumes of their own.
pub struct GraphProbe<'p, 'a, T> {
    pub probe: &'p mut SceneProbe<'a, T>,
    pub volumes: &'p Volumes,
}

impl<T: Tally> Probe for GraphProbe<'_, '_, T> {
    #[inline]
    fn open(&mut self, node: u32) -> Contents {
        self.probe.open(node)
    }

    #[inline]
    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        self.probe.tally.note(Event::BoxTest);
        self.volumes.enter(node, ray, self.probe.inverse_dir)
    }

    #[inline]
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.probe.test(primitive, ray)
    }
}

/// The same for a packet, whose rays have directions of their own.
pub struct PacketProbe<'a, T>(pub SceneProbe<'a, T>);

impl<T: Tally> PacketProbe<'_, T> {
    /// What the search has found for one ray of the packet.
    pub fn told(&mut self, hit: PrimitiveHit, ray: &Ray) -> Hit {
        // What is inside an instance was written down for whichever ray came last.
        self.0.inside.best = None;
        self.0.told(hit, ray)
    }
}

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
