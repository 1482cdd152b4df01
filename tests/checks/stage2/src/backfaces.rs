//! The backfacing test: the side of a triangle from which a ray comes.

use super::meet::UNIT;
use checks::double::LIMITS;
use checks::generate::{scaled, triangle};
use checks::prelude::*;

/// `n·d`, and the largest error of a method in single precision.
fn slope(query: &TriangleQuery) -> (f64, f64) {
    let Triangle { a, b, c } = query.triangle;
    let [a, b, c, d] = [a, b, c, query.ray.direction].map(Vec3::as_dvec3);
    let (u, v) = (b - a, c - a);
    // Each edge is rounded once, each product once, and three sums: less than 16 roundings of the terms.
    let terms = (u.abs().max_element() * v.abs().max_element()) * d.abs().element_sum() * 2.0;
    (u.cross(v).dot(d), 16.0 * U * terms)
}

/// Wrong formulas in the same order for every query, each with whether it gives this answer.
fn formulas(query: &TriangleQuery, yours: bool) -> Vec<(bool, &'static str)> {
    let (exact, error) = slope(query);
    let Triangle { a, b, c } = query.triangle;
    let (o, d) = (query.ray.origin, query.ray.direction);
    // The cosine of the angle between normal and direction, and the side of the plane on which the ray starts.
    let [u, v, wide] = [b - a, c - a, d].map(Vec3::as_dvec3);
    let cosine = u.cross(v).normalize_or_zero().dot(wide.normalize_or_zero());
    let to_plane = u.cross(v).dot(a.as_dvec3() - o.as_dvec3());
    let in_single = (b - a).cross(c - a).dot(d);
    // Where rounding decides, each formula may give each answer.
    let is_open = exact != 0.0 && exact.abs() <= error;
    let gives = |predicted: bool| is_open || yours == predicted;
    let mut all = named![
        gives(exact < 0.0) => "the sign is reversed: n points to the front, so a ray along n comes from behind",
        gives(exact >= 0.0) => "n·d = 0 (edge-on, or no area) does not turn its back: compare with > and not with >=",
        yours == (in_single > 0.0) =>
            "your product n·d underflows or overflows: compute it in double precision, or scale the edges first",
        yours == (to_plane > 0.0) => "you ask on which side of the plane the ray starts; ask to which side it goes",
    ].to_vec();
    let limited = LIMITS.into_iter().flat_map(|limit| [exact > limit, exact > 0.0 && cosine > limit]);
    all.extend(limited.map(|predicted| (gives(predicted), TEXT_OF_LIMITS)));
    all
}

const TEXT_OF_LIMITS: &str =
    "you compare n·d with a limit, but a triangle of any size and at any angle turns its back if n·d > 0";

fn judge(query: &TriangleQuery, yours: bool, source: &'static str) -> CheckResult {
    let (exact, error) = slope(query);
    // Where rounding may decide, both answers are accepted; exact zeros do not turn their back.
    if yours == (exact > 0.0) || (exact != 0.0 && exact.abs() <= error) {
        return Ok(());
    }
    Err(Broken::new(query.call("backfacing"), yours, exact > 0.0, source))
}

fn judge_all(trial: &Trial<'_>, queries: &[TriangleQuery]) -> Vec<CheckResult> {
    let judge = |query: &TriangleQuery, yours| {
        // In drawn inputs an exact zero of double precision may be a rounding error of single precision.
        let (exact, error) = slope(query);
        if exact.abs() <= error {
            Ok(())
        } else {
            judge(query, yours, "the sign of n·d in double precision")
        }
    };
    let formulas = |query: &TriangleQuery, yours: &bool| formulas(query, *yours);
    compare_formulas(queries, trial.kit.backfacing(queries), judge, formulas)
}

