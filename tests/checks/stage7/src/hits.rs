//! Checks of `rays_of_hits` and `samples_for_error`.

use checks::prelude::*;
use raykata::effects::{Effects, LightEffects, MaterialEffects};
use raykata::scene::Quality;

/// The secondary rays of one hit: `(mirror, transmission, glossy)`, then the reflected and the refracted rays with
/// `glossy_samples` 1, and with `glossy_samples` 4. Derived by hand from the doc comment of `rays_of_hits`.
type Kind = ([bool; 3], [u64; 2], [u64; 2]);

const KINDS: [Kind; 7] = [
    ([false, false, false], [0, 0], [0, 0]),
    ([true, false, false], [1, 0], [1, 0]),
    ([false, true, false], [0, 1], [0, 1]),
    ([true, true, false], [1, 1], [1, 1]),
    ([true, false, true], [1, 0], [4, 0]),
    ([false, true, true], [0, 1], [0, 4]),
    ([true, true, true], [1, 1], [4, 4]),
];

fn material(kind: &Kind, lights: Vec<usize>) -> MaterialEffects {
    let [mirror, transmission, glossy] = kind.0;
    MaterialEffects { lights, mirror, transmission, glossy, texture: false }
}

fn light(samples: u32, shadows: bool) -> LightEffects {
    LightEffects { samples, area: samples > 1, shadows }
}

fn row(material: usize, hits: u64, in_front: [u64; 3]) -> MaterialHits {
    MaterialHits { material, hits, in_front: in_front.to_vec() }
}

fn query(
    hits: Vec<MaterialHits>,
    lights: Vec<LightEffects>,
    materials: Vec<MaterialEffects>,
    glossy_samples: u32,
) -> HitsQuery {
    let effects = Effects { lights, materials, ..Effects::default() };
    HitsQuery { hits, effects, quality: Quality { glossy_samples, ..Quality::default() } }
}

fn hits_query() -> impl Strategy<Value = HitsQuery> + Clone {
    let lights = prop::collection::vec((0..4u32, any::<bool>()), 3);
    let materials = prop::collection::vec((0..KINDS.len(), prop::collection::vec(any::<bool>(), 3)), 3);
    let rows = (0..3usize, 0..100u64, prop::array::uniform3(0..100u64))
        .prop_map(|(material, hits, in_front)| row(material, hits, in_front));
    let table = prop::collection::vec(rows, 0..4);
    (lights, materials, table, 1..5u32).prop_map(|(lights, materials, hits, glossy_samples)| {
        let lit = |lit: &[bool]| (0..3).filter(|&i| lit[i]).collect();
        let lights = lights.iter().map(|&(samples, shadows)| light(samples, shadows)).collect();
        let materials = materials.iter().map(|(kind, on)| material(&KINDS[*kind], lit(on))).collect();
        query(hits, lights, materials, glossy_samples)
    })
}

/// A table for which most known mistakes give different counts.
fn drawn() -> HitsQuery {
    let plain = material(&KINDS[0], vec![0, 2]);
    let glass = material(&KINDS[6], vec![0, 1]);
    let hits = vec![row(1, 10, [3, 20, 5]), row(0, 7, [4, 31, 6])];
    query(hits, vec![light(1, true), light(4, true), light(1, false)], vec![plain, glass], 3)
}

/// The rays of [`drawn`], counted by hand. Shadow: the glass needs lights 0 and 1 (3 + 20), the plain material light 0
/// (4); light 2 casts no shadows. Each of the 10 hits of rough glass spawns 3 reflected and 3 refracted rays.
const DRAWN: RayCounts = RayCounts { primary: 17, shadow: 27, reflection: 30, transmission: 30 };

const PER_HIT: &str = "you count a shadow ray per hit, or per hit and light: in_front says how many samples lie in front of the surface";
const PER_SAMPLE: &str =
    "you count hits times light samples: in_front says how many samples lie in front of the surface";
const PER_ROW: &str = "you count secondary rays once per row: each of its hits spawns them";
const ROUGH: &str = "you count one ray of each kind per hit of a rough surface: it spawns glossy_samples";
const SMOOTH: &str = "you count glossy_samples rays per hit of a smooth surface: it spawns one";

