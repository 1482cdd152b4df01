//! The rays of one pixel, and what is visited to find their hits, as data.

use crate::aabb::Aabb;
use crate::message;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// The purpose for which a ray was traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RayKind {
    /// A ray from the camera.
    Primary,
    /// A reflected ray.
    Reflection,
    /// A ray refracted through a surface.
    Transmission,
    /// A ray in a random direction from a diffuse surface (indirect light).
    Indirect,
    /// A shadow ray to a light.
    Shadow,
}

message! { enum RayKind { Primary, Reflection, Transmission, Indirect, Shadow } }

/// A ray that was traced for a pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TracedRay {
    /// The purpose for which the ray was traced.
    pub kind: RayKind,
    /// The index of the ray at whose hit this ray starts; `None` for a ray from the camera.
    pub parent: Option<usize>,
    /// The number of reflections and refractions before this ray; a shadow ray has that of its parent.
    pub depth: u32,
    /// The factor, per channel, with which the light along the ray contributes to the pixel.
    pub weight: Vec3,
    /// The origin of the ray, in world units.
    pub origin: Vec3,
    /// The direction of the ray, of any length but zero.
    pub direction: Vec3,
    /// The `t` of the hit, in lengths of `direction`, and the name of the material there; `None` if nothing is hit.
    /// An occluded shadow ray has `t` 0 and an empty name.
    pub hit: Option<(f32, String)>,
}

message! { TracedRay { kind, parent, depth, weight, origin, direction, hit } }

/// What the search for the hit of one ray visits.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RayVisits {
    /// The number of nodes or cells whose contents the search looked at.
    pub node_visits: u64,
    /// The number of tests against bounding volumes.
    pub box_tests: u64,
    /// The number of tests against primitives.
    pub primitive_tests: u64,
    /// The tested boxes of the structure over the scene, in the order of the tests. Boxes within shared meshes are left out,
    /// because they are in another space. Grids, octrees, kd-trees, BSP trees and bounding spheres have
    /// none.
    pub boxes: Vec<TestedBox>,
}

message! { RayVisits { node_visits, box_tests, primitive_tests, boxes } }

/// A box that was tested.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TestedBox {
    /// The box, in world units.
    pub bounds: Aabb,
    /// Whether the ray enters it.
    pub hit: bool,
}

message! { TestedBox { bounds, hit } }
