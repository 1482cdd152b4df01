//! `author mutants`: mutation testing. Small automatic changes of the solutions, each of which the checks must notice.
//!
//! The tool cargo-mutants lists the changes. A build folder of the corpus builds each change, runs all checks against it and
//! renders all scenes. A change that survives is either a gap in the checks or equivalent to the original. Equivalent
//! changes are listed in tests/corpus/equivalent.toml, each with a reason.
//!
//! `list` (the changes) · `journal` (the tested changes) · `reviewed` (the equivalent changes)

mod journal;
mod list;
pub mod reviewed;

use crate::corpus::FOLDER;
use crate::corpus::build_folder::{BuildFolder, Built};
use crate::gaps::{self, Gap};
use crate::pictures::{Scenes, Shown};
use ::checks::Check;
use all_checks::STAGES;
use anyhow::{Result, bail};
use grader::kits::{Need, Source, Which};
use grader::queue;
use grader::report::bar_of_steps;
use grader::worker::{CALL_PATIENCE, Worker};
use journal::Journal;
use list::Mutant;
use raykata::kit::{Door, Kit};
use raykata_cli::args::{Argument, Given, Misuse, Opt, Spec};
use raykata_cli::lock::Lock;
use reviewed::Reviewed;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// `author mutants`.
pub static SPEC: Spec = Spec {
    name: "author mutants",
    about: "Test the checks with changes that cargo-mutants makes to the solutions.",
    arguments: &[Argument::optional("FILE", "Only files whose names contain this.")],
    options: &[&[
        Opt::flag("--resume", "Continue the last run: skip the changes that it has tested."),
        Opt::flag(
            "--quick",
            "Only the checks of the change's own stage, without pictures and other stages; --resume tests the survivors once more.",
        ),
        Opt::flag("--again", "Only the changes that survived the last run."),
        Opt::value("--jobs", "N", "How many to test at the same time [default: one per core]."),
    ]],
};

/// The options of `author mutants`.
pub struct MutantsOptions {
    file: Option<String>,
    resume: bool,
    again: bool,
    quick: bool,
    jobs: usize,
}

/// The list of reviewed changes of the solutions.
const REVIEWED: &str = "tests/corpus/equivalent.toml";

impl MutantsOptions {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Result<MutantsOptions, Misuse> {
        given.exclude("--again", "--resume")?;
        given.exclude("--again", "--quick")?;
        Ok(MutantsOptions {
            file: given.argument(0).map(|file| file.to_string_lossy().into_owned()),
            resume: given.has("--resume"),
            again: given.has("--again"),
            quick: given.has("--quick"),
            jobs: given.number("--jobs", 0..=usize::MAX)?.unwrap_or_else(queue::cores),
        })
    }
}

/// The result of testing a change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum MutantVerdict {
    /// It does not compile.
    DoesNotCompile,
    /// A check of its own stage failed.
    ByItsStage(String),
    /// A check of another stage failed.
    ByAnotherStage(String),
    /// Every check passed, but the picture of this scene or its cost differs.
    ByPicture(String),
    /// Pictures are the same, but they differ while this function is not written yet.
    ByGap(String),
    /// No check or picture noticed it, and a review found that none can.
    Equivalent,
    /// No check or picture noticed it.
    Survived,
}

/// Tests the changes and prints a report. Returns whether every survivor is a reviewed one and no reviewed one was noticed.
pub fn run(root: &Path, options: &MutantsOptions) -> Result<bool> {
    let reviewed = Reviewed::read(root, REVIEWED)?;
    let mut mutants = list::all(root, &["solutions".to_owned()])?;
    if let Some(file) = &options.file {
        mutants.retain(|mutant| mutant.file.contains(file.as_str()));
    }
    let _lock = Lock::on(&root.join(FOLDER))?;
    let mut journal = Journal::open(root, options.resume || options.again)?;
    choose(&mut mutants, options, &mut journal)?;
    // Test them, and report what the reviews do not say.
    try_all(root, &mutants, &mut journal, options)?;
    let tried: Vec<(&Mutant, MutantVerdict)> = mutants
        .iter()
        .map(|mutant| match journal.of(mutant) {
            // A quick run keeps no verdict of a survivor, which other checks or pictures may notice.
            None | Some(MutantVerdict::Survived) if is_equivalent(&reviewed, mutant) => {
                (mutant, MutantVerdict::Equivalent)
            }
            None => (mutant, MutantVerdict::Survived),
            Some(verdict) => (mutant, verdict.clone()),
        })
        .collect();
    let is_noticed = |verdict: &MutantVerdict| {
        !matches!(
            verdict,
            MutantVerdict::Survived | MutantVerdict::Equivalent | MutantVerdict::DoesNotCompile
        )
    };
    let is_reviewed = tell_unreviewed(&tried, &reviewed, is_noticed);
    report(&tried);
    Ok(is_reviewed)
}

