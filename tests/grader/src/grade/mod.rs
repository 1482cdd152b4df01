//! `grader grade`: a verdict on each submission of a class, reached outside the students' processes.
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
mod terms;

pub use class::{Grader, lint_if_asked};
pub use one::{Options as OneOptions, run as one};
pub use rehearsal::{Options as RehearsalOptions, run as rehearse};
pub use siege::{Options as AttackOptions, run as attack};
pub(crate) use terms::{draw_seed, stages};

use crate::queue;
use anyhow::{Context, Result, ensure};
use clap::Args;
use result::Graded;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use store::Store;
use submission::Submission;
use terms::Terms;

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
    /// Only part I of N of the class, as `2/8`; `grader merge` puts parts together. Needs --seed.
    #[arg(long, value_parser = shard, requires = "seed")]
    shard: Option<Shard>,
    /// Go on with the grades in the folder: only what is new or has changed is graded.
    #[arg(long)]
    resume: bool,
    #[command(flatten)]
    terms: Terms,
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
    let (submissions, others) = submission::find(&options.submissions)
        .with_context(|| format!("cannot read the folder {}", options.submissions.display()))?;
    for other in others {
        eprintln!("not a submission: {}", other.display());
    }
    let mine = |one: &Submission| options.shard.is_none_or(|shard| shard.holds(&one.student));
    let submissions: Vec<Submission> = submissions.into_iter().filter(mine).collect();
    ensure!(!submissions.is_empty(), "there is no submission in {}", options.submissions.display());
    crate::report::make_folder(&options.out)?;
    let store = Store::open(&options.out)?;
    let begun = store.session()?;
    ensure!(
        begun.is_none() || options.resume,
        "{} holds grades already: --resume goes on with them, or choose another folder",
        options.out.display()
    );
    let (grader, session) = options.terms.begin(root, begun.as_ref())?;
    store.begin(&session)?;
    let names: Vec<&str> = submissions.iter().map(|one| one.student.as_str()).collect();
    store.retain(&names)?;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_read_as_people_write_them() {
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
