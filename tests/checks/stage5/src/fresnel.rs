//! The Fresnel reflectance.

use checks::prelude::*;

/// Cosines from 0 to 1, some close to 1, and indices from 1/2 to 3, some equal.
fn queries() -> impl Strategy<Value = FresnelQuery> + Clone {
    let cosine = prop_oneof![
        6 => fractions(0..=64, 64.0),
        1 => (1..=20i32).prop_map(|halvings| 1.0 - 0.5f32.powi(halvings)),
    ];
    let index = || fractions(4..=24, 8.0);
    let all = (cosine, index(), index(), 0..8i32).prop_map(|(cos_theta, n1, n2, equal)| FresnelQuery {
        cos_theta,
        n1,
        n2: if equal == 0 { n1 } else { n2 },
    });
    all.prop_filter("no 0 / 0", |query| query.cos_theta > 0.0 || query.n1 != query.n2)
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

/// Near the critical angle the reflectance and its rounding error change with the root of the distance to it.
fn tolerance(query: &FresnelQuery) -> f64 {
    1e-5 + 4e-6 / behind(query).1.abs().sqrt().max(1e-3)
}

/// Whether rounding decides on which side of the critical angle the ray is.
fn is_critical(query: &FresnelQuery) -> bool {
    behind(query).1.abs() < 1e-5
}

/// Judges reflectances. `mistakes` are the values that wrong formulas give.
fn judge(
    name: &str,
    queries: &[FresnelQuery],
    answers: Vec<f32>,
    reference: fn(&FresnelQuery) -> f64,
    mistakes: fn(&FresnelQuery) -> Vec<(f64, &'static str)>,
) -> Vec<CheckResult> {
    let near = |query: &FresnelQuery, yours: f32, value: f64| {
        (f64::from(yours) - value).abs() <= tolerance(query) || (is_critical(query) && !value.is_nan())
    };
    let judge = |query: &FresnelQuery, yours: f32| {
        let expected = reference(query);
        let critical = is_critical(query);
        let right = (f64::from(yours) - expected).abs() <= tolerance(query);
        let beyond = behind(query).0.is_none();
        let input = || call(name, &[&query.cos_theta, &query.n1, &query.n2]);
        let broken = || {
            Broken::new(input(), yours, expected as f32, "double precision").explained_by([
                (beyond && yours.is_nan(), "you return NaN: beyond the critical angle the reflectance is 1"),
                (beyond, "beyond the critical angle all light is reflected: the reflectance is 1"),
            ])
        };
        let swapped = reference(&FresnelQuery { n1: query.n2, n2: query.n1, ..*query });
        let known = [
            (swapped, "you exchange n1 and n2"),
            (1.0 - expected, "you return the transmitted fraction: return the reflected one"),
            "you return the transmitted fraction: return the reflected one".when(if beyond {
                1.0
            } else {
                1.0 - expected
            }),
        ];
        let known = known.into_iter().chain(mistakes(query));
        unless(right || (critical && (0.0..=1.0).contains(&yours)), broken)
            .formulas(known.map(|(value, text)| (near(query, yours, value), text)))
    };
    compare(queries, answers, judge)
}

/// What Schlick's formula gives with one mistake.
fn schlick_mistakes(query: &FresnelQuery) -> Vec<(f64, &'static str)> {
    let [cosine, n1, n2] = [query.cos_theta, query.n1, query.n2].map(f64::from);
    let r0 = ((n1 - n2) / (n1 + n2)).powi(2);
    let (beyond, behind) = (behind(query).0.is_none(), behind(query).0.unwrap_or(cosine));
    let (right, wrong) = if n1 > n2 { (behind, cosine) } else { (cosine, behind) };
    let formula = |r0: f64, cosine: f64, power: i32| r0 + (1.0 - r0) * (1.0 - cosine).powi(power);
    // Beyond the critical angle a formula may be asked first or not at all.
    let total = |value: f64| if beyond { 1.0 } else { value };
    named![
        total(formula(r0, behind, 5)) => "you use the cosine of the wrong side: behind the surface, also if n1 < n2",
        total(formula(r0, cosine, 5)) => "you use cos θ1 on both sides: if n1 > n2, use that of the refracted ray",
        total(formula(r0, wrong, 5)) => "you use the cosine of the wrong side: use that in the less dense medium",
        formula(r0, cosine, 5) => "you use cos θ1 on both sides: if n1 > n2, use that of the refracted ray",
        total(formula(r0, right, 4)) => "you take the fourth power: Schlick takes the fifth",
        total(formula(r0, right, 3)) => "you take the third power: Schlick takes the fifth",
        total(formula(r0, right, 6)) => "you take the sixth power: Schlick takes the fifth",
        total(r0 + (1.0 - r0) * (1.0 - right.powi(5))) => "you take 1 - cos⁵ θ: it is (1 - cos θ)⁵",
        total(formula(r0, right, 5).powi(2)) => "you square the reflectance: R0 is a square already",
        total(formula(r0, right, 5).sqrt()) => "you take the root of the reflectance",
        total(formula(r0.sqrt(), right, 5)) => "you do not square R0",
        total(formula((n1 - n2) / (n1 + n2), right, 5)) => "you do not square R0",
        total(formula(((n1.max(n2) - 1.0) / (n1.max(n2) + 1.0)).powi(2), right, 5)) =>
            "you take the other side for air: R0 is ((n1 - n2) / (n1 + n2))²",
        total(formula(((1.0 - n2) / (1.0 + n2)).powi(2), right, 5)) =>
            "you take the side of the ray for air: R0 is ((n1 - n2) / (n1 + n2))²",
        total(r0 + (1.0 - r0) * right.powi(5)) => "you take cos⁵ θ: it is (1 - cos θ)⁵",
        total(r0) => "you return R0 for every angle: the reflectance rises to 1 at grazing angles",
        r0 => "you return R0 for every angle: the reflectance rises to 1 at grazing angles, and is 1 beyond the critical one",
        total((1.0 - right).powi(5)) => "you leave out R0",
        total(r0 + (1.0 - right).powi(5)) => "you leave out the factor 1 - R0",
    ].to_vec()
}

/// What Fresnel's equations give with one mistake.
fn exact_mistakes(query: &FresnelQuery) -> Vec<(f64, &'static str)> {
    let [cos_1, n1, n2] = [query.cos_theta, query.n1, query.n2].map(f64::from);
    let ratio = |p: f64, q: f64| if p + q > 0.0 { (p - q) / (p + q) } else { 1.0 };
    // Beyond the critical angle these formulas are not reached.
    let cos_2 = behind(query).0;
    let of_angle = |cos_2: f64| (ratio(n1 * cos_1, n2 * cos_2), ratio(n1 * cos_2, n2 * cos_1));
    let (s, p) = cos_2.map_or((1.0, 1.0), of_angle);
    let both = |s: f64, p: f64| if cos_2.is_none() { 1.0 } else { s + p };
    // Snell's law without the square of the ratio.
    let bent = 1.0 - n1 / n2 * (1.0 - cos_1 * cos_1);
    let (bent_s, bent_p) = if bent < 0.0 { (1.0, 1.0) } else { of_angle(bent.sqrt()) };
    named![
        s * s => "you return one polarisation, the one perpendicular to the plane: return the mean of both",
        p * p => "you return one polarisation, the one parallel to the plane: return the mean of both",
        both(s * s, p * p) => "you return the sum of both polarisations: return their mean",
        0.5 * (s.abs() + p.abs()) => "you do not square the ratios",
        0.5 * (s + p) => "you do not square the ratios",
        (s * p).abs() => "you return the geometric mean of both polarisations: return half of their sum",
        (0.5 * (s + p)).clamp(0.0, 1.0) => "you do not square the ratios",
        (0.5 * (s.abs() + p.abs())).powi(2) => "you square the mean of the ratios: return the mean of their squares",
        0.5 * (bent_s * bent_s + bent_p * bent_p) =>
            "Snell's law has the square of n1 / n2: sin² θ2 = (n1 / n2)² sin² θ1",
    ].to_vec()
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
    trial.forall_and(&drawn(), 3000, queries(), |queries| {
        judge("fresnel_schlick", queries, trial.kit.fresnel_schlick(queries), schlick, schlick_mistakes)
    })
}

pub(super) fn fresnel_exact_agrees_with_double_precision(trial: &Trial<'_>) -> CheckResult {
    let [first, second, third] = drawn();
    // Closer to the critical angle than any of the other queries: cos² θ2 is 0.00004.
    let near_critical = FresnelQuery { cos_theta: 0.745_368, n1: 1.5, n2: 1.0 };
    trial.forall_and(&[first, second, third, near_critical], 3000, queries(), |queries| {
        judge("fresnel_exact", queries, trial.kit.fresnel_exact(queries), exact, exact_mistakes)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two published values that need no Fresnel formula: at normal incidence ((n1 - n2) / (n1 + n2))², and at Brewster's angle,
    /// tan θ = n2 / n1, half of ((n2² - n1²) / (n2² + n1²))², because only one polarisation is reflected (Born and Wolf, 1.5.3).
    #[test]
    fn exact_has_the_published_values_at_normal_incidence_and_at_brewsters_angle() {
        for (n1, n2) in [(1.0f32, 1.5f32), (1.5, 1.0), (1.0, 2.5), (1.25, 1.5)] {
            let [m1, m2] = [f64::from(n1), f64::from(n2)];
            let normal = ((m1 - m2) / (m1 + m2)).powi(2);
            let brewster = ((m2 * m2 - m1 * m1) / (m2 * m2 + m1 * m1)).powi(2) / 2.0;
            let cosine = (m1 / m1.hypot(m2)) as f32;
            for (cos_theta, expected) in [(1.0, normal), (cosine, brewster)] {
                let found = exact(&FresnelQuery { cos_theta, n1, n2 });
                // The cosine is rounded to single precision, and the slope stays below 4 there.
                assert!(
                    (found - expected).abs() < 4.0 * f64::from(f32::EPSILON),
                    "{n1} {n2}: {found} {expected}"
                );
            }
        }
    }
}
