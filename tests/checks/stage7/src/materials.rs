//! Checks of `material_effects`.

use super::scenes::light;
use checks::prelude::*;
use raykata::effects::MaterialEffects;
use raykata::material::{Fresnel, Light, Material};
use raykata::scene::Quality;

/// A material that reflects, transmits and emits no light.
fn black() -> Material {
    Material { ambient: Vec3::ZERO, diffuse: Vec3::ZERO, index_of_refraction: 1.5, ..Material::default() }
}

/// Materials with few colours, each with a `max_depth` and the effects that it needs under a red, a green, a faint
/// blue, a white and a black light. Derived by hand from the doc comment of `material_effects`.
fn recorded() -> Vec<(MaterialQuery, MaterialEffects)> {
    let (red, green, blue) = (vec3(0.5, 0.0, 0.0), vec3(0.0, 0.5, 0.0), vec3(0.0, 0.0, 0.5));
    let faint = vec3(0.0, 0.0, 1e-4);
    let (white, image, rough) = (Vec3::splat(0.5), Some(0), 0.25);
    let lights = [red, green, faint, Vec3::ONE, Vec3::ZERO].map(|color| light(color, 1.0));
    let nothing = MaterialEffects::default;
    let lit = |lights: &[usize]| MaterialEffects { lights: lights.to_vec(), ..nothing() };
    let reads = || MaterialEffects { texture: true, ..nothing() };
    let mirrors = || MaterialEffects { mirror: true, ..nothing() };
    let passes = || MaterialEffects { transmission: true, ..nothing() };
    let splits = || MaterialEffects { transmission: true, ..mirrors() };
    let blurs = |sharp: MaterialEffects| MaterialEffects { glossy: true, ..sharp };
    let diffuse = |diffuse| Material { diffuse, ..black() };
    let specular = |specular| Material { specular, ..black() };
    let ambient = |ambient| Material { ambient, ..black() };
    let mirror = |mirror| Material { mirror, ..black() };
    let glass = |transmission, fresnel| Material { transmission, fresnel, ..black() };
    let (none, schlick, exact) = (Fresnel::None, Fresnel::Schlick, Fresnel::Exact);
    let cases = [
        (black(), 2, nothing()),
        (diffuse(red), 2, lit(&[0, 3])),
        (diffuse(green), 0, lit(&[1, 3])),
        (diffuse(blue), 1, lit(&[2, 3])),
        (diffuse(faint), 1, lit(&[2, 3])),
        (diffuse(white), 1, lit(&[0, 1, 2, 3])),
        (specular(red), 0, lit(&[0, 3])),
        (specular(green), 2, lit(&[1, 3])),
        (specular(faint), 1, lit(&[2, 3])),
        (Material { specular: green, ..diffuse(red) }, 1, lit(&[0, 1, 3])),
        (ambient(white), 1, nothing()),
        (mirror(red), 1, mirrors()),
        (mirror(blue), 2, mirrors()),
        (mirror(faint), 1, mirrors()),
        (mirror(white), 0, nothing()),
        (glass(green, none), 1, passes()),
        (glass(faint, none), 2, passes()),
        (glass(white, none), 0, nothing()),
        (Material { index_of_refraction: 1.0, ..glass(white, none) }, 1, passes()),
        (glass(green, schlick), 1, splits()),
        (glass(red, exact), 2, splits()),
        (glass(white, schlick), 0, nothing()),
        (Material { mirror: red, ..glass(blue, none) }, 1, splits()),
        (Material { mirror: red, ..glass(blue, exact) }, 0, nothing()),
        (glass(Vec3::ZERO, schlick), 1, nothing()),
        (glass(Vec3::ZERO, exact), 1, nothing()),
        (Material { coat: 1.5, ..black() }, 1, mirrors()),
        (Material { coat: 0.75, ..black() }, 2, mirrors()),
        (Material { coat: 1.5, ..black() }, 0, nothing()),
        (
            Material { coat: 1.5, roughness: rough, ..diffuse(red) },
            1,
            MaterialEffects { lights: vec![0, 3], ..blurs(mirrors()) },
        ),
        (Material { roughness: rough, ..black() }, 1, nothing()),
        (Material { roughness: rough, ..diffuse(red) }, 1, lit(&[0, 3])),
        (Material { roughness: rough, ..mirror(red) }, 1, blurs(mirrors())),
        (Material { roughness: rough, ..glass(green, none) }, 1, blurs(passes())),
        (Material { roughness: rough, ..glass(green, exact) }, 2, blurs(splits())),
        (Material { roughness: rough, ..mirror(white) }, 0, nothing()),
        (Material { roughness: rough, ..glass(white, none) }, 0, nothing()),
        (Material { texture: image, ..black() }, 1, nothing()),
        (Material { texture: image, ..specular(red) }, 1, lit(&[0, 3])),
        (Material { texture: image, ..mirror(red) }, 1, mirrors()),
        (Material { texture: image, ..glass(red, none) }, 1, passes()),
        (Material { texture: image, ..ambient(blue) }, 1, reads()),
        (Material { texture: image, ..ambient(faint) }, 0, reads()),
        (Material { texture: image, ..diffuse(red) }, 1, MaterialEffects { lights: vec![0, 3], ..reads() }),
        (Material { texture: image, ..diffuse(faint) }, 0, MaterialEffects { lights: vec![2, 3], ..reads() }),
    ];
    let query = |(material, max_depth, expected)| {
        let quality = Quality { max_depth, ..Quality::default() };
        (MaterialQuery { material, lights: lights.to_vec(), quality }, expected)
    };
    cases.into_iter().map(query).collect()
}

