//! The laws of `stable_roots`.

use super::Odd;
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::double::U;
use checks::generate::magnitude;
use checks::judge::{compare, known};
use checks::paste::call;
use proptest::prelude::*;

type Coefficients = [f32; 3];

fn describe([a, b, c]: &Coefficients) -> String {
    call("stable_roots", &[a, b, c])
}

/// The discriminant in double precision, where both products are exact, and its distance from 0 in roundings of single
/// precision.
fn discriminant([a, b, c]: Coefficients) -> (f64, f64) {
    let (square, product) = (f64::from(b).powi(2), 4.0 * f64::from(a) * f64::from(c));
    (square - product, (square - product).abs() / (U * (square + product.abs())))
}

/// Roots in double precision by the formula that does not cancel, the smaller one first.
fn roots(coefficients: Coefficients) -> [f64; 2] {
    let [a, b, c] = coefficients.map(f64::from);
    let q = -0.5 * (b + discriminant(coefficients).0.sqrt().copysign(b));
    let (first, second) = if q == 0.0 { (0.0, 0.0) } else { (q / a, c / q) };
    [first.min(second), first.max(second)]
}

pub(super) fn roots_do_not_cancel(trial: &Trial<'_>) -> CheckResult {
    let judge = |query: &Coefficients, yours: Option<[f32; 2]>| {
        let (value, roundings) = discriminant(*query);
        // Leave nearly equal roots to another check: they move by the square root of a rounding.
        if value < 0.0 || roundings < 1e6 {
            return Ok(());
        }
        let expected = roots(*query);
        let broken = || Broken::new(describe(query), yours, expected, "double precision");
        let Some(yours) = yours else {
            return Err(broken().looks_like(Some(
                "you return None, but the discriminant is far above 0: there are two roots",
            )));
        };
        // Allow six roundings; a discriminant in single precision, 1e6 roundings away from 0, adds √(2u / 1e6) / 2 ≈
        // 3u.
        let near =
            |yours: f32, exact: f64| (f64::from(yours) - exact).abs() <= 10.0 * U * exact.abs() + 1e-44;
        if near(yours[0], expected[0]) && near(yours[1], expected[1]) {
            return Ok(());
        }
        let swapped = near(yours[0], expected[1]) && near(yours[1], expected[0]);
        let small = if expected[0].abs() < expected[1].abs() { 0 } else { 1 };
        let diagnosis = match () {
            () if swapped => {
                "you return the larger root first: the smaller root comes first, also if a or b is negative"
            }
            () if yours[small] == 0.0 && expected[small] != 0.0 => {
                "one root has cancelled to 0: -b + √(b² - 4ac) subtracts two nearly equal numbers"
            }
            () if near(yours[1 - small], expected[1 - small]) => {
                "one root has lost its digits: compute it as c / q, without a difference"
            }
            () if near(2.0 * yours[1 - small], expected[1 - small])
                || near(0.5 * yours[1 - small], expected[1 - small]) =>
            {
                "off by a factor of 2: q is half of -(b + sign(b) √(b² - 4ac))"
            }
            () => "",
        };
        Err(broken().looks_like(known(diagnosis)))
    };
    let drawn =
        [[1.0, -10_000.0, 1.0], [-2.0, 3e4, 0.5], [1.0, 10_000.0, 1.0], [2.0, -3.0, -4.0], [3.0, 0.0, -12.0]];
    compare(&drawn, trial.kit.stable_roots(&drawn), judge).into_iter().collect::<CheckResult>()?;
    let signed =
        |low, high| (magnitude(low, high), any::<bool>()).prop_map(|(x, minus)| if minus { -x } else { x });
    let queries = (signed(-3.0, 3.0), signed(-3.0, 5.0), signed(-3.0, 3.0)).prop_map(|(a, b, c)| [a, b, c]);
    trial.forall(5000, queries, |queries| compare(queries, trial.kit.stable_roots(queries), judge))
}

pub(super) fn roots_that_touch_are_found(trial: &Trial<'_>) -> CheckResult {
    // a (t - p)² with integers: the products are exact in single precision, so the sign of the discriminant is exact.
    let queries = (1..=4i32, -500..=500i32, -1..=1i32).prop_map(|(a, p, step)| {
        let (a, p) = (a as f32, p as f32);
        [a, -2.0 * a * p, a * p * p + step as f32]
    });
    trial.forall(2000, queries, |queries| {
        compare(queries, trial.kit.stable_roots(queries), |query, yours| {
            let (value, _) = discriminant(*query);
            let p = f64::from(-query[1] / (2.0 * query[0]));
            let broken = |expected: String, diagnosis: &'static str| {
                Err(Broken::with_texts(
                    describe(query),
                    format!("{yours:?}"),
                    expected,
                    "whole numbers, exactly",
                )
                .looks_like(Some(diagnosis)))
            };
            match (value, yours) {
                (value, None) if value < 0.0 => Ok(()),
                (value, Some(_)) if value < 0.0 => {
                    broken("None".into(), "you return roots although the discriminant is below 0")
                }
                (0.0, None) => broken(
                    format!("Some([{p}, {p}])"),
                    "a double root is a root: the parabola touches the axis",
                ),
                (0.0, Some(roots))
                    if roots.iter().any(|&root| (f64::from(root) - p).abs() > 4.0 * U * p.abs()) =>
                {
                    broken(format!("Some([{p}, {p}])"), "return a double root twice")
                }
                (_, None) => {
                    broken("two roots".into(), "you return None although the discriminant is above 0")
                }
                _ => Ok(()),
            }
        })
    })
}

pub(super) fn roots_of_special_numbers_are_finite(trial: &Trial<'_>) -> CheckResult {
    let mut odd = Odd::new(trial, 10);
    let mut queries: Vec<Coefficients> = vec![[0.0, 1.0, 1.0], [1.0, 0.0, 0.0], [1.0, f32::NAN, 1.0]];
    queries.extend((0..1000).map(|_| [(); 3].map(|()| odd.number())));
    let judge = |query: &Coefficients, yours: Option<[f32; 2]>| {
        let refused = query[0] == 0.0 || !query.iter().all(|x| x.is_finite());
        let broken = |expected: &str, diagnosis: &'static str| {
            Err(Broken::with_texts(describe(query), format!("{yours:?}"), expected, "the definition")
                .looks_like(known(diagnosis)))
        };
        match yours {
            Some(_) if refused => {
                broken("None", "you return roots although a is 0, or a number is not finite")
            }
            Some([first, second]) if first.is_nan() || second.is_nan() => {
                broken("numbers, or None", "you return NaN: 0 / 0, or the difference of two infinities")
            }
            Some([first, second]) if first > second => broken("the smaller one first", ""),
            None if query[1..] == [0.0, 0.0] && !refused => {
                broken("Some([0, 0])", "you return None for b = c = 0: a t² = 0 has the root 0")
            }
            _ => Ok(()),
        }
    };
    compare(&queries, trial.kit.stable_roots(&queries), judge).into_iter().collect()
}
