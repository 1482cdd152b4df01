//! The verdict of a check.

use crate::message;

/// The result of a check for the student.
#[derive(Clone, Debug, PartialEq)]
pub enum Verdict {
    /// The law holds.
    Passed,
    /// The student's function is still a gap.
    NotWritten {
        /// What to write.
        task: String,
        /// The place of the gap, as `file:line`.
        place: String,
    },
    /// The law is broken, or the code crashed or did not end: the message for the student.
    Failed(String),
}

message! { enum Verdict { Passed, NotWritten { task, place }, Failed(message) } }
