//! The results of grading, from which all reports are made.

use checks::rubric::{self, Level, Score};
use raykata::course::Moment;
use serde::{Deserialize, Serialize};
use std::collections::{BTreeMap, BTreeSet};

/// How a check ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// The answers are right, on the public inputs and on the hidden ones.
    Passed,
    /// The function is not written yet.
    NotWritten,
    /// An answer is wrong on the public inputs.
    Wrong,
    /// The answers are right on the public inputs, and one is wrong on the hidden inputs.
    WrongOnHidden,
    /// The answers are right, but on known inputs, and no check of the same function with hidden inputs
    /// passed.
    Unproven,
    /// There was no answer in time.
    TooLong,
    /// The worker ended before it answered: it crashed, exited, or exceeded a limit.
    Crashed,
    /// The file does not compile.
    DoesNotCompile,
    /// The file contains a construct that no exercise needs.
    Refused,
    /// Earlier checks used up the time of the submission.
    NotTried,
}

impl Outcome {
    /// All outcomes.
    pub const ALL: [Outcome; 10] = [
        Outcome::Passed,
        Outcome::NotWritten,
        Outcome::Wrong,
        Outcome::WrongOnHidden,
        Outcome::Unproven,
        Outcome::TooLong,
        Outcome::Crashed,
        Outcome::DoesNotCompile,
        Outcome::Refused,
        Outcome::NotTried,
    ];

    /// Describes the outcome in at most four words, for tables.
    pub fn words(self) -> &'static str {
        match self {
            Outcome::Passed => "passed",
            Outcome::NotWritten => "not written",
            Outcome::Wrong => "wrong",
            Outcome::WrongOnHidden => "wrong on hidden inputs",
            Outcome::Unproven => "needs another check",
            Outcome::TooLong => "too long",
            Outcome::Crashed => "crashed",
            Outcome::DoesNotCompile => "does not compile",
            Outcome::Refused => "refused",
            Outcome::NotTried => "not tried",
        }
    }
}

/// The result of a check on a submission.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CheckResult {
    /// Its stage.
    pub stage: u8,
    /// The name of the check, unique in its stage.
    pub name: String,
    /// The outcome.
    pub outcome: Outcome,
    /// The points of the check.
    pub points: u32,
    /// The points that were earned: `points` or 0.
    pub earned: u32,
    /// What the check is for; the points of a bonus count apart.
    #[serde(default)]
    pub level: Level,
    /// Tells the student why the check failed, without hidden inputs. Empty if it passed. Plain text of several lines that
    /// may quote output of the student's code, without control characters.
    pub message: String,
    /// The compared pictures, if the check is about pictures.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub picture: Option<Picture>,
}

/// A picture for the student.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Picture {
    /// The caption.
    pub caption: String,
    /// The bytes of a PNG file, in base64.
    pub png: String,
}

/// A file of a submission that was ignored or changed.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Remark {
    /// The path in the submission. Invalid UTF-8 is replaced.
    pub file: String,
    /// What was done with the file and why, as a sentence.
    pub what: String,
}

/// A submission, graded.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Graded {
    /// The name of the folder, or of the archive without its extension.
    pub student: String,
    /// SHA-256 of the files that were read from it, in hexadecimal.
    pub content: String,
    /// All checks of the graded stages, in the order of the lecture.
    pub checks: Vec<CheckResult>,
    /// Files that were ignored or changed, and why.
    pub remarks: Vec<Remark>,
    /// The compiler's messages, if there were errors; empty otherwise.
    pub compiler: String,
    /// Why nothing could be graded (an archive that cannot be read, …); empty otherwise.
    pub trouble: String,
    /// Processor time of the build and of the submission's answers, in milliseconds. It differs from run to run, so
    /// `results.json` leaves it out.
    #[serde(default)]
    pub cpu_ms: u64,
    /// When the submission was handed in, as the instructor's table says; empty if unknown.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub handed_in: String,
    /// What the instructor adds, from `notes.csv`. It is not stored with the grade.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub note: Option<Note>,
}

