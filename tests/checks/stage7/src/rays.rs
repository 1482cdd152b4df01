//! Checks of `most_rays`.

use super::scenes::{light, one_sphere};
use checks::Trial;
use checks::broken::{Broken, CheckResult, all_hold};
use glam::Vec3;
use proptest::prelude::*;
use raykata::effects::{Effects, LightEffects, MaterialEffects};
use raykata::kit::{BoundQuery, KitError, RayCounts, kit_error};
use raykata::material::{Fresnel, Material};
use raykata::scene::{FilmSettings, Quality, Scene};

fn film(width: u32, height: u32) -> FilmSettings {
    FilmSettings { width, height, ..FilmSettings::default() }
}

/// A scene with one material besides the default one, and its effects.
fn query(material: Material, n_lights: usize, quality: Quality) -> BoundQuery {
    let mut scene = Scene { quality, ..one_sphere(material) };
    scene.lights = vec![light(Vec3::ONE, 1.0); n_lights];
    let material = &scene.materials[1];
    let through = material.transmission != Vec3::ZERO;
    let mirror = material.mirror != Vec3::ZERO
        || (through && material.fresnel != Fresnel::None)
        || material.coat != 1.0;
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

/// A scene, the counts, and the counts that mistakes give. The mistakes that are not listed give the right counts.
struct BoundedScene<'a> {
    what: &'a str,
    query: BoundQuery,
    expected: RayCounts,
    wrong: &'a [(RayCounts, &'static str)],
}

/// Counts of reflected and refracted rays, after those of camera rays and shadow rays.
const fn counts(primary: u64, shadow: u64, reflection: u64, transmission: u64) -> RayCounts {
    RayCounts { primary, shadow, reflection, transmission }
}

/// Judges scenes of one pixel, and names a mistake that gives all wrong counts. For a hidden seed the scenes have more
/// pixels, and every count is multiplied by their number.
fn judge_pixel(trial: &Trial<'_>, cases: Vec<BoundedScene<'_>>) -> CheckResult {
    let (width, height) = trial.varied((1, 1), (1..=64u32, 2..=64u32));
    let times = |count: u64| count.saturating_mul(u64::from(width) * u64::from(height));
    let of_pixels = |mut case: BoundedScene<'_>| {
        case.query.scene.film = film(width, height);
        let RayCounts { primary, shadow, reflection, transmission } = case.expected;
        case.expected = counts(times(primary), times(shadow), times(reflection), times(transmission));
        judge(trial, case)
    };
    all_hold(cases.into_iter().map(of_pixels).collect())
}

/// Judges all scenes, and names a mistake that gives all wrong counts.
fn judge_all(trial: &Trial<'_>, cases: Vec<BoundedScene<'_>>) -> CheckResult {
    all_hold(cases.into_iter().map(|case| judge(trial, case)).collect())
}

