//! The three methods of intersecting a triangle, and how the checks judge their answers.

use crate::gram::own_scalars_are_right;
use crate::triangle_mistakes::{mistakes, observations};
use checks::double::{self, TriangleExpected, compare_tolerant};
use checks::prelude::*;
use std::cell::LazyCell;

/// One of the three methods of intersecting a triangle.
#[derive(Clone, Copy)]
pub(super) struct TriangleFunction {
    pub(super) name: &'static str,
    pub(super) ask: fn(&dyn Kit, &[TriangleQuery]) -> Vec<Option<TriangleHit>>,
}

pub(super) const CRAMER: TriangleFunction =
    TriangleFunction { name: "triangle_cramer", ask: |kit, queries| kit.triangle_cramer(queries) };

pub(super) const GRAM: TriangleFunction =
    TriangleFunction { name: "triangle_gram", ask: |kit, queries| kit.triangle_gram(queries) };

pub(super) const CHOICE: TriangleFunction =
    TriangleFunction { name: "triangle_choice", ask: |kit, queries| kit.triangle_choice(queries) };

type Case = (TriangleQuery, TriangleExpected);

impl TriangleFunction {
    /// Compares answers with the result in double precision.
    pub(super) fn judge(self, trial: &Trial<'_>, queries: &[TriangleQuery]) -> Vec<CheckResult> {
        let case = |query: &TriangleQuery| (*query, double::triangle(&query.ray, &query.triangle));
        self.compare(trial, &queries.iter().map(case).collect::<Vec<_>>(), "double precision")
    }

    /// Compares answers with results that are known exactly.
    pub(super) fn judge_exact(
        self,
        trial: &Trial<'_>,
        cases: &[(TriangleQuery, Option<TriangleHit>)],
    ) -> CheckResult {
        let case = |(query, hit): &(TriangleQuery, _)| (*query, TriangleExpected::exactly(*hit));
        all_hold(self.compare(trial, &cases.iter().map(case).collect::<Vec<_>>(), "exact arithmetic"))
    }

    fn compare(self, trial: &Trial<'_>, cases: &[Case], source: &'static str) -> Vec<CheckResult> {
        // With wrong scalars of a triangle no answer proves a mistake in the intersection. They are asked for after a wrong answer
        // only.
        let proves = LazyCell::new(|| {
            let triangles: Vec<Triangle> = cases.iter().map(|(query, _)| query.triangle).collect();
            self.name != "triangle_gram" || own_scalars_are_right(trial, &triangles)
        });
        let observed =
            |query: &TriangleQuery, yours| observations(query, yours).map(|(is, text)| (is && *proves, text));
        let computed = |query: &TriangleQuery, yours, is_right| {
            let refuted = |(gives, text)| (gives && (is_right || *proves), text);
            mistakes(query, yours, is_right).into_iter().map(refuted).collect()
        };
        let ask = |queries: &[TriangleQuery]| (self.ask)(trial.kit, queries);
        compare_tolerant(cases, (self.name, source), ask, observed, computed)
    }
}

/// Rays that are aimed at a point `(β, γ)` in the plane of a triangle, inside or outside of it.
pub(super) fn aimed(
    triangles: impl Strategy<Value = Triangle> + Clone,
    origins: impl Strategy<Value = Vec3> + Clone,
) -> impl Strategy<Value = TriangleQuery> + Clone {
    let weight = || fractions(-4..=12, 8.0);
    (triangles, origins, weight(), weight(), fractions(1..=16, 4.0)).prop_map(
        |(triangle, origin, beta, gamma, length)| {
            let target = triangle.a + beta * (triangle.b - triangle.a) + gamma * (triangle.c - triangle.a);
            let to_target = target - origin;
            let direction = if to_target == Vec3::ZERO { Vec3::X } else { to_target.normalize() };
            TriangleQuery { ray: Ray::new(origin, length * direction), triangle }
        },
    )
}
