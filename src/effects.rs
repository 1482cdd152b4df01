//! What a scene can call for, as vocabulary. Which of it a scene does call for is an exercise (stage 7); the frame
//! driver and the tracer do what [`Effects`] say and nothing else.

use crate::material::{Emitter, Light};
use crate::scene::{Node, Scene};
use glam::Vec3;
use serde::{Deserialize, Serialize};
use std::fmt;

/// What rendering a scene takes, and where.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Effects {
    /// Rays start all over the lens, and not in its centre.
    pub lens: bool,
    /// Rays have times of their own, because something moves while the shutter is open.
    pub motion: bool,
    /// Light bounced between surfaces is followed (stage 11).
    pub indirect_light: bool,
    /// For each light what it takes.
    pub lights: Vec<LightEffects>,
    /// For each material what it takes.
    pub materials: Vec<MaterialEffects>,
    /// For each mesh whether normals are interpolated over its triangles.
    pub smooth_meshes: Vec<bool>,
}

/// What a light takes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct LightEffects {
    /// Places on the lamp that a surface asks about: 0 for a lamp without light, 1 for one that shines from a point.
    pub samples: u32,
    /// Whether those places are spread over the lamp at random.
    pub area: bool,
    /// Whether it casts shadows, so that a ray has to ask.
    pub shadows: bool,
}

/// What a material takes. All is false and empty for a material that nothing in the scene is made of.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct MaterialEffects {
    /// Lights that can make it brighter, in ascending order.
    pub lights: Vec<usize>,
    /// Whether rays can be mirrored off it.
    pub mirror: bool,
    /// Whether rays can go through it.
    pub transmission: bool,
    /// Whether those rays are blurred.
    pub gloss: bool,
    /// Whether its colour is read from an image.
    pub texture: bool,
}

impl Effects {
    /// All that could be called for if nobody looks closer: as much as any scene with so many lights and materials can
    /// take. Pictures come out the same, but cost more.
    pub fn everything(scene: &Scene) -> Effects {
        let quality = &scene.quality;
        let light = |light: &Light| {
            let area = matches!(light.emitter, Emitter::Area { .. }) && quality.light_samples > 0;
            let samples = if area { quality.light_samples } else { 1 };
            LightEffects { samples, area, shadows: light.shadows }
        };
        let material = |material: &crate::material::Material| MaterialEffects {
            lights: (0..scene.lights.len()).collect(),
            mirror: true,
            transmission: true,
            gloss: material.roughness > 0.0,
            texture: material.texture.is_some(),
        };
        Effects {
            lens: scene.camera.lens.is_some(),
            motion: scene.camera.shutter.is_some(),
            indirect_light: scene.indirect_light,
            lights: scene.lights.iter().map(light).collect(),
            materials: scene.materials.iter().map(material).collect(),
            smooth_meshes: scene.meshes.iter().map(|mesh| mesh.smooth).collect(),
        }
    }

    /// Whether any part of the scene calls for `effect`.
    pub fn calls_for(&self, effect: Effect) -> bool {
        let materials = |wants: fn(&MaterialEffects) -> bool| self.materials.iter().any(wants);
        let seen = |light: usize| self.materials.iter().any(|material| material.lights.contains(&light));
        let mut lights = self.lights.iter().enumerate().filter(|(light, _)| seen(*light));
        match effect {
            Effect::Shadows => lights.any(|(_, light)| light.samples > 0 && light.shadows),
            Effect::AreaLights => lights.any(|(_, light)| light.area),
            Effect::Mirrors => materials(|material| material.mirror),
            Effect::Transmission => materials(|material| material.transmission),
            Effect::Gloss => materials(|material| material.gloss),
            Effect::Lens => self.lens,
            Effect::Motion => self.motion,
            Effect::SmoothNormals => self.smooth_meshes.contains(&true),
            Effect::Textures => materials(|material| material.texture),
            Effect::IndirectLight => self.indirect_light,
        }
    }
}

