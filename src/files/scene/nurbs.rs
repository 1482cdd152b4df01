//! Reads `bspline = { … }` and `nurbs = { … }`.

use super::reader::{Table, Value};
use crate::files::error::LoadError;
use crate::shape::{NurbsPatch, Shape};
use std::ops::RangeInclusive;

/// The largest degree: the recursion for a basis function takes 2 to the power of the degree.
const DEGREES: RangeInclusive<u32> = 1..=7;
/// The directions of a surface in messages.
const NAMES: [&str; 2] = ["u", "v"];

/// A B-spline surface, or a NURBS surface if the key is `nurbs`. Fails if the counts of points, knots and weights do not
/// fit, if knots descend or leave no surface between them, or if a weight is not above 0.
pub(super) fn nurbs(value: Value) -> Result<Shape, LoadError> {
    let has_weights = value.key == "nurbs";
    let table = match has_weights {
        true => value.table(&["rows", "weights", "degree", "knots", "steps"])?,
        false => value.table(&["rows", "degree", "knots", "steps"])?,
    };
    let list = table.need("rows", "[[[0, 0, 0], [1, 0, 0]], [[0, 1, 0], [1, 1, 0]]]")?;
    let rows = net(list, "points", Value::vector)?;
    let [n_columns, n_rows] = [rows[0].len(), rows.len()];
    if rows.concat().iter().all(|point| *point == rows[0][0]) {
        return Err(list.error("all points of the net are the same, so no ray can hit the surface"));
    }
    let weights = match has_weights {
        true => weights(&table, n_columns, n_rows)?,
        false => vec![vec![1.0; n_columns]; n_rows],
    };
    let degrees = degrees(&table)?;
    let counts = [n_columns, n_rows];
    for axis in 0..2 {
        let (n, degree) = (counts[axis], degrees[axis]);
        if n <= degree {
            let message = format!(
                "{} has {n} points along {}, and degree {degree} needs {}",
                list.name(),
                NAMES[axis],
                degree + 1
            );
            return Err(list.error(message).help("add points, or write a smaller `degree`"));
        }
    }
    let patch = NurbsPatch { knots: knots(&table, counts, degrees)?, degrees, rows, weights };
    // Set the memory for the triangles aside before any is made.
    let steps = table.get("steps").map_or(Ok(8), |steps| steps.whole(1..=1024))?;
    let squares: u64 = [0, 1].map(|axis| patch.spans(axis).len() as u64 * u64::from(steps)).iter().product();
    let place = table.get("steps").unwrap_or(value);
    value.source.budget.triangles(|why| place.error(why), 2 * squares)?;
    Ok(Shape::Nurbs { patch: Box::new(patch), steps })
}

/// The weights of all control points.
fn weights(table: &Table, n_columns: usize, n_rows: usize) -> Result<Vec<Vec<f32>>, LoadError> {
    let list = table.need("weights", "[[1, 1], [1, 1]]")?;
    let weights = net(list, "weights", Value::positive)?;
    if [weights[0].len(), weights.len()] != [n_columns, n_rows] {
        let message = format!(
            "{} has {} rows of {}, but `rows` has {n_rows} rows of {n_columns}",
            list.name(),
            weights.len(),
            weights[0].len()
        );
        return Err(list.error(message).help("give one weight for each point"));
    }
    Ok(weights)
}

/// A list of rows of the same length, none of them empty; `what` names the entries in messages.
fn net<'a, T>(
    list: Value<'a>,
    what: &str,
    entry: fn(&Value<'a>) -> Result<T, LoadError>,
) -> Result<Vec<Vec<T>>, LoadError> {
    let wanted = format!("a list of rows of {what}");
    let mut rows: Vec<Vec<T>> = Vec::new();
    for row in list.list(&wanted)? {
        let entries = row.list(&format!("a list of {what}"))?;
        if let Some(first) = rows.first().filter(|first| first.len() != entries.len()) {
            let message =
                format!("{} has {} {what}, but the first has {}", row.name(), entries.len(), first.len());
            return Err(row.error(message).help("all rows need the same number"));
        }
        rows.push(entries.iter().map(entry).collect::<Result<_, _>>()?);
    }
    match rows.first().is_none_or(Vec::is_empty) {
        true => Err(list.error(format!("{} has no {what}", list.name()))),
        false => Ok(rows),
    }
}

