//! Which checks are tried with which entries.

use super::entry::{Claim, Entry};
use super::program::{Program, Reached};
use super::records::Matrix;
use anyhow::Result;
use checks::Check;
use std::collections::BTreeSet;

/// The number of mistakes that show that a check still rejects what it must.
const ENOUGH: usize = 3;

/// What is tried.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Trial {
    /// The check must reject the mistake with the stored message.
    Message,
    /// The check must reject the mistake.
    Rejects,
    /// The check must accept the correct solution.
    Accepts,
}

/// Which checks are tried with which entries: each mistake with the check that must catch it; each correct solution with every
/// check that reaches a function that it changes; and each check with at least three mistakes of the matrix, because few entries
/// name some of the checks.
pub struct Plan {
    reached: Reached,
    more: BTreeSet<(String, &'static str)>,
}

impl Plan {
    /// Plans for these entries. The reference tries the checks of their stages, to see which functions each reaches.
    pub fn of(program: &Program, matrix: &Matrix, entries: &[Entry], jobs: usize) -> Result<Plan> {
        let stages: BTreeSet<u8> = entries.iter().map(|entry| entry.stage).collect();
        let mut checks: Vec<&'static Check> =
            stages.iter().flat_map(|stage| all_checks::of_stage(*stage)).collect();
        let mut more = BTreeSet::new();
        for check in &checks {
            let of_stage = || entries.iter().filter(|entry| entry.stage == check.stage);
            let n_named = of_stage().filter(|entry| entry.caught_by() == Some(check.name)).count();
            // Take those that few checks reject: they are near what the check accepts.
            let mut others: Vec<&Entry> = of_stage()
                .filter(|entry| entry.caught_by() != Some(check.name) && matrix.fails(entry, check.name))
                .collect();
            others.sort_by_cached_key(|entry| (matrix.n_failing(entry), entry.name.clone()));
            let others = others.into_iter().take(ENOUGH.saturating_sub(n_named));
            more.extend(others.map(|entry| (entry.to_string(), check.name)));
        }
        let with_right: BTreeSet<u8> =
            entries.iter().filter(|entry| entry.claim == Claim::Right).map(|entry| entry.stage).collect();
        checks.retain(|check| with_right.contains(&check.stage));
        Ok(Plan { reached: program.reached(&checks, jobs)?, more })
    }

    /// What is tried with this entry and this check of its stage.
    pub fn trial(&self, program: &Program, entry: &Entry, check: &'static Check) -> Option<Trial> {
        match entry.caught_by() {
            Some(caught_by) if caught_by == check.name => Some(Trial::Message),
            Some(_) => self.more.contains(&(entry.to_string(), check.name)).then_some(Trial::Rejects),
            None => program.is_reached(entry, check, &self.reached).then_some(Trial::Accepts),
        }
    }
}
