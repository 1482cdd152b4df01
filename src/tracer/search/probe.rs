//! What searches may ask about the primitives of a world, or of a shared mesh.

use super::hit::{Detail, Hit, Target};
use super::intersection::{ShapeTests, TriangleTest};
use super::motion::geometry_at;
use super::primitives::Primitives;
use super::solids::intersect_solid;
use super::structure::Structure;
use crate::aabb::Aabb;
use crate::bvh::{Contents, Node, PrimitiveHit, Probe};
use crate::count::{Event, Tally};
use crate::graph::GraphOptimisations;
use crate::kit::{GramScalars, StudentFunctions};
use crate::partition::Cells;
use crate::ray::Ray;
use crate::shape::Triangle;
use crate::world::{Geometry, Primitive, World};
use glam::Vec3;
use std::marker::PhantomData;

/// A world with its acceleration structures, which all probes of a frame read.
pub struct StructuredWorld {
    /// The flat scene: all primitives, infinite planes, materials and lights.
    pub world: World,
    /// The acceleration structure over the primitives of the world.
    pub structure: Structure,
    /// One acceleration structure per shared mesh, over its triangles.
    pub mesh_structures: Vec<Structure>,
    /// The scalars of the Gram method for each primitive of the world.
    pub gram: GramTable,
    /// The same for each shared mesh.
    pub mesh_gram: Vec<GramTable>,
    /// Which student functions test rays against triangles and spheres.
    pub tests: ShapeTests,
    /// Whether `may_hit` of stage 12 sorts out triangles of wide trees; otherwise each is tested.
    pub may_hit: bool,
    /// Whether `conservative_slab` of stage 10 tests the boxes of hierarchies; otherwise `slab` of stage 3.
    pub conservative: bool,
    /// Which shortcuts a search of the scene graph takes.
    pub savings: GraphOptimisations,
}

/// The scalars of the Gram method, one entry per primitive: they are computed once and not for every ray. Empty for
/// any other method.
#[derive(Default)]
pub struct GramTable(Vec<GramScalars>);

impl GramTable {
    /// Computes the scalars of all triangles that do not move. Other primitives get an entry that is never read.
    pub fn new<F: StudentFunctions>(primitives: &[Primitive], tests: ShapeTests) -> GramTable {
        if tests.triangles != TriangleTest::Gram {
            return GramTable::default();
        }
        let unused = GramScalars { uv: 0.0, vv: 0.0, uu: 0.0, d: 0.0 };
        let scalars = |primitive: &Primitive| primitive.geometry.triangle().map_or(unused, F::gram_scalars);
        GramTable(primitives.iter().map(scalars).collect())
    }
}

/// Answers the questions of a search about one set of primitives, and counts them.
///
/// It holds what the inner loop reads, and is inlined there: with indirect access through [`StructuredWorld`], a
/// frame took a tenth longer. Everything that it changes is behind references, so that the compiler can keep
/// the rest in registers: with `reported` stored inside, hierarchies took 5 % more instructions.
pub struct SceneProbe<'a, F, T> {
    nodes: &'a [Node],
    primitives: &'a [Primitive],
    world: &'a World,
    gram: &'a [GramScalars],
    /// Which student functions test rays against triangles and spheres.
    tests: ShapeTests,
    /// Whether `may_hit` of stage 12 is written.
    may_hit: bool,
    conservative: bool,
    inverse_direction: Vec3,
    tally: &'a mut T,
    scene: &'a StructuredWorld,
    /// What is remembered of the hits that were reported.
    reported: &'a mut ReportedHits,
    functions: PhantomData<F>,
}

/// What a probe remembers of the hits that it reported: the index of the primitive, and what its test found
/// beside `t`.
pub struct ReportedHits {
    /// Whether any hit is enough; otherwise the closest is needed.
    any_will_do: bool,
    /// The last hit that was reported: the primitive, and what its test found.
    last: (u32, Detail),
    /// The closest hit with an instance: the hit, the primitive of the shared mesh, and what its test found.
    instance: Option<(PrimitiveHit, u32, Detail)>,
}

impl ReportedHits {
    /// No reported hits, for a ray whose closest hit is searched.
    pub fn for_closest_hit() -> ReportedHits {
        ReportedHits { any_will_do: false, last: (u32::MAX, Detail::None), instance: None }
    }

    /// No reported hits, for a ray for which any hit is enough, such as a shadow ray.
    pub fn for_any_hit() -> ReportedHits {
        ReportedHits { any_will_do: true, ..ReportedHits::for_closest_hit() }
    }

    /// What the test of `primitive` found, if that was the last hit.
    fn detail(&self, primitive: u32) -> Detail {
        if self.last.0 == primitive { self.last.1 } else { Detail::None }
    }
}

