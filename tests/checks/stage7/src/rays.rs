//! Checks of `most_rays`.

use super::scenes::{ONE_SAMPLE, add_material, light, one_sphere};
use checks::prelude::*;
use raykata::effects::{Effects, LightEffects, MaterialEffects};
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
        lights: vec![ONE_SAMPLE; n_lights],
        materials: vec![MaterialEffects::default(), takes],
        ..Effects::default()
    };
    BoundQuery { scene, effects }
}

/// A scene, the counts, and the counts that mistakes give. The mistakes that are not listed give the right counts.
struct BoundedScene {
    what: String,
    query: BoundQuery,
    expected: RayCounts,
    wrong: Vec<(RayCounts, &'static str)>,
}

/// Counts of reflected and refracted rays, after those of camera rays and shadow rays.
const fn counts(primary: u64, shadow: u64, reflection: u64, transmission: u64) -> RayCounts {
    RayCounts { primary, shadow, reflection, transmission }
}

/// Judges scenes of one pixel, and names a mistake that gives all wrong counts. For a hidden seed the scenes have more
/// pixels, and every count is multiplied by their number.
fn judge_pixel(trial: &Trial<'_>, cases: impl IntoIterator<Item = BoundedScene>) -> CheckResult {
    let (width, height) = trial.varied((1, 1), (1..=64u32, 2..=64u32));
    let times = |count: u64| count.saturating_mul(u64::from(width) * u64::from(height));
    let of_pixels = |mut case: BoundedScene| {
        case.query.scene.film = film(width, height);
        let RayCounts { primary, shadow, reflection, transmission } = case.expected;
        case.expected = counts(times(primary), times(shadow), times(reflection), times(transmission));
        judge(trial, case)
    };
    all_hold(cases.into_iter().map(of_pixels).collect())
}

fn judge(trial: &Trial<'_>, BoundedScene { what, query, expected, wrong }: BoundedScene) -> CheckResult {
    let input = format!("most_rays of {what}");
    match kit_error::catch(|| trial.kit.most_rays(&[query]).remove(0)) {
        Ok(yours) if yours == expected => Ok(()),
        Ok(yours) => Err(Broken::new(input, yours, expected, "counted by hand")
            .explained_by(wrong.into_iter().map(|(counts, text)| (counts == yours, text)))),
        Err(KitError::Panicked { message, place }) => {
            let yours = format!("a panic at {place}: {message}");
            let broken = Broken::with_texts(input, yours, format!("{expected:?}"), "counted by hand");
            Err(broken
                .explained_by(["a number overflows: count in u64, with saturating_add and saturating_mul"
                    .when(message.contains("overflow"))]))
        }
        Err(error) => kit_error::unwind(error),
    }
}

/// A scene with a mirror that two lights illuminate, and with glass that one of them illuminates.
fn mirror_and_glass(quality: Quality) -> BoundQuery {
    let mut query = query(Material { mirror: Vec3::ONE, ..Material::default() }, 2, quality);
    let glass = Material { transmission: Vec3::ONE, ..Material::default() };
    add_material(&mut query.scene, "glass", glass);
    let glass = MaterialEffects { lights: vec![1], transmission: true, ..MaterialEffects::default() };
    query.effects.materials.push(glass);
    query
}

/// A scene with coloured glass under two of three lights, a weaker mirror under one, and a stronger mirror that no shape
/// has.
fn unequal(quality: Quality) -> BoundQuery {
    let glass = Material { transmission: vec3(0.25, 0.5, 0.0), ..Material::default() };
    let mut query = query(glass, 2, quality);
    query.scene.lights.push(light(Vec3::ONE, 1.0));
    query.effects.lights.push(ONE_SAMPLE);
    let weak = MaterialEffects { lights: vec![1], mirror: true, ..MaterialEffects::default() };
    for (name, mirror, takes) in [("weak", 0.25, weak), ("hidden", 0.75, MaterialEffects::default())] {
        let mirror = Material { mirror: Vec3::splat(mirror), ..Material::default() };
        add_material(&mut query.scene, name, mirror);
        query.effects.materials.push(takes);
    }
    query
}

/// A scene without secondary rays, and the counts that mistakes give.
fn without_bounces(what: &str, query: BoundQuery, expected: RayCounts) -> BoundedScene {
    let FilmSettings { width, height, .. } = query.scene.film;
    let [width, height, samples] = [width, height, query.scene.quality.samples_per_pixel].map(u64::from);
    let in_u32 = |n: u64| n % (1 << 32);
    let rays = |primary: u64, per_hit: u64| counts(primary, primary * per_hit, 0, 0);
    let (primary, per_hit) = (expected.primary, expected.shadow / expected.primary);
    let lights = &query.effects.lights;
    let casting = lights.iter().filter(|light| light.shadows).count() as u64;
    let of_all_lights = lights.iter().map(|light| u64::from(light.samples)).sum();
    let overflow = "a product overflows u32: convert each factor to u64 before you multiply";
    let wrong = vec![
        (rays(width * width * samples, per_hit), "pixels = width · height: you use the width twice"),
        (rays(height * height * samples, per_hit), "pixels = width · height: you use the height twice"),
        (rays(in_u32(primary), per_hit), overflow),
        (counts(in_u32(primary), in_u32(in_u32(primary) * per_hit), 0, 0), overflow),
        (rays(width * height, per_hit), "you leave out samples_per_pixel"),
        (rays(primary, casting), "you count one shadow ray per light: an area light needs one per sample"),
        (rays(primary, of_all_lights), "you count a light that casts no shadows"),
        (rays(primary, 1), "you count one shadow ray per pixel: each light needs one"),
    ];
    BoundedScene { what: what.into(), query, expected, wrong }
}

pub(super) fn shadow_arithmetic_of_the_lecture(trial: &Trial<'_>) -> CheckResult {
    // Slide "Cost of shadow computation": 1000 × 1000 pixels, 10 lights.
    let lecture = query(Material::default(), 10, Quality::default());
    let sized = |width, height| {
        let mut query = lecture.clone();
        query.scene.film = film(width, height);
        query
    };
    let mut sampled = sized(1000, 1000);
    sampled.scene.quality.samples_per_pixel = 4;
    sampled.effects.lights[0].samples = 16;
    sampled.effects.lights[0].area = true;
    sampled.effects.lights[1].shadows = false;
    let (m, n) = (1_000_000, 10_000_000_000);
    let cases = [
        ("1000 × 1000 pixels under 10 lights", sized(1000, 1000), counts(m, 10 * m, 0, 0)),
        ("640 × 480 pixels under 10 lights", sized(640, 480), counts(307_200, 3_072_000, 0, 0)),
        ("100,000 × 100,000 pixels under 10 lights", sized(100_000, 100_000), counts(n, 10 * n, 0, 0)),
        (
            "1000 × 1000 pixels with 4 samples each, 10 lights, one of 16 samples and one without shadows",
            sampled,
            counts(4 * m, 4 * m * (16 + 8), 0, 0),
        ),
    ];
    let judge_one = |(what, query, expected)| judge(trial, without_bounces(what, query, expected));
    all_hold(cases.into_iter().map(judge_one).collect())?;
    // Other sizes, samples and lights.
    let light = (any::<bool>(), 1..=64u32);
    let inputs = (1..=9999u32, 1..=9999u32, 1..=64u32, prop::collection::vec(light, 10));
    trial.forall(50, inputs, |inputs| {
        let judge_one = |(width, height, samples, lights): &(u32, u32, u32, Vec<(bool, u32)>)| {
            let mut query = sized(*width, *height);
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
            judge(trial, BoundedScene { what, query, expected, wrong: Vec::new() })
        };
        inputs.iter().map(judge_one).collect()
    })
}

/// The rays of one pixel if every hit spawns the same numbers of rays, up to the same bounce.
#[derive(Clone, Copy)]
struct Spread {
    /// The number of bounces: `max_depth`, or fewer if `min_contribution` ends them.
    bounces: u32,
    /// The number of reflected rays per hit.
    reflected: u64,
    /// The number of refracted rays per hit.
    transmitted: u64,
    /// The number of rays per hit that hit something on the next level.
    onward: u64,
    /// The number of shadow rays per hit.
    shadows: u64,
}

const fn spread(bounces: u32, [reflected, transmitted]: [u64; 2], shadows: u64) -> Spread {
    Spread { bounces, reflected, transmitted, onward: reflected + transmitted, shadows }
}

impl Spread {
    /// The hits of the first `n_levels` levels: a geometric sum.
    fn hits(self, n_levels: u32) -> u64 {
        (0..n_levels).fold(0, |sum: u64, level| sum.saturating_add(self.onward.saturating_pow(level)))
    }

