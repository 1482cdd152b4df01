//! Builds programs with changed sources in a folder that contains only copies of the packages that they need, so that a change
//! rebuilds one small crate: the worker of the solutions with an entry of the corpus, and the judge with a changed check.
//!
//! Path packages of different folders may have the same hash, and cargo detects changes by modification time. So each build
//! folder has its own target folder, and a file is written only if its text differs. A build in which cargo found the
//! program unchanged is an error, because its verdict would belong to the previous change.

use all_checks::STAGES;
use anyhow::{Context, Result, bail};
use grader::files_below::files_below;
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

/// The sections of manifests that a build folder does not need.
const LEFT_OUT: [&str; 3] = ["dev-dependencies", "[test]", "[bench]"];

/// What a folder builds.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Product {
    /// The worker of the solutions, which is able to do this.
    Worker(Need),
    /// The judge.
    Judge,
}

impl Product {
    /// The packages besides the scaffold whose sources are copied.
    fn packages(self) -> Vec<String> {
        match self {
            Product::Worker(_) => vec!["solutions".to_owned()],
            Product::Judge => {
                let shared = ["src/cli", "tests/checks", "tests/checks/all", "tests/judge", "tests/oracle"];
                let stages = STAGES.iter().map(|(stage, _)| format!("tests/checks/stage{stage}"));
                shared.map(str::to_owned).into_iter().chain(stages).collect()
            }
        }
    }

    /// The package and the program in it.
    fn program(self) -> (&'static str, &'static str) {
        match self {
            Product::Worker(_) => ("solutions", "solutions-worker"),
            Product::Judge => ("judge", "judge"),
        }
    }

    /// The settings of a quick build without debug information.
    fn profile(self) -> &'static [&'static str] {
        match self {
            // An overflow panics, as in the exercises.
            Product::Worker(Need::Frames) => {
                &["debug=false", "package.solutions.overflow-checks=true", "package.solutions.opt-level=1"]
            }
            // Only the functions that changed are compiled, and the scaffold is built at level 1: its build takes half as long
            // as at level 3, and few of its functions run for long.
            Product::Worker(Need::Checks) => &[
                "debug=false",
                "package.solutions.overflow-checks=true",
                "package.solutions.opt-level=1",
                "package.solutions.incremental=true",
                "package.raykata.opt-level=1",
            ],
            Product::Judge => &[
                "debug=false",
                "package.raykata.opt-level=1",
                "package.judge.opt-level=0",
                "package.judge.incremental=true",
                "package.all-checks.incremental=true",
                "package.all-checks.opt-level=0",
            ],
        }
    }
}

/// A folder that builds one change at a time.
pub struct BuildFolder {
    root: PathBuf,
    folder: PathBuf,
    product: Product,
}

/// The result of a build.
pub enum Built {
    /// The program with the changes.
    Program(PathBuf),
    /// The changed sources do not compile, with these first errors.
    DoesNotCompile(String),
}

impl BuildFolder {
    /// Opens the folder of this name for the kit at `root`, and updates what does not change with each build.
    pub fn open(root: &Path, name: &str, product: Product) -> Result<BuildFolder> {
        let folder = root.join(super::FOLDER).join(name);
        let packages = product.packages();
        let members: Vec<&str> = packages.iter().map(String::as_str).collect();
        for package in [""].iter().chain(&members) {
            let manifest = Path::new(package).join("Cargo.toml");
            let cut = cut_manifest(&read(&root.join(&manifest))?, &LEFT_OUT, &members);
            write_if_new(&folder.join(manifest), &cut)?;
        }
        // The build of the scaffold reads the rubric.
        for file in rubric::files() {
            write_if_new(&folder.join(file), &read(&root.join(file))?)?;
        }
        if !folder.join("Cargo.lock").exists() {
            // Use the kit's versions of all crates. Cargo removes the crates that are not needed here.
            write_if_new(&folder.join("Cargo.lock"), &read(&root.join("Cargo.lock"))?)?;
        }
        if product == Product::Judge {
            copy_with_times(&root.join("tests/golden"), &folder.join("tests/golden"))?;
        }
        Ok(BuildFolder { root: root.to_owned(), folder, product })
    }

