//! The wide tree of the reference, with the guarantee of frames: hits are those of the watertight test.

use crate::crates::{Contestant, of_any};
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::ray::Ray;
use raykata::shape::Triangle;
use raykata::wide::simd::{Instructions, Level, Vectorized};
use raykata::wide::{
    Child, Entered, Filtered, Forks, LARGEST, TriangleBlock, WIDE_NODE_COST, WideNode, WideProbe, WideRay,
};
use rayon::prelude::*;
use solutions::{stage10_stability, stage12_build, stage12_search, stage12_simd, stage12_wide};
use std::collections::HashMap;

pub struct Wide {
    nodes: Vec<WideNode>,
    blocks: Vec<TriangleBlock>,
    /// The triangles that are too large for blocks.
    large: HashMap<u32, Triangle>,
    instructions: Instructions,
}

impl Wide {
    /// Builds as frames do, on the threads of the pool that calls it.
    pub fn build(triangles: &[Triangle]) -> Wide {
        let box_of = |t: &Triangle| Aabb::new(t.a.min(t.b).min(t.c), t.a.max(t.b).max(t.c));
        let bounds: Vec<Aabb> = triangles.par_iter().map(box_of).collect();
        let tree = stage12_build::build_parallel(&bounds, &mut Forks::new(rayon::current_num_threads() > 1));
        drop(bounds);
        let wide = stage12_wide::collapse(&tree, WIDE_NODE_COST);
        drop(tree);
        let block = |ids: &_| TriangleBlock::new(*ids, |id| Some(triangles[id as usize]));
        let blocks = wide.blocks.par_iter().map(block).collect();
        let is_large = |t: &Triangle| !(t.a.abs().max(t.b.abs()).max(t.c.abs()).max_element() <= LARGEST);
        let numbered = triangles.par_iter().enumerate().filter(|(_, t)| is_large(t));
        let large = numbered.map(|(id, t)| (id as u32, *t)).collect();
        Wide { nodes: wide.nodes, blocks, large, instructions: Instructions::detect() }
    }

    pub fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.blocks.as_slice())
    }

    /// Node visits, blocks, and exact tests of a search for each ray.
    pub fn counts(&self, rays: &[Ray], any: bool) -> [u64; 3] {
        let mut counts = [0; 3];
        self.instructions.run(Work(self, rays, any, &mut vec![0.0; rays.len()], &mut counts));
        counts
    }

    /// The closest hit of a ray, and whether there is any.
    pub fn both(&self, ray: &Ray) -> (Option<PrimitiveHit>, bool) {
        self.instructions.run(Both(self, ray))
    }
}

/// Both searches for one ray.
struct Both<'a>(&'a Wide, &'a Ray);

impl Vectorized for Both<'_> {
    type Output = (Option<PrimitiveHit>, bool);

    #[inline(always)]
    fn run<L: Level>(self, level: L) -> Self::Output {
        let Both(wide, ray) = self;
        let mut probe = Triangles { wide, ray: WideRay::new(ray), level, certain: 0, counts: [0; 3] };
        let closest = stage12_search::wide_closest_hit(&mut probe, ray);
        (closest, stage12_search::wide_any_hit(&mut probe, ray))
    }
}

impl Contestant for Wide {
    fn trace(&self, rays: &[Ray], any: bool, found: &mut [f32]) {
        self.instructions.run(Work(self, rays, any, found, &mut [0; 3]));
    }
}

/// Searches for all rays, closest hits or any, with the answers and the counts.
struct Work<'a>(&'a Wide, &'a [Ray], bool, &'a mut [f32], &'a mut [u64; 3]);

impl Vectorized for Work<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Level>(self, level: L) {
        let Work(wide, rays, any, found, counts) = self;
        for (ray, found) in rays.iter().zip(found) {
            let mut probe = Triangles { wide, ray: WideRay::new(ray), level, certain: 0, counts: [0; 3] };
            *found = if any {
                of_any(stage12_search::wide_any_hit(&mut probe, ray))
            } else {
                stage12_search::wide_closest_hit(&mut probe, ray).map_or(f32::INFINITY, |hit| hit.t)
            };
            (0..3).for_each(|i| counts[i] += probe.counts[i]);
        }
    }
}

/// Answers the questions of a search, and counts them: node visits, blocks and exact tests.
struct Triangles<'a, L> {
    wide: &'a Wide,
    ray: WideRay,
    level: L,
    /// The lanes of the last block that the ray passes through for certain.
    certain: u32,
    counts: [u64; 3],
}

impl<L: Level> WideProbe for Triangles<'_, L> {
    #[inline(always)]
    fn enter(&mut self, node: u32, t_max: f32) -> Entered {
        self.counts[0] += 1;
        stage12_simd::enter_boxes(self.level, &self.wide.nodes[node as usize], &self.ray, t_max)
    }

    #[inline(always)]
    fn children(&self, node: u32) -> &[Child; 8] {
        &self.wide.nodes[node as usize].children
    }

    #[inline(always)]
    fn candidates(&mut self, block: u32, n: u32, t_max: f32) -> u32 {
        self.counts[1] += 1;
        let lanes = (1 << n) - 1;
        if !self.ray.in_range {
            self.certain = 0;
            return lanes;
        }
        let Filtered { possible, certain } =
            stage12_simd::may_hit(self.level, &self.wide.blocks[block as usize], &self.ray, t_max);
        self.certain = certain;
        lanes & possible
    }

    #[inline(always)]
    fn hit(&mut self, block: u32, lane: u32, ray: &Ray) -> Option<PrimitiveHit> {
        let block = &self.wide.blocks[block as usize];
        let lane = lane as usize & 7;
        if self.certain >> lane & 1 == 1
            && let Some(t) = block.t_of_plane(lane, ray)
        {
            return ray.contains(t).then_some(PrimitiveHit { t, primitive: block.ids[lane] });
        }
        self.counts[2] += 1;
        let mut triangle = block.triangle(lane);
        if triangle.a.x.is_nan() {
            triangle = self.wide.large[&block.ids[lane]];
        }
        let hit = stage10_stability::watertight(ray, &triangle)?;
        Some(PrimitiveHit { t: hit.t, primitive: block.ids[lane] })
    }
}

/// The point at `t`, a little off the surface towards `normal`.
pub fn off_surface(ray: &Ray, t: f32, normal: Vec3) -> Vec3 {
    ray.at(t) + 1e-4 * t.max(1e-3) * normal
}
