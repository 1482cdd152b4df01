//! `grader grade-one`: a submission for Gradescope or GitHub Classroom. There is always an answer that they can read.

use super::options::GradingOptions;
use super::report;
use super::result::{Graded, Session};
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
    about: "Grade one submission for Gradescope or GitHub Classroom (what `export` writes runs this). At least one of \
            `--gradescope` and `--classroom` is needed.",
    arguments: &[Argument::required("SUBMISSION", "The submission: a folder, .zip, .tar or .tar.gz.")],
    options: &[
        &[
            Opt::value("--gradescope", "FILE", "Where the results for Gradescope go, as JSON."),
            Opt::value(
                "--classroom",
                "FILE",
                "Where the results for GitHub Classroom go, as JSON; a workflow's output `result` is this in base64.",
            ),
        ],
        GradingOptions::OPTIONS,
    ],
};

/// Which submission, and for whom.
pub struct Options {
    submission: PathBuf,
    gradescope: Option<PathBuf>,
    classroom: Option<PathBuf>,
    grading: GradingOptions,
}

impl Options {
    /// As they were given.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        if !given.has("--gradescope") && !given.has("--classroom") {
            return Err(given.misuse("at least one of `--gradescope FILE` and `--classroom FILE` is needed"));
        }
        Ok(Options {
            submission: given.required(0)?.into(),
            gradescope: given.path("--gradescope"),
            classroom: given.path("--classroom"),
            grading: GradingOptions::read(given)?,
        })
    }
}

/// Grades, and writes what came of it, whatever breaks. `Ok(true)` if the submission could be graded.
pub fn run(root: impl FnOnce() -> Result<PathBuf>, options: &Options) -> Result<bool> {
    let graded = catch_unwind(AssertUnwindSafe(|| grade(&root()?, options)));
    let (graded, session) =
        match graded.unwrap_or_else(|panic| Err(anyhow!("it panicked: {}", said(&*panic)))) {
            Ok(graded) => graded,
            Err(error) => {
                eprintln!("error: {error:#}");
                broken(options, &format!("the grader broke, tell your instructor: {error:#}"))
            }
        };
    if let Some(file) = &options.gradescope {
        write(file, &report::gradescope(&graded, &session))?;
    }
    if let Some(file) = &options.classroom {
        write(file, &report::classroom(&graded))?;
    }
    let (earned, of) = graded.points();
    println!("{earned} of {of} points");
    Ok(graded.trouble.is_empty())
}

fn grade(root: &Path, options: &Options) -> Result<(Graded, Session)> {
    let (grader, session) = options.grading.begin(root, None)?;
    let graded = grader.grade("submission", grader.take(&options.submission))?;
    Ok((graded, session))
}

/// What is told when it was us who failed: no points, and why.
fn broken(options: &Options, trouble: &str) -> (Graded, Session) {
    let graded = Graded {
        student: "submission".into(),
        content: String::new(),
        checks: Vec::new(),
        remarks: Vec::new(),
        compiler: String::new(),
        trouble: trouble.into(),
        cpu_ms: 0,
    };
    let session = Session {
        kit: env!("CARGO_PKG_VERSION").into(),
        stages: Vec::new(),
        seed: options.grading.seed.unwrap_or_default(),
        isolation: String::new(),
    };
    (graded, session)
}

fn said(panic: &(dyn Any + Send)) -> &str {
    let owned = panic.downcast_ref::<String>().map(String::as_str);
    owned.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a word")
}

fn write(file: &Path, results: &Value) -> Result<()> {
    crate::report::make_folder_of(file)?;
    let text = serde_json::to_vec_pretty(results)?;
    write_atomically(file, |out| out.write_all(&text))
        .with_context(|| format!("{} cannot be written", file.display()))
}
