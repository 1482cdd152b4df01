//! How a command ended.

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
