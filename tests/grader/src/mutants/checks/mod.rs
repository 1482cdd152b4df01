//! `grader mutants --checks`: small automatic changes of the checks, each of which an entry of the corpus must notice.
//!
//! A change is noticed if a verdict differs from that of the unchanged check: the changed check rejects the reference or another
//! right solution, or accepts a mistake. If no verdict differs, the messages about mistakes are compared with those that the
//! corpus keeps. A change that survives is a gap in the corpus, a part of the check that decides nothing, or harmless, for
//! example another number of random inputs. Those that were reviewed are listed in tests/corpus/harmless.toml.
//!
//! A change of what all checks share is tested by the unit tests of that code, by all checks with the reference, and by each
//! check with one of the mistakes that it catches.
//!
//! `affected` (the checks that a file decides) · `judges` (builds and asks a changed judge) · `workers` (the entries, built once)

mod affected;
mod judges;
mod workers;

use super::journal::Journal;
use super::list::{self, Mutant};
use super::reviewed::Reviewed;
use super::{Options, REVIEWED_CHECKS, choose, tell_unreviewed};
use crate::corpus::FOLDER;
use crate::report::bar_of_steps;
use affected::StageFiles;
use all_checks::STAGES;
use anyhow::{Result, bail};
use judges::{Judge, Judges};
use raykata_cli::fingerprint::fingerprint;
use raykata_cli::lock::Lock;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::path::Path;
use workers::Workers;

/// The result of testing a change of a check.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Fate {
    /// It does not compile.
    DoesNotCompile,
    /// A unit test of what all checks share fails.
    FailsUnitTest,
    /// This check rejects a right solution: the reference, or this entry.
    RejectsRight(String, String),
    /// This check accepts this mistake.
    AcceptsMistake(String, String),
    /// No verdict differs, but the message of this check about this mistake.
    ByMessage(String, String),
    /// Neither verdicts nor messages differ, and a review found that no entry of the corpus should notice it.
    Harmless,
    /// Neither verdicts nor messages differ.
    Survived,
}

/// Tests the changes and prints a report. Returns whether every survivor is a reviewed one and no reviewed one was noticed.
pub fn run(root: &Path, options: &Options) -> Result<bool> {
    let reviewed = Reviewed::read(root, REVIEWED_CHECKS)?;
    let mut packages = vec!["checks".to_owned()];
    packages.extend(STAGES.iter().map(|(stage, _)| format!("stage{stage}")));
    let mut mutants = list::all(root, &packages)?;
    if let Some(file) = &options.file {
        mutants.retain(|mutant| mutant.file.contains(file.as_str()));
    }
    let n_all = mutants.len();
    if let Some(n) = options.sample {
        mutants = sample(mutants, n, options.seed);
    }
    let _lock = Lock::on(&root.join(FOLDER))?;
    let mut journal = Journal::open(root, "mutants-of-checks", options.resume || options.again)?;
    choose(&mut mutants, options, &mut journal, &Fate::Survived)?;
    try_all(root, &mutants, &mut journal)?;
    let tried: Vec<(&Mutant, Fate)> = mutants
        .iter()
        .filter_map(|mutant| match journal.of(mutant)? {
            Fate::Survived if reviewed.has(mutant) => Some((mutant, Fate::Harmless)),
            fate => Some((mutant, fate.clone())),
        })
        .collect();
    let is_noticed = |fate: &Fate| !matches!(fate, Fate::Survived | Fate::Harmless | Fate::DoesNotCompile);
    let is_reviewed = tell_unreviewed(&tried, &reviewed, "harmless", &Fate::Survived, is_noticed);
    report(&tried, n_all);
    Ok(is_reviewed)
}

/// Chooses `n` changes of each stage. A larger sample with the same seed contains a smaller one, also after other code has
/// changed.
fn sample(mutants: Vec<Mutant>, n: usize, seed: u64) -> Vec<Mutant> {
    let key = |mutant: &Mutant| fingerprint([&seed.to_le_bytes()[..], mutant.change().as_bytes()]);
    let mut stages: BTreeMap<u8, Vec<(String, Mutant)>> = BTreeMap::new();
    for mutant in mutants {
        stages.entry(stage_of(&mutant)).or_default().push((key(&mutant), mutant));
    }
    let mut chosen = Vec::new();
    for mut of_stage in stages.into_values() {
        of_stage.sort_by(|(key, _), (other, _)| key.cmp(other));
        of_stage.dedup_by(|(key, _), (other, _)| key == other);
        of_stage.truncate(n);
        let mut of_stage: Vec<Mutant> = of_stage.into_iter().map(|(_, mutant)| mutant).collect();
        of_stage.sort_by(|one, other| one.file.cmp(&other.file));
        chosen.extend(of_stage);
    }
    chosen
}

