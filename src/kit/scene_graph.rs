//! Stage 8, the scene graph and other shapes: queries and answers.

use super::{SearchAnswer, Table};
use crate::aabb::Aabb;
use crate::graph::{ChildCache, Graph, Savings};
use crate::ray::Ray;
use crate::shape::{BezierPatch, NurbsPatch, Sphere};
use glam::{Affine3A, Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// Asks which ray in the space of an object corresponds to `ray`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ObjectRayQuery {
    /// The ray in world space, of any direction but zero.
    pub ray: Ray,
    /// The transform from the world to the space of the object.
    pub to_object: Affine3A,
}

/// Asks which normal in the world corresponds to a normal of an object.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NormalQuery {
    /// The unit normal in the space of the object.
    pub normal: Vec3,
    /// The transform from the world to the space of the object.
    pub to_object: Affine3A,
}

/// Asks which box in the world contains a transformed box.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoundsQuery {
    /// The transform from the space of the box to the world.
    pub to_world: Affine3A,
    /// The closed box before the transform; it may be empty.
    pub bounds: Aabb,
}

/// Asks where `ray` hits `solid`; the answer is a [`SolidHit`](super::SolidHit) if there is a hit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SolidQuery<S> {
    /// The ray, in the space of the solid; its range says which hits count.
    pub ray: Ray,
    /// A box, cylinder, cone, disk or polygon.
    pub solid: S,
}

/// Asks where `ray` enters a bounding sphere; the answer is a `t` if it does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoundingSphereQuery {
    /// The ray; its range says where an entry counts.
    pub ray: Ray,
    /// The bounding sphere, which is closed.
    pub sphere: Sphere,
}

/// Asks for the closest hit in `graph`, with a table that has the answer to every call of the search. The
/// answer is a [`GraphAnswer`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GraphQuery {
    /// The scene graph that is searched.
    pub graph: Graph,
    /// The ray, whose range says which hits count. Its origin and direction play no role, because the table
    /// answers.
    pub ray: Ray,
    /// The optimisations that the search uses.
    pub savings: Savings,
    /// The answers to all calls; its boxes are the bounding volumes of the nodes.
    pub table: Table,
}

/// The result of a search of a scene graph, and the order of its primitive tests.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GraphAnswer {
    /// The hit and the cost of the search.
    pub search: SearchAnswer,
    /// The numbers of the primitives that were tested, in order.
    pub asked: Vec<u32>,
}

/// Asks for the closest hit in a scene graph with a cache in each node. The answer is a [`CachedGraphAnswer`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CachedGraphQuery {
    /// The graph, the ray and the answers to all calls of the search.
    pub search: GraphQuery,
    /// The cache before the search. Each entry is a child of its node.
    pub cache: ChildCache,
}

/// The result of a search of a scene graph with a cache in each node.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CachedGraphAnswer {
    /// The hit, the cost and the order of the primitive tests.
    pub found: GraphAnswer,
    /// The cache after the search.
    pub cache: ChildCache,
}

/// Asks which point of a Bézier patch has the parameters `uv`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PatchQuery {
    /// The control net of the patch.
    pub patch: BezierPatch,
    /// The parameters `u` along the rows and `v` along the columns of the net, `0..=1` each.
    pub uv: Vec2,
}

/// Asks for the value of a B-spline basis function.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BasisQuery {
    /// The knots, which never descend.
    pub knots: Vec<f32>,
    /// The degree of the function.
    pub degree: usize,
    /// The number of the function: its support begins at `knots[index]` and ends at `knots[index + degree + 1]`.
    pub index: usize,
    /// The parameter, within the domain of the knots.
    pub u: f32,
}

/// Asks which point of a NURBS surface has the parameters `uv`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct NurbsQuery {
    /// The surface.
    pub patch: NurbsPatch,
    /// The parameters `u` along the rows and `v` along the columns of the net, within the domains of the knots.
    pub uv: Vec2,
}
