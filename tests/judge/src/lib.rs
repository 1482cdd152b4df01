//! The judge: runs the checks and the exact oracle on a kit, which runs in a worker. It is a separate
//! program, so that `raykata` can render a picture without building it; the grader uses its modules as well.

/// Prints a line like the macro of the standard library, but does not panic if the reader has closed the pipe.
macro_rules! println {
    () => { raykata_cli::report::say(format_args!("\n")) };
    ($($words:tt)*) => { raykata_cli::report::say(format_args!("{}\n", format_args!($($words)*))) };
}

pub mod again;
pub mod boxes_and_offsets;
pub mod gauntlet;
pub mod hits;
pub mod leak_table;
pub mod pixel;
pub mod scorecard;
pub mod table;
pub mod trials;