/// Something that a scene can call for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Effect {
    /// Rays towards lights.
    Shadows,
    /// Lamps with an extent.
    AreaLights,
    /// Mirrored rays.
    Mirrors,
    /// Rays through surfaces.
    Transmission,
    /// Blurred mirrors and glass.
    Gloss,
    /// Depth of field.
    Lens,
    /// Motion blur.
    Motion,
    /// Normals interpolated over meshes.
    SmoothNormals,
    /// Colours from images.
    Textures,
    /// Light bounced between surfaces.
    IndirectLight,
}

impl Effect {
    /// All of them.
    pub const ALL: [Effect; 10] = [
        Effect::Shadows,
        Effect::AreaLights,
        Effect::Mirrors,
        Effect::Transmission,
        Effect::Gloss,
        Effect::Lens,
        Effect::Motion,
        Effect::SmoothNormals,
        Effect::Textures,
        Effect::IndirectLight,
    ];

    /// `scene` as it would be if it did not call for this effect: lamps cast no shadow, area lights shine from their
    /// middle, weights of mirrors or of glass are 0 (what glass itself mirrors by Fresnel goes with the glass), rough is
    /// sharp, the lens is a pinhole, what moves stands where it is when the shutter opens, meshes are flat, images are
    /// left out.
    pub fn removed_from(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        match self {
            Effect::Shadows => scene.lights.iter_mut().for_each(|light| light.shadows = false),
            Effect::AreaLights => scene.quality.light_samples = 0,
            Effect::Mirrors => scene.materials.iter_mut().for_each(|m| m.mirror = Vec3::ZERO),
            Effect::Transmission => scene.materials.iter_mut().for_each(|m| m.transmission = Vec3::ZERO),
            Effect::Gloss => scene.materials.iter_mut().for_each(|m| m.roughness = 0.0),
            Effect::Lens => scene.camera.lens = None,
            Effect::Motion => {
                let open = scene.camera.shutter.map_or(0.0, |shutter| shutter.open);
                scene.nodes.iter_mut().for_each(|node| stand_still(node, open));
            }
            Effect::SmoothNormals => scene.meshes.iter_mut().for_each(|mesh| mesh.smooth = false),
            Effect::Textures => scene.materials.iter_mut().for_each(|m| m.texture = None),
            Effect::IndirectLight => scene.indirect_light = false,
        }
        scene
    }
}

fn stand_still(node: &mut Node, time: f32) {
    node.transform = node.transform_at(time);
    node.transform_end = None;
}

impl fmt::Display for Effect {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(match self {
            Effect::Shadows => "shadows",
            Effect::AreaLights => "area lights",
            Effect::Mirrors => "mirrors",
            Effect::Transmission => "transmission",
            Effect::Gloss => "gloss",
            Effect::Lens => "lens",
            Effect::Motion => "motion",
            Effect::SmoothNormals => "smooth normals",
            Effect::Textures => "textures",
            Effect::IndirectLight => "indirect light",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::load::parse;
    use std::path::Path;

    #[test]
    fn an_effect_that_is_removed_twice_is_removed_once() {
        let text = r#"
[camera]
position = [0, 0, 5]
look_at = [0, 0, 0]
lens = { aperture = 0.1, focal_distance = 5 }
shutter = { open = 0.25, close = 0.75 }
[materials.glass]
transmission = 1
mirror = 0.1
roughness = 0.2
fresnel = "schlick"
[[lights]]
area = { sphere = { center = [0, 5, 0], radius = 1 } }
[[nodes]]
material = "glass"
shape = { sphere = { center = [0, 0, 0], radius = 1 } }
transform_end = [{ translate = [1, 0, 0] }]
"#;
        let scene = parse(Path::new("test.toml"), text).expect("a scene");
        for effect in Effect::ALL {
            let once = effect.removed_from(&scene);
            assert_eq!(effect.removed_from(&once), once, "{effect}");
            let shown = [Effect::SmoothNormals, Effect::Textures, Effect::IndirectLight].contains(&effect);
            assert_eq!(once == scene, shown, "{effect}");
        }
        assert_eq!(Effect::Motion.removed_from(&scene).nodes[0].transform.translation.x, 0.25);
    }
}
