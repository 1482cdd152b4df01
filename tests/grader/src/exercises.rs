//! The exercises as they are made from `solutions/src`, which `author sync` writes to `exercises/src`.
//!
//! An answer stands between `// <solution>` and `// </solution>`. In the exercise, the lines marked `// <stub>` inside
//! replace it, without that mark. The marks are removed as well. All other lines are the same in both.

use crate::files_below::{files_below, last_part};
use anyhow::{Context, Result, bail};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

const BEGIN: &str = "// <solution>";
const STUB: &str = "// <stub>";
const END: &str = "// </solution>";

/// The file with the fingerprints of generated files. A file with its stored fingerprint is untouched.
pub const RECORD: &str = "exercises/.generated";

/// An exercise file in its three versions.
pub struct Exercise {
    /// Path below the workspace.
    pub path: PathBuf,
    /// The text that `sync` would write.
    pub stub: String,
    /// The current text, if the file exists.
    pub present: Option<String>,
    /// Whether the file was written by `sync` and not changed since.
    pub untouched: bool,
}

/// Returns all exercise files of the workspace at `root`.
pub fn exercises(root: &Path) -> Result<Vec<Exercise>> {
    let record = read_record(root);
    let solutions = files_below(root, "solutions/src", &|path| path.ends_with(".rs"))
        .context("there is no folder solutions/src: is this a hand-out instead of the whole kit?")?;
    let exercise = |solution: &String| {
        let path = Path::new("exercises/src").join(last_part(solution));
        let file = root.join(solution);
        let text = fs::read_to_string(&file).with_context(|| format!("cannot read {}", file.display()))?;
        let stub = stub(&text, Path::new(solution))?;
        let present = fs::read_to_string(root.join(&path)).ok();
        let is_generated = |text: &String| *text == stub || record.get(&path) == Some(&fingerprint(text));
        let untouched = present.as_ref().is_none_or(is_generated);
        Ok(Exercise { path, stub, present, untouched })
    };
    solutions.iter().map(exercise).collect()
}

/// Returns the untouched files of `exercises/src`, by name.
pub fn pristine(root: &Path) -> Result<BTreeMap<String, String>> {
    let named = |exercise: Exercise| {
        let name = exercise.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        (name, exercise.stub)
    };
    Ok(exercises(root)?.into_iter().map(named).collect())
}

/// A block of lines of a solution file.
pub enum Block<'a> {
    /// Lines that are the same in solution and exercise.
    Same(Vec<&'a str>),
    /// An answer with its marks, and the lines that replace it.
    Answer(Vec<&'a str>, Vec<String>),
}

/// Makes the exercise from a solution file.
pub fn stub(solution: &str, path: &Path) -> Result<String> {
    let mut lines: Vec<String> = Vec::new();
    for block in blocks(solution, path)? {
        match block {
            Block::Same(same) => lines.extend(same.into_iter().map(str::to_owned)),
            Block::Answer(_, stub) => lines.extend(stub),
        }
    }
    // If an answer has no stub, remove one of the two blank lines around it.
    lines.dedup_by(|line, above| line.is_empty() && above.is_empty());
    Ok(lines.join("\n").trim_end().to_owned() + "\n")
}

/// Returns a solution file without the marks, as a student would write it.
pub fn answer(solution: &str, path: &Path) -> Result<String> {
    let is_mark = |line: &&str| [BEGIN, STUB, END].iter().any(|mark| line.trim_start().starts_with(mark));
    let mut text = String::new();
    for block in blocks(solution, path)? {
        let (Block::Same(lines) | Block::Answer(lines, _)) = block;
        lines.iter().filter(|line| !is_mark(line)).for_each(|line| text.extend([line, "\n"]));
    }
    Ok(text)
}

/// Returns the stage of an exercise by the name of its file, or `None` for the glue.
pub fn stage_of(file: &str) -> Option<u8> {
    file.strip_prefix("stage")?.split_once('_')?.0.parse().ok()
}

/// Splits a solution file at its marks.
pub fn blocks<'a>(solution: &'a str, path: &Path) -> Result<Vec<Block<'a>>> {
    let mut blocks: Vec<Block<'a>> = Vec::new();
    let mut opened = None;
    for (number, line) in solution.lines().enumerate() {
        let (number, mark) = (number + 1, line.trim_start());
        let indent = &line[..line.len() - mark.len()];
        let place = || format!("{}:{number}", path.display());
        // Open a block at a mark, or at the first line after an answer.
        if mark == BEGIN {
            if let Some(begun) = opened.replace(number) {
                bail!("{}: `{BEGIN}` inside the block that begins at line {begun}", place());
            }
            blocks.push(Block::Answer(Vec::new(), Vec::new()));
        } else if opened.is_none() && (mark == END || mark.starts_with(STUB)) {
            bail!("{}: `{mark}` outside of `{BEGIN}`", place());
        } else if opened.is_none() && !matches!(blocks.last(), Some(Block::Same(_))) {
            blocks.push(Block::Same(Vec::new()));
        }
        // Add the line to its block.
        match blocks.last_mut() {
            Some(Block::Answer(lines, stub)) => {
                lines.push(line);
                if let Some(text) = mark.strip_prefix(STUB) {
                    stub.push(format!("{indent}{}", text.trim_start_matches(' ')));
                }
            }
            Some(Block::Same(lines)) => lines.push(line),
            None => {}
        }
        if mark == END {
            opened = None;
        }
    }
    match opened {
        Some(begun) => bail!("{}:{begun}: `{BEGIN}` is never closed by `{END}`", path.display()),
        None => Ok(blocks),
    }
}

fn read_record(root: &Path) -> BTreeMap<PathBuf, String> {
    let text = fs::read_to_string(root.join(RECORD)).unwrap_or_default();
    text.lines()
        .filter_map(|line| line.split_once(' '))
        .map(|(print, path)| (path.into(), print.into()))
        .collect()
}

/// Returns a fingerprint that is the same for LF and CRLF, because a checkout may convert line ends.
pub fn fingerprint(text: &str) -> String {
    let digest = Sha256::digest(text.replace("\r\n", "\n").as_bytes());
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn stub_of(text: &str) -> Result<String> {
        stub(text, Path::new("a.rs"))
    }

    #[test]
    fn a_solution_loses_its_marks_and_nothing_else() {
        let marked = "fn f() {\n    // <solution>\n    1\n    // <stub> todo!()\n    // </solution>\n}\n";
        assert_eq!(answer(marked, Path::new("a.rs")).unwrap(), "fn f() {\n    1\n}\n");
        assert!(answer("// <solution>\n", Path::new("a.rs")).is_err());
    }

    #[test]
    fn an_answer_gives_way_to_its_stub() {
        let solution = "fn f() {\n    // <solution>\n    1 + 1\n    // <stub> todo!(\"add\")\n    // </solution>\n}\n\n\
                        // <solution>\nfn helper() {}\n// </solution>\n\nfn g() {}\n";
        assert_eq!(stub_of(solution).unwrap(), "fn f() {\n    todo!(\"add\")\n}\n\nfn g() {}\n");
    }

    #[test]
    fn marks_that_do_not_match_are_errors_with_a_place() {
        let message = |text: &str| stub_of(text).unwrap_err().to_string();
        assert_eq!(
            message("\n// <solution>\nx"),
            "a.rs:2: `// <solution>` is never closed by `// </solution>`"
        );
        assert_eq!(message("// </solution>"), "a.rs:1: `// </solution>` outside of `// <solution>`");
        assert_eq!(
            message("// <solution>\n// <solution>"),
            "a.rs:2: `// <solution>` inside the block that begins at line 1"
        );
    }
}
