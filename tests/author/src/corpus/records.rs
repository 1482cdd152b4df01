//! The stored results: which checks each entry fails, and the message about each mistake.

use super::entry::{Entry, FOLDER};
use super::verdict::{Failures, TriedEntry};
use anyhow::{Context, Result};
use raykata::film::write_atomically;
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::Path;

/// The file of the kill matrix, below the root of the kit.
pub const MATRIX: &str = "tests/corpus/matrix.txt";

const ABOUT: &str = "# Which checks each entry of the corpus fails; `=` marks the check that is named to catch it. Written by\n\
                     # `cargo run -p author -- corpus --bless`.\n";

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

    /// Writes the matrix.
    pub fn write(&self, root: &Path) -> Result<()> {
        let lines: String = self.0.iter().map(|(entry, checks)| format!("{entry}: {checks}\n")).collect();
        write(&root.join(MATRIX), &format!("{ABOUT}{lines}"))
    }

    /// Returns the checks that at least one entry fails.
    pub fn killers(&self) -> impl Iterator<Item = &str> {
        self.0.values().flat_map(|checks| checks.split(' ')).map(|check| check.trim_start_matches('='))
    }

    /// Returns how many checks an entry fails.
    pub fn n_failing(&self, entry: &Entry) -> usize {
        self.0.get(&entry.to_string()).map_or(0, |row| row.split(' ').filter(|check| *check != "-").count())
    }

    /// Returns whether an entry fails a check.
    pub fn fails(&self, entry: &Entry, check: &str) -> bool {
        let row = self.0.get(&entry.to_string());
        row.is_some_and(|row| row.split(' ').any(|name| name.trim_start_matches('=') == check))
    }
}

/// Returns the line of an entry in the matrix.
fn row(entry: &Entry, failures: &Failures) -> String {
    let named = entry.caught_by().unwrap_or_default();
    let first = failures.keys().filter(|check| **check == named).map(|check| format!("={check}"));
    let others = failures.keys().filter(|check| **check != named).map(|check| (*check).to_owned());
    let all: Vec<String> = first.chain(others).collect();
    if all.is_empty() { "-".into() } else { all.join(" ") }
}

/// The message of the named check about each mistake, by the name of the entry. One file per stage stores them, without the
/// lines that come from the rubric: title, slides, and the two commands.
#[derive(Debug, Default, PartialEq)]
pub struct Messages(pub BTreeMap<String, String>);

/// The file with the messages of a stage, below the root of the kit.
fn messages_file(stage: u8) -> String {
    format!("{FOLDER}/messages/stage{stage}.txt")
}

/// Returns a message without the lines that come from the rubric.
pub fn without_rubric(message: &str) -> String {
    let starts = ["stage ", "  slides: ", "  again: ", "  print: ", "  stuck: "];
    let of_rubric = |line: &&str| starts.iter().any(|start| line.starts_with(start));
    message.lines().filter(|line| !of_rubric(line)).map(|line| format!("{line}\n")).collect()
}

impl Messages {
    /// Reads the messages of the kit at `root`. There are none where there is no file.
    pub fn read(root: &Path) -> Messages {
        let mut messages = BTreeMap::new();
        for (stage, _) in all_checks::STAGES {
            let text = fs::read_to_string(root.join(messages_file(*stage))).unwrap_or_default();
            for part in format!("\n{text}").split("\n=== ").skip(1) {
                if let Some((name, message)) = part.split_once(" ===\n") {
                    let message = format!("{}\n", message.trim_end_matches('\n'));
                    messages.insert(format!("wrong/stage{stage}/{name}"), message);
                }
            }
        }
        Messages(messages)
    }

    /// Returns the message about an entry.
    pub fn of(&self, entry: &Entry) -> Option<&str> {
        self.0.get(&entry.to_string()).map(String::as_str)
    }

    /// Replaces the messages about these entries.
    pub fn set(&mut self, tried: &[TriedEntry]) {
        for one in tried {
            match one.message() {
                Some(message) => _ = self.0.insert(one.entry.to_string(), without_rubric(message)),
                None => _ = self.0.remove(&one.entry.to_string()),
            }
        }
    }

    /// Writes the messages.
    pub fn write(&self, root: &Path) -> Result<()> {
        for (stage, _) in all_checks::STAGES {
            let start = format!("wrong/stage{stage}/");
            let of_stage =
                self.0.iter().filter_map(|(name, message)| Some((name.strip_prefix(&start)?, message)));
            let text: String = of_stage.map(|(name, message)| format!("=== {name} ===\n{message}")).collect();
            write(&root.join(messages_file(*stage)), &text)?;
        }
        Ok(())
    }
}

/// Returns the differences between new and stored messages, one text each.
pub fn differences(messages: &Messages, tried: &[TriedEntry]) -> Vec<String> {
    let mut differences = Vec::new();
    for one in tried {
        let (kept, now) = (messages.of(&one.entry), one.message().map(without_rubric));
        if kept != now.as_deref() {
            let (kept, now) = (kept.unwrap_or("nothing\n"), now.as_deref().unwrap_or("nothing\n"));
            let file = messages_file(one.entry.stage);
            differences.push(format!("the message about {} is\n{now}but {file} has\n{kept}", one.entry));
        }
    }
    differences
}

/// Stores the results. With `matrix`, every check of the stage was tried. If `all` is true, every entry was tested, and the
/// results of other entries are deleted.
pub fn bless(root: &Path, tried: &[TriedEntry], matrix: bool, all: bool) -> Result<()> {
    let mut messages = if all { Messages::default() } else { Messages::read(root) };
    messages.set(tried);
    messages.write(root)?;
    if matrix {
        let mut matrix = if all { Matrix::default() } else { Matrix::read(root) };
        for one in tried {
            matrix.0.insert(one.entry.to_string(), row(&one.entry, &one.failures));
        }
        matrix.write(root)?;
    }
    Ok(())
}

/// Writes a file, whole or not at all, and makes its folder.
pub(super) fn write(file: &Path, text: &str) -> Result<()> {
    if let Some(folder) = file.parent() {
        fs::create_dir_all(folder).with_context(|| folder.display().to_string())?;
    }
    let written = write_atomically(file, |out| out.write_all(text.as_bytes()));
    written.with_context(|| format!("{} cannot be written", file.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lines_of_the_rubric_are_left_out() {
        let message = "stage 1 · a law\n  slides: s\n  input     1\n  yours     2\n  again: cargo test\n  stuck: cargo run\n";
        assert_eq!(without_rubric(message), "  input     1\n  yours     2\n");
    }
}
