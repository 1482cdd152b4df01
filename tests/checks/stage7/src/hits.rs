//! Rays of known hits, and samples for a known error.

use checks::Trial;
use checks::broken::{Broken, Outcome};
use checks::judge::{compare, known};
use proptest::prelude::*;
use raykata::effects::{Effects, LightEffects, MaterialEffects};
use raykata::kit::{HitsQuery, MaterialHits, RayCounts};
use raykata::scene::Quality;

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

/// A table on which all mistakes give different counts.
fn drawn() -> HitsQuery {
    let light = |samples, shadows| LightEffects { samples, area: samples > 1, shadows };
    let plain = MaterialEffects { lights: vec![0, 2], ..MaterialEffects::default() };
    let glass =
        MaterialEffects { lights: vec![0, 1], mirror: true, transmission: true, gloss: true, texture: false };
    let row =
        |material, hits, in_front: [u64; 3]| MaterialHits { material, hits, in_front: in_front.to_vec() };
    HitsQuery {
        hits: vec![row(1, 10, [3, 20, 5]), row(0, 7, [4, 31, 6])],
        effects: Effects {
            lights: vec![light(1, true), light(4, true), light(1, false)],
            materials: vec![plain, glass],
            ..Effects::default()
        },
        quality: Quality { gloss_samples: 3, ..Quality::default() },
    }
}

/// What can go wrong in counting, and how it is told.
const MISTAKES: [&str; 10] = [
    "lights that do not matter to the material cost no ray",
    "lights that cast no shadows cost no ray",
    "hits times lights: in_front says how many places really lie on the lit side",
    "in_front counts places on lamps already, over all hits: do not multiply it again",
    "a rough surface sends gloss_samples rays",
    "a rough surface sends gloss_samples rays through as well as back",
    "only what mirrors sends mirrored rays, only what lets light through sends rays through",
    "the rows of the table add up, and this is but the last one",
    "each row names its material: effects.materials[row.material]",
    "each hit was made by one ray: primary is the sum of hits",
];

/// Counts one by one, with the mistake of this index.
fn counted(query: &HitsQuery, mistake: Option<usize>) -> RayCounts {
    let is = |index: usize| mistake == Some(index);
    let mut rays = RayCounts::default();
    for (row, MaterialHits { material, hits, in_front }) in query.hits.iter().enumerate() {
        let takes = &query.effects.materials[if is(8) { row } else { *material }];
        let samples = u64::from(query.quality.gloss_samples);
        let parts = if takes.gloss && !is(4) { samples } else { 1 };
        if is(7) {
            rays = RayCounts::default();
        }
        rays.primary += if is(9) { 1 } else { *hits };
        for (light, places) in in_front.iter().enumerate() {
            let LightEffects { samples, shadows, .. } = query.effects.lights[light];
            let matters = (takes.lights.contains(&light) || is(0)) && (shadows || is(1));
            rays.shadow += match matters {
                true if is(2) => hits * u64::from(samples),
                true if is(3) => places * u64::from(samples),
                true => *places,
                false => 0,
            };
        }
        rays.reflection += if takes.mirror || is(6) { hits * parts } else { 0 };
        let parts = if is(5) { 1 } else { parts };
        rays.transmission += if takes.transmission || is(6) { hits * parts } else { 0 };
    }
    rays
}

pub(super) fn rays_of_hits_are_exact(trial: &Trial<'_>) -> Outcome {
    let judge = |queries: &[HitsQuery]| {
        compare(queries, trial.kit.rays_of_hits(queries), |query, yours| {
            let expected = counted(query, None);
            if yours == expected {
                return Ok(());
            }
            // Materials may have fewer entries than the table has rows.
            let possible =
                |mistake: &usize| *mistake != 8 || query.hits.len() <= query.effects.materials.len();
            let mistake =
                (0..MISTAKES.len()).filter(possible).find(|mistake| counted(query, Some(*mistake)) == yours);
            let input = format!(
                "rays_of_hits(&{:?},\n&{:?},\ngloss_samples {})",
                query.hits, query.effects.materials, query.quality.gloss_samples
            );
            Err(Broken::new(input, yours, expected, "counted one by one")
                .looks_like(mistake.map(|mistake| MISTAKES[mistake])))
        })
    };
    judge(&[drawn()]).into_iter().collect::<Outcome>()?;
    trial.forall(2000, hits_query(), judge)
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
        (5.0, 2.0, 7),
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
                () if expected == 1 => "one sample is enough here",
                () if expected == u32::MAX => "no number is enough: as many as there can be",
                () if f64::from(yours) == (root * root).recip().ceil() => {
                    "upside down: the deviation over the error"
                }
                () if f64::from(yours) == (root * root).floor() + 1.0 => {
                    "one too many where the quotient is whole"
                }
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
