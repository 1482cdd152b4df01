//! The modules of the program `author`, as a library for its tests. The program is `main.rs`.

/// Prints a line like the macro of the standard library, but ends the program without a panic if the reader has closed the
/// pipe.
macro_rules! println {
    () => { raykata_cli::report::say(format_args!("\n")) };
    ($($words:tt)*) => { raykata_cli::report::say(format_args!("{}\n", format_args!($($words)*))) };
}

#[cfg(target_os = "linux")]
pub mod attacks;
pub mod bars;
pub mod cases;
pub mod corpus;
pub mod gaps;
pub mod gauntlet;
pub mod generate;
pub mod mutants;
pub mod new_check;
pub mod numbers;
pub mod pictures;
pub mod printed;
#[cfg(target_os = "linux")]
pub mod rehearsal;
#[cfg(target_os = "linux")]
pub mod run_attacks;
pub mod sync;
pub mod weaken;
