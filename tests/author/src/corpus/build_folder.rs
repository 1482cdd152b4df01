//! Builds entries in a folder that contains only copies of the scaffold and the solutions, so that a change rebuilds one
//! small crate.
//!
//! Path packages of different folders may have the same hash, and cargo detects changes by modification time. So each
//! build folder has its own target folder, and a file is written only if its text differs. A build in which cargo found the
//! solutions unchanged is an error, because its verdict would belong to the previous entry.

use anyhow::{Context, Result, bail};
use grader::kits::Need;
use grader::room::has_room;
use raykata::rubric;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The most errors of the compiler that are shown.
const MOST_ERRORS: usize = 20;

/// The sources of the solutions.
const SOLUTIONS: &str = "solutions/src";

/// Options for a quick build without debug information. An overflow panics, as in the exercises.
const QUICK_BUILD: [&str; 6] = [
    "--config",
    "profile.dev.debug=false",
    "--config",
    "profile.dev.package.solutions.overflow-checks=true",
    "--config",
    "profile.dev.package.solutions.opt-level=1",
];

/// Without frames, only the functions that changed are compiled, and the scaffold is built at level 1: its build takes half as
/// long as at level 3, and few of its functions run for long.
const WITHOUT_FRAMES: [&str; 4] = [
    "--config",
    "profile.dev.package.solutions.incremental=true",
    "--config",
    "profile.dev.package.raykata.opt-level=1",
];

/// A folder that builds one entry at a time.
pub struct BuildFolder {
    root: PathBuf,
    folder: PathBuf,
    /// What its workers must be able to do.
    need: Need,
}

/// The result of building an entry.
pub enum Built {
    /// The worker that answers with the changed solutions.
    Worker(PathBuf),
    /// The solutions do not compile, with these first errors.
    DoesNotCompile(String),
}

impl BuildFolder {
    /// Opens `jobs` build folders for workers of this kind. The unchanged solutions are known to build in each.
    pub fn open_all(root: &Path, jobs: usize, need: Need) -> Result<Vec<BuildFolder>> {
        let first = BuildFolder::open(root, "0", need)?;
        // Build the reference first. The other build folders copy its compiled crates.
        if let Built::DoesNotCompile(error) = first.build_with(&[])? {
            bail!("the unchanged solutions do not compile:\n{error}");
        }
        let mut build_folders = vec![first];
        for number in 1..jobs {
            let build_folder = BuildFolder::open(root, &number.to_string(), need)?;
            build_folder.take_over(&build_folders[0])?;
            build_folders.push(build_folder);
        }
        Ok(build_folders)
    }

    /// Opens the build folder of this name for the kit at `root` and updates its files, but not yet its solutions.
    pub fn open(root: &Path, name: &str, need: Need) -> Result<BuildFolder> {
        let folder = root.join(super::FOLDER).join(name);
        let build_folder = BuildFolder { root: root.to_owned(), folder, need };
        write_if_new(
            &build_folder.folder.join("Cargo.toml"),
            &cut_manifest(
                &read(&root.join("Cargo.toml"))?,
                &["dev-dependencies", "[test]", "[bench]"],
                &["solutions"],
            ),
        )?;
        write_if_new(
            &build_folder.folder.join("solutions/Cargo.toml"),
            &cut_manifest(&read(&root.join("solutions/Cargo.toml"))?, &["dev-dependencies", "[bench]"], &[]),
        )?;
        // The build of the scaffold reads the rubric.
        for file in rubric::files() {
            write_if_new(&build_folder.folder.join(file), &read(&root.join(file))?)?;
        }
        if !build_folder.folder.join("Cargo.lock").exists() {
            // Use the kit's versions of all crates. Cargo removes the crates that are not needed here.
            write_if_new(&build_folder.folder.join("Cargo.lock"), &read(&root.join("Cargo.lock"))?)?;
        }
        copy_folder(&root.join("src"), &build_folder.folder.join("src"))?;
        Ok(build_folder)
    }

    /// Returns the same build folder for workers of another kind.
    pub fn with(&self, need: Need) -> BuildFolder {
        BuildFolder { root: self.root.clone(), folder: self.folder.clone(), need }
    }

