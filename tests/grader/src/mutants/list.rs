//! The changes, as the tool cargo-mutants lists them.

use anyhow::{Context, Result, bail};
use serde::Deserialize;
use std::fmt;
use std::path::Path;
use std::process::{Command, Stdio};

/// What cargo-mutants writes at the end of a changed line.
const MARK: &str = " /* ~ changed by cargo-mutants ~ */";

/// One change of one function.
#[derive(Deserialize)]
pub struct Mutant {
    /// The file, from the root of the kit: `solutions/src/…`.
    pub file: String,
    /// The difference as `diff -u` prints it.
    pub diff: String,
    /// Place and change in words.
    name: String,
}

impl Mutant {
    /// The stage whose exercise the file is, if it is one.
    pub fn stage(&self) -> Option<u8> {
        let name = self.file.strip_prefix("solutions/src/stage")?;
        name.split('_').next()?.parse().ok()
    }

    /// The file and the change in words, without lines and columns, which move.
    fn words(&self) -> String {
        let words = self.name.splitn(4, ':').nth(3).unwrap_or(&self.name);
        format!("{}:{words}", self.file)
    }

    /// The lines that the change takes away.
    pub fn was(&self) -> String {
        self.lines('-')
    }

    /// The lines that the change puts there.
    pub fn becomes(&self) -> String {
        self.lines('+')
    }

    fn lines(&self, sign: char) -> String {
        let lines = self.diff.lines().skip(2).filter_map(|line| line.strip_prefix(sign));
        lines.map(|line| line.replace(MARK, "").trim().to_owned()).collect::<Vec<_>>().join("\n")
    }

    /// What it is known by.
    pub fn change(&self) -> String {
        format!("{}\n- {}\n+ {}", self.words(), self.was(), self.becomes())
    }
}

impl fmt::Display for Mutant {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}\n    - {}\n    + {}", self.name, self.was(), self.becomes())
    }
}

/// All changes of solutions/src.
pub fn all(root: &Path) -> Result<Vec<Mutant>> {
    let output = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
        .current_dir(root)
        .args(["mutants", "--list", "--json", "--diff", "--package", "solutions"])
        .stdin(Stdio::null())
        .output()
        .context("cargo cannot be started")?;
    if !output.status.success() {
        bail!(
            "cargo-mutants, which lists the changes, does not run (`cargo install cargo-mutants` installs it):\n{}",
            String::from_utf8_lossy(&output.stderr).trim()
        );
    }
    serde_json::from_slice(&output.stdout)
        .context("what cargo-mutants lists cannot be read; its version may be too new")
}