fn judge(trial: &Trial<'_>, BoundedScene { what, query, expected, wrong }: BoundedScene<'_>) -> CheckResult {
    let input = format!("most_rays of {what}");
    match kit_error::catch(|| trial.kit.most_rays(&[query]).remove(0)) {
        Ok(yours) if yours == expected => Ok(()),
        Ok(yours) => Err(Broken::new(input, yours, expected, "counted by hand")
            .explained_by(wrong.iter().map(|(counts, text)| (*counts == yours, *text)))),
        Err(KitError::Panicked { message, place }) => {
            let overflow = message.contains("overflow");
            let broken = Broken::with_texts(
                input,
                format!("a panic at {place}: {message}"),
                format!("{expected:?}"),
                "counted by hand",
            );
            Err(broken.explained_by([(
                overflow,
                "a number overflows: count in u64, with saturating_add and saturating_mul",
            )]))
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

const SQUARE: &str = "pixels = width · height: you use the width twice";
const SQUARE_HEIGHT: &str = "pixels = width · height: you use the height twice";
const NO_SHADOW_RAYS: &str = "you count one shadow ray per pixel: each light needs one";

pub(super) fn shadow_arithmetic_of_the_lecture(trial: &Trial<'_>) -> CheckResult {
    // Slide "Cost of shadow computation": 1000 × 1000 pixels, 10 lights.
    let mut small = query(Material::default(), 10, Quality::default());
    small.scene.film = film(1000, 1000);
    let mut wide = small.clone();
    wide.scene.film = film(640, 480);
    let mut large = small.clone();
    large.scene.film = film(100_000, 100_000);
    let n = 10_000_000_000;
    // 10¹⁰ without the part above 2³².
    let wrapped = n % (1 << 32);
    let mut sampled = small.clone();
    sampled.scene.quality.samples_per_pixel = 4;
    sampled.effects.lights[0].samples = 16;
    sampled.effects.lights[0].area = true;
    sampled.effects.lights[1].shadows = false;
    let (m, drawn) = (1_000_000, small.clone());
    let overflow = "a product overflows u32: convert each factor to u64 before you multiply";
    judge_all(
        trial,
        vec![
            BoundedScene {
                what: "1000 × 1000 pixels under 10 lights",
                query: small,
                expected: counts(m, 10 * m, 0, 0),
                wrong: &[(counts(m, m, 0, 0), NO_SHADOW_RAYS)],
            },
            BoundedScene {
                what: "640 × 480 pixels under 10 lights",
                query: wide,
                expected: counts(307_200, 3_072_000, 0, 0),
                wrong: &[
                    (counts(409_600, 4_096_000, 0, 0), SQUARE),
                    (counts(230_400, 2_304_000, 0, 0), SQUARE_HEIGHT),
                    (counts(307_200, 307_200, 0, 0), NO_SHADOW_RAYS),
                ],
            },
            BoundedScene {
                what: "100,000 × 100,000 pixels under 10 lights",
                query: large,
                expected: counts(n, 10 * n, 0, 0),
                wrong: &[
                    (counts(wrapped, 10 * wrapped, 0, 0), overflow),
                    (counts(wrapped, 10 * wrapped % (1 << 32), 0, 0), overflow),
                    (counts(n, n, 0, 0), NO_SHADOW_RAYS),
                ],
            },
            BoundedScene {
                what: "1000 × 1000 pixels with 4 samples each, 10 lights, one of 16 samples and one without shadows",
                query: sampled,
                expected: counts(4 * m, 4 * m * (16 + 8), 0, 0),
                wrong: &[
                    (counts(m, m * (16 + 8), 0, 0), "you leave out samples_per_pixel"),
                    (
                        counts(4 * m, 4 * m * 9, 0, 0),
                        "you count one shadow ray per light: an area light needs one per sample",
                    ),
                    (counts(4 * m, 4 * m * 25, 0, 0), "you count a light that casts no shadows"),
                    (counts(4 * m, 4 * m, 0, 0), NO_SHADOW_RAYS),
                ],
            },
        ],
    )?;
    // Other sizes, samples and lights.
    let light = (any::<bool>(), 1..=64u32);
    let inputs = (1..=9999u32, 1..=9999u32, 1..=64u32, prop::collection::vec(light, 10));
    trial.forall(50, inputs, |inputs| {
        let judge_one = |(width, height, samples, lights): &(u32, u32, u32, Vec<(bool, u32)>)| {
            let mut query = drawn.clone();
            query.scene.film = film(*width, *height);
            query.scene.quality.samples_per_pixel = *samples;
            for (light, (shadows, samples)) in query.effects.lights.iter_mut().zip(lights) {
                *light = LightEffects { samples: *samples, area: *samples > 1, shadows: *shadows };
            }
            let per_hit: u32 = lights.iter().filter(|light| light.0).map(|light| light.1).sum();
            let primary = u64::from(*width) * u64::from(*height) * u64::from(*samples);
            let what = format!(
                "{width} × {height} pixels with {samples} samples each, and {per_hit} shadow rays per hit"
            );
            let expected = counts(primary, primary * u64::from(per_hit), 0, 0);
            judge(trial, BoundedScene { what: &what, query, expected, wrong: &[] })
        };
        inputs.iter().map(judge_one).collect()
    })
}

// The mistakes of the loop over the bounces. Their counts below were computed once with a loop that makes the mistake.
const FIRST_HITS: &str = "you count shadow rays of the first hits only: every hit needs them";
const LAST_HITS: &str = "you leave out the shadow rays of the last bounce's hits";
const ONE_MORE: &str = "you count a bounce too many: there are max_depth bounces";
const ONE_LESS: &str = "you count a bounce too few: there are max_depth bounces";
const NO_LIMIT: &str = "you leave out min_contribution: only max_depth ends your loop";
const OF_INCOMING: &str =
    "you compare the weight of the incoming ray with min_contribution: compare that of the reflection";
const OPEN_LIMIT: &str =
    "you stop where the weight equals the limit: a ray whose weight is exactly min_contribution is traced";
const ONE_WAY: &str =
    "you follow one ray per hit: each hit spawns two rays, so their number doubles at each level";
const ONE_PER_HIT: &str =
    "you leave out glossy_samples: count glossy_samples rays per hit of a rough material";
const OF_ONE_RAY: &str = "you compare the weight of a single ray with min_contribution: compare the weight of the whole reflection";
const NOT_DIVIDED: &str =
    "each of the four rays has a quarter of the weight: divide the weight by glossy_samples at each level";
const NO_FRESNEL: &str = "with fresnel, the reflection weighs up to mirror + transmission, which is 1 here";
const NO_COAT: &str = "a coat can reflect all light: its reflection weighs up to 1";
const LAST_MATERIAL: &str =
    "you use the last material: a hit has one material, so take the maximum over the materials";
const SUM_OF_RAYS: &str = "you add up the rays of all materials: a hit has one material, so take the maximum";
const SUM_OF_LIGHTS: &str = "you add up the lights of all materials: a hit needs those of its own material";

pub(super) fn bound_follows_the_bounces(trial: &Trial<'_>) -> CheckResult {
    let grey = Vec3::splat(0.5);
    let parameters =
        |max_depth, min_contribution| Quality { max_depth, min_contribution, ..Quality::default() };
    let mirror = Material { mirror: grey, ..Material::default() };
    let both = Material { mirror: grey, transmission: grey, ..Material::default() };
    let rough = Material { roughness: 0.5, mirror: Vec3::ONE, ..Material::default() };
    let glass = Material { transmission: Vec3::ONE, fresnel: Fresnel::Exact, ..Material::default() };
    let half = Material { mirror: grey, transmission: grey, fresnel: Fresnel::Exact, ..Material::default() };
    let coated = Material { coat: 1.5, ..Material::default() };
    judge_pixel(
        trial,
        vec![
            BoundedScene {
                what: "one pixel, a mirror of 1/2, max_depth 3",
                query: query(mirror.clone(), 2, parameters(3, 0.0)),
                expected: counts(1, 8, 3, 0),
                wrong: &[
                    (counts(1, 2, 3, 0), FIRST_HITS),
                    (counts(1, 6, 3, 0), LAST_HITS),
                    (counts(1, 10, 4, 0), ONE_MORE),
                    (counts(1, 6, 2, 0), ONE_LESS),
                ],
            },
            BoundedScene {
                what: "one pixel, a mirror of 1/2, max_depth 100, min_contribution 1/100",
                query: query(mirror.clone(), 1, parameters(100, 0.01)),
                expected: counts(1, 7, 6, 0),
                wrong: &[
                    (counts(1, 1, 6, 0), FIRST_HITS),
                    (counts(1, 6, 6, 0), LAST_HITS),
                    (counts(1, 101, 100, 0), NO_LIMIT),
                    (counts(1, 8, 7, 0), OF_INCOMING),
                ],
            },
            BoundedScene {
                what: "one pixel, a mirror of 1/2, max_depth 100, min_contribution 1/8",
                query: query(mirror.clone(), 1, parameters(100, 0.125)),
                expected: counts(1, 4, 3, 0),
                wrong: &[
                    (counts(1, 1, 3, 0), FIRST_HITS),
                    (counts(1, 3, 3, 0), LAST_HITS),
                    (counts(1, 101, 100, 0), NO_LIMIT),
                    (counts(1, 5, 4, 0), OF_INCOMING),
                    (counts(1, 3, 2, 0), OPEN_LIMIT),
                ],
            },
            BoundedScene {
                what: "one pixel, half mirror and half glass, max_depth 3",
                query: query(both, 1, parameters(3, 0.0)),
                expected: counts(1, 15, 7, 7),
                wrong: &[
                    (counts(1, 1, 7, 7), FIRST_HITS),
                    (counts(1, 7, 7, 7), LAST_HITS),
                    (counts(1, 31, 15, 15), ONE_MORE),
                    (counts(1, 7, 3, 3), ONE_LESS),
                    (counts(1, 4, 3, 3), ONE_WAY),
                ],
            },
            BoundedScene {
                what: "one pixel, a rough mirror of 1, glossy_samples 4, max_depth 100, min_contribution 1/100",
                query: query(rough, 1, Quality { glossy_samples: 4, ..parameters(100, 0.01) }),
                // Reflections weigh 1, 1/4, 1/16, 1/64, 1/256: four of them are at least 1/100, with 4, 16, 64 and 256
                // rays.
                expected: counts(1, 341, 340, 0),
                wrong: &[
                    (counts(1, 1, 340, 0), FIRST_HITS),
                    (counts(1, 85, 340, 0), LAST_HITS),
                    (counts(1, u64::MAX, u64::MAX, 0), NOT_DIVIDED),
                    (counts(1, u64::MAX, u64::MAX, 0), NO_LIMIT),
                    // A weight of 1/4 of that of the reflection ends the loop one level earlier.
                    (counts(1, 85, 84, 0), OF_ONE_RAY),
                    (counts(1, 101, 100, 0), ONE_PER_HIT),
                ],
            },
            BoundedScene {
                what: "one pixel, a coat over paint, max_depth 2, min_contribution 3/4",
                query: query(coated, 1, parameters(2, 0.75)),
                expected: counts(1, 3, 2, 0),
                wrong: &[
                    (counts(1, 1, 0, 0), NO_COAT),
                    (counts(1, 1, 2, 0), FIRST_HITS),
                    (counts(1, 2, 2, 0), LAST_HITS),
                    (counts(1, 4, 3, 0), ONE_MORE),
                    (counts(1, 2, 1, 0), ONE_LESS),
                ],
            },
            BoundedScene {
                what: "one pixel, glass with fresnel, max_depth 2",
                query: query(glass, 1, parameters(2, 0.001)),
                expected: counts(1, 7, 3, 3),
                wrong: &[
                    (counts(1, 1, 3, 3), FIRST_HITS),
                    (counts(1, 3, 3, 3), LAST_HITS),
                    (counts(1, 15, 7, 7), ONE_MORE),
                    (counts(1, 3, 1, 1), ONE_LESS),
                    (counts(1, 3, 2, 2), ONE_WAY),
                ],
            },
            BoundedScene {
                what: "one pixel, half mirror and half glass with fresnel, max_depth 2, min_contribution 3/4",
                query: query(half, 1, parameters(2, 0.75)),
                expected: counts(1, 7, 3, 3),
                wrong: &[
                    (counts(1, 1, 3, 3), FIRST_HITS),
                    (counts(1, 3, 3, 3), LAST_HITS),
                    (counts(1, 15, 7, 7), ONE_MORE),
                    (counts(1, 3, 1, 1), ONE_LESS),
                    (counts(1, 3, 2, 2), ONE_WAY),
                    (counts(1, 1, 0, 0), NO_FRESNEL),
                ],
            },
            BoundedScene {
                what: "one pixel, a mirror under 2 lights and glass under 1, max_depth 2",
                query: mirror_and_glass(parameters(2, 0.0)),
                expected: counts(1, 6, 2, 2),
                wrong: &[
                    (counts(1, 2, 2, 2), FIRST_HITS),
                    (counts(1, 4, 2, 2), LAST_HITS),
                    (counts(1, 8, 3, 3), ONE_MORE),
                    (counts(1, 4, 1, 1), ONE_LESS),
                    (counts(1, 6, 0, 2), LAST_MATERIAL),
                    (counts(1, 3, 0, 2), LAST_MATERIAL),
                    (counts(1, 14, 3, 3), SUM_OF_RAYS),
                    (counts(1, 21, 3, 3), SUM_OF_RAYS),
                    (counts(1, 9, 2, 2), SUM_OF_LIGHTS),
                ],
            },
            BoundedScene {
                what: "one pixel, a mirror, max_depth 0",
                query: query(mirror, 1, parameters(0, 0.0)),
                expected: counts(1, 1, 0, 0),
                wrong: &[(counts(1, 0, 0, 0), LAST_HITS), (counts(1, 2, 1, 0), ONE_MORE)],
            },
        ],
    )
}

pub(super) fn bound_stays_at_the_largest_number(trial: &Trial<'_>) -> CheckResult {
    let both = || Material { mirror: Vec3::ONE, transmission: Vec3::ONE, ..Material::default() };
    let bounces =
        |max_depth| query(both(), 3, Quality { max_depth, min_contribution: 0.0, ..Quality::default() });
    let most = u64::MAX;
    judge_pixel(
        trial,
        vec![
            BoundedScene {
                what: "one pixel, a material that reflects and transmits all light, max_depth 10",
                query: bounces(10),
                expected: counts(1, 3 * 2047, 1023, 1023),
                wrong: &[],
            },
            BoundedScene {
                what: "one pixel, a material that reflects and transmits all light, max_depth 1000",
                query: bounces(1000),
                expected: counts(1, most, most, most),
                wrong: &[
                    // All sums of powers of two end at 2⁶⁴ - 1, and three times that is 2⁶⁴ - 3, without the part above
                    // 2⁶⁴.
                    (
                        counts(1, most - 2, most, most),
                        "your numbers wrap around, because 2¹⁰⁰⁰ does not fit u64: use saturating_mul and \
                         saturating_add everywhere",
                    ),
                ],
            },
        ],
    )
}
