//! The modules of the grader, as a library for the program `author`, tests and benchmarks. The program is `main.rs`.

/// Prints a line like the macro of the standard library, but ends the program without a panic if the reader has closed the
/// pipe.
macro_rules! println {
    () => { raykata_cli::report::say(format_args!("\n")) };
    ($($words:tt)*) => { raykata_cli::report::say(format_args!("{}\n", format_args!($($words)*))) };
}

pub mod course;
pub mod exercises;
#[cfg(target_os = "linux")]
pub mod export;
pub mod files_below;
#[cfg(target_os = "linux")]
pub mod grade;
pub mod handout;
pub mod program;
pub mod release;
pub mod room;
#[cfg(target_os = "linux")]
pub mod sandbox;

pub use raykata_cli::{kits, queue, report, worker};
