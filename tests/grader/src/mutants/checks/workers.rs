//! The entries of the corpus as workers, which are built when they are first needed and kept.

use crate::corpus::FOLDER;
use crate::corpus::entry::{self, Claim, Entry};
use crate::corpus::records::{Matrix, message_file};
use crate::corpus::tested;
use crate::corpus::workshop::{Built, Workshop};
use crate::kits::Need;
use all_checks::STAGES;
use anyhow::{Context, Result, bail};
use checks::Check;
use raykata_cli::fingerprint::fingerprint;
use std::collections::BTreeSet;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

/// The entries of the corpus, and where their workers are.
pub(super) struct Workers {
    root: PathBuf,
    folder: PathBuf,
    workshop: Workshop,
    entries: Vec<Entry>,
    matrix: Matrix,
    /// A fingerprint of the code that an entry changes.
    version: String,
}

/// The code that decides a worker besides its entry.
const DECIDE: [&str; 5] = ["Cargo.lock", "Cargo.toml", "solutions/Cargo.toml", "solutions/src", "src"];

/// A check and a kit, with the result of the unchanged check.
pub(super) struct Trial<'a> {
    /// The check.
    pub check: &'static str,
    /// The entry; `None` is the reference.
    pub entry: Option<&'a Entry>,
    /// Whether the check rejects it.
    pub fails: bool,
    /// The message, if the corpus keeps it.
    pub message: Option<String>,
    /// The stage of the check.
    pub stage: u8,
}

impl Trial<'_> {
    /// The name of the entry.
    pub fn entry_name(&self) -> String {
        self.entry.map_or("the reference".into(), ToString::to_string)
    }
}

/// A trial that the check passes.
fn trial<'a>(stage: u8, check: &'static Check, entry: Option<&'a Entry>) -> Trial<'a> {
    Trial { check: check.name, entry, fails: false, message: None, stage }
}

/// Whether the corpus says that this check catches the entry.
fn catches(entry: &Entry, check: &Check) -> bool {
    matches!(&entry.claim, Claim::Wrong { caught_by, .. } if caught_by == check.name)
}

impl fmt::Display for Trial<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the verdict of `{}` about {}", self.check, self.entry_name())
    }
}

impl Workers {
    /// Reads the corpus.
    pub fn open(root: &Path) -> Result<Workers> {
        let workshop = Workshop::open_all(root, 1, Need::Checks)?.into_iter().next();
        Ok(Workers {
            root: root.to_owned(),
            folder: root.join(FOLDER).join("workers"),
            workshop: workshop.context("there is no workshop")?,
            entries: entry::read_all(root)?,
            matrix: Matrix::read(root),
            version: tested::code(root, &DECIDE)?,
        })
    }

    /// The trials of some checks: first the reference, then the mistakes that each check rejects, then the right solutions of
    /// the functions that these mistakes change. Mistakes that a check accepts say little about it.
    pub fn trials(&self, stage: u8, checks: &[&'static Check]) -> Vec<Trial<'_>> {
        let of_stage: Vec<&Entry> = self.entries.iter().filter(|entry| entry.stage == stage).collect();
        let fails = |entry: &Entry, check: &Check| {
            let row = self.matrix.0.get(&entry.to_string());
            row.is_some_and(|row| row.split(' ').any(|name| name.trim_start_matches('=') == check.name))
        };
        let trial = |check: &'static Check, entry| trial(stage, check, entry);
        let mut trials: Vec<Trial<'_>> = checks.iter().map(|check| trial(check, None)).collect();
        let mut files: Vec<BTreeSet<&str>> = Vec::new();
        for check in checks {
            let rejected: Vec<&Entry> =
                of_stage.iter().copied().filter(|entry| fails(entry, check)).collect();
            files.push(rejected.iter().map(|entry| entry.file.as_str()).collect());
            trials.extend(rejected.into_iter().map(|entry| {
                let message = catches(entry, check).then(|| self.kept_message(entry)).flatten();
                Trial { fails: true, message, ..trial(check, Some(entry)) }
            }));
        }
        for (check, files) in checks.iter().zip(files) {
            let right = of_stage.iter().filter(|entry| {
                entry.claim == Claim::Right && files.contains(entry.file.as_str()) && !fails(entry, check)
            });
            trials.extend(right.map(|entry| trial(check, Some(*entry))));
        }
        trials
    }

    /// A short series of trials of all checks, for code that all of them share: first the reference, then one mistake per
    /// check, which that check catches.
    pub fn trials_of_all(&self) -> Vec<Trial<'_>> {
        let checks = || STAGES.iter().flat_map(|(stage, checks)| checks.iter().map(|check| (*stage, check)));
        let mut trials: Vec<Trial<'_>> = checks().map(|(stage, check)| trial(stage, check, None)).collect();
        trials.extend(checks().filter_map(|(stage, check)| {
            let entry = self.entries.iter().find(|entry| entry.stage == stage && catches(entry, check))?;
            Some(Trial { fails: true, message: self.kept_message(entry), ..trial(stage, check, Some(entry)) })
        }));
        trials
    }

    /// The message about a mistake that the corpus keeps.
    fn kept_message(&self, entry: &Entry) -> Option<String> {
        fs::read_to_string(message_file(&self.root, entry)).ok()
    }

    /// The worker of an entry, or of the reference.
    pub fn worker(&self, entry: Option<&Entry>) -> Result<PathBuf> {
        let (file, text) = match entry {
            None => ("solutions/src/lib.rs".to_owned(), self.workshop.original("solutions/src/lib.rs")?),
            Some(entry) => (entry.file.clone(), entry.apply(&self.workshop.original(&entry.file)?)?),
        };
        let name = fingerprint([self.version.as_bytes(), file.as_bytes(), text.as_bytes()]);
        let kept = self.folder.join(name);
        if kept.exists() {
            return Ok(kept);
        }
        let built = match entry {
            None => self.workshop.build_original()?,
            Some(entry) => self.workshop.build(&entry.file, &entry.diff)?,
        };
        let Built::Worker(worker) = built else {
            bail!(
                "{} does not compile or does not apply",
                entry.map_or("the reference".into(), ToString::to_string)
            );
        };
        fs::create_dir_all(&self.folder).with_context(|| self.folder.display().to_string())?;
        // A copy that was cut off must not be taken for a worker.
        let part = kept.with_extension("part");
        fs::copy(&worker, &part)
            .and_then(|_| fs::rename(&part, &kept))
            .with_context(|| format!("cannot write {}", kept.display()))?;
        Ok(kept)
    }
}
