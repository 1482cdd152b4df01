//! Checks of `most_rays`.

use super::scenes::{light, one_sphere};
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::known;
use glam::Vec3;
use raykata::effects::{Effects, LightEffects, MaterialEffects};
use raykata::kit::{BoundQuery, KitError, RayCounts, kit_error};
use raykata::material::{Fresnel, Material};
use raykata::scene::{FilmSettings, Quality, Scene};

fn film(width: u32, height: u32) -> FilmSettings {
    FilmSettings { width, height, encoding: Default::default() }
}

/// A scene with one material besides the default one, and its effects.
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
) -> CheckResult {
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
            Err(broken.looks_like(
                overflow
                    .then_some("a number overflows: count in u64, with saturating_add and saturating_mul"),
            ))
        }
        Err(error) => kit_error::unwind(error),
    }
}

/// A scene with a mirror that two lights illuminate, and with glass that one of them illuminates.
fn mirror_and_glass(quality: Quality) -> BoundQuery {
    let mut query = query(Material { mirror: Vec3::ONE, ..Material::default() }, 2, quality);
    query.scene.materials.push(Material { transmission: Vec3::ONE, ..Material::default() });
    query.scene.material_names.push("glass".into());
    let glass = MaterialEffects { lights: vec![1], transmission: true, ..MaterialEffects::default() };
    query.effects.materials.push(glass);
    query
}

pub(super) fn shadow_arithmetic_of_the_lecture(trial: &Trial<'_>) -> CheckResult {
    // Slide "Cost of shadow computation": 1000 × 1000 pixels, 10 lights.
    let mut query = query(Material::default(), 10, Quality::default());
    query.scene.film = film(1000, 1000);
    let expected = RayCounts { primary: 1_000_000, shadow: 10_000_000, ..RayCounts::default() };
    judge(
        trial,
        "1000 × 1000 pixels under 10 lights",
        query.clone(),
        expected,
        |_| "shadow rays = pixels · lights",
    )?;
    query.scene.film = film(640, 480);
    let expected = RayCounts { primary: 307_200, shadow: 3_072_000, ..RayCounts::default() };
    judge(trial, "640 × 480 pixels under 10 lights", query.clone(), expected, |_| "pixels = width · height")?;
    query.scene.film = film(100_000, 100_000);
    let n = 10_000_000_000;
    let expected = RayCounts { primary: n, shadow: 10 * n, ..RayCounts::default() };
    judge(
        trial,
        "100,000 × 100,000 pixels under 10 lights",
        query.clone(),
        expected,
        |_| "a product overflows u32: convert each factor to u64 before you multiply",
    )?;
    query.scene.film = film(1000, 1000);
    query.scene.quality.samples_per_pixel = 4;
    query.effects.lights[0].samples = 16;
    query.effects.lights[0].area = true;
    query.effects.lights[1].shadows = false;
    let expected = RayCounts { primary: 4_000_000, shadow: 4_000_000 * (16 + 8), ..RayCounts::default() };
    let what = "1000 × 1000 pixels with 4 samples each, 10 lights, one of 16 samples and one without shadows";
    judge(trial, what, query, expected, |yours| match (yours.primary, yours.shadow / yours.primary.max(1)) {
        (1_000_000, _) => "you leave out samples_per_pixel",
        (_, 9) => "you count one shadow ray per light: an area light needs one per sample",
        (_, 25) => "you count a light that casts no shadows",
        _ => "add up the samples of all lights that cast shadows",
    })
}

