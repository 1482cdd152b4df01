//! The table, with the best value of each column marked.

use super::measure::Measured;
use crate::args::wrapped;
use crate::columns::Columns;
use crate::report::{Bytes, Thousands};
use std::collections::BTreeSet;

/// A column of numbers: its head, its numbers, their format, and whether the smallest one is marked.
type Numbers = (&'static str, fn(&Measured) -> Option<f64>, fn(f64) -> String, bool);

/// The columns of numbers. Smaller is better in all of them.
const NUMBERS: [Numbers; 7] = [
    ("build s", |one| one.size.map(|_| one.build_seconds), |x| format!("{x:.3}"), true),
    ("memory", |one| one.size.map(|_| one.bytes as f64), |x| Bytes(x as u64).to_string(), true),
    ("nodes", |one| one.size.map(|size| size.nodes as f64), |x| Thousands(x as u64).to_string(), false),
    ("visits", |one| per_ray(one, one.counts.node_visits), with_tenths, false),
    ("boxes", |one| per_ray(one, one.counts.box_tests), with_tenths, false),
    ("tests", |one| per_ray(one, one.counts.primitive_tests), with_tenths, true),
    ("ns/ray", |one| Some(one.nanoseconds), |x| Thousands(x as u64).to_string(), true),
];

/// The names and the columns of numbers, whose last character is the mark. Together they take 80 columns.
const COLUMNS: Columns = Columns("", &[-(NAMES as isize), 8, 9, 10, 8, 8, 8, 8]);

/// The width of the column of names. A longer name has a line of its own.
const NAMES: usize = 21;

fn per_ray(one: &Measured, n: u64) -> Option<f64> {
    Some(n as f64 / one.rays.max(1) as f64)
}

/// A mean, with a tenth where it is small.
fn with_tenths(x: f64) -> String {
    if x < 1000.0 { format!("{x:.1}") } else { Thousands(x as u64).to_string() }
}

/// Prints the table.
pub fn print(title: &str, rows: &[Measured]) {
    println!("{title}");
    let line = |name: &str, numbers: [String; 7]| {
        let [a, b, c, d, e, f, g] = &numbers;
        println!("{}", COLUMNS.row(&[&name, a, b, c, d, e, f, g]).trim_end());
    };
    line("", NUMBERS.map(|(head, ..)| format!("{head} ")));
    for row in rows {
        let name = if row.name.chars().count() > NAMES {
            println!("{}", row.name);
            ""
        } else {
            &row.name
        };
        line(name, NUMBERS.map(|numbers| cell(numbers, row, rows)));
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
    for note in rows.iter().flat_map(|row| &row.notes).collect::<BTreeSet<_>>() {
        println!("{}", wrapped(&format!("note: {note}"), 2));
    }
}

/// A number and its mark.
fn cell((_, value, write, contest): Numbers, row: &Measured, rows: &[Measured]) -> String {
    let Some(own) = value(row) else { return "– ".to_owned() };
    let least = rows.iter().filter_map(value).fold(f64::INFINITY, f64::min);
    let wins = contest && rows.len() > 1 && own == least;
    write(own) + if wins { "*" } else { " " }
}
