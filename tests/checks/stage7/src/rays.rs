//! The most rays that a scene can take.

use super::scenes::{light, one_sphere};
use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::judge::known;
use glam::Vec3;
use raykata::effects::{Effects, LightEffects, MaterialEffects};
use raykata::kit::{BoundQuery, KitError, RayCounts, kit_error};
use raykata::material::{Fresnel, Material};
use raykata::scene::{FilmSettings, Quality, Scene};

fn film(width: u32, height: u32) -> FilmSettings {
    FilmSettings { width, height, encoding: Default::default() }
}

/// A scene of one material, and what it takes.
fn query(material: Material, n_lights: usize, quality: Quality) -> BoundQuery {
    let mut scene = Scene { quality, ..one_sphere(material) };
    scene.lights = vec![light(Vec3::ONE, 1.0); n_lights];
    let material = &scene.materials[1];
    let through = material.transmission != Vec3::ZERO;
    let mirror = material.mirror != Vec3::ZERO || (through && material.fresnel != Fresnel::None);
    let takes = MaterialEffects {
        lights: (0..n_lights).collect(),
        mirror,
        transmission: through,
        glossy: material.roughness > 0.0 && (mirror || through),
        texture: false,
    };
    let effects = Effects {
        lights: vec![LightEffects { samples: 1, area: false, shadows: true }; n_lights],
        materials: vec![MaterialEffects::default(), takes],
        ..Effects::default()
    };
    BoundQuery { scene, effects }
}

fn judge(
    trial: &Trial<'_>,
    what: &str,
    query: BoundQuery,
    expected: RayCounts,
    diagnose: impl Fn(&RayCounts) -> &'static str,
) -> Outcome {
    let input = format!("most_rays of {what}");
    match kit_error::catch(|| trial.kit.most_rays(&[query]).remove(0)) {
        Ok(yours) if yours == expected => Ok(()),
        Ok(yours) => {
            Err(Broken::new(input, yours, expected, "counted by hand").looks_like(known(diagnose(&yours))))
        }
        Err(KitError::Panicked { message, place }) => {
            let overflow = message.contains("overflow");
            let broken = Broken::with_texts(
                input,
                format!("a panic at {place}: {message}"),
                format!("{expected:?}"),
                "counted by hand",
            );
            Err(broken
                .looks_like(overflow.then_some("a number that does not fit: count in u64, and saturate")))
        }
        Err(error) => kit_error::unwind(error),
    }
}

/// A scene of a mirror that is lit by two lights, and of glass that is lit by one of them.
fn mirror_and_glass(quality: Quality) -> BoundQuery {
    let mut query = query(Material { mirror: Vec3::ONE, ..Material::default() }, 2, quality);
    query.scene.materials.push(Material { transmission: Vec3::ONE, ..Material::default() });
    query.scene.material_names.push("glass".into());
    let glass = MaterialEffects { lights: vec![1], transmission: true, ..MaterialEffects::default() };
    query.effects.materials.push(glass);
    query
}

pub(super) fn shadow_arithmetic_of_the_lecture(trial: &Trial<'_>) -> Outcome {
    // Slide "Cost of shadow computation": 1000 × 1000 pixels, 10 lights.
    let mut query = query(Material::default(), 10, Quality::default());
    query.scene.film = film(1000, 1000);
    let expected = RayCounts { primary: 1_000_000, shadow: 10_000_000, ..RayCounts::default() };
    judge(trial, "1000 × 1000 pixels under 10 lights", query.clone(), expected, |_| "pixels · lights")?;
    query.scene.film = film(640, 480);
    let expected = RayCounts { primary: 307_200, shadow: 3_072_000, ..RayCounts::default() };
    judge(trial, "640 × 480 pixels under 10 lights", query.clone(), expected, |_| "width · height")?;
    query.scene.film = film(100_000, 100_000);
    let n = 10_000_000_000;
    let expected = RayCounts { primary: n, shadow: 10 * n, ..RayCounts::default() };
    judge(
        trial,
        "100,000 × 100,000 pixels under 10 lights",
        query.clone(),
        expected,
        |_| "a product that does not fit u32: make each factor a u64 before you multiply",
    )?;
    query.scene.film = film(1000, 1000);
    query.scene.quality.samples_per_pixel = 4;
    query.effects.lights[0].samples = 16;
    query.effects.lights[0].area = true;
    query.effects.lights[1].shadows = false;
    let expected = RayCounts { primary: 4_000_000, shadow: 4_000_000 * (16 + 8), ..RayCounts::default() };
    let what = "1000 × 1000 pixels with 4 samples, 10 lights, one of 16 samples and one without shadows";
    judge(trial, what, query, expected, |yours| match (yours.primary, yours.shadow / yours.primary.max(1)) {
        (1_000_000, _) => "samples a pixel multiply",
        (_, 9) => "an area light counts as often as it has samples",
        (_, 25) => "a light without shadows asks no ray",
        _ => "add up the samples of all lights that cast shadows",
    })
}

