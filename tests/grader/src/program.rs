//! The command lines of `grader` and `author`.

pub use raykata_cli::program::{Program, exit_code};
use std::process::ExitCode;

/// A command and its function, which returns whether it succeeded. It reads the whole command line before it looks for the kit, so
/// that errors of the command line are reported first, even outside of a kit.
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
