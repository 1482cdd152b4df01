//! Gamma 2: bytes from linear light, and linear light from bytes.

use checks::prelude::*;

pub(super) fn gamma_is_two(trial: &Trial<'_>) -> CheckResult {
    let bytes: Vec<u8> = (0..=255).collect();
    all_hold(compare(&bytes, trial.kit.decode_gamma(&bytes), |byte, yours| judge_decoded(*byte, yours)))?;
    // The middle of each byte's interval, where rounding down gives the same byte; then numbers between.
    let middles = bytes.iter().map(|byte| (f32::from(*byte) / 255.0).powi(2));
    let linear: Vec<f32> = middles.chain((0..=1000).map(|i| i as f32 / 1000.0)).collect();
    let judge = |linear: &[f32]| {
        compare(linear, trial.kit.encode_gamma(linear), |linear, yours| judge_encoded(*linear, yours))
    };
    all_hold(judge(&linear))?;
    trial.forall(500, checks::generate::number(0.0..1.0f32.next_up()), judge)
}

fn judge_decoded(byte: u8, yours: f32) -> Judged {
    let share = f64::from(byte) / 255.0;
    // The tolerance covers two roundings of a number up to 1. Mistakes that scale the number have a relative one.
    let near = |value: f64| (f64::from(yours) - value).abs() < 1e-6 * value.max(1.0);
    let broken =
        || Broken::new(format!("decode_gamma({byte})"), yours, (share * share) as f32, "(byte / 255)²");
    unless(near(share * share), broken).formulas([
        (near(share), "you do not square: decoding squares byte / 255"),
        (near(f64::from(byte).powi(2)), "you square the byte itself: divide it by 255 first"),
        (near(share.sqrt()), "you take the root: encoding takes the root, decoding squares"),
        (near(share.powf(2.2)), "you use gamma 2.2: the lecture uses gamma 2, which is the square"),
        "you use the transfer function of sRGB: the lecture uses gamma 2, which is the square"
            .when(near(if share <= 0.040_45 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) })),
        (near((f64::from(byte) / 256.0).powi(2)), "you divide by 256: the largest byte is 255"),
    ])
}

fn judge_encoded(linear: f32, yours: u8) -> Judged {
    let exact = f64::from(linear);
    let right = 255.0 * exact.sqrt();
    // An exact half may be rounded either way; the thousandth covers the rounding of the root.
    let is_right = (f64::from(yours) - right).abs() <= 0.501;
    // Whether a number rounded down gives this byte, up to the rounding of the formula.
    let down = |value: f64| (-0.001..1.001).contains(&(value - f64::from(yours)));
    let mut mistakes = vec![
        (down(right), "you round down: add 0.5 before the cast"),
        (down(right + 1.0), "you round up: round to the nearest byte"),
    ];
    // As in One Weekend: a factor that no byte reaches, rounded down.
    let text = "you round 256 √linear, or a little less, down: round 255 √linear to the nearest byte";
    let factors = [256.0, 255.999, 255.99, 255.9];
    mistakes.extend(factors.map(|factor| (down((factor * exact.sqrt()).min(255.9)), text)));
    let formulas = named![
        255.0 * exact => "the square root is missing: the byte is 255 times the root",
        right.sqrt() * 255f64.sqrt() => "you take the root twice: take it once",
        255.0 * exact.cbrt() => "you take the cube root: gamma 2 is the square root",
        255.0 * exact.powf(1.0 / 1.8) => "you use gamma 1.8: the lecture uses gamma 2, the square root",
        255.0 * exact.powf(1.0 / 2.4) => "you use gamma 2.4: the lecture uses gamma 2, the square root",
        255.0 * exact * exact => "you square: encoding takes the root, decoding squares",
        255.0 * exact.powf(1.0 / 2.2) => "you use gamma 2.2: the lecture uses gamma 2, the square root",
        255.0 * if exact <= 0.003_130_8 { 12.92 * exact } else { 1.055 * exact.powf(1.0 / 2.4) - 0.055 } =>
            "you use the transfer function of sRGB: the lecture uses gamma 2, the square root",
    ];
    // A wrong formula may be rounded down, or to the nearest byte.
    mistakes.extend(
        formulas.into_iter().flat_map(|(value, text)| [(down(value), text), (down(value + 0.5), text)]),
    );
    let input = || format!("encode_gamma({})", linear.paste());
    unless(is_right, || Broken::new(input(), yours, right.round() as u8, "255 √linear, rounded"))
        .formulas(mistakes)
}

pub(super) fn gamma_survives_invalid_numbers(trial: &Trial<'_>) -> CheckResult {
    let (low, high) = trial.varied((-5.0, 7.0), (-50.0f32..-0.5, 1.5f32..50.0));
    let cases = [
        (-1e-8, 0),
        (low, 0),
        (1.0000001, 255),
        (high, 255),
        (3e38, 255),
        (f32::INFINITY, 255),
        (f32::NEG_INFINITY, 0),
        (0.25, 128),
    ];
    let linear = cases.map(|case| case.0);
    let answers = trial.kit.encode_gamma(&linear);
    let judged = cases.iter().zip(answers).map(|((linear, expected), yours)| {
        if yours == *expected || (*linear == 0.25 && yours == 127) {
            return Ok(());
        }
        let input = format!("encode_gamma({})", linear.paste());
        Err(Broken::new(input, yours, expected, "clamped to 0..=1").explained_by([
            (*linear > 1.0, "a number above 1 must give 255: clamp to 0..=1 before the root"),
            (*linear < 0.0, "a number below 0 must give 0: clamp to 0..=1 before the root"),
            (!(0.0..=1.0).contains(linear), "numbers outside 0..=1 must be clamped"),
        ]))
    });
    all_hold(judged.collect())
}
