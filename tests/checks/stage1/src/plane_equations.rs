//! Ray-plane intersection with the plane as the equation A x + B y + C z + D = 0.

use crate::planes::{along_planes, at_far_planes, at_planes, observations, of_tests};
use checks::double::{self, Expected, Sum, compare_tolerant};
use checks::prelude::*;
use raykata::shape::PlaneEquation;

type Case = (PlaneEquationQuery, Expected);

fn judge_equations(trial: &Trial<'_>, queries: &[PlaneEquationQuery], sum: Sum) -> Vec<CheckResult> {
    let case = |query: &PlaneEquationQuery| (*query, double::plane_equation(&query.ray, &query.plane, sum));
    judge_cases(trial, &queries.iter().map(case).collect::<Vec<_>>(), "double precision")
}

fn judge_cases(trial: &Trial<'_>, cases: &[Case], source: &'static str) -> Vec<CheckResult> {
    let ask = |queries: &[PlaneEquationQuery]| trial.kit.plane_by_coefficients(queries);
    let shown = |query: &PlaneEquationQuery, yours| observations(&query.ray, yours);
    compare_tolerant(cases, ("plane_by_coefficients", source), ask, shown, formulas)
}

/// Wrong formulas in the same order for every query, each with whether it gives this answer; `is_right` says whether the
/// answer is accepted.
fn formulas(query: &PlaneEquationQuery, yours: Option<f32>, is_right: bool) -> Vec<(bool, &'static str)> {
    let (ray, plane) = (&query.ray, &query.plane);
    let [o, v, n] = [ray.origin, ray.direction, plane.normal].map(Vec3::as_dvec3);
    let d = f64::from(plane.d);
    let (along, slope) = (n.dot(o), n.dot(v));
    let length = n.length();
    let t = (-d - along) / slope;
    // The rounding errors of single precision in any of these formulas.
    let terms = d.abs() * length.max(1.0).max(length.recip()) + n.abs().dot(o.abs());
    let slope_error = 8.0 * U * n.abs().dot(v.abs()) / slope.abs();
    let gives_in = |t: f64, (low, high): (f64, f64)| {
        let error = 8.0 * U * terms / slope.abs() + 2.0 * slope_error * t.abs();
        match yours {
            Some(yours) => f64::from(yours) == t || (f64::from(yours) - t).abs() <= error,
            None => !(low + error < t && t < high - error),
        }
    };
    let gives = |t: f64| gives_in(t, (f64::from(ray.t_min), f64::from(ray.t_max)));
    let of_coordinates = 8.0 * U * (d.abs() + n.abs().dot(o.abs())) / slope.abs();
    let mut all = vec![
        "D and n·o cancel far from the origin: add them in double precision".when(
            is_right
                || yours.is_some_and(|t1| ray.contains(t1) && (f64::from(t1) - t).abs() <= of_coordinates)
                || (yours.is_none() && t.abs() <= of_coordinates),
        ),
        "the sign of D is wrong: the plane is n·p + D = 0, so t = (-D - n·o) / (n·v)"
            .when(gives((d - along) / slope)),
        (gives(-d / slope), "you leave out n·o: the ray need not start at the origin"),
        (gives((-d * length - along) / slope), "if you normalize n, divide D by the length of n as well"),
        (gives(t * length), "n need not be a unit vector: the length of n must cancel in t"),
        (gives(-t), "the sign of t is wrong: t = (-D - n·o) / (n·v)"),
    ];
    all.extend(of_tests(ray, t, slope, yours, is_right, &gives_in));
    all
}

/// The equation of the plane through a point, as exact as single precision allows.
fn through(point: Vec3, normal: Vec3) -> PlaneEquation {
    PlaneEquation { normal, d: -normal.as_dvec3().dot(point.as_dvec3()) as f32 }
}

fn as_equation(PlaneQuery { ray, plane }: &PlaneQuery) -> PlaneEquationQuery {
    PlaneEquationQuery { ray: *ray, plane: through(plane.point, plane.normal) }
}

