//! The errors of the compiler, condensed to the lines of the student.

use crate::process::Process;
use anyhow::{Result, bail};
use raykata_cli::kits::{BuiltPrograms, Program};
use serde::Serialize;
use serde_json::Value;
use std::io::{BufRead, BufReader};
use std::path::PathBuf;
use std::process::Command;

/// An error: where it is, what is wrong, and the line of code.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CompilerError {
    /// `file:line:column`, or nothing if it belongs to no place.
    pub place: String,
    /// What is wrong, in one line.
    pub what: String,
    /// The line of code, without its indentation.
    pub code: String,
    /// What the compiler says about the place, and what it suggests.
    pub notes: Vec<String>,
}

/// What a build gives.
pub enum Compiled {
    /// The path of the program.
    Program(PathBuf),
    /// The errors of the compiler.
    Errors(Vec<CompilerError>),
}

/// Runs a build of `program` by cargo; returns `None` if the run is over.
pub fn compile(process: &Process, mut cargo: Command, program: Program) -> Result<Option<Compiled>> {
    cargo.arg("--message-format=json");
    let (mut errors, mut built) = (Vec::new(), BuiltPrograms::default());
    let lines = |out: &mut BufReader<_>| {
        for line in out.lines().map_while(Result::ok) {
            errors.extend(error_in(&line));
            built.add(&line);
        }
        Ok(())
    };
    let Some((compiled, words)) = process.follow(cargo, lines)? else { return Ok(None) };
    match compiled {
        true => Ok(Some(Compiled::Program(built.path(program.name)?))),
        false if errors.is_empty() => bail!("the {} cannot be built:\n{}", program.package, words.trim()),
        false => Ok(Some(Compiled::Errors(errors))),
    }
}

/// Reads one line that cargo writes with `--message-format=json`; `None` if it is no error.
pub fn error_in(line: &str) -> Option<CompilerError> {
    let line: Value = serde_json::from_str(line).ok()?;
    let message = line.get("message").filter(|_| line["reason"] == "compiler-message")?;
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let what = text(&message["message"]);
    // The last error only counts the others.
    if message["level"] != "error" || what.starts_with("aborting due to") {
        return None;
    }
    let spans = message["spans"].as_array().map_or(&[][..], Vec::as_slice);
    let Some(span) = spans.iter().find(|span| span["is_primary"] == true) else {
        return Some(CompilerError { place: String::new(), what, code: String::new(), notes: Vec::new() });
    };
    let place = format!("{}:{}:{}", text(&span["file_name"]), span["line_start"], span["column_start"]);
    let code = text(&span["text"][0]["text"]).trim().to_owned();
    let help = message["children"].as_array().map_or(&[][..], Vec::as_slice).iter();
    let suggestions = help.filter(|child| child["level"] == "help").map(|child| {
        let said = text(&child["message"]);
        // What to write instead. With several places they are parts of one change, which make no sense without the code.
        match child["spans"].as_array().map(Vec::as_slice) {
            Some([place]) => match text(&place["suggested_replacement"]).trim() {
                "" => said,
                code => format!("{said}: {}", code.lines().next().unwrap_or_default()),
            },
            _ => said,
        }
    });
    // Another place of the error, such as the bracket that is not closed, is named by its line.
    let elsewhere = spans.iter().filter(|span| span["is_primary"] != true).map(|span| {
        let label = text(&span["label"]);
        if label.is_empty() { label } else { format!("line {}: {label}", span["line_start"]) }
    });
    let mut notes: Vec<String> =
        [text(&span["label"])].into_iter().chain(elsewhere).chain(suggestions).collect();
    notes.retain(|note| !note.is_empty() && !what.starts_with(note.as_str()));
    Some(CompilerError { place, what, code, notes })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_condensed_to_its_line() {
        let line = r#"{"reason":"compiler-message","message":{"level":"error","message":"mismatched types","spans":[
            {"is_primary":true,"file_name":"src/stage1_shapes.rs","line_start":23,"column_start":5,
             "label":"expected `Option<f32>`, found `f32`","text":[{"text":"    t_near"}]}],
            "children":[{"level":"help","message":"try wrapping the expression in `Some`","spans":[]}]}}"#;
        let error = error_in(&line.replace('\n', " ")).unwrap();
        assert_eq!(error.place, "src/stage1_shapes.rs:23:5");
        assert_eq!(error.what, "mismatched types");
        assert_eq!(error.code, "t_near");
        assert_eq!(
            error.notes,
            ["expected `Option<f32>`, found `f32`", "try wrapping the expression in `Some`"]
        );
    }

    #[test]
    fn a_suggestion_says_what_to_write() {
        let line = r#"{"reason":"compiler-message","message":{"level":"error","message":"cannot find type `DVec3`","spans":[
            {"is_primary":true,"file_name":"a.rs","line_start":4,"column_start":5,"label":null,"text":[{"text":"DVec3::Z"}]}],
            "children":[{"level":"help","message":"consider importing this struct","spans":[
             {"suggested_replacement":"use glam::DVec3;\n\n"}]},
             {"level":"help","message":"try wrapping it","spans":[
             {"suggested_replacement":"Some("},{"suggested_replacement":")"}]}]}}"#;
        let error = error_in(&line.replace('\n', " ")).unwrap();
        assert_eq!(error.notes, ["consider importing this struct: use glam::DVec3;", "try wrapping it"]);
    }

    #[test]
    fn a_bracket_that_is_not_closed_is_named_by_its_line() {
        let line = r#"{"reason":"compiler-message","message":{"level":"error","message":"mismatched closing delimiter: `}`",
            "spans":[{"is_primary":true,"file_name":"a.rs","line_start":22,"column_start":1,
             "label":"mismatched closing delimiter","text":[{"text":"}"}]},
             {"is_primary":false,"file_name":"a.rs","line_start":21,"column_start":20,"label":"unclosed delimiter","text":[]}],
            "children":[]}}"#;
        let error = error_in(&line.replace('\n', " ")).unwrap();
        assert_eq!(error.notes, ["line 21: unclosed delimiter"]);
    }

    #[test]
    fn warnings_artifacts_and_the_count_of_errors_are_no_errors() {
        for line in [
            r#"{"reason":"compiler-artifact"}"#,
            r#"{"reason":"compiler-message","message":{"level":"warning","message":"unused","spans":[]}}"#,
            r#"{"reason":"compiler-message","message":{"level":"error","message":"aborting due to 2 previous errors","spans":[]}}"#,
            "no JSON",
        ] {
            assert_eq!(error_in(line), None, "{line}");
        }
    }
}
