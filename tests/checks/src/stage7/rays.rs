//! Rays, counted before they are traced.

use super::scenes::{lamp, one_ball};
use crate::Trial;
use crate::broken::{Broken, Outcome};
use crate::judge::{compare, known};
use glam::Vec3;
use proptest::prelude::*;
use raykata::effects::{Effects, LightEffects, MaterialEffects};
use raykata::kit::{BoundQuery, HitsQuery, MaterialHits, RayCounts};
use raykata::material::{Fresnel, Material};
use raykata::scene::{FilmSettings, Quality, Scene};

fn film(width: u32, height: u32) -> FilmSettings {
    FilmSettings { width, height, encoding: Default::default() }
}

/// A scene of one material, and what it takes.
fn query(material: Material, n_lights: usize, quality: Quality) -> BoundQuery {
    let mut scene = Scene { quality, ..one_ball(material) };
    scene.lights = vec![lamp(Vec3::ONE, 1.0); n_lights];
    let material = &scene.materials[1];
    let through = material.transmission != Vec3::ZERO;
    let mirror = material.mirror != Vec3::ZERO || (through && material.fresnel != Fresnel::None);
    let takes = MaterialEffects {
        lights: (0..n_lights).collect(),
        mirror,
        transmission: through,
        gloss: material.roughness > 0.0 && (mirror || through),
        texture: false,
    };
    let effects = Effects {
        lights: vec![LightEffects { samples: 1, area: false, shadows: true }; n_lights],
        materials: vec![MaterialEffects::default(), takes],
        ..Effects::default()
    };
    BoundQuery { scene, effects }
}

fn judge(trial: &Trial<'_>, what: &str, query: BoundQuery, expected: RayCounts, diagnosis: &str) -> Outcome {
    let yours = trial.kit.most_rays(&[query]).remove(0);
    match yours == expected {
        true => Ok(()),
        false => Err(Broken::new(format!("most_rays of {what}"), yours, expected, "counted by hand")
            .looks_like(known(diagnosis))),
    }
}

pub(super) fn shadow_arithmetic_of_the_lecture(trial: &Trial<'_>) -> Outcome {
    // Slide "Cost of shadow computation": 1000 × 1000 pixels, 10 lights.
    let mut query = query(Material::default(), 10, Quality::default());
    query.scene.film = film(1000, 1000);
    let expected = RayCounts { primary: 1_000_000, shadow: 10_000_000, ..RayCounts::default() };
    judge(trial, "1000 × 1000 pixels under 10 lights", query.clone(), expected, "pixels · lights")?;
    query.scene.quality.samples_per_pixel = 4;
    query.effects.lights[0].samples = 16;
    query.effects.lights[0].area = true;
    query.effects.lights[1].shadows = false;
    let expected = RayCounts { primary: 4_000_000, shadow: 4_000_000 * (16 + 8), ..RayCounts::default() };
    let diagnosis = "samples a pixel multiply, an area light counts as often as it has samples, a light without shadows not at all";
    judge(
        trial,
        "the same with 4 samples, one light of 16 samples and one without shadows",
        query,
        expected,
        diagnosis,
    )
}

pub(super) fn bound_follows_the_bounces(trial: &Trial<'_>) -> Outcome {
    let grey = Vec3::splat(0.5);
    let knobs = |max_depth, min_contribution| Quality { max_depth, min_contribution, ..Quality::default() };
    let mirror = Material { mirror: grey, ..Material::default() };
    let counts =
        |primary, shadow, reflection, transmission| RayCounts { primary, shadow, reflection, transmission };
    judge(
        trial,
        "one pixel, a mirror of 1/2, depth 3",
        query(mirror.clone(), 2, knobs(3, 0.0)),
        counts(1, 8, 3, 0),
        "one mirrored ray a bounce, and every hit is lit",
    )?;
    judge(
        trial,
        "one pixel, a mirror of 1/2, depth 100, down to 1/100",
        query(mirror.clone(), 1, knobs(100, 0.01)),
        counts(1, 7, 6, 0),
        "1/64 reaches 1/100 and 1/128 does not: six bounces",
    )?;
    let both = Material { mirror: grey, transmission: grey, ..Material::default() };
    judge(
        trial,
        "one pixel, half mirror and half glass, depth 3",
        query(both, 1, knobs(3, 0.0)),
        counts(1, 15, 7, 7),
        "each hit sends two rays on, which send two on each",
    )?;
    let rough = Material { roughness: 0.5, mirror: Vec3::ONE, ..Material::default() };
    judge(
        trial,
        "one pixel, a rough mirror of 1 with 4 samples, depth 100, down to 1/100",
        query(rough, 1, Quality { gloss_samples: 4, ..knobs(100, 0.01) }),
        // Images weigh 1, 1/4, 1/16, 1/64, 1/256: four reach 1/100, with 4, 16, 64 and 256 rays.
        counts(1, 341, 340, 0),
        "each of the four rays counts a quarter, and it is the whole image that has to reach min_contribution",
    )?;
    let glass = Material { transmission: Vec3::ONE, fresnel: Fresnel::Exact, ..Material::default() };
    judge(
        trial,
        "one pixel, glass by Fresnel, depth 2",
        query(glass, 1, knobs(2, 0.001)),
        counts(1, 7, 3, 3),
        "with fresnel, glass mirrors as well",
    )?;
    judge(
        trial,
        "one pixel, a mirror, depth 0",
        query(mirror, 1, knobs(0, 0.0)),
        counts(1, 1, 0, 0),
        "no bounce at all",
    )
}

