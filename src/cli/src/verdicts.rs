//! The messages of `judge verdicts`, the verdicts of a stage, each as soon as it is known, and of `judge trials`.

pub use raykata::course::Verdict;
use raykata::message;
use std::path::PathBuf;

/// A check and its verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct CheckVerdict {
    /// The name of the check.
    pub check: String,
    /// Its verdict.
    pub verdict: Verdict,
}

message! { CheckVerdict { check, verdict } }

/// A request to `judge trials`: one check of one worker. The answer is a [`Verdict`].
#[derive(Clone, Debug, PartialEq)]
pub struct CheckTrial {
    /// The stage of the check.
    pub stage: u8,
    /// The name of the check.
    pub check: String,
    /// The program of the worker.
    pub worker: PathBuf,
    /// Whether a failure needs a message. Without one the verdict comes sooner.
    pub needs_message: bool,
}

message! { CheckTrial { stage, check, worker, needs_message } }
