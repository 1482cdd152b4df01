//! Glossy reflection: samples of a Phong lobe.

use super::area_lights::n_angles;
use super::pixels::unit_number;
use crate::unit_arrival;
use checks::prelude::*;
use checks::statistics::{
    Mistakes, SAMPLES, columns, covers_each_part, has_mean, is_of_one_number, is_other_power, pairs,
};

pub(super) fn smooth_surfaces_stay_sharp(trial: &Trial<'_>) -> CheckResult {
    // Every fourth surface is rough, and gives another direction than `ideal`.
    let queries =
        (unit_arrival(), unit_number(), unit_number(), 0..4i32).prop_map(|((ideal, normal), u, v, which)| {
            match which {
                3 => PhongLobeQuery { ideal, normal, roughness: 0.5, u: vec2(0.25, v) },
                _ => PhongLobeQuery { ideal, normal, roughness: 0.0, u: vec2(u, v) },
            }
        });
    trial.each(500, queries, <dyn Kit>::sample_phong_lobe, |query, yours| {
        let rough = query.roughness > 0.0;
        if (yours == query.ideal) != rough {
            return Ok(());
        }
        if rough {
            let expected = "a direction at an angle to ideal";
            return Err(Broken::new(query.call("sample_phong_lobe"), yours, expected, "roughness above 0")
                .because("you return ideal for a rough surface"));
        }
        Err(Broken::new(query.call("sample_phong_lobe"), yours, query.ideal, "roughness 0").explained_by(named![
            yours.is_nan() => "you return NaN: 2 / 0² is infinite",
            (yours - query.ideal).length() < 1e-5 =>
                "you recompute ideal, which adds a rounding error: with roughness 0 return ideal itself",
            !yours.is_nan() => "you change the direction: with roughness 0 return ideal itself",
            !rough => "your result is not ideal, and some results are NaN: with roughness 0 return ideal itself",
        ]))
    })
}

/// Samples of a lobe around the normal, so that none is reflected back.
struct Lobe {
    u: Vec<Vec2>,
    /// Two fractions that must be uniform: `cosⁿ⁺¹ θ`, and the angle around `ideal` as a fraction of a full turn.
    shares: Vec<(f64, f64)>,
    /// The cosines of the angles to `ideal`.
    cosines: Vec<f64>,
}

impl Lobe {
    /// Whether all cosines are those of a wrong formula.
    fn is(&self, cosine: impl Fn(f64) -> f64) -> bool {
        is_of_one_number(&self.u, self.cosines.iter(), |u, found| (found - cosine(u)).abs() < 1e-5)
    }
}

/// Samples lobes in these directions in turn.
fn lobe(trial: &Trial<'_>, roughness: f32, axes: &[Vec3], u: &[Vec2]) -> Result<Lobe, Broken> {
    let query = |(index, u): (usize, &Vec2)| {
        let axis = axes[index % axes.len()];
        PhongLobeQuery { ideal: axis, normal: axis, roughness, u: *u }
    };
    let queries: Vec<PhongLobeQuery> = u.iter().enumerate().map(query).collect();
    let exponent = 2.0 / f64::from(roughness).powi(2) - 2.0;
    let mut lobe = Lobe { u: u.to_vec(), shares: Vec::new(), cosines: Vec::new() };
    let judge = |(query, direction): (&PhongLobeQuery, Vec3)| {
        let (around, ideal) = (direction.as_dvec3(), query.ideal.as_dvec3().normalize());
        if !((around.length() - 1.0).abs() < 1e-5) {
            let broken =
                Broken::new(query.call("sample_phong_lobe"), direction, "a unit direction", "the definition");
            return Err(broken.explained_by([
                (direction.is_nan(), "you return NaN"),
                (!direction.is_nan(), "your direction does not have unit length"),
            ]));
        }
        let (x, y) = ideal.any_orthonormal_pair();
        // cosⁿ⁺¹ θ is uniform in 0..1. Compute ln cos θ from the sine for small angles, and from the cosine for large ones:
        // each is precise there. Behind the plane of the lobe, by more than a rounding, there is no place.
        let (cosine, sine_squared) = (around.dot(ideal), around.cross(ideal).length_squared());
        let ln = if cosine > 0.7 { 0.5 * (-sine_squared).ln_1p() } else { cosine.max(0.0).ln() };
        let share = if cosine < -1e-6 { f64::INFINITY } else { ((exponent + 1.0) * ln).exp() };
        lobe.shares.push((share, around.dot(y).atan2(around.dot(x)) / std::f64::consts::TAU + 0.5));
        lobe.cosines.push(cosine);
        Ok(())
    };
    all_hold(queries.iter().zip(trial.kit.sample_phong_lobe(&queries)).map(judge).collect())?;
    Ok(lobe)
}

