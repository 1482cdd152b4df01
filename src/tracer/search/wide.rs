//! The wide tree of stage 12 over a set of primitives: eight boxes and eight triangles are tested at once.

use super::primitives::Primitives;
use crate::aabb::Aabb;
use crate::bvh::PrimitiveHit;
use crate::count::Event;
use crate::kit::{StructureSize, StudentFunctions};
use crate::ray::Ray;
use crate::scene::{Quality, Split};
use crate::shape::Triangle;
use crate::tracer::plan::WidePlan;
use crate::wide::simd::{Instructions, Level, Vectorized};
use crate::wide::{
    Child, ChildContents, Entered, Filtered, FlatTree, Forks, MAX_LEAF, TriangleBlock, WIDE_NODE_COST,
    WIDE_NODE_COST_OF_OBJECTS, WideNode, WideProbe, WideRay,
};
use rayon::prelude::*;
use std::marker::PhantomData;

/// A wide tree with the triangles of its leaves.
#[derive(Debug)]
pub struct Wide {
    /// The nodes; empty if there are no primitives.
    pub nodes: Vec<WideNode>,
    /// The blocks of all leaves.
    blocks: Vec<TriangleBlock>,
    /// The instructions of this processor.
    instructions: Instructions,
}

impl Wide {
    /// Builds a wide tree over primitives with the bounding boxes `bounds`, by the functions of `plan`.
    ///
    /// `triangle` returns a primitive that is a triangle, can be hit from both sides and does not move. The threads are those
    /// of the pool that calls this function.
    pub fn build<F: StudentFunctions>(
        bounds: &[Aabb],
        triangle: impl Fn(u32) -> Option<Triangle> + Sync,
        plan: WidePlan,
        quality: &Quality,
    ) -> Wide {
        // Build a binary tree. Only the surface area heuristic has a builder of stage 12.
        let by_area = quality.split == Split::SurfaceArea;
        let tree: FlatTree = if by_area && plan.parallel {
            F::build_parallel(bounds, &mut Forks::new(rayon::current_num_threads() > 1))
        } else if by_area && plan.binned {
            F::build_binned(bounds)
        } else {
            F::flatten(&F::build(bounds, quality.split, (quality.leaf_size as usize).min(MAX_LEAF)))
        };
        // Collapse it by the cost of what most primitives are, and copy the triangles into the blocks.
        let n_triangles = (0..bounds.len() as u32).filter(|&index| triangle(index).is_some()).count();
        let is_mesh = 2 * n_triangles > bounds.len();
        let wide = F::collapse(&tree, if is_mesh { WIDE_NODE_COST } else { WIDE_NODE_COST_OF_OBJECTS });
        drop(tree);
        let block = |&ids: &_| TriangleBlock::new(ids, &triangle);
        let blocks = if rayon::current_num_threads() > 1 {
            wide.blocks.par_iter().map(block).collect()
        } else {
            wide.blocks.iter().map(block).collect()
        };
        Wide { nodes: wide.nodes, blocks, instructions: Instructions::detect() }
    }

    /// The closest hit of `ray` with the primitives of `probe` within its range, or `None`.
    #[inline(always)]
    pub fn closest_hit<F: StudentFunctions, P: Primitives>(
        &self,
        probe: &mut P,
        ray: &Ray,
    ) -> Option<PrimitiveHit> {
        if self.nodes.is_empty() {
            return None;
        }
        self.instructions.run(Closest::<F, P> { wide: self, functions: PhantomData, probe, ray })
    }

    /// Whether `ray` hits any primitive of `probe` within its range.
    #[inline(always)]
    pub fn any_hit<F: StudentFunctions, P: Primitives>(&self, probe: &mut P, ray: &Ray) -> bool {
        !self.nodes.is_empty()
            && self.instructions.run(Any::<F, P> { wide: self, functions: PhantomData, probe, ray })
    }

    /// The boxes at depth `depth`, and those of leaves above it. The root has depth 0.
    pub fn boxes_at(&self, depth: usize) -> Vec<Aabb> {
        let Some(root) = self.nodes.first() else { return Vec::new() };
        let children = |node: &WideNode| {
            (0..node.n_children() as usize)
                .map(|i| (node.child_bounds(i), node.children[i]))
                .collect::<Vec<_>>()
        };
        let around = children(root)
            .iter()
            .fold(Aabb::EMPTY, |all, (one, _)| Aabb::new(all.min.min(one.min), all.max.max(one.max)));
        let mut level = vec![(around, Child::ROOT)];
        for _ in 0..depth {
            let below = level.into_iter().flat_map(|(bounds, child)| match child.contents() {
                ChildContents::Inner(node) => children(&self.nodes[node as usize]),
                ChildContents::Leaf { .. } => vec![(bounds, child)],
            });
            level = below.collect();
        }
        level.into_iter().map(|(bounds, _)| bounds).collect()
    }

