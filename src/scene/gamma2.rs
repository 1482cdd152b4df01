//! Which colours and images of a scene are encoded with gamma 2, the gamma of the lecture notes.

use crate::scene::Scene;
use glam::Vec3;
use serde::{Deserialize, Serialize};

/// The colours and images of a scene that are encoded with gamma 2. To decode them is an exercise of stage 4, so the
/// loader decodes them with the sRGB curve, and a frame replaces these values.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Gamma2 {
    /// The colours, each with its place in the scene and its bytes: red, green and blue.
    pub colors: Vec<(ColorPlace, [u8; 3])>,
    /// Indices of images in [`Scene::textures`] whose files have 8 bits per component.
    pub textures: Vec<usize>,
}

impl Gamma2 {
    /// Whether nothing is encoded with gamma 2.
    pub fn is_empty(&self) -> bool {
        self.colors.is_empty() && self.textures.is_empty()
    }
}

/// The place of a colour in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum ColorPlace {
    /// The background.
    Background,
    /// The ambient light.
    AmbientLight,
    /// The colour of the light with this index.
    Light(usize),
    /// A colour of the material with this index.
    Material(usize, MaterialColor),
}

/// One of the colours of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum MaterialColor {
    /// The reflectance for ambient light.
    Ambient,
    /// The diffuse reflectance.
    Diffuse,
    /// The strength of the specular highlight.
    Specular,
    /// The weight of the reflected ray.
    Mirror,
    /// The weight of the refracted ray.
    Transmission,
    /// The light that the surface emits.
    Emission,
}

impl Scene {
    /// The colour at `place`, which can be changed; `None` if the scene has no such light or material.
    pub fn color_mut(&mut self, place: ColorPlace) -> Option<&mut Vec3> {
        Some(match place {
            ColorPlace::Background => &mut self.background,
            ColorPlace::AmbientLight => &mut self.ambient,
            ColorPlace::Light(index) => &mut self.lights.get_mut(index)?.color,
            ColorPlace::Material(index, color) => {
                let material = self.materials.get_mut(index)?;
                match color {
                    MaterialColor::Ambient => &mut material.ambient,
                    MaterialColor::Diffuse => &mut material.diffuse,
                    MaterialColor::Specular => &mut material.specular,
                    MaterialColor::Mirror => &mut material.mirror,
                    MaterialColor::Transmission => &mut material.transmission,
                    MaterialColor::Emission => &mut material.emission,
                }
            }
        })
    }
}
