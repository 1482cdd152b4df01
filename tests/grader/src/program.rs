//! The command lines of `grader` and `author`.

use crate::kits::root;
use anyhow::Result;
use raykata_cli::args::Misuse;
pub use raykata_cli::program::{Program, exit_code};
use std::path::Path;
use std::process::ExitCode;

/// A command and its function, which returns whether it succeeded.
pub type Command = raykata_cli::program::Command<bool>;

/// The main function of a program. If this process was started as a launcher of untrusted code or as the syntax check, it does
/// only that.
pub fn main(program: &Program<bool>) -> ExitCode {
    #[cfg(target_os = "linux")]
    {
        crate::sandbox::launch_if_asked();
        crate::grade::lint_if_asked();
    }
    program.main()
}

/// Runs a command in the kit around the working folder. Errors of the command line are reported first, even outside of a
/// kit.
pub fn in_kit<T, R>(options: Result<T, Misuse>, work: impl FnOnce(&Path, &T) -> Result<R>) -> Result<R> {
    let options = options?;
    work(&root()?, &options)
}

/// The result of a command that always succeeds if there is no error.
pub fn done(result: Result<()>) -> Result<bool> {
    result.map(|()| true)
}
