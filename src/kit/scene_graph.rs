//! Stage 8, the scene graph and other shapes: queries and answers.

use super::{SearchAnswer, Table};
use crate::graph::{ChildCache, Graph, GraphOptimisations};
use crate::message;
use crate::ray::Ray;

/// Asks where `ray` hits `solid`; the answer is a [`SolidHit`](super::SolidHit) if there is a hit.
#[derive(Clone, Debug, PartialEq)]
pub struct SolidQuery<S> {
    /// The ray, in the space of the solid; its range says which hits count.
    pub ray: Ray,
    /// A box, cylinder, cone, disk or polygon.
    pub solid: S,
}

message! { SolidQuery<S> { ray, solid } }

/// Asks for the closest hit in `graph`, with a table that has the answer to every call of the search. The
/// answer is a [`GraphAnswer`].
#[derive(Clone, Debug, PartialEq)]
pub struct GraphQuery {
    /// The scene graph that is searched.
    pub graph: Graph,
    /// The ray, whose range says which hits count. Its origin and direction play no role, because the table
    /// answers.
    pub ray: Ray,
    /// The optimisations that the search uses.
    pub savings: GraphOptimisations,
    /// The answers to all calls; its boxes are the bounding volumes of the nodes.
    pub table: Table,
}

message! { GraphQuery { graph, ray, savings, table } }

/// The result of a search of a scene graph, and the order of its primitive tests.
#[derive(Clone, Debug, PartialEq)]
pub struct GraphAnswer {
    /// The hit and the cost of the search.
    pub search: SearchAnswer,
    /// The numbers of the primitives that were tested, in order.
    pub asked: Vec<u32>,
}

message! { GraphAnswer { search, asked } }

/// Asks for the closest hit in a scene graph with a cache in each node. The answer is a [`CachedGraphAnswer`].
#[derive(Clone, Debug, PartialEq)]
pub struct CachedGraphQuery {
    /// The graph, the ray and the answers to all calls of the search.
    pub search: GraphQuery,
    /// The cache before the search. Each entry is a child of its node.
    pub cache: ChildCache,
}

message! { CachedGraphQuery { search, cache } }

/// The result of a search of a scene graph with a cache in each node.
#[derive(Clone, Debug, PartialEq)]
pub struct CachedGraphAnswer {
    /// The hit, the cost and the order of the primitive tests.
    pub found: GraphAnswer,
    /// The cache after the search.
    pub cache: ChildCache,
}

message! { CachedGraphAnswer { found, cache } }
