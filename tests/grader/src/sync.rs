//! `grader sync`: makes `exercises/src` from `solutions/src`, and writes the [numbers] in documents.
//!
//! An answer stands between `// <solution>` and `// </solution>`. In the exercise, the lines marked `// <stub>` inside
//! replace it, without that mark. The marks are removed as well. All other lines are the same in both.

use crate::numbers;
use anyhow::{Context, Result, bail};
use raykata_cli::args::{Given, Misuse, Opt, Spec};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// `grader sync`.
pub static SPEC: Spec = Spec {
    name: "grader sync",
    about: "Make exercises/ from solutions/, and write the numbers in documents (for authors). Keeps exercises that you have begun.",
    arguments: &[],
    options: &[&[
        Opt::flag("--check", "Only report differences, and write nothing."),
        Opt::flag("--force", "Overwrite exercises that have been begun."),
    ]],
};

/// The options of `grader sync`.
pub struct Options {
    check: bool,
    force: bool,
}

impl Options {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        given.exclude("--force", "--check")?;
        Ok(Options { check: given.has("--check"), force: given.has("--force") })
    }
}

const BEGIN: &str = "// <solution>";
const STUB: &str = "// <stub>";
const END: &str = "// </solution>";

/// The file with the fingerprints of generated files. A file with its stored fingerprint is untouched.
const RECORD: &str = "exercises/.generated";

/// The file with the untouched functions, from which `raykata watch` resets one. Students have it too.
const STUBS: &str = "tests/stubs.toml";

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
    let mut files: Vec<PathBuf> = fs::read_dir(root.join("solutions/src"))
        .context("there is no folder solutions/src: is this a hand-out instead of the whole kit?")?
        .filter_map(|entry| entry.ok().map(|entry| entry.path()))
        .filter(|path| path.extension().is_some_and(|extension| extension == "rs"))
        .collect();
    files.sort();
    files
        .iter()
        .map(|solution| {
            let name = solution.file_name().context("a file without a name")?;
            let path = Path::new("exercises/src").join(name);
            let shown = Path::new("solutions/src").join(name);
            let stub = stub(&read(solution)?, &shown)?;
            let present = fs::read_to_string(root.join(&path)).ok();
            let untouched = present
                .as_ref()
                .is_none_or(|text| *text == stub || record.get(&path) == Some(&fingerprint(text)));
            Ok(Exercise { path, stub, present, untouched })
        })
        .collect()
}

/// Returns the untouched files of `exercises/src`, by name.
pub fn pristine(root: &Path) -> Result<BTreeMap<String, String>> {
    let named = |exercise: Exercise| {
        let name = exercise.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        (name, exercise.stub)
    };
    Ok(exercises(root)?.into_iter().map(named).collect())
}

/// Runs `grader sync`.
pub fn run(root: &Path, options: &Options) -> Result<()> {
    if options.check { check(root) } else { sync(root, options.force) }
}

/// Compares the exercises and the documents with the files that `sync` would write. Returns an error that lists the differences.
pub fn check(root: &Path) -> Result<()> {
    let exercises = exercises(root)?;
    let mut different: Vec<String> = exercises
        .iter()
        .filter(|exercise| exercise.present.as_ref() != Some(&exercise.stub))
        .map(|exercise| format!("  {}", exercise.path.display()))
        .collect();
    if fs::read_to_string(root.join(STUBS)).ok() != Some(stubs(&exercises)) {
        different.push(format!("  {STUBS}"));
    }
    let stale = numbers::documents(root)?.into_iter().filter(|document| document.present != document.synced);
    different.extend(stale.map(|document| format!("  {}", document.path.display())));
    if different.is_empty() {
        println!("exercises/ is up to date with solutions/, and documents have the right numbers");
        return Ok(());
    }
    bail!("these files differ from what `grader sync` would write:\n{}", different.join("\n"))
}