const AXES: [&str; 2] = ["cosⁿ⁺¹ θ", "the angle around ideal"];

/// The known mistakes in the distribution of a lobe.
fn mistakes(lobe: &Lobe, roughness: f32) -> Mistakes {
    let r = f64::from(roughness);
    let n = 2.0 / (r * r) - 2.0;
    let power = |exponent: f64| lobe.is(|u| u.powf(exponent));
    // For roughness 1 the exponent is 0, where some mistakes are the same.
    named![
        n > 0.0 && power(1.0 / n) => "your lobe is too wide: you use u^(1 / n); it is u^(1 / (n + 1))",
        power(1.0 / (n + 2.0)) => "your lobe is too narrow: you use u^(1 / (n + 2)); it is u^(1 / (n + 1))",
        power(1.0 / (n + 3.0)) => "your lobe is too narrow: you use n = 2 / roughness²; it is n = 2 / roughness² - 2",
        r < 1.0 && power(1.0 / (2.0 / r - 1.0)) =>
            "your lobe is too wide: you do not square roughness; n = 2 / roughness² - 2",
        power(1.0 / (r + 1.0)) => "you use roughness as n: n = 2 / roughness² - 2",
        is_other_power(&lobe.u, &lobe.cosines, 1.0 / (n + 1.0)) =>
            "your cos θ is another power of a random number: it is u^(1 / (n + 1))",
    ].to_vec()
}

pub(super) fn phong_lobe_falls_with_the_power_of_the_cosine(trial: &Trial<'_>) -> CheckResult {
    let (u, axes) = (pairs(trial.seed, SAMPLES), nasty::directions());
    for roughness in [0.2, 0.5, 1.0] {
        let lobe_of = |u: &[Vec2], axes: &[Vec3]| lobe(trial, roughness, axes, u);
        let lobe = lobe_of(&u, &axes)?;
        let what = format!("sample_phong_lobe with roughness {roughness}");
        let places = |u: &[Vec2]| Ok(lobe_of(u, &axes[axes.len() - 1..])?.shares);
        covers_each_part(&what, AXES, trial.seed, None, places, |counts| {
            let rings = columns(counts);
            let mistakes = mistakes(&lobe, roughness).into_iter();
            let shown = [
                (100 * rings[0] > 105 * rings[7], "your lobe is too wide"),
                (100 * rings[7] > 105 * rings[0], "your lobe is too narrow"),
            ];
            mistakes.chain(shown).collect()
        })?;
    }
    Ok(())
}

pub(super) fn slightly_rough_is_not_a_few_angles(trial: &Trial<'_>) -> CheckResult {
    // n is 2,000,000, so cosines differ from 1 in their last four bits only.
    let (u, axes) = (pairs(trial.seed, SAMPLES), nasty::directions());
    let slight = lobe(trial, 0.001, &axes, &u)?;
    let what = "sample_phong_lobe with roughness 0.001";
    let n_slight = n_angles(&slight.shares);
    // Of a thousand intervals of equal probability a few roundings leave none out.
    if n_slight < 500 {
        let yours = format!("angles in {n_slight} of 1,000 intervals of equal probability");
        let input = format!("{what} for {SAMPLES} pairs u");
        let broken = Broken::with_texts(input, yours, "in all of them", "the definition");
        // The formula gives many angles for a rough surface, and few for a slightly rough one.
        let few =
            n_slight < 64 && lobe(trial, 0.5, &axes, &u).is_ok_and(|rough| n_angles(&rough.shares) > 500);
        let imprecise =
            "your angles take few values: √(1 - cos²) is imprecise; compute 1 - cos θ with exp_m1";
        return Err(broken.explained_by([(few, imprecise)]));
    }
    let shares: Vec<f64> = slight.shares.iter().map(|(share, _)| *share).collect();
    has_mean(&format!("{what}, {}", AXES[0]), &shares, 0.5, |_| Vec::new())
}

