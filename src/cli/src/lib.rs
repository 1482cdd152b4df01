//! The parts of the program `raykata`, so that tests and the programs of instructors can reach them.

/// Prints a line like the macro of the standard library, but does not panic if the reader has closed the pipe.
#[macro_export]
macro_rules! println {
    () => { $crate::report::say(format_args!("\n")) };
    ($($words:tt)*) => { $crate::report::say(format_args!("{}\n", format_args!($($words)*))) };
}

pub mod args;
pub mod caption;
pub mod columns;
pub mod compare;
pub mod cost;
pub mod doctor;
pub mod explain;
pub mod fingerprint;
pub mod finish;
pub mod half_blocks;
pub mod html;
pub mod journal;
pub mod judge;
pub mod kits;
pub mod list;
pub mod lock;
pub mod merge_picture;
mod picture_file;
pub mod piece;
pub mod program;
pub mod programs;
pub mod progress;
pub mod quality_options;
pub mod queue;
pub mod race;
pub mod render;
pub mod report;
pub mod slides;
pub mod strip;
pub mod svg;
pub mod touch;
pub mod tree;
pub mod verdicts;
pub mod worker;
