//! Stage 4, shading and shadows: queries and answers.

use crate::kit::questions::{Asker, Call};
use crate::light::surface::{LightSample, Surface};
use crate::material::Material;
use crate::message;
use crate::ray::Ray;
use glam::Vec3;

/// Asks which colour the viewer sees at a point; the answer is a [`ShadeAnswer`].
#[derive(Clone, Debug, PartialEq)]
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

message! { ShadeQuery { surface, to_viewer, material, ambient, lights, visible } }

/// The colour of a point, and the shadow rays that were traced for it.
#[derive(Clone, Debug, PartialEq)]
pub struct ShadeAnswer {
    /// The colour that the viewer sees, in linear light.
    pub color: Vec3,
    /// For each shadow ray that was traced, the index of its light, in order.
    pub traced: Vec<usize>,
    /// The shadow rays that were traced, in the same order.
    pub rays: Vec<Ray>,
}

message! { ShadeAnswer { color, traced, rays } }

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
            return asker.visible(Call::Visible(u32::try_from(light).unwrap_or(u32::MAX), *ray));
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
