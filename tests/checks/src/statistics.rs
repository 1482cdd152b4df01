//! Two tests of whether numbers have the expected distribution, with a stated rate of false alarms.
//!
//! The score of each test is normally distributed for a correct sampler. The test fails above a threshold that a
//! correct sampler exceeds once in ten million times ([`FALSE_ALARMS`]). So the tests of stages 6 and 11, of which there are
//! fewer than 100, together reject a correct submission less than once in 100,000 times, for any seed.
//! `solutions/tests/suite/calibration.rs` counts them, and runs every statistical check with 1,000 seeds, on the reference
//! and on wrong distributions, of which each must be caught 990 times.

use crate::broken::{Broken, CheckResult};
use glam::{UVec2, Vec2};
use raykata::random::{Points, Purpose};
use raykata::scene::Sampler;

/// The probability that a test rejects a correct sampler.
pub const FALSE_ALARMS: f64 = 1e-7;
/// A normally distributed score is above this with probability [`FALSE_ALARMS`].
const ONE_SIDED: f64 = 5.2;
/// A normally distributed score is beyond ± this with probability [`FALSE_ALARMS`].
const TWO_SIDED: f64 = 5.327;

/// The number of cells along each side of the square into which samples are sorted.
pub const CELLS: u32 = 8;
/// The number of samples of a test: 384 per cell in 64 cells. With two thirds of them the test missed `u^1.1` in place
/// of `u` twice in a hundred times; with this number it hardly ever misses it.
pub const SAMPLES: usize = 24_576;

/// `count` pairs of random numbers in `0.0..1.0`, the same for the same seed.
pub fn pairs(seed: u64, count: usize) -> Vec<Vec2> {
    let pair = |index| Points::new(Sampler::Random, seed, index, 0, 1).stratum(Purpose::Pixel, 0, 1).u;
    (0..count as u64).map(pair).collect()
}

