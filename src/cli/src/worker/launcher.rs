//! How the process of a worker is started, and how its end is interpreted.

use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus};
use std::time::Duration;

/// Starts the process of a worker and interprets its end. The grader implements it with a sandbox for untrusted code.
pub trait Launcher: Send + Sync {
    /// The command that starts `program`.
    fn command(&self, program: &Path) -> Command;

    /// Starts the command.
    fn spawn(&self, command: Command) -> io::Result<Child>;

    /// The reason why the process ended with `status`, if the sandbox knows it; `stderr` is what the process
    /// wrote there.
    fn death(&self, status: ExitStatus, stderr: &str) -> Option<Death>;

    /// The processor time that the process has used so far.
    fn cpu_time(&self, process: u32) -> Duration;
}

/// The reason why the process of a worker ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Death {
    /// It used up its processor time.
    TimedOut,
    /// Another reason, in words.
    Crashed(String),
}