/// The degrees along u and v: one number for both, or two.
fn degrees(table: &Table) -> Result<[usize; 2], LoadError> {
    let Some(value) = table.get("degree") else { return Ok([3, 3]) };
    let Ok(items) = value.list("") else { return Ok([value.whole(DEGREES)? as usize; 2]) };
    match items[..] {
        [u, v] => Ok([u.whole(DEGREES)? as usize, v.whole(DEGREES)? as usize]),
        _ => Err(value.wrong("a whole number from 1 to 7, or two of them: along u and along v")),
    }
}

/// The knots along u and v. By default they are 0, 1, 2 … with the ends repeated, so that the surface passes through the
/// corners of its net.
fn knots(table: &Table, counts: [usize; 2], degrees: [usize; 2]) -> Result<[Vec<f32>; 2], LoadError> {
    let Some(value) = table.get("knots") else {
        return Ok([0, 1].map(|axis| clamped(counts[axis], degrees[axis])));
    };
    let lists = value.list_of(2, "two lists of knots: along u and along v")?;
    let read = |axis: usize| read_knots(lists[axis], NAMES[axis], counts[axis], degrees[axis]);
    Ok([read(0)?, read(1)?])
}

fn clamped(n_points: usize, degree: usize) -> Vec<f32> {
    let last = n_points - degree;
    (0..n_points + degree + 1).map(|knot| knot.saturating_sub(degree).min(last) as f32).collect()
}

/// The knots in one direction. Fails where the knots are too few or too many, descend, or leave the surface in pieces.
fn read_knots(list: Value, along: &str, n_points: usize, degree: usize) -> Result<Vec<f32>, LoadError> {
    let items = list.list("a list of knots")?;
    let n_knots = n_points + degree + 1;
    if items.len() != n_knots {
        let message = format!(
            "{n_knots} knots are needed along {along} ({n_points} points + degree {degree} + 1), but there are {}",
            items.len()
        );
        return Err(list.error(message));
    }
    let knots: Vec<f32> = items.iter().map(Value::number).collect::<Result<_, _>>()?;
    if let Some(index) = (1..n_knots).find(|&index| knots[index] < knots[index - 1]) {
        let message = format!(
            "knot {} along {along} is {}, which is below the knot before it, {}",
            index + 1,
            knots[index],
            knots[index - 1]
        );
        return Err(items[index]
            .error(message)
            .help("list the knots in ascending order; equal ones are allowed"));
    }
    if !(knots[n_knots - 1] - knots[0]).is_finite() {
        return Err(
            list.error(format!("the knots along {along} differ by more than the largest number, 3.4e38"))
        );
    }
    // A knot that occurs more often than the degree divides the surface; at an end it may occur once more.
    let mut start = 0;
    for group in knots.chunk_by(|first, second| first == second) {
        let is_end = start == 0 || start + group.len() == n_knots;
        let most = degree + usize::from(is_end);
        if group.len() > most {
            let place = if is_end { "at an end" } else { "between the ends" };
            let message = format!(
                "the knot {} along {along} occurs {} times; {place} a knot of degree {degree} may occur {most} times",
                group[0],
                group.len()
            );
            return Err(items[start + most].error(message));
        }
        start += group.len();
    }
    if knots[degree] == knots[n_points] {
        let message = format!(
            "the surface is empty: it extends along {along} from knot {} to knot {}, which are equal",
            degree + 1,
            n_points + 1
        );
        return Err(list.error(message));
    }
    Ok(knots)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn default_knots_repeat_the_ends() {
        assert_eq!(clamped(4, 3), [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0]);
        assert_eq!(clamped(5, 2), [0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0]);
        assert_eq!(clamped(3, 1), [0.0, 0.0, 1.0, 2.0, 2.0]);
    }
}
