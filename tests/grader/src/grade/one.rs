//! `grader grade-one`: grades one submission for Gradescope or GitHub Classroom. It always writes a result file, even when
//! grading fails.

use super::options::GradingOptions;
use super::report;
use super::result::{Graded, Session, in_words};
use anyhow::{Context, Result, anyhow};
use raykata::film::write_atomically;
use raykata_cli::args::{Argument, Given, Misuse, Opt, Spec};
use serde_json::Value;
use std::any::Any;
use std::io::Write;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};

/// `grader grade-one`.
pub static SPEC: Spec = Spec {
    name: "grader grade-one",
    about: "Grade one submission for Gradescope or GitHub Classroom (the files of `export` run this). At least one of \
            `--gradescope` and `--classroom` is needed.",
    arguments: &[Argument::required("SUBMISSION", "The submission: a folder, .zip, .tar or .tar.gz.")],
    options: &[
        &[
            Opt::value("--gradescope", "FILE", "The file for the results for Gradescope, as JSON."),
            Opt::value(
                "--classroom",
                "FILE",
                "The file for the results for GitHub Classroom, as JSON. A workflow's output `result` needs it in base64.",
            ),
        ],
        GradingOptions::OPTIONS,
    ],
};

/// The options of `grader grade-one`.
pub struct GradeOneOptions {
    submission: PathBuf,
    gradescope: Option<PathBuf>,
    classroom: Option<PathBuf>,
    grading: GradingOptions,
}

impl GradeOneOptions {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Result<GradeOneOptions, Misuse> {
        if !given.has("--gradescope") && !given.has("--classroom") {
            return Err(given.misuse("at least one of `--gradescope FILE` and `--classroom FILE` is needed"));
        }
        Ok(GradeOneOptions {
            submission: given.required(0)?.into(),
            gradescope: given.path("--gradescope"),
            classroom: given.path("--classroom"),
            grading: GradingOptions::read(given)?,
        })
    }
}

/// Grades a submission and writes the result files, even when grading fails. Returns `Ok(true)` if the submission could be
/// graded.
pub fn run(root: impl FnOnce() -> Result<PathBuf>, options: &GradeOneOptions) -> Result<bool> {
    let graded = catch_unwind(AssertUnwindSafe(|| grade(&root()?, options)));
    let (graded, session) =
        match graded.unwrap_or_else(|panic| Err(anyhow!("the grader panicked: {}", said(&*panic)))) {
            Ok(graded) => graded,
            Err(error) => {
                eprintln!("error: {error:#}");
                broken(options, &format!("the grader failed, tell your instructor: {error:#}"))
            }
        };
    if let Some(file) = &options.gradescope {
        write(file, &report::gradescope(&graded, &session))?;
    }
    if let Some(file) = &options.classroom {
        write(file, &report::classroom(&graded))?;
    }
    println!("{}", in_words(graded.score()));
    Ok(graded.trouble.is_empty())
}

fn grade(root: &Path, options: &GradeOneOptions) -> Result<(Graded, Session)> {
    if let Some(course) = options.grading.course()? {
        course.apply()?;
    }
    let (grader, session) = options.grading.begin(root, None)?;
    let graded = grader.grade("submission", grader.take(&options.submission))?;
    Ok((graded, session))
}

/// Returns the result for a failure of the grader itself: no points, and the reason.
fn broken(options: &GradeOneOptions, trouble: &str) -> (Graded, Session) {
    let graded = Graded { student: "submission".into(), trouble: trouble.into(), ..Graded::default() };
    let session = Session {
        kit: env!("CARGO_PKG_VERSION").into(),
        seed: options.grading.seed.unwrap_or_default(),
        ..Session::default()
    };
    (graded, session)
}

fn said(panic: &(dyn Any + Send)) -> &str {
    let owned = panic.downcast_ref::<String>().map(String::as_str);
    owned.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a message")
}

fn write(file: &Path, results: &Value) -> Result<()> {
    crate::report::make_folder_of(file)?;
    let text = serde_json::to_vec_pretty(results)?;
    write_atomically(file, |out| out.write_all(&text))
        .with_context(|| format!("{} cannot be written", file.display()))
}
