//! The two methods of intersecting a sphere: how the checks judge their answers, and the diagnosis of a wrong answer.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::double::{self, Expected, Roots};
use checks::judge::{compare, known};
use checks::paste::Arguments;
use raykata::kit::{Kit, SphereQuery};
use raykata::shape::Sphere;

/// One of the two methods of intersecting a sphere.
#[derive(Clone, Copy)]
pub(super) struct SphereFunction {
    pub(super) name: &'static str,
    pub(super) ask: fn(&dyn Kit, &[SphereQuery]) -> Vec<Option<f32>>,
}

pub(super) const ALGEBRAIC: SphereFunction =
    SphereFunction { name: "sphere_algebraic", ask: |kit, queries| kit.sphere_algebraic(queries) };

pub(super) const GEOMETRIC: SphereFunction =
    SphereFunction { name: "sphere_geometric", ask: |kit, queries| kit.sphere_geometric(queries) };

impl SphereFunction {
    /// Compares answers with the result in double precision.
    pub(super) fn judge(self, trial: &Trial<'_>, queries: &[SphereQuery]) -> Vec<CheckResult> {
        compare(queries, (self.ask)(trial.kit, queries), |query, yours| {
            let expected = double::sphere(&query.ray, &query.sphere);
            if expected.accepts(yours) {
                return Ok(());
            }
            let broken = Broken::with_texts(
                query.call(self.name),
                format!("{yours:?}"),
                expected.words(),
                "double precision",
            );
            Err(broken.looks_like(sphere_diagnosis(query, yours, expected)))
        })
    }

    /// Compares answers with results that are known exactly.
    pub(super) fn judge_exact(
        self,
        trial: &Trial<'_>,
        cases: &[(SphereQuery, Option<f32>, &str)],
    ) -> CheckResult {
        let queries: Vec<SphereQuery> = cases.iter().map(|case| case.0).collect();
        for ((query, expected, diagnosis), yours) in cases.iter().zip((self.ask)(trial.kit, &queries)) {
            if yours != *expected {
                let broken = Broken::new(query.call(self.name), yours, expected, "exact arithmetic");
                return Err(broken.looks_like(known(diagnosis)));
            }
        }
        Ok(())
    }
}

/// Whether `t` is a root for a sphere whose radius is the square root of the true radius.
fn takes_radius_for_its_square(query: &SphereQuery, t: f32) -> bool {
    let sphere = Sphere { radius: query.sphere.radius.sqrt(), ..query.sphere };
    double::sphere_roots(&query.ray, &sphere).is_ok_and(|roots| is_one_of(t, roots))
}

fn is_one_of(t: f32, roots: Roots) -> bool {
    [roots.near, roots.far].iter().any(|root| (f64::from(t) - root).abs() <= 1e-5 * root.abs())
}

/// The diagnosis: a known mistake that gives this answer, if there is one.
pub(super) fn sphere_diagnosis(
    query: &SphereQuery,
    yours: Option<f32>,
    expected: Expected,
) -> Option<&'static str> {
    let roots = double::sphere_roots(&query.ray, &query.sphere).ok();
    let length = f64::from(query.ray.direction.length());
    let near = |t: f32, exact: f64, tolerance: f64| {
        (f64::from(t) - exact).abs() <= 4.0 * tolerance + 1e-6 * exact.abs()
    };
    Some(match (yours, expected, roots) {
        (Some(t), _, _) if t.is_nan() => "you return NaN: compare so that NaN fails",
        (Some(t), _, _) if t <= query.ray.t_min => "you return a t at or before t_min: ask ray.contains(t)",
        (Some(t), _, _) if t >= query.ray.t_max => "you return a t at or beyond t_max: ask ray.contains(t)",
        (Some(t), Expected::Hit { t: exact, .. }, Some(roots))
            if exact < roots.far && near(t, roots.far, roots.tolerance) =>
        {
            "you return the far root"
        }
        (Some(t), Expected::Hit { t: exact, .. }, Some(roots))
            if (length - 1.0).abs() > 1e-3 && near(t, exact * length, roots.tolerance) =>
        {
            "your t counts world units; it must count lengths of direction (which is no unit vector here)"
        }
        (Some(t), _, Some(roots))
            if near(t, -roots.near, roots.tolerance) || near(t, -roots.far, roots.tolerance) =>
        {
            "the sign of t is wrong: you return the negative of a root"
        }
        (Some(t), _, _) if takes_radius_for_its_square(query, t) => "r stands where r² belongs",
        (Some(t), _, Some(roots)) if near(t, 0.5 * (roots.near + roots.far), roots.tolerance) => {
            "you return the t of the point nearest to the centre: half the chord is missing"
        }
        (None, Expected::Hit { .. }, Some(roots)) if roots.near < 0.0 => {
            "the ray starts inside: the near root is behind it, and the far one counts (t_ca < 0 is not a miss)"
        }
        (_, Expected::Hit { .. }, _)
            if f64::from((query.ray.origin - query.sphere.center).length())
                > 100.0 * f64::from(query.sphere.radius) =>
        {
            "the sphere is small and far away: b² - a c (or L·L - t_ca²) cancels; use r² - |f⊥|²"
        }
        (Some(_), Expected::Hit { .. }, Some(_)) if (length - 1.0).abs() > 1e-3 => {
            "direction is not a unit vector here: did you leave out a = d·d?"
        }
        (None, Expected::Hit { .. }, _) => {
            "you return None for a ray that hits: is -r² left out, or the sign of b (or t_ca) wrong?"
        }
        (Some(_), Expected::Miss, _) => "you return a hit, but the ray misses the sphere",
        _ => return None,
    })
}
