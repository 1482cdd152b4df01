//! The table, with the best value of each column marked; and the same numbers as JSON.

use super::measure::Measured;
use crate::report::{Bytes, Thousands};
use anyhow::{Context, Result};
use std::path::Path;

/// A column: its head, its numbers and their format. Smaller is better in all columns.
struct Column {
    head: &'static str,
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
    value: fn(&Measured) -> Option<f64>,
    write: fn(f64) -> String,
) -> Column {
    Column { head, value, write, contest: true }
}

/// A column without a mark.
const fn plain(head: &'static str, value: fn(&Measured) -> Option<f64>, write: fn(f64) -> String) -> Column {
    Column { head, value, write, contest: false }
}

const COLUMNS: [Column; 8] = [
    contest("build s", |one| one.size.map(|_| one.build_seconds), |x| format!("{x:.3}")),
    contest("memory", |one| one.size.map(|_| one.bytes as f64), |x| Bytes(x as u64).to_string()),
    plain("nodes", |one| one.size.map(|size| size.nodes as f64), |x| Thousands(x as u64).to_string()),
    plain("visits/ray", |one| a_ray(one, one.counts.node_visits), |x| format!("{x:.2}")),
    plain("boxes/ray", |one| a_ray(one, one.counts.box_tests), |x| format!("{x:.2}")),
    contest("prims/ray", |one| a_ray(one, one.counts.primitive_tests), |x| format!("{x:.2}")),
    contest("ns/ray", |one| Some(one.nanoseconds), |x| format!("{x:.0}")),
    plain("±", |one| Some(100.0 * one.spread), |x| format!("{x:.0} %")),
];

/// Prints the table.
pub fn print(title: &str, rows: &[Measured]) {
    println!("{title}");
    let width = rows.iter().map(|row| row.name.chars().count()).max().unwrap_or_default().max(12);
    let heads: String = COLUMNS.iter().map(|column| format!("{:>12} ", column.head)).collect();
    println!("{:<width$}{heads}{:>10}", "", "pixels off");
    for row in rows {
        let cells: String = COLUMNS.iter().map(|column| cell(column, row, rows)).collect();
        let off = Thousands(row.different_pixels);
        let slice = if row.slice > 1 { format!("  1/{}", row.slice) } else { String::new() };
        println!("{:<width$}{cells}{off:>10}{slice}", row.name);
    }
    println!(
        "* smallest of its column; visits: nodes or cells that were visited; ns: on all threads together, \
         median of rounds;\npixels off: pixels that differ from those of the hierarchy by surface area"
    );
    if rows.iter().any(|row| row.slice > 1) {
        println!("1/n: with an n-th of the columns and rows, because the whole picture would take too long");
    }
    let mut notes: Vec<&String> = rows.iter().flat_map(|row| &row.notes).collect();
    notes.sort();
    notes.dedup();
    for note in notes {
        println!("note: {note}");
    }
}

fn cell(column: &Column, row: &Measured, rows: &[Measured]) -> String {
    let Some(value) = (column.value)(row) else { return format!("{:>12} ", "–") };
    let least = rows.iter().filter_map(column.value).fold(f64::INFINITY, f64::min);
    let wins = column.contest && rows.len() > 1 && value == least;
    format!("{:>12}{}", (column.write)(value), if wins { '*' } else { ' ' })
}

/// Writes all numbers.
pub fn write_json(file: &Path, rows: &[Measured]) -> Result<()> {
    let text = serde_json::to_string_pretty(rows)?;
    raykata::film::write_atomically(file, |out| std::io::Write::write_all(out, text.as_bytes()))
        .with_context(|| format!("cannot write {}", file.display()))
}
