//! What the overview of a class keeps of each submission. A class may have many thousands, so it is little.

use super::names::FileNames;
use crate::grade::result::{Graded, Note, Outcome, Session, score};

/// A submission in the overview.
pub(super) struct Line {
    /// The name, cleaned.
    pub student: String,
    /// The name of the files of the student, without an ending.
    pub page: String,
    /// The earned points of all stages, without bonus points, and with those of the instructor.
    pub points: u32,
    /// What the instructor adds.
    pub note: Option<Note>,
    /// The earned points of the core of all stages.
    pub core: u32,
    /// The earned bonus points of all stages.
    pub bonus: u32,
    /// The earned points of each graded stage.
    pub of_stages: Vec<(u8, u32)>,
    pub n_checks: usize,
    pub n_remarks: usize,
    /// Why nothing could be graded; empty otherwise.
    pub trouble: String,
    pub cpu_ms: u64,
    /// When it was handed in; empty if unknown.
    pub handed_in: String,
    /// The stages that were handed in late.
    pub late: Vec<u8>,
    /// Which outcomes occur, a bit for each of [`Outcome::ALL`].
    outcomes: u16,
}

impl Line {
    /// The line of a cleaned submission. `student` is its name before it was cleaned.
    pub fn new(graded: &Graded, student: &str, session: &Session, names: &mut FileNames) -> Line {
        let of_stage = |stage| (stage, score(graded.of_stage(stage)).points().0);
        Line {
            student: graded.student.clone(),
            page: names.name(student),
            points: graded.earned(),
            note: graded.note.clone(),
            core: graded.score().core.0,
            bonus: graded.score().bonus.0,
            of_stages: graded.stages().into_iter().map(of_stage).collect(),
            n_checks: graded.checks.len(),
            n_remarks: graded.remarks.len(),
            trouble: graded.trouble.clone(),
            cpu_ms: graded.cpu_ms,
            handed_in: graded.handed_in.clone(),
            late: graded.late(session).into_iter().map(|(stage, _)| stage).collect(),
            outcomes: graded.checks.iter().fold(0, |bits, check| bits | bit(check.outcome)),
        }
    }

    /// Returns the earned points of a stage.
    pub fn of_stage(&self, stage: u8) -> u32 {
        self.of_stages.iter().filter(|(number, _)| *number == stage).map(|(_, points)| points).sum()
    }

    /// Returns whether a check of the submission has this outcome.
    pub fn has(&self, outcome: Outcome) -> bool {
        self.outcomes & bit(outcome) != 0
    }
}

fn bit(outcome: Outcome) -> u16 {
    Outcome::ALL.iter().position(|&one| one == outcome).map_or(0, |place| 1 << place)
}
