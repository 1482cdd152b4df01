//! Systems without Landlock and seccomp: there is no sandbox, so nothing is run.

use super::Ended;
use std::io;
use std::process::{Child, Command};
use std::time::Duration;

pub(super) const ONLY_LINUX: &str = "the sandbox works only on Linux: grade submissions on a Linux machine";

/// Returns an error.
pub fn run(_: Command, _: &[u8], _: Duration, _: usize) -> io::Result<Ended> {
    Err(io::Error::new(io::ErrorKind::Unsupported, ONLY_LINUX))
}

/// Returns an error.
pub fn spawn_guarded(_: Command) -> io::Result<Child> {
    Err(io::Error::new(io::ErrorKind::Unsupported, ONLY_LINUX))
}
