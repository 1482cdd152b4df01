//! The types in the signatures of the list of student functions, under the names that the list uses, and those of their fields.

pub use super::*;
pub use crate::aabb::Aabb;
pub use crate::bvh::{Bvh, Contents, Node, PrimitiveHit, PrimitiveRef, Probe};
pub use crate::camera::*;
pub use crate::effects::{Effects, LightEffects, MaterialEffects};
pub use crate::emitter::{AreaEmitter, EmitterSample, EmitterShape};
pub use crate::film::{Tone, ToneCurve};
pub use crate::graph::*;
pub use crate::light_path::*;
pub use crate::material::{Cone as SpotCone, *};
pub use crate::mesh::Mesh;
pub use crate::partition::*;
pub use crate::random::Stratum;
pub use crate::ray::Ray;
pub use crate::rows::Rows;
pub use crate::scene::{Node as SceneNode, *};
pub use crate::shape::{Cone, *};
pub use crate::wide::simd::{Instructions, Level, Vectorized};
pub use crate::wide::*;
pub use glam::{Affine3A, UVec3, Vec2, Vec3};
pub use std::sync::Arc;
