//! Checks of `light_effects`.

use super::scenes::{ONE_SAMPLE, light, sphere_light};
use checks::prelude::*;
use raykata::effects::LightEffects;
use raykata::material::{AreaShape, Emitter, Falloff, Light};
use raykata::scene::Quality;

/// A light, and what it needs.
#[derive(Clone)]
struct LightCase {
    name: &'static str,
    query: LightQuery,
    expected: LightEffects,
    /// What the light would need if it were bright.
    bright: LightEffects,
}

fn light_cases() -> Vec<LightCase> {
    let one = ONE_SAMPLE;
    let area = |samples| LightEffects { samples, area: true, shadows: true };
    let silent = |light: Light| Light { shadows: false, ..light };
    let case = |name, light: Light, light_samples, expected, bright| LightCase {
        name,
        query: LightQuery { light, quality: Quality { light_samples, ..Quality::default() } },
        expected,
        bright,
    };
    let lit = |name, light, light_samples, needs| case(name, light, light_samples, needs, needs);
    let dark = |name, light, light_samples, bright| {
        case(name, light, light_samples, LightEffects::default(), bright)
    };
    let sun = Light { emitter: Emitter::Directional { direction: Vec3::NEG_Y }, ..light(Vec3::ONE, 2.0) };
    let rectangle = AreaShape::Rectangle { corner: Vec3::Y, edges: (Vec3::X, Vec3::Z) };
    let rectangle = Emitter::Area { shape: rectangle, falloff: Falloff::None };
    vec![
        lit("a white light", light(Vec3::ONE, 1.0), 4, one),
        lit("a directional light", sun, 9, one),
        lit(
            "a light that casts no shadows",
            silent(light(Vec3::ONE, 1.0)),
            1,
            LightEffects { shadows: false, ..one },
        ),
        dark("a light of intensity 0", light(Vec3::ONE, 0.0), 1, one),
        dark("a black light", light(Vec3::ZERO, 3.0), 1, one),
        lit("a faint white light", light(Vec3::splat(1e-6), 1.0), 1, one),
        lit("a red light", light(vec3(1.0, 0.0, 0.0), 1.0), 1, one),
        lit("a faint red light", light(vec3(1e-6, 0.0, 0.0), 1.0), 1, one),
        lit("a spherical area light", sphere_light(Vec3::ONE), 16, area(16)),
        lit("a rectangular area light", Light { emitter: rectangle, ..light(Vec3::ONE, 1.0) }, 7, area(7)),
        lit(
            "a spherical area light that casts no shadows",
            silent(sphere_light(Vec3::ONE)),
            16,
            LightEffects { shadows: false, ..area(16) },
        ),
        lit("a spherical area light with light_samples = 1", sphere_light(Vec3::ONE), 1, area(1)),
        lit("a spherical area light with light_samples = 0", sphere_light(Vec3::ONE), 0, one),
        dark("a black spherical area light", sphere_light(Vec3::ZERO), 16, area(16)),
    ]
}

const TOO_FEW: &str = "you use 1 sample: an area light needs quality.light_samples samples";

/// The known mistakes, each with whether it gives this answer.
fn light_mistakes(case: &LightCase, yours: &LightEffects) -> Vec<(bool, &'static str)> {
    let LightCase { query: LightQuery { light, quality }, expected, bright, .. } = case;
    let nothing = LightEffects::default();
    let is_area = matches!(light.emitter, Emitter::Area { .. });
    let (n, radiance) = (quality.light_samples, light.radiance());
    let is_lit = *expected != nothing;
    let dark_if = |dark: bool| if dark { nothing } else { *bright };
    // A change of the answer for lights of some kind.
    let changed = |applies: bool, change: LightEffects| if is_lit && applies { change } else { *expected };
    let with = |applies, samples, area| changed(applies, LightEffects { samples, area, ..*expected });
    let many = is_area && n > 0;
    let is = |wrong: LightEffects| *yours == wrong;
    named![
        is(with(!is_area, n, false)) => "a point light needs 1 sample: light_samples counts for area lights only",
        is(changed(true, LightEffects { shadows: true, ..*expected })) =>
            "you set shadows for every light: a light without shadows still needs 1 sample, and shadows = light.shadows",
        is(changed(!light.shadows, nothing)) =>
            "you return the default for a light without shadows: a light without shadows still needs 1 sample, and shadows = light.shadows",
        is(dark_if(false)) => "a light that emits nothing needs nothing: LightEffects::default()",
        is(if is_lit { *expected } else { LightEffects { shadows: light.shadows, ..nothing } }) =>
            "a light that emits nothing needs no shadows either: LightEffects::default()",
        is(dark_if(light.color == Vec3::ZERO)) =>
            "you test the colour only, but a light of intensity 0 is dark, too: a light that emits nothing needs nothing",
        is(dark_if(light.intensity == 0.0)) =>
            "you test the intensity only: a black light emits nothing, so it needs nothing",
        is(dark_if(radiance.min_element() == 0.0)) =>
            "you return the default for a light that is black in one channel: a faint red light still emits, so test whether all channels are 0",
        is(dark_if(radiance.max_element() < 1e-2)) =>
            "you return the default for dim lights: a faint red light still emits, so compare with 0",
        is(with(many, 1, true)) => TOO_FEW,
        is(with(many, 1, false)) => TOO_FEW,
        is(with(many, n + 1, true)) => "you add a sample: an area light needs quality.light_samples samples",
        is(with(is_area, n, true)) => "with light_samples = 0 an area light needs 1 sample, and area is false",
        is(with(is_area && n == 0, 0, false)) =>
            "you use 0 samples: with light_samples = 0 an area light needs 1 sample, and area is false",
        is(with(is_area && n == 0, 1, true)) => "with light_samples = 0 area is false",
        is(with(is_area && n == 1, 1, false)) =>
            "a single sample is drawn at random, too: area is true if light_samples is above 0",
    ].to_vec()
}

