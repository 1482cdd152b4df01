//! The tests of `raykata` in one program, so that it is linked once and slow tests run in parallel.

mod compare;
mod cost;
mod curriculum;
mod pieces;
mod program;
mod program_runs;
mod race;
mod slides;
