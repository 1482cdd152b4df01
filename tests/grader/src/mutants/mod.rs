//! `raykata mutants`: small changes of the solutions that nobody chose by hand, each of which the checks must notice.
//!
//! The tool cargo-mutants lists the changes; each is built in a workshop of the corpus and asked every check, its own
//! stage's first, and then for the pictures of all scenes. What survives is either a gap in the checks or a change that
//! changes nothing: the latter stand in tests/corpus/equivalent.toml, each with a reason.
//!
//! `list` (the changes) · `reviewed` (those that change nothing)

mod list;
pub mod reviewed;

use crate::corpus::workshop::{Built, Workshop};
use crate::kits::Source;
use crate::pictures::{Scenes, Shown};
use anyhow::{Context, Result, bail};
use checks::{STAGES, Verdict};
use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use list::Mutant;
use reviewed::Reviewed;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Which changes to try.
#[derive(Args)]
pub struct Options {
    /// Only in files of solutions/src with this in their name.
    file: Option<String>,
    /// Only what survived the last run.
    #[arg(long)]
    again: bool,
    /// How many to try at once.
    #[arg(long, default_value_t = std::thread::available_parallelism().map_or(1, usize::from))]
    jobs: usize,
}

/// Where the survivors of the last run are kept.
const LAST_RUN: &str = "target/corpus/survivors.json";

/// How a change ended.
#[derive(Clone, Debug, PartialEq)]
enum Fate {
    /// It is no program.
    DoesNotCompile,
    /// A check of its own stage failed.
    ByItsStage(&'static str),
    /// A check of another stage failed.
    ByAnotherStage(&'static str),
    /// Every check passed, and the picture of this scene, or what it cost, is another one.
    ByPicture(String),
    /// Nobody noticed, and nobody can: it is reviewed.
    Equivalent,
    /// Nobody noticed.
    Survived,
}

/// Tries the changes and reports; whether none survived that has not been reviewed.
pub fn run(root: &Path, options: &Options) -> Result<bool> {
    let reviewed = Reviewed::read(root)?;
    let mut mutants = list::all(root)?;
    if let Some(file) = &options.file {
        mutants.retain(|mutant| mutant.file.contains(file.as_str()));
    }
    if options.again {
        let kept = std::fs::read_to_string(root.join(LAST_RUN))
            .with_context(|| format!("{LAST_RUN}: there was no run before this one"))?;
        let kept: Vec<String> = serde_json::from_str(&kept)?;
        mutants.retain(|mutant| kept.contains(&mutant.change()));
    }
    if mutants.is_empty() {
        bail!("no change is left to try");
    }
    let fates = try_all(root, &mutants, &reviewed, options.jobs.clamp(1, mutants.len()))?;
    let tried: Vec<(&Mutant, Fate)> = mutants.iter().zip(fates).collect();
    let survivors: Vec<&Mutant> =
        tried.iter().filter(|(_, fate)| *fate == Fate::Survived).map(|(mutant, _)| *mutant).collect();
    let kept: Vec<String> = survivors.iter().map(|mutant| mutant.change()).collect();
    std::fs::write(root.join(LAST_RUN), serde_json::to_string_pretty(&kept)?)?;

    for mutant in &survivors {
        println!("SURVIVED  {mutant}\n");
    }
    let noticed: Vec<&&Mutant> = tried
        .iter()
        .filter(|(mutant, fate)| {
            reviewed.has(mutant) && !matches!(fate, Fate::Equivalent | Fate::DoesNotCompile)
        })
        .map(|(mutant, _)| mutant)
        .collect();
    for mutant in &noticed {
        println!("NOTICED, though reviewed as one that changes nothing: {mutant}\n");
    }
    report(&tried);
    Ok(survivors.is_empty() && noticed.is_empty())
}

fn try_all(root: &Path, mutants: &[Mutant], reviewed: &Reviewed, jobs: usize) -> Result<Vec<Fate>> {
    let workshops = Workshop::open_all(root, jobs)?;
    let scenes = Scenes::read(root)?;
    let expected = scenes.shown_by(&*Source::Solutions.fresh());
    let bar = ProgressBar::new(mutants.len() as u64);
    if let Ok(style) = ProgressStyle::with_template("{wide_bar} {pos} of {len}, {eta} left  {msg}") {
        bar.set_style(style);
    }
    let (next, fates) = (AtomicUsize::new(0), Mutex::new(BTreeMap::new()));
    let work = |workshop: &Workshop| -> Result<()> {
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            let Some(mutant) = mutants.get(number) else { return Ok(()) };
            bar.set_message(mutant.file.clone());
            let mut fate = match workshop.build(&mutant.file, &mutant.diff)? {
                Built::Worker(worker) => judge(mutant, &Source::Worker(worker), &scenes, &expected),
                Built::DoesNotCompile(_) => Fate::DoesNotCompile,
                Built::DoesNotApply(why) => bail!("{mutant}: {why}"),
            };
            if fate == Fate::Survived && reviewed.has(mutant) {
                fate = Fate::Equivalent;
            }
            bar.inc(1);
            if let Ok(mut fates) = fates.lock() {
                fates.insert(number, fate);
            }
        }
    };
    std::thread::scope(|scope| {
        let running: Vec<_> = workshops.iter().map(|workshop| scope.spawn(|| work(workshop))).collect();
        running
            .into_iter()
            .try_for_each(|job| job.join().unwrap_or_else(|_| bail!("a job broke: see the message above")))
    })?;
    bar.finish_and_clear();
    Ok(fates.into_inner().unwrap_or_default().into_values().collect())
}

/// Asks the checks of the stage that the file belongs to, then those of the others, then for pictures; up to the first
/// that notices something.
fn judge(mutant: &Mutant, source: &Source, scenes: &Scenes, expected: &[Shown]) -> Fate {
    let own = mutant.stage();
    let (first, rest): (Vec<_>, Vec<_>) = STAGES.iter().partition(|(stage, _)| Some(*stage) == own);
    for &(stage, checks) in first.into_iter().chain(rest) {
        for check in checks {
            if checks::run(check, &source.fresh(), 0) != Verdict::Passed {
                return match Some(stage) == own {
                    true => Fate::ByItsStage(check.name),
                    false => Fate::ByAnotherStage(check.name),
                };
            }
        }
    }
    match scenes.first_difference(&*source.fresh(), expected) {
        Some(scene) => Fate::ByPicture(scene),
        None => Fate::Survived,
    }
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
        let pictures = count(|fate| matches!(fate, Fate::ByPicture(_)));
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
    println!("\nscore: percent noticed of those that are programs and not equivalent");
}
