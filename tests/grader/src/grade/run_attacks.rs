//! `grader attacks`: grades every attack of the corpus and lists those with a wrong result.

use super::attacks;
use super::forge::Forge;
use super::grader::Grader;
use super::judge::Judge;
use crate::course::HandedIn;
use crate::report::bar_of_steps;
use crate::sandbox::{self, Confinement};
use anyhow::Result;
use raykata_cli::args::{Argument, Given, Spec};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// `grader attacks`.
pub static SPEC: Spec = Spec {
    name: "grader attacks",
    about: "Test the grader with submissions that try to get points without earning them (for authors).",
    arguments: &[Argument::optional("NAME", "The names of attacks [default: all].").many()],
    options: &[&[]],
};

/// The options of `grader attacks`.
pub struct Options {
    names: Vec<String>,
}

impl Options {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Options {
        let names = given.arguments(0).iter().map(|name| name.to_string_lossy().into_owned());
        Options { names: names.collect() }
    }
}

/// The seed of the hidden inputs. Any fixed number makes the verdicts reproducible.
const SEED: u64 = 20_26;

/// Grades the attacks. Returns `Ok(true)` if every attack got the expected result.
pub fn run(root: &Path, options: &Options) -> Result<bool> {
    let level = sandbox::self_test()?;
    println!("sandbox: {level}");
    let forge = Arc::new(Forge::prepare(root, Confinement::Full)?);
    let judges: Mutex<BTreeMap<Vec<u8>, Arc<Judge>>> = Mutex::default();
    let judge = |stages: &[u8]| -> Result<Arc<Judge>> {
        let mut judges = judges.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(judge) = judges.get(stages) {
            return Ok(judge.clone());
        }
        let judge = Arc::new(Judge::of(root, stages, SEED, Confinement::Full)?);
        judges.insert(stages.to_owned(), judge.clone());
        Ok(judge)
    };
    let grade = |submission: &Path, stages: &[u8], allowed: &[String]| {
        let (forge, judge, allowed) = (forge.clone(), judge(stages)?, allowed.to_owned());
        let handed_in = HandedIn::new();
        let grader = Grader { forge, judge, confinement: Confinement::Full, allowed, handed_in };
        let student = submission.file_name().unwrap_or_default().to_string_lossy().into_owned();
        grader.grade(&student, grader.take(submission))
    };
    let chosen = attacks::choose(attacks::load(root)?, &options.names)?;
    let bar = bar_of_steps(chosen.len());
    let tried = attacks::run_all(root, chosen, grade, |tried| {
        let text = tried.complaints.iter().map(|complaint| format!("{}: {complaint}", tried.attack.name));
        bar.suspend(|| text.for_each(|line| println!("{line}")));
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    let repelled = tried.iter().filter(|tried| tried.complaints.is_empty()).count();
    println!("{repelled} of {} attacks got the expected result", tried.len());
    Ok(repelled == tried.len())
}
