//! The laws of `stable_roots`.

use super::Odd;
use checks::prelude::*;

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

/// Whether a root is right up to five roundings; and a discriminant in single precision, 1e6 roundings away from 0, adds
/// √(2u / 1e6) / 2 ≈ 3u.
fn near(yours: f32, exact: f64) -> bool {
    let least = f64::from(f32::from_bits(1));
    f64::from(yours) == exact || (f64::from(yours) - exact).abs() <= 10.0 * U * exact.abs() + 10.0 * least
}

/// Two roots are right, if both are near the exact ones.
fn are_near(yours: [f32; 2], exact: [f64; 2]) -> bool {
    near(yours[0], exact[0]) && near(yours[1], exact[1])
}

type Named = (bool, &'static str);

const LARGER_FIRST: &str =
    "you return the larger root first: the smaller root comes first, also if a or b is negative";

/// The roots if the root of the discriminant is always added to b, in double and in single precision.
fn without_the_sign_of_b(coefficients: Coefficients) -> [[f32; 2]; 2] {
    let [a, b, c] = coefficients.map(f64::from);
    let root = discriminant(coefficients).0.sqrt();
    let q = -0.5 * (b + root);
    let single = -0.5 * (coefficients[1] + root as f32);
    let pair = |p: f32, r: f32| [p.min(r), p.max(r)];
    let of = |q: f64| if q == 0.0 { [0.0, 0.0] } else { pair((q / a) as f32, (c / q) as f32) };
    [of(q), of(f64::from(single))]
}

/// Wrong formulas in double precision, each with the roots that it gives.
fn wrong_roots(query: &Coefficients) -> [(Option<[f64; 2]>, &'static str); 15] {
    let [a, b, c] = query.map(f64::from);
    let sorted = |p: f64, r: f64| [p.min(r), p.max(r)];
    // The roots by q for a discriminant and the number that is added to b.
    let by = |discriminant: f64, q: &dyn Fn(f64) -> f64| {
        let q = q(discriminant.sqrt());
        (discriminant >= 0.0).then(|| if q == 0.0 { [0.0, 0.0] } else { sorted(q / a, c / q) })
    };
    let (right, usual) = (discriminant(*query).0, |root: f64| -0.5 * (b + root.copysign(b)));
    let q = usual(right.sqrt());
    let some = |roots: [f64; 2]| (right >= 0.0).then_some(roots);
    let [low, high] = roots(*query);
    let single = query[1] * query[1] - 4.0 * query[0] * query[2];
    named![
        by(right, &|root| -0.5 * (b - root.copysign(b))) => OTHER_SIGN,
        by(right, &|root| f64::from(-0.5 * (b as f32 - (root as f32).copysign(b as f32)))) => OTHER_SIGN,
        by(right, &|root| -0.5 * (b.abs() + root)) => "you take the absolute value of b: q has the sign of -b",
        by(right, &|root| 0.5 * (b + root.copysign(b))) => "q has the wrong sign: it is -(b + sign(b) √(b² - 4ac)) / 2",
        by(b * b - 2.0 * a * c, &usual) => DISCRIMINANT,
        by(b * b - a * c, &usual) => DISCRIMINANT,
        by(b * b + 4.0 * a * c, &usual) => DISCRIMINANT,
        by(f64::from(single), &usual) => "the discriminant is computed in single precision, where it loses its digits",
        some(sorted(q / (2.0 * a), c / q)) => "one root is divided by 2 a, although q is halved already: it is q / a",
        some(sorted(q / a, q / c)) => "the second root is turned over: it is c / q",
        some(sorted(q / a, c * q)) => "the second root is a product: it is c / q",
        some(if low < 0.0 { [high, high] } else { [low, high] }) => POSITIVE,
        some([low.abs(), high.abs()]) => POSITIVE,
        if b == 0.0 { some([0.0, 0.0]) } else { some([low, high]) } => OF_ZERO,
        some([low, high]).filter(|_| b != 0.0) => OF_ZERO,
    ]
}

const OTHER_SIGN: &str =
    "the root of the discriminant has the sign that cancels: q = -(b + sign(b) √(b² - 4ac)) / 2";
const DISCRIMINANT: &str = "the discriminant is another one: it is b² - 4ac";
const POSITIVE: &str = "a negative root is replaced: the equation has no range, so both roots are returned";
const OF_ZERO: &str = "b = 0 has an answer of its own: sign(0) must not be 0, and the roots are ±√(-c / a)";

/// What two wrong roots show, and the wrong formulas, each with whether it gives these roots.
fn mistakes(query: &Coefficients, yours: [f32; 2], expected: [f64; 2]) -> ([Named; 3], [Named; 4]) {
    const WITHOUT_SIGN: &str =
        "you leave out the sign of b, so a root cancels if b is negative: q = -(b + sign(b) √(b² - 4ac)) / 2";
    const OFF_BY_TWO: &str = "off by a factor of 2: q is half of -(b + sign(b) √(b² - 4ac))";
    let (small, large) = if expected[0].abs() < expected[1].abs() { (0, 1) } else { (1, 0) };
    // The error of a difference of two numbers of the size of the larger root.
    let rounding = 16.0 * U * expected[large].abs();
    let lost =
        near(yours[large], expected[large]) && (f64::from(yours[small]) - expected[small]).abs() <= rounding;
    let scaled = |of_small: f64| {
        let mut roots = expected;
        (roots[small], roots[large]) = (of_small * expected[small], expected[large] / of_small);
        roots
    };
    let is = |roots: [f64; 2]| are_near(yours, roots);
    // The two wrong roots are sorted again.
    let sorted = |[p, q]: [f64; 2]| [p.min(q), p.max(q)];
    let [in_double, in_single] = without_the_sign_of_b(*query).map(|roots| roots.map(f64::from));
    let shown = [
        (is([expected[1], expected[0]]), LARGER_FIRST),
        "one root has cancelled to 0: -b + √(b² - 4ac) subtracts two nearly equal numbers"
            .when(lost && yours[small] == 0.0),
        "one root has lost its digits, because two nearly equal numbers are subtracted: where one root has cancelled, compute it as c / q"
            .when(lost),
    ];
    let [half, twice] = [0.5, 2.0].map(|factor| is(scaled(factor)) || is(sorted(scaled(factor))));
    let without_sign = [in_double, in_single].map(|roots| (is(roots), WITHOUT_SIGN));
    (shown, [without_sign[0], without_sign[1], (half, OFF_BY_TWO), (twice, OFF_BY_TWO)])
}

pub(super) fn roots_do_not_cancel(trial: &Trial<'_>) -> CheckResult {
    let judge = |query: &Coefficients, yours: Option<[f32; 2]>| {
        let (value, roundings) = discriminant(*query);
        // Leave nearly equal roots to another check: they move by the square root of a rounding.
        if roundings < 1e6 {
            return Ok(().into());
        }
        let expected = (value > 0.0).then(|| roots(*query));
        let broken = || Broken::new(describe(query), yours, expected, "double precision");
        let gives = |given: Option<[f64; 2]>| match (yours, given) {
            (Some(yours), Some(given)) => are_near(yours, given),
            (yours, given) => yours.is_none() && given.is_none(),
        };
        let others = wrong_roots(query).map(|(given, text)| (gives(given), text));
        let (shown, formulas) = match (yours, expected) {
            (Some(yours), Some(expected)) => mistakes(query, yours, expected),
            _ => mistakes(query, [f32::NAN; 2], [f64::NAN; 2]),
        };
        let verdicts = [
            (expected.is_none(), "you return roots although the discriminant is below 0"),
            (yours.is_none(), "you return None, but the discriminant is far above 0: there are two roots"),
        ];
        let broken = || broken().explained_by(verdicts.into_iter().chain(shown));
        // Where both answers are None, each of these formulas has no roots either.
        let none = expected.is_none() && yours.is_none();
        let formulas = formulas.map(|(gives, text)| (gives || none, text));
        unless(gives(expected), broken).formulas(formulas.into_iter().chain(others))
    };
    let drawn =
        [[1.0, -10_000.0, 1.0], [-2.0, 3e4, 0.5], [1.0, 10_000.0, 1.0], [2.0, -3.0, -4.0], [3.0, 0.0, -12.0]];
    let signed =
        |low, high| (magnitude(low, high), any::<bool>()).prop_map(|(x, minus)| if minus { -x } else { x });
    let queries = (signed(-3.0, 3.0), signed(-3.0, 5.0), signed(-3.0, 3.0)).prop_map(|(a, b, c)| [a, b, c]);
    trial
        .forall_and(&drawn, 5000, queries, |queries| compare(queries, trial.kit.stable_roots(queries), judge))
}

pub(super) fn roots_that_touch_are_found(trial: &Trial<'_>) -> CheckResult {
    // a (t - p)² with integers: the products are exact in single precision, so the sign of the discriminant is exact.
    // A power of two changes no rounding.
    let queries = (prop::sample::select(vec![1, 2, 3, 4, -1, -3]), -500..=500i32, -1..=1i32, -20..=20i32)
        .prop_map(|(a, p, step, exponent)| {
            let (a, p, scale) = (a as f32, p as f32, 2f32.powi(exponent));
            [a, -2.0 * a * p, a * p * p + step as f32].map(|x| scale * x)
        });
    trial.each(2000, queries, <dyn Kit>::stable_roots, |query, yours| {
        let (value, _) = discriminant(*query);
        let exact = roots(*query);
        let double = value == 0.0;
        // The double root of the parabola with the same axis that touches.
        let axis = -f64::from(query[1]) / (2.0 * f64::from(query[0]));
        let touches = yours.is_some_and(|yours| are_near(yours, [axis, axis]));
        // A discriminant of 0 makes q = -b / 2, and q / a and c / q differ.
        let (q, [a, c]) = (-0.5 * f64::from(query[1]), [query[0], query[2]].map(f64::from));
        let of_band = if q == 0.0 { [0.0, 0.0] } else { [(q / a).min(c / q), (q / a).max(c / q)] };
        let touches = touches || yours.is_some_and(|yours| are_near(yours, of_band));
        let band = (!double && touches, "you treat a discriminant near 0 as 0: it is not 0");
        let broken = |expected: String| {
            Broken::with_texts(describe(query), format!("{yours:?}"), expected, "whole numbers, exactly")
        };
        match yours {
            None if value < 0.0 => Ok(()),
            Some(_) if value < 0.0 => Err(broken("None".into())
                .explained_by([band, (true, "you return roots although the discriminant is below 0")])),
            None => Err(broken(format!("{exact:?}")).explained_by([
                (double, "a double root is a root: the parabola touches the axis"),
                (!double, "you return None although the discriminant is above 0"),
                (true, "you return None although the discriminant is not below 0"),
            ])),
            Some(yours) if are_near(yours, exact) => Ok(()),
            Some(yours) => {
                let one = near(yours[0], exact[0]) != near(yours[1], exact[1]);
                let twice = (
                    double && one && !yours.map(f32::is_nan).contains(&true),
                    "return a double root twice: only one of yours is right",
                );
                let shown = mistakes(query, yours, exact).0.into_iter().filter(|_| !double);
                Err(broken(format!("{exact:?}")).explained_by([band, twice].into_iter().chain(shown)))
            }
        }
    })
}

pub(super) fn roots_of_special_numbers_are_finite(trial: &Trial<'_>) -> CheckResult {
    let mut odd = Odd::new(trial, 10);
    let mut queries: Vec<Coefficients> =
        vec![[0.0, 1.0, 1.0], [1.0, 0.0, 0.0], [1.0, f32::NAN, 1.0], [1.0, 0.0, -4.0], [-2.0, -0.0, -0.0]];
    queries.extend((0..1000).map(|_| [(); 3].map(|()| odd.number())));
    let judge = |query: &Coefficients, yours: Option<[f32; 2]>| {
        let refused = query[0] == 0.0 || !query.iter().all(|x| x.is_finite());
        let zero = query[1..] == [0.0, 0.0] && !refused;
        let broken = |expected: &str, mistakes: &[(bool, &'static str)]| {
            Err(Broken::with_texts(describe(query), format!("{yours:?}"), expected, "the definition")
                .explained_by(mistakes.iter().copied()))
        };
        let is_nan = yours.is_some_and(|roots| roots.iter().any(|root| root.is_nan()));
        let nan = (is_nan, "you return NaN: 0 / 0, ∞ - ∞ or 0 · ∞");
        match yours {
            Some(_) if refused => broken(
                "None",
                &[
                    (query[0] == 0.0, "you return roots although a is 0: the equation is not quadratic"),
                    (query[0] != 0.0, "you return roots although a number is not finite"),
                    (true, "you return roots although a is 0, or a number is not finite"),
                ],
            ),
            Some(roots) if zero && roots != [0.0, 0.0] => broken("Some([0, 0])", &[nan]),
            Some(_) if is_nan => broken("numbers, or None", &[nan]),
            Some([first, second]) if first > second => {
                broken("the smaller one first", &[(true, LARGER_FIRST)])
            }
            None if zero => {
                broken("Some([0, 0])", &[(true, "you return None for b = c = 0: a t² = 0 has the root 0")])
            }
            None if *query == [1.0, 0.0, -4.0] => broken("Some([-2, 2])", &[]),
            _ => Ok(()),
        }
    };
    all_hold(compare(&queries, trial.kit.stable_roots(&queries), judge))
}
