//! All tests of the program `author` in one program, so that it is linked once and slow tests run in parallel.

mod boxes_and_offsets;
mod cases;
#[cfg(target_os = "linux")]
mod command_line;
mod corpus;
#[cfg(target_os = "linux")]
mod full_disk;
#[cfg(target_os = "linux")]
mod one_build;
mod paste;
mod pictures;
#[path = "../../../grader/tests/suite/program_runs.rs"]
mod program_runs;
mod sync;
mod weight;

/// Runs the program `author`.
fn author(arguments: &[&str]) -> std::process::Output {
    program_runs::run(env!("CARGO_BIN_EXE_author"), arguments)
}
