//! Stage 8 · the scene graph with a cache in each node: the child that the previous ray hit is searched first.
//!
//! Slides: "Ray-Scene Intersection" (coherence: "for each node, store closest child from previous ray and check that node
//! first").
//!
//! Given: [`Graph`]; [`ChildCache`] with `get` and `set`; [`Probe`] with `enter` and `hit`.

use raykata::bvh::{PrimitiveHit, Probe};
use raykata::graph::{ChildCache, Graph, GraphOptimisations};
use raykata::ray::Ray;

/// Finds the closest hit of `ray` in a scene graph like `closest_hit_in_graph`, but visits first, in each node, the child
/// in which the previous ray had its closest hit. A near hit that is found early lets the search skip more of the other
/// children.
///
/// `cache` has an entry for each node: one of its children, or `None` at first. Visit this child after the node's own
/// primitives and before the other children, and those as `savings` says. At the end, store for each node on the path from
/// the root to the node with the closest hit the child on this path. Other entries may stay or change, and a ray without
/// a hit need not change any. The hit is the same for each content of the cache. As without a cache, call `probe.enter` at
/// most once per node, and test each primitive at most once.
///
/// Pitfall: the cached child is one of the children. If it is visited again in its turn, its primitives are tested twice.
///
/// What it saves: rays must be coherent, and the order must matter. With `sort`, the child that the ray enters first
/// usually has the closest hit, so nothing is left to save, and a cached child that the ray enters late costs tests. Volumes
/// are tested before their nodes are visited, and their number hardly changes. `raykata compare SCENE --of savings` counts both.
///
/// Slide: "Ray-Scene Intersection" (coherence).
pub fn closest_hit_with_child_cache(
    graph: &Graph,
    probe: &mut impl Probe,
    ray: &Ray,
    savings: GraphOptimisations,
    cache: &mut ChildCache,
) -> Option<PrimitiveHit> {
    todo!("visit the cached child first, then the others, and store the child with the closest hit")
}