    /// The number of nodes and leaves, of levels, of references to primitives, and of bytes.
    pub fn size(&self) -> StructureSize {
        let (mut nodes, mut levels, mut references) = (0, 0, 0);
        let mut waiting: Vec<(Child, u64)> =
            self.nodes.first().map(|_| (Child::ROOT, 1)).into_iter().collect();
        while let Some((child, level)) = waiting.pop() {
            nodes += 1;
            levels = level.max(levels);
            match child.contents() {
                ChildContents::Leaf { count, .. } => references += u64::from(count),
                ChildContents::Inner(node) => {
                    let node = &self.nodes[node as usize];
                    let children = &node.children[..node.n_children() as usize];
                    waiting.extend(children.iter().map(|&child| (child, level + 1)));
                }
            }
        }
        let bytes = size_of_val(self.nodes.as_slice()) + size_of_val(self.blocks.as_slice());
        StructureSize { nodes, levels, references, bytes: bytes as u64 }
    }
}

/// The search of a closest hit, for each level of instructions.
struct Closest<'s, F, P> {
    wide: &'s Wide,
    functions: PhantomData<F>,
    probe: &'s mut P,
    ray: &'s Ray,
}

impl<F: StudentFunctions, P: Primitives> Vectorized for Closest<'_, F, P> {
    type Output = Option<PrimitiveHit>;

    #[inline(always)]
    fn run<L: Level>(self, level: L) -> Self::Output {
        F::wide_closest_hit(&mut TreeProbe::<F, P, L>::new(self.wide, self.probe, self.ray, level), self.ray)
    }
}

/// The search of any hit, for each level of instructions.
struct Any<'s, F, P> {
    wide: &'s Wide,
    functions: PhantomData<F>,
    probe: &'s mut P,
    ray: &'s Ray,
}

impl<F: StudentFunctions, P: Primitives> Vectorized for Any<'_, F, P> {
    type Output = bool;

    #[inline(always)]
    fn run<L: Level>(self, level: L) -> bool {
        F::wide_any_hit(&mut TreeProbe::<F, P, L>::new(self.wide, self.probe, self.ray, level), self.ray)
    }
}

/// Answers the questions of a search in a wide tree over the primitives of `probe`, and counts them.
struct TreeProbe<'s, F, P, L> {
    wide: &'s Wide,
    probe: &'s mut P,
    ray: WideRay,
    /// Whether `may_hit` sorts out triangles for this ray.
    sorts_out: bool,
    /// The lanes of the last block that the ray passes through for certain.
    certain: u32,
    level: L,
    functions: PhantomData<F>,
}

impl<'s, F: StudentFunctions, P: Primitives, L: Level> TreeProbe<'s, F, P, L> {
    #[inline(always)]
    fn new(wide: &'s Wide, probe: &'s mut P, ray: &Ray, level: L) -> Self {
        let ray = WideRay::new(ray);
        let sorts_out = ray.in_range && probe.may_sort_out();
        TreeProbe { wide, probe, ray, sorts_out, certain: 0, level, functions: PhantomData }
    }
}

impl<F: StudentFunctions, P: Primitives, L: Level> WideProbe for TreeProbe<'_, F, P, L> {
    #[inline(always)]
    fn enter(&mut self, node: u32, t_max: f32) -> Entered {
        self.probe.count(Event::NodeVisit);
        let node = &self.wide.nodes[node as usize];
        let entered = F::enter_boxes(self.level, node, &self.ray, t_max);
        if P::COUNTS {
            // The children come first, then the empty places.
            for child in 0..node.n_children() {
                self.probe.count(Event::BoxTest);
                self.probe.tested(|| node.child_bounds(child as usize), entered.mask & 1 << child != 0);
            }
        }
        entered
    }

    #[inline(always)]
    fn children(&self, node: u32) -> &[Child; 8] {
        &self.wide.nodes[node as usize].children
    }

    #[inline(always)]
    fn candidates(&mut self, block: u32, n: u32, t_max: f32) -> u32 {
        self.probe.count(Event::NodeVisit);
        if P::COUNTS {
            for _ in 0..n {
                self.probe.count(Event::PrimitiveTest);
            }
        }
        let lanes = (1 << n) - 1;
        if !self.sorts_out {
            return lanes;
        }
        let Filtered { possible, certain } =
            F::may_hit(self.level, &self.wide.blocks[block as usize], &self.ray, t_max);
        // Another test may round t otherwise.
        self.certain = if self.probe.is_watertight() { certain } else { 0 };
        lanes & possible
    }

    #[inline(always)]
    fn hit(&mut self, block: u32, lane: u32, ray: &Ray) -> Option<PrimitiveHit> {
        let block = &self.wide.blocks[block as usize];
        let lane = lane as usize & 7;
        let primitive = block.ids[lane];
        // Where the ray passes through the inside for certain, compute only t.
        if self.certain >> lane & 1 == 1
            && let Some(t) = block.t_of_plane(lane, ray)
        {
            return ray.contains(t).then_some(PrimitiveHit { t, primitive });
        }
        // Take the corners from the block, which is in the cache. Other shapes are looked up.
        let triangle = block.triangle(lane);
        let t = if self.sorts_out && !triangle.a.x.is_nan() {
            self.probe.hit_triangle(primitive, &triangle, ray)?
        } else {
            self.probe.hit_uncounted(primitive, ray)?
        };
        Some(PrimitiveHit { t, primitive })
    }
}
