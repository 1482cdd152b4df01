//! Checks of `bounds_to_world`.

use super::bounding_spheres;
use checks::prelude::*;
use glam::{Affine3A, Mat3};
use oracle::splitmix::Random;

/// Transforms of all kinds and boxes of all sizes.
fn moved(trial: &Trial<'_>) -> Vec<BoundsQuery> {
    let mut random = Random::new(trial.seed, 12);
    let draw = |i: i32| {
        // One query of eight has a size between 2⁻⁶⁰ and 2⁶⁰.
        let any_size = 2f32.powi(random.below(121) as i32 - 60);
        let size = if i % 8 == 0 { any_size } else { 10f32.powf(4.0 * random.signed()) };
        let mut matrix = Mat3::from_cols(random.in_cube(), random.in_cube(), random.in_cube());
        let (mut p, mut q) = (size * random.in_cube(), size * random.in_cube());
        let axis = random.below(3) as usize;
        match i % 5 {
            // Quarter turns and scales along the axes, with zeros.
            0 => {
                let turn = |column: usize| random.signed() * Vec3::AXES[(column + axis) % 3];
                matrix = Mat3::from_cols_array_2d(&[0, 1, 2].map(turn).map(|column| column.to_array()));
            }
            // Flat boxes, and boxes at the origin.
            1 => q[axis] = p[axis],
            2 => p[axis] = 0.0,
            _ => {}
        }
        let to_world = Affine3A::from_mat3_translation(matrix, size * random.in_cube());
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

/// What a box may lack, relative to its terms, where its rounding is not judged: the errors of a few products and sums.
pub(super) const ROUNDINGS: f64 = 16.0 * U;

pub(super) fn volumes_are_rounded_outwards(trial: &Trial<'_>) -> CheckResult {
    judge_contents(trial, 0.0)?;
    bounding_spheres::are_rounded_outwards(trial)
}

/// Judges whether boxes contain what they should, up to an error relative to the sum of the terms.
pub(super) fn judge_contents(trial: &Trial<'_>, allowed: f64) -> CheckResult {
    let queries = moved(trial);
    let judge = |query: &BoundsQuery, yours: Aabb| {
        // How much of the interval is missing on each axis, and the sum of the terms there.
        let lacks = [0, 1, 2].map(|row| {
            let (low, high, size) = ends(query, row);
            ((f64::from(yours.min[row]) - low).max(high - f64::from(yours.max[row])), size)
        });
        // The rounding error of the sums in double precision is at most 2⁻⁵¹ of the sum of their terms.
        let too_small = lacks.iter().position(|(off, size)| !(*off <= size * allowed.max(2f64.powi(-51))));
        let broken = || {
            let row = too_small.unwrap_or(0);
            let ((low, high, _), axis) = (ends(query, row), ["x", "y", "z"][row]);
            let rounded = lacks.iter().all(|(off, size)| *off < 8.0 * U * size);
            Broken::with_texts(
                query.call("bounds_to_world"),
                format!("{} to {} along {axis}", f64::from(yours.min[row]), f64::from(yours.max[row])),
                format!("{low} to {high}, or more"),
                "double precision",
            )
            .explained_by([
                (yours.min.is_nan() || yours.max.is_nan(), "you return NaN"),
                (rounded, "your box is too small by a rounding error: round outwards"),
            ])
        };
        // Move the smallest and the largest corner, as this mistake does.
        let corners = [query.bounds.min, query.bounds.max]
            .map(|corner| query.to_world.as_daffine3().transform_point3(corner.as_dvec3()));
        let is = |yours: Vec3, wrong: DVec3| {
            (0..3).all(|row| (f64::from(yours[row]) - wrong[row]).abs() <= 16.0 * U * lacks[row].1)
        };
        let start = query.to_world.as_daffine3().translation;
        let all = [0, 1, 2].map(|row| ends(query, row));
        let [low, high] = [DVec3::from(all.map(|end| end.0)), DVec3::from(all.map(|end| end.1))];
        let [least, most] = [corners[0].min(corners[1]), corners[0].max(corners[1])];
        unless(too_small.is_none(), broken).formulas([
            (is(yours.min, low - start) && is(yours.max, high - start), "you do not translate the box"),
            "your box is much too small, because you transform two corners only: after a rotation any of the eight can be the farthest"
                .when(is(yours.min, least) && is(yours.max, most)),
            "your box is inside out, because you transform two corners only: after a rotation any of the eight can be the farthest"
                .when(is(yours.min, corners[0]) && is(yours.max, corners[1])),
        ])
    };
    all_hold(compare(&queries, trial.kit.bounds_to_world(&queries), judge))
}

pub(super) fn boxes_have_little_room_after_transforms(trial: &Trial<'_>) -> CheckResult {
    let mut queries = moved(trial);
    // Empty boxes: infinite, and inside out along a single axis.
    let to_world = Affine3A::from_scale(Vec3::splat(2.0));
    queries.push(BoundsQuery { to_world, bounds: Aabb::EMPTY });
    for axis in Vec3::AXES {
        queries.push(BoundsQuery { to_world, bounds: Aabb::new(axis, Vec3::ONE - axis) });
    }
    all_hold(compare(&queries, trial.kit.bounds_to_world(&queries), judge_room))
}

fn judge_room(query: &BoundsQuery, yours: Aabb) -> CheckResult {
    if query.bounds.min.cmpgt(query.bounds.max).any() {
        if yours.min.cmpgt(yours.max).any() {
            return Ok(());
        }
        let nan = yours.min.is_nan() || yours.max.is_nan();
        return Err(Broken::new(query.call("bounds_to_world"), yours, "an empty box", "the definition")
            .explained_by([
                (nan, "an empty box stays empty: its corners are infinite, and ∞ - ∞ or 0 · ∞ is NaN"),
                (true, "an empty box stays empty: min is above max on some axis, so return Aabb::EMPTY"),
            ]));
    }
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
        let yours = format!("{yours_low} to {yours_high} along {axis}");
        let expected = format!("{low} to {high}, and {room:.1e} on either side at most");
        let broken = Broken::with_texts(query.call("bounds_to_world"), yours, expected, "double precision");
        return Err(broken.explained_by([
            "your box is larger than the rounding errors require, so rays enter it without need"
                .when(yours_low <= low + room && yours_high >= high - room),
        ]));
    }
    Ok(())
}