pub(super) fn bound_follows_the_bounces(trial: &Trial<'_>) -> CheckResult {
    let grey = Vec3::splat(0.5);
    let parameters =
        |max_depth, min_contribution| Quality { max_depth, min_contribution, ..Quality::default() };
    let mirror = Material { mirror: grey, ..Material::default() };
    let counts =
        |primary, shadow, reflection, transmission| RayCounts { primary, shadow, reflection, transmission };
    judge(
        trial,
        "one pixel, a mirror of 1/2, max_depth 3",
        query(mirror.clone(), 2, parameters(3, 0.0)),
        counts(1, 8, 3, 0),
        |yours| match yours {
            RayCounts { reflection: 3, shadow: 2, .. } => {
                "you count shadow rays of the first hits only: every hit needs them"
            }
            RayCounts { reflection: 3, shadow: 6, .. } => {
                "you leave out the shadow rays of the last bounce's hits"
            }
            RayCounts { reflection: 4.., .. } => "you count a bounce too many: there are max_depth bounces",
            RayCounts { reflection: 2, .. } => "you count a bounce too few: there are max_depth bounces",
            _ => "there is one reflected ray per bounce, and every hit needs shadow rays",
        },
    )?;
    judge(
        trial,
        "one pixel, a mirror of 1/2, max_depth 100, min_contribution 1/100",
        query(mirror.clone(), 1, parameters(100, 0.01)),
        counts(1, 7, 6, 0),
        |yours| match yours.reflection {
            100 => "you leave out min_contribution: only max_depth ends your loop",
            7 => {
                "you compare the weight of the incoming ray with min_contribution: compare that of the \
                 reflection"
            }
            _ => "1/64 is at least 1/100 and 1/128 is less: there are six bounces",
        },
    )?;
    judge(
        trial,
        "one pixel, a mirror of 1/2, max_depth 100, min_contribution 1/8",
        query(mirror.clone(), 1, parameters(100, 0.125)),
        counts(1, 4, 3, 0),
        |_| "a ray whose weight is exactly min_contribution is traced",
    )?;
    let both = Material { mirror: grey, transmission: grey, ..Material::default() };
    judge(
        trial,
        "one pixel, half mirror and half glass, max_depth 3",
        query(both, 1, parameters(3, 0.0)),
        counts(1, 15, 7, 7),
        |_| "each hit spawns two rays, so their number doubles at each level",
    )?;
    let rough = Material { roughness: 0.5, mirror: Vec3::ONE, ..Material::default() };
    judge(
        trial,
        "one pixel, a rough mirror of 1, glossy_samples 4, max_depth 100, min_contribution 1/100",
        query(rough, 1, Quality { glossy_samples: 4, ..parameters(100, 0.01) }),
        // Reflections weigh 1, 1/4, 1/16, 1/64, 1/256: four of them are at least 1/100, with 4, 16, 64 and 256 rays.
        counts(1, 341, 340, 0),
        |yours| match yours.reflection {
            0..=100 => {
                "compare the weight of the whole reflection with min_contribution, and count glossy_samples \
                 rays per hit"
            }
            _ => {
                "each of the four rays has a quarter of the weight: divide the weight by glossy_samples at \
                 each level"
            }
        },
    )?;
    let glass = Material { transmission: Vec3::ONE, fresnel: Fresnel::Exact, ..Material::default() };
    judge(
        trial,
        "one pixel, glass with fresnel, max_depth 2",
        query(glass, 1, parameters(2, 0.001)),
        counts(1, 7, 3, 3),
        |_| "with fresnel, glass reflects, too",
    )?;
    let half = Material { mirror: grey, transmission: grey, fresnel: Fresnel::Exact, ..Material::default() };
    judge(
        trial,
        "one pixel, half mirror and half glass with fresnel, max_depth 2, min_contribution 3/4",
        query(half, 1, parameters(2, 0.75)),
        counts(1, 7, 3, 3),
        |_| "with fresnel, the reflection weighs up to mirror + transmission, which is 1 here",
    )?;
    judge(
        trial,
        "one pixel, a mirror under 2 lights and glass under 1, max_depth 2",
        mirror_and_glass(parameters(2, 0.0)),
        counts(1, 6, 2, 2),
        |yours| match yours {
            RayCounts { reflection: 3, transmission: 3, .. } => {
                "you add up the rays of all materials: a hit has one material, so take the maximum"
            }
            RayCounts { reflection: 2, transmission: 2, .. } => {
                "you add up the lights of all materials: a hit needs those of its own material"
            }
            _ => {
                "a hit has one material: take the maximum over the materials, for each kind of ray separately"
            }
        },
    )?;
    judge(
        trial,
        "one pixel, a mirror, max_depth 0",
        query(mirror, 1, parameters(0, 0.0)),
        counts(1, 1, 0, 0),
        |_| "with max_depth 0 there are no secondary rays",
    )
}

pub(super) fn bound_stays_at_the_largest_number(trial: &Trial<'_>) -> CheckResult {
    let both = Material { mirror: Vec3::ONE, transmission: Vec3::ONE, ..Material::default() };
    let query = query(both, 3, Quality { max_depth: 1000, min_contribution: 0.0, ..Quality::default() });
    let expected = RayCounts { primary: 1, shadow: u64::MAX, reflection: u64::MAX, transmission: u64::MAX };
    judge(
        trial,
        "one pixel, a material that reflects and transmits all light, max_depth 1000",
        query,
        expected,
        |_| "2¹⁰⁰⁰ does not fit u64: use saturating_mul and saturating_add everywhere",
    )
}
