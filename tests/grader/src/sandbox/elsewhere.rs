//! Where there is no Landlock and no seccomp: nothing is contained, and so nothing runs.

use super::Ended;
use std::io;
use std::process::{Child, Command};
use std::time::Duration;

pub(super) const ONLY_LINUX: &str =
    "submissions can only be contained on Linux: grade them on a Linux machine";

/// Fails.
pub fn run(_: Command, _: &[u8], _: Duration, _: usize) -> io::Result<Ended> {
    Err(io::Error::new(io::ErrorKind::Unsupported, ONLY_LINUX))
}

/// Fails.
pub fn spawn_guarded(_: Command) -> io::Result<Child> {
    Err(io::Error::new(io::ErrorKind::Unsupported, ONLY_LINUX))
}