/// Points and a note of the instructor.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Note {
    /// Points that are added; negative ones are taken away.
    pub points: i32,
    /// The text, which the student sees.
    pub text: String,
}

impl CheckResult {
    /// Returns the result of a check that ended in this way, with the points of the rubric and without a picture.
    pub fn new(stage: u8, name: &str, outcome: Outcome, message: String) -> CheckResult {
        let entry = rubric::entry(stage, name);
        let (points, level) = (entry.points, entry.level());
        let earned = if outcome == Outcome::Passed { points } else { 0 };
        CheckResult { stage, name: name.to_owned(), outcome, points, earned, level, message, picture: None }
    }
}

impl Graded {
    /// Returns the earned points and the possible points of the checks.
    pub fn score(&self) -> Score {
        score(self.checks.iter())
    }

    /// Returns the earned points, with those of the instructor; at least 0.
    pub fn earned(&self) -> u32 {
        self.score().points().0.saturating_add_signed(self.note.as_ref().map_or(0, |note| note.points))
    }

    /// Returns the grade with the stages that count and the points that the course file gives now. Outcomes stay as they are.
    pub fn valued(mut self, stages: &[u8]) -> Graded {
        self.checks.retain(|check| stages.contains(&check.stage));
        for check in &mut self.checks {
            let CheckResult { points, earned, level, .. } =
                CheckResult::new(check.stage, &check.name, check.outcome, String::new());
            (check.points, check.earned, check.level) = (points, earned, level);
        }
        self
    }

    /// Returns the stages in ascending order.
    pub fn stages(&self) -> Vec<u8> {
        let mut stages: Vec<u8> = self.checks.iter().map(|check| check.stage).collect();
        stages.dedup();
        stages
    }

    /// Returns the stages that were handed in late, with how much later than they were due.
    pub fn late(&self, session: &Session) -> Vec<(u8, String)> {
        let Ok(time) = self.handed_in.parse::<Moment>() else { return Vec::new() };
        let late = |stage: u8| Some((stage, time.later_than(&session.due.get(&stage)?.parse().ok()?)?));
        self.stages().into_iter().filter_map(late).collect()
    }

    /// Returns the checks of a stage.
    pub fn of_stage(&self, stage: u8) -> impl Iterator<Item = &CheckResult> {
        self.checks.iter().filter(move |check| check.stage == stage)
    }
}

/// Returns the earned points and the possible points of these checks.
pub fn score<'a>(checks: impl Iterator<Item = &'a CheckResult>) -> Score {
    checks.map(|check| (check.level, check.earned, check.points)).collect()
}

/// Returns a score as reports write it: `17 of 33 points (12 of 12 core · 5 deeper)`.
pub fn in_words(score: Score) -> String {
    match (score.points(), score.core) {
        (_, (_, 0)) => score.to_string(),
        ((earned, of), _) => format!("{earned} of {of} points ({score})"),
    }
}

/// Kit, stages, seed and sandbox of the grading, the same for every submission of a class.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Session {
    /// Version of the kit and fingerprint of its checks and rubric.
    pub kit: String,
    /// The stages that count, in ascending order.
    pub stages: Vec<u8>,
    /// The stages that were graded and count no more. Their outcomes stay stored.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub dropped: Vec<u8>,
    /// The seed of the hidden inputs, the same for all students.
    pub seed: u64,
    /// The kind of sandbox, in one line.
    pub isolation: String,
    /// The title of the course and a fingerprint of its course file; empty without one.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub course: String,
    /// When stages are due. No grade depends on it.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub due: BTreeMap<u8, String>,
}

impl Session {
    /// All stages that were graded, also those that count no more.
    pub fn graded(&self) -> BTreeSet<u8> {
        self.stages.iter().chain(&self.dropped).copied().collect()
    }
}

/// A class, graded.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Class {
    /// How the class was graded.
    pub session: Session,
    /// The graded submissions, sorted by name.
    pub students: Vec<Graded>,
}
