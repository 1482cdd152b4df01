//! `raykata grade`: a verdict on each submission of a class, reached outside the students' processes.

mod lint;
pub mod report;
pub mod result;
mod submission;
