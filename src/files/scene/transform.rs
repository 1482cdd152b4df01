//! Reads `transform = [ … ]` and `transform_end = [ … ]` of a node.

use super::reader::{Table, Value};
use crate::files::error::LoadError;
use glam::{Affine3A, DAffine3, DMat3, DVec3};

/// The transform of a node to its parent at shutter time 0, and at time 1 if the node moves. Fails if a step
/// is malformed, if a transform cannot be inverted in single precision, or if the blend of the two is
/// singular in between.
pub(super) fn of_node(table: &Table) -> Result<(Affine3A, Option<Affine3A>), LoadError> {
    let start = table.get("transform").map_or(Ok(DAffine3::IDENTITY), steps)?;
    let Some(value) = table.get("transform_end") else { return Ok((single(start), None)) };
    let end = steps(value)?;
    match keeps_volume(&start.matrix3, &end.matrix3) {
        true => Ok((single(start), Some(single(end)))),
        false => Err(value
            .error("between `transform` and `transform_end` the shape becomes flat")
            .help("do not reflect the shape, and rotate it by less than 180 degrees")),
    }
}

/// The product of all steps of `value`; the first one in the list is applied to the shape first.
fn steps(value: Value) -> Result<DAffine3, LoadError> {
    let mut all = DAffine3::IDENTITY;
    for step_value in value.list("a list of steps")? {
        all = step(step_value)? * all;
    }
    let stored = single(all);
    let sound = stored.is_finite()
        && stored.inverse().is_finite()
        // Rounding to single precision must not change the sign of the determinant.
        && stored.matrix3.determinant() as f64 * all.matrix3.determinant() > 0.0;
    match sound {
        true => Ok(all),
        false => Err(value.error(format!("{} cannot be inverted in single precision", value.name()))),
    }
}

fn step(value: Value) -> Result<DAffine3, LoadError> {
    const KINDS: [&str; 4] = ["scale", "rotate", "translate", "matrix"];
    let kind = value.table(&KINDS)?.one_of(&KINDS)?;
    Ok(match kind.key {
        "scale" => DAffine3::from_scale(kind.factors()?.as_dvec3()),
        "translate" => DAffine3::from_translation(kind.vector()?.as_dvec3()),
        "rotate" => {
            let table = kind.table(&["axis", "degrees"])?;
            let axis = table.need("axis", "[0, 1, 0]")?.direction_f64()?;
            // Without whole turns, so that one turn is exactly none.
            let degrees = f64::from(table.need("degrees", "30")?.number()?) % 360.0;
            DAffine3::from_axis_angle(axis, degrees.to_radians())
        }
        _ => matrix(kind)?,
    })
}

/// An affine matrix from three rows of four numbers; its fourth row is always 0, 0, 0, 1.
fn matrix(value: Value) -> Result<DAffine3, LoadError> {
    let mut rows = [[0.0; 4]; 3];
    for (row, row_value) in rows.iter_mut().zip(value.list_of(3, "three rows of four numbers")?) {
        *row = row_value.numbers("four numbers")?;
    }
    let column = |index: usize| DVec3::from(rows.map(|row: [f32; 4]| f64::from(row[index])));
    let linear = DMat3::from_cols(column(0), column(1), column(2));
    if !spans_volume(&linear) {
        return Err(value
            .error("`matrix` is singular, so rays cannot be transformed back")
            .help("no column may be zero or a linear combination of the others"));
    }
    Ok(DAffine3::from_mat3_translation(linear, column(3)))
}

/// Whether the columns span a volume. It is compared with the volume of columns of the same lengths at right
/// angles, so that scales do not matter. If the columns are linearly dependent, double precision leaves about
/// 1e-16 of that. False for NaN.
fn spans_volume(matrix: &DMat3) -> bool {
    let right_angled = matrix.x_axis.length() * matrix.y_axis.length() * matrix.z_axis.length();
    matrix.determinant().abs() > 1e-12 * right_angled
}

/// Whether all blends of `start` and `end`, entry by entry, keep a millionth of the volume and the sign of
/// the determinant. The volume is a cubic in time, so that sixteen steps find its change of sign, and its
/// zero in the middle of a half turn.
fn keeps_volume(start: &DMat3, end: &DMat3) -> bool {
    let (first, last) = (start.determinant(), end.determinant());
    let least = 1e-6 * first.abs().min(last.abs());
    (0..=16).map(|step| f64::from(step) / 16.0).all(|time| {
        let volume = (*start * (1.0 - time) + *end * time).determinant();
        volume * first.signum() > least
    })
}

fn single(transform: DAffine3) -> Affine3A {
    Affine3A::from_cols_array(&transform.to_cols_array().map(|entry| entry as f32))
}
