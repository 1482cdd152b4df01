//! Stage 8 · the scene graph with a cache in each node: the child that the previous ray hit is
//! searched first.
//!
//! Slides: `slides/stage08.md`.
//!
//! Given: [`Graph`]; [`ChildCache`] with `get` and `set`; [`Probe`] with `enter` and `hit`.

use raykata::bvh::{PrimitiveHit, Probe};
use raykata::graph::{ChildCache, Graph, GraphOptimisations};
use raykata::ray::Ray;

// <solution>
use crate::stage3_traversal::{keep_closest, nearer};
// </solution>

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
    // <solution>
    let mut search = CachedSearch { graph, savings, cache, ray: *ray, closest: None };
    if !graph.nodes.is_empty() && search.enter(0, probe).is_some() {
        search.node(0, probe);
    }
    search.closest
    // <stub> todo!("visit the cached child first, then the others, and store the child with the closest hit")
    // </solution>
}

// <solution>
/// The state of a search.
struct CachedSearch<'a> {
    graph: &'a Graph,
    savings: GraphOptimisations,
    cache: &'a mut ChildCache,
    /// The ray. With `skip`, its range ends one float beyond the closest hit.
    ray: Ray,
    closest: Option<PrimitiveHit>,
}

/// A node that the ray enters at `t`.
struct Entered {
    t: f32,
    node: u32,
}

impl CachedSearch<'_> {
    /// Where the ray enters a node; without `volumes` it enters every node at its start.
    fn enter(&self, node: u32, probe: &mut impl Probe) -> Option<f32> {
        if self.savings.volumes { probe.enter(node, &self.ray) } else { Some(self.ray.t_min) }
    }

    /// Visits a node and the nodes below it.
    fn node(&mut self, index: u32, probe: &mut impl Probe) {
        // Test the node's own primitives.
        let graph = self.graph;
        let node = &graph.nodes[index as usize];
        for &primitive in &node.primitives {
            let Some(t) = probe.hit(primitive, &self.ray) else { continue };
            let hit = PrimitiveHit { t, primitive };
            if self.savings.skip {
                keep_closest(&mut self.closest, &mut self.ray, hit);
            } else {
                self.closest = nearer(self.closest, Some(hit));
            }
        }
        // Visit the cached child, if the ray enters it.
        let cached = self.cache.get(index);
        if let Some(child) = cached
            && self.enter(child, probe).is_some()
        {
            self.child(index, child, probe);
        }
        // Leave out the cached child, because its primitives must not be tested twice.
        // Collect the other children that the ray enters, and sort them by their entry.
        let others = node.children.iter().copied().filter(|child| Some(*child) != cached);
        let enter = |child: u32| Some(Entered { t: self.enter(child, probe)?, node: child });
        let mut entered: Vec<Entered> = others.filter_map(enter).collect();
        if self.savings.sort {
            entered.sort_by(|first, second| first.t.total_cmp(&second.t));
        }
        for child in entered {
            // Skip a child that begins beyond the closest hit, which an earlier child may have
            // changed.
            if child.t < self.ray.t_max {
                self.child(index, child.node, probe);
            }
        }
    }

    /// Visits a child of `node`, and stores it if it has the closest hit so far.
    fn child(&mut self, node: u32, child: u32, probe: &mut impl Probe) {
        let before = self.closest;
        self.node(child, probe);
        if self.closest != before {
            self.cache.set(node, child);
        }
    }
}
// </solution>
