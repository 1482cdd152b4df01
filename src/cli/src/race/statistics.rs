//! The median of ratios, and its confidence interval by order statistics.

use serde::Serialize;

/// A median with a confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Median {
    /// The median.
    pub value: f64,
    /// The lower end of the interval, which is one of the values.
    pub low: f64,
    /// The upper end of the interval, which is one of the values.
    pub high: f64,
    /// The probability that the interval contains the median of the distribution, at least 0.95.
    pub confidence: f64,
}

/// The fewest values for which an interval at 95 % exists: 1 - 2 · 2⁻⁶ = 0.969.
pub const FEWEST: usize = 6;

/// The median of `values` and the narrowest interval between two of the sorted values that contains the median of their
/// distribution with a probability of at least 95 %; `None` for fewer than [`FEWEST`] values or with a NaN.
///
/// For any distribution, a value lies below its median with probability 1/2. So the number
/// of values below it is binomial, and the interval from the k-th smallest to the k-th largest value misses it with
/// probability `2 P(B(n, 1/2) < k)`. No normal distribution is assumed.
pub fn median(values: &[f64]) -> Option<Median> {
    let n = values.len();
    if n < FEWEST || values.iter().any(|value| value.is_nan()) {
        return None;
    }
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);

    // Move inwards while the probability of a miss stays at 5 % or less. `below` is P(B(n, 1/2) = k), then of the next k.
    let (mut k, mut missed, mut below) = (0, 0.0, 0.5f64.powi(n as i32));
    while 2.0 * (missed + below) <= 0.05 {
        missed += below;
        below *= (n - k) as f64 / (k + 1) as f64;
        k += 1;
    }
    let value = 0.5 * (sorted[(n - 1) / 2] + sorted[n / 2]);
    Some(Median { value, low: sorted[k - 1], high: sorted[n - k], confidence: 1.0 - 2.0 * missed })
}

/// The median of the ratios of `values` to those of `base` in the same rounds, with its interval: what a round has in common,
/// such as a slow machine, cancels. Equal values have the ratio 1, also if they are 0.
pub fn paired_ratio(values: &[f64], base: &[f64]) -> Option<Median> {
    let ratio = |(value, base): (&f64, &f64)| if value == base { 1.0 } else { value / base };
    median(&values.iter().zip(base).map(ratio).collect::<Vec<_>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The ranks are those of tables for the sign test.
    #[test]
    fn the_interval_has_the_ranks_of_the_sign_test() {
        for (n, rank, confidence) in
            [(6, 1, 0.969), (9, 2, 0.961), (15, 4, 0.965), (25, 8, 0.957), (100, 40, 0.965)]
        {
            // The values 1 to n in another order.
            let values: Vec<f64> = (0..n).map(|i| (i * 7 % n + 1) as f64).collect();
            let values = if n % 7 == 0 { (1..=n).map(|i| i as f64).collect() } else { values };
            let found = median(&values).expect("enough values");
            assert_eq!((found.low, found.high), (rank as f64, (n + 1 - rank) as f64), "n = {n}");
            assert_eq!(found.value, (n + 1) as f64 / 2.0);
            assert!((found.confidence - confidence).abs() < 5e-4, "n = {n}: {}", found.confidence);
        }
    }

    #[test]
    fn few_values_and_nan_have_no_interval() {
        assert_eq!(median(&[1.0; FEWEST - 1]), None);
        assert_eq!(median(&[1.0, 2.0, f64::NAN, 4.0, 5.0, 6.0, 7.0]), None);
        assert_eq!(median(&[]), None);
    }

    #[test]
    fn an_outlier_does_not_move_the_interval() {
        let mut values = [1.0; 15];
        values[3] = 1000.0;
        let found = median(&values).expect("enough values");
        assert_eq!((found.low, found.value, found.high), (1.0, 1.0, 1.0));
    }
}
