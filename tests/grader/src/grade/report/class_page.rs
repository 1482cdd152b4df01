//! `index.html`: the overview of the class for the instructor. Printed, it is one sheet that the class may see, without names.

use super::chart;
use super::page::{page, session_line, with_code};
use super::tally::{self, Tally};
use crate::grade::result::{Class, Graded, Outcome, sum};
use maud::{Markup, html};

/// Number of listed checks that fail most often, and of listed slow submissions.
const N_WORST: usize = 10;

/// Returns the page as HTML. `pages` are the file names of the students' pages.
pub(super) fn class_page(class: &Class, tallies: &[Tally], pages: &[String]) -> String {
    let students: Vec<(&Graded, &str)> =
        class.students.iter().zip(pages.iter().map(String::as_str)).collect();
    let points: Vec<u32> = class.students.iter().map(|student| student.points().0).collect();
    let body = html! {
        header {
            h1 { "The class" }
            (session_line(&class.session))
        }
        nav {
            a href="#reteach" { "Most failed checks" }
            a href="#look" { "Problems" }
            a href="#stages" { "Checks" }
            a href="#slowest" { "Slowest" }
            a href="#students" { "Students" }
        }
        (numbers(class, tallies))
        section {
            h2 { "Points" }
            @if !points.is_empty() { (chart::histogram(&points, tally::of(tallies))) }
        }
        (worst(tallies))
        (to_look_at(&students))
        (stages(tallies))
        (slowest(&students))
        (all(&students, tallies))
    };
    page("The class · Raykata", &body)
}

fn numbers(class: &Class, tallies: &[Tally]) -> Markup {
    let of = tally::of(tallies);
    let full = class.students.iter().filter(|student| !student.checks.is_empty() && student.points().0 == of);
    let troubled = class.students.iter().filter(|student| !student.trouble.is_empty());
    html! {
        dl.numbers {
            div { dt { "submissions" } dd { (class.students.len()) } }
            div { dt { "points, median" } dd { (tally::median(class)) small { " of " (of) } } }
            div { dt { "points, mean" } dd { (format!("{:.1}", tally::mean(class))) small { " of " (of) } } }
            div { dt { "all points" } dd { (full.count()) } }
            div { dt { "not gradable" } dd { (troubled.count()) } }
        }
    }
}

