//! Which colours and images of a scene are encoded with gamma 2, the gamma of the lecture notes.

use crate::message;
use crate::scene::{Background, Scene};
use glam::Vec3;

/// The colours and images of a scene that are encoded with gamma 2. To decode them is an exercise of stage 4, so the
/// loader decodes them with the sRGB curve, and a frame replaces these values.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gamma2 {
    /// The colours, each with its place in the scene and its bytes: red, green and blue.
    pub colors: Vec<(ColorPlace, [u8; 3])>,
    /// Indices of images in [`Scene::textures`] whose files have 8 bits per component.
    pub textures: Vec<usize>,
}

message! { Gamma2 { colors, textures } }

impl Gamma2 {
    /// Whether nothing is encoded with gamma 2.
    pub fn is_empty(&self) -> bool {
        self.colors.is_empty() && self.textures.is_empty()
    }
}

/// The place of a colour in a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorPlace {
    /// The background, if it is one colour.
    Background,
    /// The ambient light.
    AmbientLight,
    /// The colour of the light with this index.
    Light(usize),
    /// A colour of the material with this index.
    Material(usize, MaterialColor),
    /// A colour of the background, if it is a gradient.
    Gradient(GradientColor),
}

message! { enum ColorPlace { Background, AmbientLight, Light(a), Material(a, b), Gradient(a) } }

/// One of the colours of a gradient.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GradientColor {
    /// The colour straight up.
    Zenith,
    /// The colour in horizontal directions.
    Horizon,
    /// The colour straight down.
    Nadir,
}

message! { enum GradientColor { Zenith, Horizon, Nadir } }

/// One of the colours of a material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
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

message! { enum MaterialColor { Ambient, Diffuse, Specular, Mirror, Transmission, Emission } }

impl Scene {
    /// The colour at `place`, which can be changed; `None` if the scene has no such light, material or background.
    pub fn color_mut(&mut self, place: ColorPlace) -> Option<&mut Vec3> {
        Some(match place {
            ColorPlace::Background => match &mut self.background {
                Background::Color(color) => color,
                _ => return None,
            },
            ColorPlace::Gradient(color) => match (&mut self.background, color) {
                (Background::Gradient(gradient), GradientColor::Zenith) => &mut gradient.zenith,
                (Background::Gradient(gradient), GradientColor::Horizon) => &mut gradient.horizon,
                (Background::Gradient(gradient), GradientColor::Nadir) => &mut gradient.nadir,
                _ => return None,
            },
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