/// Wrong counts, each with its diagnosis.
fn wrong_counts(HitsQuery { hits, effects, quality }: &HitsQuery) -> Vec<(RayCounts, &'static str)> {
    type OfRow<'a> = &'a dyn Fn(&MaterialHits, &MaterialEffects) -> u64;
    let parts = |takes: &MaterialEffects| if takes.glossy { u64::from(quality.glossy_samples) } else { 1 };
    let n = |_: &MaterialEffects| u64::from(quality.glossy_samples);
    // The sum over rows of shadow rays per row, and of reflected and refracted rays per hit with these numbers of parts.
    let count = |rows: &[MaterialHits], shadow: OfRow<'_>, reflected: OfRow<'_>, refracted: OfRow<'_>| {
        rows.iter().fold(RayCounts::default(), |sum, row| {
            let takes = &effects.materials[row.material];
            RayCounts {
                primary: sum.primary + row.hits,
                shadow: sum.shadow + shadow(row, takes),
                reflection: sum.reflection + row.hits * reflected(row, takes),
                transmission: sum.transmission + row.hits * refracted(row, takes),
            }
        })
    };
    let casts = |light: &usize| effects.lights[*light].shadows;
    let in_front = |row: &MaterialHits, takes: &MaterialEffects| {
        takes.lights.iter().filter(|light| casts(light)).map(|&light| row.in_front[light]).sum::<u64>()
    };
    let mirror = |_: &MaterialHits, takes: &MaterialEffects| u64::from(takes.mirror) * parts(takes);
    let refracted = |_: &MaterialHits, takes: &MaterialEffects| u64::from(takes.transmission) * parts(takes);
    let right = count(hits, &in_front, &mirror, &refracted);
    let of_shadow = |shadow: OfRow<'_>| count(hits, shadow, &mirror, &refracted);
    // Per light that is listed, and casts shadows or not.
    let lights = |casting: bool, rays: &dyn Fn(&MaterialHits, usize) -> u64| {
        let counts = |light: &&usize| !casting || casts(light);
        of_shadow(&|row, takes| takes.lights.iter().filter(counts).map(|&light| rays(row, light)).sum())
    };
    let samples = |light: usize| u64::from(effects.lights[light].samples);
    let is_lit = |takes: &MaterialEffects| u64::from(takes.lights.iter().any(casts));
    let first = |row: &MaterialHits, takes: &MaterialEffects| {
        takes.lights.iter().find(|light| casts(light)).map_or(0, |&light| row.in_front[light])
    };
    let secondary = |of_mirror: &dyn Fn(&MaterialEffects) -> u64,
                     of_glass: &dyn Fn(&MaterialEffects) -> u64| {
        count(hits, &in_front, &|_, takes| u64::from(takes.mirror) * of_mirror(takes), &|_, takes| {
            u64::from(takes.transmission) * of_glass(takes)
        })
    };
    let any =
        |row: &MaterialHits| (0..row.in_front.len()).filter(casts).map(|light| row.in_front[light]).sum();
    let per_row = |rays: OfRow<'_>| hits.iter().map(|row| rays(row, &effects.materials[row.material])).sum();
    let last = hits.last().cloned().into_iter().collect::<Vec<_>>();
    let numbered = (0..effects.materials.len()).zip(hits);
    let numbered =
        numbered.map(|(material, row)| MaterialHits { material, ..row.clone() }).collect::<Vec<_>>();
    named![
        of_shadow(&|row, _| row.in_front.iter().sum()) =>
            "you add up all of in_front: count the lights that the material lists and that cast shadows",
        of_shadow(&|row, takes| takes.lights.iter().filter(|light| casts(light)).zip(&row.in_front).map(|(_, n)| n).sum()) =>
            "you read in_front by the place in the material's list: its places are the numbers of the lights",
        count(hits, &in_front, &mirror, &|row, takes| if takes.mirror { 0 } else { refracted(row, takes) }) =>
            "you count no refracted rays of a material that reflects: it may do both",
        RayCounts { reflection: per_row(&mirror), ..right } => PER_ROW,
        RayCounts { transmission: per_row(&refracted), ..right } => PER_ROW,
        RayCounts { reflection: per_row(&mirror), transmission: per_row(&refracted), ..right } => PER_ROW,
        of_shadow(&|row, _| any(row)) => "you count lights that do not matter to the material",
        lights(false, &|row, light| row.in_front[light]) => "you count lights that cast no shadows",
        lights(true, &|row, light| row.hits * samples(light)) => PER_SAMPLE,
        lights(false, &|row, light| row.hits * samples(light)) => PER_SAMPLE,
        lights(true, &|row, _| row.hits) => PER_HIT,
        lights(false, &|row, _| row.hits) => PER_HIT,
        of_shadow(&|row, takes| row.hits * is_lit(takes)) => PER_HIT,
        of_shadow(&|row, _| row.hits) => PER_HIT,
        of_shadow(&first) => "you count only the first light of each row",
        lights(true, &|row, light| row.in_front[light] * samples(light)) =>
            "you multiply in_front by the samples of the light: it already counts samples, over all hits",
        secondary(&|_| 1, &|_| 1) => ROUGH,
        secondary(&parts, &|_| 1) =>
            "you count one refracted ray per hit of a rough surface: it spawns glossy_samples refracted rays, too",
        secondary(&|_| 1, &parts) =>
            "you count one reflected ray per hit of a rough surface: it spawns glossy_samples reflected rays, too",
        secondary(&n, &n) => SMOOTH,
        count(hits, &in_front, &|_, takes| parts(takes), &|_, takes| parts(takes)) =>
            "you count secondary rays for a material whose mirror and transmission are false",
        RayCounts { primary: hits.len() as u64, ..right } =>
            "you count rows: one ray made each hit, so primary is the sum of hits",
        count(&last, &in_front, &mirror, &refracted) => "you return the counts of the last row: add up all rows",
        count(&numbered, &in_front, &mirror, &refracted) =>
            "you use the number of the row as its material: take effects.materials[row.material]",
    ]
    .to_vec()
}

