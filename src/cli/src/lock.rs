//! Locks on the files and folders of results, so that two runs never mix theirs.

use crate::report::make_folder_of;
use anyhow::{Context, Result, bail};
use std::ffi::OsString;
use std::fs::{File, OpenOptions, TryLockError};
use std::path::Path;

/// A lock that this process holds until the value is dropped. The system releases it if the process is killed.
#[derive(Debug)]
pub struct Lock {
    _file: File,
}

impl Lock {
    /// Locks the results at `place`, a file or a folder that need not exist, by a file beside it.
    /// An error if another process, or another part of this one, has locked them.
    pub fn on(place: &Path) -> Result<Lock> {
        make_folder_of(place)?;
        let mut name = OsString::from(".");
        name.push(place.file_name().with_context(|| format!("{} has no name", place.display()))?);
        name.push(".lock");
        Lock::file(&place.with_file_name(name), || {
            format!(
                "another run is writing to {}: wait until it has ended, or choose another place",
                place.display()
            )
        })
    }

    /// Locks this file, and creates it if it does not exist. `taken` is the message if the lock is taken.
    pub fn file(path: &Path, taken: impl FnOnce() -> String) -> Result<Lock> {
        let file = OpenOptions::new().create(true).append(true).open(path);
        let file = file.with_context(|| format!("cannot write {}", path.display()))?;
        match file.try_lock() {
            Ok(()) => Ok(Lock { _file: file }),
            Err(TryLockError::WouldBlock) => bail!(taken()),
            Err(TryLockError::Error(error)) => {
                Err(error).with_context(|| format!("cannot lock {}", path.display()))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_run_writes_to_a_place_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let place = folder.path().join("deep/results");
        let first = Lock::on(&place).unwrap();
        let error = Lock::on(&place).unwrap_err().to_string();
        assert!(error.contains("another run is writing to"), "{error}");
        Lock::on(&place.with_extension("json")).unwrap();
        drop(first);
        Lock::on(&place).unwrap();
        assert!(!place.exists());
    }
}
