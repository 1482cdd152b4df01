//! Checks of `effects` for whole scenes.

use super::scenes::{BUILT, everything, light, one_sphere, one_triangle};
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::known;
use glam::Vec3;
use raykata::camera::{Lens, Shutter};
use raykata::effects::{Effect, Effects, LightEffects, MaterialEffects};
use raykata::material::Material;
use raykata::mesh::Mesh;
use raykata::scene::{Node, Scene, SceneMesh};
use raykata::shape::Shape;
use std::sync::Arc;

/// The effects of one diffuse sphere under one light.
fn plain() -> Effects {
    let lit = MaterialEffects { lights: vec![0], ..MaterialEffects::default() };
    Effects {
        lights: vec![LightEffects { samples: 1, area: false, shadows: true }],
        materials: vec![MaterialEffects::default(), lit],
        ..Effects::default()
    }
}

fn judge(trial: &Trial<'_>, what: &str, scene: Scene, expected: &Effects, diagnosis: &str) -> CheckResult {
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

pub(super) fn a_plain_scene_takes_nothing_special(trial: &Trial<'_>) -> CheckResult {
    let scene = one_sphere(Material::default());
    judge(
        trial,
        "a diffuse sphere under a light",
        scene.clone(),
        &plain(),
        "materials[0] needs nothing, because no shape of the scene has it",
    )?;
    let indirect = Scene { indirect_light: true, ..scene };
    let as_it_says = "copy indirect_light from the scene";
    let expected = Effects { indirect_light: true, ..plain() };
    judge(trial, "the same with indirect light", indirect, &expected, as_it_says)?;

    let mut dark = one_sphere(Material::default());
    dark.lights.insert(0, light(Vec3::ZERO, 1.0));
    let mut expected = plain();
    expected.lights.insert(0, LightEffects::default());
    expected.materials[1].lights = vec![1];
    let in_place =
        "a black light needs nothing but keeps its entry: there is one entry per light of the scene";
    judge(trial, "a diffuse sphere under a black light and a white one", dark, &expected, in_place)
}

pub(super) fn what_is_not_shown_takes_nothing(trial: &Trial<'_>) -> CheckResult {
    let shown = "only shapes that a root reaches are shown: use scene.shown()";
    let mut scene = one_sphere(Material::default());
    scene.materials.push(Material { mirror: Vec3::ONE, ..Material::default() });
    scene.material_names.push("mirror".into());
    let mut expected = plain();
    expected.materials.push(MaterialEffects::default());
    judge(
        trial,
        "a diffuse sphere, and a mirror material that no shape has",
        scene.clone(),
        &expected,
        shown,
    )?;

    // Add a node with this mirror that no root reaches.
    scene.nodes.push(super::scenes::sphere(2));
    judge(
        trial,
        "a diffuse sphere, and a mirror sphere that no root reaches",
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
    judge(trial, "a diffuse sphere, and a smooth mesh that no node holds", scene.clone(), &expected, shown)?;

    // Show the mesh; half of it has the mirror material.
    let mesh = Mesh { triangles: vec![[0, 1, 2]; 2], face_materials: vec![0, 1], ..one_triangle() };
    scene.meshes =
        vec![SceneMesh { mesh: Arc::new(mesh), smooth: false, subdivisions: 0, materials: vec![1, 2] }];
    scene.nodes.push(Node { shape: Some(Shape::Mesh(0)), ..Node::default() });
    scene.roots.push(scene.nodes.len() - 1);
    expected.materials[2] = MaterialEffects { mirror: true, ..expected.materials[1].clone() };
    let several = "a mesh can have several materials: use all of shape.materials";
    judge(trial, "a diffuse sphere, and a mesh that is half a mirror", scene, &expected, several)
}

pub(super) fn lens_and_time_matter_only_where_they_are_seen(trial: &Trial<'_>) -> CheckResult {
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
        ("a shutter, and a sphere at rest", with(&still, None, Some((0.0, 1.0))), plain(), "no shape moves"),
        (
            "a moving sphere without a shutter",
            with(&moving, None, None),
            plain(),
            "without a shutter all rays have time 0",
        ),
        (
            "a moving sphere, and a shutter that closes at the time at which it opens",
            with(&moving, None, Some((0.5, 0.5))),
            plain(),
            "all rays have the same time",
        ),
        (
            "a moving sphere, and a shutter",
            with(&moving, None, Some((0.25, 0.5))),
            motion,
            "it moves while the shutter is open, with or without a lens",
        ),
        (
            "a shutter, and a moving sphere that no root reaches",
            elsewhere,
            plain(),
            "a shape that no root reaches does not count: use scene.shown()",
        ),
        (
            "a shutter, and a sphere whose transform is the same at both times",
            in_place,
            plain(),
            "equal transforms at both times are no motion: use shape.moves of scene.shown()",
        ),
    ];
    for (what, scene, expected, diagnosis) in cases {
        judge(trial, what, scene, &expected, diagnosis)?;
    }
    Ok(())
}

pub(super) fn every_subset_of_effects_is_recognised(trial: &Trial<'_>) -> CheckResult {
    // Test all 2⁹ scenes that have a subset of the nine effects.
    let all = everything();
    let subset =
        |bits: u32| BUILT.iter().enumerate().filter(move |(i, _)| bits >> i & 1 == 1).map(|(_, e)| *e);
    let scenes: Vec<Scene> = (0..1u32 << BUILT.len())
        .map(|bits| subset(!bits).fold(all.clone(), |scene, effect| effect.removed_from(&scene)))
        .collect();
    for (bits, effects) in trial.kit.effects(&scenes).into_iter().enumerate() {
        let wanted: Vec<Effect> = subset(bits as u32).collect();
        for effect in BUILT {
            // Roughness matters only for reflected and refracted rays.
            let possible = effect != Effect::Glossy
                || wanted.contains(&Effect::Mirrors)
                || wanted.contains(&Effect::Transmission);
            let expected = wanted.contains(&effect) && possible;
            if effects.calls_for(effect) != expected {
                let names: Vec<String> = wanted.iter().map(Effect::to_string).collect();
                let says = |calls: bool| {
                    format!("{} {effect}", if calls { "calls for" } else { "does not call for" })
                };
                let input = format!("effects of a scene with exactly these: {}", names.join(", "));
                let broken =
                    Broken::with_texts(input, says(!expected), says(expected), "how the scene was made");
                return Err(broken.looks_like(Some(clue(effect, expected))));
            }
        }
    }
    Ok(())
}

/// The diagnosis for an effect that is missing or that the scene does not need: what the effect depends on.
fn clue(effect: Effect, missed: bool) -> String {
    let depends_on = match effect {
        Effect::Shadows => "lights that emit light and cast shadows",
        Effect::AreaLights => "area lights and quality.light_samples",
        Effect::Mirrors => "material.mirror, and fresnel of materials with transmission",
        Effect::Transmission => "material.transmission",
        Effect::Glossy => "the roughness of materials that reflect or refract rays",
        Effect::Lens => "the aperture of the lens",
        Effect::Motion => "shapes that move while the shutter is open",
        Effect::SmoothNormals => "smooth meshes that are shown",
        Effect::Textures => "images of materials that are shown",
        Effect::IndirectLight => "scene.indirect_light",
    };
    let fate = if missed { "missing" } else { "not needed here" };
    format!("{effect}: {fate}; this effect depends only on {depends_on}")
}