fn judge(query: &HitsQuery, yours: RayCounts, expected: RayCounts, source: &'static str) -> CheckResult {
    if yours == expected {
        return Ok(());
    }
    let input = format!(
        "rays_of_hits(&{:?},\n&{:?},\nglossy_samples {})",
        query.hits, query.effects.materials, query.quality.glossy_samples
    );
    Err(Broken::new(input, yours, expected, source))
}

/// Tables of `n` hits of each kind and of `n` samples of a light, each with the rays that it needs.
fn single_hits_and_places(n: u64) -> Vec<(HitsQuery, RayCounts)> {
    let single = |kind: &Kind, listed: &[usize], casts: bool, row: MaterialHits, glossy_samples: u32| {
        let lights = [2, 3, 1].map(|samples| light(samples, casts));
        query(vec![row], lights.to_vec(), vec![material(kind, listed.to_vec())], glossy_samples)
    };
    let mut singles = Vec::new();
    for kind in &KINDS {
        for (glossy_samples, [reflection, transmission]) in [(1, kind.1), (4, kind.2)] {
            let expected = RayCounts {
                primary: n,
                shadow: 0,
                reflection: n * reflection,
                transmission: n * transmission,
            };
            let hit = single(kind, &[0, 1, 2], true, row(0, n, [0, 0, 0]), glossy_samples);
            singles.push((hit, expected));
        }
        // One sample of light 1: the lights that matter, whether they cast shadows, and the number of shadow rays.
        let (with, without) = (&[0, 1, 2][..], &[0, 2][..]);
        for (listed, casts, shadow) in
            [(with, true, 1), (with, false, 0), (without, true, 0), (without, false, 0)]
        {
            let place = single(kind, listed, casts, row(0, 0, [0, n, 0]), 4);
            singles.push((place, RayCounts { shadow: n * shadow, ..RayCounts::default() }));
        }
    }
    singles
}

/// Tables of a single hit or a single light sample, each with its number in a larger table.
type Parts = Vec<(HitsQuery, u64)>;

/// The table in parts: for each row one hit alone, and one sample of each light alone, each with its number in the row.
fn parts(query: &HitsQuery) -> Parts {
    let singles = [(1, [0, 0, 0]), (0, [1, 0, 0]), (0, [0, 1, 0]), (0, [0, 0, 1])];
    let of_row = |MaterialHits { material, hits, in_front }: &MaterialHits| {
        let numbers = std::iter::once(*hits).chain(in_front.clone());
        let alone = singles.map(|(hits, in_front)| vec![row(*material, hits, in_front)]);
        alone.into_iter().map(|hits| HitsQuery { hits, ..query.clone() }).zip(numbers).collect::<Parts>()
    };
    query.hits.iter().flat_map(of_row).collect()
}

/// Checks known counts: the fixed table, single hits and single light samples. All other tables must be sums of those.
pub(super) fn rays_of_hits_are_exact(trial: &Trial<'_>) -> CheckResult {
    let mut known = vec![(drawn(), DRAWN)];
    known.extend(single_hits_and_places(trial.varied(1, 2..50u64)));
    let queries: Vec<HitsQuery> = known.iter().map(|(query, _)| query.clone()).collect();
    let law = |(query, expected): &(HitsQuery, RayCounts), yours| {
        judge(query, yours, *expected, "counted by hand, or a single hit or light sample")
    };
    all_hold(compare_formulas(&known, trial.kit.rays_of_hits(&queries), law, |(query, _), yours| {
        wrong_counts(query).into_iter().map(|(counts, text)| (counts == *yours, text)).collect()
    }))?;
    trial.forall(2000, hits_query(), |queries| {
        let parts: Vec<Parts> = queries.iter().map(parts).collect();
        let all: Vec<HitsQuery> = parts.iter().flatten().map(|(part, _)| part.clone()).collect();
        let mut alone = trial.kit.rays_of_hits(&all).into_iter();
        let whole = trial.kit.rays_of_hits(queries);
        let sums = |((query, parts), yours): ((&HitsQuery, &Parts), RayCounts)| {
            let mut sum = RayCounts::default();
            for ((_, times), one) in parts.iter().zip(alone.by_ref()) {
                // Saturating, because a wrong answer can be any number.
                let add = |sum: &mut u64, one: u64| *sum = sum.saturating_add(times.saturating_mul(one));
                add(&mut sum.primary, one.primary);
                add(&mut sum.shadow, one.shadow);
                add(&mut sum.reflection, one.reflection);
                add(&mut sum.transmission, one.transmission);
            }
            judge(query, yours, sum, "the sum of your counts for single hits and samples")
        };
        queries.iter().zip(&parts).zip(whole).map(sums).collect()
    })
}

