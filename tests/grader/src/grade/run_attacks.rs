//! `grader attacks`: hands every attack of the corpus to the grader, and says which got what it should not.

use super::attacks::{self, Tried};
use super::forge::Forge;
use super::grader::Grader;
use super::judge::Judge;
use super::result::Outcome;
use crate::report::bar_of_steps;
use crate::sandbox::{self, Confinement};
use anyhow::Result;
use raykata_cli::args::{Argument, Given, Opt, Spec};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// `grader attacks`.
pub static SPEC: Spec = Spec {
    name: "grader attacks",
    about: "Try the grader on submissions that try to get points which they have not earned (for authors).",
    arguments: &[Argument::optional("NAME", "Names of attacks; all if none is given.").many()],
    options: &[&[Opt::flag(
        "--table",
        "For each attack that was tried on `cargo test`, print the result there and the result of this grader.",
    )]],
};

/// Which attacks.
pub struct Options {
    names: Vec<String>,
    table: bool,
}

impl Options {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Options {
        let names = given.arguments(0).iter().map(|name| name.to_string_lossy().into_owned());
        Options { names: names.collect(), table: given.has("--table") }
    }
}

/// Hidden inputs are picked by this: any number does, and the same one gives the same verdicts again.
const SEED: u64 = 20_26;

/// `Ok(true)` if every attack got what it should.
pub fn run(root: &Path, options: &Options) -> Result<bool> {
    let level = sandbox::self_test()?;
    println!("contained by {level}");
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
        let grader = Grader { forge, judge, confinement: Confinement::Full, allowed };
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
    if options.table {
        println!("| attack | `cargo test` | this grader |\n|---|---|---|");
        tried.iter().filter_map(row).for_each(|row| println!("{row}"));
    }
    let repelled = tried.iter().filter(|tried| tried.complaints.is_empty()).count();
    println!("{repelled} of {} attacks got what they should", tried.len());
    Ok(repelled == tried.len())
}

fn row(tried: &Tried) -> Option<String> {
    let naive = tried.attack.naive.as_ref()?;
    let ours = match &tried.graded {
        Err(error) => format!("gave up: {error:#}"),
        Ok(graded) if !graded.trouble.is_empty() => format!("not graded: {}", graded.trouble),
        Ok(graded) => {
            let (earned, of) = graded.points();
            let count = |outcome| graded.checks.iter().filter(|check| check.outcome == outcome).count();
            let others = Outcome::ALL.into_iter().filter(|outcome| *outcome != Outcome::Passed);
            let others: Vec<String> = others
                .filter(|outcome| count(*outcome) > 0)
                .map(|outcome| format!(", {} {}", count(outcome), outcome.words()))
                .collect();
            format!("{earned} of {of} points{}", others.concat())
        }
    };
    Some(format!("| {} | {naive} | {} |", tried.attack.title, ours.replace(['\n', '|'], " ")))
}
