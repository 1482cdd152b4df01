//! Ray-plane intersection, and the normal on the side that the ray comes from.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::double::{self, Expected};
use checks::generate::{direction, point, rough_point};
use checks::judge::{compare, known};
use checks::paste::{Arguments, Paste};
use glam::Vec3;
use proptest::prelude::*;
use raykata::kit::PlaneQuery;
use raykata::ray::Ray;
use raykata::shape::Plane;

pub(super) fn judge_planes(trial: &Trial<'_>, queries: &[PlaneQuery]) -> Vec<CheckResult> {
    compare(queries, trial.kit.plane(queries), |query, yours| {
        let expected = double::plane(&query.ray, &query.plane);
        if expected.accepts(yours) {
            return Ok(());
        }
        let length = query.ray.direction.length();
        let infinite = Ray { t_min: f32::NEG_INFINITY, ..query.ray };
        let mirrored = |t: f32| double::plane(&infinite, &query.plane).accepts(Some(-t));
        let diagnosis = match (yours, expected) {
            (Some(t), _) if t.is_nan() => "you return NaN: compare so that NaN fails",
            (Some(t), _) if !query.ray.contains(t) => "you return a t that ray.contains(t) refuses",
            (Some(t), _) if t != 0.0 && mirrored(t) => "the sign of t is wrong: compute p0 - o, not o - p0",
            (Some(t), Expected::Hit { t: exact, tolerance })
                if (f64::from(t / length) - exact).abs() <= tolerance =>
            {
                "your t counts world units; it must count lengths of direction"
            }
            (None, Expected::Hit { .. }) if query.ray.direction.dot(query.plane.normal).abs() < 0.01 => {
                "you compare n·d with a fixed limit, but a ray is parallel only if n·d = 0"
            }
            (None, Expected::Hit { .. }) if query.ray.direction.dot(query.plane.normal) > 0.0 => {
                "the plane can be hit from behind, too: do not test the sign of n·d"
            }
            _ => "",
        };
        let broken = Broken::with_texts(
            query.call("plane"),
            format!("{yours:?}"),
            expected.words(),
            "double precision",
        );
        Err(broken.looks_like(known(diagnosis)))
    })
}

pub(super) fn plane_agrees_with_double_precision(trial: &Trial<'_>) -> CheckResult {
    let inputs =
        (point(8), direction(), point(8), direction()).prop_map(|(origin, direction, point, normal)| {
            PlaneQuery { ray: Ray::new(origin, direction), plane: Plane { point, normal } }
        });
    trial.forall(4000, inputs, |queries| judge_planes(trial, queries))?;
    let floor = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let flat = PlaneQuery { ray: Ray::new(Vec3::Y, Vec3::new(1.0, -2f32.powi(-14), 0.0)), plane: floor };
    let short = PlaneQuery {
        ray: Ray::new(Vec3::new(0.0, 2.0, 0.0), Vec3::NEG_Y).with_range(0.0, 1.0),
        plane: floor,
    };
    judge_planes(trial, &[flat, short]).into_iter().collect()
}

pub(super) fn plane_is_missed_by_rays_along_it(trial: &Trial<'_>) -> CheckResult {
    let plane = Plane { point: Vec3::ZERO, normal: Vec3::Y };
    let cases = [
        (Ray::new(Vec3::Y, Vec3::X), plane),
        (Ray::new(Vec3::ZERO, Vec3::X), plane),
        (Ray::new(Vec3::NEG_Y, Vec3::new(1.0, -0.0, 1.0)), plane),
        (Ray::new(Vec3::ZERO, Vec3::NEG_Y), plane),
        (Ray::new(Vec3::Y, Vec3::NAN), plane),
        (Ray::new(Vec3::Y, Vec3::NEG_Y), Plane { normal: Vec3::ZERO, ..plane }),
    ];
    let queries = cases.map(|(ray, plane)| PlaneQuery { ray, plane });
    for (query, yours) in queries.iter().zip(trial.kit.plane(&queries)) {
        if yours.is_some() {
            let diagnosis =
                "n·d = 0 makes t infinite or NaN; an origin in the plane makes t = 0: none of these counts";
            return Err(Broken::with_texts(
                query.call("plane"),
                format!("{yours:?}"),
                "None",
                "the definition",
            )
            .looks_like(Some(diagnosis)));
        }
    }
    Ok(())
}

pub(super) fn plane_far_from_the_origin(trial: &Trial<'_>) -> CheckResult {
    // T12: -(D + n·o) subtracts two numbers as large as the coordinates; (p0 - o)·n does not.
    let inputs = (rough_point(4.0), direction(), direction()).prop_map(|(offset, direction, normal)| {
        let point = Vec3::new(148_376.0, 1_234.0, -223_423.0);
        PlaneQuery { ray: Ray::new(point + offset, direction), plane: Plane { point, normal } }
    });
    let cancels = "-(D + n·o) cancels far from the origin; (p0 - o)·n does not";
    trial
        .forall(2000, inputs, |queries| judge_planes(trial, queries))
        .map_err(|broken| if broken.diagnosis.is_some() { broken } else { broken.looks_like(Some(cancels)) })
}

pub(super) fn face_forward_turns_the_normal_to_the_ray(trial: &Trial<'_>) -> CheckResult {
    trial.forall(1000, (direction(), direction()), |queries| {
        compare(queries, trial.kit.face_forward(queries), |(normal, direction), yours| {
            let expected = if normal.dot(*direction) > 0.0 { -*normal } else { *normal };
            // At a right angle both sides are accepted.
            let right = yours == expected || (normal.dot(*direction) == 0.0 && yours == -expected);
            let diagnosis = (yours == -expected).then_some("your normal points away from the viewer");
            let input = format!("face_forward({}, {})", normal.paste(), direction.paste());
            if right {
                Ok(())
            } else {
                Err(Broken::new(input, yours, expected, "the definition").looks_like(diagnosis))
            }
        })
    })
}
