//! The table, with the best value of each column marked; and the same numbers as JSON.

use super::measure::Measured;
use crate::args::wrapped;
use crate::report::{Bytes, Thousands};

/// A column: its head, its width, its numbers and their format. Smaller is better in all columns.
struct Column {
    head: &'static str,
    width: usize,
    value: fn(&Measured) -> Option<f64>,
    write: fn(f64) -> String,
    /// Whether the smallest number is marked.
    contest: bool,
}

fn a_ray(one: &Measured, n: u64) -> Option<f64> {
    Some(n as f64 / one.rays.max(1) as f64)
}

/// A column whose smallest number is marked.
const fn contest(
    head: &'static str,
    width: usize,
    value: fn(&Measured) -> Option<f64>,
    write: fn(f64) -> String,
) -> Column {
    Column { head, width, value, write, contest: true }
}

/// A column without a mark.
const fn plain(
    head: &'static str,
    width: usize,
    value: fn(&Measured) -> Option<f64>,
    write: fn(f64) -> String,
) -> Column {
    Column { head, width, value, write, contest: false }
}

/// Together with the names they take 80 columns.
const COLUMNS: [Column; 7] = [
    contest("build s", 7, |one| one.size.map(|_| one.build_seconds), |x| format!("{x:.3}")),
    contest("memory", 8, |one| one.size.map(|_| one.bytes as f64), |x| Bytes(x as u64).to_string()),
    plain("nodes", 9, |one| one.size.map(|size| size.nodes as f64), |x| Thousands(x as u64).to_string()),
    plain("visits", 7, |one| a_ray(one, one.counts.node_visits), per_ray),
    plain("boxes", 7, |one| a_ray(one, one.counts.box_tests), per_ray),
    contest("tests", 7, |one| a_ray(one, one.counts.primitive_tests), per_ray),
    contest("ns/ray", 7, |one| Some(one.nanoseconds), |x| Thousands(x as u64).to_string()),
];

/// The width of the column of names. A longer name has a line of its own.
const NAMES: usize = 21;

/// A mean per ray, with a tenth where it is small.
fn per_ray(x: f64) -> String {
    if x < 1000.0 { format!("{x:.1}") } else { Thousands(x as u64).to_string() }
}

/// Prints the table.
pub fn print(title: &str, rows: &[Measured]) {
    println!("{title}");
    let heads: String =
        COLUMNS.iter().map(|column| format!("{:>width$} ", column.head, width = column.width)).collect();
    println!("{:NAMES$}{}", "", heads.trim_end());
    for row in rows {
        let cells: String = COLUMNS.iter().map(|column| cell(column, row, rows)).collect();
        let name = if row.name.chars().count() > NAMES {
            println!("{}", row.name);
            ""
        } else {
            &row.name
        };
        println!("{name:NAMES$}{}", cells.trim_end());
    }
    println!("* smallest of its column. visits: nodes or cells that a ray visits; boxes and");
    println!("tests: of boxes and of primitives per ray; ns/ray: on all threads together,");
    println!("median of rounds");
    let list = |kept: &dyn Fn(&Measured) -> Option<String>| {
        let named = rows.iter().filter_map(|row| Some(format!("{} ({})", row.name, kept(row)?)));
        named.collect::<Vec<String>>().join(", ")
    };
    let sliced = list(&|row| (row.slice > 1).then(|| format!("1/{}", row.slice)));
    if !sliced.is_empty() {
        let text = format!("with fewer columns and rows, because the whole picture takes too long: {sliced}");
        println!("{}", wrapped(&text, 2));
    }
    let off = list(&|row| {
        let pixels = Thousands(row.different_pixels);
        (row.different_pixels > 0).then(|| format!("{pixels}, by at most {:.2e}", row.largest_difference))
    });
    let off = if off.is_empty() {
        "all pictures are the same, bit by bit".to_owned()
    } else {
        format!("pixels that differ from those of the hierarchy by surface area: {off}")
    };
    println!("{}", wrapped(&off, 2));
    let mut notes: Vec<&String> = rows.iter().flat_map(|row| &row.notes).collect();
    notes.sort();
    notes.dedup();
    for note in notes {
        println!("{}", wrapped(&format!("note: {note}"), 2));
    }
}

fn cell(column: &Column, row: &Measured, rows: &[Measured]) -> String {
    let width = column.width;
    let Some(value) = (column.value)(row) else { return format!("{:>width$} ", "–") };
    let least = rows.iter().filter_map(column.value).fold(f64::INFINITY, f64::min);
    let wins = column.contest && rows.len() > 1 && value == least;
    format!("{:>width$}{}", (column.write)(value), if wins { '*' } else { ' ' })
}
