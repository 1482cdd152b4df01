//! The modules of the program `author`, as a library for its tests. The program is `main.rs`.

// `println!` here does not panic if the reader has closed the pipe.
#[macro_use(println)]
extern crate raykata_cli;

#[cfg(target_os = "linux")]
pub mod attacks;
pub mod bars;
pub mod corpus;
pub mod gaps;
pub mod gauntlet;
pub mod generate;
pub mod numbers;
pub mod pictures;
pub mod printed;
#[cfg(target_os = "linux")]
pub mod rehearsal;
#[cfg(target_os = "linux")]
pub mod run_attacks;
pub mod sync;
pub mod weaken;
