//! The two methods of intersecting a sphere, and how the checks judge their answers.

use crate::sphere_mistakes::{mistakes, observations};
use checks::double::{self, Expected, compare_tolerant};
use checks::prelude::*;

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

/// The rounding errors that a check accepts.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Accepts {
    /// Those of the formula on the slide in single precision, `b² - a c`, which cancels.
    TheFormula,
    /// A few roundings of the input, which a formula without cancellation keeps.
    FewRoundings,
}

impl Accepts {
    pub(super) fn expected(self, query: &SphereQuery) -> Expected {
        match self {
            Accepts::TheFormula => Quadratic::of(query).expected(query),
            Accepts::FewRoundings => double::sphere(&query.ray, &query.sphere),
        }
    }
}

impl SphereFunction {
    /// Compares answers with the result in double precision.
    pub(super) fn judge(
        self,
        trial: &Trial<'_>,
        queries: &[SphereQuery],
        accepts: Accepts,
    ) -> Vec<CheckResult> {
        let cases: Vec<_> = queries.iter().map(|query| (*query, accepts.expected(query))).collect();
        self.compare(trial, &cases, accepts, "double precision")
    }

    /// Compares answers with results that are known exactly.
    pub(super) fn judge_exact(self, trial: &Trial<'_>, cases: &[(SphereQuery, Option<f32>)]) -> CheckResult {
        let cases: Vec<_> = cases.iter().map(|(query, t)| (*query, Expected::exactly(*t))).collect();
        all_hold(self.compare(trial, &cases, Accepts::TheFormula, "exact arithmetic"))
    }

    fn compare(
        self,
        trial: &Trial<'_>,
        cases: &[(SphereQuery, Expected)],
        accepts: Accepts,
        source: &'static str,
    ) -> Vec<CheckResult> {
        let ask = |queries: &[SphereQuery]| (self.ask)(trial.kit, queries);
        let formulas = |query: &SphereQuery, yours, _| mistakes(query, yours, accepts);
        compare_tolerant(cases, (self.name, source), ask, observations, formulas)
    }
}

/// The quadratic `a t² - 2 b t + c = 0` of a ray and a sphere.
#[derive(Clone, Copy)]
pub(super) struct Quadratic {
    pub(super) a: f64,
    pub(super) b: f64,
    /// `b² - a c`.
    pub(super) discriminant: f64,
    /// The largest error of the discriminant in single precision: sixteen roundings of its largest terms.
    pub(super) slack: f64,
}

impl Quadratic {
    pub(super) fn of(query: &SphereQuery) -> Self {
        Quadratic::with_radius(query, f64::from(query.sphere.radius))
    }

    /// The same, with the errors of a formula that does not cancel.
    pub(super) fn stable(query: &SphereQuery) -> Self {
        let quadratic = Quadratic::of(query);
        let distance = query.ray.origin.as_dvec3().distance(query.sphere.center.as_dvec3());
        let radius = f64::from(query.sphere.radius);
        // Sixteen roundings of the distance, which change r² - |f⊥|² near the rim by 2 r times as much.
        let slack = 16.0 * U * (distance + radius);
        Quadratic { slack: quadratic.a * (2.0 * radius + slack) * slack, ..quadratic }
    }

    pub(super) fn with_radius(query: &SphereQuery, radius: f64) -> Self {
        let d = query.ray.direction.as_dvec3();
        let f = query.ray.origin.as_dvec3() - query.sphere.center.as_dvec3();
        let (a, b, squared) = (d.length_squared(), -f.dot(d), radius * radius);
        let discriminant = b * b - a * (f.length_squared() - squared);
        let slack = 16.0 * U * (b * b + a * (f.length_squared() + squared));
        Quadratic { a, b, discriminant, slack }
    }

    /// The largest error of a root in single precision.
    pub(super) fn tolerance(&self) -> f64 {
        let known = self.discriminant.max(0.0);
        // The root of a discriminant that is too large by the slack, and the roundings of b.
        (2.0 * ((known + self.slack).sqrt() - known.sqrt()) + 16.0 * U * self.b.abs()) / self.a
    }

    /// The answer for the range of the ray; open if single precision cannot decide.
    fn expected(&self, query: &SphereQuery) -> Expected {
        if self.discriminant.abs() <= self.slack {
            return Expected::Open;
        }
        if self.discriminant < 0.0 {
            return Expected::Miss;
        }
        let (root, tolerance) = (self.discriminant.sqrt(), self.tolerance());
        let [near, far] = [(self.b - root) / self.a, (self.b + root) / self.a];
        double::first_in_range(&query.ray, &[near, far], tolerance)
    }
}
