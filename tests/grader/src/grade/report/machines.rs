//! Reports for programs: `results.json`, and the files for Gradescope and GitHub Classroom.

use super::clean::clean_line;
use super::{Each, messages, presentable};
use crate::grade::result::{CheckResult, Graded, Note, Outcome, Remark, Session};
use anyhow::Result;
use checks::rubric::Level;
use serde::Serialize;
use serde_json::{Value, json};
use std::io::Write;

/// A submission without pictures and without values that differ from run to run.
#[derive(Serialize)]
struct GradedView<'a> {
    student: &'a str,
    content: &'a str,
    earned: u32,
    of: u32,
    core: u32,
    core_of: u32,
    bonus: u32,
    checks: Vec<CheckResult>,
    remarks: &'a [Remark],
    compiler: &'a str,
    trouble: &'a str,
    #[serde(skip_serializing_if = "str::is_empty")]
    handed_in: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    note: Option<&'a Note>,
}

/// Writes the class as JSON for the instructor's tools, one submission after the other. It can be read back as a
/// [`Class`](crate::grade::result::Class).
pub(super) fn results(session: &Session, each: &Each<'_>, out: &mut dyn Write) -> Result<()> {
    write!(out, "{{\n  \"session\": {},\n  \"students\": [", indented(session, 2)?)?;
    let mut before = "";
    each(&mut |graded| {
        let score = graded.score();
        let (of, (core, core_of)) = (score.points().1, score.core);
        let without_picture = |check: &CheckResult| CheckResult { picture: None, ..check.clone() };
        let view = GradedView {
            student: &graded.student,
            content: &graded.content,
            earned: graded.earned(),
            of,
            core,
            core_of,
            bonus: score.bonus.0,
            checks: graded.checks.iter().map(without_picture).collect(),
            remarks: &graded.remarks,
            compiler: &graded.compiler,
            trouble: &graded.trouble,
            handed_in: &graded.handed_in,
            note: graded.note.as_ref(),
        };
        write!(out, "{before}\n    {}", indented(&view, 4)?)?;
        before = ",";
        Ok(())
    })?;
    // A list without entries is written on one line.
    let end = if before.is_empty() { "" } else { "\n  " };
    Ok(writeln!(out, "{end}]\n}}")?)
}

/// Returns indented JSON as a part of a text: all lines but the first begin with `spaces` more. A text in JSON has no line
/// breaks.
fn indented(value: &impl Serialize, spaces: usize) -> Result<String> {
    Ok(serde_json::to_string_pretty(value)?.replace('\n', &format!("\n{:spaces$}", "")))
}

/// Returns indented JSON.
pub(super) fn pretty(value: &impl Serialize) -> Result<Vec<u8>> {
    let mut bytes = serde_json::to_vec_pretty(value)?;
    bytes.push(b'\n');
    Ok(bytes)
}

/// Returns the content of Gradescope's `/autograder/results/results.json`. The student may see all of it. Gradescope adds up scores
/// and takes the points of a test with a `max_score` of 0 as extra credit.
pub fn gradescope(graded: &Graded, session: &Session) -> Value {
    let graded = &presentable(graded);
    let mut place = (0, 0);
    let mut tests: Vec<Value> = graded
        .checks
        .iter()
        .map(|check| {
            place = if place.0 == check.stage { (place.0, place.1 + 1) } else { (check.stage, 1) };
            let status = if check.outcome == Outcome::Passed { "passed" } else { "failed" };
            json!({
                "name": title(check),
                "number": format!("{}.{}", place.0, place.1),
                "score": check.earned,
                "max_score": if check.level == Level::Bonus { 0 } else { check.points },
                "status": status,
                "output": messages::message(check),
                "output_format": "text",
                "name_format": "text",
                "visibility": "visible",
            })
        })
        .collect();
    tests.extend(messages::note(graded).zip(graded.note.as_ref()).map(|(name, note)| {
        json!({ "name": name, "score": note.points, "max_score": 0, "name_format": "text", "visibility": "visible" })
    }));
    let kit = clean_line(&session.kit, super::LINE);
    let course = match clean_line(&session.course, super::LINE) {
        course if course.is_empty() => String::new(),
        course => format!("\ncourse: {course}"),
    };
    let late: String = messages::late(graded, session).iter().map(|line| format!("\n{line}")).collect();
    let mut results = json!({
        "output": format!("{}{late}\n\nkit: {kit}{course}", messages::summary(graded)),
        "output_format": "text",
        "test_output_format": "text",
        "test_name_format": "text",
        "visibility": "visible",
        "stdout_visibility": "hidden",
        "tests": tests,
    });
    // Gradescope adds up the points of the tests. It needs a score only if there are no tests.
    if graded.checks.is_empty() {
        results["score"] = json!(0);
    }
    results
}

/// Returns the result that GitHub Classroom reads from a runner, before base64. Classroom adds up the scores of `tests`.
/// The share of tests that it prints does not weight them by points. It has no extra credit, so a bonus check has the score 0
/// there, and its title says what it earned.
pub fn classroom(graded: &Graded) -> Value {
    let graded = &presentable(graded);
    let (earned, of) = graded.score().points();
    let mut tests: Vec<Value> = graded
        .checks
        .iter()
        .map(|check| {
            let (title, message) = (title(check), messages::message(check));
            match check.level {
                Level::Bonus => {
                    let title = format!("{title} (bonus: {} of {})", check.earned, check.points);
                    classroom_test(&title, status(check.outcome), &message, 0)
                }
                _ => classroom_test(&title, status(check.outcome), &message, check.earned as i32),
            }
        })
        .collect();
    tests.extend(
        messages::note(graded)
            .zip(graded.note.as_ref())
            .map(|(name, note)| classroom_test(&name, "pass", "", note.points)),
    );
    if graded.checks.is_empty() {
        tests.push(classroom_test("submission", "error", &graded.trouble, 0));
    }
    let status = match (graded.trouble.is_empty() && !graded.checks.is_empty(), earned == of) {
        (false, _) => "error",
        (true, true) => "pass",
        (true, false) => "fail",
    };
    json!({ "version": 1, "status": status, "max_score": of, "tests": tests })
}

fn classroom_test(name: &str, status: &str, message: &str, score: i32) -> Value {
    let message = if message.is_empty() { Value::Null } else { json!(message) };
    json!({
        "name": name,
        "status": status,
        "message": message,
        "test_code": "",
        "filename": "",
        "line_no": 0,
        "duration": 0,
        "score": score,
    })
}

/// Returns `pass`, `fail` for a wrong answer or an unwritten function, or `error` if no answer could be judged.
fn status(outcome: Outcome) -> &'static str {
    match outcome {
        Outcome::Passed => "pass",
        Outcome::Wrong | Outcome::WrongOnHidden | Outcome::Unproven | Outcome::NotWritten => "fail",
        Outcome::TooLong
        | Outcome::Crashed
        | Outcome::DoesNotCompile
        | Outcome::Refused
        | Outcome::NotTried => "error",
    }
}

/// Returns the title and the name of the check, because several checks may share a title.
fn title(check: &CheckResult) -> String {
    format!("{} ({})", messages::entry(check).title, check.name)
}

/// Returns whether JUnit counts the outcome as an error instead of a failure.
pub(super) fn is_error(outcome: Outcome) -> bool {
    status(outcome) == "error"
}
