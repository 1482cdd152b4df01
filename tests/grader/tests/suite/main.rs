//! All tests of the grader in one program, so that it is linked once and slow tests run in parallel.

#[cfg(target_os = "linux")]
mod command_line;
#[cfg(target_os = "linux")]
mod course;
#[cfg(target_os = "linux")]
mod environments;
mod export;
#[cfg(target_os = "linux")]
mod full_disk;
#[cfg(target_os = "linux")]
mod grade;
mod handout;
mod platforms;
mod program_runs;
mod release;
#[cfg(target_os = "linux")]
mod sandbox;
#[cfg(target_os = "linux")]
mod sandboxed_workers;
#[cfg(target_os = "linux")]
mod slurm;

use std::ffi::OsStr;
use std::process::Output;

/// Runs the program `grader`.
fn grader(arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Output {
    program_runs::run(env!("CARGO_BIN_EXE_grader"), arguments)
}

/// Runs the grader, which must succeed. Returns what it prints.
fn grader_succeeds(arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> String {
    let output = grader(arguments);
    let said = said_by(&output);
    assert!(output.status.success(), "{said}");
    said
}

/// What a program printed to both of its outputs.
fn said_by(output: &Output) -> String {
    let (said, complained) = program_runs::printed(output);
    format!("{said}{complained}")
}
