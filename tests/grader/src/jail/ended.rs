//! How a command ended.

use crate::worker::Jailed;
use std::process::ExitStatus;
use std::time::Duration;

/// What became of a command.
#[derive(Debug)]
pub struct Ended {
    /// How it ended.
    pub how: How,
    /// What it said, up to the cap.
    pub stdout: Vec<u8>,
    /// What it complained about, up to the cap.
    pub stderr: Vec<u8>,
    /// Processor time, with its children.
    pub cpu: Duration,
}

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum How {
    /// By itself, with this code.
    Exited(i32),
    /// By a signal that was not ours.
    Signalled(i32),
    /// It did not come to an end.
    TookTooLong,
    /// It has used all the processor time it was given.
    UsedUpCpu,
    /// It wrote more than anybody wants to read.
    WroteTooMuch,
    /// It started more and more processes.
    TooManyProcesses,
}

/// What a signal means for a process that was jailed; `None` if that was not the jail.
#[cfg(target_os = "linux")]
pub fn how_it_died(status: ExitStatus, stderr: &str) -> Option<Jailed> {
    use nix::libc;
    use std::os::unix::process::ExitStatusExt;
    Some(match status.signal()? {
        libc::SIGXCPU => Jailed::Time,
        libc::SIGABRT if stderr.contains("memory allocation of") => Jailed::Memory,
        libc::SIGSYS => Jailed::Other("it asked the kernel for what no exercise needs"),
        // There is no list of its memory in a jail, by which Rust tells one from the other.
        libc::SIGSEGV => Jailed::Other(
            "the stack overflowed, or memory was touched that is not its own: a recursion that never ends?",
        ),
        _ => return None,
    })
}

/// Nothing was jailed.
#[cfg(not(target_os = "linux"))]
pub fn how_it_died(_: ExitStatus, _: &str) -> Option<Jailed> {
    None
}
