//! What the paths of a scene need: `paths_called_for`, by scenes whose answer follows from how they were made.

use checks::prelude::*;
use glam::Affine3A;
use raykata::camera::{Camera, Shutter};
use raykata::light_path::PathEffects;
use raykata::material::{AreaShape, Emitter, Falloff, Light, Material};
use raykata::scene::{Background, EnvironmentMap, Gradient, Node, Scene, VisibleLight};
use raykata::shape::{PlaneEquation, Shape};

const RED: Vec3 = Vec3::X;
const GREEN: Vec3 = Vec3::Y;

fn sphere() -> Shape {
    Shape::Sphere(Sphere { center: Vec3::ZERO, radius: 1.0 })
}

fn plane() -> Shape {
    Shape::Plane(Plane { point: Vec3::NEG_Y, normal: Vec3::Y })
}

fn light(color: Vec3) -> Light {
    let emitter = Emitter::Point { position: vec3(0.0, 5.0, 0.0), falloff: Falloff::None };
    Light { emitter, color, intensity: 1.0, shadows: true, cone: None }
}

fn diffuse(color: Vec3) -> Material {
    Material { diffuse: color, ambient: Vec3::ZERO, ..Material::default() }
}

/// A black surface that emits light.
fn glowing(color: Vec3) -> Material {
    Material { emission: color, ..diffuse(Vec3::ZERO) }
}

/// A scene with indirect light and a black background, and a shape of each of these materials. Their indices begin at 1,
/// because no shape has material 0.
fn scene(shapes: &[(Shape, Material)]) -> Scene {
    let camera = Camera::new(vec3(0.0, 1.0, 5.0), Vec3::NEG_Z, Vec3::Y, 40.0, 1.0)
        .expect("a camera that looks along -z");
    let mut scene = Scene { indirect_light: true, ..Scene::empty(camera) };
    for (shape, material) in shapes {
        scene.materials.push(material.clone());
        scene.material_names.push(format!("material {}", scene.materials.len() - 1));
        scene.roots.push(scene.nodes.len());
        let material = Some(scene.materials.len() - 1);
        scene.nodes.push(Node { shape: Some(shape.clone()), material, ..Node::default() });
    }
    scene
}

/// The same under a light.
fn lit_scene(color: Vec3, shapes: &[(Shape, Material)]) -> Scene {
    Scene { lights: vec![light(color)], ..scene(shapes) }
}

/// The materials that diffuse rays leave, those that are sampled, and whether the environment map is.
type Needs = (&'static [usize], &'static [usize], bool);

const NOTHING: Needs = (&[], &[], false);
/// The first shape reflects light.
const WALL: Needs = (&[1], &[], false);
/// The first shape reflects light, and the second one is sampled as a light.
const BOTH: Needs = (&[1], &[2], false);

