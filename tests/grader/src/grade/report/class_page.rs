//! `index.html`: the overview of the class for the instructor. Printed, it is one sheet that the class may see, without names.

use super::line::Line;
use super::page::{page, session_line, with_code};
use super::tally::{self, Tally};
use super::{chart, student_list};
use crate::grade::result::{Outcome, Session};
use maud::{Markup, html};

/// Number of listed checks that fail most often, and of listed slow submissions.
const N_WORST: usize = 10;

/// Number of links to submissions in a list of problems.
const N_LINKS: usize = 200;

/// Returns the page as HTML.
pub(super) fn class_page(session: &Session, lines: &[Line], tallies: &[Tally]) -> String {
    let points: Vec<u32> = lines.iter().map(|line| line.points).collect();
    let body = html! {
        header {
            h1 { "The class" }
            (session_line(session))
        }
        nav {
            a href="#reteach" { "Most failed checks" }
            a href="#look" { "Problems" }
            a href="#stages" { "Checks" }
            a href="#slowest" { "Slowest" }
            a href="#students" { "Students" }
        }
        (numbers(lines, tallies))
        section {
            h2 { "Points" }
            @if !points.is_empty() { (chart::histogram(&points, tally::of(tallies))) }
        }
        (worst(tallies))
        (to_look_at(lines))
        (stages(tallies))
        (slowest(lines))
        section #students.screen {
            h2 { "Students" }
            (student_list::list(lines, tallies))
        }
    };
    page("The class · Raykata", &body)
}

fn numbers(lines: &[Line], tallies: &[Tally]) -> Markup {
    let of = tally::of(tallies);
    let full = lines.iter().filter(|line| line.n_checks > 0 && line.points == of);
    let troubled = lines.iter().filter(|line| !line.trouble.is_empty());
    html! {
        dl.numbers {
            div { dt { "submissions" } dd { (lines.len()) } }
            div { dt { "points, median" } dd { (tally::median(lines)) small { " of " (of) } } }
            div { dt { "points, mean" } dd { (format!("{:.1}", tally::mean(lines))) small { " of " (of) } } }
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
                                td.slide { (tally.entry.taught()) }
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

fn to_look_at(lines: &[Line]) -> Markup {
    let kinds = [
        (Outcome::DoesNotCompile, "A file does not compile"),
        (Outcome::Refused, "A file was refused by the syntax check"),
        (Outcome::Crashed, "A check crashed"),
        (Outcome::TooLong, "A check took too long"),
        (Outcome::NotTried, "The submission used up its time"),
    ];
    let troubled: Vec<&Line> = lines.iter().filter(|line| !line.trouble.is_empty()).collect();
    let kinds = kinds.map(|(outcome, words)| {
        let such: Vec<&Line> = lines.iter().filter(|line| line.has(outcome)).collect();
        (words, such)
    });
    let late: Vec<&Line> = lines.iter().filter(|line| !line.late.is_empty()).collect();
    html! {
        section #look.screen {
            h2 { "Problems" }
            @if troubled.is_empty() && late.is_empty() && kinds.iter().all(|(_, such)| such.is_empty()) {
                p { "None: every submission compiles and answers." }
            }
            @if !troubled.is_empty() {
                h3 { "Could not be graded " small { (troubled.len()) } }
                ul { @for line in troubled.iter().take(N_LINKS) { li { (student_list::link("", line)) ": " (line.trouble) } } }
                (more(troubled.len(), "grades.csv"))
            }
            @if !late.is_empty() {
                h3 { "Handed in late " small { (late.len()) } }
                p.links { @for line in late.iter().take(N_LINKS) { (student_list::link("", line)) " " } }
                (more(late.len(), "grades.csv"))
            }
            @for (words, such) in kinds.iter().filter(|(_, such)| !such.is_empty()) {
                h3 { (words) " " small { (such.len()) } }
                p.links { @for line in such.iter().take(N_LINKS) { (student_list::link("", line)) " " } }
                (more(such.len(), "checks.csv"))
            }
        }
    }
}

/// Says where the rest of a long list is.
fn more(n: usize, table: &str) -> Markup {
    html! { @if n > N_LINKS { p.note { (n - N_LINKS) " more are in " (table) "." } } }
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
                                td.number { (tally.points) " " (tally.entry.level().word()) }
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

fn slowest(lines: &[Line]) -> Markup {
    let mut slowest: Vec<&Line> = lines.iter().collect();
    slowest.sort_by_key(|line| std::cmp::Reverse(line.cpu_ms));
    html! {
        section #slowest.screen {
            h2 { "Slowest" }
            p.note { "Time of the build and the checks. Only this part of the page differs from run to run." }
            table.plain {
                thead { tr { th { "student" } th.number { "seconds" } } }
                tbody {
                    @for line in slowest.iter().take(N_WORST) {
                        tr {
                            td { (student_list::link("", line)) }
                            td.number { (format!("{}.{}", line.cpu_ms / 1000, line.cpu_ms / 100 % 10)) }
                        }
                    }
                }
            }
        }
    }
}
