//! Keeps finished pieces of long work in a file, one line of JSON each, so that a run that was killed continues where it was. A
//! line is on the disk before the next piece counts as finished. A line that was cut off, because the process was killed or the
//! disk was full, is dropped, and that piece is done again.

use crate::report::make_folder_of;
use anyhow::{Context, Result, bail};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::VecDeque;
use std::fs::{self, File, OpenOptions};
use std::io::{ErrorKind, Write};
use std::path::{Path, PathBuf};

/// The first line of the file.
#[derive(Serialize, Deserialize)]
struct Head {
    /// The version of the format.
    raykata_journal: u32,
    /// What the pieces are of. Pieces of other work are never mixed with them.
    about: String,
}

const VERSION: u32 = 1;

/// How every journal begins.
const FIRST: &[u8] = br#"{"raykata_journal""#;

/// The pieces of an earlier run, and the file to which this run adds its own.
pub struct Journal<T> {
    file: PathBuf,
    out: File,
    /// The length of the complete lines, in bytes.
    length: u64,
    /// The pieces of the earlier run, in its order, with their names.
    kept: VecDeque<(String, T)>,
}

impl<T: Serialize + DeserializeOwned> Journal<T> {
    /// Begins a new journal, in place of any earlier one.
    pub fn create(file: &Path, about: &str) -> Result<Journal<T>> {
        make_folder_of(file)?;
        let out = File::create(file).with_context(|| format!("cannot write {}", file.display()))?;
        let mut journal = Journal { file: file.to_owned(), out, length: 0, kept: VecDeque::new() };
        journal.line(&serde_json::to_string(&Head { raykata_journal: VERSION, about: about.to_owned() })?)?;
        Ok(journal)
    }

    /// Continues the journal of an earlier run; begins one if there is none.
    /// An error if the file is no journal, or is about other work: then it is left as it is.
    pub fn resume(file: &Path, about: &str) -> Result<Journal<T>> {
        let bytes = match fs::read(file) {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::NotFound => return Journal::create(file, about),
            Err(error) => return Err(error).with_context(|| format!("cannot read {}", file.display())),
        };
        let mut lines = bytes.split_inclusive(|byte| *byte == b'\n').take_while(|line| line.ends_with(b"\n"));
        let Some(first) = lines.next() else {
            // A run that was killed at once has left an empty file, or a part of the first line.
            let begins = bytes.len().min(FIRST.len());
            if bytes.len() > 200 || bytes[..begins] != FIRST[..begins] {
                bail!("{} is not a journal of this program: name another file", file.display());
            }
            return Journal::create(file, about);
        };
        match serde_json::from_slice::<Head>(first) {
            Ok(Head { raykata_journal: VERSION, about: theirs }) if theirs == about => {}
            Ok(Head { raykata_journal: VERSION, about: theirs }) => bail!(
                "{} is of other work: {theirs}, and not {about}. Continue with the same, or begin again",
                file.display()
            ),
            _ => bail!(
                "{} is not a journal of this version: begin again, or name another file",
                file.display()
            ),
        }
        // Keep the lines that are complete, and cut off what follows them.
        let mut length = first.len() as u64;
        let mut kept = VecDeque::new();
        for line in lines {
            let Ok(piece) = serde_json::from_slice(line) else { break };
            kept.push_back(piece);
            length += line.len() as u64;
        }
        let out = OpenOptions::new().append(true).open(file).and_then(|out| {
            out.set_len(length)?;
            Ok(out)
        });
        let out = out.with_context(|| format!("cannot write {}", file.display()))?;
        Ok(Journal { file: file.to_owned(), out, length, kept })
    }

    /// Continues the journal of an earlier run of the same work, and begins one in place of any other.
    pub fn open(file: &Path, about: &str) -> Result<Journal<T>> {
        match Journal::<T>::about(file).as_deref() == Some(about) {
            true => Journal::resume(file, about),
            false => Journal::create(file, about),
        }
    }

