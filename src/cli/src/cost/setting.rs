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
        let mut turned = self.clone();
        turned.quality.take(parameter.key(), &to.quality);
        if parameter == Parameter::SmoothNormals {
            turned.smooth = to.smooth;
        }
        turned
    }
}
