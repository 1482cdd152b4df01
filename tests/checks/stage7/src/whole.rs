//! Checks of `effects` for whole scenes.

use super::scenes::{BUILT, ONE_SAMPLE, add_material, everything, light, one_sphere, one_triangle, sphere};
use checks::prelude::*;
use raykata::effects::{Effect, Effects, LightEffects, MaterialEffects};
use raykata::material::{Light, Material};
use raykata::mesh::Mesh;
use raykata::scene::{Node, Scene, SceneMesh};
use raykata::shape::Shape;
use std::sync::Arc;

/// The effects of one diffuse sphere under one light.
pub(super) fn plain() -> Effects {
    let lit = MaterialEffects { lights: vec![0], ..MaterialEffects::default() };
    Effects {
        lights: vec![ONE_SAMPLE],
        materials: vec![MaterialEffects::default(), lit],
        ..Effects::default()
    }
}

/// A scene, and its effects.
type SceneWithEffects = (&'static str, Scene, Effects);

/// The mistakes in an answer, given the right one, each with whether it explains that answer.
type Mistakes = fn(&Effects, &Effects) -> Vec<(bool, &'static str)>;

/// Lights that scenes get for hidden seeds only.
pub(super) fn hidden_lights(trial: &Trial<'_>) -> Vec<Light> {
    let light = (0.1f32..4.0).prop_map(|intensity| light(Vec3::ONE, intensity));
    trial.varied(Vec::new(), prop::collection::vec(light, 1..8))
}

/// The effects of the same scene with `n` more point lights, which light each material that is lit.
pub(super) fn with_lights(mut effects: Effects, n: usize) -> Effects {
    let numbers = effects.lights.len()..effects.lights.len() + n;
    effects.lights.resize(numbers.end, ONE_SAMPLE);
    for material in effects.materials.iter_mut().filter(|material| !material.lights.is_empty()) {
        material.lights.extend(numbers.clone());
    }
    effects
}

/// Judges all scenes, and names a mistake that explains all wrong answers.
fn judge_all(trial: &Trial<'_>, mut cases: Vec<SceneWithEffects>, mistakes: Mistakes) -> CheckResult {
    let lights = hidden_lights(trial);
    for (_, scene, expected) in &mut cases {
        scene.lights.extend_from_slice(&lights);
        *expected = with_lights(std::mem::take(expected), lights.len());
    }
    let scenes: Vec<Scene> = cases.iter().map(|(_, scene, _)| scene.clone()).collect();
    all_hold(compare(&cases, trial.kit.effects(&scenes), |(what, _, expected), yours| {
        judge(what, &yours, expected).map_err(|broken| broken.explained_by(mistakes(&yours, expected)))
    }))
}

pub(super) fn judge(what: &str, yours: &Effects, expected: &Effects) -> CheckResult {
    if yours == expected {
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
    // If a single effect is wrong, its name and what it depends on.
    let is_wrong = |effect: &Effect| yours.calls_for(*effect) != expected.calls_for(*effect);
    let wrong: Vec<Effect> = BUILT.into_iter().filter(is_wrong).collect();
    let samples = |effects: &Effects| effects.lights.iter().map(|light| light.samples).collect::<Vec<_>>();
    let clue = match wrong[..] {
        [only] if only == Effect::AreaLights || samples(yours) == samples(expected) => {
            clue(only, expected.calls_for(only))
        }
        _ => "",
    };
    Err(Broken::with_texts(format!("effects of {what}"), part(yours), part(expected), "the definition")
        .explained_by([(!clue.is_empty(), clue)]))
}

const DROPPED: &str =
    "a black light needs nothing but keeps its entry: there is one entry per light of the scene";

/// The mistakes in scenes with one sphere, which has material 1.
fn of_plain_scenes(yours: &Effects, expected: &Effects) -> Vec<(bool, &'static str)> {
    let lit = expected.materials[1].clone();
    let all_materials = Effects { materials: vec![lit.clone(), lit], ..expected.clone() };
    let still_lit: Vec<LightEffects> =
        expected.lights.iter().copied().filter(|light| light.samples > 0).collect();
    let moved_up = MaterialEffects { lights: vec![0], ..MaterialEffects::default() };
    let dropped = Effects { lights: still_lit, ..expected.clone() };
    let renumbered = Effects { materials: vec![MaterialEffects::default(), moved_up], ..dropped.clone() };
    let has_fewer = yours.lights.len() < expected.lights.len();
    vec![
        "materials[0] needs nothing, because no shape of the scene has it: analyse only materials of shown shapes"
            .when(*yours == all_materials),
        "copy indirect_light from the scene: you return false"
            .when(*yours == Effects { indirect_light: false, ..expected.clone() }),
        "copy indirect_light from the scene: you return true"
            .when(*yours == Effects { indirect_light: true, ..expected.clone() }),
        (has_fewer && *yours == dropped, DROPPED),
        (has_fewer && *yours == renumbered, DROPPED),
        "you leave out the lights: there is one entry per light of the scene"
            .when(*yours == Effects { lights: Vec::new(), ..expected.clone() }),
        "you leave out the materials: there is one entry per material of the scene"
            .when(*yours == Effects { materials: Vec::new(), ..expected.clone() }),
    ]
}

pub(super) fn a_plain_scene_takes_nothing_special(trial: &Trial<'_>) -> CheckResult {
    let scene = one_sphere(Material::default());
    let mut dark = scene.clone();
    dark.lights.insert(0, light(Vec3::ZERO, 1.0));
    let mut of_dark = plain();
    of_dark.lights.insert(0, LightEffects::default());
    of_dark.materials[1].lights = vec![1];
    let indirect = Scene { indirect_light: true, ..scene.clone() };
    let cases = vec![
        ("a diffuse sphere under a light", scene, plain()),
        ("the same with indirect light", indirect, Effects { indirect_light: true, ..plain() }),
        ("a diffuse sphere under a black light and a white one", dark, of_dark),
    ];
    judge_all(trial, cases, of_plain_scenes)
}

const ONE_MATERIAL: &str =
    "you analyse one material per shape: a mesh can have several materials, so use all of shape.materials";

/// The mistakes in scenes with parts that are not shown.
fn of_hidden_parts(yours: &Effects, expected: &Effects) -> Vec<(bool, &'static str)> {
    let nothing = MaterialEffects::default();
    let is_same = Effects {
        materials: expected.materials.clone(),
        smooth_meshes: expected.smooth_meshes.clone(),
        ..yours.clone()
    } == *expected;
    let same_length = yours.materials.len() == expected.materials.len()
        && yours.smooth_meshes.len() == expected.smooth_meshes.len();
    let mut wrong = yours.materials.iter().zip(&expected.materials).filter(|(one, other)| one != other);
    let extra = wrong.clone().any(|(_, other)| *other == nothing);
    let only_extra = wrong.all(|(_, other)| *other == nothing);
    // Keep one of the materials of the mesh, which are those from 2 on.
    let one_material = |kept: usize| {
        let keep = |(index, material): (usize, &MaterialEffects)| match index < 2 || index == kept {
            true => material.clone(),
            false => nothing.clone(),
        };
        let materials = expected.materials.iter().enumerate().map(keep).collect();
        *yours == Effects { materials, ..expected.clone() }
    };
    let smooth = yours.smooth_meshes.iter().zip(&expected.smooth_meshes).any(|(one, other)| *one && !*other);
    named![
        is_same && same_length && only_extra && (extra || smooth) =>
            "you analyse what is not shown: only shapes that a root reaches are shown, so use scene.shown()",
        one_material(2) => ONE_MATERIAL,
        one_material(expected.materials.len() - 1) => ONE_MATERIAL,
        !same_length => "you leave out entries: there is one per material and one per mesh of the scene, in order",
    ].to_vec()
}

pub(super) fn what_is_not_shown_takes_nothing(trial: &Trial<'_>) -> CheckResult {
    let mut scene = one_sphere(Material::default());
    add_material(&mut scene, "mirror", Material { mirror: Vec3::ONE, ..Material::default() });
    let mut expected = plain();
    expected.materials.push(MaterialEffects::default());
    let case = |what, scene: &Scene, expected: &Effects| (what, scene.clone(), expected.clone());
    let mut cases =
        vec![case("a diffuse sphere, and a mirror material that no shape has", &scene, &expected)];

    // Add a node with this mirror that no root reaches.
    scene.nodes.push(sphere(2));
    cases.push(case("a diffuse sphere, and a mirror sphere that no root reaches", &scene, &expected));

    scene.meshes.push(SceneMesh { mesh: Arc::new(one_triangle()), smooth: true, ..SceneMesh::default() });
    expected.smooth_meshes = vec![false];
    cases.push(case("a diffuse sphere, and a smooth mesh that no node holds", &scene, &expected));

    // Show the mesh, with three materials that the sphere does not have.
    add_material(&mut scene, "glass", Material { transmission: Vec3::ONE, ..Material::default() });
    add_material(&mut scene, "paint", Material::default());
    let mesh = Mesh { triangles: vec![[0, 1, 2]; 3], face_materials: vec![0, 1, 2], ..one_triangle() };
    // The smooth mesh is second now. No node holds it.
    let smooth = scene.meshes.remove(0);
    let mesh = SceneMesh { mesh: Arc::new(mesh), materials: vec![2, 3, 4], ..SceneMesh::default() };
    scene.meshes = vec![mesh, smooth];
    expected.smooth_meshes = vec![false; 2];
    scene.nodes.push(Node { shape: Some(Shape::Mesh(0)), ..Node::default() });
    scene.roots.push(scene.nodes.len() - 1);
    let lit = expected.materials[1].clone();
    expected.materials[2] = MaterialEffects { mirror: true, ..lit.clone() };
    expected.materials.extend([MaterialEffects { transmission: true, ..lit.clone() }, lit]);
    cases.push(case("a diffuse sphere, and a mesh of mirror, glass and paint", &scene, &expected));
    judge_all(trial, cases, of_hidden_parts)
}

pub(super) fn every_subset_of_effects_is_recognised(trial: &Trial<'_>) -> CheckResult {
    subsets_are_recognised(trial, &everything())?;
    // The same for other colours and another picture: the effects do not depend on them.
    let strategy = (0.1f32..0.9, 0.1f32..0.9, 1..=2048u32);
    trial.forall(1, strategy, |drawn| {
        let judge = |(factor, brightness, width): &(f32, f32, u32)| {
            let mut all = everything();
            all.film.width = *width;
            all.lights.iter_mut().for_each(|light| light.intensity *= brightness);
            for material in &mut all.materials {
                for color in [&mut material.diffuse, &mut material.mirror, &mut material.transmission] {
                    *color *= *factor;
                }
            }
            subsets_are_recognised(trial, &all)
        };
        drawn.iter().map(judge).collect()
    })
}

/// Tests all 2⁹ scenes that have a subset of the nine effects of `all`.
fn subsets_are_recognised(trial: &Trial<'_>, all: &Scene) -> CheckResult {
    let subset =
        |bits: u32| BUILT.iter().enumerate().filter(move |(i, _)| bits >> i & 1 == 1).map(|(_, e)| *e);
    let scenes: Vec<Scene> = (0..1u32 << BUILT.len())
        .map(|bits| subset(!bits).fold(all.clone(), |scene, effect| effect.removed_from(&scene)))
        .collect();
    let judge = |(bits, effects): (usize, Effects)| {
        let wanted: Vec<Effect> = subset(bits as u32).collect();
        // Roughness matters only for reflected and refracted rays.
        let spawns = wanted.contains(&Effect::Mirrors) || wanted.contains(&Effect::Transmission);
        let expected = |effect| wanted.contains(&effect) && (effect != Effect::Glossy || spawns);
        let wrong: Vec<Effect> =
            BUILT.into_iter().filter(|effect| effects.calls_for(*effect) != expected(*effect)).collect();
        let Some(&first) = wrong.first() else { return Ok(()) };
        let names: Vec<String> = wanted.iter().map(Effect::to_string).collect();
        let says = |calls: bool| format!("{} {first}", if calls { "calls for" } else { "does not call for" });
        let input = format!("effects of a scene with exactly these: {}", names.join(", "));
        let (yours, right) = (says(!expected(first)), says(expected(first)));
        let broken = Broken::with_texts(input, yours, right, "how the scene was made");
        // Name an effect only if it is the only one that is wrong in this scene.
        let clue = match wrong[..] {
            [only] => clue(only, expected(only)),
            _ => "",
        };
        Err(broken.explained_by([(!clue.is_empty(), clue)]))
    };
    all_hold(trial.kit.effects(&scenes).into_iter().enumerate().map(judge).collect())
}

/// What an effect depends on that is missing in some scenes, or that some scenes do not need.
fn clue(effect: Effect, missed: bool) -> &'static str {
    macro_rules! clues {
        ($($effect:ident: $name:literal, $depends_on:literal;)*) => {
            match (effect, missed) {
                $((Effect::$effect, true) => concat!($name, ": missing; this effect depends only on ", $depends_on),
                (Effect::$effect, false) => concat!($name, ": not needed here; this effect depends only on ", $depends_on),)*
            }
        };
    }
    clues! {
        Shadows: "shadows", "lights that emit light and cast shadows";
        AreaLights: "area lights", "area lights and quality.light_samples";
        Mirrors: "mirrors", "material.mirror, and fresnel of materials with transmission";
        Transmission: "transmission", "material.transmission";
        Glossy: "glossy", "the roughness of materials that reflect or refract rays";
        Lens: "lens", "the aperture of the lens";
        Motion: "motion", "shapes that move while the shutter is open";
        SmoothNormals: "smooth normals", "smooth meshes that are shown";
        Textures: "textures", "images of materials that are shown, and lit";
        IndirectLight: "indirect light", "scene.indirect_light";
    }
}