/// A scene, what its paths need, and what a mistake makes of it.
struct SceneForPaths {
    what: &'static str,
    scene: Scene,
    needs: Needs,
    mistakes: Vec<(Needs, &'static str)>,
}

/// How much of a colour of the scenes is used for a hidden seed. What a scene needs does not depend on it.
fn judge_all(trial: &Trial<'_>, cases: Vec<SceneForPaths>) -> CheckResult {
    let hidden = (0.1..1.0f32, 0.1..1.0f32, 1..9u32, 0..3usize);
    let (of_light, of_material, depth, turn) = trial.varied((1.0, 1.0, 5, 0), hidden);
    // The channels of all colours change places.
    let turned = |color: Vec3| {
        let channels = color.to_array();
        Vec3::from_array([0, 1, 2].map(|channel| channels[(channel + turn) % 3]))
    };
    let vary = |case: SceneForPaths| {
        let mut scene = case.scene;
        for light in &mut scene.lights {
            light.color = of_light * turned(light.color);
        }
        for material in &mut scene.materials {
            material.diffuse = of_material * turned(material.diffuse);
            material.emission = of_light * turned(material.emission);
        }
        match &mut scene.background {
            Background::Color(color) => *color = of_light * turned(*color),
            Background::Gradient(gradient) => {
                for color in [&mut gradient.zenith, &mut gradient.horizon, &mut gradient.nadir] {
                    *color = of_light * turned(*color);
                }
            }
            Background::Map(map) => map.scale *= of_light,
        }
        if scene.quality.max_depth > 0 {
            scene.quality.max_depth = depth;
        }
        SceneForPaths { scene, ..case }
    };
    let cases: Vec<SceneForPaths> = cases.into_iter().map(vary).collect();
    let scenes: Vec<Scene> = cases.iter().map(|case| case.scene.clone()).collect();
    // A text is a mistake of all cases, whose wrong answers differ.
    let mut texts: Vec<&str> = Vec::new();
    for (_, text) in cases.iter().flat_map(|case| &case.mistakes) {
        if !texts.contains(text) {
            texts.push(text);
        }
    }
    // The most specific one is named first.
    let n_cases = |text: &str| {
        cases.iter().filter(|case| case.mistakes.iter().any(|(_, other)| *other == text)).count()
    };
    texts.sort_by_key(|text| n_cases(text));
    let judge = |(case, yours): (&SceneForPaths, PathEffects)| {
        let n = case.scene.materials.len();
        let flags = |indices: &[usize]| (0..n).map(|index| indices.contains(&index)).collect::<Vec<bool>>();
        let effects = |(diffuse, sampled, environment): Needs| PathEffects {
            diffuse: flags(diffuse),
            sampled: flags(sampled),
            environment,
        };
        let expected = effects(case.needs);
        if yours == expected {
            return Ok(());
        }
        let has_length = yours.diffuse.len() == n && yours.sampled.len() == n;
        let part = |effects: &PathEffects| match () {
            () if yours.diffuse != expected.diffuse => format!("diffuse: {:?}", effects.diffuse),
            () if yours.sampled != expected.sampled => format!("sampled: {:?}", effects.sampled),
            () => format!("environment: {}", effects.environment),
        };
        let input = format!("paths_called_for of {}", case.what);
        let entries =
            (!has_length, "there is one entry per material of the scene, also for those without effects");
        let gives =
            |says: &str| case.mistakes.iter().any(|(wrong, text)| *text == says && yours == effects(*wrong));
        let mistakes = texts.iter().map(|text| (gives(text), *text));
        Err(Broken::with_texts(input, part(&yours), part(&expected), "the definition")
            .explained_by(std::iter::once(entries).chain(mistakes)))
    };
    all_hold(cases.iter().zip(trial.kit.paths_called_for(&scenes)).map(judge).collect())
}

fn case(what: &'static str, scene: Scene, needs: Needs, mistakes: &[(Needs, &'static str)]) -> SceneForPaths {
    SceneForPaths { what, scene, needs, mistakes: mistakes.to_vec() }
}

pub(super) fn no_paths_without_indirect_light(trial: &Trial<'_>) -> CheckResult {
    let wall = || (sphere(), diffuse(Vec3::ONE));
    let emitter = || (sphere(), glowing(Vec3::ONE));
    let lit = scene(&[wall(), emitter()]);
    let mut shallow = lit.clone();
    shallow.quality.max_depth = 0;
    const OFF: &str = "nothing is needed without scene.indirect_light";
    const DARK: &str = "nothing emits light, so no path finds any";
    const FLAT: &str = "with max_depth 0 no path has a bounce";
    let off = Scene { indirect_light: false, ..lit.clone() };
    let mut black_lights = scene(&[wall()]);
    black_lights.lights.push(light(Vec3::ZERO));
    black_lights.lights.push(Light { intensity: 0.0, ..light(Vec3::ONE) });
    let mut ambient = scene(&[wall()]);
    ambient.ambient = Vec3::ONE;
    let cases = vec![
        case("a diffuse sphere and one that emits light, with indirect light", lit, BOTH, &[]),
        case(
            "the same without indirect light",
            off,
            NOTHING,
            &[(BOTH, OFF), (WALL, OFF), ((&[], &[2], false), OFF)],
        ),
        case(
            "the same with max_depth 0",
            shallow,
            NOTHING,
            &[(BOTH, FLAT), (WALL, FLAT), ((&[], &[2], false), FLAT)],
        ),
        case("a diffuse sphere in the dark", scene(&[wall()]), NOTHING, &[(WALL, DARK)]),
        case(
            "a sphere that emits light and reflects none",
            scene(&[emitter()]),
            NOTHING,
            &[
                ((&[], &[1], false), "a light is sampled only if a surface reflects its light"),
                (WALL, "a black surface reflects no light"),
            ],
        ),
        case(
            "a diffuse sphere under a black light and one of intensity 0",
            black_lights,
            NOTHING,
            &[(WALL, "these lights emit nothing: use radiance()"), (WALL, DARK)],
        ),
        case(
            "a diffuse sphere in ambient light",
            ambient,
            NOTHING,
            &[(WALL, "ambient light stands for indirect light: it is not a source of it"), (WALL, DARK)],
        ),
    ];
    judge_all(trial, cases)
}

