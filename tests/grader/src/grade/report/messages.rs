//! What a student is told about a check: the same in every format.

use crate::grade::result::{CheckResult, Graded, Outcome};
use checks::rubric::{self, Entry, Visibility};

/// What the rubric says of a check.
pub fn entry(check: &CheckResult) -> Entry {
    rubric::entry(check.stage, &check.name)
}

/// What went wrong, and nothing of what is hidden. Empty if nothing did.
pub fn message(check: &CheckResult) -> String {
    if check.outcome == Outcome::Passed {
        return String::new();
    }
    if check.outcome == Outcome::WrongOnHidden {
        return "wrong on hidden inputs: it holds for the inputs that you have, and not for all".to_owned();
    }
    if entry(check).visibility == Visibility::Hidden {
        return format!("a hidden check: {}", check.outcome.words());
    }
    match check.message.trim() {
        "" => in_a_sentence(check.outcome).to_owned(),
        _ => check.message.trim_end().to_owned(),
    }
}

/// The same without the lines that a page shows as headings.
pub fn message_without_header(check: &CheckResult) -> String {
    let text = message(check);
    match text.strip_prefix(&entry(check).header()) {
        // What follows the header is indented below it.
        Some(rest) => {
            let lines: Vec<&str> = rest.lines().map(|line| line.strip_prefix("  ").unwrap_or(line)).collect();
            lines.join("\n")
        }
        None => text,
    }
}

/// What an outcome means, for checks about which there is no more to say.
fn in_a_sentence(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Passed => "",
        Outcome::NotWritten => "there is no code to judge: the gap is still empty",
        Outcome::Wrong => "the answer is wrong",
        Outcome::WrongOnHidden => "wrong on hidden inputs",
        Outcome::TooLong => "no answer in time: does a loop, or a recursion, ever end?",
        Outcome::Crashed => {
            "the program was gone before it answered: it crashed, ended itself, or took too much memory"
        }
        Outcome::DoesNotCompile => "the file does not compile",
        Outcome::Refused => "the file holds what no exercise needs, and was not taken",
        Outcome::NotTried => "not tried: the submission had used up its time before",
    }
}

/// For each stage that has any: how many checks fail on hidden inputs only.
pub fn failing_on_hidden(graded: &Graded) -> Vec<(u8, usize)> {
    let count =
        |stage| graded.of_stage(stage).filter(|check| check.outcome == Outcome::WrongOnHidden).count();
    graded.stages().into_iter().map(|stage| (stage, count(stage))).filter(|(_, n)| *n > 0).collect()
}

/// What is told of a submission as a whole, as plain text.
pub fn summary(graded: &Graded) -> String {
    let mut lines = Vec::new();
    if !graded.checks.is_empty() {
        let (earned, points) = graded.points();
        lines.push(format!("{earned} of {points} points"));
    }
    if !graded.trouble.is_empty() {
        lines.push(format!("This submission could not be graded: {}", graded.trouble));
    }
    for stage in graded.stages() {
        let (earned, points) = crate::grade::result::sum(graded.of_stage(stage));
        lines.push(format!("stage {stage}: {earned} of {points} points"));
    }
    for (stage, n) in failing_on_hidden(graded) {
        let checks = if n == 1 { "1 check fails" } else { &format!("{n} checks fail") };
        lines.push(format!("stage {stage}: {checks} on hidden inputs only"));
    }
    if !graded.remarks.is_empty() {
        lines.push("\nWhat was not taken as it is:".to_owned());
    }
    lines.extend(graded.remarks.iter().map(|remark| format!("{}: {}", remark.file, remark.what)));
    if !graded.compiler.is_empty() {
        lines.push(format!("\nThe compiler says:\n{}", graded.compiler));
    }
    lines.join("\n")
}
