//! Russian roulette.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::{Judged, compare, proven, unless};
use checks::paste::Paste;
use glam::Vec3;
use proptest::prelude::*;
use raykata::kit::RouletteQuery;

fn paste(query: &RouletteQuery) -> String {
    format!("survives({}, {}, {})", query.weight.paste(), query.bounce, query.u.paste())
}

/// A weight whose largest channel is `largest`.
fn weight(largest: impl Strategy<Value = f32> + Clone) -> impl Strategy<Value = Vec3> + Clone {
    (largest, 0..3usize, 0..=8i32, 0..=8i32).prop_map(|(largest, axis, first, second)| {
        let mut weight = Vec3::splat(largest);
        weight[(axis + 1) % 3] *= first as f32 / 8.0;
        weight[(axis + 2) % 3] *= second as f32 / 8.0;
        weight
    })
}

/// Public path tracers let one path in twenty end, however bright it is.
const LEAST_CAP: f64 = 0.95;

/// The number of random numbers, one in the middle of each of so many equal intervals.
const STRATA: u32 = 4096;

pub(super) fn roulette_keeps_the_mean(trial: &Trial<'_>) -> CheckResult {
    // The largest channel is at least 1/64, so that at least 64 of the random numbers survive.
    let largest =
        prop_oneof![6 => checks::generate::fractions(1..=63, 64.0), 2 => 0.02..0.99f32, 1 => 1.0..8.0f32];
    // Roulette begins at bounce 3.
    let first =
        [(Vec3::new(0.25, 0.5, 0.125), 3), (Vec3::new(0.75, 0.5, 0.875), 3), (Vec3::new(1.5, 0.5, 1.0), 3)];
    trial.forall_and(&first, 24, (weight(largest), 3..20u32), |cases| {
        let query = |(weight, bounce): &(Vec3, u32)| {
            let (weight, bounce) = (*weight, *bounce);
            (0..STRATA).map(move |index| RouletteQuery {
                weight,
                bounce,
                u: (index as f32 + 0.5) / STRATA as f32,
            })
        };
        let queries: Vec<RouletteQuery> = cases.iter().flat_map(query).collect();
        let answers = trial.kit.survives(&queries);
        let judge =
            |((weight, bounce), factors): (&(Vec3, u32), &[f32])| judge_mean(*weight, *bounce, factors);
        proven(cases.iter().zip(answers.chunks(STRATA as usize)).map(judge))
    })
}

fn judge_mean(weight: Vec3, bounce: u32, factors: &[f32]) -> Judged {
    let largest = f64::from(weight.max_element());
    let strata = f64::from(STRATA);
    let survivors: Vec<f64> =
        factors.iter().filter(|factor| **factor != 0.0).map(|factor| f64::from(*factor)).collect();
    let share = survivors.len() as f64 / strata;
    let factor = survivors.first().copied().unwrap_or(0.0);
    let is_one_factor = survivors.iter().all(|other| *other == factor);
    let mean = survivors.iter().sum::<f64>() / strata;
    // The last stratum that survives may survive in part.
    let slack = 1.5 / strata;
    let (least, most) = (largest.min(LEAST_CAP), (0.5 * (1.0 + largest)).min(1.0));
    let in_range = share >= least - slack && share <= most + slack;
    let near = |x: f64, y: f64| (x - y).abs() <= 2.0 * slack * y.max(1.0);
    let smallest = f64::from(weight.min_element());
    let green = f64::from(weight.dot(Vec3::new(0.2126, 0.7152, 0.0722)));
    let average = f64::from(weight.element_sum()) / 3.0;
    let broken = || {
        let input = format!(
            "survives({}, {bounce}, u) for {STRATA} numbers u, evenly spaced in 0..1",
            weight.paste()
        );
        let yours = format!("{:.1} % survive, and the mean of the factor is {mean:.4}", 100.0 * share);
        let [least, most] = [least, most].map(|share| 100.0 * share);
        let expected = format!("{least:.1} % to {most:.1} %, mean 1, and one factor for all that survive");
        Broken::with_texts(input, yours, expected, "the mean over u").explained_by([
            (factors.iter().any(|factor| factor.is_nan()), "you return NaN"),
            (
                share == 1.0 && near(mean, 1.0) && bounce == 3,
                "your roulette begins too late: it begins at bounce 3",
            ),
            (share == 0.0, "no path survives"),
            (
                is_one_factor && near(mean, 1.0) && 0.75 < share && share < least / 100.0 - slack,
                "too many bright paths end: of those whose weight is 0.95 or more, at most one in twenty may end",
            ),
        ])
    };
    let right = is_one_factor && (mean - 1.0).abs() <= slack * factor && in_range;
    // A weight of 1 or more always survives.
    let open = right && largest >= 1.0;
    let formulas = [
        (share == 1.0 && near(mean, 1.0), "no path ever ends"),
        (
            near(share, 0.5) && near(mean, 1.0),
            "every path survives with probability 1/2, but the probability has to follow its weight",
        ),
        (
            is_one_factor && factor == 1.0 && (share < 1.0 || right),
            "you do not divide by the probability to survive, so the picture is too dark",
        ),
        (
            is_one_factor && near(1.0 - share, largest),
            "the path ends with the probability with which it must survive",
        ),
        (
            is_one_factor && near(share, largest) && near(1.0 - share, 1.0 / factor),
            "you divide by the probability to end",
        ),
        (near(share, smallest), "you compare u with the smallest channel of the weight: take the largest"),
        (near(share, average), "you compare u with the mean of the channels: take the largest"),
        (near(share, green), "you compare u with the luminance of the weight: take the largest channel"),
        (is_one_factor && near(factor * largest * largest, 1.0), "you divide by the probability twice"),
        (is_one_factor && near(factor, largest), "you multiply by the probability to survive: divide by it"),
    ];
    unless(right, broken).formulas(formulas.map(|(gives, text)| (gives || open, text)))
}

