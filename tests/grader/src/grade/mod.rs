//! `grader grade`: grades each submission of a class. The verdicts are made outside of the students' processes.
//!
//! The steps for a submission: `submission` reads the exercise files and nothing else, `lint` refuses constructs that no
//! exercise needs, `forge` compiles the rest in a sandbox, `judge` runs the checks against the resulting worker, `store`
//! saves the grade, `report` writes the reports.

pub mod attacks;
mod counted;
mod forge;
mod grader;
mod judge;
mod lint;
mod naive;
mod one;
mod options;
mod rehearsal;
pub mod report;
pub mod result;
mod run_attacks;
mod sanity;
mod scratch;
mod store;
mod submission;

pub use grader::{Grader, lint_if_asked};
pub use one::{Options as OneOptions, SPEC as ONE, run as one};
pub(crate) use options::{Stages, draw_seed, stages};
pub use rehearsal::{Options as RehearsalOptions, SPEC as REHEARSE, run as rehearse};
pub use run_attacks::{Options as AttackOptions, SPEC as ATTACKS, run as attack};

use crate::queue;
use anyhow::{Context, Result, ensure};
use options::GradingOptions;
use raykata_cli::args::{Argument, Given, Misuse, Opt, Spec};
use report::clean::clean_line;
use result::Graded;
use sha2::{Digest, Sha256};
use std::path::{Path, PathBuf};
use store::Store;
use submission::Submission;

/// `grader grade`.
pub static SPEC: Spec = Spec {
    name: "grader grade",
    about: "Grade a folder of submissions, each in a sandbox, and write tables and reports (for instructors).",
    arguments: &[Argument::required(
        "SUBMISSIONS",
        "The folder of the class. Each folder, .zip, .tar or .tar.gz in it is a submission, named after its student.",
    )],
    options: &[
        &[
            Opt::value(
                "--out",
                "FOLDER",
                "The folder for the grades: tables, reports, and the database that `--resume` continues.",
            )
            .required(),
            Opt::value(
                "--jobs",
                "N",
                "How many submissions to grade at the same time [default: one per core].",
            ),
            Opt::value(
                "--shard",
                "I/N",
                "Grade only part I of N of the class, as `2/8`; `grader merge` combines the parts. Needs --seed.",
            ),
            Opt::flag(
                "--resume",
                "Continue with the grades in the folder: grade only submissions that are new or have changed. Grades of \
                 other submissions stay, so SUBMISSIONS may be a folder of late ones.",
            ),
            Opt::flag(
                "--forget-missing",
                "With `--resume`: delete the grades of submissions that are not in SUBMISSIONS.",
            ),
        ],
        GradingOptions::OPTIONS,
    ],
};

/// `grader merge`.
pub static MERGE: Spec = Spec {
    name: "grader merge",
    about: "Combine the grades that `grade --shard` made of the parts of a class (for instructors).",
    arguments: &[Argument::required("PART", "The folders of the parts.").many()],
    options: &[&[Opt::value("--out", "FOLDER", "The folder for the grades of the whole class.").required()]],
};

/// The options of `grader grade`.
pub struct Options {
    submissions: PathBuf,
    out: PathBuf,
    jobs: Option<u16>,
    shard: Option<Shard>,
    resume: bool,
    forget_missing: bool,
    grading: GradingOptions,
}

impl Options {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        let options = Options {
            submissions: given.required(0)?.into(),
            out: given.required_path("--out")?,
            jobs: given.number("--jobs", 1..=u16::MAX)?,
            shard: given.parsed("--shard", shard)?,
            resume: given.has("--resume"),
            forget_missing: given.has("--forget-missing"),
            grading: GradingOptions::read(given)?,
        };
        given.require("--shard", "--seed")?;
        given.require("--forget-missing", "--resume")?;
        Ok(options)
    }
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
    /// Returns whether a student belongs to this part. This depends only on the name, so that all machines agree even if
    /// their folders differ.
    fn holds(self, student: &str) -> bool {
        let hash = Sha256::digest(student);
        let number = hash[..8].iter().fold(0u64, |number, byte| number << 8 | u64::from(*byte));
        number % self.of == self.index - 1
    }
}

