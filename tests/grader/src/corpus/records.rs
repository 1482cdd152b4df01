//! The stored results of a run: the kill matrix, and the message about each mistake.

use super::entry::{Claim, Entry};
use super::verdict::{Failures, Tried};
use anyhow::{Context, Result};
use raykata::film::write_atomically;
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The file of the kill matrix, below the root of the kit.
pub const MATRIX: &str = "tests/corpus/matrix.txt";

const ABOUT: &str = "# Which checks each entry of the corpus fails; `=` marks the check that is named to catch it. Written by\n\
                     # `cargo run -p grader -- corpus --bless`, compared by `cargo run -p grader -- corpus --check`.\n";

/// The lines of a matrix by entry.
#[derive(Debug, Default, PartialEq)]
pub struct Matrix(pub BTreeMap<String, String>);

impl Matrix {
    /// Reads the matrix of the kit at `root`. The matrix is empty if there is no file.
    pub fn read(root: &Path) -> Matrix {
        let text = fs::read_to_string(root.join(MATRIX)).unwrap_or_default();
        let lines = text.lines().filter(|line| !line.starts_with('#'));
        let pairs = lines.filter_map(|line| line.split_once(": "));
        Matrix(pairs.map(|(entry, checks)| (entry.to_owned(), checks.to_owned())).collect())
    }

    /// Replaces the line of an entry.
    pub fn set(&mut self, entry: &Entry, failures: &Failures) {
        self.0.insert(entry.to_string(), row(entry, failures));
    }

    /// Writes the matrix.
    pub fn write(&self, root: &Path) -> Result<()> {
        let lines: String = self.0.iter().map(|(entry, checks)| format!("{entry}: {checks}\n")).collect();
        write(&root.join(MATRIX), &format!("{ABOUT}{lines}"))
    }

    /// Returns the checks that at least one entry fails.
    pub fn killers(&self) -> impl Iterator<Item = &str> {
        self.0.values().flat_map(|checks| checks.split(' ')).map(|check| check.trim_start_matches('='))
    }
}

/// Returns the line of an entry in the matrix.
fn row(entry: &Entry, failures: &Failures) -> String {
    let named = match &entry.claim {
        Claim::Wrong { caught_by, .. } => caught_by.as_str(),
        Claim::Right => "",
    };
    let first = failures.keys().filter(|check| **check == named).map(|check| format!("={check}"));
    let others = failures.keys().filter(|check| **check != named).map(|check| (*check).to_owned());
    let all: Vec<String> = first.chain(others).collect();
    if all.is_empty() { "-".into() } else { all.join(" ") }
}

/// Returns the file that stores the message of an entry.
pub fn message_file(root: &Path, entry: &Entry) -> PathBuf {
    root.join(format!("tests/corpus/messages/stage{}/{}.txt", entry.stage, entry.name))
}

/// Returns the differences between new and stored results, one sentence each.
pub fn differences(root: &Path, matrix: &Matrix, tried: &[Tried]) -> Vec<String> {
    let mut differences = Vec::new();
    for Tried { entry, failures, .. } in tried {
        let found = row(entry, failures);
        match matrix.0.get(&entry.to_string()) {
            None => differences.push(format!("{entry} is not in {MATRIX}")),
            Some(kept) if *kept != found => {
                differences.push(format!("{entry} fails\n  {found}\nbut {MATRIX} says\n  {kept}"));
            }
            Some(_) => {}
        }
    }
    for one in tried {
        let file = message_file(root, &one.entry);
        let kept = fs::read_to_string(&file).ok();
        if kept.as_deref() != one.message() {
            let shown = file.strip_prefix(root).unwrap_or(&file).display();
            let (kept, now) = (kept.as_deref().unwrap_or("nothing\n"), one.message().unwrap_or("nothing\n"));
            differences.push(format!("the message of {} is\n{now}but {shown} contains\n{kept}", one.entry));
        }
    }
    differences
}

/// Stores the results. If `all` is true, every entry was tested, and the results of other entries are deleted.
pub fn bless(root: &Path, tried: &[Tried], all: bool) -> Result<()> {
    let mut matrix = if all { Matrix::default() } else { Matrix::read(root) };
    for one in tried {
        matrix.set(&one.entry, &one.failures);
    }
    matrix.write(root)?;
    if all && root.join("tests/corpus/messages").exists() {
        fs::remove_dir_all(root.join("tests/corpus/messages")).context("tests/corpus/messages")?;
    }
    for one in tried {
        let file = message_file(root, &one.entry);
        match one.message() {
            Some(message) => write(&file, message)?,
            None if file.exists() => fs::remove_file(&file).with_context(|| file.display().to_string())?,
            None => {}
        }
    }
    Ok(())
}

fn write(file: &Path, text: &str) -> Result<()> {
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    let written = write_atomically(file, |out| out.write_all(text.as_bytes()));
    written.with_context(|| format!("{} cannot be written", file.display()))
}
