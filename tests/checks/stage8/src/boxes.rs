//! Checks of `bounds_to_world`.

use checks::Trial;
use checks::broken::{Broken, CheckResult};
use checks::double::U;
use checks::judge::{compare, known};
use checks::paste::call;
use glam::{Affine3A, Mat3, Vec3};
use oracle::splitmix::Random;
use raykata::aabb::Aabb;
use raykata::kit::BoundsQuery;

/// Transforms of all kinds and boxes of all sizes.
fn moved(trial: &Trial<'_>) -> Vec<BoundsQuery> {
    let mut random = Random::new(trial.seed, 12);
    let draw = |_| {
        let size = 10f32.powf(4.0 * random.signed());
        let matrix = Mat3::from_cols(random.in_cube(), random.in_cube(), random.in_cube());
        let to_world = Affine3A::from_mat3_translation(matrix, size * random.in_cube());
        let (p, q) = (size * random.in_cube(), size * random.in_cube());
        BoundsQuery { to_world, bounds: Aabb::new(p.min(q), p.max(q)) }
    };
    let mut queries: Vec<BoundsQuery> = (0..2000).map(draw).collect();
    let bounds = Aabb::new(Vec3::new(-1.0, 0.25, 3.0), Vec3::new(2.0, 0.25, 3.5));
    queries.push(BoundsQuery { to_world: Affine3A::IDENTITY, bounds });
    queries
}

/// The exact ends along an axis in double precision, and the sum of the absolute values of all terms.
fn ends(query: &BoundsQuery, row: usize) -> (f64, f64, f64) {
    let start = f64::from(query.to_world.translation[row]);
    let (mut low, mut high, mut size) = (start, start, start.abs());
    for axis in 0..3 {
        let factor = f64::from(query.to_world.matrix3.col(axis)[row]);
        let ends = [query.bounds.min, query.bounds.max].map(|corner| factor * f64::from(corner[axis]));
        low += ends[0].min(ends[1]);
        high += ends[0].max(ends[1]);
        size += ends[0].abs().max(ends[1].abs());
    }
    (low, high, size)
}

fn describe(query: &BoundsQuery) -> String {
    call("bounds_to_world", &[&query.to_world, &query.bounds])
}

pub(super) fn boxes_hold_what_they_should_after_transforms(trial: &Trial<'_>) -> CheckResult {
    let queries = moved(trial);
    let judge = |query: &BoundsQuery, yours: Aabb| {
        for row in 0..3 {
            let (low, high, size) = ends(query, row);
            // The rounding error of the sums in double precision is at most 2⁻⁵¹ of the sum of their terms.
            let slack = size * 2f64.powi(-51);
            let (yours_low, yours_high) = (f64::from(yours.min[row]), f64::from(yours.max[row]));
            if yours_low <= low + slack && yours_high >= high - slack {
                continue;
            }
            let off = (yours_low - low).max(high - yours_high) / (U * size);
            let diagnosis = match () {
                () if off.is_nan() => "you return NaN",
                () if off < 8.0 => "your box is too small by a rounding error: round outwards",
                () => {
                    "your box is much too small: after a rotation any of the eight corners can be the \
                     farthest"
                }
            };
            let axis = ["x", "y", "z"][row];
            return Err(Broken::with_texts(
                describe(query),
                format!("{yours_low} to {yours_high} along {axis}"),
                format!("{low} to {high}, or more"),
                "double precision",
            )
            .looks_like(Some(diagnosis)));
        }
        Ok(())
    };
    compare(&queries, trial.kit.bounds_to_world(&queries), judge).into_iter().collect()
}

pub(super) fn boxes_have_little_room_after_transforms(trial: &Trial<'_>) -> CheckResult {
    let queries = moved(trial);
    let judge = |query: &BoundsQuery, yours: Aabb| {
        for row in 0..3 {
            let (low, high, size) = ends(query, row);
            // Allow six rounding errors of each term (three products, three sums), one float outwards, and a small
            // reserve.
            let room = 16.0 * U * size;
            let (yours_low, yours_high) = (f64::from(yours.min[row]), f64::from(yours.max[row]));
            if yours_low >= low - room && yours_high <= high + room {
                continue;
            }
            let axis = ["x", "y", "z"][row];
            let diagnosis =
                "your box is larger than the rounding errors require, so rays enter it without need";
            return Err(Broken::with_texts(
                describe(query),
                format!("{yours_low} to {yours_high} along {axis}"),
                format!("{low} to {high}, and {room:.1e} on either side at most"),
                "double precision",
            )
            .looks_like(known(diagnosis)));
        }
        Ok(())
    };
    compare(&queries, trial.kit.bounds_to_world(&queries), judge).into_iter().collect::<CheckResult>()?;
    let empty = BoundsQuery { to_world: Affine3A::from_scale(Vec3::splat(2.0)), bounds: Aabb::EMPTY };
    let yours = trial.kit.bounds_to_world(&[empty])[0];
    if yours.min.cmpgt(yours.max).all() {
        return Ok(());
    }
    let broken = Broken::new(describe(&empty), yours, "an empty box", "the definition");
    Err(broken.looks_like(Some("an empty box stays empty: its corners are infinite, and ∞ - ∞ is NaN")))
}
