//! The course as it stands: its stages, their checks, the last verdict of each, and the judge that gives it.

use crate::process::Process;
use anyhow::{Context, Result, bail};
use raykata::rubric::{self, CheckEntry, Score};
use raykata::worker::{child, receive};
use raykata_cli::verdicts::{CheckVerdict, Verdict};
use std::io::{BufReader, ErrorKind};
use std::path::Path;

/// A stage.
pub struct Stage {
    /// Its number.
    pub number: u8,
    /// Its entry in the rubric.
    pub entry: &'static rubric::Stage,
    /// Its checks, in the order of the lecture.
    pub checks: Vec<Check>,
    /// Whether it was done once since the program has started.
    pub was_done: bool,
    /// Whether it was not done once, when all its checks had a verdict.
    pub was_open: bool,
}

/// A check.
pub struct Check {
    /// Its name.
    pub name: &'static str,
    /// Its entry in the rubric.
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
        was_open: false,
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

/// Lets the judge run the checks of a stage, with the worker of the kit at `root`, and reports each verdict. `false` if the run is over.
pub fn judge(
    process: &Process,
    judge: &Path,
    [root, worker]: [&Path; 2],
    stage: u8,
    mut report: impl FnMut(CheckVerdict),
) -> Result<bool> {
    let mut command = child(judge);
    command.arg("verdicts").arg(root).arg(worker).arg(stage.to_string());
    let verdicts = |out: &mut BufReader<_>| loop {
        match receive::<CheckVerdict>(out) {
            Ok(verdict) => report(verdict),
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(()),
            Err(error) => return Err(error).context("the judge is not understood"),
        }
    };
    match process.follow(command, verdicts)? {
        Some((false, words)) => bail!("the judge has failed: {}", words.trim()),
        ended => Ok(ended.is_some()),
    }
}