/// The colours of a material that [`color`] draws.
fn colors(material: &mut Material) -> [&mut Vec3; N_COLORS] {
    let Material { ambient, diffuse, specular, mirror, transmission, .. } = material;
    [ambient, diffuse, specular, mirror, transmission]
}

/// For each colour of the material: the same material with all other colours black.
fn by_color(query: &MaterialQuery) -> Vec<MaterialQuery> {
    let alone = |kept: usize| {
        let mut query = query.clone();
        let others = colors(&mut query.material).into_iter().enumerate().filter(|(i, _)| *i != kept);
        others.for_each(|(_, color)| *color = Vec3::ZERO);
        query
    };
    (0..N_COLORS).map(alone).collect()
}

/// The same query with every colour of the material and of its lights changed.
fn recolored(query: &MaterialQuery, change: impl Fn(Vec3) -> Vec3) -> MaterialQuery {
    let mut query = query.clone();
    let of_lights = query.lights.iter_mut().map(|light| &mut light.color);
    of_lights.chain(colors(&mut query.material)).for_each(|color| *color = change(*color));
    query
}

/// For each channel: the same query with all other channels black.
fn by_channel(query: &MaterialQuery) -> Vec<MaterialQuery> {
    [Vec3::X, Vec3::Y, Vec3::Z].map(|channel| recolored(query, |color| color * channel)).to_vec()
}

const N_COLORS: usize = 5;
const N_CHANNELS: usize = 3;

/// The union of the answers: an effect is set if any answer sets it.
fn together(answers: &[MaterialEffects]) -> MaterialEffects {
    let any = |said: fn(&MaterialEffects) -> bool| answers.iter().any(said);
    let mut lights: Vec<usize> = answers.iter().flat_map(|one| one.lights.clone()).collect();
    lights.sort_unstable();
    lights.dedup();
    MaterialEffects {
        lights,
        mirror: any(|one| one.mirror),
        transmission: any(|one| one.transmission),
        glossy: any(|one| one.glossy),
        texture: any(|one| one.texture),
    }
}

/// Rotates the channels and changes their amounts. Channels of 0 stay 0.
fn turned(color: Vec3) -> Vec3 {
    vec3(color.z, color.x, color.y).map(|share| if share > 0.0 { 1e-5 / share } else { 0.0 })
}

