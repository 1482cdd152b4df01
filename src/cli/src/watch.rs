//! `raykata watch`: builds and starts the program that follows a student's edits. It is built when it is needed, so that a
//! picture does not wait for that.

use crate::args::{Given, Spec};
use crate::kits::{Program, build, root};
use crate::list;
use anyhow::{Context, Result, bail};
use std::process::{Command, ExitCode};

/// `raykata watch`.
pub static SPEC: Spec = Spec {
    name: "raykata watch",
    about: "Compile and check your exercises at each save, and show what comes next.",
    arguments: &[list::STAGE],
    options: &[],
};

/// Starts the program with the stage of the command line, and returns its exit code.
pub fn run(given: &Given) -> Result<ExitCode> {
    let stage = list::stage(given)?;
    let root = root()?;
    let programs = build(&root, "the judge of your exercises", &[Program::WATCH, Program::JUDGE])?;
    let [watch, _] = &programs[..] else { bail!("the program was not built") };
    let mut command = Command::new(watch);
    let status = command.arg(&root).args(stage.map(|stage| stage.to_string())).status();
    let status = status.with_context(|| format!("{} cannot be started", watch.display()))?;
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(ExitCode::from(code.unwrap_or(1)))
}
