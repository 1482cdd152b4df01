//! Multiple importance sampling.

use checks::prelude::*;
use std::f64::consts::TAU;

type Pair = (f32, f32);

/// The answers for each pair and for the same pair in the other order.
pub(super) fn both_ways(trial: &Trial<'_>, pairs: &[Pair]) -> Vec<Pair> {
    let reversed: Vec<Pair> = pairs.iter().map(|(own, other)| (*other, *own)).collect();
    trial.kit.mis_weight(pairs).into_iter().zip(trial.kit.mis_weight(&reversed)).collect()
}

/// Judges that both weights are in 0..=1 and sum to 1.
fn judge_sum(pair: &Pair, (own, other): Pair) -> Judged {
    let is_share = |weight: f32| (0.0..=1.0).contains(&weight);
    let sum = f64::from(own) + f64::from(other);
    // Whether both weights are those of a formula in single precision, up to two roundings.
    let is = |formula: fn(f32, f32) -> f32| {
        let same = |x: f32, y: f32| (x - y).abs() <= 1e-6 || (x.is_nan() && y.is_nan());
        same(own, formula(pair.0, pair.1)) && same(other, formula(pair.1, pair.0))
    };
    let broken = || {
        let input = format!("{} and {}", pair.call("mis_weight"), (pair.1, pair.0).call("mis_weight"));
        let expected = "two weights in 0..=1 that sum to 1";
        Broken::with_texts(input, format!("{own:?} and {other:?}, sum {sum}"), expected, "the definition")
            .explained_by([
                (own.is_nan() || other.is_nan(), "you return NaN"),
                (own == 1.0 && other == 1.0, "each technique counts in full, so light is counted twice"),
                (own == 0.0 && other == 0.0, "both weights are 0, so light is lost"),
                (sum > 1.0 + 1e-6, "your weights sum to more than 1, so light is counted twice"),
                (sum < 1.0 - 1e-6, "your weights sum to less than 1, so light is lost"),
            ])
    };
    unless(is_share(own) && is_share(other) && (sum - 1.0).abs() <= 1e-6, broken).formulas([
        "the squares of the densities overflow or underflow: divide first"
            .when(is(|own, other| own * own / (own * own + other * other))),
        (is(|own, other| own / (own + other)), "the sum of the densities overflows: divide first"),
    ])
}

pub(super) fn mis_weights_sum_to_one(trial: &Trial<'_>) -> CheckResult {
    let density = || prop_oneof![1 => fractions(1..=32, 8.0), 3 => magnitude(-4.0, 4.0)];
    let pairs = (density(), density(), 0..6i32)
        .prop_map(|(own, other, which)| (own, if which == 0 { own } else { other }));
    trial.forall(500, pairs, |pairs| {
        let answers = both_ways(trial, pairs);
        let outcomes = compare(pairs, answers.clone(), |pair, answers| {
            let refuted = judge_sum(pair, answers)?;
            let (larger, smaller) = if pair.0 >= pair.1 { answers } else { (answers.1, answers.0) };
            if larger >= smaller {
                return Ok(refuted);
            }
            let expected = "the larger density has the larger weight";
            Err(Broken::new(pair.call("mis_weight"), answers.0, expected, "the definition")
                .because("the smaller density gets the larger weight: own and other are exchanged"))
        });
        // Weights that are always 1/2 pass so far, although they ignore the densities.
        let all_half = pairs.len() > 1 && answers.iter().all(|(own, _)| *own == 0.5);
        if all_half {
            let (yours, expected) = ("0.5 for all densities", "a weight that depends on the densities");
            let broken = Broken::with_texts(pairs[0].call("mis_weight"), yours, expected, "the definition");
            return vec![Err(broken.because("your weights are 1/2 for all densities"))];
        }
        outcomes
    })
}

pub(super) fn mis_weight_of_a_lone_density_is_one(trial: &Trial<'_>) -> CheckResult {
    // 0: the other technique never takes this sample. ∞: a mirror always takes it.
    let cases = (magnitude(-6.0, 6.0), any::<bool>(), any::<bool>()).prop_map(|(density, certain, own)| {
        let special = if certain { f32::INFINITY } else { 0.0 };
        if own { (special, density) } else { (density, special) }
    });
    trial.each(200, cases, <dyn Kit>::mis_weight, |pair, yours| {
        let expected = if pair.0 == f32::INFINITY || pair.1 == 0.0 { 1.0 } else { 0.0 };
        if yours == expected {
            return Ok(());
        }
        Err(Broken::new(pair.call("mis_weight"), yours, expected, "the definition").explained_by([
            (yours.is_nan(), "you return NaN: ∞ / ∞"),
            "a technique with infinite density always takes this sample: it gets the whole weight"
                .when(pair.0.is_infinite() || pair.1.is_infinite()),
            (pair.1 == 0.0, "the other technique never takes this sample: its weight is 1"),
        ]))
    })?;
    // Where neither technique takes the sample, or both always do, any weight from 0 to 1 passes.
    let undecided = [(0.0, 0.0), (f32::INFINITY, f32::INFINITY)];
    all_hold(compare(&undecided, trial.kit.mis_weight(&undecided), |pair, yours| {
        if (0.0..=1.0).contains(&yours) {
            return Ok(());
        }
        let (input, expected) = (pair.call("mis_weight"), "any weight in 0..=1");
        Err(Broken::with_texts(input, format!("{yours:?}"), expected, "the definition")
            .explained_by([(yours.is_nan(), "you return NaN: 0 / 0 or ∞ / ∞")]))
    }))
}