pub(super) fn samples_reach_the_error_that_is_asked_for(trial: &Trial<'_>) -> CheckResult {
    // Eighths, so that every square of a quotient is exact or far from a whole number; and special numbers.
    let chosen = [
        (1.0, 0.5),
        (1.0, 0.25),
        (0.5, 0.5),
        (0.25, 1.0),
        (0.0, 0.5),
        (0.0, 0.0),
        (5.0, 2.0),
        (1.0, 1.0 / 1024.0),
        (1.0, 0.0),
        (1e30, 1e-30),
        (1e-30, 1e-30),
        (8192.0, 0.125),
        // Quotients and squares that single precision rounds to another whole number.
        (4097.0, 1.0),
        (0.3, 0.1),
    ];
    let inputs = (0..64u32, 0..64u32, -40..=40i32).prop_map(|(deviation, error, exponent)| {
        let scale = 2f32.powi(exponent - 3);
        (scale * deviation as f32, scale * error as f32)
    });
    trial.each_and(&chosen, 500, inputs, <dyn Kit>::samples_for_error, judge_samples)
}

/// Whether the mean of `n` samples is good enough. The products are exact, or far from equal.
fn is_enough((deviation, error): (f32, f32), n: f64) -> bool {
    f64::from(deviation).powi(2) <= n * f64::from(error).powi(2)
}

fn judge_samples(query: &(f32, f32), yours: u32) -> Judged {
    let &(deviation, error) = query;
    let most = u32::MAX;
    let enough = is_enough(*query, yours.into());
    let fewer = yours > 1 && is_enough(*query, f64::from(yours) - 1.0);
    let broken = || {
        let expected = match () {
            () if yours == 0 => "1 or more".to_owned(),
            () if fewer => format!("less: {} samples are enough", yours - 1),
            () => format!(
                "more than {yours}: the error is still {:e}",
                f64::from(deviation) / f64::from(yours).sqrt()
            ),
        };
        let input = format!("samples_for_error({deviation:?}, {error:?})");
        Broken::with_texts(input, format!("{yours}"), expected, "deviation / √n <= error")
    };
    let ratio = f64::from(deviation) / f64::from(error);
    let whole = |n: f64| n as u32;
    let is = |wrong: u32| yours == wrong || (yours == 1 && wrong == 0);
    let square = ratio * ratio;
    let single = deviation / error;
    let of_single = f64::from(single) * f64::from(single);
    unless(yours >= 1 && (enough || yours == most) && !fewer, broken).formulas([
        (yours == whole(square.ceil()), "you return 0 if the deviation is 0: one sample is the minimum"),
        (is(whole(square.recip().ceil())), "you divide the error by the deviation: it is deviation / error"),
        "you return one sample too many: if (deviation / error)² is whole, it is the answer"
            .when(is(whole(square.floor() + 1.0))),
        (is(whole(ratio.ceil())), "you do not square deviation / error: the error falls with √n, not with n"),
        "you round the quotient up before you square it: round the square"
            .when(is((ratio.ceil().powi(2) as u32).max(1))),
        "you take the root of deviation / error: the error falls with √n, so solve for n by squaring"
            .when(is(whole(ratio.sqrt().ceil()))),
        (is(whole(square.floor())), "you round down, so the error is still too large: round up"),
        (is(whole(square.round())), "you round to nearest, so the error can be too large: round up"),
        (is(((single * single).ceil() as u32).max(1)), IN_SINGLE),
        (is((of_single.ceil() as u32).max(1)), IN_SINGLE),
        "you return 1 for an error of 0: no number of samples is enough, so return u32::MAX"
            .when(is(if error == 0.0 { 1 } else { whole(square.ceil()).max(1) })),
        "you return u32::MAX for an error of 0 also if the deviation is 0: one sample is enough then"
            .when(is(if error == 0.0 { u32::MAX } else { whole(square.ceil()).max(1) })),
    ])
}

const IN_SINGLE: &str =
    "you compute in single precision, which rounds the quotient or its square: convert to f64 first";
