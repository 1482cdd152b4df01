//! Counts the results of a class.

use super::line::Line;
use super::messages;
use crate::grade::result::{CheckResult, Graded, Outcome};
use checks::rubric::{CheckEntry, Level, RUBRIC};
use std::cmp::Reverse;
use std::collections::BTreeMap;

/// The results of a check in the class.
pub(super) struct Tally {
    pub stage: u8,
    pub name: String,
    pub points: u32,
    /// The rubric entry of the check.
    pub entry: CheckEntry,
    /// The number of submissions per outcome, in the order of [`Outcome::ALL`].
    pub counts: [usize; Outcome::ALL.len()],
}

impl Tally {
    fn new(check: &CheckResult) -> Self {
        let (stage, name, points) = (check.stage, check.name.clone(), check.points);
        Tally { stage, name, points, entry: messages::entry(check), counts: [0; Outcome::ALL.len()] }
    }

    /// Returns how many submissions passed.
    pub fn passed(&self) -> usize {
        self.outcomes().filter(|(outcome, _)| *outcome == Outcome::Passed).map(|(_, n)| n).sum()
    }

    /// Returns how many submissions tried the check and failed.
    pub fn tried_in_vain(&self) -> usize {
        let in_vain =
            [Outcome::Wrong, Outcome::WrongOnHidden, Outcome::Unproven, Outcome::TooLong, Outcome::Crashed];
        self.outcomes().filter(|(outcome, _)| in_vain.contains(outcome)).map(|(_, n)| n).sum()
    }

    /// Returns the number of submissions.
    pub fn of(&self) -> usize {
        self.counts.iter().sum()
    }

    /// Returns the outcomes that occurred, with their counts.
    pub fn outcomes(&self) -> impl Iterator<Item = (Outcome, usize)> {
        Outcome::ALL.into_iter().zip(self.counts).filter(|(_, n)| *n > 0)
    }
}

/// Counts the results of each check, one submission after the other.
#[derive(Default)]
pub(super) struct Tallies {
    places: BTreeMap<(u8, String), usize>,
    tallies: Vec<Tally>,
}

impl Tallies {
    /// Adds the results of a submission.
    pub fn add(&mut self, graded: &Graded) {
        for check in &graded.checks {
            let tallies = &mut self.tallies;
            let place = *self.places.entry((check.stage, check.name.clone())).or_insert_with(|| {
                tallies.push(Tally::new(check));
                tallies.len() - 1
            });
            if let Some(which) = Outcome::ALL.iter().position(|&outcome| outcome == check.outcome) {
                tallies[place].counts[which] += 1;
            }
        }
    }

    /// Returns the counts of each check, in the order of the lecture.
    pub fn in_order(mut self) -> Vec<Tally> {
        // The sort is stable: the checks of each stage stay in their order.
        self.tallies.sort_by_key(|tally| tally.stage);
        self.tallies
    }
}

/// Returns the graded stages in ascending order.
pub(super) fn stages(tallies: &[Tally]) -> Vec<u8> {
    let mut stages: Vec<u8> = tallies.iter().map(|tally| tally.stage).collect();
    stages.dedup();
    stages
}

/// Returns the sum of all possible points, without bonus points.
pub(super) fn of<'a>(tallies: impl IntoIterator<Item = &'a Tally>) -> u32 {
    tallies.into_iter().filter(|tally| tally.entry.level() != Level::Bonus).map(|tally| tally.points).sum()
}

/// Returns the sum of the possible points of the core.
pub(super) fn of_core(tallies: &[Tally]) -> u32 {
    tallies.iter().filter(|tally| tally.entry.level() == Level::Core).map(|tally| tally.points).sum()
}

/// Returns whether any check is worth bonus points.
pub(super) fn has_bonus(tallies: &[Tally]) -> bool {
    tallies.iter().any(|tally| tally.entry.level() == Level::Bonus)
}

/// Returns the percentage of the points, rounded to the nearest integer; 0 of 0 points are 0 %.
pub(super) fn percent(earned: u32, of: u32) -> String {
    let share = if of == 0 { 0.0 } else { f64::from(earned) / f64::from(of) };
    format!("{:.0}", 100.0 * share)
}

/// Returns the heading of a stage.
pub(super) fn stage_title(stage: u8) -> String {
    match RUBRIC.get(&format!("stage{stage}")) {
        Some(known) => format!("Stage {stage} · {}", known.title),
        None => format!("Stage {stage}"),
    }
}

/// Returns the `n` checks that most submissions tried and failed, worst first. Unwritten functions only break ties, because
/// they say more about lack of time than about the lecture.
pub(super) fn worst(tallies: &[Tally], n: usize) -> Vec<&Tally> {
    let mut worst: Vec<&Tally> = tallies.iter().filter(|tally| tally.tried_in_vain() > 0).collect();
    worst.sort_by_key(|tally| (Reverse(tally.tried_in_vain()), tally.passed()));
    worst.truncate(n);
    worst
}

/// Returns the median of the points.
pub(super) fn median(lines: &[Line]) -> f64 {
    let mut points: Vec<u32> = lines.iter().map(|line| line.points).collect();
    points.sort_unstable();
    match points.len() {
        0 => 0.0,
        n => f64::from(points[(n - 1) / 2] + points[n / 2]) / 2.0,
    }
}

/// Returns the mean of the points.
pub(super) fn mean(lines: &[Line]) -> f64 {
    let sum: u64 = lines.iter().map(|line| u64::from(line.points)).sum();
    sum as f64 / lines.len().max(1) as f64
}
