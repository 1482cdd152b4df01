//! Glossy reflection: samples of a Phong lobe.

use super::pixels::unit_number;
use crate::unit_arrival;
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::{compare, known};
use checks::paste::call;
use checks::statistics::{SAMPLES, columns, covers_evenly, has_mean, pairs};
use glam::{Vec3, vec2, vec3};
use proptest::prelude::*;
use raykata::kit::PhongLobeQuery;

fn paste(query: &PhongLobeQuery) -> String {
    call("sample_phong_lobe", &[&query.ideal, &query.normal, &query.roughness, &query.u])
}

pub(super) fn smooth_surfaces_stay_sharp(trial: &Trial<'_>) -> CheckResult {
    let queries = (unit_arrival(), unit_number(), unit_number())
        .prop_map(|((ideal, normal), u, v)| PhongLobeQuery { ideal, normal, roughness: 0.0, u: vec2(u, v) });
    trial.forall(500, queries, |queries| {
        compare(queries, trial.kit.sample_phong_lobe(queries), |query, yours| {
            if yours == query.ideal {
                return Ok(());
            }
            let diagnosis = match () {
                () if yours.is_nan() => "you return NaN: 2 / 0² is infinite",
                () if (yours - query.ideal).length() < 1e-3 => {
                    "you recompute ideal, which adds a rounding error: with roughness 0 return ideal itself"
                }
                () => "you change the direction: with roughness 0 return ideal itself",
            };
            Err(Broken::new(paste(query), yours, query.ideal, "roughness 0").looks_like(known(diagnosis)))
        })
    })
}

/// Samples of a lobe around the normal, so that none is reflected back, as two fractions that must be uniform:
/// `cosⁿ⁺¹ θ`, and the angle around `ideal`.
fn lobe(trial: &Trial<'_>, roughness: f32) -> Result<Vec<(f64, f64)>, Broken> {
    let axis = vec3(0.48, 0.6, -0.64);
    let queries: Vec<PhongLobeQuery> = pairs(trial.seed, SAMPLES)
        .into_iter()
        .map(|u| PhongLobeQuery { ideal: axis, normal: axis, roughness, u })
        .collect();
    let exponent = 2.0 / f64::from(roughness).powi(2) - 2.0;
    let ideal = axis.as_dvec3().normalize();
    let (x, y) = ideal.any_orthonormal_pair();
    let mut shares = Vec::new();
    for (query, direction) in queries.iter().zip(trial.kit.sample_phong_lobe(&queries)) {
        let around = direction.as_dvec3();
        if !((around.length() - 1.0).abs() < 1e-5) {
            let broken = Broken::new(paste(query), direction, "a unit direction", "the definition");
            return Err(broken.looks_like(
                direction.is_nan().then_some("you return NaN: do you take the root of a negative number?"),
            ));
        }
        // cosⁿ⁺¹ θ is uniform in 0..1. Compute ln cos θ from the sine, which is precise for small angles.
        let sine_squared = around.cross(ideal).length_squared().min(1.0);
        let share = (0.5 * (exponent + 1.0) * (-sine_squared).ln_1p()).exp();
        shares.push((share, around.dot(y).atan2(around.dot(x)) / std::f64::consts::TAU + 0.5));
    }
    Ok(shares)
}

const AXES: [&str; 2] = ["cosⁿ⁺¹ θ", "the angle around ideal"];

const TOO_BLURRED: &str = "your lobe is too wide: is it u^(1 / (n + 1)), with n = 2 / roughness² - 2?";
const TOO_SHARP: &str = "your lobe is too narrow: is it u^(1 / (n + 1)), with n = 2 / roughness² - 2?";

