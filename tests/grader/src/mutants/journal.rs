//! Keeps the fates of the tested changes, so that a stopped run can be continued.

use super::list::Mutant;
use anyhow::{Result, ensure};
use raykata_cli::journal::Journal as Kept;
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::path::Path;

/// The fates of changes, in memory and in a file.
pub struct Journal<F> {
    kept: Kept<F>,
    fates: BTreeMap<String, F>,
}

impl<F: Clone + Serialize + DeserializeOwned> Journal<F> {
    /// Opens the journal `about.jsonl` of the last run, or an empty one. The code may differ between runs: `--again` tests
    /// survivors after a new check.
    pub fn open(root: &Path, about: &str, keep: bool) -> Result<Journal<F>> {
        let file = root.join(crate::corpus::FOLDER).join(format!("{about}.jsonl"));
        ensure!(!keep || file.exists(), "{}: there is no earlier run", file.display());
        let kept = if keep { Kept::resume(&file, about)? } else { Kept::create(&file, about)? };
        // A change that was tested again has a second line, which counts.
        let fates = kept.kept().cloned().collect();
        Ok(Journal { kept, fates })
    }

    /// Returns the fate of this change, if it was tested.
    pub(super) fn of(&self, mutant: &Mutant) -> Option<&F> {
        self.fates.get(&mutant.change())
    }

    /// Deletes the fates of these changes, so that they are tested again.
    pub(super) fn forget(&mut self, mutants: &[Mutant]) {
        for mutant in mutants {
            self.fates.remove(&mutant.change());
        }
    }

    pub(super) fn write(&mut self, mutant: &Mutant, fate: F) -> Result<()> {
        self.kept.add(&mutant.change(), &fate)?;
        self.fates.insert(mutant.change(), fate);
        Ok(())
    }
}
