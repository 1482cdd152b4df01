//! What lights, materials and scenes call for.

use super::scenes::{BUILT, ball_lamp, everything, lamp, one_ball, one_triangle};
use crate::Trial;
use crate::broken::{Broken, Outcome};
use crate::judge::{compare, known};
use crate::paste::Paste;
use glam::{Vec3, vec3};
use proptest::prelude::*;
use raykata::camera::{Lens, Shutter};
use raykata::effects::{Effect, Effects, LightEffects, MaterialEffects};
use raykata::kit::{LightQuery, MaterialQuery};
use raykata::material::{Fresnel, Light, Material};
use raykata::scene::{Quality, Scene, SceneMesh};
use std::sync::Arc;

pub(super) fn lights_take_what_they_are(trial: &Trial<'_>) -> Outcome {
    let quality = |light_samples| Quality { light_samples, ..Quality::default() };
    let one = LightEffects { samples: 1, area: false, shadows: true };
    let nothing = LightEffects::default();
    let silent = Light { shadows: false, ..lamp(Vec3::ONE, 1.0) };
    let cases = [
        ("a white lamp", lamp(Vec3::ONE, 1.0), quality(4), one, "a lamp without extent shines from 1 place"),
        ("a lamp that casts no shadows", silent, quality(1), LightEffects { shadows: false, ..one }, ""),
        (
            "a lamp of intensity 0",
            lamp(Vec3::ONE, 0.0),
            quality(1),
            nothing,
            "it gives no light: it takes nothing",
        ),
        ("a black lamp", lamp(Vec3::ZERO, 3.0), quality(1), nothing, "black light is none: it takes nothing"),
        ("a faint red lamp", lamp(vec3(1e-6, 0.0, 0.0), 1.0), quality(1), one, "faint light is light"),
        (
            "a ball of light",
            ball_lamp(Vec3::ONE),
            quality(16),
            LightEffects { samples: 16, area: true, shadows: true },
            "a lamp with an extent is asked light_samples times",
        ),
        (
            "a ball of light with light_samples = 1",
            ball_lamp(Vec3::ONE),
            quality(1),
            LightEffects { samples: 1, area: true, shadows: true },
            "one place is drawn at random as well",
        ),
        (
            "a ball of light with light_samples = 0",
            ball_lamp(Vec3::ONE),
            quality(0),
            one,
            "it shines from its middle",
        ),
        ("a black ball", ball_lamp(Vec3::ZERO), quality(16), nothing, "it gives no light: it takes nothing"),
    ];
    let queries: Vec<LightQuery> = cases
        .iter()
        .map(|(_, light, quality, ..)| LightQuery { light: light.clone(), quality: *quality })
        .collect();
    for ((name, _, _, expected, diagnosis), yours) in cases.iter().zip(trial.kit.light_effects(&queries)) {
        if yours != *expected {
            let broken = Broken::new(format!("light_effects of {name}"), yours, expected, "the definition");
            return Err(broken.looks_like(known(diagnosis)));
        }
    }
    Ok(())
}

/// What the material takes, by the definition.
fn takes(query: &MaterialQuery) -> MaterialEffects {
    let MaterialQuery { material, lights, quality } = query;
    let meets = |light: &Light| {
        let arrives = light.radiance();
        (0..3).any(|i| arrives[i] > 0.0 && (material.diffuse[i] > 0.0 || material.specular[i] > 0.0))
    };
    let deep = quality.max_depth > 0;
    let transmission = deep && material.transmission != Vec3::ZERO;
    let mirror =
        deep && (material.mirror != Vec3::ZERO || (transmission && material.fresnel != Fresnel::None));
    MaterialEffects {
        lights: (0..lights.len()).filter(|&i| meets(&lights[i])).collect(),
        mirror,
        transmission,
        gloss: material.roughness > 0.0 && (mirror || transmission),
        texture: material.texture.is_some() && (material.diffuse + material.ambient) != Vec3::ZERO,
    }
}

fn color() -> impl Strategy<Value = Vec3> + Clone {
    let channel = || prop_oneof![2 => Just(0.0f32), 1 => Just(0.5f32)];
    (channel(), channel(), channel()).prop_map(|(r, g, b)| vec3(r, g, b))
}

fn material_query() -> impl Strategy<Value = MaterialQuery> + Clone {
    let fresnel = prop_oneof![Just(Fresnel::None), Just(Fresnel::Schlick), Just(Fresnel::Exact)];
    let rough = prop_oneof![Just(0.0f32), Just(0.25f32)];
    let texture = prop_oneof![Just(None), Just(Some(0))];
    let colors = (color(), color(), color(), color(), color());
    let lights = prop::collection::vec(color().prop_map(|color| lamp(color, 2.0)), 0..4);
    (colors, fresnel, rough, texture, lights, 0..3u32).prop_map(
        |(
            (ambient, diffuse, specular, mirror, transmission),
            fresnel,
            roughness,
            texture,
            lights,
            max_depth,
        )| {
            MaterialQuery {
                material: Material {
                    ambient,
                    diffuse,
                    specular,
                    mirror,
                    transmission,
                    fresnel,
                    roughness,
                    texture,
                    ..Material::default()
                },
                lights,
                quality: Quality { max_depth, ..Quality::default() },
            }
        },
    )
}

