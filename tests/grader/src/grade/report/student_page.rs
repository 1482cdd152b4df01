//! `students/NAME.html`: the report for one student.

use super::chart;
use super::page::{page, session_line, with_code};
use super::{messages, tally};
use crate::grade::result::{CheckResult, Graded, Outcome, Picture, Session, score};
use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use checks::rubric::Level;
use maud::{Markup, html};

/// Returns the page of a student as HTML.
pub(super) fn student_page(graded: &Graded, session: &Session) -> String {
    let (earned, of) = (graded.earned(), graded.score().points().1);
    let body = html! {
        header {
            h1.student { (graded.student) }
            @if !graded.checks.is_empty() { p.points { b { (earned) } " of " (of) " points (" (tally::percent(earned, of)) " %): " (graded.score()) } }
            @if let Some(note) = messages::note(graded) { p.points { (note) } }
            (session_line(session))
        }
        @if !graded.trouble.is_empty() {
            section.alarm { h2 { "This submission could not be graded" } p { (graded.trouble) } }
        }
        @let late = messages::late(graded, session);
        @if !late.is_empty() {
            section { h2 { "Late" } ul { @for line in &late { li { (line) "." } } } p.note { "The points are as if it was in time." } }
        }
        (blocked(graded))
        (overview(graded))
        (remarks(graded))
        @if !graded.compiler.is_empty() {
            section { h2 { "Compiler messages" } pre { (graded.compiler) } }
        }
        @for stage in graded.stages() { (stage_section(graded, stage)) }
    };
    page(&format!("{} · Raykata", graded.student), &body)
}

/// Names the files of which no check could be judged, with the reason.
fn blocked(graded: &Graded) -> Markup {
    let is_blocked =
        |check: &&CheckResult| matches!(check.outcome, Outcome::Refused | Outcome::DoesNotCompile);
    let mut reasons: Vec<(Outcome, String, u32)> = Vec::new();
    for check in graded.checks.iter().filter(is_blocked) {
        let reason = messages::message_without_header(check);
        match reasons.iter_mut().find(|(outcome, other, _)| *outcome == check.outcome && *other == reason) {
            Some((.., points)) => *points += counted(check),
            None => reasons.push((check.outcome, reason, counted(check))),
        }
    }
    html! {
        @for (outcome, reason, points) in reasons {
            section.alarm {
                @let kind = if outcome == Outcome::Refused { "Refused" } else { "Does not compile" };
                h2 { (kind) ": " (points) " points could not be graded" }
                pre { (reason) }
            }
        }
    }
}

/// Returns the points of a check, or 0 for bonus points.
fn counted(check: &CheckResult) -> u32 {
    if check.level == Level::Bonus { 0 } else { check.points }
}

fn overview(graded: &Graded) -> Markup {
    html! {
        @if !graded.checks.is_empty() {
            table.plain.overview {
                tbody {
                    @for stage in graded.stages() {
                        @let score = score(graded.of_stage(stage));
                        @let (earned, of) = score.points();
                        tr {
                            td { a href={ "#stage" (stage) } { (tally::stage_title(stage)) } }
                            td.number { (score) }
                            td.wide { (chart::share(earned, of)) }
                        }
                    }
                }
            }
        }
    }
}

fn remarks(graded: &Graded) -> Markup {
    html! {
        @if !graded.remarks.is_empty() {
            section {
                h2 { "Ignored or changed files" }
                ul { @for remark in &graded.remarks { li { code { (remark.file) } ": " (remark.what) } } }
            }
        }
    }
}

fn stage_section(graded: &Graded, stage: u8) -> Markup {
    let passed: Vec<&CheckResult> =
        graded.of_stage(stage).filter(|check| check.outcome == Outcome::Passed).collect();
    html! {
        section id={ "stage" (stage) } {
            h2 { (tally::stage_title(stage)) }
            @for group in groups(graded.of_stage(stage)) { (card(&group)) }
            @if !passed.is_empty() {
                details open[passed.len() == graded.of_stage(stage).count()] {
                    summary { span.badge.passed { "passed" } " " (passed.len()) @if passed.len() == 1 { " check" } @else { " checks" } }
                    ul { @for check in passed { li { (heading(check)) } } }
                }
            }
        }
    }
}

/// Groups the checks that did not pass. Checks with the same outcome and message form one group if no answer was judged,
/// for example because the file does not compile.
fn groups<'a>(checks: impl Iterator<Item = &'a CheckResult>) -> Vec<Vec<&'a CheckResult>> {
    let mut groups: Vec<Vec<&CheckResult>> = Vec::new();
    for check in checks.filter(|check| check.outcome != Outcome::Passed) {
        let same = |group: &&mut Vec<&CheckResult>| {
            let first = group[0];
            let no_answer = !matches!(check.outcome, Outcome::Wrong | Outcome::TooLong | Outcome::Crashed);
            no_answer
                && first.outcome == check.outcome
                && messages::message_without_header(first) == messages::message_without_header(check)
        };
        match groups.iter_mut().find(same) {
            Some(group) => group.push(check),
            None => groups.push(vec![check]),
        }
    }
    groups
}

fn card(group: &[&CheckResult]) -> Markup {
    let first = group[0];
    html! {
        article {
            p.kind {
                span class={ "badge " (chart::class(first.outcome)) } { (first.outcome.words()) }
                @if group.len() > 1 { " " (group.len()) " checks" }
            }
            @for check in group { (failed(check, group.len() == 1)) }
            pre { (messages::message_without_header(first)) }
            @if let Some(picture) = first.picture.as_ref().filter(|_| first.outcome != Outcome::WrongOnHidden) { (figure(picture)) }
        }
    }
}

/// Shows a check that did not pass: its title, its slides, and a hint if it is the only one of its group.
fn failed(check: &CheckResult, alone: bool) -> Markup {
    let entry = messages::entry(check);
    html! {
        h3 { (heading(check)) }
        @if !entry.slide.is_empty() { p.slide { "Slides: " (entry.taught()) } }
        @if alone && !entry.hints[0].is_empty() { details { summary { "Hint" } p { (with_code(&entry.hints[0])) } } }
    }
}

fn heading(check: &CheckResult) -> Markup {
    html! {
        span.worth { (check.earned) " of " (check.points) " " (check.level.word()) }
        (with_code(&messages::entry(check).title)) " " span.name { (check.name) }
    }
}

/// Embeds a picture in the page if its data is valid.
fn figure(picture: &Picture) -> Markup {
    let is_png = BASE64.decode(&picture.png).is_ok_and(|bytes| bytes.starts_with(b"\x89PNG\r\n\x1a\n"));
    html! {
        @if is_png {
            figure {
                img src={ "data:image/png;base64," (picture.png) } alt=(picture.caption);
                figcaption { (picture.caption) }
            }
        }
    }
}
