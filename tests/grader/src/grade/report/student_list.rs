//! The list of all students. In a large class it is divided into pages, because a browser needs seconds for a table of thousands
//! of rows.

use super::line::Line;
use super::page::page;
use super::tally::{self, Tally};
use maud::{Markup, html};

/// Most rows of a page.
pub(super) const ROWS: usize = 1000;

/// Returns the list for the overview of the class: the table, or links to its pages.
pub(super) fn list(lines: &[Line], tallies: &[Tally]) -> Markup {
    if lines.len() <= ROWS {
        return table(lines, tallies, "");
    }
    html! {
        p.note { "All students are in grades.csv, and in these pages of " (ROWS) ":" }
        ul {
            @for (number, lines) in (1..).zip(lines.chunks(ROWS)) {
                li { a href=(file_name(number)) { (ends(lines)) } }
            }
        }
    }
}

/// Returns the pages of the list with their file names; none if the table fits into the overview.
pub(super) fn pages(lines: &[Line], tallies: &[Tally]) -> impl Iterator<Item = (String, String)> {
    let n_pages = if lines.len() <= ROWS { 0 } else { lines.len().div_ceil(ROWS) };
    (1..=n_pages).zip(lines.chunks(ROWS)).map(move |(number, lines)| {
        let body = html! {
            header {
                h1 { "Students: " (ends(lines)) }
                p.session { "Page " (number) " of " (n_pages) }
            }
            nav {
                a href="../index.html" { "The class" }
                @if number > 1 { a href=(format!("{}.html", number - 1)) { "Page before" } }
                @if number < n_pages { a href=(format!("{}.html", number + 1)) { "Next page" } }
            }
            section { (table(lines, tallies, "../")) }
        };
        (file_name(number), page("Students · Raykata", &body))
    })
}

fn file_name(number: usize) -> String {
    format!("lists/{number}.html")
}

/// Returns the names of the first and the last student.
fn ends(lines: &[Line]) -> String {
    let name = |line: Option<&Line>| line.map_or("", shown).to_owned();
    format!("{} – {}", name(lines.first()), name(lines.last()))
}

/// Returns the table. `to_class` leads from the page to the folder of the class.
fn table(lines: &[Line], tallies: &[Tally], to_class: &str) -> Markup {
    let stages = tally::stages(tallies);
    let of_stage = |stage| tally::of(tallies.iter().filter(|tally| tally.stage == stage));
    let has_bonus = tally::has_bonus(tallies);
    html! {
        div.scroll {
            table.plain {
                thead {
                    tr {
                        th { "student" }
                        th.number { "points" div.note { "of " (tally::of(tallies)) } }
                        th.number { "core" div.note { "of " (tally::of_core(tallies)) } }
                        @if has_bonus { th.number { "bonus" } }
                        @for &stage in &stages {
                            th.number { "stage " (stage) div.note { "of " (of_stage(stage)) } }
                        }
                        th.number { "remarks" }
                    }
                }
                tbody {
                    @for line in lines {
                        tr {
                            td.student { (link(to_class, line)) @if !line.trouble.is_empty() { " " span.badge.crashed { "not gradable" } } }
                            td.number {
                                b { (line.points) }
                                div.note { (tally::percent(line.points, tally::of(tallies))) " %" }
                            }
                            td.number { (line.core) }
                            @if has_bonus { td.number { (line.bonus) } }
                            @for &stage in &stages {
                                td.number { (line.of_stage(stage)) }
                            }
                            td.number { @if line.n_remarks > 0 { (line.n_remarks) } }
                        }
                    }
                }
            }
        }
    }
}

/// Returns a link to the page of a student. `to_class` leads to the folder of the class; it is empty in the overview.
pub(super) fn link(to_class: &str, line: &Line) -> Markup {
    html! { a href={ (to_class) "students/" (line.page) ".html" } { (shown(line)) } }
}

fn shown(line: &Line) -> &str {
    if line.student.is_empty() { "(no name)" } else { &line.student }
}
