//! `raykata grade`: a verdict on each submission of a class, reached outside the students' processes.
//!
//! The way of a submission: `submission` takes the files in which students write and nothing else, `lint` says what no
//! exercise needs, `forge` compiles the rest in a jail, `judge` puts the laws to the worker that came of it, `store`
//! writes the grade down, `report` tells everybody.

pub mod attacks;
mod class;
mod forge;
mod judge;
mod lint;
mod one;
mod rehearsal;
pub mod report;
pub mod result;
mod sanity;
mod siege;
mod store;
mod submission;

pub use class::{Grader, lint_if_asked};
pub use one::{Options as OneOptions, run as one};
pub use rehearsal::{Options as RehearsalOptions, run as rehearse};
pub use siege::{Options as AttackOptions, run as attack};

use crate::{jail, queue};
use anyhow::{Context, Result, bail, ensure};
use checks::STAGES;
use clap::Args;
use forge::Forge;
use jail::{Jail, Purpose};
use judge::Judge;
use result::{Graded, Session};
use sha2::{Digest, Sha256};
use std::fs;
use std::hash::{BuildHasher, RandomState};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use store::Store;
use submission::Submission;

/// Grade a folder of submissions.
#[derive(Args)]
pub struct Options {
    /// The folder: each folder, .zip, .tar or .tar.gz in it is a submission, by the name of its student.
    submissions: PathBuf,
    /// The folder for the grades: tables, reports, and the database that `--resume` goes on with.
    #[arg(long)]
    out: PathBuf,
    /// How many submissions are graded at a time; one a core if not given.
    #[arg(long, value_parser = clap::value_parser!(u16).range(1..))]
    jobs: Option<u16>,
    /// The stages, as `3`, `1-4` or `1-4,10`; all if not given.
    #[arg(long, value_parser = stages)]
    stages: Option<Stages>,
    /// Only part I of N of the class, as `2/8`; `raykata merge` puts parts together. Needs --seed.
    #[arg(long, value_parser = shard, requires = "seed")]
    shard: Option<Shard>,
    /// Go on with the grades in the folder: only what is new or has changed is graded.
    #[arg(long)]
    resume: bool,
    /// Picks the hidden inputs; drawn at random if not given, and the same for all students.
    #[arg(long)]
    seed: Option<u64>,
    /// Rules of the syntax check that do not apply, as a refusal names them.
    #[arg(long, value_delimiter = ',')]
    allow: Vec<String>,
    /// Grade even where submissions cannot be contained. They can then do what you can.
    #[arg(long)]
    insecure: bool,
}

/// Numbers of stages, in order.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Stages(Vec<u8>);

/// As people write them.
pub(crate) fn stages(text: &str) -> Result<Stages> {
    let number =
        |text: &str| text.trim().parse::<u8>().with_context(|| format!("`{text}` is no number of a stage"));
    let mut stages = Vec::new();
    for part in text.split(',') {
        let (first, last) = part.split_once('-').unwrap_or((part, part));
        stages.extend(number(first)?..=number(last)?);
    }
    stages.sort_unstable();
    stages.dedup();
    ensure!(!stages.is_empty(), "`{text}` names no stage");
    for stage in &stages {
        ensure!(STAGES.iter().any(|(number, _)| number == stage), "there is no stage {stage}");
    }
    Ok(Stages(stages))
}

/// A part of a class.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Shard {
    index: u64,
    of: u64,
}

fn shard(text: &str) -> Result<Shard> {
    let (index, of) = text.split_once('/').with_context(|| format!("`{text}` is not like 2/8"))?;
    let shard = Shard { index: index.parse()?, of: of.parse()? };
    ensure!((1..=shard.of).contains(&shard.index), "parts are counted from 1: 1/{of} to {of}/{of}");
    Ok(shard)
}

impl Shard {
    /// By name alone, so that every machine agrees whatever else lies in its folder.
    fn holds(self, student: &str) -> bool {
        let hash = Sha256::digest(student);
        let number = hash[..8].iter().fold(0u64, |number, byte| number << 8 | u64::from(*byte));
        number % self.of == self.index - 1
    }
}

/// `Ok(true)` if every submission could be graded, whatever its grade is.
pub fn run(root: &Path, options: &Options) -> Result<bool> {
    let isolation = isolation(options.insecure)?;
    let (submissions, others) = submission::find(&options.submissions)
        .with_context(|| format!("cannot read the folder {}", options.submissions.display()))?;
    for other in others {
        eprintln!("not a submission: {}", other.display());
    }
    let mine = |one: &Submission| options.shard.is_none_or(|shard| shard.holds(&one.student));
    let submissions: Vec<Submission> = submissions.into_iter().filter(mine).collect();
    ensure!(!submissions.is_empty(), "there is no submission in {}", options.submissions.display());
    crate::report::make_folder(&options.out)?;
    let forge = Forge::prepare(root)?;
    let store = Store::open(&options.out)?;
    let session = session(root, options, &store, &forge, isolation)?;
    store.begin(&session)?;
    let names: Vec<&str> = submissions.iter().map(|one| one.student.as_str()).collect();
    store.retain(&names)?;
    let judge =
        Judge::of(&session.stages, session.seed, (!options.insecure).then(|| Jail::new(Purpose::Worker)))?;
    let grader = Grader { forge: Arc::new(forge), judge: Arc::new(judge), allowed: options.allow.clone() };
    let bar = crate::report::bar_of_steps(submissions.len());
    let jobs = options.jobs.map_or_else(queue::cores, usize::from);
    grader.grade_all(&submissions, &store, jobs, |_| bar.inc(1))?;
    bar.finish_and_clear();
    finish(&store, &options.out)
}