impl<'a, F: StudentFunctions, T: Tally> SceneProbe<'a, F, T> {
    /// A probe for `ray` against the primitives of the world; `tally` counts its answers.
    #[inline(always)]
    pub fn new(
        scene: &'a StructuredWorld,
        ray: &Ray,
        tally: &'a mut T,
        reported: &'a mut ReportedHits,
    ) -> Self {
        let world = (&scene.structure, scene.world.primitives.as_slice(), &scene.gram);
        SceneProbe::over(scene, world, ray, tally, reported)
    }

    /// A probe for `ray` against primitives with the structure that is built over them and their scalars of the
    /// Gram method.
    #[inline(always)]
    fn over(
        scene: &'a StructuredWorld,
        (structure, primitives, gram): (&'a Structure, &'a [Primitive], &'a GramTable),
        ray: &Ray,
        tally: &'a mut T,
        reported: &'a mut ReportedHits,
    ) -> Self {
        SceneProbe {
            nodes: structure.nodes(),
            primitives,
            world: &scene.world,
            gram: &gram.0,
            tests: scene.tests,
            may_hit: scene.may_hit,
            conservative: scene.conservative,
            // A wide tree has reciprocals of its own.
            inverse_direction: match structure {
                Structure::Wide(_) => Vec3::ZERO,
                _ => ray.direction.recip(),
            },
            tally,
            scene,
            reported,
            functions: PhantomData,
        }
    }

    #[inline(always)]
    fn intersect(
        &mut self,
        index: u32,
        ray: &Ray,
        geometry: &Geometry,
        scalars: Option<&GramScalars>,
    ) -> Option<f32> {
        match geometry {
            Geometry::Sphere(sphere) => self.tests.sphere::<F>(ray, sphere),
            Geometry::OneSided(triangle) if F::backfacing(ray, triangle) => None,
            Geometry::Triangle(triangle) | Geometry::OneSided(triangle) => {
                let hit = self.tests.triangle::<F>(ray, triangle, scalars)?;
                self.reported.last = (index, Detail::Triangle(hit.beta, hit.gamma));
                Some(hit.t)
            }
            Geometry::Solid(solid) => self.intersect_solid(index, ray, *solid),
            Geometry::Instance(instance) => self.intersect_instance(index, ray, *instance),
        }
    }

    #[cold]
    fn intersect_solid(&mut self, index: u32, ray: &Ray, solid: u32) -> Option<f32> {
        let hit = intersect_solid::<F>(self.tests, ray, &self.world.solids[solid as usize])?;
        self.reported.last = (index, Detail::Solid(hit.normal));
        Some(hit.t)
    }

    /// Transforms the ray into the space of the shared mesh and searches there. Out of line, because few
    /// scenes have instances.
    #[cold]
    fn intersect_instance(&mut self, index: u32, ray: &Ray, instance: u32) -> Option<f32> {
        let instance = &self.world.instances[instance as usize];
        let ray = F::ray_to_object(ray, &instance.placement.to_object);
        let mesh = instance.shared_mesh as usize;
        let structure = &self.scene.mesh_structures[mesh];
        let primitives = self.world.shared_meshes[mesh].primitives.as_slice();
        let searched = (structure, primitives, &self.scene.mesh_gram[mesh]);
        // Search the shared mesh with a probe and reported hits of its own.
        let mut reported =
            ReportedHits { any_will_do: self.reported.any_will_do, ..ReportedHits::for_closest_hit() };
        self.tally.within_mesh(true);
        let mut probe = SceneProbe::<F, T>::over(self.scene, searched, &ray, self.tally, &mut reported);
        if self.reported.any_will_do {
            let hit = structure.any_hit::<F, _>(&mut probe, &ray, self.scene.savings);
            self.tally.within_mesh(false);
            return hit.then_some(ray.t_min.next_up());
        }
        let hit = structure.closest_hit::<F, _>(&mut probe, &ray, self.scene.savings);
        self.tally.within_mesh(false);
        let hit = hit?;
        // Keep the inner hit if it is the closest so far; of two at the same `t` the smaller index wins.
        if self.reported.instance.is_none_or(|(best, ..)| (hit.t, index) < (best.t, best.primitive)) {
            let at = PrimitiveHit { t: hit.t, primitive: index };
            self.reported.instance = Some((at, hit.primitive, reported.detail(hit.primitive)));
        }
        Some(hit.t)
    }

    #[inline(always)]
    fn test(&mut self, index: u32, ray: &Ray) -> Option<f32> {
        self.tally.note(Event::PrimitiveTest);
        self.hit_uncounted(index, ray)
    }

    /// The complete hit for `found`, the result of a search with `ray`: with its surface, and with what the
    /// test found beside `t`.
    pub fn hit_of(&mut self, found: PrimitiveHit, ray: &Ray) -> Hit {
        let PrimitiveHit { t, primitive } = found;
        let Geometry::Instance(_) = self.primitives[primitive as usize].geometry else {
            return Hit { t, target: Target::Primitive(primitive), detail: self.reported.detail(primitive) };
        };
        if self.reported.instance.is_none_or(|(best, ..)| best.primitive != primitive) {
            // Test this instance again if the reported hits are about another one: a search may return a hit that is not the
            // closest.
            self.reported.instance = None;
            let _ = self.test(primitive, ray);
        }
        let (inner, detail) =
            self.reported.instance.map_or((0, Detail::None), |(_, inner, detail)| (inner, detail));
        Hit { t, target: Target::Instance(primitive, inner), detail }
    }
}

impl<F: StudentFunctions, T: Tally> Probe for SceneProbe<'_, F, T> {
    #[inline]
    fn open(&mut self, node: u32) -> Contents {
        self.tally.note(Event::NodeVisit);
        self.nodes[node as usize].contents
    }

