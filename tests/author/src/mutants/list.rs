//! Lists the changes that the tool cargo-mutants makes.

use crate::corpus::build_folder::BuildFolder;
use anyhow::{Context, Result, bail, ensure};
use serde::Deserialize;
use std::fmt;
use std::path::Path;
use std::process::{Command, Stdio};

/// The comment that cargo-mutants puts at the end of a changed line.
const MARK: &str = " /* ~ changed by cargo-mutants ~ */";

/// One change of one function.
#[derive(Clone, Deserialize)]
pub struct Mutant {
    /// The file, from the root of the kit: `solutions/src/…`.
    pub file: String,
    /// The difference as `diff -u` prints it.
    pub diff: String,
    /// A description of place and change.
    name: String,
}

impl Mutant {
    /// Returns the stage of the exercise, if the file is one.
    pub fn stage(&self) -> Option<u8> {
        let name = self.file.strip_prefix("solutions/src/stage")?;
        name.split('_').next()?.parse().ok()
    }

    /// Describes file and change without lines and columns, because edits move these.
    fn words(&self) -> String {
        let words = self.name.splitn(4, ':').nth(3).unwrap_or(&self.name);
        format!("{}:{words}", self.file)
    }

    /// Returns the text of the file with the change.
    pub fn apply(&self, build_folder: &BuildFolder) -> Result<String> {
        let original = build_folder.original(&self.file)?;
        applied(&self.diff, &original).with_context(|| format!("{self}\n    does not fit {}", self.file))
    }

    /// Returns the lines that the change removes.
    pub fn was(&self) -> String {
        self.lines('-')
    }

    /// Returns the lines that the change adds.
    pub fn becomes(&self) -> String {
        self.lines('+')
    }

    fn lines(&self, sign: char) -> String {
        let lines = self.diff.lines().skip(2).filter_map(|line| line.strip_prefix(sign));
        lines.map(|line| line.replace(MARK, "").trim().to_owned()).collect::<Vec<_>>().join("\n")
    }

    /// Returns a key that identifies the change.
    pub fn change(&self) -> String {
        format!("{}\n- {}\n+ {}", self.words(), self.was(), self.becomes())
    }
}

impl fmt::Display for Mutant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n    - {}\n    + {}", self.name, self.was(), self.becomes())
    }
}

/// Returns a text with a difference applied, as `diff -u` prints it.
fn applied(diff: &str, text: &str) -> Result<String> {
    let mut lines: Vec<&str> = text.split('\n').collect();
    // From the last part on, so that the lines of those before keep their places.
    for part in diff.split("\n@@ -").skip(1).collect::<Vec<_>>().into_iter().rev() {
        let (place, part) = part.split_once('\n').unwrap_or((part, ""));
        let first = place.split([',', ' ']).next().unwrap_or_default().parse::<usize>();
        let first = first.with_context(|| format!("`{place}` names no line"))?.saturating_sub(1);
        let without = |sign: char| {
            let lines = part.lines().filter(move |line| !line.starts_with([sign, '\\']));
            lines.map(|line| line.get(1..).unwrap_or_default())
        };
        let old: Vec<&str> = without('+').collect();
        let is_there = lines.get(first..).is_some_and(|rest| rest.starts_with(&old));
        ensure!(is_there, "its lines are not in the file:\n    {}", old.join("\n    "));
        lines.splice(first..first + old.len(), without('-'));
    }
    Ok(lines.join("\n"))
}

/// Lists all changes of these packages.
pub fn all(root: &Path, packages: &[String]) -> Result<Vec<Mutant>> {
    let output = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .current_dir(root)
        .args(["mutants", "--list", "--json", "--diff"])
        .args(packages.iter().flat_map(|package| ["--package", package]))
        .stdin(Stdio::null())
        .output()
        .context("cargo cannot be started")?;
    if !output.status.success() {
        bail!(
            "cargo-mutants, which lists the changes, does not run (`cargo install cargo-mutants` installs it):\n{}",
            String::from_utf8_lossy(&output.stderr).trim()
        );
    }
    let mutants: Vec<Mutant> = serde_json::from_slice(&output.stdout)
        .context("the list of cargo-mutants cannot be read; its version may be too new")?;
    Ok(mutants)
}

#[cfg(test)]
mod tests {
    use super::applied;

    #[test]
    fn a_difference_is_applied_where_it_fits() {
        let diff = "--- a/a.rs\n+++ b/a.rs\n@@ -1,2 +1,3 @@\n one\n-two\n+zwei\n+drei\n";
        assert_eq!(applied(diff, "one\ntwo\n").unwrap(), "one\nzwei\ndrei\n");
        assert!(applied(diff, "one\nthree\n").unwrap_err().to_string().contains("not in the file"));
    }
}