/// Whether a change was reviewed.
fn is_equivalent(reviewed: &Reviewed, mutant: &Mutant) -> bool {
    reviewed.has(&mutant.file, &mutant.was(), &mutant.becomes())
}

/// Keeps the changes that are to be tested. `--again` keeps those that survived the last run, and forgets their verdicts.
fn choose(mutants: &mut Vec<Mutant>, options: &MutantsOptions, journal: &mut Journal) -> Result<()> {
    if options.again {
        mutants.retain(|mutant| journal.of(mutant) == Some(&MutantVerdict::Survived));
        journal.forget(mutants);
    }
    if mutants.is_empty() {
        bail!("there is no change to test");
    }
    Ok(())
}

/// Prints the changes that survived, and those that were noticed although they are reviewed as changes that nothing can notice.
/// Returns whether there are none.
fn tell_unreviewed(
    tried: &[(&Mutant, MutantVerdict)],
    reviewed: &Reviewed,
    is_noticed: impl Fn(&MutantVerdict) -> bool,
) -> bool {
    let survivors: Vec<&Mutant> = tried
        .iter()
        .filter(|(_, verdict)| *verdict == MutantVerdict::Survived)
        .map(|(mutant, _)| *mutant)
        .collect();
    for mutant in &survivors {
        println!("SURVIVED  {mutant}\n");
    }
    let noticed =
        tried.iter().filter(|(mutant, verdict)| is_noticed(verdict) && is_equivalent(reviewed, mutant));
    let noticed: Vec<&Mutant> = noticed.map(|(mutant, _)| *mutant).collect();
    for mutant in &noticed {
        println!("NOTICED, but reviewed as equivalent: {mutant}\n");
    }
    survivors.is_empty() && noticed.is_empty()
}

