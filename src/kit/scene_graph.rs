//! Stage 8 in plain data.

use super::{SearchAnswer, Table};
use crate::aabb::Aabb;
use crate::graph::{Graph, Savings};
use crate::ray::Ray;
use crate::shape::{BezierPatch, Sphere};
use glam::{Affine3A, Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// Carry `ray` into the space of an object.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ObjectRayQuery {
    /// The ray in the world.
    pub ray: Ray,
    /// From the world to the space of the object.
    pub to_object: Affine3A,
}

/// Carry the normal of an object into the world.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct NormalQuery {
    /// Unit normal in the space of the object.
    pub normal: Vec3,
    /// From the world to the space of the object.
    pub to_object: Affine3A,
}

/// Which box after a transform?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoundsQuery {
    /// From the space of the box to the world.
    pub to_world: Affine3A,
    /// The box.
    pub bounds: Aabb,
}

/// Where does `ray` meet `solid`?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SolidQuery<S> {
    /// The ray, in the space of the solid.
    pub ray: Ray,
    /// A box, cylinder, cone, disk or polygon.
    pub solid: S,
}

/// Where a ray meets the surface of a solid.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SolidHit {
    /// Distance along the ray, in lengths of its direction.
    pub t: f32,
    /// Unit normal there, out of the solid; that of a disk is its own, and that of a polygon points to where its corners
    /// run anticlockwise.
    pub normal: Vec3,
}

/// Where does `ray` enter the ball?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BallEntryQuery {
    /// The ray.
    pub ray: Ray,
    /// The ball.
    pub ball: Sphere,
}

/// Find a hit in `graph`, given the answers to every question that the search may ask.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GraphQuery {
    /// What to search.
    pub graph: Graph,
    /// Which `t` count. Its origin and direction play no part: the table answers.
    pub ray: Ray,
    /// What to save.
    pub savings: Savings,
    /// The answers; its boxes are the volumes around the nodes.
    pub table: Table,
}

/// What the search of a graph found, and in which order it asked.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct GraphAnswer {
    /// The hit and what it cost.
    pub search: SearchAnswer,
    /// The primitives in the order in which they were asked about.
    pub asked: Vec<u32>,
}

/// Which point of a patch?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PatchQuery {
    /// The patch.
    pub patch: BezierPatch,
    /// Where on it, `0..=1` along either side.
    pub uv: Vec2,
}