pub(super) fn every_source_of_light_calls_for_paths(trial: &Trial<'_>) -> CheckResult {
    let wall = || (sphere(), diffuse(Vec3::ONE));
    let with = |background: Background| Scene { background, ..scene(&[wall()]) };
    let gradient = |zenith, horizon, nadir| Background::Gradient(Gradient { zenith, horizon, nadir });
    let map = |scale| Background::Map(EnvironmentMap { texture: 0, rotation: 0.0, scale });
    let lit = lit_scene(RED, &[wall()]);
    let (zero, one) = (Vec3::ZERO, Vec3::ONE);
    const WITH_MAP: Needs = (&[1], &[], true);
    const LIGHTS: &str = "lights of the scene are light, too";
    const BACKGROUND: (Needs, &str) = (NOTHING, "the background is light, too");
    let dark_map = Scene { background: map(0.0), ..lit_scene(one, &[wall()]) };
    let sky = |what, background| case(what, with(background), WALL, &[BACKGROUND]);
    let mirror = (sphere(), Material { mirror: one, ..diffuse(zero) });
    let glass = (sphere(), Material { transmission: one, specular: one, ..diffuse(zero) });
    let cases = vec![
        case("a diffuse sphere under a red light", lit, WALL, &[(NOTHING, LIGHTS)]),
        sky("a diffuse sphere under a grey sky", Background::Color(0.1 * one)),
        sky("a diffuse sphere over a bright ground", gradient(zero, zero, one)),
        sky("a diffuse sphere under a bright zenith", gradient(one, zero, zero)),
        sky("a diffuse sphere before a bright horizon", gradient(zero, GREEN, zero)),
        case(
            "a diffuse sphere in a black gradient",
            with(gradient(zero, zero, zero)),
            NOTHING,
            &[(WALL, "a black gradient is no light")],
        ),
        case(
            "a diffuse sphere in an environment map",
            with(map(1.0)),
            WITH_MAP,
            &[BACKGROUND, (WALL, "an environment map is sampled")],
        ),
        case(
            "a diffuse sphere in an environment map of scale 0",
            with(map(0.0)),
            NOTHING,
            &[
                (WALL, "a map of scale 0 is no light"),
                (WITH_MAP, "a map of scale 0 is no light"),
                ((&[], &[], true), "a map of scale 0 is no light"),
            ],
        ),
        case(
            "a diffuse sphere under a light, in an environment map of scale 0",
            dark_map,
            WALL,
            &[(WITH_MAP, "a map of scale 0 is no light"), (NOTHING, LIGHTS)],
        ),
        case(
            "a diffuse sphere and a mirror under a light",
            lit_scene(one, &[wall(), mirror]),
            WALL,
            &[((&[1, 2], &[], false), "a mirror sends no diffuse rays"), (NOTHING, LIGHTS)],
        ),
        case(
            "a glass sphere with a highlight, and a diffuse one",
            lit_scene(one, &[glass, wall()]),
            (&[2], &[], false),
            &[((&[1, 2], &[], false), "glass and highlights send no diffuse rays"), (NOTHING, LIGHTS)],
        ),
        sky(
            "a diffuse sphere in a gradient whose zenith and horizon have the same colour",
            gradient(one, one, zero),
        ),
        sky(
            "a diffuse sphere in a gradient whose horizon and nadir have the same colour",
            gradient(zero, one, one),
        ),
    ];
    judge_all(trial, cases)
}

pub(super) fn paths_are_called_for_channel_by_channel(trial: &Trial<'_>) -> CheckResult {
    const CHANNELS: &str = "compare channel by channel: a red light adds nothing to a green wall";
    let wall = |color| (sphere(), diffuse(color));
    let emitter = |color| (sphere(), glowing(color));
    let red_light = lit_scene(RED, &[wall(GREEN), wall(RED)]);
    let map = Background::Map(EnvironmentMap { texture: 0, rotation: 0.0, scale: 1.0 });
    let black = Scene { background: map, ..scene(&[wall(Vec3::ZERO)]) };
    let two = scene(&[wall(RED), emitter(GREEN), emitter(RED)]);
    let mixed = scene(&[wall(GREEN), emitter(RED + GREEN)]);
    let sky = Scene { background: Background::Color(GREEN), ..scene(&[wall(GREEN), emitter(RED)]) };
    const UNREFLECTED: &str = "nothing reflects the light of the map";
    let cases = vec![
        case(
            "a green and a red sphere under a red light",
            red_light,
            (&[2], &[], false),
            &[((&[1, 2], &[], false), CHANNELS)],
        ),
        case(
            "a green sphere and a red emitter",
            scene(&[wall(GREEN), emitter(RED)]),
            NOTHING,
            &[(BOTH, CHANNELS), ((&[], &[2], false), CHANNELS), (WALL, CHANNELS)],
        ),
        case(
            "a red sphere, a green emitter and a red emitter",
            two,
            (&[1], &[3], false),
            &[((&[1], &[2, 3], false), CHANNELS)],
        ),
        case("a green sphere and a yellow emitter", mixed, BOTH, &[]),
        case("a green sphere and a red emitter under a green sky", sky, WALL, &[(BOTH, CHANNELS)]),
        case(
            "a black sphere in an environment map",
            black,
            NOTHING,
            &[((&[], &[], true), UNREFLECTED), ((&[1], &[], true), UNREFLECTED)],
        ),
    ];
    judge_all(trial, cases)
}

