//! `raykata update`: builds and starts the program that brings a student's kit to the version of a new hand-out. It is built when
//! it is needed, so that a picture does not wait for that.

use crate::args::{Argument, Given, Opt, Spec};
use crate::kits::{Program, build, root};
use anyhow::{Context, Result, bail};
use std::path::PathBuf;
use std::process::{Command, ExitCode};

/// `raykata update`.
pub static SPEC: Spec = Spec {
    name: "raykata update",
    about: "Bring your kit to the version of a new hand-out. What you have written stays as it is.",
    arguments: &[Argument::required("FOLDER", "The new hand-out.")],
    options: &[&[Opt::flag("--dry-run", "Only say what would change.")]],
};

/// Starts the program, and returns its exit code.
pub fn run(given: &Given) -> Result<ExitCode> {
    let folder = PathBuf::from(given.required(0)?);
    let root = root()?;
    if !folder.is_dir() {
        bail!("there is no folder {}: name the folder of the new hand-out", folder.display());
    }
    let programs = build(&root, "the program that updates", &[Program::UPDATE])?;
    let [update] = &programs[..] else { bail!("the program was not built") };
    let mut command = Command::new(update);
    command.arg(&root).arg(folder).args(given.has("--dry-run").then_some("--dry-run"));
    let status = command.status().with_context(|| format!("{} cannot be started", update.display()))?;
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(ExitCode::from(code.unwrap_or(1)))
}
