//! Two tests of whether numbers have the expected distribution, with a stated rate of false alarms.
//!
//! The score of each test is normally distributed for a correct sampler. The test fails above a threshold that a
//! correct sampler exceeds once in ten million times ([`FALSE_ALARMS`]). So the tests of stages 6 and 11, of which there are
//! fewer than 100, together reject a correct submission less than once in 100,000 times, for any seed.
//! `solutions/tests/suite/calibration.rs` counts them, and runs every statistical check with 1,000 seeds, on the reference
//! and on wrong distributions, of which each must be caught 990 times.

use crate::broken::{Broken, CheckResult};
use glam::{DVec2, Vec2};
use raykata::random::{Points, Purpose};
use raykata::scene::Sampler;
use std::cell::RefCell;
use std::collections::HashMap;
use std::fmt::Debug;
use std::ops::Range;

/// The probability that a test rejects a correct sampler.
pub const FALSE_ALARMS: f64 = 1e-7;
/// A normally distributed score is beyond ± this with probability [`FALSE_ALARMS`].
const TWO_SIDED: f64 = 5.327;

/// The number of cells along each side of the square for a diagnosis.
pub const CELLS: u32 = 8;
/// The number of samples of a mean.
pub const SAMPLES: usize = 24_576;

/// `count` pairs of random numbers in `0.0..1.0`, the same for the same seed.
pub fn pairs(seed: u64, count: usize) -> Vec<Vec2> {
    let pair = |index| Points::new(Sampler::Random, seed, index, 0, 1).stratum(Purpose::Pixel, 0, 1).u;
    (0..count as u64).map(pair).collect()
}

/// The score of Student's t-test: the error of the mean of `values` in standard errors. With thousands of values it is
/// normally distributed.
pub fn mean_score(values: &[f64], expected: f64) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let standard_error = (variance / n).sqrt();
    // Equal values have no standard error. Then the mean must be exact.
    if standard_error > 0.0 { (mean - expected) / standard_error } else { (mean - expected) * f64::MAX }
}

