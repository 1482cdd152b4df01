//! The parts of a scene that need an effect, and the reasons why the scene does not need the others.

use glam::Vec3;
use raykata::effects::{Effect, Effects};
use raykata::material::{AreaShape, Emitter, Fresnel, Light, Material};
use raykata::scene::{Background, Scene, TextureFilter};
use raykata::shape::Shape;

/// The parts of `scene` that need `effect`, in words; none if the scene does not need it.
pub fn asked_by(effect: Effect, scene: &Scene, effects: &Effects) -> Vec<String> {
    let seen = |light: usize| effects.materials.iter().any(|material| material.lights.contains(&light));
    let lights = |wants: &dyn Fn(usize) -> bool| {
        (0..scene.lights.len())
            .filter(|&light| seen(light) && wants(light))
            .map(|light| light_name(scene, light))
            .collect()
    };
    let materials = |wants: &dyn Fn(usize) -> bool| {
        (0..scene.materials.len()).filter(|&index| wants(index)).map(|index| material(scene, index)).collect()
    };
    match effect {
        Effect::Shadows => {
            lights(&|light| effects.lights[light].samples > 0 && effects.lights[light].shadows)
        }
        Effect::AreaLights => lights(&|light| effects.lights[light].area),
        Effect::Mirrors => materials(&|index| effects.materials[index].mirror),
        Effect::Transmission => materials(&|index| effects.materials[index].transmission),
        Effect::Glossy => materials(&|index| effects.materials[index].glossy),
        Effect::Textures => materials(&|index| effects.materials[index].texture),
        Effect::Lens => scene
            .camera
            .lens
            .filter(|_| effects.lens)
            .map(|lens| format!("camera: aperture {}, focal distance {}", lens.aperture, lens.focal_distance))
            .into_iter()
            .collect(),
        Effect::Motion if effects.motion => {
            scene.shown().iter().filter(|shape| shape.moves).map(|shape| node(scene, shape.node)).collect()
        }
        Effect::SmoothNormals => scene
            .shown()
            .iter()
            .filter(|shape| shape.mesh.is_some_and(|mesh| effects.smooth_meshes[mesh]))
            .map(|shape| node(scene, shape.node))
            .collect(),
        Effect::IndirectLight if effects.indirect_light => vec!["[environment]: indirect_light".into()],
        Effect::Motion | Effect::IndirectLight => Vec::new(),
    }
}

/// What changes the picture and costs no ray, each with its parts in words: surfaces that emit light, visible lights, a
/// background of more than one colour, and filtered images.
pub fn seen(scene: &Scene, effects: &Effects) -> Vec<(&'static str, String)> {
    let of_light = |index: &usize| scene.visible_lights.iter().any(|light| light.material == *index);
    let emitters = scene.emitters().into_iter().filter(|index| !of_light(index));
    let emitters: Vec<String> = emitters.map(|index| material(scene, index)).collect();
    let lights: Vec<String> =
        scene.visible_lights.iter().map(|visible| light_name(scene, visible.light)).collect();
    let background = match scene.background {
        Background::Color(_) => None,
        Background::Gradient(_) => Some("vertical gradient".to_owned()),
        Background::Map(_) => Some("environment map, one image read per ray that hits nothing".to_owned()),
    };
    let filtered =
        effects.calls_for(Effect::Textures) && scene.quality.texture_filter == TextureFilter::Mipmap;
    let filter = filtered.then(|| "mip levels, 1 to 32 image reads per hit".to_owned());
    let parts = [
        ("emission", emitters),
        ("visible lights", lights),
        ("background", background.into_iter().collect()),
        ("texture filter", filter.into_iter().collect()),
    ];
    // Paths of indirect light sample emitters and the environment map.
    let costs = |what| match scene.indirect_light && ["emission", "background"].contains(&what) {
        true => "",
        false => "; costs no ray",
    };
    let some = parts.into_iter().filter(|(_, parts)| !parts.is_empty());
    some.map(|(what, parts)| (what, format!("{}{}", list(&parts), costs(what)))).collect()
}

