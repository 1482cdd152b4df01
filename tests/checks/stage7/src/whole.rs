//! What whole scenes call for.

use super::scenes::{BUILT, everything, light, one_sphere, one_triangle};
use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::judge::known;
use glam::Vec3;
use raykata::camera::{Lens, Shutter};
use raykata::effects::{Effect, Effects, LightEffects, MaterialEffects};
use raykata::material::Material;
use raykata::mesh::Mesh;
use raykata::scene::{Node, Scene, SceneMesh};
use raykata::shape::Shape;
use std::sync::Arc;

/// What a scene with nothing special takes.
fn plain() -> Effects {
    let lit = MaterialEffects { lights: vec![0], ..MaterialEffects::default() };
    Effects {
        lights: vec![LightEffects { samples: 1, area: false, shadows: true }],
        materials: vec![MaterialEffects::default(), lit],
        ..Effects::default()
    }
}

fn judge(trial: &Trial<'_>, what: &str, scene: Scene, expected: &Effects, diagnosis: &str) -> Outcome {
    let yours = trial.kit.effects(&[scene]).remove(0);
    if yours == *expected {
        return Ok(());
    }
    let part = |effects: &Effects| match () {
        () if yours.materials != expected.materials => format!("materials: {:?}", effects.materials),
        () if yours.lights != expected.lights => format!("lights: {:?}", effects.lights),
        () if yours.smooth_meshes != expected.smooth_meshes => {
            format!("smooth_meshes: {:?}", effects.smooth_meshes)
        }
        () => format!(
            "lens: {}, motion: {}, indirect_light: {}",
            effects.lens, effects.motion, effects.indirect_light
        ),
    };
    let broken =
        Broken::with_texts(format!("effects of {what}"), part(&yours), part(expected), "the definition");
    Err(broken.looks_like(known(diagnosis)))
}

pub(super) fn a_plain_scene_takes_nothing_special(trial: &Trial<'_>) -> Outcome {
    let scene = one_sphere(Material::default());
    judge(
        trial,
        "a dull sphere under a light",
        scene.clone(),
        &plain(),
        "no shape is of the default material",
    )?;
    let indirect = Scene { indirect_light: true, ..scene };
    let as_it_says = "indirect_light is as the scene says";
    let expected = Effects { indirect_light: true, ..plain() };
    judge(trial, "the same with indirect light", indirect, &expected, as_it_says)?;

    let mut dark = one_sphere(Material::default());
    dark.lights.insert(0, light(Vec3::ZERO, 1.0));
    let mut expected = plain();
    expected.lights.insert(0, LightEffects::default());
    expected.materials[1].lights = vec![1];
    let in_place =
        "a light without light takes nothing and keeps its place: one entry for each light of the scene";
    judge(trial, "a dull sphere under a black light and a white one", dark, &expected, in_place)
}

pub(super) fn what_is_not_shown_takes_nothing(trial: &Trial<'_>) -> Outcome {
    let shown = "only what is reached from a root is shown: ask scene.shown()";
    let mut scene = one_sphere(Material::default());
    scene.materials.push(Material { mirror: Vec3::ONE, ..Material::default() });
    scene.material_names.push("mirror".into());
    let mut expected = plain();
    expected.materials.push(MaterialEffects::default());
    judge(trial, "a dull sphere, and a mirror that nothing is made of", scene.clone(), &expected, shown)?;

    // The same mirror on a node that no root leads to.
    scene.nodes.push(super::scenes::sphere(2));
    judge(
        trial,
        "a dull sphere, and a mirror sphere that is not in the scene",
        scene.clone(),
        &expected,
        shown,
    )?;

    scene.meshes.push(SceneMesh {
        mesh: Arc::new(one_triangle()),
        smooth: true,
        subdivisions: 0,
        materials: Vec::new(),
    });
    expected.smooth_meshes = vec![false];
    judge(trial, "a dull sphere, and a smooth mesh that stands nowhere", scene.clone(), &expected, shown)?;

    // The mesh stands there, half of it of the mirror.
    let mesh = Mesh { triangles: vec![[0, 1, 2]; 2], face_materials: vec![0, 1], ..one_triangle() };
    scene.meshes =
        vec![SceneMesh { mesh: Arc::new(mesh), smooth: false, subdivisions: 0, materials: vec![1, 2] }];
    scene.nodes.push(Node { shape: Some(Shape::Mesh(0)), ..Node::default() });
    scene.roots.push(scene.nodes.len() - 1);
    expected.materials[2] = MaterialEffects { mirror: true, ..expected.materials[1].clone() };
    let several = "a mesh may be of several materials: look at all of shape.materials";
    judge(trial, "a dull sphere, and a mesh that is half a mirror", scene, &expected, several)
}

