//! Reads `polygon = { corners = [ … ] }` and checks that it is flat.

use super::reader::Value;
use crate::files::error::LoadError;
use crate::geometry::triangulate::area_vector;
use glam::{DVec3, Vec3};

/// The largest distance of a corner from the plane, relative to the size of the polygon: corners written with
/// five digits are that far away.
const FLATNESS: f64 = 1e-5;

/// The corners of a polygon, at least three and in order. Fails if two neighbours are the same point, if all
/// lie on one line, or if one lies outside of the common plane.
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
    if let Some(index) = first_corner_off_plane(&exact, normal) {
        return Err(items[index]
            .error(format!("corner {} does not lie in the plane of the polygon", index + 1))
            .help("divide the polygon into triangles"));
    }
    Ok(corners)
}

/// The first corner that is too far from the plane through the mean of all corners.
fn first_corner_off_plane(corners: &[DVec3], normal: DVec3) -> Option<usize> {
    let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
    let size = corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
    // Allow for the rounding of the coordinates to `f32` as well, which matters far from the origin.
    let largest = corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f64::max);
    let tolerance = FLATNESS * size + f64::from(f32::EPSILON) * largest;
    corners.iter().position(|corner| (corner - middle).dot(normal).abs() > tolerance)
}
