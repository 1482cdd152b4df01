//! Keeps the verdicts of the tested changes, so that a stopped run can be continued.

use super::MutantVerdict;
use super::list::Mutant;
use anyhow::{Result, ensure};
use raykata_cli::journal::Journal as Kept;
use std::collections::BTreeMap;
use std::path::Path;

/// What the file keeps.
const ABOUT: &str = "mutants";

/// The verdicts of changes, in memory and in a file.
pub(super) struct Journal {
    kept: Kept<MutantVerdict>,
    verdicts: BTreeMap<String, MutantVerdict>,
}

impl Journal {
    /// Opens the journal `mutants.jsonl` of the last run, or an empty one. The code may differ between runs: `--again` tests
    /// survivors after a new check.
    pub fn open(root: &Path, keep: bool) -> Result<Journal> {
        let file = root.join(crate::corpus::FOLDER).join("mutants.jsonl");
        ensure!(!keep || file.exists(), "{}: there is no earlier run", file.display());
        let kept = if keep { Kept::resume(&file, ABOUT)? } else { Kept::create(&file, ABOUT)? };
        // A change that was tested again has a second line, which counts.
        let verdicts = kept.kept().cloned().collect();
        Ok(Journal { kept, verdicts })
    }

    /// Returns the verdict of this change, if it was tested.
    pub(super) fn of(&self, mutant: &Mutant) -> Option<&MutantVerdict> {
        self.verdicts.get(&mutant.change())
    }

    /// Deletes the verdicts of these changes, so that they are tested again.
    pub(super) fn forget(&mut self, mutants: &[Mutant]) {
        for mutant in mutants {
            self.verdicts.remove(&mutant.change());
        }
    }

    pub(super) fn write(&mut self, mutant: &Mutant, verdict: MutantVerdict) -> Result<()> {
        self.kept.add(&mutant.change(), &verdict)?;
        self.verdicts.insert(mutant.change(), verdict);
        Ok(())
    }
}