pub(super) fn lights_are_sampled_where_they_can_be(trial: &Trial<'_>) -> CheckResult {
    let wall = || (sphere(), diffuse(Vec3::ONE));
    let emitter = || (sphere(), glowing(Vec3::ONE));
    let plain = scene(&[wall(), (plane(), glowing(Vec3::ONE))]);
    let equation = Shape::PlaneEquation(PlaneEquation { normal: Vec3::Y, d: 1.0 });
    let equation = scene(&[wall(), (equation, glowing(Vec3::ONE))]);
    // The same material on a plane and on a sphere.
    let mut both = plain.clone();
    both.nodes.push(Node { shape: Some(sphere()), material: Some(2), ..Node::default() });
    both.roots.push(2);
    // An emitter that no root reaches, and the material of an emitter that no shape has.
    let mut hidden = scene(&[wall(), emitter()]);
    hidden.roots.pop();
    hidden.background = Background::Color(Vec3::ONE);
    hidden.materials.push(glowing(Vec3::ONE));
    hidden.material_names.push("unused".into());
    let dark = Scene { background: Background::Color(Vec3::ZERO), ..hidden.clone() };
    let moving = |shutter: Option<Shutter>| {
        let mut scene = scene(&[wall(), emitter()]);
        scene.nodes[1].transform_end = Some(Affine3A::from_translation(Vec3::X));
        scene.camera.shutter = shutter;
        scene
    };
    // A visible light has a shape with a material that emits its light.
    let mut visible = scene(&[wall(), emitter()]);
    let shape = AreaShape::Sphere(Sphere { center: Vec3::ZERO, radius: 1.0 });
    let area = Emitter::Area { shape, falloff: Falloff::InverseSquare };
    visible.lights.push(Light { emitter: area, ..light(Vec3::ONE) });
    visible.visible_lights.push(VisibleLight { light: 0, material: 2 });
    let glow = Material { emission: Vec3::ONE, ..diffuse(Vec3::ONE) };
    const STILL: &str = "a light moves only if the shutter closes later than it opens";
    const SHOWN: &str = "only shapes that a root reaches are shown: use scene.shown()";
    let sampled = |what, scene, mistake| case(what, scene, BOTH, &[(WALL, mistake)]);
    let not_sampled = |what, scene, mistake| case(what, scene, WALL, &[(BOTH, mistake)]);
    let cases = vec![
        not_sampled(
            "a diffuse sphere and a plane that emits light",
            plain,
            "an infinite plane is not sampled",
        ),
        not_sampled(
            "a diffuse sphere and a plane, given by its equation, that emits light",
            equation,
            "an infinite plane is not sampled",
        ),
        sampled(
            "a diffuse sphere, and a plane and a sphere of the same glowing material",
            both,
            "a material is sampled if one of its shapes can be",
        ),
        case(
            "a diffuse sphere and an emitter that no root reaches, under a sky",
            hidden,
            WALL,
            &[(BOTH, SHOWN), ((&[1], &[2, 3], false), SHOWN), ((&[1], &[3], false), SHOWN)],
        ),
        case(
            "a diffuse sphere and an emitter that no root reaches, in the dark",
            dark,
            NOTHING,
            &[(WALL, "the emission of a material that no shown shape has is no light"), (BOTH, SHOWN)],
        ),
        not_sampled(
            "a diffuse sphere and an emitter that moves",
            moving(Some(Shutter { open: 0.0, close: 1.0 })),
            "a light that moves is not sampled",
        ),
        sampled("a diffuse sphere and an emitter that would move, without a shutter", moving(None), STILL),
        sampled(
            "a diffuse sphere and an emitter that would move, with a shutter that closes when it opens",
            moving(Some(Shutter { open: 0.5, close: 0.5 })),
            STILL,
        ),
        not_sampled(
            "a diffuse sphere and a visible light",
            visible,
            "a visible light is sampled as a light, not as a surface",
        ),
        case(
            "one sphere that emits and reflects light",
            scene(&[(sphere(), glow)]),
            (&[1], &[1], false),
            &[
                (WALL, "a surface that reflects light can be sampled as a light, too"),
                (NOTHING, "a surface can emit and reflect light"),
            ],
        ),
        case(
            "two diffuse spheres of the same colour, and an emitter",
            scene(&[wall(), wall(), emitter()]),
            (&[1, 2], &[3], false),
            &[],
        ),
    ];
    judge_all(trial, cases)
}
