//! Notices that files have changed, by looking at their times. This works on every file system, also where the system
//! reports no events: in WSL, in containers, on network drives.

use anyhow::{Context, Result, bail};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// The time and the length of each source file.
type Times = BTreeMap<PathBuf, (SystemTime, u64)>;

/// The source files in a folder and its subfolders.
pub struct Files {
    folder: PathBuf,
    /// The files as they were when a change was reported last.
    reported: Times,
    /// The files at the previous look.
    previous: Times,
}

impl Files {
    /// Begins with the files as they are now.
    #[must_use]
    pub fn new(folder: PathBuf) -> Files {
        let now = times(&folder);
        Files { folder, reported: now.clone(), previous: now }
    }

    /// Whether files have changed since the last time that this was `true`. Two looks in a row must be the same, because an
    /// editor may write several files, or one file in several steps.
    pub fn have_changed(&mut self) -> bool {
        let now = times(&self.folder);
        let is_quiet = now == self.previous;
        self.previous = now;
        let changed = is_quiet && self.previous != self.reported;
        if changed {
            self.reported.clone_from(&self.previous);
        }
        changed
    }
}

/// The files of Rust in a folder. A file that disappears while it is looked at is left out.
fn times(folder: &Path) -> Times {
    let mut found = Times::new();
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        if path.is_dir() {
            found.extend(times(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs")
            && let Ok(about) = fs::metadata(&path)
            && let Ok(time) = about.modified()
        {
            found.insert(path, (time, about.len()));
        }
    }
    found
}

/// The names of the entries of a folder; none if it cannot be read.
pub fn names_in(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect()
}

/// Makes a new folder in `out`, in which old texts are kept: `NAME-1`, or a larger number.
pub fn new_folder(root: &Path, name: &str) -> Result<PathBuf> {
    let out = root.join("out");
    fs::create_dir_all(&out).with_context(|| format!("{} cannot be made", out.display()))?;
    for number in 1.. {
        let folder = out.join(format!("{name}-{number}"));
        match fs::create_dir(&folder) {
            Ok(()) => return Ok(folder),
            Err(error) if error.kind() == std::io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error).with_context(|| format!("{} cannot be made", folder.display())),
        }
    }
    bail!("out/ is full")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_is_reported_once_and_only_when_it_is_over() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("a.rs");
        fs::write(&file, "1").unwrap();
        let mut files = Files::new(folder.path().to_owned());
        assert!(!files.have_changed());
        fs::write(&file, "22").unwrap();
        assert!(!files.have_changed(), "the first look after a change waits for a second one");
        fs::write(&file, "333").unwrap();
        assert!(!files.have_changed(), "it is still changing");
        assert!(files.have_changed());
        assert!(!files.have_changed());
    }

    #[test]
    fn new_removed_and_renamed_files_count_and_other_files_do_not() {
        let folder = tempfile::tempdir().unwrap();
        let mut files = Files::new(folder.path().to_owned());
        let mut change = |name: &str| {
            let _ = files.have_changed();
            assert_eq!(files.have_changed(), name.ends_with(".rs"), "{name}");
        };
        fs::write(folder.path().join("a.rs~"), "1").unwrap();
        change("a.rs~");
        fs::create_dir(folder.path().join("inside")).unwrap();
        fs::write(folder.path().join("inside/a.rs"), "1").unwrap();
        change("inside/a.rs");
        fs::rename(folder.path().join("inside/a.rs"), folder.path().join("b.rs")).unwrap();
        change("b.rs");
        fs::remove_file(folder.path().join("b.rs")).unwrap();
        change("removed.rs");
    }
}
