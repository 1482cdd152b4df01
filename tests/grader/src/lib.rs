//! The parts of the grader, so that tests and benchmarks can reach them. The program is `main.rs`.

/// Prints a line as the macro of the standard library does, but ends in peace when nobody reads it any more.
macro_rules! println {
    () => { raykata_cli::report::say(format_args!("\n")) };
    ($($words:tt)*) => { raykata_cli::report::say(format_args!("{}\n", format_args!($($words)*))) };
}

pub mod cases;
pub mod corpus;
#[cfg(target_os = "linux")]
pub mod export;
pub mod gaps;
pub mod gauntlet;
pub mod generate;
#[cfg(target_os = "linux")]
pub mod grade;
pub mod handout;
pub mod mutants;
pub mod pictures;
pub mod sandbox;
pub mod sync;

pub use raykata_cli::{kits, queue, report, worker};