    fn counts(self) -> RayCounts {
        let times = |n_levels, per_hit: u64| self.hits(n_levels).saturating_mul(per_hit);
        counts(
            1,
            times(self.bounces + 1, self.shadows),
            times(self.bounces, self.reflected),
            times(self.bounces, self.transmitted),
        )
    }

    /// A scene of one pixel with these rays, and the counts that mistakes give. `special` has the rays of mistakes that
    /// only some scenes show.
    fn scene(
        self,
        what: &str,
        query: BoundQuery,
        expected: RayCounts,
        special: &[(Spread, &'static str)],
    ) -> BoundedScene {
        assert_eq!(self.counts(), expected, "{what}");
        let max_depth = query.scene.quality.max_depth;
        let after = |bounces| Spread { bounces, ..self }.counts();
        let lit = |hits| RayCounts { shadow: self.shadows * hits, ..expected };
        let one_way = Spread { onward: self.reflected.max(self.transmitted), ..self };
        let mut wrong: Vec<_> = special.iter().map(|(spread, text)| (spread.counts(), *text)).collect();
        wrong.extend([
            (lit(1), "you count shadow rays of the first hits only: every hit needs them"),
            (
                lit(1 + self.hits(self.bounces)),
                "each bounce adds the hits of the level before: multiply first, then add",
            ),
            (lit(self.hits(self.bounces)), "you leave out the shadow rays of the last bounce's hits"),
            (after(max_depth), "you leave out min_contribution: only max_depth ends your loop"),
            "you follow one ray per hit: each hit spawns two rays, so their number doubles at each level"
                .when(one_way.counts()),
        ]);
        // A wrong number of bounces shows only where max_depth ends them.
        if self.bounces == max_depth {
            wrong.extend(named![
                after(max_depth + 1) => "you count a bounce too many: there are max_depth bounces",
                after(max_depth.saturating_sub(1)) => "you count a bounce too few: there are max_depth bounces",
            ]);
        }
        BoundedScene { what: format!("one pixel, {what}"), query, expected, wrong }
    }
}

// The mistakes that only some of the scenes show.
const OF_INCOMING: &str =
    "you compare the weight of the incoming ray with min_contribution: compare that of the reflection";
const OPEN_LIMIT: &str =
    "you stop where the weight equals the limit: a ray whose weight is exactly min_contribution is traced";
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
const SUM_OF_WEIGHTS: &str = "you add up the weights of reflection and refraction: the larger one counts";
const NO_WEIGHT: &str = "a weight of 0 ends the bounces, also without min_contribution";
const SUM_OF_LIGHTS: &str = "you add up the lights of all materials: a hit needs those of its own material";

pub(super) fn bound_follows_the_bounces(trial: &Trial<'_>) -> CheckResult {
    let grey = Vec3::splat(0.5);
    let parameters =
        |max_depth, min_contribution| Quality { max_depth, min_contribution, ..Quality::default() };
    let mirror = Material { mirror: grey, ..Material::default() };
    let both = Material { mirror: grey, transmission: grey, ..Material::default() };
    let rough = Material { roughness: 0.5, mirror: Vec3::ONE, ..Material::default() };
    let glass = Material { transmission: Vec3::ONE, fresnel: Fresnel::Exact, ..Material::default() };
    let mut black = query(Material::default(), 1, parameters(5, 0.0));
    black.effects.materials[1].mirror = true;
    let half = Material { fresnel: Fresnel::Exact, ..both.clone() };
    let coated = Material { coat: 1.5, ..Material::default() };
    // The two materials of a scene: each hit spawns one ray, which is either reflected or refracted.
    let either = Spread { onward: 1, ..spread(2, [1, 1], 2) };
    let cases = [
        spread(3, [1, 0], 2).scene(
            "a mirror of 1/2, max_depth 3",
            query(mirror.clone(), 2, parameters(3, 0.0)),
            counts(1, 8, 3, 0),
            &[],
        ),
        spread(6, [1, 0], 1).scene(
            "a mirror of 1/2, max_depth 100, min_contribution 1/100",
            query(mirror.clone(), 1, parameters(100, 0.01)),
            counts(1, 7, 6, 0),
            &[(spread(7, [1, 0], 1), OF_INCOMING)],
        ),
        spread(3, [1, 0], 1).scene(
            "a mirror of 1/2, max_depth 100, min_contribution 1/8",
            query(mirror.clone(), 1, parameters(100, 0.125)),
            counts(1, 4, 3, 0),
            &[(spread(4, [1, 0], 1), OF_INCOMING), (spread(2, [1, 0], 1), OPEN_LIMIT)],
        ),
        spread(3, [1, 1], 1).scene(
            "half mirror and half glass, max_depth 3",
            query(both.clone(), 1, parameters(3, 0.0)),
            counts(1, 15, 7, 7),
            &[],
        ),
        spread(3, [1, 1], 1).scene(
            "half mirror and half glass, max_depth 10, min_contribution 1/10",
            query(both, 1, parameters(10, 0.1)),
            counts(1, 15, 7, 7),
            &[(spread(10, [1, 1], 1), SUM_OF_WEIGHTS), (spread(4, [1, 1], 1), OF_INCOMING)],
        ),
        spread(0, [1, 0], 1).scene(
            "a black mirror, max_depth 5",
            black,
            counts(1, 1, 0, 0),
            &[(spread(5, [1, 0], 1), NO_WEIGHT)],
        ),
        // Reflections weigh 1, 1/4, 1/16, 1/64, 1/256: four of them are at least 1/100, with 4, 16, 64 and 256 rays.
        spread(4, [4, 0], 1).scene(
            "a rough mirror of 1, glossy_samples 4, max_depth 100, min_contribution 1/100",
            query(rough, 1, Quality { glossy_samples: 4, ..parameters(100, 0.01) }),
            counts(1, 341, 340, 0),
            &[
                (spread(100, [4, 0], 1), NOT_DIVIDED),
                // A weight of 1/4 of that of the reflection ends the loop one level earlier.
                (spread(3, [4, 0], 1), OF_ONE_RAY),
                (spread(100, [1, 0], 1), ONE_PER_HIT),
            ],
        ),
        spread(2, [1, 0], 1).scene(
            "a coat over paint, max_depth 2, min_contribution 3/4",
            query(coated, 1, parameters(2, 0.75)),
            counts(1, 3, 2, 0),
            &[(spread(0, [1, 0], 1), NO_COAT)],
        ),
        spread(2, [1, 1], 1).scene(
            "glass with fresnel, max_depth 2",
            query(glass, 1, parameters(2, 0.001)),
            counts(1, 7, 3, 3),
            &[],
        ),
        spread(2, [1, 1], 1).scene(
            "half mirror and half glass with fresnel, max_depth 2, min_contribution 3/4",
            query(half, 1, parameters(2, 0.75)),
            counts(1, 7, 3, 3),
            &[(spread(0, [1, 1], 1), NO_FRESNEL)],
        ),
        either.scene(
            "a mirror under 2 lights and glass under 1, max_depth 2",
            mirror_and_glass(parameters(2, 0.0)),
            counts(1, 6, 2, 2),
            &[
                (Spread { reflected: 0, ..either }, LAST_MATERIAL),
                (Spread { reflected: 0, shadows: 1, ..either }, LAST_MATERIAL),
                (spread(2, [1, 1], 2), SUM_OF_RAYS),
                (spread(2, [1, 1], 3), SUM_OF_RAYS),
                (Spread { shadows: 3, ..either }, SUM_OF_LIGHTS),
            ],
        ),
        spread(0, [1, 0], 1).scene(
            "a mirror, max_depth 0",
            query(mirror, 1, parameters(0, 0.0)),
            counts(1, 1, 0, 0),
            &[],
        ),
    ];
    judge_pixel(trial, cases)?;
    // The largest weight is 1/2, that of one channel of the glass: 1/2, 1/4 and 1/8 are at least 1/8.
    let unequal = Spread { onward: 1, ..spread(3, [1, 1], 2) }.scene(
        "glass of (1/4, 1/2, 0) under 2 of 3 lights, a mirror of 1/4 under 1, and a mirror of 3/4 that no shape has, \
         glossy_samples 4, max_depth 100, min_contribution 1/8",
        unequal(Quality { glossy_samples: 4, ..parameters(100, 0.125) }),
        counts(1, 8, 3, 3),
        &[(Spread { onward: 1, ..spread(3, [1, 1], 3) }, "you count lights that no material lists")],
    );
    judge_pixel(trial, [unequal])
}

pub(super) fn bound_stays_at_the_largest_number(trial: &Trial<'_>) -> CheckResult {
    let both = Material { mirror: Vec3::ONE, transmission: Vec3::ONE, ..Material::default() };
    let case = |max_depth, expected, wrong| BoundedScene {
        what: format!("one pixel, a material that reflects and transmits all light, max_depth {max_depth}"),
        query: query(both.clone(), 3, Quality { max_depth, min_contribution: 0.0, ..Quality::default() }),
        expected,
        wrong,
    };
    let most = u64::MAX;
    // All sums of powers of two end at 2⁶⁴ - 1, and three times that is 2⁶⁴ - 3, without the part above 2⁶⁴.
    const WRAPS: &str = "your numbers wrap around, because they do not fit u64: use saturating_mul and saturating_add everywhere";
    let wrapped = (counts(1, most - 2, most, most), WRAPS);
    let small = case(10, counts(1, 3 * 2047, 1023, 1023), Vec::new());
    // Twelve rays per hit: 12¹⁸ hits of the last bounce do not fit, and modulo 2⁶⁴ the sum of all would.
    let glossy = Material { roughness: 0.5, ..both.clone() };
    let quality = Quality { max_depth: 18, min_contribution: 0.0, glossy_samples: 6, ..Quality::default() };
    let last = 12u128.pow(18);
    let before = (last - 1) / 11;
    let [each, wrong_hits] =
        [6 * before, before + last % (1 << 64)].map(|n| u64::try_from(n).unwrap_or(most));
    let what = "one pixel under one light, a glossy material that reflects and transmits all light, glossy_samples 6, max_depth 18";
    let twelve = BoundedScene {
        what: what.into(),
        query: query(glossy, 1, quality),
        expected: counts(1, most, each, each),
        wrong: vec![(counts(1, wrong_hits, each, each), WRAPS)],
    };
    judge_pixel(trial, [small, case(1000, counts(1, most, most, most), vec![wrapped]), twelve])
}
