//! The judge: runs the checks and the exact oracle on a kit, which runs in a worker. It is a separate
//! program, so that `raykata` can render a picture without building it; the grader uses its modules as well.

// `println!` here does not panic if the reader has closed the pipe.
#[macro_use(println)]
extern crate raykata_cli;

pub mod again;
pub mod boxes_and_offsets;
pub mod gauntlet;
pub mod hits;
pub mod leak_table;
pub mod lint;
pub mod pixel;
pub mod scorecard;
pub mod table;
pub mod trials;