fn try_all(root: &Path, mutants: &[Mutant], journal: &mut Journal, options: &MutantsOptions) -> Result<()> {
    let jobs = options.jobs.clamp(1, mutants.len());
    let build_folders =
        BuildFolder::open_all(root, jobs, if options.quick { Need::Checks } else { Need::Frames })?;
    let journal = Mutex::new(journal);
    // Test all changes by the checks of their stage first, which is quick and notices most of them.
    let bar = bar_of_steps(mutants.len());
    let latest = Latest::default();
    queue::run(&build_folders, mutants, |build_folder, mutant| {
        bar.set_message(mutant.file.clone());
        if lock(&journal).of(mutant).is_none()
            && let Some(verdict) = first_failure(build_folder, mutant, &latest)?
        {
            lock(&journal).write(mutant, verdict)?;
        }
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    let others: Vec<&Mutant> = mutants.iter().filter(|mutant| lock(&journal).of(mutant).is_none()).collect();
    if options.quick || others.is_empty() {
        Ok(())
    } else {
        try_others(root, &others, &journal, &build_folders)
    }
}

/// Tests the changes that the checks of their stage do not notice by everything else.
fn try_others(
    root: &Path,
    others: &[&Mutant],
    journal: &Mutex<&mut Journal>,
    build_folders: &[BuildFolder],
) -> Result<()> {
    let reference = Source::prepare(root, Which::Solutions, Need::Frames)?.fresh();
    let scenes = Scenes::read(root, &*reference)?;
    let expected = scenes.shown_by(&*reference);
    let of_gaps = scenes.of_gaps();
    let of_gaps = (of_gaps.shown_by(&*reference), of_gaps);
    let bar = bar_of_steps(others.len());
    bar.set_message("pictures of gaps");
    let gaps = if others.iter().any(|mutant| mutant.stage().is_none()) {
        gaps::that_show(root, build_folders, &of_gaps.1, &of_gaps.0)?
    } else {
        Vec::new()
    };
    queue::run(build_folders, others, |build_folder, &mutant| {
        bar.set_message(mutant.file.clone());
        let verdict = match build_folder.build_with(&[(&mutant.file, &mutant.apply(build_folder)?)])? {
            Built::Program(worker) => match judge(mutant, &worker, &scenes, &expected) {
                MutantVerdict::Survived if mutant.stage().is_none() => {
                    judge_by_gaps(mutant, build_folder, &gaps, &of_gaps)?
                }
                verdict => verdict,
            },
            Built::DoesNotCompile(_) => MutantVerdict::DoesNotCompile,
        };
        lock(journal).write(mutant, verdict)?;
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    Ok(())
}

fn lock<T>(shared: &Mutex<T>) -> MutexGuard<'_, T> {
    shared.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Tests a change of an exercise by the checks of its stage. They need no frames, without which the build is much quicker.
fn first_failure(
    build_folder: &BuildFolder,
    mutant: &Mutant,
    latest: &Latest,
) -> Result<Option<MutantVerdict>> {
    let Some(own) = mutant.stage() else { return Ok(None) };
    Ok(match build_folder.with(Need::Checks).build_with(&[(&mutant.file, &mutant.apply(build_folder)?)])? {
        Built::Program(worker) => {
            failed_check(&worker, |stage| stage == own, latest).map(MutantVerdict::ByItsStage)
        }
        Built::DoesNotCompile(_) => Some(MutantVerdict::DoesNotCompile),
    })
}

/// Tests a change that passes the checks of its stage by pictures, then by the other stages.
fn judge(mutant: &Mutant, worker: &Path, scenes: &Scenes, expected: &[Shown]) -> MutantVerdict {
    let shown = Door(Worker::new(worker.to_owned(), CALL_PATIENCE).with_short_frames());
    if let Some(scene) = scenes.first_difference(&shown, expected) {
        return MutantVerdict::ByPicture(scene);
    }
    let elsewhere =
        mutant.stage().and_then(|own| failed_check(worker, |stage| stage != own, &Latest::default()));
    elsewhere.map_or(MutantVerdict::Survived, MutantVerdict::ByAnotherStage)
}

/// The checks that failed, the latest one first. The next change is often one of the same function, which they notice as well,
/// so they are tried first.
#[derive(Default)]
struct Latest(Mutex<Vec<&'static str>>);

impl Latest {
    fn add(&self, check: &'static str) {
        let mut latest = lock(&self.0);
        latest.retain(|other| *other != check);
        latest.insert(0, check);
    }

    fn sort(&self, checks: &mut [&Check]) {
        let latest = lock(&self.0);
        checks.sort_by_key(|check| latest.iter().position(|name| *name == check.name).unwrap_or(usize::MAX));
    }
}

/// Returns the first check of the `wanted` stages that the worker fails.
fn failed_check(worker: &Path, wanted: impl Fn(u8) -> bool, latest: &Latest) -> Option<String> {
    let kit =
        || -> Arc<dyn Kit + Send + Sync> { Arc::new(Door(Worker::new(worker.to_owned(), CALL_PATIENCE))) };
    let wanted = STAGES.iter().filter(|(stage, _)| wanted(*stage));
    let mut checks: Vec<&'static Check> = wanted.flat_map(|(_, checks)| checks.iter()).collect();
    latest.sort(&mut checks);
    // Ask twice: on a busy machine, a call can exceed its time limit.
    let fails = |check: &&Check| (0..2).all(|_| !::checks::passes(check, &kit(), 0));
    let failed = checks.into_iter().find(fails)?;
    latest.add(failed.name);
    Some(failed.name.into())
}

/// Tests a change with each gap that changes a picture. The code that leaves out parts of a picture runs only while a
/// function is not written.
fn judge_by_gaps(
    mutant: &Mutant,
    build_folder: &BuildFolder,
    gaps: &[(Gap, String)],
    (whole, scenes): &(Vec<Shown>, Scenes),
) -> Result<MutantVerdict> {
    let changed = mutant.apply(build_folder)?;
    for (gap, unchanged) in gaps {
        let changes = [(mutant.file.as_str(), changed.as_str()), (gap.file.as_str(), gap.text.as_str())];
        if gaps::lacks(build_folder, &changes, scenes, whole)? != *unchanged {
            return Ok(MutantVerdict::ByGap(gap.function.clone()));
        }
    }
    Ok(MutantVerdict::Survived)
}

fn report(tried: &[(&Mutant, MutantVerdict)]) {
    let mut files: Vec<&str> = tried.iter().map(|(mutant, _)| mutant.file.as_str()).collect();
    files.dedup();
    println!(
        "file                     changes  no program  own stage  others  pictures  equivalent  survived  score"
    );
    for file in files.into_iter().map(Some).chain([None]) {
        let count = |which: fn(&MutantVerdict) -> bool| {
            tried
                .iter()
                .filter(|(m, verdict)| file.is_none_or(|file| file == m.file) && which(verdict))
                .count()
        };
        let own = count(|verdict| matches!(verdict, MutantVerdict::ByItsStage(_)));
        let others = count(|verdict| matches!(verdict, MutantVerdict::ByAnotherStage(_)));
        let pictures =
            count(|verdict| matches!(verdict, MutantVerdict::ByPicture(_) | MutantVerdict::ByGap(_)));
        let survived = count(|verdict| *verdict == MutantVerdict::Survived);
        let noticed = own + others + pictures;
        println!(
            "{:<23}  {:>7}  {:>10}  {own:>9}  {others:>6}  {pictures:>8}  {:>10}  {survived:>8}  {:>5.1}",
            file.map_or("all", |file| file.trim_start_matches("solutions/src/")),
            count(|_| true),
            count(|verdict| *verdict == MutantVerdict::DoesNotCompile),
            count(|verdict| *verdict == MutantVerdict::Equivalent),
            100.0 * noticed as f64 / ((noticed + survived).max(1)) as f64,
        );
    }
    println!("\nscore: percent noticed, of the changes that compile and are not equivalent");
}