/// Puts the parts of a class together.
pub fn merge(parts: &[PathBuf], out: &Path) -> Result<bool> {
    crate::report::make_folder(out)?;
    let store = Store::open(out)?;
    ensure!(store.session()?.is_none(), "{} holds grades already; choose another folder", out.display());
    for part in parts {
        ensure!(part.join(store::FILE).is_file(), "{} holds no grades", part.display());
        store.take_over(&Store::open(part)?.class()?, part)?;
    }
    finish(&store, out)
}

/// Writes the reports and says how it went.
fn finish(store: &Store, out: &Path) -> Result<bool> {
    let class = store.class()?;
    report::write_all(&class, out)?;
    let troubled: Vec<&Graded> = class.students.iter().filter(|one| !one.trouble.is_empty()).collect();
    for one in &troubled {
        eprintln!("{}: {}", one.student, one.trouble);
    }
    println!("{} submissions graded; open {}", class.students.len(), out.join("index.html").display());
    Ok(troubled.is_empty())
}

/// What contains the submissions, in a line for the reports.
fn isolation(insecure: bool) -> Result<String> {
    match jail::self_test() {
        Ok(level) => Ok(level.to_string()),
        Err(error) if insecure => {
            eprintln!("warning: submissions are not contained: {error:#}");
            Ok("none, on the word of the instructor (--insecure)".into())
        }
        Err(error) => Err(error.context(
            "submissions cannot be contained here, so none is run (--insecure runs them all the same, with your rights)",
        )),
    }
}

/// How the class is graded: as it was begun, or as the options say.
fn session(
    root: &Path,
    options: &Options,
    store: &Store,
    forge: &Forge,
    isolation: String,
) -> Result<Session> {
    let begun = store.session()?;
    if begun.is_some() && !options.resume {
        bail!(
            "{} holds grades already: --resume goes on with them, or choose another folder",
            options.out.display()
        );
    }
    let seed = options.seed.or(begun.as_ref().map(|session| session.seed));
    let stages = match (&options.stages, &begun) {
        (Some(Stages(stages)), _) => stages.clone(),
        (None, Some(session)) => session.stages.clone(),
        (None, None) => all_stages(),
    };
    let seed = seed.unwrap_or_else(draw_seed);
    Ok(Session { kit: kit(root, &options.allow, forge)?, stages, seed, isolation })
}

fn all_stages() -> Vec<u8> {
    STAGES.iter().map(|(number, _)| *number).collect()
}

/// A seed that nobody knows: the standard library draws keys for its tables at random.
pub(crate) fn draw_seed() -> u64 {
    RandomState::new().hash_one("seed")
}

/// Version of the kit, with a fingerprint of all that decides a grade.
fn kit(root: &Path, allow: &[String], forge: &Forge) -> Result<String> {
    let mut hash = Sha256::new();
    hash.update(forge.fingerprint());
    hash.update(allow.join(","));
    let mut waiting =
        vec![root.join("tests/checks/src"), root.join("tests/golden"), root.join("tests/rubric.toml")];
    while let Some(path) = waiting.pop() {
        if path.is_dir() {
            let mut inside: Vec<PathBuf> =
                fs::read_dir(&path)?.map(|entry| Ok(entry?.path())).collect::<Result<_>>()?;
            inside.sort();
            waiting.extend(inside);
        } else {
            hash.update(fs::read(&path).with_context(|| path.display().to_string())?);
        }
    }
    Ok(format!("{} ({})", env!("CARGO_PKG_VERSION"), &forge::hex(&hash.finalize())[..12]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stages_and_parts_are_read_as_people_write_them() {
        assert_eq!(stages("1-4,10").unwrap(), Stages(vec![1, 2, 3, 4, 10]));
        assert_eq!(stages("3").unwrap(), Stages(vec![3]));
        for wrong in ["", "x", "0", "4-2", "1-99"] {
            assert!(stages(wrong).is_err(), "{wrong}");
        }
        assert_eq!(shard("2/8").unwrap(), Shard { index: 2, of: 8 });
        for wrong in ["0/8", "9/8", "2", "a/b", "1/0"] {
            assert!(shard(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn every_student_is_in_one_part() {
        for student in ["ann", "bob", "c d", "é"] {
            let parts = (1..=7).filter(|&index| Shard { index, of: 7 }.holds(student)).count();
            assert_eq!(parts, 1, "{student}");
        }
    }
}
