//! In place of the jail where only one's own code runs: nothing has to be contained, and so no jail can be made.

use crate::worker::Jailed;
use std::convert::Infallible;
use std::io;
use std::path::Path;
use std::process::{Child, Command, ExitStatus};

/// How a launcher that could not jail itself would end.
pub const NOT_LAUNCHED: i32 = 126;

/// What its message would begin with.
pub const NOT_LAUNCHED_BECAUSE: &str = "the jail: ";

/// There is none.
pub struct Jail {
    /// How much of the machine it would leave.
    pub limits: Limits,
    never: Infallible,
}

/// How much of the machine a jailed process may use.
pub struct Limits {
    /// Address space.
    pub memory_bytes: u64,
}

impl Jail {
    /// Cannot be called.
    pub fn command(&self, _: &Path) -> Command {
        match self.never {}
    }
}

/// Nothing was jailed.
pub fn how_it_died(_: ExitStatus, _: &str) -> Option<Jailed> {
    None
}

/// Fails.
pub fn spawn_guarded(_: Command) -> io::Result<Child> {
    Err(io::Error::new(io::ErrorKind::Unsupported, "there is no jail in the student's tool"))
}

/// What the kernel says about processes.
pub mod processes {
    use std::time::Duration;

    /// Only what is jailed has its time counted.
    pub fn cpu_time(_: u32) -> Option<Duration> {
        None
    }
}
