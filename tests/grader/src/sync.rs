//! `grader sync`: makes `exercises/src` from `solutions/src`.
//!
//! An answer stands between `// <solution>` and `// </solution>`. In the exercise it gives way to the lines marked
//! `// <stub>` inside, without that mark; the marks themselves go, too. Everything else is the same in both.

use anyhow::{Context, Result, bail};
use raykata_cli::args::{Given, Misuse, Opt, Spec};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// `grader sync`.
pub static SPEC: Spec = Spec {
    name: "grader sync",
    about: "Make exercises/ from solutions/ (for authors). Keeps what you have begun.",
    arguments: &[],
    options: &[&[
        Opt::flag("--check", "Only say whether anything differs."),
        Opt::flag("--force", "Overwrite exercises that have been begun."),
    ]],
};

/// Whether to compare or to write.
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

/// Where the fingerprints of generated files are kept: a file that still has its own is one that nobody has begun.
const RECORD: &str = "exercises/.generated";

/// An exercise file in its three versions.
pub struct Exercise {
    /// Path below the workspace.
    pub path: PathBuf,
    /// What `sync` would write.
    pub stub: String,
    /// What is there now, if anything.
    pub present: Option<String>,
    /// Whether what is there was written by `sync` and not touched since.
    pub untouched: bool,
}

/// All exercise files of the workspace at `root`.
pub fn exercises(root: &Path) -> Result<Vec<Exercise>> {
    let record = read_record(root);
    let mut files: Vec<PathBuf> = fs::read_dir(root.join("solutions/src"))
        .context("no folder solutions/src: is this the whole kit, or a hand-out?")?
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

/// The files of `exercises/src` as nobody has begun them, by name.
pub fn pristine(root: &Path) -> Result<BTreeMap<String, String>> {
    let named = |exercise: Exercise| {
        let name = exercise.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        (name, exercise.stub)
    };
    Ok(exercises(root)?.into_iter().map(named).collect())
}

/// Compares or writes.
pub fn run(root: &Path, options: &Options) -> Result<()> {
    if options.check { check(root) } else { sync(root, options.force) }
}

/// Says which exercises differ from what `sync` would write; fails if any does.
pub fn check(root: &Path) -> Result<()> {
    let different: Vec<String> = exercises(root)?
        .iter()
        .filter(|exercise| exercise.present.as_ref() != Some(&exercise.stub))
        .map(|exercise| format!("  {}", exercise.path.display()))
        .collect();
    if different.is_empty() {
        println!("exercises/ is what solutions/ makes it");
        return Ok(());
    }
    bail!("not what `grader sync` would write from solutions/:\n{}", different.join("\n"))
}

/// Writes all exercises that nobody has begun; with `force`, the others as well.
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
    for path in &kept {
        println!("kept {path}: you have begun it (`grader sync --force` would overwrite it)");
    }
    Ok(())
}

/// Lines of a solution file that stand together.
pub enum Block<'a> {
    /// The same in both.
    Same(Vec<&'a str>),
    /// An answer with its marks, and the lines that replace it.
    Answer(Vec<&'a str>, Vec<String>),
}

/// The exercise that a solution file makes.
pub fn stub(solution: &str, path: &Path) -> Result<String> {
    let mut lines: Vec<String> = Vec::new();
    for block in blocks(solution, path)? {
        match block {
            Block::Same(same) => lines.extend(same.into_iter().map(str::to_owned)),
            Block::Answer(_, stub) => lines.extend(stub),
        }
    }
    // An answer that leaves nothing behind leaves one blank line too many.
    lines.dedup_by(|line, above| line.is_empty() && above.is_empty());
    Ok(lines.join("\n").trim_end().to_owned() + "\n")
}

/// A solution file as a student would have written it: without the marks.
pub fn answer(solution: &str, path: &Path) -> Result<String> {
    let is_mark = |line: &&str| [BEGIN, STUB, END].iter().any(|mark| line.trim_start().starts_with(mark));
    let mut text = String::new();
    for block in blocks(solution, path)? {
        let (Block::Same(lines) | Block::Answer(lines, _)) = block;
        lines.iter().filter(|line| !is_mark(line)).for_each(|line| text.extend([line, "\n"]));
    }
    Ok(text)
}

/// The stage of an exercise by the name of its file; none for what connects them.
pub fn stage_of(file: &str) -> Option<u8> {
    file.strip_prefix("stage")?.split_once('_')?.0.parse().ok()
}

/// A solution file, cut at its marks.
pub fn blocks<'a>(solution: &'a str, path: &Path) -> Result<Vec<Block<'a>>> {
    let mut blocks: Vec<Block<'a>> = Vec::new();
    let mut opened = None;
    for (number, line) in solution.lines().enumerate() {
        let (number, mark) = (number + 1, line.trim_start());
        let indent = &line[..line.len() - mark.len()];
        let place = || format!("{}:{number}", path.display());
        if mark == BEGIN {
            if let Some(begun) = opened.replace(number) {
                bail!("{}: `{BEGIN}` inside the one that line {begun} began", place());
            }
            blocks.push(Block::Answer(Vec::new(), Vec::new()));
        } else if opened.is_none() && (mark == END || mark.starts_with(STUB)) {
            bail!("{}: `{mark}` outside of `{BEGIN}`", place());
        } else if opened.is_none() && !matches!(blocks.last(), Some(Block::Same(_))) {
            blocks.push(Block::Same(Vec::new()));
        }
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

/// The same for LF and CRLF: a checkout may turn one into the other.
fn fingerprint(text: &str) -> String {
    let digest = Sha256::digest(text.replace("\r\n", "\n").as_bytes());
    digest.iter().map(|byte| format!("{byte:02x}")).collect()
}

fn read(file: &Path) -> Result<String> {
    fs::read_to_string(file).with_context(|| format!("cannot read {}", file.display()))
}

fn write(file: &Path, text: &str) -> Result<()> {
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
            "a.rs:2: `// <solution>` inside the one that line 1 began"
        );
    }

    #[test]
    fn work_that_was_begun_is_kept_until_told_otherwise() {
        let root = tempfile::tempdir().unwrap();
        let at = |path: &str| root.path().join(path);
        fs::create_dir_all(at("solutions/src")).unwrap();
        fs::create_dir_all(at("exercises/src")).unwrap();
        let solution =
            "fn f() -> u8 {\n    // <solution>\n    7\n    // <stub> todo!()\n    // </solution>\n}\n";
        fs::write(at("solutions/src/a.rs"), solution).unwrap();
        sync(root.path(), false).unwrap();
        check(root.path()).unwrap();

        // A newer kit replaces what nobody has touched …
        fs::write(at("solutions/src/a.rs"), solution.replace("u8", "u16")).unwrap();
        assert!(check(root.path()).is_err());
        sync(root.path(), false).unwrap();
        assert!(fs::read_to_string(at("exercises/src/a.rs")).unwrap().contains("u16"));

        // … and leaves alone what somebody has.
        fs::write(at("exercises/src/a.rs"), "fn f() -> u16 { 8 }\n").unwrap();
        sync(root.path(), false).unwrap();
        assert_eq!(fs::read_to_string(at("exercises/src/a.rs")).unwrap(), "fn f() -> u16 { 8 }\n");
        sync(root.path(), true).unwrap();
        check(root.path()).unwrap();
    }
}