    /// Returns the text of a file of the kit.
    pub fn original(&self, file: &str) -> Result<String> {
        read(&self.root.join(file))
    }

    /// Builds the program with the texts of some files replaced, and with more files.
    pub fn build_with<T: AsRef<str>>(&self, changes: &[(T, T)]) -> Result<Built> {
        // Cargo sees what has changed by the times of the files.
        let changes: BTreeMap<&str, &str> =
            changes.iter().map(|(file, text)| (file.as_ref(), text.as_ref())).collect();
        let mut is_changed = copy_folder(&self.root, &self.folder, "src", &changes)?;
        for package in self.product.packages() {
            is_changed |= copy_folder(&self.root, &self.folder, &format!("{package}/src"), &changes)?;
        }
        let (is_fresh, built) = self.cargo()?;
        if is_fresh && is_changed && matches!(built, Built::Program(_)) {
            bail!(
                "cargo found no change in {:?}, so the answers would be those of other code; remove {} and run this again",
                changes.keys().collect::<Vec<_>>(),
                self.folder.display()
            );
        }
        Ok(built)
    }

    /// Runs cargo. Returns whether it found the program unchanged, and the result of the build.
    fn cargo(&self) -> Result<(bool, Built)> {
        let (package, program) = self.product.program();
        let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
        command.current_dir(&self.folder);
        command.args(["build", "--quiet", "--package", package, "--bin", program]);
        command.args(["--message-format=json", "--target-dir", "target"]);
        if let Product::Worker(need) = self.product {
            command.args(need.feature().map(|feature| format!("--features={feature}")));
        }
        for setting in self.product.profile() {
            command.args(["--config".to_owned(), format!("profile.dev.{setting}")]);
        }
        let output = command.stdin(Stdio::null()).output();
        let output = output.context("cargo, which builds the changes, cannot be started")?;
        let messages: Vec<Value> = String::from_utf8_lossy(&output.stdout)
            .lines()
            .filter_map(|line| serde_json::from_str(line).ok())
            .collect();
        let built = messages.iter().find(|message| {
            message["reason"] == "compiler-artifact"
                && message["target"]["name"] == program
                && message["executable"].is_string()
        });
        match built.and_then(|built| Some((built["fresh"] != false, built["executable"].as_str()?))) {
            Some((is_fresh, program)) if output.status.success() => {
                Ok((is_fresh, Built::Program(program.into())))
            }
            _ => {
                has_room(&self.folder, "delete something")?;
                let errors = messages.iter().filter(|message| message["message"]["level"] == "error");
                let errors = errors.filter_map(|message| message["message"]["rendered"].as_str());
                let first: Vec<&str> = errors.take(MOST_ERRORS).map(str::trim).collect();
                let stderr = String::from_utf8_lossy(&output.stderr);
                let words = if first.is_empty() { stderr.trim().to_owned() } else { first.join("\n\n") };
                Ok((false, Built::DoesNotCompile(words)))
            }
        }
    }
}

/// Returns a manifest without the sections of these names, and with these members if it is that of a workspace.
pub fn cut_manifest(manifest: &str, without: &[&str], members: &[&str]) -> String {
    let mut cut = String::new();
    let mut keep = true;
    for line in manifest.lines() {
        if line.starts_with('[') {
            let name = line.trim_start_matches('[').trim_end_matches(']');
            keep = !without.iter().any(|section| section.trim_matches(['[', ']']) == name);
        }
        match line {
            _ if !keep || line.starts_with("default-members") => {}
            _ if line.starts_with("members = ") => cut += &format!("members = {members:?}\n"),
            _ => cut += &format!("{line}\n"),
        }
    }
    cut
}