pub(super) fn plane_by_coefficients_agrees_with_double_precision(trial: &Trial<'_>) -> CheckResult {
    let ends = (0..4usize).prop_map(|end| [(0.0, f32::INFINITY), (0.0, 1.0), (2.0, 64.0), (-64.0, 1.0)][end]);
    let inputs = (at_planes(), ends).prop_map(|(query, (t_min, t_max))| PlaneEquationQuery {
        ray: query.ray.with_range(t_min, t_max),
        ..as_equation(&query)
    });
    let ceiling = PlaneEquation { normal: Vec3::Y, d: -2.0 };
    // From both sides, with products of n·v that cancel to 0.00003 of their size.
    let diagonal = PlaneEquation { normal: vec3(1.0, 1.0, 0.0), d: -2.0 };
    let cancels = |x: f32, length: f32| PlaneEquationQuery {
        ray: Ray::new(x * Vec3::X, length * vec3(1.0, -1.0 + 2f32.powi(-14), 0.0)),
        plane: diagonal,
    };
    let drawn = [
        PlaneEquationQuery { ray: Ray::new(Vec3::ZERO, Vec3::Y), plane: ceiling },
        PlaneEquationQuery { ray: Ray::new(Vec3::Y, 0.5 * Vec3::Y), plane: ceiling },
        PlaneEquationQuery { ray: Ray::new(4.0 * Vec3::Y, vec3(1.0, -1.0, 0.0)), plane: ceiling },
        PlaneEquationQuery { ray: Ray::new(4.0 * Vec3::Y, Vec3::Y), plane: ceiling },
        PlaneEquationQuery { ray: Ray::new(Vec3::ZERO, Vec3::Y).with_range(0.0, 2.0), plane: ceiling },
        cancels(0.0, 1024.0),
        cancels(4.0, -1024.0),
    ];
    trial.forall_and(&drawn, 3000, inputs, |queries| judge_equations(trial, queries, Sum::Single))
}

pub(super) fn plane_by_coefficients_takes_any_factor(trial: &Trial<'_>) -> CheckResult {
    // The same plane with all four coefficients times a factor: a power of two or any number, of either sign.
    let factor = (nasty::scale(-40..=40), prop_oneof![Just(1.0f32), 0.5..2.0f32], nasty::sign());
    let scales = (nasty::scale(-20..=20), nasty::scale(-20..=20));
    let inputs = (point(8), direction(), point(8), nasty::unit(), factor, scales).prop_map(
        |(origin, direction, on, normal, (power, digits, sign), (size, length))| {
            let factor = sign * digits * power;
            let plane = through(on, normal);
            let plane = PlaneEquation { normal: factor * plane.normal, d: size * factor * plane.d };
            PlaneEquationQuery { ray: Ray::new(size * origin, length * direction), plane }
        },
    );
    let ray = Ray::new(vec3(1.0, 5.0, -2.0), vec3(0.5, -1.0, 0.25));
    let with = |factor: f32| {
        let plane = PlaneEquation { normal: factor * vec3(1.0, 2.0, -1.0), d: factor * -3.0 };
        PlaneEquationQuery { ray, plane }
    };
    let drawn = [with(1.0), with(4.0), with(-1.0), with(2f32.powi(-30)), with(-(2f32.powi(30)))];
    trial.forall_and(&drawn, 2000, inputs, |queries| judge_equations(trial, queries, Sum::Single))
}

pub(super) fn plane_by_coefficients_is_missed_by_rays_along_it(trial: &Trial<'_>) -> CheckResult {
    let floor = PlaneEquation { normal: Vec3::Y, d: 0.0 };
    let flat = Ray::new(Vec3::Y, vec3(1.0, 2f32.powi(-20), 0.0));
    let others = [
        (Ray::new(Vec3::Y, Vec3::NEG_Y), PlaneEquation { normal: Vec3::ZERO, d: 1.0 }, Expected::Miss),
        (flat, PlaneEquation { d: -2.0, ..floor }, Expected::exactly(Some(1_048_576.0))),
    ];
    let others = others.map(|(ray, plane, expected)| (PlaneEquationQuery { ray, plane }, expected));
    let along = along_planes().map(|(query, expected)| (as_equation(&query), expected));
    all_hold(judge_cases(trial, &[&along[..], &others].concat(), "the definition"))
}

pub(super) fn plane_by_coefficients_far_from_the_origin(trial: &Trial<'_>) -> CheckResult {
    // D and n·o are as large as the coordinates, and their sum is as small as the distance.
    let inputs = at_far_planes().prop_map(|query| as_equation(&query));
    trial.forall(2000, inputs, |queries| judge_equations(trial, queries, Sum::Double))
}