/// The chi-square score of cells with these expected counts. It is normally distributed by the approximation of Wilson and
/// Hilferty, and large if the counts do not fit. At this threshold and 63 degrees of freedom, the approximation gives about a
/// seventh fewer false alarms than stated. Each expected count must be above 20 or so, because counts of rare cells are not
/// normally distributed.
fn score_of_expected(counts: &[u64], expected: &[f64]) -> f64 {
    let term = |(&count, &expected): (&u64, &f64)| (count as f64 - expected).powi(2) / expected;
    let chi_square: f64 = counts.iter().zip(expected).map(term).sum();
    let freedom = counts.len() as f64 - 1.0;
    let spread = 2.0 / (9.0 * freedom);
    ((chi_square / freedom).cbrt() - (1.0 - spread)) / spread.sqrt()
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

/// Checks that `places`, each in the unit square, cover it evenly. `what` is the call. `mistakes` gets the counts of the
/// cells; if none of its mistakes is proven, the pattern of the counts is described.
pub fn covers_evenly(
    what: &str,
    places: &[(f64, f64)],
    axes: [&str; 2],
    mistakes: impl Fn(&[u64]) -> Mistakes,
) -> CheckResult {
    let even = vec![1.0; (CELLS * CELLS) as usize];
    has_shares(what, places, axes, &even, |counts| {
        let proven = mistakes(counts).into_iter().find_map(|(proven, text)| proven.then(|| text.to_owned()));
        proven.or_else(|| pattern(counts, axes))
    })
}

/// Checks that `places`, each in the unit square, are distributed over its cells in proportion to `shares`, which are listed
/// row by row. `what` is the call. `diagnosis` gets the counts of the cells.
pub fn has_shares(
    what: &str,
    places: &[(f64, f64)],
    axes: [&str; 2],
    shares: &[f64],
    diagnosis: impl Fn(&[u64]) -> Option<String>,
) -> CheckResult {
    let mut counts = vec![0; (CELLS * CELLS) as usize];
    for &(x, y) in places {
        let cell = |share: f64| ((share * f64::from(CELLS)).max(0.0) as u32).min(CELLS - 1);
        let UVec2 { x, y } = UVec2::new(cell(x), cell(y));
        counts[(y * CELLS + x) as usize] += 1;
    }
    let scale = places.len() as f64 / shares.iter().sum::<f64>();
    let expected: Vec<f64> = shares.iter().map(|share| scale * share).collect();
    // A score that is NaN fails.
    if score_of_expected(&counts, &expected) <= ONE_SIDED {
        return Ok(());
    }
    let worst = (0..counts.len())
        .max_by(|&a, &b| {
            let off = |cell: usize| (counts[cell] as f64 - expected[cell]).abs();
            off(a).total_cmp(&off(b))
        })
        .unwrap_or(0);
    let (column, row) = (worst as u32 % CELLS, worst as u32 / CELLS);
    let range = |cell: u32| {
        format!("{:.3}..{:.3}", f64::from(cell) / f64::from(CELLS), f64::from(cell + 1) / f64::from(CELLS))
    };
    let input = format!(
        "{what} for {} pairs u;\nsorted by {} and {} into {} cells{}",
        places.len(),
        axes[0],
        axes[1],
        counts.len(),
        if shares.iter().all(|share| *share == shares[0]) { " of equal probability" } else { "" }
    );
    let yours =
        format!("{} with {} in {} and {} in {}", counts[worst], axes[0], range(column), axes[1], range(row));
    let broken = Broken::with_texts(
        input,
        yours,
        format!("about {:.0}", expected[worst]),
        "chi-square, 1 false alarm in 10 million",
    );
    Err(broken.looks_like(diagnosis(&counts)))
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
        (ignores(true), "one random number for both: you do not use u.x"),
        (ignores(false), "one random number for both: you do not use u.y"),
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
    // The number in the range of the expected mean that is nearest to the mean. A mean that is NaN fails.
    if mean_score(values, mean.clamp(expected - slack, expected + slack)).abs() <= TWO_SIDED {
        return Ok(());
    }
    let input = format!("{what}: the mean over {} pairs u", values.len());
    let broken = Broken::with_texts(
        input,
        format!("{mean:.5}"),
        format!("{expected:.5}"),
        "closed form; t-test, 1 false alarm in 10 million",
    );
    Err(broken.explained_by(mistakes(mean)))
}

/// The number of hits per column of the cells.
pub fn columns(counts: &[u64]) -> Vec<u64> {
    let column = |x: usize| counts.iter().skip(x).step_by(CELLS as usize).sum();
    (0..CELLS as usize).map(column).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// How often the score of correct numbers is above the threshold, for 2,000 seeds.
    fn alarms(score: impl Fn(u64) -> f64, threshold: f64) -> usize {
        (0..2000).filter(|&seed| score(seed) > threshold).count()
    }

    /// Too many seeds would be needed to observe one case in ten million, so this computes the tails. For an odd number
    /// of degrees of freedom the tail of chi-square is a sum.
    #[test]
    fn thresholds_are_where_tails_are_as_thin_as_stated() {
        // Compute Φ(-z) by its continued fraction, which is accurate from z = 3 on.
        let normal = |z: f64| {
            let fraction = (1..60).rev().fold(z, |below, k| z + f64::from(k) / below);
            (-0.5 * z * z).exp() / (std::f64::consts::TAU.sqrt() * fraction)
        };
        assert!((normal(TWO_SIDED) * 2.0 / FALSE_ALARMS - 1.0).abs() < 0.01);
        // Compute the chi-square with the score ONE_SIDED, and the probability of a larger one.
        let freedom = f64::from(CELLS * CELLS) - 1.0;
        let spread = 2.0 / (9.0 * freedom);
        let half = 0.5 * freedom * (1.0 - spread + ONE_SIDED * spread.sqrt()).powi(3);
        // 2 Φ(-√(2h)) + Σ e⁻ʰ h^(j - ½) / Γ(j + ½)
        let (mut term, mut tail) = ((-half).exp() * (half / std::f64::consts::PI).sqrt() * 2.0, 0.0);
        for j in 1..=(freedom as u32 - 1) / 2 {
            tail += term;
            term *= half / (f64::from(j) + 0.5);
        }
        tail += 2.0 * normal((2.0 * half).sqrt());
        assert!((0.8..1.0).contains(&(tail / FALSE_ALARMS)), "{tail:e}");
    }

    #[test]
    fn right_numbers_raise_false_alarms_at_the_stated_rate() {
        let chi_square = |seed| {
            let mut counts = [0; 64];
            for u in pairs(seed, 1024) {
                counts[((u.x * 8.0) as usize) * 8 + (u.y * 8.0) as usize] += 1;
            }
            score_of_expected(&counts, &[16.0; 64])
        };
        // At 1.645, 5 % of 2,000: 100 ± 10. Four standard deviations either way.
        let n = alarms(chi_square, 1.645);
        assert!((60..140).contains(&n), "chi-square: {n}");
        let mean = |seed| {
            let values: Vec<f64> = pairs(seed, 1024).iter().map(|u| f64::from(u.x)).collect();
            mean_score(&values, 0.5)
        };
        let n = alarms(mean, 1.645);
        assert!((60..140).contains(&n), "mean: {n}");
    }
}
