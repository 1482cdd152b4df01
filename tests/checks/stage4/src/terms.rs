//! The diffuse and the specular term.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::unit;
use checks::judge::{compare, known};
use checks::paste::call;
use glam::{Vec3, vec3};
use proptest::prelude::*;
use raykata::kit::TermQuery;

pub(super) fn terms() -> impl Strategy<Value = TermQuery> + Clone {
    (unit(), unit(), unit(), 0..=64i32, any::<bool>()).prop_map(
        |(normal, to_light, to_viewer, exponent, aim)| {
            // Half of the viewers are near the reflected light, so that there are highlights to judge.
            let mirrored = 2.0 * normal.dot(to_light) * normal - to_light;
            let to_viewer = if aim { (mirrored + 0.3 * to_viewer).normalize() } else { to_viewer };
            TermQuery { normal, to_light, to_viewer, exponent: exponent as f32 / 2.0 }
        },
    )
}

pub(super) fn paste_term(name: &str, query: &TermQuery) -> String {
    match name {
        "diffuse_term" => call(name, &[&query.normal, &query.to_light]),
        _ => call(name, &[&query.normal, &query.to_light, &query.to_viewer, &query.exponent]),
    }
}

pub(super) fn diffuse_term_is_the_cosine(trial: &Trial<'_>) -> CheckResult {
    let judge = |queries: &[TermQuery]| {
        compare(queries, trial.kit.diffuse_term(queries), |query, yours| {
            let cosine = query.normal.as_dvec3().dot(query.to_light.as_dvec3());
            let expected = cosine.max(0.0) as f32;
            let diagnosis = match () {
                () if (f64::from(yours) - cosine).abs() < 1e-6 => {
                    "you return a negative cosine for a light behind the surface: return at least 0"
                }
                () if (f64::from(yours) - cosine.abs()).abs() < 1e-6 => {
                    "you return the absolute value: a light behind the surface gives 0"
                }
                () if yours == 1.0 => "you return 1: the cosine is missing",
                () if yours == 0.0 && cosine > 0.0 => {
                    "you return 0 for a light in front of the surface: is a direction negated?"
                }
                () => "",
            };
            let input = paste_term("diffuse_term", query);
            // The tolerance covers three products and two sums of numbers up to 1.
            if (yours - expected).abs() < 1e-6 {
                Ok(())
            } else {
                Err(Broken::new(input, yours, expected, "closed form").looks_like(known(diagnosis)))
            }
        })
    };
    // Begin with a light in front: behind the surface a wrong sign and an absolute value give the same answer.
    let (to_light, to_viewer) = (vec3(0.6, 0.8, 0.0), Vec3::Y);
    judge(&[TermQuery { normal: Vec3::Y, to_light, to_viewer, exponent: 1.0 }])
        .into_iter()
        .collect::<CheckResult>()?;
    trial.forall(2000, terms(), judge)
}

/// The cosine of the angle between the reflected light and the viewer, in double precision.
pub(super) fn cos_phi(query: &TermQuery) -> f64 {
    let [n, l, v] = [query.normal, query.to_light, query.to_viewer].map(Vec3::as_dvec3);
    (2.0 * n.dot(l) * n - l).dot(v)
}

/// `cosⁿ φ` in double precision.
pub(super) fn specular(query: &TermQuery) -> f64 {
    let cos_theta = query.normal.as_dvec3().dot(query.to_light.as_dvec3());
    let cos_phi = cos_phi(query);
    if cos_theta > 0.0 && cos_phi > 0.0 { cos_phi.powf(f64::from(query.exponent)) } else { 0.0 }
}

pub(super) fn specular_term_is_the_mirrored_cosine(trial: &Trial<'_>) -> CheckResult {
    // Begin with a highlight for which every known mistake gives a different number.
    let drawn = TermQuery {
        normal: Vec3::Y,
        to_light: vec3(0.6, 0.8, 0.0),
        to_viewer: vec3(-0.28, 0.96, 0.0),
        exponent: 2.0,
    };
    judge_highlights(trial, &[drawn]).into_iter().collect::<CheckResult>()?;
    trial.forall(3000, terms(), |queries| judge_highlights(trial, queries))
}

