//! The effects that a scene can need, as data. Deciding which of them a scene does need is an exercise (stage
//! 7); the frame driver and the tracer compute what [`Effects`] lists and nothing else.

use crate::material::{Emitter, Light};
use crate::message;
use crate::scene::{Node, Scene};
use glam::Vec3;
use std::fmt;

/// What rendering a scene needs: the effects of the camera, of each light, of each material and of each mesh.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effects {
    /// Whether rays start at points all over the lens (depth of field), and not at its centre.
    pub lens: bool,
    /// Whether each ray has a time of its own, because something moves while the shutter is open (motion
    /// blur).
    pub motion: bool,
    /// Whether indirect light, which surfaces reflect to each other, is computed (stage 11).
    pub indirect_light: bool,
    /// What each light of the scene needs, by its index.
    pub lights: Vec<LightEffects>,
    /// What each material of the scene needs, by its index.
    pub materials: Vec<MaterialEffects>,
    /// For each mesh of the scene, by its index, whether normals are interpolated over its triangles.
    pub smooth_meshes: Vec<bool>,
}

message! { Effects { lens, motion, indirect_light, lights, materials, smooth_meshes } }

/// What a light needs. The default needs nothing: it is that of a light that emits nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightEffects {
    /// The number of points of the light that each hit samples: 0 for a light that emits nothing, 1 for a
    /// light that shines from one point or one direction.
    pub samples: u32,
    /// Whether those points are spread at random over an area light.
    pub area: bool,
    /// Whether the light casts shadows, so that shadow rays are traced to it.
    pub shadows: bool,
}

message! { LightEffects { samples, area, shadows } }

/// What a material needs. All fields are `false` or empty for a material that no surface of the scene has.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MaterialEffects {
    /// The indices of the lights that can make the material brighter, in ascending order.
    pub lights: Vec<usize>,
    /// Whether surfaces of the material spawn reflected rays.
    pub mirror: bool,
    /// Whether surfaces of the material spawn refracted rays.
    pub transmission: bool,
    /// Whether those secondary rays are spread around the ideal direction (glossy reflection and refraction).
    pub glossy: bool,
    /// Whether the colour of the material is read from an image.
    pub texture: bool,
}

message! { MaterialEffects { lights, mirror, transmission, glossy, texture } }

impl Effects {
    /// All effects that a scene with these lights and materials can need, without a closer look. Rendered
    /// with them, the picture is the same as with the effects of stage 7, but costs more.
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
            glossy: material.roughness > 0.0,
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

    /// Whether any light, material or mesh, or the camera, needs `effect`. A light counts only if some
    /// material lists it.
    pub fn calls_for(&self, effect: Effect) -> bool {
        let materials = |wants: fn(&MaterialEffects) -> bool| self.materials.iter().any(wants);
        let seen = |light: usize| self.materials.iter().any(|material| material.lights.contains(&light));
        let mut lights = self.lights.iter().enumerate().filter(|(light, _)| seen(*light));
        match effect {
            Effect::Shadows => lights.any(|(_, light)| light.samples > 0 && light.shadows),
            Effect::AreaLights => lights.any(|(_, light)| light.area),
            Effect::Mirrors => materials(|material| material.mirror),
            Effect::Transmission => materials(|material| material.transmission),
            Effect::Glossy => materials(|material| material.glossy),
            Effect::Lens => self.lens,
            Effect::Motion => self.motion,
            Effect::SmoothNormals => self.smooth_meshes.contains(&true),
            Effect::Textures => materials(|material| material.texture),
            Effect::IndirectLight => self.indirect_light,
        }
    }
}

/// An effect that a scene can need and that costs time only where it is needed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Shadow rays to lights.
    Shadows,
    /// Lights with an extent, which cast soft shadows.
    AreaLights,
    /// Reflected rays.
    Mirrors,
    /// Refracted rays through surfaces.
    Transmission,
    /// Glossy reflection and refraction: secondary rays spread around the ideal direction.
    Glossy,
    /// Depth of field, by a thin lens.
    Lens,
    /// Motion blur, by rays at different times.
    Motion,
    /// Normals that are interpolated over the triangles of meshes.
    SmoothNormals,
    /// Colours that are read from images.
    Textures,
    /// Indirect light, which surfaces reflect to each other.
    IndirectLight,
}

message! { enum Effect {
    Shadows, AreaLights, Mirrors, Transmission, Glossy, Lens, Motion, SmoothNormals, Textures,
    IndirectLight
} }

impl Effect {
    /// All ten effects, in the order of their declaration.
    pub const ALL: [Effect; 10] = [
        Effect::Shadows,
        Effect::AreaLights,
        Effect::Mirrors,
        Effect::Transmission,
        Effect::Glossy,
        Effect::Lens,
        Effect::Motion,
        Effect::SmoothNormals,
        Effect::Textures,
        Effect::IndirectLight,
    ];

    /// A copy of `scene` that does not need this effect.
    ///
    /// - Without shadows, no light casts one.
    /// - Without area lights, each of them shines from its centre.
    /// - Without mirrors, the weight of reflection is 0, and there are no coats.
    /// - Without transmission, the weight of refraction is 0; the Fresnel reflection of a transparent
    ///   material goes with it.
    /// - Without glossy, roughness is 0.
    /// - Without the lens, the camera is a pinhole.
    /// - Without motion, every node stays where it is when the shutter opens.
    /// - Without smooth normals, meshes are flat.
    /// - Without textures, images are left out.
    /// - Without indirect light, only direct light is computed.
    pub fn removed_from(self, scene: &Scene) -> Scene {
        let mut scene = scene.clone();
        match self {
            Effect::Shadows => scene.lights.iter_mut().for_each(|light| light.shadows = false),
            Effect::AreaLights => scene.quality.light_samples = 0,
            Effect::Mirrors => {
                scene.materials.iter_mut().for_each(|m| (m.mirror, m.coat) = (Vec3::ZERO, 1.0));
            }
            Effect::Transmission => scene.materials.iter_mut().for_each(|m| m.transmission = Vec3::ZERO),
            Effect::Glossy => scene.materials.iter_mut().for_each(|m| m.roughness = 0.0),
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
            Effect::Glossy => "glossy",
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
    use crate::files::scene::parse;
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
