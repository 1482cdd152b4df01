//! What a search with many rays at once may ask (stage 12, bonus).

use super::{Child, Entered};
use crate::bvh::PrimitiveHit;
use crate::ray::Ray;

/// The largest number of rays in a stream: as many as a mask of 64 bits has.
pub const STREAM: usize = 64;

/// The node or the block of the last call, from which follows what a call fetches.
#[derive(Debug, Default)]
pub(crate) struct LastFetch(Option<(bool, u32)>);

impl LastFetch {
    /// Whether a call about this node, or about this block, fetches it: the last call was about another one.
    #[inline(always)]
    pub(crate) fn fetches(&mut self, is_block: bool, index: u32) -> bool {
        self.0.replace((is_block, index)) != Some((is_block, index))
    }
}

/// All that a search of a wide tree with several rays may ask. Rays have the numbers `0..rays.len()`.
///
/// Each call is counted. A call about another node, or about another block, than the call before *fetches* it from memory, and each
/// fetch is counted as well: calls for several rays about the same node, one after the other, fetch it once.
pub trait StreamProbe {
    /// Which children of `node` this ray enters at `t_max` or before.
    fn enter(&mut self, ray: u32, node: u32, t_max: f32) -> Entered;

    /// The children of `node`, whose boxes [`StreamProbe::enter`] has tested.
    fn children(&self, node: u32) -> &[Child; 8];

    /// The lanes among the first `n` of `block` that this ray may hit before `t_max`, as bits: a lane without its bit is not
    /// hit.
    fn candidates(&mut self, ray: u32, block: u32, n: u32, t_max: f32) -> u32;

    /// The hit of this ray with the primitive in `lane` of `block`, or `None` if there is no hit with
    /// `shortened.t_min < t < shortened.t_max`. `shortened` is the ray, which may end earlier.
    fn hit(&mut self, ray: u32, block: u32, lane: u32, shortened: &Ray) -> Option<PrimitiveHit>;
}
