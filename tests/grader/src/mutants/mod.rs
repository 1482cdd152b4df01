//! `grader mutants`: mutation testing. Small automatic changes of the solutions, each of which the checks must notice.
//!
//! The tool cargo-mutants lists the changes. A workshop of the corpus builds each change, runs all checks against it and
//! renders all scenes. A change that survives is either a gap in the checks or equivalent to the original. Equivalent
//! changes are listed in tests/corpus/equivalent.toml, each with a reason.
//!
//! `list` (the changes) · `journal` (the tested changes) · `reviewed` (the equivalent changes)

mod journal;
mod list;
pub mod reviewed;

use crate::corpus::workshop::{Built, Workshop};
use crate::corpus::{FOLDER, entry};
use crate::gaps::{self, Gap};
use crate::kits::{Need, Source, Which};
use crate::pictures::{Scenes, Shown};
use crate::queue;
use crate::report::bar_of_steps;
use crate::worker::{CALL_PATIENCE, Worker};
use all_checks::STAGES;
use anyhow::{Result, bail};
use checks::Check;
use journal::Journal;
use list::Mutant;
use raykata::kit::Door;
use raykata_cli::args::{Argument, Given, Misuse, Opt, Spec};
use raykata_cli::lock::Lock;
use reviewed::Reviewed;
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Mutex;

/// `grader mutants`.
pub static SPEC: Spec = Spec {
    name: "grader mutants",
    about: "Test the checks with changes that cargo-mutants makes to the solutions (for authors).",
    arguments: &[Argument::optional("FILE", "Only files of solutions/src whose names contain this.")],
    options: &[&[
        Opt::flag("--resume", "Continue the last run: skip the changes that it has tested."),
        Opt::flag("--again", "Only the changes that survived the last run."),
        Opt::value("--jobs", "N", "How many to test at the same time [default: one per core]."),
    ]],
};

/// The options of `grader mutants`.
pub struct Options {
    file: Option<String>,
    resume: bool,
    again: bool,
    jobs: usize,
}

impl Options {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        given.exclude("--again", "--resume")?;
        Ok(Options {
            file: given.argument(0).map(|file| file.to_string_lossy().into_owned()),
            resume: given.has("--resume"),
            again: given.has("--again"),
            jobs: given.number("--jobs", 0..=usize::MAX)?.unwrap_or_else(queue::cores),
        })
    }
}

