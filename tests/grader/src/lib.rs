//! The modules of the grader, as a library for the program `author`, tests and benchmarks. The program is `main.rs`.

// `println!` here does not panic if the reader has closed the pipe.
#[macro_use(println)]
extern crate raykata_cli;

pub mod course;
pub mod exercises;
#[cfg(target_os = "linux")]
pub mod export;
pub mod files_below;
#[cfg(target_os = "linux")]
pub mod grade;
pub mod handout;
pub mod platform;
pub mod program;
pub mod release;
pub mod room;
#[cfg(target_os = "linux")]
pub mod sandbox;

pub use raykata_cli::{kits, queue, report, worker};