/// The number of no stage: what the checks of all stages share.
const SHARED: u8 = 0;

/// The stage of a changed check, or [`SHARED`].
fn stage_of(mutant: &Mutant) -> u8 {
    let name = mutant.file.strip_prefix("tests/checks/stage").unwrap_or_default();
    name.split('/').next().and_then(|number| number.parse().ok()).unwrap_or(SHARED)
}

fn try_all(root: &Path, mutants: &[Mutant], journal: &mut Journal<Fate>) -> Result<()> {
    let workers = Workers::open(root)?;
    let judges = Judges::open(root)?;
    let bar = bar_of_steps(mutants.len());
    for mutant in mutants {
        bar.set_message(mutant.file.clone());
        if journal.of(mutant).is_none() {
            let fate = try_one(root, mutant, &judges, &workers)?;
            journal.write(mutant, fate)?;
        }
        bar.inc(1);
    }
    bar.finish_and_clear();
    Ok(())
}

fn try_one(root: &Path, mutant: &Mutant, judges: &Judges, workers: &Workers) -> Result<Fate> {
    let stage = stage_of(mutant);
    if stage == SHARED && judges.fails_unit_test(mutant)? {
        return Ok(Fate::FailsUnitTest);
    }
    let Some(changed) = judges.changed(mutant)? else { return Ok(Fate::DoesNotCompile) };
    let mut judge = Judge::start(&changed)?;
    let trials = match stage {
        SHARED => workers.trials_of_all(),
        _ => workers.trials(stage, &StageFiles::read(root, stage)?.decided_by(&mutant.file)?),
    };
    for trial in &trials {
        // Ask twice: on a busy machine, a check can exceed its time limit.
        if judge.fails(trial, workers)? != trial.fails
            && Judge::start(&changed)?.fails(trial, workers)? != trial.fails
        {
            let mut unchanged = Judge::start(judges.unchanged())?;
            if unchanged.fails(trial, workers)? != trial.fails {
                bail!(
                    "{trial} differs from tests/corpus/matrix.txt without a change: run `grader corpus --check`"
                );
            }
            let (check, entry) = (trial.check.to_owned(), trial.entry_name());
            return Ok(if trial.fails {
                Fate::AcceptsMistake(check, entry)
            } else {
                Fate::RejectsRight(check, entry)
            });
        }
    }
    // No verdict differs: compare the messages about the mistakes that name a check of this file.
    for trial in trials.iter().filter(|trial| trial.message.is_some()) {
        if judge.message(trial, workers)? != trial.message {
            return Ok(Fate::ByMessage(trial.check.to_owned(), trial.entry_name()));
        }
    }
    Ok(Fate::Survived)
}

fn report(tried: &[(&Mutant, Fate)], n_all: usize) {
    let mut stages: Vec<u8> = tried.iter().map(|(mutant, _)| stage_of(mutant)).collect();
    stages.dedup();
    println!(
        "stage   changes  no program  unit test  rejects right  accepts mistake  message  harmless  survived    score"
    );
    for stage in stages.into_iter().map(Some).chain([None]) {
        let count = |which: fn(&Fate) -> bool| {
            let of_stage =
                tried.iter().filter(|(mutant, _)| stage.is_none_or(|stage| stage == stage_of(mutant)));
            of_stage.filter(|(_, fate)| which(fate)).count()
        };
        let unit = count(|fate| *fate == Fate::FailsUnitTest);
        let rejects = count(|fate| matches!(fate, Fate::RejectsRight(..)));
        let accepts = count(|fate| matches!(fate, Fate::AcceptsMistake(..)));
        let messages = count(|fate| matches!(fate, Fate::ByMessage(..)));
        let survived = count(|fate| *fate == Fate::Survived);
        let noticed = unit + rejects + accepts + messages;
        let score = match noticed + survived {
            0 => "-".into(),
            judged => format!("{:.1} %", 100.0 * noticed as f64 / judged as f64),
        };
        println!(
            "{:<6}  {:>7}  {:>10}  {unit:>9}  {rejects:>13}  {accepts:>15}  {messages:>7}  {:>8}  {survived:>8}  {score:>7}",
            match stage {
                None => "all".into(),
                Some(SHARED) => "shared".into(),
                Some(stage) => stage.to_string(),
            },
            count(|_| true),
            count(|fate| *fate == Fate::DoesNotCompile),
            count(|fate| *fate == Fate::Harmless),
        );
    }
    println!(
        "\nof {n_all} changes in these files; score: noticed, of the changes that compile and are not harmless"
    );
}
