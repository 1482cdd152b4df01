//! Stores the tested changes, one line each, so that a stopped run can be continued.

use super::Fate;
use super::list::Mutant;
use anyhow::{Context, Result};
use std::collections::BTreeMap;
use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The fates of changes, in memory and in a file.
pub struct Journal {
    file: PathBuf,
    out: File,
    fates: BTreeMap<String, Fate>,
}

impl Journal {
    /// Opens the journal of the last run, or an empty one.
    pub fn open(root: &Path, keep: bool) -> Result<Journal> {
        let file = root.join(crate::corpus::FOLDER).join("mutants.jsonl");
        let text = || format!("{}", file.display());
        std::fs::create_dir_all(file.parent().unwrap_or(root)).with_context(text)?;
        let mut fates = BTreeMap::new();
        if keep {
            let text = std::fs::read_to_string(&file)
                .with_context(|| format!("{}: there is no earlier run", text()))?;
            // The last line of a killed run may be incomplete. Then that change is tested again.
            fates.extend(text.lines().filter_map(|line| serde_json::from_str::<(String, Fate)>(line).ok()));
        }
        let out = OpenOptions::new()
            .create(true)
            .write(true)
            .append(keep)
            .truncate(!keep)
            .open(&file)
            .with_context(text)?;
        let mut journal = Journal { file, out, fates };
        if keep {
            journal.line("")?;
        }
        Ok(journal)
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
        self.line(&serde_json::to_string(&(mutant.change(), &fate))?)?;
        self.fates.insert(mutant.change(), fate);
        Ok(())
    }

    fn line(&mut self, line: &str) -> Result<()> {
        writeln!(self.out, "{line}").with_context(|| format!("cannot write {}", self.file.display()))
    }
}
