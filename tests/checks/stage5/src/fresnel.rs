//! The Fresnel reflectance.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::judge::{compare, known};
use checks::paste::call;
use proptest::prelude::*;
use raykata::kit::FresnelQuery;

fn queries() -> impl Strategy<Value = FresnelQuery> + Clone {
    (0..=64i32, 8..=24i32, 8..=24i32).prop_map(|(cosine, n1, n2)| FresnelQuery {
        cos_theta: cosine as f32 / 64.0,
        n1: n1 as f32 / 8.0,
        n2: n2 as f32 / 8.0,
    })
}

/// `cos θ2`, `None` beyond the critical angle; and cos² θ2, which is 0 at the critical angle.
fn behind(query: &FresnelQuery) -> (Option<f64>, f64) {
    let [cosine, n1, n2] = [query.cos_theta, query.n1, query.n2].map(f64::from);
    let squared = 1.0 - (n1 / n2).powi(2) * (1.0 - cosine * cosine);
    ((squared >= 0.0).then(|| squared.sqrt()), squared)
}

/// Schlick's formula in double precision.
pub(super) fn schlick(query: &FresnelQuery) -> f64 {
    let [cosine, n1, n2] = [query.cos_theta, query.n1, query.n2].map(f64::from);
    let r0 = ((n1 - n2) / (n1 + n2)).powi(2);
    let cosine = match behind(query).0 {
        _ if n1 <= n2 => cosine,
        Some(cos_2) => cos_2,
        None => return 1.0,
    };
    r0 + (1.0 - r0) * (1.0 - cosine).powi(5)
}

/// Fresnel's equations in double precision.
pub(super) fn exact(query: &FresnelQuery) -> f64 {
    let [cosine, n1, n2] = [query.cos_theta, query.n1, query.n2].map(f64::from);
    let Some(cos_2) = behind(query).0 else { return 1.0 };
    let ratio = |p: f64, q: f64| if p + q > 0.0 { ((p - q) / (p + q)).powi(2) } else { 1.0 };
    0.5 * (ratio(n1 * cosine, n2 * cos_2) + ratio(n1 * cos_2, n2 * cosine))
}

fn judge(
    name: &str,
    queries: &[FresnelQuery],
    answers: Vec<f32>,
    reference: fn(&FresnelQuery) -> f64,
    mistakes: fn(&FresnelQuery) -> Vec<(f64, &'static str)>,
) -> Vec<CheckResult> {
    compare(queries, answers, |query, yours| {
        let expected = reference(query);
        // Near the critical angle the reflectance and its rounding error change with the root of the distance to it.
        let tolerance = 1e-5 + 4e-6 / behind(query).1.abs().sqrt().max(1e-3);
        // Equal indices at cos θ = 0 give 0/0: any value in 0..=1 passes, and NaN fails.
        let nothing = query.n1 == query.n2 && query.cos_theta == 0.0;
        if (nothing && (0.0..=1.0).contains(&yours)) || (f64::from(yours) - expected).abs() <= tolerance {
            return Ok(());
        }
        let swapped = reference(&FresnelQuery { n1: query.n2, n2: query.n1, ..*query });
        let diagnosis = match () {
            () if nothing => "you divide 0 by 0 for equal indices at cos θ = 0: return a value in 0..=1",
            () if yours.is_nan() => "you return NaN: beyond the critical angle the reflectance is 1",
            () if behind(query).0.is_none() => {
                "beyond the critical angle all light is reflected: the reflectance is 1"
            }
            () if (f64::from(yours) - swapped).abs() <= tolerance => {
                "n1 and n2 are exchanged, or the cosine is wrong: use that in the less dense medium"
            }
            () if (f64::from(1.0 - yours) - expected).abs() <= tolerance => {
                "you return the transmitted fraction: return the reflected one"
            }
            () => mistakes(query)
                .into_iter()
                .find(|(share, _)| (f64::from(yours) - share).abs() <= tolerance)
                .map_or("", |(_, diagnosis)| diagnosis),
        };
        let input = call(name, &[&query.cos_theta, &query.n1, &query.n2]);
        Err(Broken::new(input, yours, expected as f32, "double precision").looks_like(known(diagnosis)))
    })
}

/// What Schlick's formula gives with one mistake.
fn schlick_mistakes(query: &FresnelQuery) -> Vec<(f64, &'static str)> {
    let [cosine, n1, n2] = [query.cos_theta, query.n1, query.n2].map(f64::from);
    let r0 = ((n1 - n2) / (n1 + n2)).powi(2);
    let behind = behind(query).0.unwrap_or(cosine);
    let (right, wrong) = if n1 > n2 { (behind, cosine) } else { (cosine, behind) };
    let formula = |r0: f64, cosine: f64, power: i32| r0 + (1.0 - r0) * (1.0 - cosine).powi(power);
    vec![
        (formula(r0, wrong, 5), "you use the cosine of the wrong side: use that in the less dense medium"),
        (formula(r0, right, 4), "you take the fourth power: Schlick takes the fifth"),
        (formula(r0.sqrt(), right, 5), "you do not square R0"),
        (r0, "you return R0 for every angle: the reflectance rises to 1 at grazing angles"),
    ]
}

/// What Fresnel's equations give with one mistake.
fn exact_mistakes(query: &FresnelQuery) -> Vec<(f64, &'static str)> {
    let [cos_1, n1, n2] = [query.cos_theta, query.n1, query.n2].map(f64::from);
    let Some(cos_2) = behind(query).0 else { return Vec::new() };
    let ratio = |p: f64, q: f64| (p - q) / (p + q);
    let (s, p) = (ratio(n1 * cos_1, n2 * cos_2), ratio(n1 * cos_2, n2 * cos_1));
    vec![
        (s * s, "you return one polarisation: return the mean of both"),
        (p * p, "you return one polarisation: return the mean of both"),
        (s * s + p * p, "you return the sum of both polarisations: return their mean"),
        (0.5 * (s.abs() + p.abs()), "you do not square the ratios"),
    ]
}

/// Queries from either side, and beyond the critical angle, for which all known mistakes give different answers.
fn drawn() -> [FresnelQuery; 3] {
    [(0.5, 1.0, 1.5), (0.875, 1.5, 1.0), (0.5, 1.5, 1.0)].map(|(cos_theta, n1, n2)| FresnelQuery {
        cos_theta,
        n1,
        n2,
    })
}

pub(super) fn fresnel_schlick_agrees_with_double_precision(trial: &Trial<'_>) -> CheckResult {
    let judge = |queries: &[FresnelQuery]| {
        judge("fresnel_schlick", queries, trial.kit.fresnel_schlick(queries), schlick, schlick_mistakes)
    };
    judge(&drawn()).into_iter().collect::<CheckResult>()?;
    trial.forall(3000, queries(), judge)
}

pub(super) fn fresnel_exact_agrees_with_double_precision(trial: &Trial<'_>) -> CheckResult {
    let judge = |queries: &[FresnelQuery]| {
        judge("fresnel_exact", queries, trial.kit.fresnel_exact(queries), exact, exact_mistakes)
    };
    judge(&drawn()).into_iter().collect::<CheckResult>()?;
    trial.forall(3000, queries(), judge)
}
