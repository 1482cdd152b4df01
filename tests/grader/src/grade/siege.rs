//! `raykata attacks`: hands every attack of the corpus to the grader, and says which got what it should not.

use super::attacks::{self, Attack};
use super::class::Grader;
use super::forge::Forge;
use super::judge::Judge;
use crate::jail::{self, Jail, Purpose};
use crate::report::bar_of_steps;
use anyhow::Result;
use clap::Args;
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};

/// Try the grader on submissions that want what they have not earned.
#[derive(Args)]
pub struct Options {
    /// Names of attacks; all if none is given.
    names: Vec<String>,
    /// Print what each is and what a grader that trusts it makes of it.
    #[arg(long)]
    table: bool,
}

/// Hidden inputs are picked by this: any number does, and the same one gives the same verdicts again.
const SEED: u64 = 20_26;

/// `Ok(true)` if every attack got what it should.
pub fn run(root: &Path, options: &Options) -> Result<bool> {
    let level = jail::self_test()?;
    println!("contained by {level}");
    let forge = Arc::new(Forge::prepare(root)?);
    let judges: Mutex<BTreeMap<Vec<u8>, Arc<Judge>>> = Mutex::default();
    let judge = |stages: &[u8]| -> Result<Arc<Judge>> {
        let mut judges = judges.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(judge) = judges.get(stages) {
            return Ok(judge.clone());
        }
        let judge = Arc::new(Judge::of(stages, SEED, Some(Jail::new(Purpose::Worker)))?);
        judges.insert(stages.to_owned(), judge.clone());
        Ok(judge)
    };
    let bar = bar_of_steps(attacks::choose(attacks::load(root)?, &options.names)?.len());
    let tried = attacks::run_all(root, &options.names, |submission, stages, allowed| {
        let grader = Grader { forge: forge.clone(), judge: judge(stages)?, allowed: allowed.to_owned() };
        let student = submission.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let graded = grader.grade(&student, grader.take(submission));
        bar.inc(1);
        graded
    })?;
    bar.finish_and_clear();
    if options.table {
        tried.iter().for_each(|(attack, _)| println!("{}", row(attack)));
    }
    let repelled = tried.iter().filter(|(_, complaints)| complaints.is_empty()).count();
    for (attack, complaints) in &tried {
        for complaint in complaints {
            println!("{}: {complaint}", attack.name);
        }
    }
    println!("{repelled} of {} attacks got what they should", tried.len());
    Ok(repelled == tried.len())
}

fn row(attack: &Attack) -> String {
    format!("| {} | {} |", attack.title, attack.naive.as_deref().unwrap_or("-"))
}