fn told(query: &MaterialQuery) -> String {
    let m = &query.material;
    let lights: Vec<String> = query.lights.iter().map(|light| light.radiance().paste()).collect();
    format!(
        "material_effects of ambient {}, diffuse {}, specular {}, mirror {}, transmission {},\nfresnel {:?}, roughness {}, texture {:?}, max_depth {},\nunder lights of radiance [{}]",
        m.ambient,
        m.diffuse,
        m.specular,
        m.mirror,
        m.transmission,
        m.fresnel,
        m.roughness,
        m.texture,
        query.quality.max_depth,
        lights.join(", ")
    )
}

pub(super) fn materials_take_what_they_show(trial: &Trial<'_>) -> Outcome {
    trial.forall(4000, material_query(), |queries| {
        compare(queries, trial.kit.material_effects(queries), |query, yours| {
            let expected = takes(query);
            if yours == expected {
                return Ok(());
            }
            let m = &query.material;
            let shown = query.quality.max_depth > 0;
            let diagnosis = match () {
                () if yours.lights.len() > expected.lights.len() => {
                    "a light whose every channel meets a 0 adds nothing: no ray should ask for it"
                }
                () if yours.lights.len() < expected.lights.len() => {
                    "a light is missing: one channel is enough, diffuse or specular"
                }
                () if !shown && (yours.mirror || yours.transmission) => "with max_depth 0 no ray goes on",
                () if yours.mirror != expected.mirror && m.mirror == Vec3::ZERO => {
                    "with fresnel, what lets light through mirrors part of it; without any light through, nothing"
                }
                () if yours.gloss != expected.gloss => "rough matters only where rays are mirrored or go through",
                () if yours.texture != expected.texture => {
                    "an image matters if diffuse or ambient, which it multiplies, is not 0"
                }
                () => "",
            };
            Err(Broken::new(told(query), yours, expected, "the definition").looks_like(known(diagnosis)))
        })
    })
}

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
    let broken = Broken::told(format!("effects of {what}"), part(&yours), part(expected), "the definition");
    Err(broken.looks_like(known(diagnosis)))
}

pub(super) fn a_plain_scene_takes_nothing_special(trial: &Trial<'_>) -> Outcome {
    let scene = one_ball(Material::default());
    judge(trial, "a dull ball under a lamp", scene.clone(), &plain(), "no shape is of the default material")?;
    let indirect = Scene { indirect_light: true, ..scene };
    judge(trial, "the same with indirect light", indirect, &Effects { indirect_light: true, ..plain() }, "")
}

pub(super) fn what_is_not_shown_takes_nothing(trial: &Trial<'_>) -> Outcome {
    let shown = "only what is reached from a root is shown: ask scene.shown()";
    let mut scene = one_ball(Material::default());
    scene.materials.push(Material { mirror: Vec3::ONE, ..Material::default() });
    scene.material_names.push("mirror".into());
    let mut expected = plain();
    expected.materials.push(MaterialEffects::default());
    judge(trial, "a dull ball, and a mirror that nothing is made of", scene.clone(), &expected, shown)?;

    // The same mirror on a node that no root leads to.
    scene.nodes.push(super::scenes::ball(2));
    judge(trial, "a dull ball, and a mirror ball that is not in the scene", scene.clone(), &expected, shown)?;

    scene.meshes.push(SceneMesh { mesh: Arc::new(one_triangle()), smooth: true, materials: Vec::new() });
    expected.smooth_meshes = vec![false];
    judge(trial, "a dull ball, and a smooth mesh that stands nowhere", scene, &expected, shown)
}

pub(super) fn lens_and_time_matter_only_where_they_are_seen(trial: &Trial<'_>) -> Outcome {
    let still = one_ball(Material::default());
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
        ("a lens", with(&still, Some(0.1), None), lens, ""),
        ("a shutter before a still ball", with(&still, None, Some((0.0, 1.0))), plain(), "nothing moves"),
        (
            "a moving ball without a shutter",
            with(&moving, None, None),
            plain(),
            "the picture is taken at time 0",
        ),
        (
            "a moving ball, and a shutter that closes when it opens",
            with(&moving, None, Some((0.5, 0.5))),
            plain(),
            "all rays have the same time",
        ),
        ("a moving ball before a shutter", with(&moving, None, Some((0.25, 0.5))), motion, ""),
        (
            "a shutter, and a moving ball that is not in the scene",
            elsewhere,
            plain(),
            "only what is shown moves",
        ),
        ("a ball that moves to where it is", in_place, plain(), "it does not move: ask scene.shown()"),
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
            let possible = effect != Effect::Gloss
                || wanted.contains(&Effect::Mirrors)
                || wanted.contains(&Effect::Transmission);
            let expected = wanted.contains(&effect) && possible;
            if effects.calls_for(effect) != expected {
                let names: Vec<String> = wanted.iter().map(Effect::to_string).collect();
                let says = |calls: bool| {
                    format!("{} {effect}", if calls { "calls for" } else { "does not call for" })
                };
                return Err(Broken::told(
                    format!("effects of a scene with just these: {}", names.join(", ")),
                    says(!expected),
                    says(expected),
                    "how the scene was made",
                ));
            }
        }
    }
    Ok(())
}