    /// What the journal in a file is about; `None` if there is none.
    pub fn about(file: &Path) -> Option<String> {
        let text = fs::read(file).ok()?;
        let first = text.split(|byte| *byte == b'\n').next()?;
        serde_json::from_slice(first).ok().map(|Head { about, .. }| about)
    }

    /// The pieces of the earlier run that have not been taken.
    pub fn kept(&self) -> impl Iterator<Item = &(String, T)> {
        self.kept.iter()
    }

    /// Takes the first kept piece of this name.
    pub fn take(&mut self, name: &str) -> Option<T> {
        let place = self.kept.iter().position(|(one, _)| one == name)?;
        self.kept.remove(place).map(|(_, piece)| piece)
    }

    /// Adds a finished piece.
    /// If that fails, for example because the disk is full, the pieces before it are kept.
    pub fn add(&mut self, name: &str, piece: &T) -> Result<()> {
        self.line(&serde_json::to_string(&(name, piece))?)
    }

    /// Deletes the file, because the work is complete.
    pub fn finish(&self) -> Result<()> {
        fs::remove_file(&self.file).with_context(|| format!("cannot delete {}", self.file.display()))
    }

    fn line(&mut self, line: &str) -> Result<()> {
        let line = format!("{line}\n");
        let written = self.out.write_all(line.as_bytes()).and_then(|()| self.out.sync_data());
        if written.is_err() {
            // Cut off what was written of the line, so that the file is valid.
            let _ = self.out.set_len(self.length);
        }
        written.with_context(|| {
            format!(
                "cannot write {}: what is in it is kept, and the next run continues there",
                self.file.display()
            )
        })?;
        self.length += line.len() as u64;
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(journal: &Journal<u32>) -> Vec<&str> {
        journal.kept().map(|(name, _)| name.as_str()).collect()
    }

    /// A process can be killed at any byte.
    #[test]
    fn a_journal_that_ends_anywhere_is_continued_after_its_last_complete_line() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("deep/journal.jsonl");
        let mut journal = Journal::create(&file, "work").unwrap();
        for (name, piece) in [("a", 1), ("b", 2), ("a", 3)] {
            journal.add(name, &piece).unwrap();
        }
        drop(journal);
        let whole = fs::read(&file).unwrap();
        let ends: Vec<usize> = (0..whole.len()).filter(|&at| whole[at] == b'\n').collect();
        for length in 0..=whole.len() {
            fs::write(&file, &whole[..length]).unwrap();
            let mut journal: Journal<u32> = Journal::resume(&file, "work").unwrap();
            let n_kept = ends.iter().filter(|&&end| end < length).count().saturating_sub(1);
            assert_eq!(names(&journal), ["a", "b", "a"][..n_kept], "cut at {length}");
            journal.add("c", &4).unwrap();
            drop(journal);
            let mut again: Journal<u32> = Journal::resume(&file, "work").unwrap();
            assert_eq!(again.kept().count(), n_kept + 1);
            assert_eq!(again.take("c"), Some(4));
            assert_eq!(again.take("c"), None);
        }
    }

    #[test]
    fn other_work_and_other_files_are_refused_and_left_alone() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("journal.jsonl");
        Journal::create(&file, "work").unwrap().add("a", &1).unwrap();
        let error = Journal::<u32>::resume(&file, "other").err().unwrap().to_string();
        assert!(error.contains("is of other work: work, and not other"), "{error}");
        assert_eq!(Journal::<u32>::about(&file).as_deref(), Some("work"));
        assert_eq!(names(&Journal::resume(&file, "work").unwrap()), ["a"]);
        for notes in ["my notes", "my notes\n", "{}\n", "{"] {
            fs::write(&file, notes).unwrap();
            let opened = Journal::<u32>::resume(&file, "work");
            assert_eq!(opened.is_err(), notes != "{", "{notes}");
            assert!(notes == "{" || fs::read_to_string(&file).unwrap() == notes);
        }
    }
}
