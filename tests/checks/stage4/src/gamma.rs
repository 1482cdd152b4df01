//! Gamma 2: bytes from linear light, and linear light from bytes.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::known;
use checks::paste::Paste;

pub(super) fn gamma_is_two(trial: &Trial<'_>) -> CheckResult {
    let bytes: Vec<u8> = (0..=255).collect();
    let linear = trial.kit.decode_gamma(&bytes);
    for (&byte, &yours) in bytes.iter().zip(&linear) {
        let expected = (f64::from(byte) / 255.0).powi(2);
        if (f64::from(yours) - expected).abs() > 1e-6 {
            let diagnosis = match () {
                () if (f64::from(yours) - f64::from(byte) / 255.0).abs() < 1e-6 => {
                    "you do not square: decoding squares byte / 255"
                }
                () if (f64::from(yours) - expected * 255.0 * 255.0).abs() < 1e-2 => {
                    "you square the byte itself: divide it by 255 first"
                }
                () if (f64::from(yours) - (f64::from(byte) / 255.0).sqrt()).abs() < 1e-6 => {
                    "you take the root: encoding takes the root, decoding squares"
                }
                () if (f64::from(yours) - (f64::from(byte) / 255.0).powf(2.2)).abs() < 1e-6 => {
                    "you use gamma 2.2: the lecture uses gamma 2, which is the square"
                }
                () => "",
            };
            return Err(Broken::new(
                format!("decode_gamma({byte})"),
                yours,
                expected as f32,
                "(byte / 255)²",
            )
            .looks_like(known(diagnosis)));
        }
    }
    // √0.16 = 0.4. An answer that is off by one may be a wrong rounding, which has its own diagnosis below.
    let yours = trial.kit.encode_gamma(&[0.16])[0];
    if yours.abs_diff(102) > 1 {
        let diagnosis = match yours {
            41 => "the square root is missing: the byte is 255 times the root",
            160..=162 => "you take the root twice: take it once",
            6 | 7 => "you square: encoding takes the root, decoding squares",
            _ => "the byte is 255 times the root of the linear value",
        };
        let broken = Broken::new("encode_gamma(0.16)", yours, 102, "255 √linear, rounded");
        return Err(broken.looks_like(Some(diagnosis)));
    }
    let round_trip = trial.kit.encode_gamma(&linear);
    if let Some(byte) = (0..256).find(|&byte| usize::from(round_trip[byte]) != byte) {
        let broken = Broken::new(
            format!("encode_gamma(decode_gamma({byte}))"),
            round_trip[byte],
            byte as u8,
            "decoded and encoded again",
        );
        return Err(broken.looks_like(Some(match round_trip[byte] as usize {
            below if below + 1 == byte => "you round down: add 0.5 before the cast",
            _ => "the byte is 255 times the root of the linear value",
        })));
    }
    let between: Vec<f32> = (0..=1000).map(|i| i as f32 / 1000.0).collect();
    for (linear, yours) in between.iter().zip(trial.kit.encode_gamma(&between)) {
        let exact = 255.0 * f64::from(*linear).sqrt();
        if (f64::from(yours) - exact).abs() > 0.501 {
            let input = format!("encode_gamma({linear:?})");
            // All bytes survived the round trip above, so the factor may be 256 instead of 255.
            let down = (f64::from(yours) == exact.floor()).then_some(
                "you round down: add 0.5 to 255 √linear before the cast (256 √linear rounded down differs)",
            );
            return Err(
                Broken::new(input, yours, exact.round() as u8, "255 √linear, rounded").looks_like(down)
            );
        }
    }
    Ok(())
}

pub(super) fn gamma_survives_invalid_numbers(trial: &Trial<'_>) -> CheckResult {
    let cases =
        [(-1e-8, 0), (-5.0, 0), (1.0000001, 255), (7.0, 255), (f32::INFINITY, 255), (f32::NEG_INFINITY, 0)];
    for ((linear, expected), yours) in cases.iter().zip(trial.kit.encode_gamma(&cases.map(|case| case.0))) {
        if yours != *expected {
            return Err(Broken::new(
                format!("encode_gamma({})", linear.paste()),
                yours,
                expected,
                "clamped to 0..=1",
            )
            .looks_like(Some("clamp to 0..=1 before the root")));
        }
    }
    Ok(())
}
