//! The text about a check that a student reads. It is the same in every format.

use crate::grade::result::{self, CheckResult, Graded, Outcome, Session, in_words};
use checks::rubric::{self, CheckEntry};

/// Returns the rubric entry of a check.
pub fn entry(check: &CheckResult) -> CheckEntry {
    rubric::entry(check.stage, &check.name)
}

/// Returns why a check failed, without any hidden input. The text is empty for a passed check.
pub fn message(check: &CheckResult) -> String {
    let has_own = !matches!(check.outcome, Outcome::Passed | Outcome::WrongOnHidden);
    match check.message.trim_end() {
        message if has_own && !message.is_empty() => message.to_owned(),
        _ => in_a_sentence(check.outcome).to_owned(),
    }
}

/// Returns the same text without the lines that a page shows as headings.
pub fn message_without_header(check: &CheckResult) -> String {
    let text = message(check);
    match text.strip_prefix(&entry(check).header()) {
        // The lines below the header are indented.
        Some(rest) => {
            let lines: Vec<&str> = rest.lines().map(|line| line.strip_prefix("  ").unwrap_or(line)).collect();
            lines.join("\n")
        }
        None => text,
    }
}

/// Explains an outcome, for checks without a message of their own.
fn in_a_sentence(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Passed => "",
        Outcome::NotWritten => "not written yet: the function still contains `todo!`",
        Outcome::Wrong => "the answer is wrong",
        Outcome::WrongOnHidden => {
            "wrong on hidden inputs: right on the inputs that you have, wrong on others"
        }
        Outcome::Unproven => "right on known inputs; it counts when a check with hidden inputs passes",
        Outcome::TooLong => "no answer in time: look for a loop or a recursion that never ends",
        Outcome::Crashed => {
            "the program ended before it answered: it crashed, exited, or took too much memory"
        }
        Outcome::DoesNotCompile => "the file does not compile",
        Outcome::Refused => "the file was refused: it contains code that no exercise needs",
        Outcome::NotTried => "not tried: earlier checks used up the time of the submission",
    }
}

/// Counts per stage the checks that fail on hidden inputs only. Stages without such a check are left out.
pub fn failing_on_hidden(graded: &Graded) -> Vec<(u8, usize)> {
    let count =
        |stage| graded.of_stage(stage).filter(|check| check.outcome == Outcome::WrongOnHidden).count();
    graded.stages().into_iter().map(|stage| (stage, count(stage))).filter(|(_, n)| *n > 0).collect()
}

/// Says which stages were handed in late.
pub fn late(graded: &Graded, session: &Session) -> Vec<String> {
    let line = |(stage, by): (u8, String)| {
        let due = session.due.get(&stage).map_or("", String::as_str);
        format!("stage {stage} was handed in {by} late, at {}; it was due {due}", graded.handed_in)
    };
    graded.late(session).into_iter().map(line).collect()
}

/// What the instructor adds, as a sentence.
pub fn note(graded: &Graded) -> Option<String> {
    let note = graded.note.as_ref()?;
    let text = if note.text.is_empty() { String::new() } else { format!(": {}", note.text) };
    Some(match note.points {
        0 => format!("from your instructor{text}"),
        points => format!("{points:+} points from your instructor{text}"),
    })
}

/// The points of each stage.
fn of_stages(graded: &Graded) -> impl Iterator<Item = String> {
    let line = |stage| format!("stage {stage}: {}", result::score(graded.of_stage(stage)));
    graded.stages().into_iter().map(line)
}

/// The points in one line: those of all stages, of each stage, and of the instructor.
pub fn in_short(graded: &Graded) -> String {
    let mut parts = vec![graded.trouble.clone(), in_words(graded.score())];
    parts.extend(of_stages(graded));
    parts.extend(note(graded));
    parts.retain(|part| !part.is_empty());
    parts.join("; ")
}

/// Summarises a submission as plain text: points, reasons and the compiler's messages.
pub fn summary(graded: &Graded) -> String {
    let mut lines = Vec::new();
    if !graded.checks.is_empty() {
        lines.push(in_words(graded.score()));
    }
    lines.extend(note(graded));
    if !graded.trouble.is_empty() {
        lines.push(format!("This submission could not be graded: {}", graded.trouble));
    }
    lines.extend(of_stages(graded));
    for (stage, n) in failing_on_hidden(graded) {
        let checks = if n == 1 { "1 check fails" } else { &format!("{n} checks fail") };
        lines.push(format!("stage {stage}: {checks} on hidden inputs only"));
    }
    if !graded.remarks.is_empty() {
        lines.push("\nIgnored or changed files:".to_owned());
    }
    lines.extend(graded.remarks.iter().map(|remark| format!("{}: {}", remark.file, remark.what)));
    if !graded.compiler.is_empty() {
        lines.push(format!("\nCompiler messages:\n{}", graded.compiler));
    }
    lines.join("\n")
}
