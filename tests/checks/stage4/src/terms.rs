//! The diffuse and the specular term.

use checks::prelude::*;
use std::f64::consts::PI;

/// Normals, lights and viewers in all directions. Half of the viewers are near the reflected light, so that there are
/// highlights to judge.
pub(super) fn terms() -> impl Strategy<Value = TermQuery> + Clone {
    (nasty::unit(), nasty::unit(), nasty::unit(), fractions(1..=64, 2.0), any::<bool>()).prop_map(
        |(normal, to_light, to_viewer, exponent, aim)| {
            let mirrored = 2.0 * normal.dot(to_light) * normal - to_light;
            let to_viewer = if aim { (mirrored + 0.3 * to_viewer).normalize() } else { to_viewer };
            TermQuery { normal, to_light, to_viewer, exponent }
        },
    )
}

pub(super) fn paste_term(name: &str, query: &TermQuery) -> String {
    match name {
        "diffuse_term" => call(name, &[&query.normal, &query.to_light]),
        _ => call(name, &[&query.normal, &query.to_light, &query.to_viewer, &query.exponent]),
    }
}

const HALF: &str = "you move the cosine to 0..=1 (half Lambert): a light behind the surface gives 0, and cos θ is not scaled";

pub(super) fn diffuse_term_is_the_cosine(trial: &Trial<'_>) -> CheckResult {
    // The tolerance covers three products and two sums of numbers up to 1.
    let near = |yours: f32, value: f64| (f64::from(yours) - value).abs() < 1e-6;
    let judge = |query: &TermQuery, yours: f32| {
        let cosine = cos_theta(query);
        let expected = cosine.max(0.0);
        let broken = || Broken::new(paste_term("diffuse_term", query), yours, expected as f32, "closed form");
        unless(near(yours, expected), broken).formulas(named![
            near(yours, cosine) => "you return a negative cosine for a light behind the surface: return at least 0",
            near(yours, cosine.abs()) => "you return the absolute value: a light behind the surface gives 0",
            yours == 1.0 || near(yours, 0.0) && cosine <= 0.0 => "you return 1: the cosine is missing",
            near(yours, (-cosine).max(0.0)) =>
                "you return 0 for a light in front of the surface, and a cosine for one behind: is a direction negated?",
            yours == 0.0 => "you return 0 for a light in front of the surface",
            near(yours, expected.powi(2)) => "you square the cosine: the diffuse term is the cosine itself",
            near(yours, expected.powi(3)) => "you cube the cosine: the diffuse term is the cosine itself",
            near(yours, expected.sqrt()) => "you take the root of the cosine: the diffuse term is the cosine itself",
            near(yours, expected / PI) => "you divide by π: the diffuse term of the Phong model is the cosine alone",
            near(yours, 0.5 + 0.5 * cosine) => HALF,
            near(yours, (0.5 + 0.5 * cosine).powi(2)) => HALF,
            near(yours, (1.0 - expected.powi(2)).sqrt()) => "you return the sine: the diffuse term is the cosine",
        ])
    };
    let judge = |queries: &[TermQuery]| compare(queries, trial.kit.diffuse_term(queries), judge);
    trial.forall(2000, terms(), judge)
}

/// The cosine of the angle between the normal and the light, in double precision.
pub(super) fn cos_theta(query: &TermQuery) -> f64 {
    query.normal.as_dvec3().dot(query.to_light.as_dvec3())
}

/// The cosine of the angle between the reflected light and the viewer, in double precision.
pub(super) fn cos_phi(query: &TermQuery) -> f64 {
    let [n, l, v] = [query.normal, query.to_light, query.to_viewer].map(Vec3::as_dvec3);
    (2.0 * n.dot(l) * n - l).dot(v)
}

/// `cosⁿ φ` in double precision.
pub(super) fn specular(query: &TermQuery) -> f64 {
    let cos_phi = cos_phi(query);
    if cos_theta(query) > 0.0 && cos_phi > 0.0 { cos_phi.powf(f64::from(query.exponent)) } else { 0.0 }
}

/// Cosines closer to 0 than this may have either sign in single precision. Both answers pass there.
const EDGE: f64 = 1e-5;

/// A highlight for which every known mistake gives a different number.
const DRAWN: TermQuery = TermQuery {
    normal: Vec3::Y,
    to_light: vec3(0.6, 0.8, 0.0),
    to_viewer: vec3(-0.28, 0.96, 0.0),
    exponent: 2.0,
};

pub(super) fn specular_term_is_the_mirrored_cosine(trial: &Trial<'_>) -> CheckResult {
    // Another check asks about negative cosines: turn the light and the viewer to the sides where both are positive.
    let highlights = terms().prop_map(|query| {
        let side = |v: Vec3, cosine: f64| if cosine < 0.0 { -v } else { v };
        let query = TermQuery { to_light: side(query.to_light, cos_theta(&query)), ..query };
        TermQuery { to_viewer: side(query.to_viewer, cos_phi(&query)), ..query }
    });
    trial.each_and(&[DRAWN], 2000, highlights, <dyn Kit>::specular_term, judge_highlight)
}

/// Whether rounding decides on the sign of a cosine. Both answers pass there.
fn is_on_edge(query: &TermQuery) -> bool {
    cos_theta(query).abs() <= EDGE || cos_phi(query).abs() <= EDGE
}

pub(super) const WHOLE: &str = "the exponent is rounded to a whole number: it may be any, so use `powf`";
const SCALED: &str =
    "you scale the highlight by its exponent, as a normalized lobe is: the specular term is cosⁿ φ alone";
