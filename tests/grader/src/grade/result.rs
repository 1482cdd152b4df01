//! What grading a submission gives: everything that reports are made of, and nothing else.

use serde::{Deserialize, Serialize};

/// How a check ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// The law holds, on the inputs that students have and on hidden ones.
    Passed,
    /// There is no code to judge.
    NotWritten,
    /// The law is broken on the inputs that students have as well.
    Wrong,
    /// The law holds on the inputs that students have, and is broken on hidden ones.
    WrongOnHidden,
    /// No answer in time.
    TooLong,
    /// The process that answered was gone: it crashed, ended itself, or took more than it was given.
    Crashed,
    /// The file does not compile; the file of another stage was put in place of what it needed.
    DoesNotCompile,
    /// The file holds what no exercise needs.
    Refused,
    /// The submission had used up its time before.
    NotTried,
}

impl Outcome {
    /// All of them.
    pub const ALL: [Outcome; 9] = [
        Outcome::Passed,
        Outcome::NotWritten,
        Outcome::Wrong,
        Outcome::WrongOnHidden,
        Outcome::TooLong,
        Outcome::Crashed,
        Outcome::DoesNotCompile,
        Outcome::Refused,
        Outcome::NotTried,
    ];

    /// In a word or three, for tables.
    pub fn words(self) -> &'static str {
        match self {
            Outcome::Passed => "passed",
            Outcome::NotWritten => "not written",
            Outcome::Wrong => "wrong",
            Outcome::WrongOnHidden => "wrong on hidden inputs",
            Outcome::TooLong => "too long",
            Outcome::Crashed => "crashed",
            Outcome::DoesNotCompile => "does not compile",
            Outcome::Refused => "refused",
            Outcome::NotTried => "not tried",
        }
    }
}

/// A check of a submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckResult {
    /// Its stage.
    pub stage: u8,
    /// Its name, unique in its stage.
    pub name: String,
    /// How it ended.
    pub outcome: Outcome,
    /// What it is worth.
    pub points: u32,
    /// What was earned: all of `points`, or nothing.
    pub earned: u32,
    /// For the student: what went wrong, without anything that is hidden. Empty if it passed. Plain text of several lines
    /// that may quote what student code has said; control characters have been taken out.
    pub message: String,
    /// What says more than words, if the check compares pictures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub picture: Option<Picture>,
}

/// A picture for the student.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Picture {
    /// What it shows, in words.
    pub caption: String,
    /// The bytes of a PNG file, in base64.
    pub png: String,
}

/// A file of a submission that was not taken, or taken in another way than as it is.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Remark {
    /// As the submission names it; what is no text is replaced.
    pub file: String,
    /// What was done and why, as a sentence.
    pub what: String,
}

/// A submission, graded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Graded {
    /// Name of the folder or archive, without ending.
    pub student: String,
    /// SHA-256 of what was taken from it, in hexadecimal.
    pub content: String,
    /// All checks of the stages that were asked for, in the order of the lecture.
    pub checks: Vec<CheckResult>,
    /// What was ignored or replaced, and why.
    pub remarks: Vec<Remark>,
    /// The compiler's messages, if there were errors; empty otherwise.
    pub compiler: String,
    /// Why nothing could be graded (an archive that cannot be read, …); empty otherwise.
    pub trouble: String,
    /// Processor time of everything, in milliseconds. Differs from run to run, so `results.json` leaves it out.
    #[serde(default)]
    pub cpu_ms: u64,
}

impl Graded {
    /// Points that were earned, and points that there were.
    pub fn points(&self) -> (u32, u32) {
        sum(self.checks.iter())
    }

    /// The stages, in order.
    pub fn stages(&self) -> Vec<u8> {
        let mut stages: Vec<u8> = self.checks.iter().map(|check| check.stage).collect();
        stages.dedup();
        stages
    }

    /// The checks of a stage.
    pub fn of_stage(&self, stage: u8) -> impl Iterator<Item = &CheckResult> {
        self.checks.iter().filter(move |check| check.stage == stage)
    }
}

/// Points that were earned, and points that there were.
pub fn sum<'a>(checks: impl Iterator<Item = &'a CheckResult>) -> (u32, u32) {
    checks.fold((0, 0), |(earned, points), check| (earned + check.earned, points + check.points))
}

/// How a class was graded: the same for every submission of it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Session {
    /// Version of the kit and fingerprint of its checks and rubric.
    pub kit: String,
    /// The stages that were asked for, in order.
    pub stages: Vec<u8>,
    /// Picks the hidden inputs; the same for all students.
    pub seed: u64,
    /// How submissions were contained, in a line.
    pub isolation: String,
}

/// A class, graded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Class {
    /// How.
    pub session: Session,
    /// Sorted by name.
    pub students: Vec<Graded>,
}