fn judge_highlights(trial: &Trial<'_>, queries: &[TermQuery]) -> Vec<CheckResult> {
    compare(queries, trial.kit.specular_term(queries), |query, yours| {
        let [n, l, v] = [query.normal, query.to_light, query.to_viewer].map(Vec3::as_dvec3);
        let exponent = f64::from(query.exponent);
        let expected = specular(query);
        // For exponent 0 the sign of a cosine near 0 decides between 0 and 1, so either answer passes.
        let cos_phi = cos_phi(query);
        let edge = n.dot(l).abs() < 1e-5 || cos_phi.abs() < 1e-5;
        // The cosine is off by a few roundings. The power multiplies this by n cosⁿ⁻¹ φ, which exceeds n for n < 1.
        let steep = if cos_phi > 0.0 { exponent * cos_phi.powf(exponent - 1.0).max(1.0) } else { exponent };
        if edge || (f64::from(yours) - expected).abs() < 1e-6 * (1.0 + steep) {
            return Ok(());
        }
        let near = |value: f64| (f64::from(yours) - value).abs() < 1e-5 * (1.0 + exponent);
        let power = |cosine: f64| cosine.max(0.0).powf(exponent);
        let diagnosis = match () {
            () if yours.is_nan() => "a negative cosine to a fractional power is NaN: return 0 first",
            () if n.dot(l) <= 0.0 => "you return a highlight for a light behind the surface: return 0",
            () if near(power((l + v).normalize().dot(n))) => {
                "you use the half vector (Blinn-Phong): the lecture reflects the light (Phong)"
            }
            () if near(power(n.dot(l))) => {
                "you use θ: φ is the angle between the reflected light and the viewer"
            }
            () if near(cos_phi) => "you leave out the exponent",
            () if near(power((n.dot(l) * n - l).dot(v))) => "you leave out the factor 2 of 2 (n·l) n - l",
            () if yours == 0.0 && cos_phi > 0.0 => {
                "you return 0 where there is a highlight: the reflected light is 2 (n·l) n - l"
            }
            () => "",
        };
        Err(Broken::new(paste_term("specular_term", query), yours, expected as f32, "closed form")
            .looks_like(known(diagnosis)))
    })
}

pub(super) fn light_from_behind_adds_nothing(trial: &Trial<'_>) -> CheckResult {
    // L1: a negative cos φ to an even power is positive, to a fractional power NaN. Some lights are below the horizon.
    let below = vec3(0.6, -0.8, 0.0);
    let aside = vec3(0.8, 0.6, 0.0);
    let queries: Vec<TermQuery> = [0.0, 2.0, 2.5, 32.0]
        .into_iter()
        .flat_map(|exponent| {
            [
                TermQuery { normal: Vec3::Y, to_light: below, to_viewer: vec3(-0.6, 0.8, 0.0), exponent },
                TermQuery { normal: Vec3::Y, to_light: below, to_viewer: vec3(0.6, 0.8, 0.0), exponent },
                // Here cos φ is positive. Only cos θ shows that the light is below the horizon.
                TermQuery { normal: Vec3::Y, to_light: below, to_viewer: vec3(-0.96, 0.28, 0.0), exponent },
                TermQuery { normal: Vec3::Y, to_light: aside, to_viewer: vec3(0.8, -0.6, 0.0), exponent },
                TermQuery { normal: Vec3::Y, to_light: aside, to_viewer: vec3(0.96, 0.28, 0.0), exponent },
            ]
        })
        .collect();
    for (query, yours) in queries.iter().zip(trial.kit.specular_term(&queries)) {
        if yours != 0.0 {
            let broken = Broken::new(paste_term("specular_term", query), yours, 0.0, "closed form");
            return Err(broken.looks_like(Some(
                "return 0 where cos φ < 0 or the light is behind the surface, for every exponent",
            )));
        }
    }
    Ok(())
}
