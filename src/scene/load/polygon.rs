//! Reads `polygon = { corners = [ … ] }` and checks that it is flat, convex and goes around once.

use super::reader::Value;
use crate::scene::error::LoadError;
use glam::{DVec3, Vec3};
use std::f64::consts::{PI, TAU};

/// The largest distance of a corner from the plane, relative to the size of the polygon: corners written with
/// five digits are that far away.
const FLATNESS: f64 = 1e-5;

/// The corners of a polygon, at least three and in order. Fails if two neighbours are the same point, if all
/// lie on one line, if one lies outside of the common plane, or if the polygon is not convex.
pub(super) fn corners(value: Value) -> Result<Vec<Vec3>, LoadError> {
    let list = value.table(&["corners"])?.need("corners", "[[0, 0, 0], [1, 0, 0], [0, 1, 0]]")?;
    let items = list.list("a list of points")?;
    if items.len() < 3 {
        return Err(
            list.error(format!("a polygon has three corners or more, and this one has {}", items.len()))
        );
    }
    let corners: Vec<Vec3> = items.iter().map(Value::vector).collect::<Result<_, _>>()?;
    let exact: Vec<DVec3> = corners.iter().map(|corner| corner.as_dvec3()).collect();
    let after = |index: usize| (index + 1) % corners.len();
    if let Some(index) = (0..corners.len()).find(|&index| corners[index] == corners[after(index)]) {
        let message = format!("corners {} and {} are the same point", index + 1, after(index) + 1);
        return Err(items[after(index)].error(message));
    }

    let Some(normal) = area_vector(&exact).try_normalize() else {
        return Err(list.error("the corners lie on one line, so no ray can hit the polygon"));
    };
    if let Some(index) = strays(&exact, normal) {
        return Err(items[index]
            .error(format!("corner {} does not lie in the plane of the polygon", index + 1))
            .help("divide the polygon into triangles"));
    }
    if let Some(index) = turns_back(&exact, normal) {
        return Err(items[index]
            .error(format!("the polygon is not convex at corner {}", index + 1))
            .help("divide it into convex parts, and give the corners in order"));
    }
    Ok(corners)
}

/// The normal of the polygon, twice as long as its area: the sum over all edges of the parallelograms that
/// they span with the first corner.
fn area_vector(corners: &[DVec3]) -> DVec3 {
    corners.windows(2).map(|edge| (edge[0] - corners[0]).cross(edge[1] - corners[0])).sum()
}

/// The first corner that is too far from the plane through the mean of all corners.
fn strays(corners: &[DVec3], normal: DVec3) -> Option<usize> {
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let size = corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
    // Allow for the rounding of the coordinates to `f32` as well, which matters far from the origin.
    let largest = corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
    let tolerance = FLATNESS * size + f64::from(f32::EPSILON) * largest;
    corners.iter().position(|corner| (corner - middle).dot(normal).abs() > tolerance)
}

/// The first corner at which the outline turns the wrong way, or at which it has gone around more than once.
fn turns_back(corners: &[DVec3], normal: DVec3) -> Option<usize> {
    let count = corners.len();
    let edge = |index: usize| (corners[(index + 1) % count] - corners[index % count]).normalize_or_zero();
    let mut turned = 0.0;
    (0..count).find(|&index| {
        let (before, after) = (edge(index + count - 1), edge(index));
        let angle = before.cross(after).dot(normal).atan2(before.dot(after));
        turned += angle;
        // Accept corners in the middle of a straight edge, up to the rounding of their coordinates.
        !(-FLATNESS..PI - FLATNESS).contains(&angle) || turned > TAU + 1e-3
    })
}