pub(super) fn bound_stays_at_the_largest_number(trial: &Trial<'_>) -> Outcome {
    let both = Material { mirror: Vec3::ONE, transmission: Vec3::ONE, ..Material::default() };
    let query = query(both, 3, Quality { max_depth: 1000, min_contribution: 0.0, ..Quality::default() });
    let expected = RayCounts { primary: 1, shadow: u64::MAX, reflection: u64::MAX, transmission: u64::MAX };
    judge(trial, "two perfect mirrors in one, depth 1000", query, expected, "2¹⁰⁰⁰ does not fit: saturate")
}

fn hits_query() -> impl Strategy<Value = HitsQuery> + Clone {
    let light = (0..4u32, any::<bool>()).prop_map(|(samples, shadows)| LightEffects {
        samples,
        area: samples > 1,
        shadows,
    });
    let lights = prop::collection::vec(light, 3);
    let takes = (prop::collection::vec(any::<bool>(), 3), any::<[bool; 3]>()).prop_map(
        |(lit, [mirror, transmission, gloss])| MaterialEffects {
            lights: (0..3).filter(|&i| lit[i]).collect(),
            mirror,
            transmission,
            gloss: gloss && (mirror || transmission),
            texture: false,
        },
    );
    let materials = prop::collection::vec(takes, 3);
    let hits = (0..3usize, 0..100u64, prop::collection::vec(0..100u64, 3))
        .prop_map(|(material, hits, in_front)| MaterialHits { material, hits, in_front });
    let table = prop::collection::vec(hits, 0..4);
    (lights, materials, table, 1..5u32).prop_map(|(lights, materials, hits, gloss_samples)| HitsQuery {
        hits,
        effects: Effects { lights, materials, ..Effects::default() },
        quality: Quality { gloss_samples, ..Quality::default() },
    })
}

pub(super) fn rays_of_hits_are_exact(trial: &Trial<'_>) -> Outcome {
    trial.forall(2000, hits_query(), |queries| {
        compare(queries, trial.kit.rays_of_hits(queries), |query, yours| {
            let (mut expected, mut unlit, mut single) = (RayCounts::default(), 0, RayCounts::default());
            for MaterialHits { material, hits, in_front } in &query.hits {
                let takes = &query.effects.materials[*material];
                let parts = if takes.gloss { u64::from(query.quality.gloss_samples) } else { 1 };
                expected.primary += hits;
                for (light, places) in in_front.iter().enumerate() {
                    let matters = takes.lights.contains(&light) && query.effects.lights[light].shadows;
                    expected.shadow += if matters { *places } else { 0 };
                    unlit += places;
                }
                expected.reflection += if takes.mirror { hits * parts } else { 0 };
                expected.transmission += if takes.transmission { hits * parts } else { 0 };
                single.reflection += u64::from(takes.mirror) * hits;
            }
            if yours == expected {
                return Ok(());
            }
            let diagnosis = match () {
                () if yours.shadow == unlit => {
                    "lights that do not matter to the material, or cast no shadow, cost no ray"
                }
                () if yours.shadow != expected.shadow => {
                    "in_front counts places on lamps, over all hits: add them up"
                }
                () if yours.reflection == single.reflection => "a rough surface sends gloss_samples rays",
                () => "",
            };
            let input = format!(
                "rays_of_hits(&{:?},\n&{:?},\ngloss_samples {})",
                query.hits, query.effects.materials, query.quality.gloss_samples
            );
            Err(Broken::new(input, yours, expected, "counted one by one").looks_like(known(diagnosis)))
        })
    })
}

pub(super) fn samples_reach_the_error_that_is_asked_for(trial: &Trial<'_>) -> Outcome {
    // Powers of two, so that every quotient is exact.
    let cases = [
        (1.0, 0.5, 4),
        (1.0, 0.25, 16),
        (0.5, 0.5, 1),
        (0.25, 1.0, 1),
        (0.0, 0.5, 1),
        (0.0, 0.0, 1),
        (3.0, 2.0, 3),
        (1.0, 1.0 / 1024.0, 1 << 20),
        (1.0, 0.0, u32::MAX),
        (1e30, 1e-30, u32::MAX),
    ];
    let queries = cases.map(|(deviation, error, _)| (deviation, error));
    for ((deviation, error, expected), yours) in cases.into_iter().zip(trial.kit.samples_for_error(&queries))
    {
        if yours != expected {
            let root = f64::from(deviation) / f64::from(error);
            let diagnosis = match () {
                () if yours == 0 => "at least one sample",
                () if f64::from(yours) == root.ceil() => {
                    "the error falls with the root of n, not with n: square the quotient"
                }
                () if f64::from(yours) == (root * root).floor() => {
                    "rounded down, the error is still too large"
                }
                () => "",
            };
            let input = format!("samples_for_error({deviation:?}, {error:?})");
            return Err(
                Broken::new(input, yours, expected, "deviation / √n <= error").looks_like(known(diagnosis))
            );
        }
    }
    Ok(())
}
