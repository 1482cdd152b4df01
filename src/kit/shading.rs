//! Stage 4 in plain data.

use crate::material::Material;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A point of a surface that is to be shaded.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Surface {
    /// Where it is.
    pub point: Vec3,
    /// How far `point` may lie from the true surface, along each axis: a bound on its rounding error.
    pub error: Vec3,
    /// Unit normal of the shape itself, on the viewer's side.
    pub geometric_normal: Vec3,
    /// Unit normal to shade with, on the viewer's side; differs from the geometric one on smooth meshes.
    pub shading_normal: Vec3,
}

/// Light that would arrive at a point if nothing stood in its way.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightSample {
    /// Unit direction from the point to the light.
    pub direction: Vec3,
    /// How far away the light is; infinite for a directional light.
    pub distance: f32,
    /// Its colour times its intensity, weakened by distance if it weakens.
    pub radiance: Vec3,
}

/// How strong is this term of the illumination?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TermQuery {
    /// Unit normal.
    pub normal: Vec3,
    /// Unit direction to the light.
    pub to_light: Vec3,
    /// Unit direction to the viewer.
    pub to_viewer: Vec3,
    /// Sharpness of the highlight.
    pub exponent: f32,
}

/// Which shadow ray does this light need, if any?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShadowQuery {
    /// From where.
    pub surface: Surface,
    /// To which light.
    pub light: LightSample,
}

/// What colour does the viewer see?
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShadeQuery {
    /// The point.
    pub surface: Surface,
    /// Unit direction to the viewer.
    pub to_viewer: Vec3,
    /// What the surface does with light.
    pub material: Material,
    /// `A`, light from everywhere.
    pub ambient: Vec3,
    /// All lights.
    pub lights: Vec<LightSample>,
    /// For each light whether a shadow ray finds the way free.
    pub visible: Vec<bool>,
}

/// The colour, and which shadow rays were traced for it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShadeAnswer {
    /// The colour in linear light.
    pub color: Vec3,
    /// For each shadow ray the light it went to.
    pub traced: Vec<usize>,
}
