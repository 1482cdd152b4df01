//! The modules of the grader, as a library for tests and benchmarks. The program is `main.rs`.

/// Prints a line like the macro of the standard library, but ends the program without a panic if the reader has closed the
/// pipe.
macro_rules! println {
    () => { raykata_cli::report::say(format_args!("\n")) };
    ($($words:tt)*) => { raykata_cli::report::say(format_args!("{}\n", format_args!($($words)*))) };
}

pub mod bars;
pub mod cases;
pub mod corpus;
pub mod course;
#[cfg(target_os = "linux")]
pub mod export;
pub mod gaps;
pub mod gauntlet;
pub mod generate;
#[cfg(target_os = "linux")]
pub mod grade;
pub mod handout;
pub mod mutants;
pub mod new_check;
pub mod numbers;
pub mod pictures;
pub mod release;
mod room;
pub mod sandbox;
pub mod sync;
pub mod weaken;

pub use raykata_cli::{kits, queue, report, worker};
