//! The course as it stands: its stages, their checks, and the last verdict of each.

use raykata::rubric::{self, CheckEntry, Score};
use raykata_cli::verdicts::{CheckVerdict, Verdict};

/// A stage.
pub struct Stage {
    pub number: u8,
    pub entry: &'static rubric::Stage,
    /// Its checks, in the order of the lecture.
    pub checks: Vec<Check>,
    /// Whether it was done once since the program has started.
    pub was_done: bool,
}

/// A check.
pub struct Check {
    pub name: &'static str,
    pub entry: &'static CheckEntry,
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
    /// The checks that pass of those that are asked for: `5 of 8 checks`, and the points.
    pub fn earned(&self) -> (String, Score) {
        let asked_for = || self.checks.iter().filter(|check| check.entry.is_asked_for());
        let passed = asked_for().filter(|check| check.passes()).count();
        let points = |check: &Check| {
            let of = check.entry.points;
            (check.entry.level(), if check.passes() { of } else { 0 }, of)
        };
        let checks = format!("{passed} of {} checks", asked_for().count());
        (checks, self.checks.iter().map(points).collect())
    }

    /// Whether every check passes that is asked for.
    pub fn is_done(&self) -> bool {
        self.checks.iter().all(|check| !check.entry.is_asked_for() || check.passes())
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

/// All stages of the course, in their order, without verdicts.
pub fn stages() -> Vec<Stage> {
    let check = |(name, entry)| Check { name, entry, verdict: None };
    let stage = |(number, entry): (u8, &'static rubric::Stage)| Stage {
        number,
        entry,
        checks: entry.in_order().into_iter().map(check).collect(),
        was_done: false,
    };
    rubric::stages().into_iter().map(stage).collect()
}

/// Keeps a verdict.
pub fn keep(stages: &mut [Stage], of_check: CheckVerdict) {
    let mut checks = stages.iter_mut().flat_map(|stage| &mut stage.checks);
    if let Some(check) = checks.find(|check| check.name == of_check.check) {
        check.verdict = Some(of_check.verdict);
    }
}