    /// Copies the compiled foreign crates of another build folder, so that they are not built again.
    fn take_over(&self, other: &BuildFolder) -> Result<()> {
        if !self.folder.join("target").exists() {
            copy_with_times(&other.folder.join("target"), &self.folder.join("target"))?;
        }
        Ok(())
    }

    /// Returns the text of a file of the kit.
    pub fn original(&self, file: &str) -> Result<String> {
        read(&self.root.join(file))
    }

    /// Builds the solutions with the texts of some files replaced, and with more files.
    pub fn build_with(&self, changes: &[(&str, &str)]) -> Result<Built> {
        // Collect the files as they must be.
        let (from, to) = (self.root.join(SOLUTIONS), self.folder.join(SOLUTIONS));
        let mut texts: BTreeMap<String, String> = BTreeMap::new();
        for name in names_in(&from)? {
            texts.insert(name.clone(), read(&from.join(&name))?);
        }
        for (file, text) in changes {
            let name = file.strip_prefix(SOLUTIONS).and_then(|name| name.strip_prefix('/'));
            texts.insert(name.context("a file of the solutions")?.to_owned(), (*text).to_owned());
        }
        // Write those that differ, and remove all others. Cargo sees what has changed by the times of the files.
        let mut is_changed = false;
        for (name, text) in &texts {
            is_changed |= write_if_new(&to.join(name), text)?;
        }
        for name in names_in(&to)?.iter().filter(|name| !texts.contains_key(*name)) {
            fs::remove_file(to.join(name)).with_context(|| to.join(name).display().to_string())?;
            is_changed = true;
        }
        let (fresh, built) = self.cargo()?;
        if fresh && is_changed && matches!(built, Built::Worker(_)) {
            bail!(
                "cargo found no change in {:?}, so the answers would be those of other code; remove {} and run this again",
                changes.iter().map(|(file, _)| *file).collect::<Vec<_>>(),
                self.folder.display()
            );
        }
        Ok(built)
    }

    /// Runs cargo. Returns whether it found the solutions unchanged, and the result of the build.
    fn cargo(&self) -> Result<(bool, Built)> {
        let output = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()))
            .current_dir(&self.folder)
            .args(["build", "--quiet", "--package", "solutions", "--bin", "solutions-worker"])
            .args(["--message-format=json", "--target-dir", "target"])
            .args(self.need.feature().map(|feature| format!("--features={feature}")))
            .args(QUICK_BUILD)
            .args(WITHOUT_FRAMES.iter().filter(|_| self.need == Need::Checks))
            .stdin(Stdio::null())
            .output()
            .context("cargo, which builds the entries, cannot be started")?;
        let messages: Vec<Value> = String::from_utf8_lossy(&output.stdout)
            .lines()
            .filter_map(|line| serde_json::from_str(line).ok())
            .collect();
        let artifact = |name: &str| {
            messages
                .iter()
                .find(|message| message["reason"] == "compiler-artifact" && message["target"]["name"] == name)
        };
        // A changed module rebuilds the library; a changed src/worker.rs rebuilds only the program.
        let is_fresh = |name: &str| artifact(name).is_none_or(|built| built["fresh"] != false);
        let fresh = is_fresh("solutions") && is_fresh("solutions-worker");
        let worker = artifact("solutions-worker").and_then(|worker| worker["executable"].as_str());
        match worker {
            Some(worker) if output.status.success() => Ok((fresh, Built::Worker(worker.into()))),
            _ => {
                has_room(&self.folder, "delete something")?;
                let errors = messages.iter().filter(|message| message["message"]["level"] == "error");
                let errors = errors.filter_map(|message| message["message"]["rendered"].as_str());
                let first: Vec<&str> = errors.take(MOST_ERRORS).map(str::trim).collect();
                let stderr = String::from_utf8_lossy(&output.stderr);
                let words = if first.is_empty() { stderr.trim().to_owned() } else { first.join("\n\n") };
                Ok((fresh, Built::DoesNotCompile(words)))
            }
        }
    }
}

/// Returns a manifest without the sections of these names, and with these members if it is that of a workspace.
pub(crate) fn cut_manifest(manifest: &str, without: &[&str], members: &[&str]) -> String {
    let mut cut = String::new();
    let mut keep = true;
    for line in manifest.lines() {
        if line.starts_with('[') {
            let name = line.trim_start_matches('[').trim_end_matches(']');
            keep = !without.iter().any(|section| section.trim_matches(['[', ']']) == name);
        }
        match line {
            _ if !keep || line.starts_with("default-members") => {}
            _ if line.starts_with("members = ") => cut.push_str(&format!("members = {members:?}\n")),
            _ => {
                cut.push_str(line);
                cut.push('\n');
            }
        }
    }
    cut
}

