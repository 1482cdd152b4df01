//! `grader grade`: grades each submission of a class. The verdicts are made outside of the students' processes.
//!
//! The steps for a submission: `submission` reads the exercise files and nothing else, `lint` refuses constructs that no
//! exercise needs, `worker_builder` compiles the rest in a sandbox, `judge` runs the checks against the resulting worker, `store`
//! saves the grade, `report` writes the reports.

mod counted;
mod grader;
mod judge;
mod merge;
mod once;
mod one;
mod options;
pub mod report;
pub mod result;
mod scratch;
mod shard;
mod store;
mod submission;
mod worker_builder;

pub use grader::{Grader, SharedResults, lint_if_asked};
pub use judge::{CALL_PATIENCE, Judge};
pub use merge::{SPEC as MERGE, run as merge};
pub use once::Once;
pub use one::{SPEC as ONE, run as one};
pub(crate) use options::draw_seed;
pub use shard::{Shard, shard};
pub use store::{FILE as STORE, Store};
pub(crate) use submission::find as find_submissions;
pub use worker_builder::{COMPILER_PATIENCE, WorkerBuilder};

use crate::course::CourseFiles;
use crate::kits::root;
use crate::queue;
use anyhow::{Context, Result, ensure};
use options::GradingOptions;
use raykata::rubric;
use raykata_cli::args::{Argument, Given, Opt, Spec};
use report::clean::clean_line;
use shard::Part;
use std::path::Path;
use submission::Submission;

/// `grader grade`.
pub static SPEC: Spec = Spec {
    name: "grader grade",
    about: "Grade a folder of submissions, each in a sandbox, and write tables and reports.",
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
            Opt::value(
                "--handed-in",
                "FILE",
                "A table of students and times: the grading worksheet of Moodle, or `ann,2026-11-02T18:30:00` below a header. \
                 Reports mark what was handed in after the dates of the course file; the points stay the same.",
            ),
            Opt::value(
                "--again",
                "STUDENT",
                "With `--resume`: grade the submission of this student again, although it has not changed.",
            )
            .many(),
            Opt::flag(
                "--forget-missing",
                "With `--resume`: delete the grades of submissions that are not in SUBMISSIONS.",
            ),
        ],
        GradingOptions::OPTIONS,
    ],
};

/// Grades the class. Returns `Ok(true)` if every submission could be graded, with any grade.
pub fn run(given: &Given) -> Result<bool> {
    let (class, out) = (Path::new(given.required(0)?), given.required_path("--out")?);
    let jobs = given.number("--jobs", 1..=u16::MAX)?;
    let shard = given.parsed("--shard", shard)?;
    let again = given.list("--again", |student| Ok::<_, String>(student.to_owned()))?;
    let options = GradingOptions::read(given)?;
    given.require("--shard", "--seed")?;
    given.require("--forget-missing", "--resume")?;
    given.require("--again", "--resume")?;
    let root = root()?;
    let course = CourseFiles::given(given)?;
    // Find the submissions of this part of the class.
    let (submissions, others) = submission::find(class)?;
    for other in others {
        eprintln!("not a submission: {}", other.display());
    }
    // An archive keeps its extension if its name alone stands for another submission too.
    let is_twin =
        |one: &&Submission| one.path.is_file() && one.path.file_name() == Some(one.student.as_ref());
    for twin in submissions.iter().filter(is_twin) {
        let path = twin.path.display();
        eprintln!(
            "note: {path} has the name of another submission, and both are graded: remove one if they are from the same student"
        );
    }
    ensure!(!submissions.is_empty(), "there is no submission in {}", class.display());
    let part = shard.map(|shard| Part::of(shard, &submissions));
    // A part of a small class may be empty.
    let mine = |one: &Submission| shard.is_none_or(|shard| shard.holds(&one.student));
    let submissions: Vec<Submission> = submissions.into_iter().filter(mine).collect();
    // Open the database and begin or continue the session.
    scratch::clean();
    crate::report::make_folder(&out)?;
    let store = Store::claim(&out)?;
    let begun = store.session()?;
    ensure!(
        begun.is_none() || given.has("--resume"),
        "{} already contains grades: continue them by --resume, or choose another folder",
        out.display()
    );
    let course = course.or(store.course()?);
    course.as_ref().map_or(Ok(()), CourseFiles::apply)?;
    let (mut grader, session) = options.begin(&root, begun.as_ref())?;
    // Keep the grades of submissions that are not there, unless the instructor says otherwise.
    let names: Vec<&str> = submissions.iter().map(|one| one.student.as_str()).collect();
    if let Some(file) = given.path("--handed-in") {
        let (times, unmatched) = crate::course::handed_in(&file, rubric::course(), &names)?;
        grader.handed_in = times;
        // The rows of other parts have no submission here.
        let unmatched = unmatched.iter().filter(|_| shard.is_none());
        unmatched.for_each(|line| eprintln!("note: --handed-in: {}", clean_line(line, 200)));
    }
    store.begin(session)?;
    for student in &again {
        ensure!(
            names.contains(&student.as_str()),
            "--again: there is no submission of {student} in {}",
            class.display()
        );
        store.forget(student)?;
    }
    store.keep_course(course.as_ref())?;
    store.begin_part(part.as_ref())?;
    let others = store.others(&names)?;
    let forgets = given.has("--forget-missing");
    if forgets {
        others.iter().try_for_each(|student| store.forget(student))?;
    }
    if let [first, ..] = &others[..] {
        let fate = if forgets { "deleted" } else { "kept; --forget-missing deletes them" };
        eprintln!(
            "{} of the grades in {} are of submissions that are not in {}, such as {}: {fate}",
            others.len(),
            out.display(),
            class.display(),
            clean_line(first, 80)
        );
    }
    // Grade all submissions and write the reports.
    let bar = crate::report::bar_of_steps(submissions.len());
    let jobs = jobs.map_or_else(queue::cores, usize::from);
    grader.grade_all(&submissions, &store, jobs, |_| bar.inc(1))?;
    bar.finish_and_clear();
    store.finish_part()?;
    finish(&store, &out)
}

/// Most submissions that could not be graded and that are listed at the end. The reports list all.
const MOST_LISTED: usize = 20;

/// Writes the reports and prints a summary. Returns whether every submission could be graded.
fn finish(store: &Store, out: &Path) -> Result<bool> {
    let session = store.session()?.context("nothing has been graded here yet")?;
    store.notes()?.1.iter().for_each(|line| eprintln!("note: {}", clean_line(line, 200)));
    let summary = report::write_from(&session, &|each| store.each(each), out)?;
    for (student, trouble) in summary.troubled.iter().take(MOST_LISTED) {
        eprintln!("{student}: {trouble}");
    }
    let n_troubled = summary.troubled.len();
    if n_troubled > MOST_LISTED {
        eprintln!("{} more could not be graded: see grades.csv", n_troubled - MOST_LISTED);
    }
    let not_graded = match n_troubled {
        0 => String::new(),
        n => format!(", {n} of them could not be graded"),
    };
    println!("{} submissions{not_graded}; open {}", summary.submissions, out.join("index.html").display());
    Ok(n_troubled == 0)
}