fn worst(tallies: &[Tally]) -> Markup {
    let worst = tally::worst(tallies, N_WORST);
    html! {
        section #reteach {
            h2 { "Most failed checks" }
            @if worst.is_empty() {
                p { "No submission tried a check and failed." }
            } @else {
                p.note { "The checks that most submissions tried and failed, with their slides in the lecture." }
                table.checks {
                    thead { tr { th { "check" } th { "slide" } th.number { "fail" } th.number { "pass" } th.wide { "outcomes" } } }
                    tbody {
                        @for tally in worst {
                            tr {
                                td { "Stage " (tally.stage) ": " (with_code(&tally.entry.title)) div.name { (tally.name) } }
                                td.slide { (tally.entry.slide) }
                                td.number { (tally.tried_in_vain()) span.unit { " fail" } }
                                td.number { (tally.passed()) " of " (tally.of()) span.unit { " pass" } }
                                td.wide { (chart::outcomes(tally)) (failures(tally)) }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// Lists how often each outcome other than `passed` occurred.
fn failures(tally: &Tally) -> Markup {
    let words: Vec<String> = tally
        .outcomes()
        .filter(|(outcome, _)| *outcome != Outcome::Passed)
        .map(|(outcome, n)| format!("{n} {}", outcome.words()))
        .collect();
    html! { div.note { (words.join(" · ")) } }
}

fn to_look_at(students: &[(&Graded, &str)]) -> Markup {
    let kinds = [
        (Outcome::DoesNotCompile, "A file does not compile"),
        (Outcome::Refused, "A file was refused by the syntax check"),
        (Outcome::Crashed, "A check crashed"),
        (Outcome::TooLong, "A check took too long"),
        (Outcome::NotTried, "The submission used up its time"),
    ];
    let troubled: Vec<_> = students.iter().filter(|(student, _)| !student.trouble.is_empty()).collect();
    let kinds = kinds.map(|(outcome, words)| {
        let such: Vec<_> = students.iter().filter(|(student, _)| tally::has(student, outcome)).collect();
        (words, such)
    });
    html! {
        section #look.screen {
            h2 { "Problems" }
            @if troubled.is_empty() && kinds.iter().all(|(_, such)| such.is_empty()) {
                p { "None: every submission compiles and answers." }
            }
            @if !troubled.is_empty() {
                h3 { "Could not be graded " small { (troubled.len()) } }
                ul { @for (student, name) in troubled { li { (link(student, name)) ": " (student.trouble) } } }
            }
            @for (words, such) in kinds.iter().filter(|(_, such)| !such.is_empty()) {
                h3 { (words) " " small { (such.len()) } }
                p.links { @for (student, name) in such { (link(student, name)) " " } }
            }
        }
    }
}

fn stages(tallies: &[Tally]) -> Markup {
    html! {
        section #stages.screen {
            h2 { "Checks" }
            (chart::legend())
            @for stage in tally::stages(tallies) {
                h3 { (tally::stage_title(stage)) }
                table.checks {
                    thead { tr { th { "check" } th.number { "points" } th.number { "pass" } th.wide { "outcomes" } } }
                    tbody {
                        @for tally in tallies.iter().filter(|tally| tally.stage == stage) {
                            tr {
                                td { (with_code(&tally.entry.title)) div.name { (tally.name) } }
                                td.number { (tally.points) span.unit { " points" } }
                                td.number { (tally.passed()) " of " (tally.of()) span.unit { " pass" } }
                                td.wide { (chart::outcomes(tally)) (failures(tally)) }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn slowest(students: &[(&Graded, &str)]) -> Markup {
    let mut slowest = students.to_vec();
    slowest.sort_by_key(|(student, _)| std::cmp::Reverse(student.cpu_ms));
    html! {
        section #slowest.screen {
            h2 { "Slowest" }
            p.note { "Time of the build and the checks. Only this part of the page differs from run to run." }
            table.plain {
                thead { tr { th { "student" } th.number { "seconds" } } }
                tbody {
                    @for (student, name) in slowest.iter().take(N_WORST) {
                        tr {
                            td { (link(student, name)) }
                            td.number { (format!("{}.{}", student.cpu_ms / 1000, student.cpu_ms / 100 % 10)) }
                        }
                    }
                }
            }
        }
    }
}

fn all(students: &[(&Graded, &str)], tallies: &[Tally]) -> Markup {
    let stages = tally::stages(tallies);
    let of_stage =
        |stage| tallies.iter().filter(|tally| tally.stage == stage).map(|tally| tally.points).sum::<u32>();
    html! {
        section #students.screen {
            h2 { "Students" }
            div.scroll {
                table.plain {
                    thead {
                        tr {
                            th { "student" }
                            th.number { "points" div.note { "of " (tally::of(tallies)) } }
                            @for &stage in &stages {
                                th.number { "stage " (stage) div.note { "of " (of_stage(stage)) } }
                            }
                            th.number { "remarks" }
                        }
                    }
                    tbody {
                        @for (student, name) in students {
                            tr {
                                td.student { (link(student, name)) @if !student.trouble.is_empty() { " " span.badge.crashed { "not gradable" } } }
                                td.number {
                                    b { (student.points().0) }
                                    div.note { (tally::percent(student.points().0, tally::of(tallies))) " %" }
                                }
                                @for &stage in &stages {
                                    td.number { (sum(student.of_stage(stage)).0) }
                                }
                                td.number { @if !student.remarks.is_empty() { (student.remarks.len()) } }
                            }
                        }
                    }
                }
            }
        }
    }
}

fn link(student: &Graded, name: &str) -> Markup {
    let shown = if student.student.is_empty() { "(no name)" } else { &student.student };
    html! { a href={ "students/" (name) ".html" } { (shown) } }
}