pub(super) fn roulette_ends_no_young_path(trial: &Trial<'_>) -> CheckResult {
    let number = || (0..64u32).prop_map(|n| (n as f32 + 0.5) / 64.0);
    let young = (weight(checks::generate::fractions(1..=64, 64.0)), 0..3u32, number(), Just(true));
    // Every fifth path has the weight 1/64, and half of these must end, whichever random numbers end them.
    let dim = (weight(Just(1.0f32 / 64.0)), 3..50u32, number(), Just(false));
    let cases = prop_oneof![4 => young, 1 => dim];
    trial.forall(500, cases, |cases| {
        let queries: Vec<RouletteQuery> = cases
            .iter()
            .map(|(weight, bounce, u, _)| RouletteQuery { weight: *weight, bounce: *bounce, u: *u })
            .collect();
        let answers: Vec<(f32, bool)> =
            trial.kit.survives(&queries).into_iter().zip(cases.iter().map(|case| case.3)).collect();
        let dim: Vec<f32> = answers.iter().filter(|(_, lives)| !lives).map(|(factor, _)| *factor).collect();
        let none_ends = dim.len() > 10 && !dim.contains(&0.0);
        compare(&queries, answers, |query, (yours, lives)| {
            if if lives { yours == 1.0 } else { !none_ends } {
                return Ok(());
            }
            let expected = if lives { "1.0" } else { "0.0 for about half of the numbers u" };
            let broken = Broken::with_texts(paste(query), format!("{yours:?}"), expected, "the definition");
            Err(broken.explained_by([
                (lives && query.bounce == 2, "your roulette begins too early: not before bounce 3"),
                (lives, "your roulette begins at the first bounces: not before bounce 3"),
                (!lives, "no path ends"),
            ]))
        })
    })
}

pub(super) fn roulette_ends_paths_without_weight(trial: &Trial<'_>) -> CheckResult {
    let number = || (0..64u32).prop_map(|n| (n as f32 + 0.5) / 64.0);
    // Every fourth path has weight in one channel, and lives: it is young.
    let cases = (0..12i32, 0..20u32, number()).prop_map(|(which, bounce, u)| {
        let (weight, bounce) =
            if which < 3 { (Vec3::AXES[which as usize], bounce % 3) } else { (Vec3::ZERO, bounce) };
        RouletteQuery { weight, bounce, u: if which == 5 { 0.0 } else { u } }
    });
    trial.forall(300, cases, |queries| {
        compare(queries, trial.kit.survives(queries), |query, yours| {
            let lives = query.weight != Vec3::ZERO;
            if yours == f32::from(u8::from(lives)) {
                return Ok(());
            }
            let expected = f32::from(u8::from(lives));
            Err(Broken::new(paste(query), yours, expected, "the definition").explained_by([
                (yours.is_nan(), "you return NaN: 0 / 0"),
                (!lives && yours.is_infinite(), "you divide by 0"),
                (!lives && query.bounce < 3, "a path without weight ends at once, also before bounce 3"),
                (!lives, "a path without weight goes on"),
                (lives && yours == 0.0, "you end a path that has weight in one channel"),
            ]))
        })
    })
}
