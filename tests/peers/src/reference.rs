//! The wide tree of the reference, with the guarantee of frames: hits are those of the watertight test.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::ray::Ray;
use raykata::shape::Triangle;
use raykata::wide::simd::{Instructions, Level, Vectorized};
use raykata::wide::{Child, Entered, Forks, TriangleBlock, WideNode, WideProbe, WideRay};
use solutions::{stage10_stability, stage12_build, stage12_search, stage12_simd, stage12_wide};

pub struct Wide {
    nodes: Vec<WideNode>,
    blocks: Vec<TriangleBlock>,
    instructions: Instructions,
}

impl Wide {
    pub fn build(triangles: &[Triangle], in_parallel: bool) -> Wide {
        let bounds = bounds(triangles);
        let tree = stage12_build::build_parallel(&bounds, &mut Forks::new(in_parallel));
        drop(bounds);
        let wide = stage12_wide::collapse(&tree);
        drop(tree);
        let block = |ids: &_| TriangleBlock::new(*ids, |id| Some(triangles[id as usize]));
        let blocks = wide.blocks.iter().map(block).collect();
        Wide { nodes: wide.nodes, blocks, instructions: Instructions::detect() }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.blocks.as_slice())
    }

    pub fn closest(&self, rays: &[Ray], found: &mut [f32]) {
        self.instructions.run(Closest(self, rays, found));
    }

    pub fn any(&self, rays: &[Ray], found: &mut [bool]) {
        self.instructions.run(Any(self, rays, found));
    }

    /// Node visits, blocks, and exact tests of a search for each ray.
    pub fn counts(&self, rays: &[Ray], search: Search) -> [u64; 3] {
        struct Counting<'a>(&'a Wide, &'a [Ray], Search);
        impl Vectorized for Counting<'_> {
            type Output = [u64; 3];

            #[inline(always)]
            fn run<L: Level>(self, level: L) -> [u64; 3] {
                let counts = |ray: &Ray| {
                    let mut probe = Triangles::new(self.0, ray, level);
                    probe.is_ordered = self.2 != Search::ClosestWithoutOrder;
                    if self.2 == Search::Any {
                        let _ = stage12_search::wide_any_hit(&mut probe, ray);
                    } else {
                        let _ = stage12_search::wide_closest_hit(&mut probe, ray);
                    }
                    probe.counts
                };
                let add = |sum: [u64; 3], one: [u64; 3]| std::array::from_fn(|i| sum[i] + one[i]);
                self.1.iter().map(counts).fold([0; 3], add)
            }
        }
        self.instructions.run(Counting(self, rays, search))
    }
}

/// What is searched, and how.
#[derive(Clone, Copy, PartialEq)]
pub enum Search {
    /// The closest hit.
    Closest,
    /// The closest hit, by a search that does not know where a ray enters a child: nothing is sorted or skipped.
    ClosestWithoutOrder,
    /// Any hit.
    Any,
}

/// The boxes around the triangles.
pub fn bounds(triangles: &[Triangle]) -> Vec<Aabb> {
    triangles.iter().map(|t| Aabb::new(t.a.min(t.b).min(t.c), t.a.max(t.b).max(t.c))).collect()
}

struct Closest<'a>(&'a Wide, &'a [Ray], &'a mut [f32]);

impl Vectorized for Closest<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Level>(self, level: L) {
        for (ray, found) in self.1.iter().zip(self.2) {
            let mut probe = Triangles::new(self.0, ray, level);
            *found = stage12_search::wide_closest_hit(&mut probe, ray).map_or(f32::INFINITY, |hit| hit.t);
        }
    }
}

struct Any<'a>(&'a Wide, &'a [Ray], &'a mut [bool]);

impl Vectorized for Any<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Level>(self, level: L) {
        for (ray, found) in self.1.iter().zip(self.2) {
            let mut probe = Triangles::new(self.0, ray, level);
            *found = stage12_search::wide_any_hit(&mut probe, ray);
        }
    }
}

/// Answers the questions of a search, and counts them: node visits, blocks and exact tests.
struct Triangles<'a, L> {
    wide: &'a Wide,
    ray: WideRay,
    level: L,
    counts: [u64; 3],
    is_ordered: bool,
}

impl<'a, L: Level> Triangles<'a, L> {
    #[inline(always)]
    fn new(wide: &'a Wide, ray: &Ray, level: L) -> Self {
        Triangles { wide, ray: WideRay::new(ray), level, counts: [0; 3], is_ordered: true }
    }
}

impl<L: Level> WideProbe for Triangles<'_, L> {
    #[inline(always)]
    fn enter(&mut self, node: u32, t_max: f32) -> Entered {
        self.counts[0] += 1;
        let entered =
            stage12_simd::enter_boxes(self.level, &self.wide.nodes[node as usize], &self.ray, t_max);
        if self.is_ordered { entered } else { Entered { t: [0.0; 8], ..entered } }
    }

    #[inline(always)]
    fn children(&self, node: u32) -> &[Child; 8] {
        &self.wide.nodes[node as usize].children
    }

    #[inline(always)]
    fn candidates(&mut self, block: u32, n: u32, t_max: f32) -> u32 {
        self.counts[1] += 1;
        let lanes = (1 << n) - 1;
        lanes & stage12_simd::may_hit(self.level, &self.wide.blocks[block as usize], &self.ray, t_max)
    }

    #[inline(always)]
    fn hit(&mut self, block: u32, lane: u32, ray: &Ray) -> Option<PrimitiveHit> {
        self.counts[2] += 1;
        let block = &self.wide.blocks[block as usize];
        let lane = lane as usize & 3;
        let hit = stage10_stability::watertight(ray, &block.triangle(lane))?;
        Some(PrimitiveHit { t: hit.t, primitive: block.ids[lane] })
    }
}

/// The point at `t`, a little off the surface towards `normal`.
pub fn off_surface(ray: &Ray, t: f32, normal: Vec3) -> Vec3 {
    ray.at(t) + 1e-4 * t.max(1e-3) * normal
}
