//! Keeps the results of a run of the corpus, so that a run that was stopped can be continued.

use super::FOLDER;
use super::entry::Entry;
use super::verdict::{Fate, Tried};
use anyhow::{Context, Result};
use raykata_cli::fingerprint::fingerprint;
use raykata_cli::journal::Journal;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// A result as it is kept: the fate, and the messages of the failed checks.
type Kept = (Fate, BTreeMap<String, String>);

/// The results of this run and of the one that it continues.
pub(super) struct Tested(Mutex<Journal<Kept>>);

/// Everything in the kit that decides a result besides the entry itself.
const DECIDE: [&str; 9] = [
    "Cargo.lock",
    "Cargo.toml",
    "solutions/src",
    "src",
    "tests/checks",
    "tests/course.toml",
    "tests/golden",
    "tests/language.toml",
    "tests/oracle",
];

impl Tested {
    /// Continues the last run, or begins a new one.
    pub fn open(root: &Path, resume: bool, seed: Option<u64>) -> Result<Tested> {
        let file = root.join(FOLDER).join("corpus.jsonl");
        let seed = seed.map_or("no seed".to_owned(), |seed| format!("--seed {seed}"));
        let about = format!("the corpus with {seed} and the code {}", code(root, &DECIDE)?);
        let journal = if resume { Journal::resume(&file, &about)? } else { Journal::create(&file, &about)? };
        Ok(Tested(Mutex::new(journal)))
    }

    /// Takes the kept result of an entry.
    pub fn take(&self, entry: &Entry) -> Option<Tried> {
        let (fate, messages) = self.0.lock().unwrap_or_else(PoisonError::into_inner).take(&name(entry))?;
        let known = |name: &str| {
            let mut checks = all_checks::STAGES.iter().flat_map(|(_, checks)| *checks);
            checks.find(|check| check.name == name).map(|check| check.name)
        };
        let failures = messages.into_iter().map(|(name, message)| Some((known(&name)?, message)));
        Some(Tried { entry: entry.clone(), fate, failures: failures.collect::<Option<_>>()? })
    }

    /// Keeps a result.
    pub fn add(&self, tried: &Tried) -> Result<()> {
        let messages = tried.failures.iter().map(|(name, message)| ((*name).to_owned(), message.clone()));
        let kept = (tried.fate.clone(), messages.collect());
        self.0.lock().unwrap_or_else(PoisonError::into_inner).add(&name(&tried.entry), &kept)
    }

    /// Deletes the kept results, because all entries are tested.
    pub fn finish(self) -> Result<()> {
        self.0.into_inner().unwrap_or_else(PoisonError::into_inner).finish()
    }
}

/// The name of an entry with a fingerprint of its content.
fn name(entry: &Entry) -> String {
    format!("{entry} {}", fingerprint([format!("{entry:?}").as_bytes()]))
}

/// A fingerprint of these files and folders of the kit.
pub(crate) fn code(root: &Path, paths: &[&str]) -> Result<String> {
    let mut files: Vec<PathBuf> = Vec::new();
    let mut waiting: Vec<PathBuf> = paths.iter().map(|path| root.join(path)).collect();
    while let Some(path) = waiting.pop() {
        if path.is_dir() {
            let inside = fs::read_dir(&path).with_context(|| format!("cannot read {}", path.display()))?;
            waiting.extend(inside.map(|entry| Ok(entry?.path())).collect::<Result<Vec<_>>>()?);
        } else {
            files.push(path);
        }
    }
    files.sort();
    let read = |file: &PathBuf| fs::read(file).with_context(|| format!("cannot read {}", file.display()));
    let texts = files.iter().map(read).collect::<Result<Vec<_>>>()?;
    Ok(fingerprint(texts.iter().map(Vec::as_slice)))
}
