//! The attack corpus: submissions that want points they have not earned, or harm, and honest ones that look as if they did.
//! `tests/corpus/attack/NAME/attack.toml` says how one is made and what must come of it; see its neighbour `README.md`.
//!
//! `step` (what attack.toml says) · `make` (the folder or archive) · `source` (changes of a source file) · `pack` (archives
//! that no archiver makes) · `remember` (answers known by heart) · `verdict` (what came of it) · `run` (all of them)
//!
//! Nothing here runs or compiles an attack: that is for the sandbox alone.

mod make;
mod pack;
mod remember;
mod run;
mod source;
mod step;
mod verdict;

pub use make::{CANARY, Place, make};
pub use run::{Tried, run_all};
pub use verdict::{Earned, Expectation, complaints};

use anyhow::{Context, Result, ensure};
use serde::Deserialize;
use std::fs;
use std::path::{Path, PathBuf};

/// Below the root of the kit.
const FOLDER: &str = "tests/corpus/attack";

/// What an attack is after.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Family {
    /// Nothing: it is honest, and must get what it has earned.
    Honest,
    /// A verdict that it writes itself.
    Forging,
    /// The processor, the memory or the end of its worker.
    Exhausting,
    /// Processes, files, memory and networks of others, while it runs.
    Escaping,
    /// Files of others, while it is compiled.
    Including,
    /// The symbols and sections of the program that it is linked into.
    Linking,
    /// What cargo, the compiler and the tests are told by files and variables.
    Settings,
    /// The time and memory of the compiler.
    Compiling,
    /// Whoever opens the archive or walks through the folder.
    Packing,
    /// Whoever judges the answers.
    Answers,
    /// Whoever reads the messages of the worker.
    Protocol,
    /// Points for what is right on known inputs only.
    Guessing,
    /// Whoever reads the report.
    Words,
}

/// What all files of a submission are before the first step.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Base {
    /// As nobody has begun them.
    #[default]
    Stubs,
    /// Those of the stages in question are right.
    Solutions,
    /// Those of the stages in question give answers that no check accepts, so that every point is a forged one.
    Wrong,
    /// There are none.
    Nothing,
}

/// A submission and what must come of it.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Attack {
    /// Name of its folder.
    #[serde(skip)]
    pub name: String,
    /// Where its description and its fragments are.
    #[serde(skip)]
    pub folder: PathBuf,
    /// What it is, in a few words.
    pub title: String,
    /// What it tries, and what a grader that trusts it would do.
    pub what: String,
    /// What it is after.
    pub family: Family,
    /// Its number in the catalogue of attacks that this corpus began with, if it is from there.
    pub catalogue: Option<u8>,
    /// What `cargo test` says of it as it was handed in.
    pub naive: Option<String>,
    /// What its files are before the first step.
    #[serde(default)]
    pub base: Base,
    /// The name of the submission, if it is another one than that of the attack.
    pub student: Option<String>,
    /// The same as bytes in hexadecimal, for names that are no text.
    pub student_hex: Option<String>,
    /// What is graded.
    #[serde(default = "stage_one")]
    pub stages: Vec<u8>,
    /// How long it may take to grade, on an idle machine.
    #[serde(default = "a_minute")]
    pub most_seconds: u64,
    /// How it is made, one thing after the other.
    #[serde(default)]
    pub step: Vec<step::Step>,
    /// What must come of it.
    pub expect: Expectation,
    /// What must come of it if the syntax check lets it pass, so that the sandbox itself is tried.
    pub without_lint: Option<Expectation>,
}

fn stage_one() -> Vec<u8> {
    vec![1]
}

fn a_minute() -> u64 {
    60
}

/// All attacks of the kit at `root`, by name.
pub fn load(root: &Path) -> Result<Vec<Attack>> {
    let folder = root.join(FOLDER);
    let entries = fs::read_dir(&folder).with_context(|| folder.display().to_string())?;
    let mut folders: Vec<PathBuf> = entries.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
    folders.retain(|path| path.is_dir());
    folders.sort();
    folders.iter().map(|folder| read(folder)).collect()
}

/// Those of these names; all, if none is named.
pub fn choose(attacks: Vec<Attack>, names: &[String]) -> Result<Vec<Attack>> {
    for name in names {
        ensure!(attacks.iter().any(|attack| attack.name == *name), "{FOLDER} has no attack `{name}`");
    }
    Ok(attacks.into_iter().filter(|attack| names.is_empty() || names.contains(&attack.name)).collect())
}

fn read(folder: &Path) -> Result<Attack> {
    let file = folder.join("attack.toml");
    let shown = || file.display().to_string();
    let text = fs::read_to_string(&file).with_context(shown)?;
    let mut attack: Attack = toml::from_str(&text).with_context(shown)?;
    attack.name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    attack.folder = folder.to_owned();
    Ok(attack)
}

#[cfg(test)]
mod tests;
