//! Russian roulette.

use checks::prelude::*;
use checks::statistics::measures;

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

pub(super) fn roulette_keeps_the_mean(trial: &Trial<'_>) -> CheckResult {
    let dim = magnitude(-4.0, 0.0);
    let largest = prop_oneof![4 => fractions(1..=63, 64.0), 4 => dim, 1 => 1.0..8.0f32];
    // Roulette begins at bounce 3.
    let first = [
        (0.25, 0.5, 0.125),
        (0.75, 0.5, 0.875),
        (1.5, 0.5, 1.0),
        (0.02, 0.01, 0.0),
        (0.0, 1e-3, 1e-4),
        (1e-4, 0.0, 0.0),
    ];
    let first = first.map(|weight| (Vec3::from(weight), 3));
    trial.forall_and(&first, 24, (weight(largest), 3..20u32), |cases| {
        proven(cases.iter().map(|&(weight, bounce)| {
            let query = |u: &f32| RouletteQuery { weight, bounce, u: *u };
            let (factors, slack) = measures(|u| trial.kit.survives(&u.iter().map(query).collect::<Vec<_>>()));
            judge_mean(weight, bounce, &factors, slack)
        }))
    })
}

/// Judges the factors, each with the measure of its numbers u, which is known up to `slack`.
fn judge_mean(weight: Vec3, bounce: u32, factors: &[(f32, f64)], slack: f64) -> Judged {
    let largest = f64::from(weight.max_element());
    let survivors = factors.iter().filter(|(factor, _)| *factor != 0.0);
    let survivors: Vec<(f64, f64)> = survivors.map(|(factor, share)| (f64::from(*factor), *share)).collect();
    let share = survivors.iter().fold(0.0, |sum, (_, share)| sum + share);
    let factor = survivors.first().map_or(0.0, |(factor, _)| *factor);
    let is_one_factor = survivors.len() <= 1;
    let mean = survivors.iter().fold(0.0, |sum, (factor, share)| sum + factor * share);
    let (least, most) = (largest.min(LEAST_CAP), (0.5 * (1.0 + largest)).min(1.0));
    let in_range = share >= least - slack && share <= most + slack;
    // Roundings of single precision, in numbers that differ by more in different formulas.
    let near = |x: f64, y: f64| (x - y).abs() <= 1e-5 * y.max(1.0);
    let smallest = f64::from(weight.min_element());
    let green = f64::from(weight.dot(Vec3::new(0.2126, 0.7152, 0.0722)));
    let average = f64::from(weight.element_sum()) / 3.0;
    let broken = || {
        let input = format!("survives({}, {bounce}, u) for all numbers u in 0..1", weight.paste());
        let yours = format!("{:.2} % survive, and the mean of the factor is {mean:.4}", 100.0 * share);
        let [in_least, in_most] = [least, most].map(|share| 100.0 * share);
        let expected =
            format!("{in_least:.2} % to {in_most:.2} %, mean 1, and one factor for all that survive");
        Broken::with_texts(input, yours, expected, "the mean over u").explained_by(named![
            factors.iter().any(|(factor, _)| factor.is_nan()) => "you return NaN",
            share == 1.0 && near(mean, 1.0) && bounce == 3 => "your roulette begins too late: it begins at bounce 3",
            share == 0.0 => "a path of this small weight always ends: it must survive with a probability above 0",
            is_one_factor && near(share, largest) && 1.0 < factor && factor < 0.99 / share =>
                "the factor is below 1 / q for this small weight: you limit it, so light is lost",
            is_one_factor && near(mean, 1.0) && 0.75 < share && share < least - slack =>
                "too many bright paths end: of those whose weight is 0.95 or more, at most one in twenty may end",
        ])
    };
    // The factor is rounded to single precision.
    let right = is_one_factor && (mean - 1.0).abs() <= slack * factor + 1e-6 && in_range;
    // A weight of 1 or more always survives.
    let open = right && largest >= 1.0;
    let formulas = named![
        share == 0.0 => "no path survives",
        share == 1.0 && near(mean, 1.0) => "no path ever ends",
        near(share, 0.5) && near(mean, 1.0) =>
            "every path survives with probability 1/2, but the probability has to follow its weight",
        is_one_factor && factor == 1.0 && (share < 1.0 || right) =>
            "you do not divide by the probability to survive, so the picture is too dark",
        is_one_factor && near(1.0 - share, largest) => "the path ends with the probability with which it must survive",
        is_one_factor && near(share, largest) && near(1.0 - share, 1.0 / factor) => "you divide by the probability to end",
        near(share, smallest) => "you compare u with the smallest channel of the weight: take the largest",
        near(share, average) => "you compare u with the mean of the channels: take the largest",
        near(share, green) => "you compare u with the luminance of the weight: take the largest channel",
        is_one_factor && near(factor * largest * largest, 1.0) => "you divide by the probability twice",
        is_one_factor && near(factor, largest) => "you multiply by the probability to survive: divide by it",
    ];
    unless(right, broken).formulas(formulas.map(|(gives, text)| (gives || open, text)))
}

pub(super) fn roulette_ends_no_young_path(trial: &Trial<'_>) -> CheckResult {
    let number = || (0..64u32).prop_map(|n| (n as f32 + 0.5) / 64.0);
    let largest = prop_oneof![fractions(1..=64, 64.0), magnitude(-4.0, 0.0)];
    let young = (weight(largest), 0..3u32, number(), Just(true));
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
            let broken =
                Broken::with_texts(query.call("survives"), format!("{yours:?}"), expected, "the definition");
            Err(broken.explained_by([
                "paths of small weight end: before bounce 3 each weight above 0 survives"
                    .when(lives && query.weight.max_element() < 1.0 / 64.0),
                "a young path ends because one of its channels is 0: it ends if all are 0"
                    .when(lives && query.weight.min_element() == 0.0),
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
    trial.each(300, cases, <dyn Kit>::survives, |query, yours| {
        let lives = query.weight != Vec3::ZERO;
        if yours == f32::from(u8::from(lives)) {
            return Ok(());
        }
        let expected = f32::from(u8::from(lives));
        Err(Broken::new(query.call("survives"), yours, expected, "the definition").explained_by([
            (yours.is_nan(), "you return NaN: 0 / 0"),
            (!lives && yours.is_infinite(), "you divide by 0"),
            (!lives && query.bounce < 3, "a path without weight ends at once, also before bounce 3"),
            (!lives, "a path without weight goes on"),
            (lives && yours == 0.0, "you end a path that has weight in one channel"),
        ]))
    })
}