pub(super) fn lens_and_time_matter_only_where_they_are_seen(trial: &Trial<'_>) -> Outcome {
    let still = one_sphere(Material::default());
    let mut moving = still.clone();
    moving.nodes[0].transform_end = Some(glam::Affine3A::from_translation(Vec3::X));
    let with = |scene: &Scene, lens: Option<f32>, shutter: Option<(f32, f32)>| {
        let mut scene = scene.clone();
        scene.camera.lens = lens.map(|aperture| Lens { aperture, focal_distance: 3.0 });
        scene.camera.shutter = shutter.map(|(open, close)| Shutter { open, close });
        scene
    };
    let mut elsewhere = with(&still, None, Some((0.0, 1.0)));
    elsewhere.nodes.push(moving.nodes[0].clone());
    let mut in_place = with(&moving, None, Some((0.0, 1.0)));
    in_place.nodes[0].transform_end = Some(in_place.nodes[0].transform);
    let lens = Effects { lens: true, ..plain() };
    let motion = Effects { motion: true, ..plain() };
    let cases = [
        ("a lens of aperture 0", with(&still, Some(0.0), None), plain(), "an aperture of 0 is a pinhole"),
        (
            "a lens",
            with(&still, Some(0.1), None),
            lens,
            "an aperture above 0 blurs, with or without a shutter",
        ),
        ("a shutter before a still sphere", with(&still, None, Some((0.0, 1.0))), plain(), "nothing moves"),
        (
            "a moving sphere without a shutter",
            with(&moving, None, None),
            plain(),
            "the picture is taken at time 0",
        ),
        (
            "a moving sphere, and a shutter that closes when it opens",
            with(&moving, None, Some((0.5, 0.5))),
            plain(),
            "all rays have the same time",
        ),
        (
            "a moving sphere before a shutter",
            with(&moving, None, Some((0.25, 0.5))),
            motion,
            "it moves while the shutter is open, with or without a lens",
        ),
        (
            "a shutter, and a moving sphere that is not in the scene",
            elsewhere,
            plain(),
            "only what is shown moves",
        ),
        ("a sphere that moves to where it is", in_place, plain(), "it does not move: ask scene.shown()"),
    ];
    for (what, scene, expected, diagnosis) in cases {
        judge(trial, what, scene, &expected, diagnosis)?;
    }
    Ok(())
}

pub(super) fn every_subset_of_effects_is_recognised(trial: &Trial<'_>) -> Outcome {
    // All 2⁹ scenes that have some of nine effects and lack the others.
    let all = everything();
    let subset =
        |bits: u32| BUILT.iter().enumerate().filter(move |(i, _)| bits >> i & 1 == 1).map(|(_, e)| *e);
    let scenes: Vec<Scene> = (0..1u32 << BUILT.len())
        .map(|bits| subset(!bits).fold(all.clone(), |scene, effect| effect.removed_from(&scene)))
        .collect();
    for (bits, effects) in trial.kit.effects(&scenes).into_iter().enumerate() {
        let wanted: Vec<Effect> = subset(bits as u32).collect();
        for effect in BUILT {
            // Only mirrors and glass can be rough.
            let possible = effect != Effect::Glossy
                || wanted.contains(&Effect::Mirrors)
                || wanted.contains(&Effect::Transmission);
            let expected = wanted.contains(&effect) && possible;
            if effects.calls_for(effect) != expected {
                let names: Vec<String> = wanted.iter().map(Effect::to_string).collect();
                let says = |calls: bool| {
                    format!("{} {effect}", if calls { "calls for" } else { "does not call for" })
                };
                let input = format!("effects of a scene with just these: {}", names.join(", "));
                let broken =
                    Broken::with_texts(input, says(!expected), says(expected), "how the scene was made");
                return Err(broken.looks_like(Some(clue(effect, expected))));
            }
        }
    }
    Ok(())
}

/// What an effect depends on that is missed, or is called for in vain.
fn clue(effect: Effect, missed: bool) -> String {
    let depends_on = match effect {
        Effect::Shadows => "lights that give light and cast shadows",
        Effect::AreaLights => "lights with an extent, and quality.light_samples",
        Effect::Mirrors => "material.mirror, and fresnel of what lets light through",
        Effect::Transmission => "material.transmission",
        Effect::Glossy => "roughness of what is mirrored or seen through",
        Effect::Lens => "the aperture of the lens",
        Effect::Motion => "what moves while the shutter is open",
        Effect::SmoothNormals => "smooth meshes that are shown",
        Effect::Textures => "images of materials that are shown",
        Effect::IndirectLight => "scene.indirect_light",
    };
    let fate = if missed { "left out" } else { "called for in vain" };
    format!("{effect} {fate}, and nothing else decides about it: {depends_on}")
}
