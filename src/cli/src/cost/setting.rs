//! A setting: the values of all parameters.

use super::parameter::Parameter;
use raykata::effects::Effect;
use raykata::scene::{Quality, Scene};

/// The values of all parameters for one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    pub quality: Quality,
    /// Whether meshes keep their smooth normals.
    pub smooth: bool,
}

impl Setting {
    /// The scene's own setting.
    pub fn of(scene: &Scene) -> Setting {
        Setting { quality: scene.quality, smooth: true }
    }

    pub fn apply(&self, scene: &Scene) -> Scene {
        let mut scene = if self.smooth { scene.clone() } else { Effect::SmoothNormals.removed_from(scene) };
        scene.quality = self.quality;
        scene
    }

    /// The same setting with the value of one parameter taken from `to`.
    pub fn turned(&self, parameter: Parameter, to: &Setting) -> Setting {
        let (from, mut turned) = (&to.quality, self.clone());
        let quality = &mut turned.quality;
        match parameter {
            Parameter::Samples => quality.samples_per_pixel = from.samples_per_pixel,
            Parameter::Sampler => quality.sampler = from.sampler,
            Parameter::LightSamples => quality.light_samples = from.light_samples,
            Parameter::GlossySamples => quality.glossy_samples = from.glossy_samples,
            Parameter::Depth => quality.max_depth = from.max_depth,
            Parameter::MinContribution => quality.min_contribution = from.min_contribution,
            Parameter::NextEvent => quality.next_event = from.next_event,
            Parameter::RouletteFrom => quality.roulette_from = from.roulette_from,
            Parameter::Clamp => quality.clamp = from.clamp,
            Parameter::TextureFilter => quality.texture_filter = from.texture_filter,
            Parameter::SmoothNormals => turned.smooth = to.smooth,
            Parameter::Intersection => quality.triangle_method = from.triangle_method,
            Parameter::SphereTest => quality.sphere_method = from.sphere_method,
            Parameter::Precision => quality.precision = from.precision,
            Parameter::Accelerator => quality.accelerator = from.accelerator,
            Parameter::Split => quality.split = from.split,
            Parameter::LeafSize => quality.leaf_size = from.leaf_size,
            Parameter::GridResolution => quality.grid_resolution = from.grid_resolution,
        }
        turned
    }
}