const BLINN: &str = "you use the half vector (Blinn-Phong): the lecture reflects the light (Phong)";

fn judge_highlight(query: &TermQuery, yours: f32) -> Judged {
    let exponent = f64::from(query.exponent);
    let (cos_phi, expected) = (cos_phi(query), specular(query));
    // The cosine is off by a few roundings. The power multiplies this by n cosⁿ⁻¹ φ, which exceeds n for n < 1.
    let steep = exponent * cos_phi.powf(exponent - 1.0).max(1.0);
    let right = is_on_edge(query) || (f64::from(yours) - expected).abs() < 1e-6 * (1.0 + steep);
    let [n, l, v] = [query.normal, query.to_light, query.to_viewer].map(Vec3::as_dvec3);
    let near = |value: f64| (f64::from(yours) - value).abs() < 1e-5 * (1.0 + exponent) || is_on_edge(query);
    let power = |cosine: f64| cosine.max(0.0).powf(exponent);
    let half = (l + v).normalize().dot(n);
    let broken = || Broken::new(paste_term("specular_term", query), yours, expected as f32, "closed form");
    let raised = |exponent: f64| near(cos_phi.max(0.0).powf(exponent));
    // The angle of a cosine near 1 has half of its digits.
    let by_angle = |of_zero: f64| {
        let value = power(1.0 - cos_phi.clamp(-1.0, 1.0).acos() / of_zero);
        (f64::from(yours) - value).abs() < 5e-4 * (1.0 + exponent) || is_on_edge(query)
    };
    let n_plus = |n: f64, d: f64| near((exponent + n) / d * expected);
    unless(right, broken).formulas(named![
        raised(exponent.floor()) => WHOLE,
        raised(exponent.round()) => WHOLE,
        raised(exponent.ceil()) => WHOLE,
        raised(0.5 * exponent) => "you halve the exponent: the specular term is cosⁿ φ",
        raised(2.0 * exponent) => "you double the exponent: the specular term is cosⁿ φ",
        raised(exponent + 1.0) => "the exponent is one too large: the specular term is cosⁿ φ",
        raised(exponent - 1.0) => "the exponent is one too small: the specular term is cosⁿ φ",
        n_plus(1.0, 1.0) => SCALED,
        n_plus(2.0, 1.0) => SCALED,
        n_plus(1.0, 2.0) => SCALED,
        n_plus(2.0, 2.0) => SCALED,
        n_plus(1.0, 2.0 * PI) => SCALED,
        n_plus(2.0, 2.0 * PI) => SCALED,
        n_plus(8.0, 8.0 * PI) => SCALED,
        by_angle(1.0) => "you raise one minus the angle: raise the cosine of the angle",
        by_angle(0.5 * PI) => "you raise one minus the angle: raise the cosine of the angle",
        near(exponent * cos_phi) => "you multiply by the exponent: the cosine is raised to it",
        near(power(half)) => BLINN,
        near(half.powf(exponent)) || !(half >= 1e-2) => BLINN,
        near(power(n.dot(l))) => "you use θ: φ is the angle between the reflected light and the viewer",
        near(cos_phi) => "you leave out the exponent",
        near(power((n.dot(l) * n - l).dot(v))) => "you leave out the factor 2 of 2 (n·l) n - l",
        near(expected * n.dot(l)) => "you multiply by cos θ: the specular term is cosⁿ φ alone",
        near(power(-cos_phi)) => "you return 0 where there is a highlight: the reflected light is 2 (n·l) n - l",
    ])
}

pub(super) fn light_from_behind_adds_nothing(trial: &Trial<'_>) -> CheckResult {
    // A negative cos φ to an even power is positive, to a fractional power NaN. Some lights are below the horizon, and
    // some of these have a positive cos φ: only cos θ shows where they are.
    let below = vec3(0.6, -0.8, 0.0);
    let chosen = [
        TermQuery { to_viewer: vec3(0.8, -0.6, 0.0), ..DRAWN },
        TermQuery { to_light: below, to_viewer: vec3(-0.96, 0.28, 0.0), ..DRAWN },
        DRAWN,
    ];
    trial.each_and(&chosen, 2000, terms(), <dyn Kit>::specular_term, judge_sign)
}

/// The result is 0 where a cosine is negative, and is not 0 at a clear highlight.
fn judge_sign(query: &TermQuery, yours: f32) -> CheckResult {
    let (cos_theta, cos_phi) = (cos_theta(query), cos_phi(query));
    let highlight = cos_theta > 0.0 && cos_phi > 0.0;
    // A small cosine to a large power is 0 in single precision.
    if is_on_edge(query) {
        return Ok(());
    }
    if if highlight { yours != 0.0 || specular(query) < 1e-6 } else { yours == 0.0 } {
        return Ok(());
    }
    let input = paste_term("specular_term", query);
    if highlight {
        return Err(Broken::new(input, yours, specular(query) as f32, "closed form"));
    }
    let power = cos_phi.powf(f64::from(query.exponent));
    let is = |value: f64| (f64::from(yours) - value).abs() < 1e-4 || (yours.is_nan() && value.is_nan());
    Err(Broken::new(input, yours, 0.0, "closed form").explained_by([
        "you return a highlight for a light behind the surface: return 0 if n·l is negative"
            .when(cos_phi > 0.0 && is(power)),
        "you raise a negative cos φ to the exponent, which gives a positive number or NaN: return 0 first"
            .when(cos_theta > 0.0 && is(power)),
        (is(power), "you raise cos φ to the exponent for any light: return 0 if n·l or cos φ is negative"),
    ]))
}
