//! The shading normal.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::generate::unit;
use checks::judge::{compare, known};
use checks::paste::Paste;
use glam::Vec3;
use proptest::prelude::*;

pub(super) fn paste_normal_query(
    (geometric, interpolated, direction): &(Vec3, Option<Vec3>, Vec3),
) -> String {
    let interpolated = interpolated.map_or("None".into(), |n| format!("Some({})", n.paste()));
    format!("shading_normal({}, {interpolated}, {})", geometric.paste(), direction.paste())
}

pub(super) fn shading_normal_faces_the_viewer(trial: &Trial<'_>) -> CheckResult {
    // An interpolated normal is the geometric one plus up to 0.3 of a unit vector. It has any length and either sign.
    let inputs = (unit(), unit(), unit(), any::<bool>(), any::<bool>(), 1..=8i32).prop_map(
        |(geometric, lean, direction, smooth, back, length)| {
            let bent = (geometric + 0.3 * lean) * length as f32 / 4.0;
            (geometric, smooth.then_some(if back { -bent } else { bent }), direction)
        },
    );
    trial.forall(2000, inputs, |queries| {
        compare(queries, trial.kit.shading_normal(queries), |query, yours| {
            let (geometric, interpolated, direction) = *query;
            let facing = if geometric.dot(direction) > 0.0 { -geometric } else { geometric };
            let expected = match interpolated.map(Vec3::normalize) {
                Some(smooth) if smooth.dot(facing) < 0.0 => -smooth,
                Some(smooth) => smooth,
                None => facing,
            };
            let grazing = geometric.dot(direction).abs() < 1e-6;
            let same = |n: Vec3| (yours - n).length() < 1e-5;
            if same(expected) || (grazing && same(-expected)) {
                return Ok(());
            }
            let diagnosis = match () {
                () if same(-expected) => "your normal points away from the viewer: negate it",
                () if (yours.normalize_or_zero() - expected).length() < 1e-4 => {
                    "your normal does not have unit length: normalize the interpolated normal"
                }
                () if interpolated.is_some() && same(facing) => {
                    "you return the geometric normal where there is an interpolated one"
                }
                () => "",
            };
            Err(Broken::new(paste_normal_query(query), yours, expected, "closed form")
                .looks_like(known(diagnosis)))
        })
    })
}

pub(super) fn shading_normal_falls_back_to_flat(trial: &Trial<'_>) -> CheckResult {
    let queries = [Vec3::ZERO, Vec3::NAN].map(|useless| (Vec3::Y, Some(useless), Vec3::Y));
    for (query, yours) in queries.iter().zip(trial.kit.shading_normal(&queries)) {
        if yours != Vec3::NEG_Y {
            let broken = Broken::new(
                paste_normal_query(query),
                yours,
                Vec3::NEG_Y,
                "the geometric normal, turned to the viewer",
            );
            return Err(broken.looks_like(Some(
                "a normal of length 0 or NaN has no direction: return the geometric normal",
            )));
        }
    }
    Ok(())
}
