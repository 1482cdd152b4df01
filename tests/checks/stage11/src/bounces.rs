//! The light that paths of limited length miss.

use checks::prelude::*;

pub(super) fn cut_off_is_the_light_beyond_the_last_bounce(trial: &Trial<'_>) -> CheckResult {
    let albedo = prop_oneof![4 => fractions(0..=16, 16.0), 1 => 0.9..1.0f32];
    let bounces = prop_oneof![6 => 0..12u32, 2 => 12..3000u32, 1 => Just(u32::MAX)];
    let power = |albedo: f32, exponent: f64| f64::from(albedo).powf(exponent);
    let near = |yours: f32, expected: f64| {
        // The doc comment states these bounds.
        (f64::from(yours) - expected).abs() <= (1e-4 * expected).max(1e-6)
    };
    trial.each(300, (albedo, bounces), <dyn Kit>::cut_off, |(albedo, bounces), yours| {
        let n = f64::from(*bounces);
        let whole = 1.0 / (1.0 - f64::from(*albedo));
        let rest = power(*albedo, n + 1.0);
        let input = || format!("cut_off({albedo:?}, {bounces})");
        let overflow = *bounces == u32::MAX && yours == 1.0;
        let broken = || {
            Broken::new(input(), yours, rest, "albedo^(bounces + 1)")
                .explained_by([(overflow, "bounces + 1 overflows: add in a larger type")])
        };
        unless(near(yours, rest), broken).formulas([
            "the power is bounces: it is bounces + 1, because light is also seen directly"
                .when(near(yours, power(*albedo, n))),
            (near(yours, power(*albedo, n + 2.0)), "the power is bounces + 2: it is bounces + 1"),
            (near(yours, 1.0 - rest), "you return the fraction that is found, not the one that is missing"),
            "you return the missing light, not its fraction of all light"
                .when(near(yours, rest * whole) || (*albedo == 1.0 && !yours.is_finite())),
            (near(yours, f64::from(*albedo) * (n + 1.0)), "you multiply where a power is needed"),
        ])
    })
}

/// Judges a number of bounces by its definition.
fn judge(query: &(f32, f32), yours: u32) -> Judged {
    let (albedo, error) = (f64::from(query.0), f64::from(query.1));
    // The albedo to the power n, for n up to 2³² + 1.
    let power = |exponent: f64| albedo.powf(exponent);
    // Powers of 1/2 are exact. Other powers have a few roundings of a double for each factor of 2 in the exponent.
    let slack = if query.0.to_bits() & 0x7f_ffff == 0 { 0.0 } else { 1e-9 };
    let n = f64::from(yours);
    let is_enough = power(n + 1.0) <= error * (1.0 + slack);
    let is_smallest = yours == 0 || power(n) > error * (1.0 - slack);
    // The number by the definition, for the message. At the end a step may be off by a rounding.
    let bounces = if albedo <= error { 0.0 } else { error.ln() / albedo.ln() - 1.0 };
    let estimate = bounces.ceil();
    let quotient = if albedo <= error { 1.0 } else { error.ln() / albedo.ln() };
    let of_last = if albedo <= error { 0.0 } else { (error / (1.0 - albedo)).ln() / albedo.ln() };
    let expected = format!("about {estimate}, the smallest n with albedo^(n + 1) <= error");
    let right = is_enough && is_smallest;
    let broken = || {
        Broken::with_texts(query.call("bounces_for_error"), format!("{yours}"), expected, "the definition")
            .explained_by([
                (yours == u32::MAX, "there is a number that is enough"),
                (yours == 0 && estimate > 0.0, "0 bounces are not enough here"),
            ])
    };
    unless(right, broken).formulas(named![
        n == estimate + 1.0 || (right && estimate < 1.0) =>
            "one bounce too many: the power is n + 1, because light is also seen directly",
        n == if power(estimate + 1.0) == error { estimate + 1.0 } else { estimate.max(0.0) } =>
            "an error that is reached exactly is small enough: albedo^(n + 1) <= error",
        n == (bounces.floor().max(0.0)) => "one bounce too few: round up",
        n == (quotient.ceil() - 1.0).max(0.0) || n == estimate.max(0.0) =>
            "the quotient of the logarithms is rounded: test the power for this number and the one before",
        n == quotient.round().max(0.0) => "the quotient is rounded to the nearest number: round up",
        n == bounces.round().max(0.0) => "the quotient is rounded to the nearest number: round up",
        n == quotient.floor().max(0.0) => "the quotient of the logarithms is rounded down: it is n + 1, rounded up",
        n == of_last.ceil().max(0.0) || n == (of_last - 1.0).ceil().max(0.0) =>
            "the error is that of one bounce: all light after the last one is missing",
    ])
}

pub(super) fn bounces_for_error_is_the_smallest_number(trial: &Trial<'_>) -> CheckResult {
    // Next to 1 a bounce loses so little that logarithms in single precision are off by many bounces.
    let next_to_one = magnitude(-7.0, -2.0).prop_map(|loss| 1.0 - loss);
    let albedo = || prop_oneof![4 => fractions(1..=15, 16.0), 2 => 0.02..0.999f32, 1 => next_to_one.clone()];
    let drawn = (albedo(), magnitude(-6.0, 0.0));
    // Errors that are exactly a power of the albedo: one bounce more or less is wrong.
    let exact = (prop::sample::select(vec![0.5f32, 0.25, 0.125]), 1..9i32)
        .prop_map(|(albedo, power)| (albedo, albedo.powi(power)));
    trial.each(400, prop_oneof![3 => drawn, 1 => exact], <dyn Kit>::bounces_for_error, judge)
}

pub(super) fn bounces_for_error_at_the_limits(trial: &Trial<'_>) -> CheckResult {
    let share = || fractions(1..=64, 64.0);
    // All light stays in the room (albedo 1), none is reflected (0), no error is allowed (0), and any error is (1).
    let cases = (0..5i32, share()).prop_map(|(which, share)| match which {
        0 => (1.0, (share - 1.0 / 64.0).min(0.98)),
        1 => (0.0, (share - 0.5).max(0.0)),
        2 => (share, 0.0),
        3 => (share, 1.0),
        _ => (0.5, 0.5f32.powi(3)),
    });
    trial.each(300, cases, <dyn Kit>::bounces_for_error, |query, yours| {
        let (albedo, error) = *query;
        let expected = match () {
            () if albedo <= error => 0,
            () if error == 0.0 || albedo == 1.0 => u32::MAX,
            // 0.5^(2 + 1)
            () => 2,
        };
        if yours == expected {
            return Ok(());
        }
        Err(Broken::new(query.call("bounces_for_error"), yours, expected, "the definition").explained_by([
            (albedo == 1.0, "at an albedo of 1 all light is missing, however many bounces there are"),
            (albedo == 0.0, "at an albedo of 0 nothing is reflected: 0 bounces are enough"),
            (error == 0.0, "with an error of 0 no number is enough"),
            (error == 1.0, "an error of 1 allows 0 bounces"),
        ]))
    })
}
