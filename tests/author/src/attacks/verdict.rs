//! Compares the result of an attack with the expected one.

use super::Attack;
use super::make::CANARY;
use crate::corpus::verdict::one_line;
use all_checks::STAGES;
use checks::rubric;
use grader::grade::result::{Graded, Outcome};
use serde::Deserialize;

/// Longest report about one student, in bytes.
const LONGEST_REPORT: usize = 1 << 20;

/// The checks whose points may be earned. One `*` in a name matches any text.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Earned {
    /// All points: the submission is honest.
    All,
    /// No points.
    None,
    /// Exactly these checks fail.
    AllBut(Vec<String>),
    /// These checks may pass or fail; all others pass.
    AtLeastAllBut(Vec<String>),
    /// These checks may pass or fail; all others fail.
    AtMost(Vec<String>),
}

/// The expected result of an attack.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Expectation {
    /// Rules of the syntax check that are switched off.
    #[serde(default)]
    pub allow: Vec<String>,
    /// The points that may be earned.
    pub earned: Earned,
    /// The allowed outcomes of checks that do not pass. An empty list allows all.
    #[serde(default)]
    pub outcomes: Vec<Outcome>,
    /// Whether grading as a whole must fail with a reason. Without a value both are allowed.
    pub trouble: Option<bool>,
    /// Words that must appear in the message of a check, a remark, the compiler's messages or the reason for failed
    /// grading.
    #[serde(default)]
    pub says: Vec<String>,
    /// Words that must not appear there.
    #[serde(default)]
    pub never_says: Vec<String>,
}

/// Returns the differences from the expected result, one sentence each.
pub fn complaints(attack: &Attack, expected: &Expectation, graded: &Graded) -> Vec<String> {
    let mut complaints = Vec::new();
    completeness(attack, graded, &mut complaints);
    points(expected, graded, &mut complaints);
    words(expected, graded, &mut complaints);
    complaints
}

/// Requires that every check that is judged is present once and is worth the points of the rubric.
fn completeness(attack: &Attack, graded: &Graded, complaints: &mut Vec<String>) {
    let all = STAGES.iter().flat_map(|(_, checks)| *checks);
    let judged = all.filter(|check| attack.is_judged(check.stage, check.name));
    let wanted: Vec<(u8, &str)> = judged.map(|check| (check.stage, check.name)).collect();
    let present: Vec<(u8, &str)> =
        graded.checks.iter().map(|check| (check.stage, check.name.as_str())).collect();
    if wanted != present {
        complaints.push(format!("{} checks were graded, but there are {}", present.len(), wanted.len()));
        return;
    }
    for check in &graded.checks {
        let points = rubric::entry(check.stage, &check.name).points;
        let right = if check.outcome == Outcome::Passed { points } else { 0 };
        if (check.points, check.earned) != (points, right) {
            complaints.push(format!(
                "{} earned {} of {} points, but its outcome is worth {right} of {points}",
                check.name, check.earned, check.points
            ));
        }
    }
}

fn points(expected: &Expectation, graded: &Graded, complaints: &mut Vec<String>) {
    match (expected.trouble, graded.trouble.as_str()) {
        (Some(true), "") => complaints.push("grading should have failed, but there is no reason".into()),
        (Some(false), trouble) if !trouble.is_empty() => {
            complaints.push(format!("grading failed: {trouble}"));
        }
        _ => {}
    }
    for check in &graded.checks {
        let passed = check.outcome == Outcome::Passed;
        let named = |names: &[String]| names.iter().any(|name| is_like(&check.name, name));
        let wanted = match &expected.earned {
            Earned::All => Some(true),
            Earned::None => Some(false),
            Earned::AllBut(names) => Some(!named(names)),
            Earned::AtLeastAllBut(names) | Earned::AtMost(names) if named(names) => None,
            Earned::AtLeastAllBut(_) => Some(true),
            Earned::AtMost(_) => Some(false),
        };
        match wanted {
            Some(true) if !passed => complaints.push(format!(
                "{} should pass and is: {}: {}",
                check.name,
                check.outcome.words(),
                check.message
            )),
            Some(false) if passed => complaints.push(format!("{} passes but was not earned", check.name)),
            _ => {}
        }
        if !passed && !expected.outcomes.is_empty() && !expected.outcomes.contains(&check.outcome) {
            let may: Vec<&str> = expected.outcomes.iter().map(|outcome| outcome.words()).collect();
            complaints.push(format!("{} is: {}, not: {}", check.name, check.outcome.words(), may.join(", ")));
        }
        if !passed && check.message.trim().is_empty() && graded.trouble.is_empty() {
            complaints.push(format!("{} fails without a message", check.name));
        }
    }
}

fn words(expected: &Expectation, graded: &Graded, complaints: &mut Vec<String>) {
    let messages = graded.checks.iter().map(|check| check.message.as_str());
    let remarks = graded.remarks.iter().flat_map(|remark| [remark.file.as_str(), remark.what.as_str()]);
    let text: Vec<&str> =
        messages.chain(remarks).chain([graded.compiler.as_str(), graded.trouble.as_str()]).collect();
    for words in &expected.says {
        if !text.iter().any(|text| one_line(text).contains(&one_line(words))) {
            complaints.push(format!("no message says `{words}`"));
        }
    }
    for words in expected.never_says.iter().map(String::as_str).chain([CANARY]) {
        if text.iter().any(|text| text.contains(words)) {
            complaints.push(format!("a message says `{words}`"));
        }
    }
    if let Some(text) = text.iter().find(|text| text.chars().any(is_dangerous)) {
        let shown: String = text.escape_debug().take(200).collect();
        complaints.push(format!("a message contains control characters: {shown}"));
    }
    let length: usize = text.iter().map(|text| text.len()).sum();
    if length > LONGEST_REPORT {
        complaints.push(format!("the report has {length} bytes"));
    }
}

/// Returns whether the character controls a terminal or the direction of text.
fn is_dangerous(character: char) -> bool {
    let bidi =
        matches!(character, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    bidi || character.is_control() && !matches!(character, '\n' | '\t')
}

/// Returns whether a name matches a pattern, in which one `*` matches any text.
pub(super) fn is_like(name: &str, pattern: &str) -> bool {
    match pattern.split_once('*') {
        None => name == pattern,
        Some((start, end)) => {
            name.len() >= start.len() + end.len() && name.starts_with(start) && name.ends_with(end)
        }
    }
}
