//! The course as it stands: its stages, their checks, and the last verdict of each.

use raykata::rubric;
use raykata_cli::verdicts::{CheckVerdict, Verdict};

/// All stages, in the order of the course.
pub struct Course {
    /// The stages.
    pub stages: Vec<Stage>,
}

/// A stage.
pub struct Stage {
    /// Its number.
    pub number: u8,
    /// Its title.
    pub title: String,
    /// The files that students write, as the rubric names them.
    pub files: String,
    /// Its checks, in the order of the lecture.
    pub checks: Vec<Check>,
}

/// A check.
pub struct Check {
    /// Its name.
    pub name: String,
    /// The law that it tests.
    pub title: String,
    /// The slide that teaches the law.
    pub slide: String,
    /// Its points.
    pub points: u32,
    /// Whether its points are a bonus.
    pub bonus: bool,
    /// Its points in words.
    pub worth: String,
    /// Its three hints.
    pub hints: [String; 3],
    /// The last verdict.
    pub verdict: Option<Verdict>,
}

impl Check {
    /// Whether the last verdict was good.
    pub fn passes(&self) -> bool {
        self.verdict == Some(Verdict::Passed)
    }
}

impl Stage {
    /// The checks that pass of those that are asked for: `5 of 8 checks`, `12 of 20 points`, and the bonus points if there are any.
    pub fn earned(&self) -> (String, String) {
        let asked_for = || self.checks.iter().filter(|check| !check.bonus);
        let points = |passes: bool, bonus: bool| -> u32 {
            let counts = |check: &&Check| check.bonus == bonus && (check.passes() || !passes);
            self.checks.iter().filter(counts).map(|check| check.points).sum()
        };
        let passed = asked_for().filter(|check| check.passes()).count();
        let bonus = match points(true, true) {
            0 => String::new(),
            earned => format!(" +{earned}"),
        };
        let checks = format!("{passed} of {} checks", asked_for().count());
        (checks, format!("{} of {}{bonus} points", points(true, false), points(false, false)))
    }

    /// Whether every check passes that is asked for.
    pub fn is_done(&self) -> bool {
        self.checks.iter().all(|check| check.bonus || check.passes())
    }

    /// The first check after `from` (or from it on, if `inclusive`) that does not pass, also from the beginning.
    pub fn next_open(&self, from: usize, inclusive: bool) -> Option<usize> {
        let n = self.checks.len();
        let steps = usize::from(!inclusive)..n + usize::from(!inclusive);
        steps.map(|step| (from + step) % n).find(|&index| !self.checks[index].passes())
    }

    /// The first check before `from` that does not pass, also from the end.
    pub fn previous_open(&self, from: usize) -> Option<usize> {
        let n = self.checks.len();
        (1..=n).map(|step| (from + n - step) % n).find(|&index| !self.checks[index].passes())
    }
}

impl Course {
    /// The course of the rubric, without verdicts.
    pub fn new() -> Course {
        let check = |(name, entry): (&str, &rubric::CheckEntry)| Check {
            name: name.to_owned(),
            title: entry.title.clone(),
            slide: entry.slide.clone(),
            points: entry.points,
            bonus: entry.bonus,
            worth: entry.worth(),
            hints: entry.hints.clone(),
            verdict: None,
        };
        let stage = |(number, stage): (u8, &rubric::Stage)| Stage {
            number,
            title: stage.title.clone(),
            files: stage.file.clone(),
            checks: stage.in_order().into_iter().map(check).collect(),
        };
        Course { stages: rubric::stages().into_iter().map(stage).collect() }
    }

    /// Keeps a verdict.
    pub fn keep(&mut self, of_check: CheckVerdict) {
        let checks = self.stages.iter_mut().flat_map(|stage| &mut stage.checks);
        if let Some(check) = checks.into_iter().find(|check| check.name == of_check.check) {
            check.verdict = Some(of_check.verdict);
        }
    }
}
