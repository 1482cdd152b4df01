//! `grader corpus`: tests the checks. Each entry is the reference with one difference. It is either a mistake, which a
//! named check must catch and diagnose, or another right solution, which every check must accept.
//!
//! `carry` (updates patches) · `entry` (reads `tests/corpus`) · `workshop` (builds an entry) · `verdict` (its result) ·
//! `records` (the stored results) · `tested` (the results of a run that was stopped)

pub mod carry;
pub mod entry;
pub mod records;
pub(crate) mod tested;
pub mod verdict;
pub mod workshop;

use crate::kits::{Need, Source, Which};
use crate::queue;
use crate::report::bar_of_steps;
use anyhow::{Result, bail};
use checks::Inputs;
use entry::{Claim, Entry};
use judge::scorecard::run_checks_on;
use raykata_cli::args::{Argument, Given, Misuse, Opt, Spec};
use raykata_cli::lock::Lock;
use records::Matrix;
use std::path::Path;
use std::sync::Arc;
use tested::Tested;
use verdict::{Fate, Tried};
use workshop::{Built, Workshop};

/// The folder in which entries and changes of the solutions are built. One run at a time uses it.
pub(crate) const FOLDER: &str = "target/corpus";

/// `grader corpus`.
pub static SPEC: Spec = Spec {
    name: "grader corpus",
    about: "Test the checks with known mistakes and other right solutions (for authors).",
    arguments: &[Argument::optional("NAME", "The names of entries [default: all].").many()],
    options: &[&[
        Opt::value("--stage", "N", "Only this stage."),
        Opt::flag("--slice", "Only one mistake and one right solution per stage."),
        Opt::value("--jobs", "N", "How many to test at the same time [default: one per core]."),
        Opt::flag("--check", "Also compare with tests/corpus/matrix.txt and tests/corpus/messages."),
        Opt::flag("--bless", "Write tests/corpus/matrix.txt and tests/corpus/messages."),
        Opt::flag("--right", "Only right solutions."),
        Opt::flag("--resume", "Continue a run that was stopped: skip the entries that it has tested."),
        Opt::value(
            "--seed",
            "N",
            "Pick the inputs of the checks with this seed instead of 0. The messages may then differ, so each mistake \
             only has to fail the check that must catch it.",
        ),
    ]],
};

/// The options of `grader corpus`.
pub struct Options {
    names: Vec<String>,
    stage: Option<u8>,
    slice: bool,
    jobs: usize,
    check: bool,
    bless: bool,
    right: bool,
    resume: bool,
    seed: Option<u64>,
}

impl Options {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        given.exclude("--bless", "--check")?;
        given.exclude("--seed", "--check")?;
        given.exclude("--seed", "--bless")?;
        let names: Vec<String> =
            given.arguments(0).iter().map(|name| name.to_string_lossy().into_owned()).collect();
        if names.iter().any(|name| name == "carry") {
            return Err(given.misuse("`carry` is a separate command: `grader corpus carry`"));
        }
        Ok(Options {
            names,
            stage: given.number("--stage", 0..=u8::MAX)?,
            slice: given.has("--slice"),
            jobs: given.number("--jobs", 0..=usize::MAX)?.unwrap_or_else(queue::cores),
            check: given.has("--check"),
            bless: given.has("--bless"),
            right: given.has("--right"),
            resume: given.has("--resume"),
            seed: given.number("--seed", 0..=u64::MAX)?,
        })
    }
}

/// Tests entries and prints a report. Returns whether all results are as required.
pub fn run(root: &Path, options: &Options) -> Result<bool> {
    let all = entry::read_all(root)?;
    let n_all = all.len();
    let chosen = choose(all, options)?;
    let complete = chosen.len() == n_all;
    let _lock = Lock::on(&root.join(FOLDER))?;
    let tested = Tested::open(root, options.resume, options.seed)?;
    let tried = try_all(root, &chosen, options.jobs.max(1), options.seed, &tested)?;
    tested.finish()?;

    let matrix = Matrix::read(root);
    let differences = if options.check { records::differences(root, &matrix, &tried) } else { Vec::new() };
    if options.bless {
        records::bless(root, &tried, complete)?;
    }
    report(&tried, &differences);
    if complete {
        report_idle_checks(&tried);
    }
    Ok(differences.is_empty() && tried.iter().all(|one| one.fate.is_as_it_must_be()))
}

fn choose(all: Vec<Entry>, options: &Options) -> Result<Vec<Entry>> {
    for name in &options.names {
        if !all.iter().any(|entry| is_named(entry, name)) {
            bail!("tests/corpus has no entry `{name}`");
        }
    }
    let slice = slice(&all);
    let wanted = |entry: &Entry| {
        (options.names.is_empty() || options.names.iter().any(|name| is_named(entry, name)))
            && options.stage.is_none_or(|stage| stage == entry.stage)
            && (!options.slice || slice.contains(&entry.to_string()))
            && (!options.right || entry.claim == Claim::Right)
    };
    let chosen: Vec<Entry> = all.into_iter().filter(wanted).collect();
    if chosen.is_empty() {
        bail!("tests/corpus has no entry for these options");
    }
    Ok(chosen)
}

fn is_named(entry: &Entry, name: &str) -> bool {
    entry.name == name || entry.to_string() == name
}

/// Chooses per stage the mistake and the right solution in the middle of the list.
fn slice(all: &[Entry]) -> Vec<String> {
    let mut stages: Vec<u8> = all.iter().map(|entry| entry.stage).collect();
    stages.dedup();
    let mut chosen = Vec::new();
    for stage in stages {
        let of_stage = all.iter().filter(|entry| entry.stage == stage);
        let (right, wrong): (Vec<&Entry>, Vec<&Entry>) =
            of_stage.partition(|entry| entry.claim == Claim::Right);
        let picks = [wrong.get(wrong.len() / 2), right.get(right.len() / 2)];
        chosen.extend(picks.into_iter().flatten().map(ToString::to_string));
    }
    chosen
}