pub(super) fn mis_weight_survives_extreme_densities(trial: &Trial<'_>) -> CheckResult {
    let extreme =
        || prop_oneof![1 => magnitude(18.0, 38.0), 1 => magnitude(-38.0, -18.0), 1 => Just(f32::MAX)];
    let pairs = (extreme(), extreme(), 0..4i32)
        .prop_map(|(own, other, which)| (own, if which == 0 { own } else { other }));
    trial.forall(300, pairs, |pairs| compare(pairs, both_ways(trial, pairs), judge_sum))
}

/// A lobe `cosⁿ θ` around the direction to the middle of a square light of this side at distance 1. Its radiance is 1.
#[derive(Clone, Copy, Debug)]
struct LobeAndLight {
    exponent: f64,
    side: f64,
}

/// The number of nodes along half a side.
const NODES: usize = 48;

impl LobeAndLight {
    /// Points of a quarter of the light: the density of the lobe, that of uniform points of the light, and the solid angle.
    fn nodes(&self) -> Vec<(f64, f64, f64)> {
        // The nodes are dense at the middle, where a sharp lobe is: x = side / 2 · t⁴.
        let half = 0.5 * self.side;
        let at = |index: usize| {
            let t = (index as f64 + 0.5) / NODES as f64;
            (half * t.powi(4), 4.0 * half * t.powi(3) / NODES as f64)
        };
        let mut nodes = Vec::with_capacity(NODES * NODES);
        for (x, dx) in (0..NODES).map(at) {
            for (y, dy) in (0..NODES).map(at) {
                let squared = 1.0 + x * x + y * y;
                let cosine = squared.sqrt().recip();
                let per_area = cosine / squared;
                let lobe = (self.exponent + 1.0) / TAU * cosine.powf(self.exponent);
                // Leave out the rest of a sharp lobe, which carries no light and would underflow.
                if lobe < 1e-30 {
                    continue;
                }
                nodes.push((lobe, 1.0 / (self.side * self.side * per_area), 4.0 * dx * dy * per_area));
            }
        }
        nodes
    }
}

/// The variance of one sample of each technique, in units of the squared mean, below which weights pass. The balance
/// heuristic reaches 0.183 and the power heuristic 0.179 for exponents from 1 to 10,000 and sides from 0.02 to 2; weights of 1/2
/// reach more than 1,000.
const LARGEST_VARIANCE: f64 = 0.25;

pub(super) fn mis_weights_keep_the_variance_low(trial: &Trial<'_>) -> CheckResult {
    let factors = trial.varied((1.0f64, 1.0f64), (1.0..3.0f64, 1.0..2.0f64));
    for exponent in [1.0, 10.0, 100.0, 1000.0, 3000.0] {
        for side in [0.02, 0.2, 1.0] {
            let case = LobeAndLight { exponent: exponent * factors.0, side: side * factors.1 };
            let nodes = case.nodes();
            let pairs: Vec<Pair> =
                nodes.iter().map(|(lobe, light, _)| (*lobe as f32, *light as f32)).collect();
            let weights = both_ways(trial, &pairs);
            // The mean and the second moment of each technique, by integrals: no random numbers.
            let (mut mean, mut means, mut squares) = (0.0, [0.0; 2], [0.0; 2]);
            for ((lobe, light, solid_angle), (by_lobe, by_light)) in nodes.iter().zip(&weights) {
                let arrives = lobe * solid_angle;
                mean += arrives;
                for (technique, (weight, density)) in
                    [(by_lobe, lobe), (by_light, light)].into_iter().enumerate()
                {
                    let weight = f64::from(*weight);
                    means[technique] += weight * arrives;
                    squares[technique] += weight * weight * arrives * lobe / density;
                }
            }
            let variance: f64 = (0..2).map(|i| squares[i] - means[i] * means[i]).sum::<f64>() / (mean * mean);
            let bias = (means[0] + means[1]) / mean - 1.0;
            if variance <= LARGEST_VARIANCE && bias.abs() < 1e-4 {
                continue;
            }
            let input = format!(
                "the light that a lobe cos^{:.0} θ receives from a square light of side {:.2} at distance 1,\none sample of the lobe and one of the light, weighted by mis_weight",
                case.exponent, case.side
            );
            let yours =
                format!("variance {variance:.4} of the squared mean, mean {:.4} of the light", 1.0 + bias);
            let expected = format!("at most {LARGEST_VARIANCE}, and all of the light");
            let broken = Broken::with_texts(input, yours, expected, "integrals over the light");
            let all = |is: &dyn Fn(&Pair, &Pair) -> bool| {
                pairs.iter().zip(&weights).all(|(pair, weights)| is(pair, weights))
            };
            let share =
                |power: f64, pair: &Pair| 1.0 / (1.0 + (f64::from(pair.1) / f64::from(pair.0)).powf(power));
            let by = |weight: &dyn Fn(&Pair) -> f64| {
                all(&|pair, weights| (f64::from(weights.0) - weight(pair)).abs() < 1e-3)
            };
            return Err(broken.explained_by(named![
                weights.iter().any(|(p, q)| p.is_nan() || q.is_nan()) => "you return NaN",
                by(&|pair| share(0.5, pair)) || by(&|pair| share(0.25, pair)) =>
                    "your weights are those of the roots of the densities, which differ too little",
                by(&|pair| 0.25 + 0.5 * share(1.0, pair)) || by(&|pair| 0.25 + 0.5 * share(2.0, pair)) =>
                    "your weights are the mean of 1/2 and a heuristic, so a rare sample counts too much",
                all(&|_, weights| *weights == (0.5, 0.5)) => "your weights are 1/2 for all densities",
                all(&|pair, weights| (pair.0 > pair.1) == (weights.0 < weights.1)) =>
                    "the smaller density gets the larger weight: own and other are exchanged",
                all(&|_, weights| *weights == (1.0, 1.0)) => "each technique counts in full, so light is counted twice",
            ]));
        }
    }
    Ok(())
}