pub(super) fn phong_lobe_falls_with_the_power_of_the_cosine(trial: &Trial<'_>) -> CheckResult {
    for roughness in [0.2, 0.5, 1.0] {
        let shares = lobe(trial, roughness)?;
        covers_evenly(&format!("sample_phong_lobe with roughness {roughness}"), &shares, AXES, |counts| {
            let rings = columns(counts);
            match () {
                // With the exponent 1 / n instead of 1 / (n + 1) the lobe is too wide: small cosines are too frequent.
                () if 4 * rings[0] > 5 * rings[7] => TOO_BLURRED,
                () if 4 * rings[7] > 5 * rings[0] => TOO_SHARP,
                () => "",
            }
        })?;
        // The mean of cos θ of a lobe with power n is (n + 1) / (n + 2).
        let n = 2.0 / f64::from(roughness).powi(2) - 2.0;
        let cosines: Vec<f64> = shares.iter().map(|(share, _)| share.powf(1.0 / (n + 1.0))).collect();
        let (mean, expected) = (cosines.iter().sum::<f64>() / cosines.len() as f64, (n + 1.0) / (n + 2.0));
        has_mean(
            &format!("the cosine of sample_phong_lobe with ideal, roughness {roughness}"),
            &cosines,
            expected,
            if mean < expected { TOO_BLURRED } else { TOO_SHARP },
        )?;
    }
    Ok(())
}

pub(super) fn slightly_rough_is_not_a_few_angles(trial: &Trial<'_>) -> CheckResult {
    // n is 2,000,000, so cosines differ from 1 in their last four bits only.
    let shares = lobe(trial, 0.001)?;
    covers_evenly("sample_phong_lobe with roughness 0.001", &shares, AXES, |counts| {
        let rings = columns(counts);
        let uneven = rings.iter().max() > Some(&(SAMPLES as u64 / 7)); // a ring has an eighth ± 2 %
        if uneven {
            "your angles take few values: √(1 - cos²) is imprecise; compute 1 - cos θ with exp_m1"
        } else {
            ""
        }
    })
}

pub(super) fn phong_lobe_stays_on_its_side(trial: &Trial<'_>) -> CheckResult {
    let queries = (unit_arrival(), 1..=16i32, unit_number(), unit_number()).prop_map(
        |((ideal, normal), sixteenths, u, v)| PhongLobeQuery {
            ideal,
            normal,
            roughness: sixteenths as f32 / 16.0,
            u: vec2(u, v),
        },
    );
    trial.forall(3000, queries, |queries| {
        // The same samples with the normal `ideal` give the directions before they are reflected back.
        let free: Vec<PhongLobeQuery> =
            queries.iter().map(|query| PhongLobeQuery { normal: query.ideal, ..*query }).collect();
        let drawn = trial.kit.sample_phong_lobe(&free);
        let pairs: Vec<(PhongLobeQuery, Vec3)> = queries.iter().copied().zip(drawn).collect();
        compare(&pairs, trial.kit.sample_phong_lobe(queries), |(query, drawn), yours| {
            let above = drawn.dot(query.normal);
            let expected = if above < 0.0 { *drawn - 2.0 * above * query.normal } else { *drawn };
            // The tolerance covers a few roundings. A ray parallel to the surface may be one rounding below it.
            if (yours - expected).length() < 1e-5 && yours.dot(query.normal) > -1e-5 {
                return Ok(());
            }
            let diagnosis = match () {
                () if yours.is_nan() => "you return NaN: ln 0 is -∞, and 0 · ∞ is NaN",
                () if (yours + *drawn).length() < 1e-4 => {
                    "you reverse the whole direction: reverse only its part along the normal"
                }
                () if above < -1e-3 && yours.dot(query.normal).abs() < 1e-5 => {
                    "you subtract the part along the normal once: subtract it twice"
                }
                () if yours.dot(query.normal) < 0.0 => {
                    "your ray goes through the surface: reflect it back by the normal"
                }
                () if above < 0.0 && yours == query.ideal => {
                    "you return ideal, which changes the distribution: reflect the ray back by the normal"
                }
                () => "",
            };
            Err(Broken::new(paste(query), yours, expected, "reflected back to the side of the normal")
                .looks_like(known(diagnosis)))
        })
    })
}