pub(super) fn bound_follows_the_bounces(trial: &Trial<'_>) -> Outcome {
    let grey = Vec3::splat(0.5);
    let parameters =
        |max_depth, min_contribution| Quality { max_depth, min_contribution, ..Quality::default() };
    let mirror = Material { mirror: grey, ..Material::default() };
    let counts =
        |primary, shadow, reflection, transmission| RayCounts { primary, shadow, reflection, transmission };
    judge(
        trial,
        "one pixel, a mirror of 1/2, depth 3",
        query(mirror.clone(), 2, parameters(3, 0.0)),
        counts(1, 8, 3, 0),
        |yours| match yours {
            RayCounts { reflection: 3, shadow: 2, .. } => {
                "only first hits are lit: every hit asks the lights"
            }
            RayCounts { reflection: 3, shadow: 6, .. } => "the hits of the last bounce are lit as well",
            RayCounts { reflection: 4.., .. } => "a bounce too many: max_depth of them",
            RayCounts { reflection: 2, .. } => "a bounce is missing: max_depth of them",
            _ => "one mirrored ray a bounce, and every hit is lit",
        },
    )?;
    judge(
        trial,
        "one pixel, a mirror of 1/2, depth 100, down to 1/100",
        query(mirror.clone(), 1, parameters(100, 0.01)),
        counts(1, 7, 6, 0),
        |yours| match yours.reflection {
            100 => "min_contribution is left out: only the depth ends this",
            7 => "the weight of the image decides, not that of the ray that sees it",
            _ => "1/64 reaches 1/100 and 1/128 does not: six bounces",
        },
    )?;
    judge(
        trial,
        "one pixel, a mirror of 1/2, depth 100, down to 1/8",
        query(mirror.clone(), 1, parameters(100, 0.125)),
        counts(1, 4, 3, 0),
        |_| "a weight of just min_contribution is traced",
    )?;
    let both = Material { mirror: grey, transmission: grey, ..Material::default() };
    judge(
        trial,
        "one pixel, half mirror and half glass, depth 3",
        query(both, 1, parameters(3, 0.0)),
        counts(1, 15, 7, 7),
        |_| "each hit sends two rays on, which send two on each",
    )?;
    let rough = Material { roughness: 0.5, mirror: Vec3::ONE, ..Material::default() };
    judge(
        trial,
        "one pixel, a rough mirror of 1 with 4 samples, depth 100, down to 1/100",
        query(rough, 1, Quality { glossy_samples: 4, ..parameters(100, 0.01) }),
        // Images weigh 1, 1/4, 1/16, 1/64, 1/256: four reach 1/100, with 4, 16, 64 and 256 rays.
        counts(1, 341, 340, 0),
        |yours| match yours.reflection {
            0..=100 => {
                "it is the whole image that has to reach min_contribution, or glossy_samples are left out"
            }
            _ => "each of the four rays counts a quarter, and its image a quarter of the one before",
        },
    )?;
    let glass = Material { transmission: Vec3::ONE, fresnel: Fresnel::Exact, ..Material::default() };
    judge(
        trial,
        "one pixel, glass by Fresnel, depth 2",
        query(glass, 1, parameters(2, 0.001)),
        counts(1, 7, 3, 3),
        |_| "with fresnel, glass mirrors as well",
    )?;
    let half = Material { mirror: grey, transmission: grey, fresnel: Fresnel::Exact, ..Material::default() };
    judge(
        trial,
        "one pixel, half mirror and half glass by Fresnel, depth 2, down to 3/4",
        query(half, 1, parameters(2, 0.75)),
        counts(1, 7, 3, 3),
        |_| "with fresnel the mirror image weighs up to mirror + transmission, which is 1 here",
    )?;
    judge(
        trial,
        "one pixel, a mirror under 2 lights and glass under 1, depth 2",
        mirror_and_glass(parameters(2, 0.0)),
        counts(1, 6, 2, 2),
        |yours| match yours {
            RayCounts { reflection: 3, transmission: 3, .. } => {
                "a hit is of one material: the most that any of them sends on, not the sum"
            }
            RayCounts { reflection: 2, transmission: 2, .. } => {
                "a hit asks the lights of one material, not of all"
            }
            _ => "a hit is of one material: take the most of both, each by itself",
        },
    )?;
    judge(
        trial,
        "one pixel, a mirror, depth 0",
        query(mirror, 1, parameters(0, 0.0)),
        counts(1, 1, 0, 0),
        |_| "no bounce at all",
    )
}

pub(super) fn bound_stays_at_the_largest_number(trial: &Trial<'_>) -> Outcome {
    let both = Material { mirror: Vec3::ONE, transmission: Vec3::ONE, ..Material::default() };
    let query = query(both, 3, Quality { max_depth: 1000, min_contribution: 0.0, ..Quality::default() });
    let expected = RayCounts { primary: 1, shadow: u64::MAX, reflection: u64::MAX, transmission: u64::MAX };
    judge(
        trial,
        "two perfect mirrors in one, depth 1000",
        query,
        expected,
        |_| "2¹⁰⁰⁰ does not fit: saturate every product and every sum",
    )
}
