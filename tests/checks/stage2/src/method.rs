//! The three methods of intersecting a triangle, and how the checks judge their answers.

use crate::triangle_mistakes::mistakes;
use checks::Trial;
use checks::broken::{Broken, CheckResult, all_hold};
use checks::double;
use checks::judge::compare;
use checks::paste::Arguments;
use glam::Vec3;
use proptest::prelude::*;
use raykata::kit::{Kit, TriangleHit, TriangleQuery};
use raykata::ray::Ray;
use raykata::shape::Triangle;

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

impl TriangleFunction {
    /// Compares answers with the result in double precision.
    pub(super) fn judge(self, trial: &Trial<'_>, queries: &[TriangleQuery]) -> Vec<CheckResult> {
        let answers = (self.ask)(trial.kit, queries);
        let is_constant = queries.len() > 1 && answers.iter().all(Option::is_none);
        let accepts =
            |query: &TriangleQuery, yours| double::triangle(&query.ray, &query.triangle).accepts(yours);
        let loses_only =
            queries.iter().zip(&answers).all(|(query, yours)| yours.is_none() || accepts(query, *yours));
        compare(queries, answers, |query, yours| {
            let expected = double::triangle(&query.ray, &query.triangle);
            if expected.accepts(yours) {
                return Ok(());
            }
            let broken = Broken::with_texts(
                query.call(self.name),
                describe(yours),
                expected.words(),
                "double precision",
            );
            // Many mistakes give None to many queries, but none gives it to all.
            Err(broken.explained_by(if is_constant {
                Vec::new()
            } else {
                mistakes(query, yours, loses_only)
            }))
        })
    }

    /// Compares answers with results that are known exactly.
    pub(super) fn judge_exact(
        self,
        trial: &Trial<'_>,
        cases: &[(TriangleQuery, Option<TriangleHit>)],
    ) -> CheckResult {
        let queries: Vec<TriangleQuery> = cases.iter().map(|case| case.0).collect();
        let answers = (self.ask)(trial.kit, &queries);
        all_hold(compare(cases, answers, |(query, expected), yours| {
            if yours == *expected {
                return Ok(());
            }
            let (yours_in_words, expected) = (describe(yours), describe(*expected));
            let broken =
                Broken::with_texts(query.call(self.name), yours_in_words, expected, "exact arithmetic");
            Err(broken.explained_by(mistakes(query, yours, false)))
        }))
    }
}

pub(super) fn describe(hit: Option<TriangleHit>) -> String {
    hit.map_or("None".into(), |hit| {
        format!("t = {:?}, beta = {:?}, gamma = {:?}", hit.t, hit.beta, hit.gamma)
    })
}

/// Rays that are aimed at a point `(β, γ)` in the plane of a triangle, inside or outside of it.
pub(super) fn aimed(
    triangles: impl Strategy<Value = Triangle> + Clone,
    origins: impl Strategy<Value = Vec3> + Clone,
) -> impl Strategy<Value = TriangleQuery> + Clone {
    (triangles, origins, -4..=12i32, -4..=12i32, 1..=16i32).prop_map(
        |(triangle, origin, beta, gamma, length)| {
            let (beta, gamma) = (beta as f32 / 8.0, gamma as f32 / 8.0);
            let target = triangle.a + beta * (triangle.b - triangle.a) + gamma * (triangle.c - triangle.a);
            let to_target = target - origin;
            let direction = if to_target == Vec3::ZERO { Vec3::X } else { to_target.normalize() };
            TriangleQuery { ray: Ray::new(origin, length as f32 / 4.0 * direction), triangle }
        },
    )
}
