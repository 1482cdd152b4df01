//! `raykata grade`: a verdict on each submission of a class, reached outside the students' processes.

pub mod attacks;
mod lint;
pub mod result;
mod submission;