/// Grades the class. Returns `Ok(true)` if every submission could be graded, with any grade.
pub fn run(root: &Path, options: &Options) -> Result<bool> {
    // Find the submissions of this part of the class.
    let (submissions, others) = submission::find(&options.submissions)
        .with_context(|| format!("cannot read the folder {}", options.submissions.display()))?;
    for other in others {
        eprintln!("not a submission: {}", other.display());
    }
    let mine = |one: &Submission| options.shard.is_none_or(|shard| shard.holds(&one.student));
    let submissions: Vec<Submission> = submissions.into_iter().filter(mine).collect();
    ensure!(!submissions.is_empty(), "there is no submission in {}", options.submissions.display());
    // Open the database and begin or continue the session.
    scratch::clean();
    crate::report::make_folder(&options.out)?;
    let store = Store::claim(&options.out)?;
    let begun = store.session()?;
    ensure!(
        begun.is_none() || options.resume,
        "{} already contains grades: continue them by --resume, or choose another folder",
        options.out.display()
    );
    let (grader, session) = options.grading.begin(root, begun.as_ref())?;
    store.begin(&session)?;
    // Keep the grades of submissions that are not there, unless the instructor says otherwise.
    let names: Vec<&str> = submissions.iter().map(|one| one.student.as_str()).collect();
    let others = store.others(&names)?;
    if options.forget_missing {
        others.iter().try_for_each(|student| store.forget(student))?;
    }
    if let [first, ..] = &others[..] {
        let fate = if options.forget_missing { "deleted" } else { "kept; --forget-missing deletes them" };
        eprintln!(
            "{} of the grades in {} are of submissions that are not in {}, such as {}: {fate}",
            others.len(),
            options.out.display(),
            options.submissions.display(),
            clean_line(first, 80)
        );
    }
    // Grade all submissions and write the reports.
    let bar = crate::report::bar_of_steps(submissions.len());
    let jobs = options.jobs.map_or_else(queue::cores, usize::from);
    grader.grade_all(&submissions, &store, jobs, |_| bar.inc(1))?;
    bar.finish_and_clear();
    finish(&store, &options.out)
}

/// The options of `grader merge`.
pub struct MergeOptions {
    parts: Vec<PathBuf>,
    out: PathBuf,
}

impl MergeOptions {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Result<MergeOptions, Misuse> {
        given.required(0)?;
        let parts = given.arguments(0).iter().map(PathBuf::from).collect();
        Ok(MergeOptions { parts, out: given.required_path("--out")? })
    }
}

/// Combines the parts of a class.
pub fn merge(MergeOptions { parts, out }: &MergeOptions) -> Result<bool> {
    crate::report::make_folder(out)?;
    let store = Store::claim(out)?;
    ensure!(store.session()?.is_none(), "{} already contains grades; choose another folder", out.display());
    for part in parts {
        ensure!(part.join(store::FILE).is_file(), "{} contains no grades", part.display());
        store.take_over(&Store::open(part)?.class()?, part)?;
    }
    finish(&store, out)
}

/// Writes the reports and prints a summary. Returns whether every submission could be graded.
fn finish(store: &Store, out: &Path) -> Result<bool> {
    let class = store.class()?;
    report::write_all(&class, out)?;
    let troubled: Vec<&Graded> = class.students.iter().filter(|one| !one.trouble.is_empty()).collect();
    for one in &troubled {
        eprintln!("{}: {}", one.student, one.trouble);
    }
    let not_graded = match troubled.len() {
        0 => String::new(),
        n => format!(", {n} of them could not be graded"),
    };
    println!("{} submissions{not_graded}; open {}", class.students.len(), out.join("index.html").display());
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
