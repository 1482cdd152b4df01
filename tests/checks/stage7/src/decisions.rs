//! What lights and materials call for.

use super::scenes::{ball_lamp, lamp};
use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::judge::{compare, known};
use checks::paste::Paste;
use glam::{Vec3, vec3};
use proptest::prelude::*;
use raykata::effects::{LightEffects, MaterialEffects};
use raykata::kit::{LightQuery, MaterialQuery};
use raykata::material::{Fresnel, Light, Material};
use raykata::scene::Quality;

pub(super) fn lights_take_what_they_are(trial: &Trial<'_>) -> Outcome {
    let quality = |light_samples| Quality { light_samples, ..Quality::default() };
    let one = LightEffects { samples: 1, area: false, shadows: true };
    let nothing = LightEffects::default();
    let silent = Light { shadows: false, ..lamp(Vec3::ONE, 1.0) };
    let cases = [
        ("a white lamp", lamp(Vec3::ONE, 1.0), quality(4), one, "a lamp without extent shines from 1 place"),
        (
            "a lamp that casts no shadows",
            silent,
            quality(1),
            LightEffects { shadows: false, ..one },
            "it shines all the same, and shadows is as light.shadows says",
        ),
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
    let channel = || prop_oneof![3 => Just(0.0f32), 2 => Just(0.5f32), 1 => Just(1e-4f32)];
    (channel(), channel(), channel()).prop_map(|(r, g, b)| vec3(r, g, b))
}

fn material_query() -> impl Strategy<Value = MaterialQuery> + Clone {
    let fresnel = prop_oneof![Just(Fresnel::None), Just(Fresnel::Schlick), Just(Fresnel::Exact)];
    let rough = prop_oneof![Just(0.0f32), Just(0.25f32)];
    let texture = prop_oneof![Just(None), Just(Some(0))];
    let colors = (color(), color(), color(), color(), color());
    let index = prop_oneof![Just(1.0f32), Just(1.5f32)];
    let lights = prop::collection::vec(color().prop_map(|color| lamp(color, 2.0)), 0..4);
    (colors, fresnel, rough, texture, lights, 0..3u32, index).prop_map(
        |(
            (ambient, diffuse, specular, mirror, transmission),
            fresnel,
            roughness,
            texture,
            lights,
            max_depth,
            index_of_refraction,
        )| {
            MaterialQuery {
                material: Material {
                    ambient,
                    diffuse,
                    specular,
                    mirror,
                    transmission,
                    index_of_refraction,
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
        "material_effects of ambient {}, diffuse {}, specular {}, mirror {}, transmission {}, index {},\nfresnel {:?}, roughness {}, texture {:?}, max_depth {},\nunder lights of radiance [{}]",
        m.ambient,
        m.diffuse,
        m.specular,
        m.mirror,
        m.transmission,
        m.index_of_refraction,
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
                    "a light is missing: one channel is enough, diffuse or specular, and faint light is light"
                }
                () if !shown && (yours.mirror || yours.transmission) => "with max_depth 0 no ray goes on",
                () if yours.mirror != expected.mirror && m.mirror == Vec3::ZERO => {
                    "with fresnel, what lets light through mirrors part of it; without any light through, nothing"
                }
                () if yours.mirror != expected.mirror => "rays are mirrored if some channel of mirror is not 0",
                () if yours.transmission != expected.transmission => {
                    "rays go through if some channel of transmission is not 0, whatever the index and the angle"
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
