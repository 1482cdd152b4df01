//! How fast the error falls: the slope of a line through points on logarithmic axes.

use serde::Serialize;

/// A slope with its confidence interval.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Slope {
    /// The mean over all rounds.
    pub mean: f64,
    /// Half of the 95 % confidence interval (Student's t over the rounds).
    pub half_interval: f64,
}

/// The slope of error over samples: `rounds[i]` holds the errors of round `i`, one per number of samples.
pub fn slope(samples: &[f64], rounds: &[Vec<f64>]) -> Option<Slope> {
    let slopes: Vec<f64> = rounds.iter().filter_map(|errors| line(samples, errors)).collect();
    let n = slopes.len();
    if n < 2 {
        return None;
    }
    let mean = slopes.iter().sum::<f64>() / n as f64;
    let variance = slopes.iter().map(|slope| (slope - mean).powi(2)).sum::<f64>() / (n - 1) as f64;
    Some(Slope { mean, half_interval: quantile_of_t(n - 1) * (variance / n as f64).sqrt() })
}

/// The slope of the least squares line through the logarithms; points without error are left out.
fn line(xs: &[f64], ys: &[f64]) -> Option<f64> {
    let points: Vec<(f64, f64)> =
        xs.iter().zip(ys).filter(|(x, y)| **x > 0.0 && **y > 0.0).map(|(x, y)| (x.ln(), y.ln())).collect();
    if points.len() < 3 {
        return None;
    }
    let n = points.len() as f64;
    let mean = |of: fn(&(f64, f64)) -> f64| points.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let (above, below) = points
        .iter()
        .fold((0.0, 0.0), |(above, below), p| (above + (p.0 - x) * (p.1 - y), below + (p.0 - x).powi(2)));
    (below > 0.0).then(|| above / below)
}

/// The 97.5 % quantile of Student's t for this many degrees of freedom, from tables. Above 30 degrees it is
/// that of 30, which is too large by less than 5 %.
fn quantile_of_t(freedom: usize) -> f64 {
    const TABLE: [f64; 12] =
        [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228, 2.201, 2.179];
    match freedom {
        0 => f64::INFINITY,
        1..=12 => TABLE[freedom - 1],
        13..=29 => 2.160,
        _ => 2.042,
    }
}

/// The theoretical exponent of a sampler for pictures with edges, where the error is a power of the number of
/// samples. Random: the central limit theorem. Jittered: an edge crosses √n of n cells, and only those are
/// uncertain (Mitchell 1996). Low-discrepancy points are as good on edges, and better on smooth areas.
pub fn theory(sampler: &str) -> Option<f64> {
    match sampler {
        "random" => Some(-0.5),
        "jittered" | "low discrepancy" => Some(-0.75),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_power_is_found_again() {
        let samples = [1.0, 2.0, 4.0, 8.0];
        let errors = |scale: f64| samples.iter().map(|n: &f64| scale * n.powf(-0.5)).collect::<Vec<_>>();
        let found = slope(&samples, &[errors(1.0), errors(3.0), errors(0.1)]).unwrap();
        // Only logarithms are rounded.
        assert!((found.mean + 0.5).abs() < 1e-12 && found.half_interval < 1e-12, "{found:?}");
    }

    #[test]
    fn few_points_or_rounds_have_no_slope() {
        assert_eq!(slope(&[1.0, 2.0, 4.0], &[vec![1.0, 0.7, 0.5]]), None);
        assert_eq!(slope(&[1.0, 2.0], &[vec![1.0, 0.7], vec![1.0, 0.7]]), None);
        assert_eq!(slope(&[1.0, 2.0, 4.0], &[vec![0.0; 3], vec![0.0; 3]]), None);
    }
}
