//! Inside tests I, II and III.

use super::method::aimed;
use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::double::{self};
use checks::generate::{point, triangle};
use checks::judge::{compare, known};
use checks::paste::{Arguments, call};
use glam::{DVec3, Vec3, vec3};
use proptest::prelude::*;
use raykata::kit::{InsideQuery, Kit, TriangleQuery};
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// A point where a ray hits the plane of a triangle, with its barycentric coordinates `[α, β, γ]`.
pub(super) fn plane_points() -> impl Strategy<Value = (InsideQuery, [f64; 3])> + Clone {
    aimed(triangle(), point(8)).prop_map(|TriangleQuery { ray, triangle }| {
        let hit = double::triangle(&ray, &triangle);
        let point = double::triangle_point(&triangle, hit.beta, hit.gamma).as_vec3();
        (InsideQuery { ray, point, triangle }, [1.0 - hit.beta - hit.gamma, hit.beta, hit.gamma])
    })
}

/// Whether the point is inside. `None` if rounding may decide: the point is near a side, the triangle is thin, or
/// the ray is nearly parallel to it.
pub(super) fn clearly_inside(query: &InsideQuery, weights: [f64; 3]) -> Option<bool> {
    let Triangle { a, b, c } = query.triangle;
    let area = (b - a).cross(c - a).length();
    let thin = (b - a).length() * (c - a).length() / area;
    let facing = query.ray.direction.normalize().dot((b - a).cross(c - a) / area).abs();
    let least = weights.into_iter().fold(f64::INFINITY, f64::min);
    // A side and the ray's origin span no plane if the origin lies on the line of the side. For a grazing ray it nearly
    // does.
    let sharp = thin < 30.0 && facing > 0.05 && weights.iter().all(|w| w.is_finite());
    (sharp && least.abs() > 1e-3).then_some(least > 0.0)
}

pub(super) fn judge_inside(
    trial: &Trial<'_>,
    name: &'static str,
    ask: fn(&dyn Kit, &[InsideQuery]) -> Vec<bool>,
) -> CheckResult {
    trial.forall(4000, plane_points(), |cases| {
        let queries: Vec<InsideQuery> = cases.iter().map(|case| case.0).collect();
        compare(cases, ask(trial.kit, &queries), |(query, weights), yours| {
            match clearly_inside(query, *weights) {
                Some(inside) if inside != yours => {
                    let normal =
                        (query.triangle.b - query.triangle.a).cross(query.triangle.c - query.triangle.a);
                    let backwards = normal.dot(query.ray.direction) > 0.0;
                    let diagnosis = match yours {
                        false if backwards => {
                            "seen from behind, all three signs change: accept all ≥ 0 or all ≤ 0"
                        }
                        false => "for a point inside, all three signs are equal: accept all ≥ 0 or all ≤ 0",
                        true => "a point beyond a side: is P0 subtracted twice, or a side left out or turned around?",
                    };
                    Err(Broken::new(query.call(name), yours, inside, "double precision")
                        .looks_like(Some(diagnosis)))
                }
                _ => Ok(()),
            }
        })
    })
}

pub(super) fn inside_by_planes_agrees_with_double_precision(trial: &Trial<'_>) -> CheckResult {
    judge_inside(trial, "inside_by_planes", |kit, queries| kit.inside_by_planes(queries))?;
    // T10: the ray's origin lies on the line of a side, so that plane's normal is 0, and normalizing it gives NaN.
    let triangle = Triangle { a: Vec3::ZERO, b: vec3(4.0, 0.0, 0.0), c: vec3(0.0, 4.0, 0.0) };
    let eye = vec3(-4.0, 0.0, 0.0);
    let query = InsideQuery { ray: Ray::new(eye, vec3(5.0, 0.0, 0.0)), point: vec3(1.0, 0.0, 0.0), triangle };
    match trial.kit.inside_by_planes(&[query])[..] {
        [true] => Ok(()),
        ref yours => Err(Broken::new(query.call("inside_by_planes"), yours, [true], "exact arithmetic")
            .looks_like(Some(
                "the ray's origin is on the line of a side: accept its 0, and do not normalize (0/0)",
            ))),
    }
}

pub(super) fn inside_by_direction_agrees_with_double_precision(trial: &Trial<'_>) -> CheckResult {
    judge_inside(trial, "inside_by_direction", |kit, queries| kit.inside_by_direction(queries))
}

pub(super) fn inside_by_areas_gives_barycentric_coordinates(trial: &Trial<'_>) -> CheckResult {
    trial.forall(4000, plane_points(), |cases| {
        let queries: Vec<InsideQuery> = cases.iter().map(|case| case.0).collect();
        compare(cases, trial.kit.inside_by_areas(&queries), |(query, weights), yours| {
            let Some(inside) = clearly_inside(query, *weights) else { return Ok(()) };
            let exact = DVec3::from_array(*weights);
            // The point is rounded at its own size. A thin triangle magnifies this error, here up to 30 times.
            let right = yours.is_none_or(|yours| (yours.as_dvec3() - exact).abs().max_element() < 1e-3);
            if yours.is_some() == inside && right {
                return Ok(());
            }
            let diagnosis = match yours {
                Some(yours) if inside && (yours.element_sum() - 1.0).abs() > 1e-2 => {
                    "your coordinates do not add up to 1: |u × v| is twice the area of the triangle"
                }
                Some(_) if !inside => {
                    "areas without a sign cannot tell inside from outside: use signed areas"
                }
                Some(yours)
                    if (yours.as_dvec3().truncate() - exact.truncate()).length() > 1e-3
                        && (yours.as_dvec3() - DVec3::new(exact.z, exact.y, exact.x)).length() < 1e-3 =>
                {
                    "your values belong to other corners: α to a, β to b, γ to c (the slide differs)"
                }
                _ => "",
            };
            let expected = inside.then_some(exact.as_vec3());
            let input = call("inside_by_areas", &[&query.point, &query.triangle]);
            Err(Broken::new(input, yours, expected, "double precision").looks_like(known(diagnosis)))
        })
    })
}
