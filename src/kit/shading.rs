//! Stage 4, shading and shadows: queries and answers.

use crate::kit::questions::Asker;
use crate::material::Material;
use crate::ray::Ray;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// A point of a surface that is to be shaded, with its normals and its rounding error.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Surface {
    /// The point in world units, rounded to single precision.
    pub point: Vec3,
    /// A bound on the rounding error of `point` along each axis, in world units, at least 0.
    pub error: Vec3,
    /// The unit normal of the shape itself, on the viewer's side.
    pub geometric_normal: Vec3,
    /// The unit normal for shading, on the viewer's side. It differs from the geometric one on smooth meshes.
    pub shading_normal: Vec3,
}

/// The light that would arrive at a point from one point of a light, without occlusion.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct LightSample {
    /// The direction from the point to the light, of unit length.
    pub direction: Vec3,
    /// The distance from the point to the light in world units; infinite for a directional light.
    pub distance: f32,
    /// The light that arrives, in linear light: the light's colour times its intensity and its falloff with
    /// distance.
    pub radiance: Vec3,
}

/// Asks how large the diffuse or the specular term of the Phong model is.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct TermQuery {
    /// The unit normal on the viewer's side.
    pub normal: Vec3,
    /// The direction from the surface to the light, of unit length.
    pub to_light: Vec3,
    /// The direction from the surface to the viewer, of unit length; the diffuse term does not use it.
    pub to_viewer: Vec3,
    /// The Phong exponent, at least 0; the diffuse term does not use it.
    pub exponent: f32,
}

/// Asks which shadow ray a light needs, if any.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShadowQuery {
    /// The point at which the shadow ray starts.
    pub surface: Surface,
    /// The light at which the shadow ray ends.
    pub light: LightSample,
}

/// Asks which colour the viewer sees at a point; the answer is a [`ShadeAnswer`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShadeQuery {
    /// The point that is shaded.
    pub surface: Surface,
    /// The direction from the surface to the viewer, of unit length.
    pub to_viewer: Vec3,
    /// The material of the surface.
    pub material: Material,
    /// `A`, the ambient light of the scene, in linear light.
    pub ambient: Vec3,
    /// The light that would arrive from each light without occlusion.
    pub lights: Vec<LightSample>,
    /// For each entry of `lights`, whether its shadow ray is not occluded.
    pub visible: Vec<bool>,
}

/// The colour of a point, and the shadow rays that were traced for it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ShadeAnswer {
    /// The colour that the viewer sees, in linear light.
    pub color: Vec3,
    /// For each shadow ray that was traced, the index of its light, in order.
    pub traced: Vec<usize>,
    /// The shadow rays that were traced, in the same order.
    pub rays: Vec<Ray>,
}

/// Answers the shadow rays of a shading from the query, and records them.
pub struct ShadowProbe<'a> {
    query: &'a ShadeQuery,
    traced: Vec<usize>,
    rays: Vec<Ray>,
    /// Asks the judge, which knows the visible lights.
    asker: Option<Asker>,
}

impl<'a> ShadowProbe<'a> {
    /// A probe that answers from `query.visible`.
    pub fn new(query: &'a ShadeQuery) -> Self {
        ShadowProbe { query, traced: Vec::new(), rays: Vec::new(), asker: Asker::for_next_query() }
    }

    /// Whether the shadow ray `ray` to the light with the index `light` is not occluded.
    ///
    /// # Panics
    ///
    /// If there is no such light.
    #[track_caller]
    pub fn visible(&mut self, light: usize, ray: &Ray) -> bool {
        if let Some(asker) = &mut self.asker {
            return asker.visible(light, ray);
        }
        self.traced.push(light);
        self.rays.push(*ray);
        self.query.visible[light]
    }

    /// The answer of a shading that returned `color`, with the shadow rays that it traced.
    pub fn finish(self, color: Vec3) -> ShadeAnswer {
        ShadeAnswer { color, traced: self.traced, rays: self.rays }
    }
}