    #[inline]
    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        self.tally.note(Event::BoxTest);
        let bounds = &self.nodes[node as usize].bounds;
        let interval = if self.conservative {
            F::conservative_slab(ray, self.inverse_direction, bounds)
        } else {
            F::slab(ray, self.inverse_direction, bounds)
        };
        self.tested(|| *bounds, interval.is_some());
        interval.map(|(enter, _)| enter)
    }

    #[inline(always)]
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.test(primitive, ray)
    }
}

impl<F: StudentFunctions, T: Tally> Cells for SceneProbe<'_, F, T> {
    #[inline]
    fn visit(&mut self, _: u32) {
        self.tally.note(Event::NodeVisit);
    }

    #[inline(always)]
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.test(primitive, ray)
    }
}

impl<F: StudentFunctions, T: Tally> Primitives for SceneProbe<'_, F, T> {
    const COUNTS: bool = T::COUNTS;

    #[inline(always)]
    fn n_primitives(&self) -> u32 {
        self.primitives.len() as u32
    }

    #[inline(always)]
    fn count(&mut self, event: Event) {
        self.tally.note(event);
    }

    #[inline(always)]
    fn tested(&mut self, bounds: impl FnOnce() -> Aabb, hit: bool) {
        if self.tally.keeps_boxes() {
            self.tally.tested(&bounds(), hit);
        }
    }

    #[inline(always)]
    fn conservative(&self) -> bool {
        self.conservative
    }

    #[inline(always)]
    fn inverse_direction(&self) -> Vec3 {
        self.inverse_direction
    }

    #[inline(always)]
    fn may_sort_out(&self) -> bool {
        matches!(self.tests.triangles, TriangleTest::Watertight | TriangleTest::InDouble) && self.may_hit
    }

    #[inline(always)]
    fn is_watertight(&self) -> bool {
        self.tests.triangles == TriangleTest::Watertight
    }

    #[inline(always)]
    fn hit_uncounted(&mut self, index: u32, ray: &Ray) -> Option<f32> {
        let primitive = &self.primitives[index as usize];
        match primitive.end.get() {
            None => self.intersect(index, ray, &primitive.geometry, self.gram.get(index as usize)),
            Some(_) => self.intersect(index, ray, &geometry_at::<F>(self.world, primitive, ray.time), None),
        }
    }

    #[inline(always)]
    fn hit_triangle(&mut self, primitive: u32, triangle: &Triangle, ray: &Ray) -> Option<f32> {
        let hit = self.tests.triangle::<F>(ray, triangle, None)?;
        self.reported.last = (primitive, Detail::Triangle(hit.beta, hit.gamma));
        Some(hit.t)
    }
}

/// A [`SceneProbe`] for a packet of rays, each with a direction of its own.
pub struct PacketProbe<'a, F, T>(pub SceneProbe<'a, F, T>);

impl<F: StudentFunctions, T: Tally> PacketProbe<'_, F, T> {
    /// The complete hit for `found`, the result of the search for `ray`, one ray of the packet.
    pub fn hit_of(&mut self, found: PrimitiveHit, ray: &Ray) -> Hit {
        // Test the primitive again, because the reported hits are those of the last ray of the packet.
        *self.0.reported = ReportedHits::for_closest_hit();
        self.0.hit_of(found, ray)
    }
}

impl<F: StudentFunctions, T: Tally> Probe for PacketProbe<'_, F, T> {
    #[inline]
    fn open(&mut self, node: u32) -> Contents {
        self.0.open(node)
    }

    #[inline]
    fn enter(&mut self, node: u32, ray: &Ray) -> Option<f32> {
        self.0.inverse_direction = ray.direction.recip();
        self.0.enter(node, ray)
    }

    #[inline]
    fn hit(&mut self, primitive: u32, ray: &Ray) -> Option<f32> {
        self.0.test(primitive, ray)
    }
}
