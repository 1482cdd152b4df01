//! Asks a changed judge for verdicts.

use crate::corpus::verdict::without_lines;
use anyhow::{Context, Result};
use checks::Check;
use grader::kits::Source as Kits;
use raykata::worker::{receive, send};
use raykata_cli::verdicts::{CheckTrial, Verdict};
use std::ffi::OsStr;
use std::io::ErrorKind;
use std::path::Path;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};

/// The most memory of a changed judge in KB: a changed loop may allocate without end.
const MEMORY: u64 = 8 << 20;

/// The most processor time of a changed judge in seconds: a changed loop may not end. All trials of a change take less.
const SECONDS: u64 = 90;

/// A program that may not use more memory and processor time than a changed judge.
fn limited(program: &OsStr) -> Command {
    let mut command = Command::new("sh");
    command
        .args(["-c", &format!("ulimit -v {MEMORY}; ulimit -t {SECONDS}; exec \"$0\" \"$@\"")])
        .arg(program);
    command
}

/// A running judge.
pub(super) struct Judge {
    process: Child,
    asks: ChildStdin,
    answers: ChildStdout,
}

impl Judge {
    /// Starts a judge.
    pub fn start(program: &Path) -> Result<Judge> {
        let mut process = limited(program.as_os_str())
            .arg("trials")
            // A judge writes messages to its output, so a snapshot that differs may not be printed there.
            .envs([("INSTA_OUTPUT", "none"), ("INSTA_UPDATE", "no")])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .context("the judge cannot be started")?;
        let asks = process.stdin.take().context("the judge has no input")?;
        let answers = process.stdout.take().context("the judge has no output")?;
        Ok(Judge { process, asks, answers })
    }

    /// The message of a check about a kit; `None` if the kit passes. The messages of a judge that crashes are like no other.
    pub fn message(&mut self, check: &Check, kit: &Kits) -> Result<Option<String>> {
        let asked = CheckTrial {
            stage: check.stage,
            check: check.name.to_owned(),
            worker: kit.program.clone(),
            needs_message: true,
        };
        let answer = send(&mut self.asks, &asked).and_then(|()| receive(&mut self.answers));
        match answer {
            Ok(Verdict::Passed) => Ok(None),
            Ok(Verdict::Failed(message)) => Ok(Some(without_lines(&message))),
            Ok(Verdict::NotWritten { task, .. }) => Ok(Some(task)),
            Err(error) if matches!(error.kind(), ErrorKind::BrokenPipe | ErrorKind::UnexpectedEof) => {
                Ok(Some("the changed judge has crashed".to_owned()))
            }
            Err(error) => Err(error).context("the judge does not answer"),
        }
    }
}

impl Drop for Judge {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
