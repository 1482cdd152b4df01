//! Keeps the fates of the tested changes, so that a stopped run can be continued.

use super::Fate;
use super::list::Mutant;
use anyhow::{Result, ensure};
use raykata_cli::journal::Journal as Kept;
use std::collections::BTreeMap;
use std::path::Path;

/// What the file keeps.
const ABOUT: &str = "mutants";

/// The fates of changes, in memory and in a file.
pub(super) struct Journal {
    kept: Kept<Fate>,
    fates: BTreeMap<String, Fate>,
}

impl Journal {
    /// Opens the journal `mutants.jsonl` of the last run, or an empty one. The code may differ between runs: `--again` tests
    /// survivors after a new check.
    pub fn open(root: &Path, keep: bool) -> Result<Journal> {
        let file = root.join(crate::corpus::FOLDER).join("mutants.jsonl");
        ensure!(!keep || file.exists(), "{}: there is no earlier run", file.display());
        let kept = if keep { Kept::resume(&file, ABOUT)? } else { Kept::create(&file, ABOUT)? };
        // A change that was tested again has a second line, which counts.
        let fates = kept.kept().cloned().collect();
        Ok(Journal { kept, fates })
    }

    /// Returns the fate of this change, if it was tested.
    pub(super) fn of(&self, mutant: &Mutant) -> Option<&Fate> {
        self.fates.get(&mutant.change())
    }

    /// Deletes the fates of these changes, so that they are tested again.
    pub(super) fn forget(&mut self, mutants: &[Mutant]) {
        for mutant in mutants {
            self.fates.remove(&mutant.change());
        }
    }

    pub(super) fn write(&mut self, mutant: &Mutant, fate: Fate) -> Result<()> {
        self.kept.add(&mutant.change(), &fate)?;
        self.fates.insert(mutant.change(), fate);
        Ok(())
    }
}
