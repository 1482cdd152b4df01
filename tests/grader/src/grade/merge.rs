//! `grader merge`: combines the grades of the parts of a class. It writes nothing if a part is missing.

use super::finish;
use super::shard;
use super::store::{self, Store};
use crate::course::CourseFiles;
use anyhow::{Result, bail, ensure};
use raykata_cli::args::{Argument, Given, Opt, Spec};
use std::path::{Path, PathBuf};

/// `grader merge`.
pub static SPEC: Spec = Spec {
    name: "grader merge",
    about: "Combine the grades that `grade --shard` made of the parts of a class. If a part is \
            missing or not finished, nothing is written, and an error names it.",
    arguments: &[Argument::required("PART", "The folders of the parts.").many()],
    options: &[&[Opt::value("--out", "FOLDER", "The folder for the grades of the whole class.").required()]],
};

/// Combines the parts of a class. Returns whether every submission could be graded.
pub fn run(given: &Given) -> Result<bool> {
    given.required(0)?;
    let parts: Vec<PathBuf> = given.arguments(0).iter().map(PathBuf::from).collect();
    let out = given.required_path("--out")?;
    // A folder that cannot be used is named together with the parts that are missing.
    let mut faults = Vec::new();
    let mut known = Vec::new();
    for folder in &parts {
        match part_of(folder) {
            Ok(part) => known.extend(part.map(|part| (folder.display().to_string(), part))),
            Err(error) => faults.push(format!("{error:#}")),
        }
    }
    faults.extend(shard::faults(&known));
    if !faults.is_empty() {
        bail!(
            "the class is not complete, so nothing is merged:\n{}\nhelp: `grader grade … --shard I/N --resume` grades a \
             part, or what is left of it; for Slurm: `sbatch --array=I grade.sbatch`",
            faults.join("\n")
        );
    }
    // Copy the grades.
    crate::report::make_folder(&out)?;
    let store = Store::claim(&out)?;
    ensure!(store.session()?.is_none(), "{} already contains grades; choose another folder", out.display());
    // The titles and texts of the reports are those of the course.
    let course = match parts.first() {
        Some(first) => Store::open(first)?.course()?,
        None => None,
    };
    course.as_ref().map_or(Ok(()), CourseFiles::apply)?;
    store.take_over(&parts)?;
    store.keep_course(course.as_ref())?;
    finish(&store, &out)
}

/// Returns which part of a class is in a folder; `None` if it was graded without `--shard`.
fn part_of(folder: &Path) -> Result<Option<shard::Part>> {
    ensure!(folder.join(store::FILE).is_file(), "{} contains no grades", folder.display());
    let store = Store::open(folder)?;
    ensure!(store.session()?.is_some(), "{} contains no grades", folder.display());
    store.part()
}
