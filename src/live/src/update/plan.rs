//! The changes of an update, and how they are made.

use crate::exercise::{Merged, StubsOfFile, beside_unwritten, merge};
use crate::kit::Kit;
use anyhow::{Context, Result, bail};
use live::files::new_folder;
use raykata_cli::report::{make_folder_of, write_file};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

/// The folder whose files belong to the student.
const EXERCISES: &str = "exercises/src/";

/// The file that lists the exercise files.
const MODULES: &str = "exercises/src/lib.rs";

/// All changes of an update.
pub struct Plan {
    /// The new content of each file that changes; `None` removes it.
    files: BTreeMap<String, Option<Vec<u8>>>,
    /// What happens to exercises in which something was written, by path.
    merged: BTreeMap<String, Merged>,
}

impl Plan {
    /// Compares the kits.
    /// An error if exercises of the new kit are written already.
    pub fn new(yours: &Kit, new: &Kit) -> Result<Plan> {
        let mut plan = Plan { files: BTreeMap::new(), merged: BTreeMap::new() };
        for path in &new.files {
            let present = read(&yours.root, path)?;
            let wanted = read(&new.root, path)?
                .with_context(|| format!("{} is not complete: it lacks {path}", new.root.display()))?;
            let wanted = match (present.as_deref().map(std::str::from_utf8), std::str::from_utf8(&wanted)) {
                (Some(Ok(present)), Ok(text)) if path == MODULES => {
                    with_own_modules(present, text).into_bytes()
                }
                (present, Ok(text)) if is_exercise(path) => {
                    let present = present.transpose().with_context(|| format!("{path} is not UTF-8"))?;
                    plan.exercise(path, present, text, [yours, new])?
                }
                _ => wanted,
            };
            if present.as_ref() != Some(&wanted) {
                plan.files.insert(path.clone(), Some(wanted));
            }
        }
        // Remove what was part of the old kit and is not part of the new one, except for exercises.
        for path in yours.files.difference(&new.files).filter(|path| !path.starts_with(EXERCISES)) {
            if read(&yours.root, path)?.is_some() {
                plan.files.insert(path.clone(), None);
            }
        }
        Ok(plan)
    }

    /// The new text of an exercise file, from the student's text and the new kit's. `kits` are both kits, the old one first.
    fn exercise(&mut self, path: &str, yours: Option<&str>, new: &str, kits: [&Kit; 2]) -> Result<Vec<u8>> {
        let stem = Path::new(path).file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let none = StubsOfFile::new();
        let [old_stubs, new_stubs] = kits.map(|kit| kit.stubs.get(&stem).unwrap_or(&none));
        if beside_unwritten(new, new_stubs).is_none() {
            bail!("{} is no fresh hand-out: functions of {path} are written in it", kits[1].root.display());
        }
        let Some(yours) = yours else { return Ok(new.to_owned().into_bytes()) };
        let merged =
            merge(yours, old_stubs, new, new_stubs).with_context(|| format!("{path} cannot be read"))?;
        let bytes = merged.text.clone().into_bytes();
        self.merged.insert(path.to_owned(), merged);
        Ok(bytes)
    }

    /// Whether nothing changes.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// What changes, for the student.
    pub fn summary(&self, yours: &Kit, new: &Kit) -> String {
        let mut text = format!("raykata {} → {}\n", yours.version, new.version);
        let of_kit = || self.files.iter().filter(|(path, _)| !path.starts_with(EXERCISES));
        let is_new = |path: &str| !yours.root.join(path).is_file();
        let count = |wanted: &dyn Fn(&str, &Option<Vec<u8>>) -> bool| {
            of_kit().filter(|(path, content)| wanted(path, content)).count()
        };
        let _ = writeln!(
            text,
            "  files of the kit: {} changed, {} new, {} removed",
            count(&|path, content| content.is_some() && !is_new(path)),
            count(&|path, _| is_new(path)),
            count(&|_, content| content.is_none())
        );
        for path in self.files.keys().filter(|path| path.starts_with(EXERCISES)) {
            let what = match self.merged.get(path) {
                Some(merged) if !merged.kept.is_empty() => {
                    let stay = if merged.kept.len() == 1 { "stays" } else { "stay" };
                    format!("{} that you have written {stay}", counted(merged.kept.len()))
                }
                None if is_new(path) => "new".to_owned(),
                _ => "brought up to date".to_owned(),
            };
            let added = self.merged.get(path).map(|merged| merged.added.join("`, `")).unwrap_or_default();
            let added = if added.is_empty() { added } else { format!("; new: `{added}`") };
            let _ = writeln!(text, "  {path}: {what}{added}");
        }
        for (path, merged) in &self.merged {
            for note in &merged.notes {
                let _ = writeln!(text, "  look at {path}: {note}");
            }
        }
        text
    }

    /// Makes the changes. Returns the folder in which the old files are kept, if there were any. A second call after an error goes
    /// on where this one stopped.
    pub fn make(&self, root: &Path) -> Result<Option<PathBuf>> {
        // Keep all old files before the first one changes.
        let mut kept = None;
        for path in self.files.keys() {
            let Some(old) = read(root, path)? else { continue };
            let folder = match kept.take() {
                Some(folder) => folder,
                None => new_folder(root, "before-update")?,
            };
            write(&folder.join(path), &old)?;
            kept = Some(folder);
        }
        for (path, content) in &self.files {
            let file = root.join(path);
            match content {
                Some(content) => write(&file, content)?,
                None => {
                    fs::remove_file(&file).with_context(|| format!("{} cannot be removed", file.display()))?
                }
            }
        }
        Ok(kept)
    }
}

/// Whether the file contains functions that students write.
fn is_exercise(path: &str) -> bool {
    path.strip_prefix(EXERCISES).is_some_and(|name| name.starts_with("stage") && name.ends_with(".rs"))
}

fn counted(n: usize) -> String {
    match n {
        1 => "the function".to_owned(),
        n => format!("the {n} functions"),
    }
}

/// The list of modules of the new kit, with the modules that the student has added.
fn with_own_modules(yours: &str, new: &str) -> String {
    let is_own = |line: &&str| {
        (line.starts_with("mod ") || line.starts_with("pub mod "))
            && !line.contains(" stage")
            && !new.lines().any(|other| other == *line)
    };
    let own: Vec<&str> = yours.lines().filter(is_own).collect();
    match own.is_empty() {
        true => new.to_owned(),
        false => format!("{}\n{}\n", new.trim_end(), own.join("\n")),
    }
}

/// The bytes of a file, or `None` if there is none.
fn read(root: &Path, path: &str) -> Result<Option<Vec<u8>>> {
    match fs::read(root.join(path)) {
        Ok(bytes) => Ok(Some(bytes)),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(error).with_context(|| format!("{path} cannot be read in {}", root.display())),
    }
}

fn write(file: &Path, content: &[u8]) -> Result<()> {
    make_folder_of(file)?;
    write_file(file, content)
}