/// Variants of a material, each with the effects that it must need if the material needs `yours`.
fn variants(query: &MaterialQuery, yours: &MaterialEffects) -> Vec<(MaterialQuery, MaterialEffects)> {
    let with = |material: Material| MaterialQuery { material, ..query.clone() };
    let material = || query.material.clone();
    let depth =
        |max_depth| MaterialQuery { quality: Quality { max_depth, ..query.quality }, ..query.clone() };
    let under = |lights: &[Light]| MaterialQuery { lights: lights.to_vec(), ..query.clone() };
    let (first, others) = query.lights.split_at(query.lights.len().min(1));
    let same = || yours.clone();
    let lit_by = |lights: Vec<usize>| MaterialEffects { lights, ..same() };
    let no_glass = query.material.transmission == Vec3::ZERO;
    let fresnel = match query.material.fresnel {
        Fresnel::None if no_glass => Fresnel::Schlick,
        Fresnel::None => Fresnel::None,
        Fresnel::Schlick => Fresnel::Exact,
        Fresnel::Exact => Fresnel::Schlick,
    };
    let mut variants = vec![
        // The order of the channels and the amount of a colour do not matter.
        (recolored(query, turned), same()),
        (with(Material { index_of_refraction: 1.25, ..material() }), same()),
        (with(Material { fresnel, ..material() }), same()),
        (with(Material { texture: None, ..material() }), MaterialEffects { texture: false, ..same() }),
        (with(Material { roughness: 0.0, ..material() }), MaterialEffects { glossy: false, ..same() }),
        (depth(0), MaterialEffects { mirror: false, transmission: false, glossy: false, ..same() }),
        // Whether a light matters does not depend on the other lights.
        (under(first), lit_by(yours.lights.iter().copied().filter(|i| *i == 0).collect())),
        (under(others), lit_by(yours.lights.iter().filter_map(|i| i.checked_sub(1)).collect())),
    ];
    if query.quality.max_depth > 0 {
        variants.push((depth(3), same()));
    }
    variants
}

/// The mistakes in an answer for a material whose effects are known, each with whether it explains the difference.
fn material_mistakes(
    query: &MaterialQuery,
    yours: &MaterialEffects,
    expected: &MaterialEffects,
) -> Vec<(bool, &'static str)> {
    let shown = query.quality.max_depth > 0;
    let material = &query.material;
    let more = expected.lights.iter().all(|light| yours.lights.contains(light));
    let fewer = yours.lights.iter().all(|light| expected.lights.contains(light));
    let lights_differ = yours.lights != expected.lights;
    let through = material.transmission != Vec3::ZERO;
    // Some effects follow from others, so the first wrong one decides.
    let mirror = !lights_differ && yours.mirror != expected.mirror;
    let transmission = !lights_differ && yours.transmission != expected.transmission;
    let same_rays = !lights_differ && !mirror && !transmission;
    let mirror_alone = mirror && !transmission && shown;
    named![
        lights_differ && more && yours.lights.len() > expected.lights.len() =>
            "you list a light that adds nothing: in each channel, its radiance or diffuse and specular are 0",
        lights_differ && fewer && yours.lights.len() < expected.lights.len() =>
            "you leave out a light that matters: one channel of diffuse or specular is enough, and so is faint light",
        !shown && (mirror || transmission) => "with max_depth 0 a surface spawns no secondary rays",
        mirror_alone && material.coat != 1.0 => "a coat, which is not 1, reflects rays",
        mirror_alone && material.mirror == Vec3::ZERO =>
            "with fresnel, a material reflects if its transmission is not 0, and only then",
        mirror_alone && material.mirror != Vec3::ZERO => "rays are reflected if some channel of mirror is not 0",
        transmission && through && shown =>
            "rays are refracted if some channel of transmission is not 0, for every index of refraction",
        same_rays && yours.glossy != expected.glossy =>
            "glossy is true if roughness is above 0 and the material reflects or refracts rays",
        same_rays && yours.texture != expected.texture =>
            "an image matters if diffuse or ambient, which it multiplies, is not 0: otherwise texture is false",
    ].to_vec()
}

fn compare_effects(
    query: &MaterialQuery,
    yours: &MaterialEffects,
    expected: &MaterialEffects,
    source: &'static str,
) -> CheckResult {
    if yours == expected {
        return Ok(());
    }
    // Which of the two answers is wrong is not known, so no mistake is.
    Err(Broken::new(describe(query), yours, expected, source))
}

fn color() -> impl Strategy<Value = Vec3> + Clone {
    checks::generate::vector(prop_oneof![3 => Just(0.0f32), 2 => Just(0.5f32), 1 => Just(1e-4f32)])
}

