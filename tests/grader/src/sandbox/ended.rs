//! How a command ended.

use crate::worker::Death;
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

/// What a signal means for a process that was given so much memory; `None` if that was not the sandbox.
#[cfg(target_os = "linux")]
pub(super) fn how_it_died(status: ExitStatus, stderr: &str, memory: u64) -> Option<Death> {
    use nix::libc;
    use std::os::unix::process::ExitStatusExt;
    let crashed = |how: &str| Death::Crashed(how.to_owned());
    Some(match status.signal()? {
        libc::SIGXCPU => Death::TimedOut,
        libc::SIGABRT if stderr.contains("memory allocation of") => {
            Death::Crashed(format!("it took more memory than the {} it was given", size(memory)))
        }
        libc::SIGSYS => crashed("it asked the kernel for what no exercise needs"),
        // There is no list of its memory in a sandbox, by which Rust tells one from the other.
        libc::SIGSEGV => crashed(
            "the stack overflowed, or memory was touched that is not its own: a recursion that never ends?",
        ),
        _ => return None,
    })
}

/// Nothing was sandboxed.
#[cfg(not(target_os = "linux"))]
pub(super) fn how_it_died(_: ExitStatus, _: &str, _: u64) -> Option<Death> {
    None
}

#[cfg(target_os = "linux")]
fn size(bytes: u64) -> String {
    if bytes.is_multiple_of(1 << 30) {
        format!("{} GiB", bytes >> 30)
    } else {
        format!("{} MiB", bytes >> 20)
    }
}
