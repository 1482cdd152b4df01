//! The search of a wide tree with a stream of rays (stage 12, bonus).

use super::probe::SceneProbe;
use super::wide::{Wide, WideSceneProbe};
use crate::bvh::PrimitiveHit;
use crate::count::{Event, Tally};
use crate::kit::StudentFunctions;
use crate::ray::Ray;
use crate::wide::simd::{Level, Vectorized};
use crate::wide::{Child, Entered, LastFetch, StreamProbe, WideProbe, WideRay};

/// The search of the closest hits of several rays, for each level of instructions.
pub(super) struct ClosestOfStream<'s, 'p, 'w, F, T> {
    pub wide: &'s Wide,
    pub probe: &'s mut SceneProbe<'p, F, T>,
    pub rays: &'w [Ray],
}

impl<F: StudentFunctions, T: Tally> Vectorized for ClosestOfStream<'_, '_, '_, F, T> {
    type Output = Vec<Option<PrimitiveHit>>;

    #[inline(always)]
    fn run<L: Level>(self, level: L) -> Self::Output {
        let ClosestOfStream { wide, probe, rays } = self;
        let Some(first) = rays.first() else { return Vec::new() };
        let prepared: Vec<WideRay> = rays.iter().map(WideRay::new).collect();
        let one = WideSceneProbe::new(wide, probe, first, level);
        F::stream_closest_hits(
            &mut StreamSceneProbe { one, rays: &prepared, last: LastFetch::default() },
            rays,
        )
    }
}

/// Answers the questions of a search with several rays. A visit of a node or a block is counted once for all calls about it that
/// follow each other.
struct StreamSceneProbe<'s, 'p, 'w, F, T, L> {
    one: WideSceneProbe<'s, 'p, F, T, L>,
    rays: &'w [WideRay],
    last: LastFetch,
}

impl<F: StudentFunctions, T: Tally, L: Level> StreamSceneProbe<'_, '_, '_, F, T, L> {
    /// Makes `ray` the ray of the next call, and counts a visit unless the last call was about the same node or block.
    #[inline(always)]
    fn select(&mut self, ray: u32, is_block: bool, index: u32) {
        self.one.select(&self.rays[ray as usize]);
        if self.last.fetches(is_block, index) {
            self.one.probe.note(Event::NodeVisit);
        }
    }
}

impl<F: StudentFunctions, T: Tally, L: Level> StreamProbe for StreamSceneProbe<'_, '_, '_, F, T, L> {
    #[inline(always)]
    fn enter(&mut self, ray: u32, node: u32, t_max: f32) -> Entered {
        self.select(ray, false, node);
        self.one.enter_uncounted(node, t_max)
    }

    #[inline(always)]
    fn children(&self, node: u32) -> &[Child; 8] {
        self.one.children(node)
    }

    #[inline(always)]
    fn candidates(&mut self, ray: u32, block: u32, n: u32, t_max: f32) -> u32 {
        self.select(ray, true, block);
        self.one.candidates_uncounted(block, n, t_max)
    }

    #[inline(always)]
    fn hit(&mut self, ray: u32, block: u32, lane: u32, shortened: &Ray) -> Option<PrimitiveHit> {
        self.select(ray, true, block);
        self.one.hit(block, lane, shortened)
    }
}