/// Triangles and rays of ordinary sizes: at any angle, and almost edge-on.
fn ordinary() -> impl Strategy<Value = TriangleQuery> + Clone {
    let ordinary = (triangle(), point(8), direction()).prop_map(|(triangle, origin, direction)| {
        TriangleQuery { ray: Ray::new(origin, direction), triangle }
    });
    let grazing = (triangle(), point(8), nasty::tilt(), any::<bool>()).prop_map(
        |(triangle, origin, (angle, turn), behind)| {
            let normal = (triangle.b - triangle.a).cross(triangle.c - triangle.a).normalize_or(Vec3::Z);
            let direction = nasty::tilted(if behind { normal } else { -normal }, angle, turn);
            TriangleQuery { ray: Ray::new(origin, direction), triangle }
        },
    );
    prop_oneof![ordinary, grazing]
}

pub(super) fn backfacing_is_the_sign_of_n_dot_d(trial: &Trial<'_>) -> CheckResult {
    let from = |origin: Vec3, direction| TriangleQuery { ray: Ray::new(origin, direction), triangle: UNIT };
    let drawn = [
        from(vec3(0.25, 0.25, 1.0), Vec3::NEG_Z),
        from(vec3(0.25, 0.25, -1.0), Vec3::Z),
        // Rays that point away from the triangle, or that miss it.
        from(vec3(0.25, 0.25, 1.0), Vec3::Z),
        from(vec3(5.0, 5.0, -1.0), vec3(1.0, 0.0, 0.5)),
    ];
    trial.forall_and(&drawn, 3000, ordinary(), |queries| judge_all(trial, queries))
}

pub(super) fn backfacing_is_false_for_what_is_seen_edge_on(trial: &Trial<'_>) -> CheckResult {
    let slanted = Triangle { a: vec3(1.0, 0.0, 0.0), b: vec3(0.0, 2.0, 0.0), c: vec3(0.0, 0.0, 1.0) };
    let line = Triangle { a: Vec3::ZERO, b: Vec3::X, c: 2.0 * Vec3::X };
    let point = Triangle { a: Vec3::ONE, b: Vec3::ONE, c: Vec3::ONE };
    let cases = [
        (UNIT, Vec3::X),
        (UNIT, vec3(-3.0, 2.0, 0.0)),
        (UNIT, vec3(1.0, 0.0, -0.0)),
        // The normal of the slanted triangle is (2, 1, 2).
        (slanted, vec3(1.0, -2.0, 0.0)),
        (slanted, vec3(1.0, 2.0, -2.0)),
        (slanted, vec3(1.0, 2.0, -1.5)),
        (slanted, vec3(1.0, 2.0, -2.5)),
        (line, Vec3::Z),
        (point, Vec3::Z),
        (UNIT, Vec3::Z),
        (UNIT, vec3(1.0, 1.0, 2f32.powi(-14))),
        (UNIT, vec3(1.0, 1.0, -(2f32.powi(-14)))),
    ];
    let queries = cases.map(|(triangle, direction)| TriangleQuery {
        ray: Ray::new(vec3(0.25, 0.25, -1.0), direction),
        triangle,
    });
    let judge = |query: &TriangleQuery, yours| judge(query, yours, "the definition");
    let formulas = |query: &TriangleQuery, yours: &bool| formulas(query, *yours);
    let judged = compare_formulas(&queries, trial.kit.backfacing(&queries), judge, formulas);
    all_hold(judged)
}

pub(super) fn backfacing_has_no_smallest_size(trial: &Trial<'_>) -> CheckResult {
    let inputs =
        (ordinary(), nasty::scale(-66..=60), nasty::scale(-40..=40)).prop_map(|(query, size, length)| {
            let ray = Ray::new(size * query.ray.origin, length * query.ray.direction);
            TriangleQuery { ray, triangle: scaled(query.triangle, size) }
        });
    let sized = |size: f32, direction| TriangleQuery {
        ray: Ray::new(Vec3::ZERO, direction),
        triangle: scaled(UNIT, size),
    };
    let drawn = [1.0, 2f32.powi(-66), 2f32.powi(66)];
    let drawn = drawn.map(|size| [sized(size, Vec3::Z), sized(size, Vec3::NEG_Z)]);
    trial.forall_and(drawn.as_flattened(), 2000, inputs, |queries| judge_all(trial, queries))
}
