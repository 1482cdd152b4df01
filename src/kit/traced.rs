//! The rays behind one pixel, as data.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Why a ray was traced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RayKind {
    /// From the camera.
    Primary,
    /// Off a mirror.
    Reflection,
    /// Through a surface.
    Transmission,
    /// To a light.
    Shadow,
}

/// A ray that was traced for a pixel.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TracedRay {
    /// Why.
    pub kind: RayKind,
    /// Index of the ray that it goes on from; `None` for a ray from the camera.
    pub parent: Option<usize>,
    /// Mirrorings and refractions behind it.
    pub depth: u32,
    /// What the light that it finds counts in the pixel.
    pub weight: Vec3,
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes.
    pub dir: Vec3,
    /// How far it goes, in lengths of `dir`, and the name of the material there; a shadow ray says only
    /// whether it is stopped, at `t` 0 and by no name.
    pub hit: Option<(f32, String)>,
}