pub(crate) fn read(file: &Path) -> Result<String> {
    fs::read_to_string(file).with_context(|| format!("{} cannot be read", file.display()))
}

/// The names of the files in a folder. There are none if there is no folder.
fn names_in(folder: &Path) -> Result<Vec<String>> {
    if !folder.exists() {
        return Ok(Vec::new());
    }
    let read = fs::read_dir(folder).with_context(|| folder.display().to_string())?;
    read.map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned())).collect()
}

/// Writes a file only if its text differs, so that cargo rebuilds only changed files. Returns whether it was written.
pub(crate) fn write_if_new(file: &Path, text: &str) -> Result<bool> {
    if fs::read_to_string(file).is_ok_and(|old| old == text) {
        return Ok(false);
    }
    let write = || {
        fs::create_dir_all(file.parent().unwrap_or(file))?;
        fs::write(file, text)
    };
    write().with_context(|| format!("{} cannot be written", file.display()))?;
    Ok(true)
}

/// Makes `to` an exact copy of `from`. Folders with a manifest of their own are neither copied nor deleted.
pub(crate) fn copy_folder(from: &Path, to: &Path) -> Result<()> {
    let mut wanted = BTreeSet::new();
    for entry in fs::read_dir(from).with_context(|| from.display().to_string())? {
        let entry = entry?;
        wanted.insert(entry.file_name());
        let target = to.join(entry.file_name());
        if entry.path().join("Cargo.toml").is_file() {
            // Skip a separate package, which the solutions do not need.
            wanted.remove(&entry.file_name());
        } else if entry.file_type()?.is_dir() {
            copy_folder(&entry.path(), &target)?;
        } else {
            write_if_new(&target, &read(&entry.path())?)?;
        }
    }
    for entry in fs::read_dir(to).with_context(|| to.display().to_string())? {
        let entry = entry?;
        if !wanted.contains(&entry.file_name()) && !entry.path().join("Cargo.toml").is_file() {
            let gone = if entry.file_type()?.is_dir() { fs::remove_dir_all } else { fs::remove_file };
            gone(entry.path()).with_context(|| entry.path().display().to_string())?;
        }
    }
    Ok(())
}

/// Copies a folder with the modification times of its files, from which cargo sees which files are up to date.
pub(crate) fn copy_with_times(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    for entry in fs::read_dir(from).with_context(|| from.display().to_string())? {
        let (entry, target) = entry.map(|entry| (entry.path(), to.join(entry.file_name())))?;
        if entry.is_dir() {
            copy_with_times(&entry, &target)?;
        } else {
            fs::copy(&entry, &target)?;
            let modified = fs::metadata(&entry)?.modified()?;
            fs::File::options().write(true).open(&target)?.set_modified(modified)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_manifest_of_a_build_folder_has_one_member_and_no_tests() {
        let root = "[workspace]\nmembers = [\"a\", \"b\"]\ndefault-members = [\".\"]\n[package]\nname = \"r\"\n\
                    [dev-dependencies]\nchecks = \"1\"\n[[test]]\nname = \"s\"\n[lints]\nworkspace = true\n";
        assert_eq!(
            cut_manifest(root, &["dev-dependencies", "[test]"], &["solutions"]),
            "[workspace]\nmembers = [\"solutions\"]\n[package]\nname = \"r\"\n[lints]\nworkspace = true\n"
        );
    }

    #[test]
    fn what_is_the_same_is_not_written_again() {
        let folder = tempfile::tempdir().unwrap();
        let (from, to) = (folder.path().join("from"), folder.path().join("to"));
        write_if_new(&from.join("a/b.txt"), "b").unwrap();
        write_if_new(&to.join("old.txt"), "old").unwrap();
        copy_folder(&from, &to).unwrap();
        assert!(!to.join("old.txt").exists());
        let time = || fs::metadata(to.join("a/b.txt")).unwrap().modified().unwrap();
        let before = time();
        copy_folder(&from, &to).unwrap();
        assert_eq!(before, time());
    }
}
