//! The laws of `offset_origin` and `safe_normalize`.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::double::U;
use checks::generate::{magnitude, rough_point, unit};
use checks::judge::{compare, known};
use checks::paste::call;
use glam::Vec3;
use proptest::prelude::*;
use raykata::kit::OffsetQuery;

fn describe(query: &OffsetQuery) -> String {
    call("offset_origin", &[&query.point, &query.error, &query.normal, &query.direction])
}

fn surfaces() -> impl Strategy<Value = OffsetQuery> + Clone {
    (unit(), unit(), rough_point(1.0), magnitude(-3.0, 5.0), any::<bool>()).prop_map(
        |(normal, lean, at, size, beyond)| {
            let side = if beyond { -normal } else { normal };
            OffsetQuery {
                point: size * at,
                // Seven roundings per coordinate, as for a point on a triangle of this size.
                error: Vec3::splat(4e-7 * size),
                normal,
                direction: (side + 0.8 * lean).normalize(),
            }
        },
    )
}

/// The height of the origin above the point on the side to which the ray goes, and the error bound of the point along
/// the normal.
fn height(query: &OffsetQuery, origin: Vec3) -> (f64, f64) {
    let normal = query.normal.as_dvec3();
    let side = if normal.dot(query.direction.as_dvec3()) < 0.0 { -normal } else { normal };
    let moved = origin.as_dvec3() - query.point.as_dvec3();
    (moved.dot(side), query.error.as_dvec3().dot(side.abs()))
}

pub(super) fn offsets_leave_the_surface_at_any_scale(trial: &Trial<'_>) -> CheckResult {
    trial.forall(4000, surfaces(), |queries| {
        compare(queries, trial.kit.offset_origin(queries), |query, origin| {
            let (height, bound) = height(query, origin);
            // Allow one per cent for the rounding of the bound itself.
            if height >= 0.99 * bound {
                return Ok(());
            }
            let diagnosis = match () {
                () if height == 0.0 => {
                    "the ray starts on the surface itself, and hits it again in half of all cases (shadow acne)"
                }
                () if height < 0.0 => {
                    "the ray starts on the other side: turn the normal to the side of the direction"
                }
                () => "the offset is too small here: move by the error of the point, error · |n|",
            };
            Err(Broken::with_texts(
                describe(query),
                format!("{height:.3e} off the point"),
                format!("{bound:.3e} or more, on the side of the direction"),
                "closed form",
            )
            .looks_like(Some(diagnosis)))
        })
    })
}

pub(super) fn offsets_are_as_small_as_they_can_be(trial: &Trial<'_>) -> CheckResult {
    trial.forall(4000, surfaces(), |queries| {
        compare(queries, trial.kit.offset_origin(queries), |query, origin| {
            let (height, bound) = height(query, origin);
            // Allow 64 steps of the largest coordinate. The ray must hit objects that are farther away.
            let most = 64.0 * 2.0 * U * f64::from(query.point.abs().max_element()) + 4.0 * bound;
            if height <= most {
                return Ok(());
            }
            let diagnosis = "the offset is too large here: the ray misses objects that touch the surface";
            Err(Broken::with_texts(
                describe(query),
                format!("{height:.3e} off the point"),
                format!("at most {most:.3e}"),
                "closed form",
            )
            .looks_like(Some(diagnosis)))
        })
    })
}

pub(super) fn directions_have_length_one_at_every_length(trial: &Trial<'_>) -> CheckResult {
    let vectors =
        (unit(), -140..=126i32).prop_map(|(v, exponent)| (v.as_dvec3() * 2f64.powi(exponent)).as_vec3());
    let vectors = vectors.prop_filter("a vector that did not underflow to 0", |v| *v != Vec3::ZERO);
    trial.forall(4000, vectors, |queries| {
        compare(queries, trial.kit.safe_normalize(queries), |query, yours| {
            let expected = query.as_dvec3().normalize();
            // Allow four roundings per coordinate.
            if yours.is_some_and(|yours| (yours.as_dvec3() - expected).length() < 4.0 * 2.0 * U) {
                return Ok(());
            }
            let short = query.as_dvec3().length() < 1.0;
            let diagnosis = match yours {
                None if short => {
                    "you return None for a short vector: the squares underflow, so scale by the largest coordinate first"
                }
                None => {
                    "you return None for a long vector: the squares overflow, so scale by the largest coordinate first"
                }
                // The vector was divided by an infinite length.
                Some(yours) if yours.length() < 0.5 => "the squares overflow: scale by the largest coordinate first",
                Some(_) if short => "the squares underflow: scale by the largest coordinate first",
                Some(_) => "",
            };
            Err(Broken::new(call("safe_normalize", &[query]), yours, expected, "double precision")
                .looks_like(known(diagnosis)))
        })
    })
}

pub(super) fn zero_has_no_direction(trial: &Trial<'_>) -> CheckResult {
    let bad = [0.0, -0.0, f32::NAN, f32::INFINITY, f32::NEG_INFINITY];
    let mut queries = vec![Vec3::ZERO, Vec3::splat(-0.0)];
    for number in &bad[2..] {
        queries.extend([Vec3::new(*number, 1.0, 0.0), Vec3::new(0.0, 1.0, *number), Vec3::splat(*number)]);
    }
    let judge = |query: &Vec3, yours: Option<Vec3>| match yours {
        None => Ok(()),
        Some(_) => {
            let broken = Broken::new(call("safe_normalize", &[query]), yours, None::<Vec3>, "the definition");
            let diagnosis = match () {
                () if *query == Vec3::ZERO => "you return a direction for the zero vector: 0 / 0 is NaN",
                () => "you return a direction for a vector that is not finite",
            };
            Err(broken.looks_like(Some(diagnosis)))
        }
    };
    compare(&queries, trial.kit.safe_normalize(&queries), judge).into_iter().collect()
}