/// The result of testing a change.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
enum Fate {
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
pub fn run(root: &Path, options: &Options) -> Result<bool> {
    let reviewed = Reviewed::read(root)?;
    let mut mutants = list::all(root)?;
    if let Some(file) = &options.file {
        mutants.retain(|mutant| mutant.file.contains(file.as_str()));
    }
    // Choose the changes to test.
    let _lock = Lock::on(&root.join(FOLDER))?;
    let mut journal = Journal::open(root, options.resume || options.again)?;
    if options.again {
        mutants.retain(|mutant| journal.of(mutant) == Some(&Fate::Survived));
        journal.forget(&mutants);
    }
    if mutants.is_empty() {
        bail!("there is no change to test");
    }
    // Test them, and report the survivors that were not reviewed.
    try_all(root, &mutants, &mut journal, options.jobs.clamp(1, mutants.len()))?;
    let tried: Vec<(&Mutant, Fate)> = mutants
        .iter()
        .filter_map(|mutant| match journal.of(mutant)? {
            Fate::Survived if reviewed.has(mutant) => Some((mutant, Fate::Equivalent)),
            fate => Some((mutant, fate.clone())),
        })
        .collect();
    let survivors: Vec<&Mutant> =
        tried.iter().filter(|(_, fate)| *fate == Fate::Survived).map(|(mutant, _)| *mutant).collect();
    for mutant in &survivors {
        println!("SURVIVED  {mutant}\n");
    }
    // Report the reviewed changes that were noticed.
    let is_noticed = |fate: &Fate| !matches!(fate, Fate::Equivalent | Fate::DoesNotCompile);
    let noticed = tried.iter().filter(|(mutant, fate)| reviewed.has(mutant) && is_noticed(fate));
    let noticed: Vec<&Mutant> = noticed.map(|(mutant, _)| *mutant).collect();
    for mutant in &noticed {
        println!("NOTICED, but reviewed as equivalent: {mutant}\n");
    }
    report(&tried);
    Ok(survivors.is_empty() && noticed.is_empty())
}

fn try_all(root: &Path, mutants: &[Mutant], journal: &mut Journal, jobs: usize) -> Result<()> {
    let workshops = Workshop::open_all(root, jobs, Need::Frames)?;
    let reference = Source::prepare(root, Which::Solutions, Need::Frames)?.fresh();
    let scenes = Scenes::read(root, &*reference)?;
    let expected = scenes.shown_by(&*reference);
    let of_gaps = scenes.of_gaps();
    let of_gaps = (of_gaps.shown_by(&*reference), of_gaps);
    let bar = bar_of_steps(mutants.len());
    bar.set_message("pictures of gaps");
    let needs_gaps = |mutant: &Mutant| mutant.stage().is_none() && journal.of(mutant).is_none();
    let gaps = if mutants.iter().any(needs_gaps) {
        gaps::that_show(root, &workshops, &of_gaps.1, &of_gaps.0)?
    } else {
        Vec::new()
    };
    let journal = Mutex::new(journal);
    let lock = || journal.lock().unwrap_or_else(|broken| broken.into_inner());
    // Test all changes by the checks of their stage first, which is quick and notices most of them.
    queue::run(&workshops, mutants, |workshop, mutant| {
        bar.set_message(mutant.file.clone());
        if lock().of(mutant).is_none()
            && let Some(fate) = first_failure(workshop, mutant)?
        {
            lock().write(mutant, fate)?;
        }
        bar.inc(1);
        Ok(())
    })?;
    // Test the others by everything else.
    let others: Vec<&Mutant> = mutants.iter().filter(|mutant| lock().of(mutant).is_none()).collect();
    bar.finish_and_clear();
    let bar = bar_of_steps(others.len());
    queue::run(&workshops, &others, |workshop, &mutant| {
        bar.set_message(mutant.file.clone());
        let fate = match workshop.build(&mutant.file, &mutant.diff)? {
            Built::Worker(worker) => match judge(mutant, &worker, &scenes, &expected) {
                Fate::Survived if mutant.stage().is_none() => {
                    judge_by_gaps(mutant, workshop, &gaps, &of_gaps)?
                }
                fate => fate,
            },
            Built::DoesNotCompile(_) => Fate::DoesNotCompile,
            Built::DoesNotApply(why) => bail!("{mutant}: {why}"),
        };
        lock().write(mutant, fate)?;
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    Ok(())
}

/// Tests a change of an exercise by the checks of its stage. They need no frames, without which the build is much quicker.
fn first_failure(workshop: &Workshop, mutant: &Mutant) -> Result<Option<Fate>> {
    let Some(own) = mutant.stage() else { return Ok(None) };
    Ok(match workshop.with(Need::Checks).build(&mutant.file, &mutant.diff)? {
        Built::Worker(worker) => failed_check(&worker, |stage| stage == own).map(Fate::ByItsStage),
        Built::DoesNotCompile(_) => Some(Fate::DoesNotCompile),
        Built::DoesNotApply(why) => bail!("{mutant}: {why}"),
    })
}

/// Tests a change that passes the checks of its stage by pictures, then by the other stages.
fn judge(mutant: &Mutant, worker: &Path, scenes: &Scenes, expected: &[Shown]) -> Fate {
    let shown = Door(Worker::hasty(worker.to_owned(), CALL_PATIENCE));
    if let Some(scene) = scenes.first_difference(&shown, expected) {
        return Fate::ByPicture(scene);
    }
    let elsewhere = mutant.stage().and_then(|own| failed_check(worker, |stage| stage != own));
    elsewhere.map_or(Fate::Survived, Fate::ByAnotherStage)
}

/// Returns the first check of the `wanted` stages that the worker fails.
fn failed_check(worker: &Path, wanted: impl Fn(u8) -> bool) -> Option<String> {
    let source = Source { which: Which::Solutions, program: worker.to_owned() };
    let mut checks = STAGES.iter().filter(|(stage, _)| wanted(*stage)).flat_map(|(_, checks)| checks.iter());
    let failed = |check: &&Check| !checks::passes(check, &source.fresh(), 0);
    checks.find(failed).map(|check| check.name.into())
}

/// Tests a change with each gap that changes a picture. The code that leaves out parts of a picture runs only while a
/// function is not written.
fn judge_by_gaps(
    mutant: &Mutant,
    workshop: &Workshop,
    gaps: &[(Gap, String)],
    (whole, scenes): &(Vec<Shown>, Scenes),
) -> Result<Fate> {
    let changed = entry::apply(&mutant.file, &mutant.diff, &workshop.original(&mutant.file)?)?;
    for (gap, unchanged) in gaps {
        let changes = [(mutant.file.as_str(), changed.as_str()), (gap.file.as_str(), gap.text.as_str())];
        if gaps::lacks(workshop, &changes, scenes, whole)? != *unchanged {
            return Ok(Fate::ByGap(gap.function.clone()));
        }
    }
    Ok(Fate::Survived)
}

fn report(tried: &[(&Mutant, Fate)]) {
    let mut files: Vec<&str> = tried.iter().map(|(mutant, _)| mutant.file.as_str()).collect();
    files.dedup();
    println!(
        "file                     changes  no program  own stage  others  pictures  equivalent  survived  score"
    );
    for file in files.into_iter().map(Some).chain([None]) {
        let count = |which: fn(&Fate) -> bool| {
            tried.iter().filter(|(m, fate)| file.is_none_or(|file| file == m.file) && which(fate)).count()
        };
        let own = count(|fate| matches!(fate, Fate::ByItsStage(_)));
        let others = count(|fate| matches!(fate, Fate::ByAnotherStage(_)));
        let pictures = count(|fate| matches!(fate, Fate::ByPicture(_) | Fate::ByGap(_)));
        let survived = count(|fate| *fate == Fate::Survived);
        let noticed = own + others + pictures;
        println!(
            "{:<23}  {:>7}  {:>10}  {own:>9}  {others:>6}  {pictures:>8}  {:>10}  {survived:>8}  {:>5.1}",
            file.map_or("all", |file| file.trim_start_matches("solutions/src/")),
            count(|_| true),
            count(|fate| *fate == Fate::DoesNotCompile),
            count(|fate| *fate == Fate::Equivalent),
            100.0 * noticed as f64 / ((noticed + survived).max(1)) as f64,
        );
    }
    println!("\nscore: percent noticed, of the changes that compile and are not equivalent");
}
