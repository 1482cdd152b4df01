//! Where all knobs stand.

use super::ladder::Knob;
use raykata::effects::Effect;
use raykata::scene::{Quality, Scene};

/// A value of a knob: the scene with one thing changed.
#[derive(Clone, Debug, PartialEq)]
pub struct Setting {
    pub quality: Quality,
    /// Whether meshes keep their smooth normals.
    pub smooth: bool,
}

impl Setting {
    /// As the scene has it.
    pub fn of(scene: &Scene) -> Setting {
        Setting { quality: scene.quality, smooth: true }
    }

    pub fn apply(&self, scene: &Scene) -> Scene {
        let mut scene = if self.smooth { scene.clone() } else { Effect::SmoothNormals.removed_from(scene) };
        scene.quality = self.quality;
        scene
    }

    /// With one knob turned to where `to` has it.
    pub fn turned(&self, knob: Knob, to: &Setting) -> Setting {
        let (from, mut turned) = (&to.quality, self.clone());
        let quality = &mut turned.quality;
        match knob {
            Knob::Samples => quality.samples_per_pixel = from.samples_per_pixel,
            Knob::Sampler => quality.sampler = from.sampler,
            Knob::LightSamples => quality.light_samples = from.light_samples,
            Knob::GlossySamples => quality.glossy_samples = from.glossy_samples,
            Knob::Depth => quality.max_depth = from.max_depth,
            Knob::MinContribution => quality.min_contribution = from.min_contribution,
            Knob::SmoothNormals => turned.smooth = to.smooth,
            Knob::Intersection => quality.triangle_method = from.triangle_method,
            Knob::Precision => quality.precision = from.precision,
            Knob::Accelerator => quality.accelerator = from.accelerator,
            Knob::Split => quality.split = from.split,
            Knob::LeafSize => quality.leaf_size = from.leaf_size,
            Knob::GridResolution => quality.grid_resolution = from.grid_resolution,
        }
        turned
    }
}