fn material_query() -> impl Strategy<Value = MaterialQuery> + Clone {
    let fresnel = prop_oneof![Just(Fresnel::None), Just(Fresnel::Schlick), Just(Fresnel::Exact)];
    let rough = prop_oneof![Just(0.0f32), Just(0.25f32)];
    let texture = prop_oneof![Just(None), Just(Some(0))];
    let index = prop_oneof![Just(1.0f32), Just(1.5f32)];
    let lights = prop::collection::vec(color().prop_map(|color| light(color, 2.0)), 0..4);
    let drawn =
        ((color(), color(), color(), color(), color()), fresnel, rough, texture, lights, 0..3u32, index);
    drawn.prop_map(|(drawn, fresnel, roughness, texture, lights, max_depth, index_of_refraction)| {
        let mut material = Material { index_of_refraction, fresnel, roughness, texture, ..black() };
        colors(&mut material)
            .into_iter()
            .zip(<[Vec3; N_COLORS]>::from(drawn))
            .for_each(|(color, drawn)| *color = drawn);
        MaterialQuery { material, lights, quality: Quality { max_depth, ..Quality::default() } }
    })
}

fn describe(query: &MaterialQuery) -> String {
    let Material { ambient, diffuse, specular, mirror, transmission, .. } = query.material;
    let Material { index_of_refraction, fresnel, roughness, coat, texture, .. } = query.material;
    let max_depth = query.quality.max_depth;
    let radiances: Vec<Vec3> = query.lights.iter().map(Light::radiance).collect();
    format!(
        "material_effects of ambient {ambient}, diffuse {diffuse}, specular {specular}, mirror {mirror}, \
         transmission {transmission}, index {index_of_refraction}, fresnel {fresnel:?}, roughness {roughness}, \
         coat {coat}, texture {texture:?}, max_depth {max_depth},\nunder lights of radiance {}",
        list(&radiances)
    )
}

/// Compares simple materials with recorded answers, and other materials with the student's own answers for simpler
/// ones: a material needs the union of what its colours need, and the union of what its channels need. Each setting
/// changes only its own effect.
pub(super) fn materials_take_what_they_show(trial: &Trial<'_>) -> CheckResult {
    let recorded = recorded();
    let queries: Vec<MaterialQuery> = recorded.iter().map(|(query, _)| query.clone()).collect();
    all_hold(compare(&recorded, trial.kit.material_effects(&queries), |(query, expected), yours| {
        let mistakes = material_mistakes(query, &yours, expected);
        compare_effects(query, &yours, expected, "the definition")
            .map_err(|broken| broken.explained_by(mistakes))
    }))?;
    trial.forall(1000, material_query(), |queries| {
        let ask = |queries: &[MaterialQuery]| trial.kit.material_effects(queries);
        let yours = ask(queries);
        let unions = |parts: fn(&MaterialQuery) -> Vec<MaterialQuery>, n_parts| -> Vec<MaterialEffects> {
            let parts: Vec<MaterialQuery> = queries.iter().flat_map(parts).collect();
            ask(&parts).chunks(n_parts).map(together).collect()
        };
        let (colors, channels) = (unions(by_color, N_COLORS), unions(by_channel, N_CHANNELS));
        let variants: Vec<_> =
            queries.iter().zip(&yours).map(|(query, yours)| variants(query, yours)).collect();
        let asked: Vec<MaterialQuery> = variants.iter().flatten().map(|(query, _)| query.clone()).collect();
        let mut answers = ask(&asked).into_iter();
        let judge = |index: usize| {
            let (query, yours, variants) = (&queries[index], &yours[index], &variants[index]);
            let answers: Vec<MaterialEffects> = answers.by_ref().take(variants.len()).collect();
            let of_colors = "the union of your answers for each of its colours";
            compare_effects(query, yours, &colors[index], of_colors)?;
            compare_effects(query, yours, &channels[index], "the union of your answers for each channel")?;
            variants.iter().zip(&answers).try_for_each(|((variant, expected), yours)| {
                compare_effects(variant, yours, expected, "what your answer for another material implies")
            })
        };
        (0..queries.len()).map(judge).collect()
    })
}
