//! Stage 8 · the scene graph with a cache in each node: the child that the previous ray hit is
//! searched first.
//!
//! Slides: `slides/stage08.md`.
//!
//! Given: [`Graph`]; [`ChildCache`] with `get` and `set`; [`Probe`] with `enter` and `hit`.

use raykata::bvh::{PrimitiveHit, Probe};
use raykata::graph::{ChildCache, Graph, GraphOptimisations};
use raykata::ray::Ray;

/// Like `closest_hit_in_graph`, but each node visits first the child in which the previous ray had
/// its closest hit. A near hit that is found early lets the search skip more. What happens when it
/// is this child's own turn?
///
/// Exactly:
///
/// 1. `cache` has an entry per node: one of its children, or `None`. The hit is the same for all
///    contents.
/// 2. Visit the cached child after the node's own primitives and before the other children, and
///    those as `savings` says.
/// 3. Call `probe.enter` at most once per node, and test each primitive at most once.
/// 4. In the end, each node on the path from the root to the node with the closest hit has stored
///    the child on this path. Other entries may stay or change.
///
/// Source: "Ray-Scene Intersection" (coherence).
pub fn closest_hit_with_child_cache(
    graph: &Graph,
    probe: &mut impl Probe,
    ray: &Ray,
    savings: GraphOptimisations,
    cache: &mut ChildCache,
) -> Option<PrimitiveHit> {
    todo!("visit the cached child first, then the others, and store the child with the closest hit")
}