/// The reason why no part of `scene` needs `effect`.
pub fn not_asked(effect: Effect, scene: &Scene) -> String {
    let shown = scene.shown();
    let has = |wants: &dyn Fn(&Material) -> bool, what: &str| {
        let idle: Vec<String> = scene
            .materials
            .iter()
            .zip(&scene.material_names)
            .filter(|(material, _)| wants(material))
            .map(|(_, name)| format!("`{name}`"))
            .collect();
        (!idle.is_empty()).then(|| format!("{} {what}", list(&idle)))
    };
    let area = |light: &Light| matches!(light.emitter, Emitter::Area { .. });
    let unused = "could, but no shape has this material, max_depth is 0, or nothing shines";
    const DARK: &str =
        "nothing shines: there is no light, no emission, no ambient light, and the background is black";
    match effect {
        Effect::Shadows if scene.lights.is_empty() => "there is no light".into(),
        Effect::Shadows => "no light that reaches a surface casts shadows".into(),
        Effect::AreaLights if scene.lights.iter().any(area) && scene.quality.light_samples == 0 => {
            "light_samples is 0: area lights shine from their centre".into()
        }
        Effect::AreaLights if scene.lights.iter().any(area) => "no area light reaches a surface".into(),
        Effect::AreaLights => "there is no area light".into(),
        Effect::Mirrors => has(&|m| m.mirror != Vec3::ZERO || m.fresnel != Fresnel::None, unused)
            .unwrap_or_else(|| "no material is a mirror".into()),
        Effect::Transmission => has(&|m| m.transmission != Vec3::ZERO, unused)
            .unwrap_or_else(|| "no material transmits light".into()),
        Effect::Glossy => {
            has(&|m| m.roughness > 0.0, "is rough, but no shape of this material reflects or transmits light")
                .unwrap_or_else(|| "no material is rough".into())
        }
        Effect::Lens if scene.camera.lens.is_some_and(|lens| lens.aperture > 0.0) => DARK.into(),
        Effect::Lens if scene.camera.lens.is_some() => "the aperture of the lens is 0".into(),
        Effect::Lens => "the camera is a pinhole".into(),
        Effect::Motion if !shown.iter().any(|shape| shape.moves) => "nothing moves".into(),
        Effect::Motion if scene.camera.shutter.is_some_and(|shutter| shutter.close > shutter.open) => {
            DARK.into()
        }
        Effect::Motion => "the shutter opens and closes at the same time".into(),
        Effect::SmoothNormals if scene.meshes.is_empty() && scene.has_curved_surface() => {
            "there is no mesh; curved surfaces have normals of their own".into()
        }
        Effect::SmoothNormals if scene.meshes.is_empty() => "there is no mesh".into(),
        Effect::SmoothNormals
            if shown.iter().any(|shape| shape.mesh.is_some_and(|m| scene.meshes[m].smooth)) =>
        {
            DARK.into()
        }
        Effect::SmoothNormals => "no mesh that is shown is smooth".into(),
        Effect::Textures => has(&|m| m.texture.is_some(), "has an image, but no shape shows it, or no light")
            .unwrap_or_else(|| "no material has an image".into()),
        Effect::IndirectLight if scene.indirect_light => DARK.into(),
        Effect::IndirectLight => "[environment] does not request it".into(),
    }
}

fn light_name(scene: &Scene, light: usize) -> String {
    let kind = match &scene.lights[light].emitter {
        Emitter::Point { .. } if scene.lights[light].cone.is_some() => "spot",
        Emitter::Point { .. } => "point",
        Emitter::Directional { .. } => "directional",
        Emitter::Area { shape: AreaShape::Rectangle { .. }, .. } => "rectangle",
        Emitter::Area { shape: AreaShape::Disk(_), .. } => "disk",
        Emitter::Area { shape: AreaShape::Sphere(_), .. } => "sphere",
    };
    format!("light {} ({kind})", light + 1)
}

/// The name of a material, and the first nodes that have it.
pub fn material(scene: &Scene, index: usize) -> String {
    let mut nodes: Vec<String> = scene
        .shown()
        .iter()
        .filter(|shape| shape.materials.contains(&index))
        .map(|shape| node(scene, shape.node))
        .collect();
    nodes.dedup();
    format!("`{}` ({})", scene.material_names[index], list(&nodes))
}

fn node(scene: &Scene, index: usize) -> String {
    let node = &scene.nodes[index];
    let unnamed = format!("node {}", index + 1);
    if node.name != unnamed {
        return node.name.clone();
    }
    let kind = match &node.shape {
        Some(Shape::Sphere(_)) => "sphere",
        Some(Shape::Plane(_) | Shape::PlaneEquation(_)) => "plane",
        Some(Shape::Triangle(_)) => "triangle",
        Some(Shape::Cuboid(_)) => "box",
        Some(Shape::Cylinder(_)) => "cylinder",
        Some(Shape::Cone(_)) => "cone",
        Some(Shape::Disk(_)) => "disk",
        Some(Shape::Polygon(_)) => "polygon",
        Some(Shape::Bezier { .. } | Shape::Nurbs { .. }) => "curved surface",
        Some(Shape::Mesh(_)) => "mesh",
        None => "nothing",
    };
    format!("{kind} of {unnamed}")
}

/// The first three parts, and how many more there are.
pub fn list(parts: &[String]) -> String {
    match parts {
        [first, second, third, more @ ..] if !more.is_empty() => {
            format!("{first}, {second}, {third} and {} more", more.len())
        }
        parts => parts.join(", "),
    }
}
