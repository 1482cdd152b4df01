//! The three methods of intersecting a triangle: how the checks judge their answers, and the diagnosis of a wrong one.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::double::{self, Expected};
use checks::judge::{compare, known};
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
        compare(queries, (self.ask)(trial.kit, queries), |query, yours| {
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
            Err(broken.looks_like(triangle_diagnosis(self.name, query, yours, &expected)))
        })
    }

    /// Compares answers with results that are known exactly.
    pub(super) fn judge_exact(
        self,
        trial: &Trial<'_>,
        cases: &[(TriangleQuery, Option<TriangleHit>, &str)],
    ) -> CheckResult {
        let queries: Vec<TriangleQuery> = cases.iter().map(|case| case.0).collect();
        for ((query, expected, diagnosis), yours) in cases.iter().zip((self.ask)(trial.kit, &queries)) {
            if yours != *expected {
                let broken = Broken::with_texts(
                    query.call(self.name),
                    describe(yours),
                    describe(*expected),
                    "exact arithmetic",
                );
                return Err(broken.looks_like(known(diagnosis)));
            }
        }
        Ok(())
    }
}

pub(super) fn describe(hit: Option<TriangleHit>) -> String {
    hit.map_or("None".into(), |hit| {
        format!("t = {:?}, beta = {:?}, gamma = {:?}", hit.t, hit.beta, hit.gamma)
    })
}

pub(super) fn triangle_diagnosis(
    method: &str,
    query: &TriangleQuery,
    yours: Option<TriangleHit>,
    expected: &double::TriangleExpected,
) -> Option<&'static str> {
    let near = |value: f32, exact: f64| (f64::from(value) - exact).abs() <= 2.0 * expected.tolerance;
    let (beta, gamma) = (expected.beta, expected.gamma);
    let alpha = 1.0 - beta - gamma;
    Some(match (yours, expected.t) {
        (Some(hit), _) if hit.t.is_nan() || hit.beta.is_nan() => "you return NaN: compare so that NaN fails",
        (Some(hit), _) if hit.t <= query.ray.t_min => {
            "you return a t at or before t_min: ask ray.contains(t)"
        }
        (Some(hit), _) if hit.t >= query.ray.t_max => {
            "you return a t at or beyond t_max: ask ray.contains(t)"
        }
        (Some(_), Expected::Miss) if beta < 0.0 || gamma < 0.0 => {
            "you accept a β or γ below 0: 0 ≤ β + γ ≤ 1 is not enough, test β ≥ 0 and γ ≥ 0 as well"
        }
        (Some(_), Expected::Miss) if alpha < 0.0 => {
            "you accept a point beyond the side b c: β + γ ≤ 1 is not tested"
        }
        _ if method == CRAMER.name && slide_determinant_explains(query, yours, expected) => {
            "you use the determinant as the slide prints it; it must be a(fk - gj) + b(gi - ek) + c(ej - fi)"
        }
        (Some(hit), _) if !near(hit.beta, beta) && near(hit.beta, gamma) && near(hit.gamma, beta) => {
            "β and γ look swapped"
        }
        (Some(hit), _)
            if !near(hit.beta, beta) && near(hit.beta, alpha)
                || !near(hit.gamma, gamma) && near(hit.gamma, alpha) =>
        {
            "you return α, a weight of corner a: β belongs to b and γ to c"
        }
        (Some(hit), Expected::Hit { t, .. }) if f64::from(hit.t) * t < 0.0 => "the sign of t is wrong",
        (Some(hit), Expected::Hit { t, .. })
            if (f64::from(hit.t) - t * f64::from(query.ray.direction.length())).abs() <= 1e-3 * t.abs() =>
        {
            "your t counts world units; it must count lengths of direction"
        }
        (None, Expected::Hit { .. }) => {
            "you return None for a hit: is the triangle tested from one side only, or a - o turned around?"
        }
        _ => return None,
    })
}

/// Whether the determinant that the slide prints explains this answer: it differs clearly from the right one, and the
/// answer follows from it.
fn slide_determinant_explains(
    query: &TriangleQuery,
    yours: Option<TriangleHit>,
    expected: &double::TriangleExpected,
) -> bool {
    let [x, y, z] =
        [query.triangle.a - query.triangle.b, query.triangle.a - query.triangle.c, query.ray.direction];
    let s = query.triangle.a - query.ray.origin;
    let slide = x.x * (y.y * z.z - z.y * y.z) + y.x * (z.y * s.z - s.y * z.z) + z.x * (s.y * y.z - y.y * s.z);
    let right = x.dot(y.cross(z));
    let Expected::Hit { t, .. } = expected.t else { return false };
    if (slide - right).abs() <= 1e-3 * right.abs() {
        return false;
    }
    // The numerators are right, so the same factor is wrong in all three results.
    let factor = f64::from(right) / f64::from(slide);
    let [t, beta, gamma] = [t, expected.beta, expected.gamma].map(|value| factor * value);
    match yours {
        Some(hit) => t.is_finite() && (f64::from(hit.t) - t).abs() <= 1e-3 * t.abs(),
        None => {
            !t.is_finite() || !query.ray.contains(t as f32) || beta < 0.0 || gamma < 0.0 || beta + gamma > 1.0
        }
    }
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
