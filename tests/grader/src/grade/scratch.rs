//! The temporary folders in which submissions are compiled.

use anyhow::{Context, Result};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// What the names of the folders begin with, before the number of the process.
const PREFIX: &str = "raykata-grade-";

/// Makes an empty folder. It is deleted when it is dropped.
pub fn folder() -> Result<TempDir> {
    let prefix = format!("{PREFIX}{}-", std::process::id());
    tempfile::Builder::new()
        .prefix(&prefix)
        .tempdir()
        .context("cannot make a temporary folder for the compiler")
}

/// Deletes the folders of graders that were killed before they could.
pub fn clean() {
    clean_in(&std::env::temp_dir());
}

fn clean_in(folder: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries {
        let name = entry.file_name();
        let process =
            name.to_str().and_then(|name| name.strip_prefix(PREFIX)?.split('-').next()?.parse::<u32>().ok());
        if process.is_some_and(|process| !Path::new(&format!("/proc/{process}")).exists()) {
            // Folders of other users cannot be deleted, and need not be.
            let _ = fs::remove_dir_all(entry.path());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_of_killed_graders_are_deleted_and_no_others() {
        let place = tempfile::tempdir().unwrap();
        let own = format!("{PREFIX}{}-x", std::process::id());
        // No process has the largest number.
        let killed = format!("{PREFIX}{}-x", u32::MAX);
        for name in [&own, &killed, "raykata-grade-notes", "other"] {
            fs::create_dir_all(place.path().join(name).join("deep")).unwrap();
        }
        clean_in(place.path());
        let mut left: Vec<_> = fs::read_dir(place.path())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        left.sort();
        assert_eq!(left, ["other", &own, "raykata-grade-notes"]);
    }
}
