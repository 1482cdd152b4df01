//! Stage 7 in plain data.

use crate::effects::Effects;
use crate::material::{Light, Material, Texture, Wrap};
use crate::scene::{Quality, Scene};
use glam::Vec2;
use serde::{Deserialize, Serialize};

/// What does this light take?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightQuery {
    /// The light.
    pub light: Light,
    /// The knobs.
    pub quality: Quality,
}

/// What does this material take?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MaterialQuery {
    /// The material.
    pub material: Material,
    /// All lights of the scene.
    pub lights: Vec<Light>,
    /// The knobs.
    pub quality: Quality,
}

/// Rays by kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RayCounts {
    /// From the camera.
    pub primary: u64,
    /// To lights.
    pub shadow: u64,
    /// Off mirrors.
    pub reflection: u64,
    /// Through surfaces.
    pub transmission: u64,
}

/// How many rays can a scene take at most?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoundQuery {
    /// The scene.
    pub scene: Scene,
    /// What it calls for.
    pub effects: Effects,
}

/// Hits on one material.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MaterialHits {
    /// Index of the material.
    pub material: usize,
    /// How many rays hit it.
    pub hits: u64,
    /// For each light: how many places on the lamp, over all hits, lie on the lit side of the surface.
    pub in_front: Vec<u64>,
}

/// Which rays do these hits send on?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HitsQuery {
    /// What was hit.
    pub hits: Vec<MaterialHits>,
    /// What the scene calls for.
    pub effects: Effects,
    /// The knobs.
    pub quality: Quality,
}

/// Which column or row of an image?
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TexelQuery {
    /// Counted from the first one, and past either end.
    pub index: i64,
    /// How many there are, at least 1.
    pub size: u32,
    /// What lies outside.
    pub wrap: Wrap,
}

/// Which colour?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TextureQuery {
    /// The image.
    pub texture: Texture,
    /// `(0, 0)` is the lower left corner of the image, `(1, 1)` the upper right one.
    pub uv: Vec2,
}