fn read(file: &Path) -> Result<String> {
    fs::read_to_string(file).with_context(|| format!("{} cannot be read", file.display()))
}

/// Writes a file only if its text differs, so that cargo rebuilds only changed files. Returns whether it was written.
pub fn write_if_new(file: &Path, text: &str) -> Result<bool> {
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

/// Makes the folder `path` below `to` a copy of the one below `from`, with these changes of files. Folders with a manifest of their
/// own are neither copied nor deleted. Returns whether anything was written or deleted.
fn copy_folder(from: &Path, to: &Path, path: &str, changes: &BTreeMap<&str, &str>) -> Result<bool> {
    let mut is_changed = false;
    let mut wanted: BTreeSet<String> = BTreeSet::new();
    for entry in fs::read_dir(from.join(path)).with_context(|| path.to_owned())? {
        let entry = entry?;
        let name = entry.file_name().to_string_lossy().into_owned();
        let inside = format!("{path}/{name}");
        if entry.path().join("Cargo.toml").is_file() {
            continue;
        }
        is_changed |= match (entry.file_type()?.is_dir(), changes.get(inside.as_str())) {
            (true, _) => copy_folder(from, to, &inside, changes)?,
            (false, Some(text)) => write_if_new(&to.join(&inside), text)?,
            (false, None) => write_if_new(&to.join(&inside), &read(&entry.path())?)?,
        };
        wanted.insert(name);
    }
    let added = changes.iter().filter_map(|(file, text)| Some((file.rsplit_once('/')?, text)));
    for ((_, name), text) in added.filter(|((folder, _), _)| *folder == path) {
        is_changed |= wanted.insert(name.to_owned()) && write_if_new(&to.join(path).join(name), text)?;
    }
    for entry in fs::read_dir(to.join(path)).with_context(|| path.to_owned())? {
        let entry = entry?;
        let is_wanted = wanted.contains(&*entry.file_name().to_string_lossy());
        if !is_wanted && !entry.path().join("Cargo.toml").is_file() {
            let gone = if entry.file_type()?.is_dir() { fs::remove_dir_all } else { fs::remove_file };
            gone(entry.path()).with_context(|| entry.path().display().to_string())?;
            is_changed = true;
        }
    }
    Ok(is_changed)
}

/// Copies a folder with the modification times of its files, from which cargo sees which files are up to date.
fn copy_with_times(from: &Path, to: &Path) -> Result<()> {
    for path in files_below(from, "", &|_| true)? {
        let (source, target) = (from.join(&path), to.join(&path));
        fs::create_dir_all(target.parent().unwrap_or(to))?;
        fs::copy(&source, &target)?;
        let modified = fs::metadata(&source)?.modified()?;
        fs::File::options().write(true).open(&target)?.set_modified(modified)?;
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
        write_if_new(&from.join("src/a/b.txt"), "b").unwrap();
        write_if_new(&from.join("src/c.txt"), "c").unwrap();
        write_if_new(&to.join("src/old.txt"), "old").unwrap();
        let copy = |changes: &[(&str, &str)]| {
            copy_folder(&from, &to, "src", &changes.iter().copied().collect()).unwrap()
        };
        let text = |name: &str| fs::read_to_string(to.join("src").join(name)).ok();
        assert!(copy(&[("src/c.txt", "changed"), ("src/a/more.txt", "more")]));
        assert_eq!([text("old.txt"), text("c.txt")], [None, Some("changed".to_owned())]);
        assert_eq!(text("a/more.txt"), Some("more".to_owned()));
        assert!(copy(&[]));
        assert_eq!([text("c.txt"), text("a/more.txt")], [Some("c".to_owned()), None]);
        let time = || fs::metadata(to.join("src/a/b.txt")).unwrap().modified().unwrap();
        let before = time();
        assert!(!copy(&[]));
        assert_eq!(before, time());
    }
}
