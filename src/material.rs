//! What surfaces do with light, and where light comes from. Data only.

use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The optical properties of a surface: `A·kd + Σ (I·kd·cosθ + I·ks·cosⁿφ) + Ks·mirror + Kr·refraction`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Material {
    /// Share of the scene's ambient light that comes back; as `diffuse` unless the scene says otherwise.
    pub ambient: Vec3,
    /// `kd`, the share of light that scatters evenly.
    pub diffuse: Vec3,
    /// `ks`, the strength of the highlight.
    pub specular: Vec3,
    /// `n`, the sharpness of the highlight, at least 0.
    pub exponent: f32,
    /// `Ks`, the weight of the mirror image (stage 5).
    pub mirror: Vec3,
    /// `Kr`, the weight of what is seen through the surface (stage 5).
    pub transmission: Vec3,
    /// Index of refraction inside, above 0; 1 bends nothing (stage 5).
    pub index_of_refraction: f32,
    /// Whether what is seen through gives way to the mirror image at flat angles (stage 5).
    pub fresnel: Fresnel,
    /// Blur of mirror images and of what is seen through, `0..=1`; 0 is sharp (stage 6).
    pub roughness: f32,
    /// Light that the surface gives off by itself (stage 11).
    pub emission: Vec3,
    /// Index into [`crate::scene::Scene::textures`]: an image that multiplies `diffuse` and `ambient` (stage 7).
    pub texture: Option<usize>,
}

impl Default for Material {
    /// A dull light grey.
    fn default() -> Self {
        Material {
            ambient: Vec3::splat(0.8),
            diffuse: Vec3::splat(0.8),
            specular: Vec3::ZERO,
            exponent: 32.0,
            mirror: Vec3::ZERO,
            transmission: Vec3::ZERO,
            index_of_refraction: 1.0,
            fresnel: Fresnel::None,
            roughness: 0.0,
            emission: Vec3::ZERO,
            texture: None,
        }
    }
}

/// How the mirrored share of light depends on the angle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Fresnel {
    /// Not at all: constant weights, as in the lecture notes.
    #[default]
    None,
    /// By Schlick's formula.
    Schlick,
    /// By Fresnel's equations.
    Exact,
}

/// What happens to texture coordinates outside `0..1`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Wrap {
    /// The image repeats.
    #[default]
    Repeat,
    /// The border is drawn out.
    Clamp,
    /// The image repeats, every other time mirrored.
    Mirror,
}

/// An image in linear light, row by row from the top.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Texture {
    /// Pixels a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// `width * height` linear colours.
    pub pixels: Arc<Vec<Vec3>>,
    /// What lies outside.
    pub wrap: Wrap,
}

/// How light weakens on its way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Falloff {
    /// Not at all, as in the lecture notes.
    #[default]
    None,
    /// With the square of the distance, as in nature.
    InverseSquare,
}

/// Where a light is and how far it spreads.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Emitter {
    /// A point in space.
    Point {
        /// Where it is.
        position: Vec3,
        /// How it weakens.
        falloff: Falloff,
    },
    /// Endlessly far away, shining along `direction` (from the lamp to the scene; unit length).
    Directional {
        /// Where the light goes.
        direction: Vec3,
    },
    /// A lamp with an extent (stage 6).
    Area {
        /// Its outline.
        shape: AreaShape,
        /// How it weakens.
        falloff: Falloff,
    },
}

/// The outline of an area light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum AreaShape {
    /// `corner + u * edges.0 + v * edges.1` for `u`, `v` in `0..1`.
    Rectangle {
        /// One corner.
        corner: Vec3,
        /// The two edges that leave it.
        edges: (Vec3, Vec3),
    },
    /// A disk.
    Disk(crate::shape::Disk),
    /// A ball.
    Sphere(crate::shape::Sphere),
}

impl AreaShape {
    /// The middle of the lamp.
    pub fn center(&self) -> Vec3 {
        match self {
            AreaShape::Rectangle { corner, edges } => *corner + 0.5 * (edges.0 + edges.1),
            AreaShape::Disk(disk) => disk.center,
            AreaShape::Sphere(sphere) => sphere.center,
        }
    }
}

/// A lamp: the colour of its light is `intensity * color`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Light {
    /// Where it is.
    pub emitter: Emitter,
    /// Red, green, blue.
    pub color: Vec3,
    /// A factor on the colour, at least 0.
    pub intensity: f32,
    /// Whether things stand in its light.
    pub shadows: bool,
}

impl Light {
    /// `intensity * color`: the light that arrives at distance 1, or anywhere if it does not weaken.
    pub fn radiance(&self) -> Vec3 {
        self.intensity * self.color
    }
}

/// A texture coordinate; `(0, 0)` is the lower left of the image.
pub type Uv = Vec2;
