//! Starts the judge, the program that contains the checks and the exact oracle. It is built when it is
//! needed, so that a picture does not wait for that.

use crate::kits::{Need, Program, Which, build};
use anyhow::{Context, Result};
use raykata::message::Message;
use raykata::worker::{receive, send};
use std::ffi::OsStr;
use std::path::Path;
use std::process::{Child, Command, ExitCode, Stdio};

/// Runs the judge with a command such as `check` on a kit, and returns its exit code.
pub fn judge<S: AsRef<OsStr>>(root: &Path, what: &str, which: Which, more: &[S]) -> Result<ExitCode> {
    let whose = match which {
        Which::Exercises => "your exercises and their judge",
        Which::Solutions => "the solutions and their judge",
    };
    let programs = build(root, whose, &[Program::JUDGE, Program::worker(which, Need::Checks)])?;
    let [judge, worker] = &programs[..] else { anyhow::bail!("the judge was not built") };
    let mut command = Command::new(judge);
    let status = command.arg(what).arg(root).arg(worker).args(more).status();
    let status = status.with_context(|| format!("{} cannot be started", judge.display()))?;
    let code = status.code().and_then(|code| u8::try_from(code).ok());
    Ok(ExitCode::from(code.unwrap_or(1)))
}

/// A judge that gets requests through its standard input and answers through its standard output.
pub struct Judge(Child);

impl Judge {
    /// Starts the judge with this command.
    pub fn start(root: &Path, what: &str) -> Result<Judge> {
        let programs = build(root, "the judge of your exercises", &[Program::JUDGE])?;
        let program = programs.first().context("the judge was not built")?;
        let child = Command::new(program).arg(what).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn();
        Ok(Judge(child.with_context(|| format!("{} cannot be started", program.display()))?))
    }

    /// Sends a message to the judge.
    pub fn send<T: Message>(&mut self, message: &T) -> Result<()> {
        let pipe = self.0.stdin.as_mut().context("the judge has no standard input")?;
        send(pipe, message).context("the judge accepts no message")
    }

    /// The next message of the judge.
    pub fn receive<T: Message>(&mut self) -> Result<T> {
        let pipe = self.0.stdout.as_mut().context("the judge has no standard output")?;
        receive(pipe).context("the judge does not answer")
    }
}

impl Drop for Judge {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}
