//! Stage 7, the effects analysis: queries and answers.

use crate::effects::Effects;
use crate::material::{Light, Material, Texture, Wrap};
use crate::scene::{Quality, Scene};
use glam::Vec2;
use serde::{Deserialize, Serialize};

/// Asks what a light needs; the answer is its [`LightEffects`](crate::effects::LightEffects).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightQuery {
    /// The light that is analysed.
    pub light: Light,
    /// The quality parameters of the scene.
    pub quality: Quality,
}

/// Asks what a material needs; the answer is its [`MaterialEffects`](crate::effects::MaterialEffects).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MaterialQuery {
    /// The material that is analysed.
    pub material: Material,
    /// All lights of the scene, by index.
    pub lights: Vec<Light>,
    /// The quality parameters of the scene.
    pub quality: Quality,
}

/// The number of rays of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct RayCounts {
    /// The number of rays from the camera.
    pub primary: u64,
    /// The number of shadow rays.
    pub shadow: u64,
    /// The number of reflected rays.
    pub reflection: u64,
    /// The number of refracted rays.
    pub transmission: u64,
}

/// Asks how many rays a scene can need at most; the answer is [`RayCounts`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct BoundQuery {
    /// The scene that is analysed.
    pub scene: Scene,
    /// The effects that the scene needs.
    pub effects: Effects,
}

/// The hits of rays with surfaces of one material.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MaterialHits {
    /// The index of the material.
    pub material: usize,
    /// The number of rays that hit the material.
    pub hits: u64,
    /// For each light of the scene: the number of sampled points of the light, over all hits, that lie in
    /// front of the surface.
    pub in_front: Vec<u64>,
}

/// Asks how many rays of each kind these hits need; the answer is [`RayCounts`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct HitsQuery {
    /// The hits, by material.
    pub hits: Vec<MaterialHits>,
    /// The effects that the scene needs.
    pub effects: Effects,
    /// The quality parameters of the scene.
    pub quality: Quality,
}

/// Asks which column or row of an image is shown at an index that may lie outside of the image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct TexelQuery {
    /// The column or row, any number; those of the image are `0 <= index < size`.
    pub index: i64,
    /// The number of columns or rows of the image, at least 1.
    pub size: u32,
    /// What the image shows outside of its borders.
    pub wrap: Wrap,
}

/// Asks which colour an image has at a texture coordinate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct TextureQuery {
    /// The image, in linear light.
    pub texture: Texture,
    /// The texture coordinate: `(0, 0)` is the lower left corner of the image and `(1, 1)` the upper right
    /// one. Any number is allowed, NaN and infinity included.
    pub uv: Vec2,
}
