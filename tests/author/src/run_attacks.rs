//! `author attacks`: grades every attack of the corpus and lists those with a wrong result.

use crate::attacks::{self, Attack, Hasty};
use anyhow::Result;
use grader::course::HandedIn;
use grader::grade::{
    CALL_PATIENCE, COMPILER_PATIENCE, Grader, Judge, Once, SharedResults, WorkerBuilder, shard,
};
use grader::kits::root;
use grader::report::bar_of_steps;
use grader::sandbox::{self, Confinement};
use raykata_cli::args::{Argument, Given, Opt, Spec};
use std::path::Path;
use std::sync::Arc;

/// `author attacks`.
pub static SPEC: Spec = Spec {
    name: "author attacks",
    about: "Test the grader with submissions that try to get points without earning them.",
    arguments: &[Argument::optional("NAME", "The names of attacks [default: all].").many()],
    options: &[&[Opt::value("--shard", "I/N", "Try only part I of N, such as 2/5.")]],
};

/// The seed of the hidden inputs. Any fixed number makes the verdicts reproducible.
const SEED: u64 = 20_26;

/// The number of times as long as for a hasty attack that calls and the compiler may take.
const HASTE: u32 = 4;

/// The number of attacks in the list of those that took longest.
const SLOWEST: usize = 5;

/// Grades the attacks. Returns `Ok(true)` if every attack got the expected result.
pub fn run(given: &Given) -> Result<bool> {
    let shard = given.parsed("--shard", shard)?;
    let root = &root()?;
    let level = sandbox::self_test()?;
    println!("sandbox: {level}");
    // Many attacks have the same files: their archives are malformed, or the syntax check refuses what is their own. These
    // files are compiled and judged once.
    let patient = WorkerBuilder::prepare(root, Confinement::Full)?.with_shared_workers();
    let hasty = Arc::new(patient.clone().with_patience(COMPILER_PATIENCE / HASTE));
    let patient = Arc::new(patient);
    let shared = Arc::<SharedResults>::default();
    let judges: Once<Vec<u8>, Arc<Judge>> = Once::default();
    let judge = |stages: &[u8]| Ok(Arc::new(Judge::of(root, stages, SEED, Confinement::Full)?));
    let grade = |submission: &Path, attack: &Attack, allowed: &[String]| {
        let grader = Grader {
            builder: if attack.hasty == Some(Hasty::Compiler) { hasty.clone() } else { patient.clone() },
            judge: {
                let of_stages = judges.get(attack.stages.clone(), || judge(&attack.stages))?;
                Arc::new(of_stages.only(|stage, check| attack.is_judged(stage, check)))
            },
            confinement: Confinement::Full,
            allowed: allowed.to_owned(),
            handed_in: HandedIn::new(),
            call_patience: if attack.hasty == Some(Hasty::Calls) {
                CALL_PATIENCE / HASTE
            } else {
                CALL_PATIENCE
            },
            shared: Some(shared.clone()),
        };
        let student = submission.file_name().unwrap_or_default().to_string_lossy().into_owned();
        grader.grade(&student, grader.take(submission))
    };
    let mut chosen = attacks::choose(attacks::load(root)?, &given.texts(0))?;
    if let Some(shard) = shard {
        chosen = attacks::part(chosen, shard);
    }
    let bar = bar_of_steps(chosen.len());
    let mut tried = attacks::run_all(root, chosen, grade, |tried| {
        let text = tried.complaints.iter().map(|complaint| format!("{}: {complaint}", tried.attack.name));
        bar.suspend(|| text.for_each(|line| println!("{line}")));
        bar.inc(1);
    })?;
    bar.finish_and_clear();
    let (n, repelled) = (tried.len(), tried.iter().filter(|tried| tried.complaints.is_empty()).count());
    tried.sort_by_key(|tried| std::cmp::Reverse(tried.took));
    let slowest = tried.iter().take(SLOWEST);
    let slowest = slowest.map(|tried| format!("{} {:.0} s", tried.attack.name, tried.took.as_secs_f64()));
    println!("slowest: {}", slowest.collect::<Vec<_>>().join(", "));
    println!("{repelled} of {n} attacks got the expected result");
    Ok(repelled == n)
}