/// Tests entries, with one workshop per job.
fn try_all(
    root: &Path,
    entries: &[Entry],
    jobs: usize,
    seed: Option<u64>,
    tested: &Tested,
) -> Result<Vec<Tried>> {
    let bar = bar_of_steps(entries.len());
    bar.set_message("foreign crates");
    let jobs = jobs.min(entries.len());
    let workshops = Workshop::open_all(root, jobs, Need::Checks)?;
    let threads = queue::cores().div_ceil(jobs);
    // With a seed, texts and pictures are drawn, and the expected ones come from the reference.
    let reference = match seed {
        Some(_) => Some(Source::prepare(root, Which::Solutions, Need::Checks)?.fresh()),
        None => None,
    };
    let inputs = Inputs { drawn: Some(Arc::default()), reference, ..Inputs::default() };
    let tried = queue::run(&workshops, entries, |workshop, entry| {
        bar.set_message(entry.to_string());
        let one = match tested.take(entry) {
            Some(known) => known,
            None => {
                let one = try_one(workshop, entry, threads, seed, &inputs)?;
                tested.add(&one)?;
                one
            }
        };
        bar.inc(1);
        Ok(one)
    })?;
    bar.finish_and_clear();
    Ok(tried)
}

fn try_one(
    workshop: &Workshop,
    entry: &Entry,
    threads: usize,
    seed: Option<u64>,
    inputs: &Inputs,
) -> Result<Tried> {
    let tried = |fate, failures| Ok(Tried { entry: entry.clone(), fate, failures });
    let worker = match workshop.build(&entry.file, &entry.diff)? {
        Built::Worker(worker) => worker,
        Built::DoesNotApply(why) => return tried(Fate::DoesNotApply(why), Default::default()),
        Built::DoesNotCompile(error) => return tried(Fate::DoesNotCompile(error), Default::default()),
    };
    let wanted = |stage| stage == entry.stage;
    let source = Source { which: Which::Solutions, program: worker };
    let graded = run_checks_on(threads, &source, wanted, seed.unwrap_or(0), inputs)?;
    let failures: verdict::Failures =
        graded.into_iter().filter_map(|one| Some((one.check.name, verdict::failure(one.verdict)?))).collect();
    let fate = match Fate::of(entry, &failures) {
        Fate::Unnamed(_) | Fate::Misnamed if seed.is_some() => Fate::Killed,
        fate => fate,
    };
    tried(fate, failures)
}

/// Lists the checks that no mistake fails. The corpus does not show that they can fail.
fn report_idle_checks(tried: &[Tried]) {
    let is_tried = |stage: u8| tried.iter().any(|one| one.entry.stage == stage);
    let fails = |name: &str| tried.iter().any(|one| one.failures.contains_key(name));
    let checks =
        all_checks::STAGES.iter().filter(|(stage, _)| is_tried(*stage)).flat_map(|(_, checks)| *checks);
    let idle: Vec<&str> = checks.map(|check| check.name).filter(|name| !fails(name)).collect();
    if !idle.is_empty() {
        println!("\nchecks that no mistake fails: {}", idle.join(", "));
    }
}

fn report(tried: &[Tried], differences: &[String]) {
    for one in tried.iter().filter(|one| !one.fate.is_as_it_must_be()) {
        println!("{one}\n");
    }
    for difference in differences {
        println!("{difference}\n");
    }
    let mut stages: Vec<u8> = tried.iter().map(|one| one.entry.stage).collect();
    stages.dedup();
    println!("stage  mistakes  by name  otherwise  survived  diagnosed   right  accepted   broken");
    for stage in stages.iter().map(|stage| Some(*stage)).chain([None]) {
        let count = |which: &dyn Fn(&Tried) -> bool| {
            let of_stage = tried.iter().filter(|one| stage.is_none_or(|stage| stage == one.entry.stage));
            of_stage.filter(|one| which(one)).count()
        };
        let fated = |fate: Fate| count(&|one| one.fate == fate);
        let otherwise =
            |one: &Tried| matches!(one.fate, Fate::Unnamed(_) | Fate::Misnamed | Fate::KilledByAnother);
        let broken = |one: &Tried| matches!(one.fate, Fate::DoesNotApply(_) | Fate::DoesNotCompile(_));
        let right = |one: &Tried| one.entry.claim == Claim::Right;
        println!(
            "{:<5}  {:>8}  {:>7}  {:>9}  {:>8}  {:>9}  {:>6}  {:>8}  {:>7}",
            stage.map_or("all".into(), |stage| stage.to_string()),
            count(&|one| !right(one)),
            fated(Fate::Killed),
            count(&otherwise),
            fated(Fate::Survived),
            count(&Tried::is_diagnosed),
            count(&right),
            fated(Fate::Accepted),
            count(&broken),
        );
    }
    let undiagnosed = tried
        .iter()
        .filter(|one| one.message().is_some() && !one.is_diagnosed() && one.entry.has_a_known_mistake());
    let undiagnosed: Vec<String> = undiagnosed.map(|one| one.entry.to_string()).collect();
    if !undiagnosed.is_empty() {
        println!("\ncaught without a diagnosis: {}", undiagnosed.join(", "));
    }
    if !differences.is_empty() {
        println!(
            "\n{} differences: look at them, then `cargo run -p grader -- corpus --bless`",
            differences.len()
        );
    }
}