pub(super) fn phong_lobe_stays_on_its_side(trial: &Trial<'_>) -> CheckResult {
    // Begin with rays along the surface, of which about half go through it before they are reflected back.
    let grazing = |u: Vec2| PhongLobeQuery { ideal: Vec3::X, normal: Vec3::Y, roughness: 1.0, u };
    let chosen: Vec<PhongLobeQuery> = pairs(trial.seed, 64).into_iter().map(grazing).collect();
    let free = |queries: &[PhongLobeQuery]| -> Vec<PhongLobeQuery> {
        queries.iter().map(|query| PhongLobeQuery { normal: query.ideal, ..*query }).collect()
    };
    let through = trial.kit.sample_phong_lobe(&free(&chosen));
    if !through.iter().any(|direction| direction.y < -0.1) {
        let input = "sample_phong_lobe with roughness 1 and normal = ideal = Vec3::X, for 64 pairs u";
        let yours = "no direction with y < -0.1";
        return Err(Broken::with_texts(input, yours, "about a half", "the definition"));
    }
    let queries = (unit_arrival(), fractions(1..=16, 16.0), unit_number(), unit_number()).prop_map(
        |((ideal, normal), roughness, u, v)| PhongLobeQuery { ideal, normal, roughness, u: vec2(u, v) },
    );
    trial.forall_and(&chosen, 3000, queries, |queries| {
        // The same samples with the normal `ideal` give the directions before they are reflected back.
        let drawn = trial.kit.sample_phong_lobe(&free(queries));
        let pairs: Vec<(PhongLobeQuery, Vec3)> = queries.iter().copied().zip(drawn).collect();
        compare(&pairs, trial.kit.sample_phong_lobe(queries), |(query, drawn), yours| {
            let above = drawn.dot(query.normal);
            let expected = if above < 0.0 { *drawn - 2.0 * above * query.normal } else { *drawn };
            let near = |v: Vec3| (yours - v).length() < 1e-5;
            // The tolerance covers a few roundings. A ray parallel to the surface may be one rounding below it.
            if near(expected) && yours.dot(query.normal) > -1e-5 {
                return Ok(());
            }
            let source = "reflected back to the side of the normal";
            // Rounding may put a ray along the surface on either side.
            let through = above < 1e-6;
            // A student who reflects every ray has reflected the free sample along ideal.
            let unreflected = *drawn - 2.0 * drawn.dot(query.ideal) * query.ideal;
            // A student who returns ideal in place of a direction below the surface has replaced free samples that rounding
            // puts below it, too. They are at a right angle to ideal.
            let replaced = *drawn == query.ideal && yours.dot(query.ideal).abs() < 1e-5;
            let mirrored = unreflected - 2.0 * unreflected.dot(query.normal) * query.normal;
            Err(Broken::new(query.call("sample_phong_lobe"), yours, expected, source).explained_by(named![
                yours.is_nan() => "you return NaN: ln 0 is -∞, and 0 · ∞ is NaN",
                through && near(-*drawn) => "you reverse the whole direction: reverse only its part along the normal",
                through && near((*drawn - above * query.normal).normalize_or_zero()) =>
                    "you subtract the part along the normal once: subtract it twice",
                (through && near(query.ideal)) || replaced =>
                    "you return ideal, which changes the distribution: reflect the ray back by the normal",
                through && near(*drawn) => "your ray goes through the surface: reflect it back by the normal",
                !through && near(*drawn - 2.0 * above * query.normal) =>
                    "you reflect rays that are on the right side: reflect only those below the surface",
                near(mirrored) => "you reflect every ray: reflect only those below the surface",
                yours.dot(query.normal) < 0.0 => "your ray goes through the surface: reflect it back by the normal",
            ]))
        })
    })
}