pub(super) fn lights_take_what_they_are(trial: &Trial<'_>) -> CheckResult {
    let cases = light_cases();
    let queries: Vec<LightQuery> = cases.iter().map(|case| case.query.clone()).collect();
    all_hold(compare(&cases, trial.kit.light_effects(&queries), |case, yours| {
        let broken = || {
            let (name, n) = (case.name, case.query.quality.light_samples);
            let input = format!("light_effects of {name}, light_samples {n}");
            Broken::new(input, yours, case.expected, "the definition")
        };
        unless(yours == case.expected, broken).formulas(light_mistakes(case, &yours))
    }))?;
    trial.forall(200, drawn_lights(), |drawn| {
        let queries: Vec<LightQuery> = drawn.iter().map(|(query, _)| query.clone()).collect();
        compare(drawn, trial.kit.light_effects(&queries), |(query, expected), yours| {
            if yours == *expected {
                return Ok(());
            }
            let input = format!("light_effects of {query:?}");
            Err(Broken::new(input, yours, *expected, "the definition"))
        })
    })
}

/// Lights of all kinds, one in five of them dark, with up to 64 samples, and what each needs.
fn drawn_lights() -> impl Strategy<Value = (LightQuery, LightEffects)> + 'static {
    let channel = || prop_oneof![Just(0.0), 0.01f32..5.0];
    // One channel is not 0.
    let color = (channel(), channel(), 0.01f32..5.0, 0..3usize).prop_map(|(one, other, bright, axis)| {
        let mut channels = [one, other, bright];
        channels.swap(2, axis);
        Vec3::from(channels)
    });
    // How much of the colour and of the intensity is left: a light without one of them is dark.
    let left = prop_oneof![8 => Just((1.0f32, 1.0f32)), 1 => Just((0.0, 1.0)), 1 => Just((1.0, 0.0))];
    let position = rough_point(9.0);
    (0..4, position, color, 0.01f32..9.0, left, any::<bool>(), 0..=64u32).prop_map(
        |(kind, position, color, intensity, left, shadows, light_samples)| {
            let falloff = Falloff::None;
            let sphere = AreaShape::Sphere(Sphere { center: position, radius: 0.5 });
            let rectangle = AreaShape::Rectangle { corner: position, edges: (Vec3::X, Vec3::Z) };
            let one_sample = LightEffects { shadows, ..ONE_SAMPLE };
            let by_area = match light_samples {
                0 => one_sample,
                samples => LightEffects { samples, area: true, shadows },
            };
            let (emitter, bright) = match kind {
                0 => (Emitter::Point { position, falloff }, one_sample),
                1 => (Emitter::Directional { direction: Vec3::NEG_Y }, one_sample),
                2 => (Emitter::Area { shape: sphere, falloff }, by_area),
                _ => (Emitter::Area { shape: rectangle, falloff }, by_area),
            };
            let expected = if left == (1.0, 1.0) { bright } else { LightEffects::default() };
            let (color, intensity) = (left.0 * color, left.1 * intensity);
            let light = Light { emitter, color, intensity, shadows, cone: None };
            let quality = Quality { light_samples, ..Quality::default() };
            (LightQuery { light, quality }, expected)
        },
    )
}
