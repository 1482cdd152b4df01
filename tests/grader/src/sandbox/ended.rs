//! How a command ended.

use crate::worker::Death;
use nix::libc;
use std::os::unix::process::ExitStatusExt;
use std::process::ExitStatus;
use std::time::Duration;

/// The result of a command.
#[derive(Debug)]
pub struct Ended {
    /// How it ended.
    pub how: How,
    /// Its standard output, up to the cap.
    pub stdout: Vec<u8>,
    /// Its standard error, up to the cap.
    pub stderr: Vec<u8>,
    /// Its processor time, with that of its children.
    pub cpu: Duration,
}

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum How {
    /// It exited with this code.
    Exited(i32),
    /// A signal ended it that the grader did not send.
    Signalled(i32),
    /// It exceeded the time limit.
    TookTooLong,
    /// It exceeded the limit of processor time.
    UsedUpCpu,
    /// It wrote more output than allowed.
    WroteTooMuch,
    /// It started too many processes.
    TooManyProcesses,
}

/// Explains the signal that ended a process with this memory limit. Returns `None` if the sandbox did not cause it.
pub(super) fn how_it_died(status: ExitStatus, stderr: &str, memory: u64) -> Option<Death> {
    let crashed = |how: &str| Death::Crashed(how.to_owned());
    Some(match status.signal()? {
        libc::SIGXCPU => Death::TimedOut,
        libc::SIGABRT if stderr.contains("memory allocation of") => {
            Death::Crashed(format!("it used more memory than its limit of {}", size(memory)))
        }
        libc::SIGSYS => crashed("it made a system call that no exercise needs"),
        // Rust distinguishes the two by the process's memory map, which a sandbox hides.
        libc::SIGSEGV => crashed(
            "the stack overflowed, or memory was touched outside of the program: look for infinite recursion",
        ),
        _ => return None,
    })
}

fn size(bytes: u64) -> String {
    if bytes.is_multiple_of(1 << 30) {
        format!("{} GiB", bytes >> 30)
    } else {
        format!("{} MiB", bytes >> 20)
    }
}