/// Writes all untouched exercises, with `force` the others as well, and the documents whose numbers are stale.
pub fn sync(root: &Path, force: bool) -> Result<()> {
    let exercises = exercises(root)?;
    let mut record = BTreeMap::new();
    let mut kept = Vec::new();
    for exercise in &exercises {
        if exercise.untouched || force {
            if exercise.present.as_ref() != Some(&exercise.stub) {
                write(&root.join(&exercise.path), &exercise.stub)?;
                println!("wrote {}", exercise.path.display());
            }
            record.insert(exercise.path.clone(), fingerprint(&exercise.stub));
        } else {
            kept.push(exercise.path.display().to_string());
        }
    }
    let lines: Vec<String> =
        record.iter().map(|(path, print)| format!("{print} {}\n", path.display())).collect();
    write(&root.join(RECORD), &lines.concat())?;
    write(&root.join(STUBS), &stubs(&exercises))?;
    for document in numbers::documents(root)?.iter().filter(|document| document.present != document.synced) {
        write(&root.join(&document.path), &document.synced)?;
        println!("wrote {}", document.path.display());
    }
    for path in &kept {
        println!("kept {path}: you have begun it (`grader sync --force` would overwrite it)");
    }
    Ok(())
}

/// Returns the untouched functions of all exercises as TOML: a table per file, and in it the text of each function.
fn stubs(exercises: &[Exercise]) -> String {
    let mut toml = "# The functions of the exercises before they are written. `grader sync` writes this file, and `raykata watch` \
                    resets a\n# function from it.\n"
        .to_owned();
    for exercise in exercises {
        let file = exercise.path.file_stem().unwrap_or_default().to_string_lossy();
        if stage_of(&file).is_none() {
            continue;
        }
        toml += &format!("\n[{file}]\n");
        let mut lines = exercise.stub.lines();
        while let Some(line) = lines.next() {
            let Some(head) = line.strip_prefix("pub fn ") else { continue };
            let name: String =
                head.chars().take_while(|sign| sign.is_ascii_alphanumeric() || *sign == '_').collect();
            let rest = lines.by_ref().take_while(|line| *line != "}").map(|line| format!("{line}\n"));
            toml += &format!("{name} = '''\n{line}\n{}}}\n'''\n", rest.collect::<String>());
        }
    }
    toml
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
fn fingerprint(text: &str) -> String {
    let digest = Sha256::digest(text.replace("\r\n", "\n").as_bytes());
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn read(file: &Path) -> Result<String> {
    fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))
}

/// Writes a file, whole or not at all.
pub(crate) fn write(file: &Path, text: &str) -> Result<()> {
    raykata::film::write_atomically(file, |out| std::io::Write::write_all(out, text.as_bytes()))
        .with_context(|| format!("cannot write {}", file.display()))
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

    #[test]
    fn work_that_was_begun_is_kept_unless_forced() {
        let root = tempfile::tempdir().unwrap();
        let at = |path: &str| root.path().join(path);
        fs::create_dir_all(at("solutions/src")).unwrap();
        fs::create_dir_all(at("exercises/src")).unwrap();
        fs::create_dir_all(at("tests")).unwrap();
        let solution =
            "fn f() -> u8 {\n    // <solution>\n    7\n    // <stub> todo!()\n    // </solution>\n}\n";
        fs::write(at("solutions/src/a.rs"), solution).unwrap();
        sync(root.path(), false).unwrap();
        check(root.path()).unwrap();

        // A newer kit replaces an untouched file …
        fs::write(at("solutions/src/a.rs"), solution.replace("u8", "u16")).unwrap();
        assert!(check(root.path()).is_err());
        sync(root.path(), false).unwrap();
        assert!(fs::read_to_string(at("exercises/src/a.rs")).unwrap().contains("u16"));

        // … and keeps a changed one.
        fs::write(at("exercises/src/a.rs"), "fn f() -> u16 { 8 }\n").unwrap();
        sync(root.path(), false).unwrap();
        assert_eq!(fs::read_to_string(at("exercises/src/a.rs")).unwrap(), "fn f() -> u16 { 8 }\n");
        sync(root.path(), true).unwrap();
        check(root.path()).unwrap();
    }

    #[test]
    fn a_stale_number_in_a_document_is_found_and_written() {
        let root = tempfile::tempdir().unwrap();
        let at = |path: &str| root.path().join(path);
        for folder in ["solutions/src", "exercises", "tests"] {
            fs::create_dir_all(at(folder)).unwrap();
        }
        fs::write(at("README.md"), "There are 11<!--=stages--> stages.\n").unwrap();
        sync(root.path(), false).unwrap();
        assert_eq!(fs::read_to_string(at("README.md")).unwrap(), "There are 12<!--=stages--> stages.\n");
        check(root.path()).unwrap();
        fs::write(at("README.md"), "There are 13<!--=stages--> stages.\n").unwrap();
        assert!(check(root.path()).unwrap_err().to_string().ends_with("\n  README.md"));
    }
}
