//! All tests of the grader in one program, so that it is linked once and slow tests run in parallel.

mod boxes_and_offsets;
mod cases;
#[cfg(target_os = "linux")]
mod command_line;
mod corpus;
#[cfg(target_os = "linux")]
mod course;
#[cfg(target_os = "linux")]
mod export;
#[cfg(target_os = "linux")]
mod full_disk;
#[cfg(target_os = "linux")]
mod grade;
mod handout;
#[cfg(target_os = "linux")]
mod long_runs;
#[cfg(target_os = "linux")]
mod new_check;
mod one_build;
mod paste;
mod pictures;
mod program_runs;
mod release;
#[cfg(target_os = "linux")]
mod sandbox;
#[cfg(target_os = "linux")]
mod sandboxed_workers;
#[cfg(target_os = "linux")]
mod slurm;
mod sync;