/// The known mistakes, each with whether it is proven by the answers.
pub type Mistakes = Vec<(bool, &'static str)>;

/// A bound on a normally distributed score that any of the [`parts`] exceeds with probability [`FALSE_ALARMS`].
const OF_ALL_PARTS: f64 = 6.1;

/// The strata along each side of the square of [`stratified`] numbers, before those at both ends are divided. With it a
/// deviation of 2 % is found in each 32nd of the square.
const SIDE: usize = 384;
/// The parts of the first and of the last stratum. They grow with the square of their number, so that a narrow rim has many.
const FINE: usize = 24;

/// The bounds of bins along each side of the unit square: eighths, and narrow bins at both rims.
const EDGES: [f64; 15] = {
    let [a, b, c] = [1.0 / 4096.0, 1.0 / 512.0, 1.0 / 64.0];
    [0.0, a, b, c, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0 - c, 1.0 - b, 1.0 - a, 1.0]
};
/// The number of bins along each side.
const BINS: usize = EDGES.len() - 1;

/// The bins of the unit square, row by row: the corner and the size of each.
pub fn bins() -> impl Iterator<Item = ((f64, f64), (f64, f64))> {
    let along = |bin: usize| (EDGES[bin], EDGES[bin + 1] - EDGES[bin]);
    (0..BINS * BINS).map(move |bin| {
        let ((x, width), (y, height)) = (along(bin % BINS), along(bin / BINS));
        ((x, y), (width, height))
    })
}

/// The parts of the square that are counted, as ranges of bins along x and y.
fn parts() -> Vec<[Range<usize>; 2]> {
    let eighth = |index: usize| if index < 8 { index.min(1) * 3 + index } else { BINS };
    let even = |n: usize| (0..n).map(|i| eighth(8 / n * i)..eighth(8 / n * (i + 1))).collect::<Vec<_>>();
    let rims = (1..4).flat_map(|n| [0..n, BINS - n..BINS]).collect::<Vec<_>>();
    let (whole, quarters, eighths) = (even(1), even(4), even(8));
    let pairs = [(&quarters, &eighths), (&eighths, &quarters), (&eighths, &whole), (&whole, &eighths)];
    let pairs = pairs.into_iter().chain([(&rims, &whole), (&whole, &rims)]);
    pairs.flat_map(|(x, y)| x.iter().flat_map(|x| y.iter().map(|y| [x.clone(), y.clone()]))).collect()
}

/// Random numbers, two pairs in each cell of a grid whose cells are narrow at the rims, and the weight of each: the area of its
/// cell, so that all weights sum to their number. A map that keeps areas spreads them over the parts of the square far more
/// evenly than independent ones.
fn stratified(seed: u64) -> (Vec<Vec2>, Vec<f64>) {
    let rim = |part: usize| (part as f64 / FINE as f64).powi(2) / SIDE as f64;
    let middle = (1..SIDE).map(|stratum| stratum as f64 / SIDE as f64);
    let edges: Vec<f64> =
        (0..FINE).map(rim).chain(middle).chain((0..FINE).rev().map(|part| 1.0 - rim(part))).collect();
    let side = edges.len() - 1;
    let stratum = |index: usize| (edges[index], edges[index + 1] - edges[index]);
    let place = |(index, u): (usize, Vec2)| {
        let ((x, width), (y, height)) = (stratum(index / 2 % side), stratum(index / 2 / side));
        let place = DVec2::new(x + width * f64::from(u.x), y + height * f64::from(u.y)).as_vec2();
        (place.min(Vec2::splat(1.0 - f32::EPSILON / 2.0)), width * height * (side * side) as f64)
    };
    pairs(seed, 2 * side * side).into_iter().enumerate().map(place).unzip()
}

/// Judges a sampler that maps two random numbers to places in the unit square. It must use both numbers, and each part of the
/// square must get as many samples as its bins expect: all parts of equal size, and narrow ones at the rims. `what` is the call;
/// `shares` has the expected share of each bin, and none if they are the areas.
///
/// Each cell of the grid of numbers has two samples, whose difference states the variance of the count for any map that is
/// right. `mistakes` gets the counts of [`CELLS`]² equal cells; if none of them is proven, the pattern of counts that should be
/// equal is described.
pub fn covers_each_part(
    what: &str,
    axes: [&str; 2],
    seed: u64,
    shares: Option<&[f64]>,
    places: impl Fn(&[Vec2]) -> Result<Vec<(f64, f64)>, Broken>,
    mistakes: impl Fn(&[u64]) -> Mistakes,
) -> CheckResult {
    let (u, weights) = stratified(seed ^ (1 << 41));
    // A message of a worker is at most some megabytes long.
    let all = u.chunks(1 << 16).map(&places).collect::<Result<Vec<_>, _>>()?.concat();
    // A list of even places is no sampler: the same numbers give the same places in another batch.
    let is_other = |(one, other): (&(f64, f64), &(f64, f64))| format!("{one:?}") != format!("{other:?}");
    if places(&u[..64])?.iter().zip(&all).any(is_other) {
        return Err(Broken::with_texts(what, "two places for the same numbers", "one", "the definition"));
    }
    let places_of = |u: &[Vec2]| places(u).unwrap_or_default();
    let unused = unused_number(places_of).into_iter().find_map(|(proven, text)| proven.then_some(text));
    if let Some(text) = unused {
        let broken = Broken::with_texts(what, "one number has no effect", "both have", "two coordinates");
        return Err(broken.looks_like(Some(text.to_owned())));
    }
    // Sort the places into bins. Rounding may put a place of the rim beyond it, by no more than the callers accept.
    let bin = |place: &(f64, f64)| {
        let along = |share: f64| {
            let inside = (-1e-3..=1.001).contains(&share);
            inside.then(|| EDGES[1..BINS].partition_point(|edge| *edge <= share))
        };
        Some([along(place.0)?, along(place.1)?])
    };
    let bins_of: Vec<Option<[usize; 2]>> = all.iter().map(bin).collect();
    let weighted = || bins_of.iter().zip(&weights).filter_map(|(bin, weight)| Some(((*bin)?, *weight)));
    // The weight of the samples in each bin, and the largest weight of one.
    let mut counts = vec![(0.0, 0f64); BINS * BINS];
    for ([x, y], weight) in weighted() {
        let (count, most) = &mut counts[y * BINS + x];
        (*count, *most) = (*count + weight, most.max(weight));
    }
    let areas: Vec<f64> = bins().map(|(_, (width, height))| width * height).collect();
    let (even, shares) = (shares.is_none(), shares.unwrap_or(&areas));
    let scale = u.len() as f64 / shares.iter().sum::<f64>();
    let pairs = bins_of.chunks(2).zip(weights.iter().step_by(2));
    let split: Vec<_> = pairs.filter(|(pair, _)| pair[0] != pair[1]).collect();
    let mut worst: Option<(f64, f64, Broken)> = None;
    for [x, y] in parts() {
        let cells = || y.clone().flat_map(|y| x.clone().map(move |x| y * BINS + x));
        let count: f64 = cells().map(|cell| counts[cell].0).sum();
        let most = cells().map(|cell| counts[cell].1).fold(0.0, f64::max);
        // A part without samples could have had one of the usual weight.
        let most = if most > 0.0 { most } else { 1.0 };
        let expected: f64 = scale * cells().map(|cell| shares[cell]).sum::<f64>();
        let is_in = |place: &Option<[usize; 2]>| place.is_some_and(|[i, j]| x.contains(&i) && y.contains(&j));
        let crossing = split.iter().filter(|(pair, _)| is_in(&pair[0]) != is_in(&pair[1]));
        // A few pairs may by chance state no difference.
        let variance = crossing.map(|(_, weight)| *weight * *weight).sum::<f64>() + 3.0 * most * most;
        // Ten samples may lie on the other side of a bound because of rounding.
        let limit = OF_ALL_PARTS * variance.sqrt() + 10.0 * most;
        // State what is found, but for narrow ranges of an angle: it has no rim.
        let [width, height] = [&x, &y].map(|range| EDGES[range.end] - EDGES[range.start]);
        if !(axes[1].contains("angle") && height < 0.1) {
            note_power(width * height, (limit + OF_POWER * variance.sqrt()) / expected);
        }
        // A NaN among the shares is off, too.
        let off = (count - expected).abs() / limit;
        let off = if off.is_nan() { f64::INFINITY } else { off };
        if off > 1.0 && worst.as_ref().is_none_or(|(most, ..)| off > *most) {
            let range = |range: &Range<usize>| format!("{:.4}..{:.4}", EDGES[range.start], EDGES[range.end]);
            let input = format!("{what} for {} pairs u;\nsorted by {} and {}", u.len(), axes[0], axes[1]);
            let yours =
                format!("{count:.0} with {} in {} and {} in {}", axes[0], range(&x), axes[1], range(&y));
            let source = "stratified numbers, 1 false alarm in 10 million";
            worst =
                Some((off, count, Broken::with_texts(input, yours, format!("about {expected:.0}"), source)));
        }
    }
    let Some((_, count, broken)) = worst else { return Ok(()) };
    let gap = (count == 0.0).then_some("your samples leave this part of the range out");
    // Count in cells of equal size.
    let mut cells = vec![0.0; (CELLS * CELLS) as usize];
    for ([x, y], weight) in weighted() {
        let eighth = |bin: usize| bin.clamp(3, BINS - 4) - 3;
        cells[eighth(y) * CELLS as usize + eighth(x)] += weight;
    }
    let cells: Vec<u64> = cells.into_iter().map(|count: f64| count.round() as u64).collect();
    let proven = mistakes(&cells).into_iter().find_map(|(proven, text)| proven.then(|| text.to_owned()));
    let described = if even { pattern(&cells, axes) } else { None };
    Err(broken.looks_like(proven.or(described).or(gap.map(str::to_owned))))
}

/// Whether all of these values fit one of the random numbers, or 1 less it.
pub fn is_of_one_number<T>(
    u: &[Vec2],
    values: impl Iterator<Item = T> + Clone,
    fits: impl Fn(f64, T) -> bool,
) -> bool {
    (0..4).any(|which| {
        let number = |u: &Vec2| f64::from([u.x, u.y, 1.0 - u.x, 1.0 - u.y][which]);
        u.iter().zip(values.clone()).all(|(u, value)| fits(number(u), value))
    })
}

/// Whether all of these values are the same power of one of the random numbers, or of 1 less it, for an exponent that is not
/// `right`.
pub fn is_other_power(u: &[Vec2], values: &[f64], right: f64) -> bool {
    (0..4).any(|which| {
        let number = |u: &Vec2| f64::from([u.x, u.y, 1.0 - u.x, 1.0 - u.y][which]);
        // Logarithms are precise away from both ends.
        let pairs = u.iter().map(number).zip(values).filter(|(u, _)| (0.1..0.9).contains(u));
        let mut powers = pairs.map(|(u, value)| value.ln() / u.ln());
        let first = powers.next().unwrap_or(right);
        (first - right).abs() > 1e-3 * right && powers.all(|power| (power - first).abs() <= 1e-4 * first)
    })
}

/// The number of intervals into which [`measures`] divides the random numbers at first. It finds sets of a measure of 1e-4.
const STRATA: usize = 16_384;

/// The measures of the sets of random numbers with equal answers, and a bound on their errors. They are exact up to the
/// spacing of random numbers, because each border between two sets is bisected; if there are very many, they are counted.
pub fn measures<A: PartialEq + Debug>(answer: impl Fn(&[f32]) -> Vec<A>) -> (Vec<(A, f64)>, f64) {
    const ALL: usize = 1 << 24;
    let ask = |numbers: &[usize]| answer(&numbers.iter().map(|n| *n as f32 / ALL as f32).collect::<Vec<_>>());
    let numbers: Vec<usize> = (0..STRATA).map(|n| n * (ALL / STRATA)).chain([ALL - 1]).collect();
    let answers = ask(&numbers);
    let borders = (0..STRATA).filter(|n| answers[*n] != answers[n + 1]);
    let mut borders: Vec<[usize; 2]> = borders.map(|n| [numbers[n], numbers[n + 1]]).collect();
    let few = borders.len() <= 64;
    while few && borders.iter().any(|[low, high]| high - low > 1) {
        let middles: Vec<usize> = borders.iter().map(|[low, high]| low.midpoint(*high)).collect();
        let (below, here) = (ask(&borders.iter().map(|border| border[0]).collect::<Vec<_>>()), ask(&middles));
        for (border, (middle, same)) in
            borders.iter_mut().zip(middles.into_iter().zip(below.iter().zip(&here).map(|(a, b)| a == b)))
        {
            border[usize::from(!same)] = middle;
        }
    }
    let ends = borders.iter().map(|border| border[1]).chain([ALL]);
    let (mut sets, mut places, mut start): (Vec<(A, f64)>, _, _) = (Vec::new(), HashMap::new(), 0);
    for (end, answer) in ends.clone().zip(ask(&ends.map(|end| end - 1).collect::<Vec<_>>())) {
        let measure = (end - start) as f64 / ALL as f64;
        let place = *places.entry(format!("{answer:?}")).or_insert(sets.len());
        match sets.get_mut(place) {
            Some((_, sum)) => *sum += measure,
            None => sets.push((answer, measure)),
        }
        start = end;
    }
    let spacing = if few { ALL } else { STRATA } as f64;
    (sets, (borders.len() + 4) as f64 / spacing)
}

/// A normally distributed score is below this with probability 99.9 %.
const OF_POWER: f64 = 3.09;

thread_local! {
    static POWER: RefCell<Option<Vec<(f64, f64)>>> = const { RefCell::new(None) };
}

/// Notes the smallest relative deviation that a test finds with 99.9 % power in a part of the square; 1 for a mean.
fn note_power(part: f64, deviation: f64) {
    POWER.with_borrow_mut(|power| power.iter_mut().for_each(|power| power.push((part, deviation.abs()))));
}

/// The parts and deviations that the tests of a check find, for the table in CONTRIBUTING.md.
pub fn power_of(check: impl FnOnce()) -> Vec<(f64, f64)> {
    POWER.set(Some(Vec::new()));
    check();
    POWER.take().unwrap_or_default()
}

/// A description of uneven counts that does not depend on the sampler.
fn pattern(counts: &[u64], axes: [&str; 2]) -> Option<String> {
    let sums = [columns(counts), counts.chunks(CELLS as usize).map(|row| row.iter().sum()).collect()];
    for (sums, axis) in sums.iter().zip(axes) {
        let (first, last) = (sums[0], sums[CELLS as usize - 1]);
        if sums.contains(&0) {
            return Some(format!("your samples cover only a part of the range of {axis}"));
        }
        // The difference is far above random variation: each sum has thousands of samples, with a deviation of about 2
        // %.
        if 2 * first > 3 * last || 2 * last > 3 * first {
            return Some(format!(
                "too many samples where {axis} is {}",
                if first > last { "small" } else { "large" }
            ));
        }
    }
    None
}

/// Whether one of the two random numbers is not used: the answers stay the same if only this number changes. `sample` returns
/// the answers for pairs of random numbers.
pub fn unused_number<A: PartialEq>(sample: impl Fn(&[Vec2]) -> Vec<A>) -> Mistakes {
    let shares = [0.1f32, 0.3, 0.45, 0.62, 0.87];
    let row =
        |u: Vec2| shares.map(|share| if u.x < 0.0 { Vec2::new(share, u.y) } else { Vec2::new(u.x, share) });
    let ignores = |first: bool| {
        shares.iter().all(|&other| {
            let answers = sample(&row(if first { Vec2::new(-1.0, other) } else { Vec2::new(other, -1.0) }));
            answers.iter().all(|answer| *answer == answers[0])
        })
    };
    vec![
        (ignores(true) && ignores(false), "your answer does not depend on u"),
        (ignores(true), "you do not use u.x"),
        (ignores(false), "you do not use u.y"),
    ]
}

/// Checks that the mean of `values` is `expected`. `mistakes` gets the mean.
pub fn has_mean(
    what: &str,
    values: &[f64],
    expected: f64,
    mistakes: impl Fn(f64) -> Mistakes,
) -> CheckResult {
    has_mean_within(what, values, (expected, 0.0), mistakes)
}

/// Checks that the mean of `values` is `expected.0`, which itself is only known up to `expected.1`. `mistakes` gets the mean.
pub fn has_mean_within(
    what: &str,
    values: &[f64],
    (expected, slack): (f64, f64),
    mistakes: impl Fn(f64) -> Mistakes,
) -> CheckResult {
    let mean = values.iter().sum::<f64>() / values.len() as f64;
    let standard_error = (mean - expected) / mean_score(values, expected);
    note_power(1.0, ((TWO_SIDED + OF_POWER) * standard_error.abs() + slack) / expected);
    // The number in the range of the expected mean that is nearest to the mean. A mean that is NaN fails.
    if mean_score(values, mean.clamp(expected - slack, expected + slack)).abs() <= TWO_SIDED {
        return Ok(());
    }
    let input = format!("{what}: the mean over {} pairs u", values.len());
    let (yours, right) = (format!("{mean:.5}"), format!("{expected:.5}"));
    let source = "closed form; t-test, 1 false alarm in 10 million";
    Err(Broken::with_texts(input, yours, right, source).explained_by(mistakes(mean)))
}

/// The number of hits per column of the cells.
pub fn columns(counts: &[u64]) -> Vec<u64> {
    let column = |x: usize| counts.iter().skip(x).step_by(CELLS as usize).sum();
    (0..CELLS as usize).map(column).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Too many seeds would be needed to observe one case in ten million, so this computes the tails.
    #[test]
    fn thresholds_are_where_tails_are_as_thin_as_stated() {
        // Compute Φ(-z) by its continued fraction, which is accurate from z = 3 on.
        let normal = |z: f64| {
            let fraction = (1..60).rev().fold(z, |below, k| z + f64::from(k) / below);
            (-0.5 * z * z).exp() / (std::f64::consts::TAU.sqrt() * fraction)
        };
        assert!((normal(TWO_SIDED) * 2.0 / FALSE_ALARMS - 1.0).abs() < 0.01);
    }
}
