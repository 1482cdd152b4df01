//! `grader grade-one`: grades one submission for Gradescope or GitHub Classroom. It always writes a result file, even when
//! grading fails.

use super::options::GradingOptions;
use super::report;
use super::result::{Graded, Session, in_words};
use crate::course::CourseFiles;
use crate::export::write;
use crate::kits::root;
use anyhow::{Result, anyhow};
use raykata_cli::args::{Argument, Given, Opt, Spec};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

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

/// Grades a submission and writes the result files, even when grading fails. Returns `Ok(true)` if the submission could be
/// graded.
pub fn run(given: &Given) -> Result<bool> {
    let (gradescope, classroom) = (given.path("--gradescope"), given.path("--classroom"));
    if gradescope.is_none() && classroom.is_none() {
        let message = "at least one of `--gradescope FILE` and `--classroom FILE` is needed";
        return Err(given.misuse(message).into());
    }
    let submission = Path::new(given.required(0)?);
    let options = GradingOptions::read(given)?;
    let grade = || {
        let root = root()?;
        CourseFiles::given(given)?.map_or(Ok(()), |course| course.apply())?;
        let (grader, session) = options.begin(&root, None)?;
        Ok((grader.grade("submission", grader.take(submission))?, session))
    };
    let graded = catch_unwind(AssertUnwindSafe(grade));
    let (graded, session) =
        match graded.unwrap_or_else(|panic| Err(anyhow!("the grader panicked: {}", said(&*panic)))) {
            Ok(graded) => graded,
            Err(error) => {
                eprintln!("error: {error:#}");
                broken(&options, &format!("the grader failed, tell your instructor: {error:#}"))
            }
        };
    if let Some(file) = gradescope {
        write(&file, &serde_json::to_vec_pretty(&report::gradescope(&graded, &session))?)?;
    }
    if let Some(file) = classroom {
        write(&file, &serde_json::to_vec_pretty(&report::classroom(&graded))?)?;
    }
    println!("{}", in_words(graded.score()));
    Ok(graded.trouble.is_empty())
}

/// Returns the result for a failure of the grader itself: no points, and the reason.
fn broken(options: &GradingOptions, trouble: &str) -> (Graded, Session) {
    let graded = Graded { student: "submission".into(), trouble: trouble.into(), ..Graded::default() };
    let session = Session {
        kit: env!("CARGO_PKG_VERSION").into(),
        seed: options.seed.unwrap_or_default(),
        ..Session::default()
    };
    (graded, session)
}

fn said(panic: &(dyn Any + Send)) -> &str {
    let owned = panic.downcast_ref::<String>().map(String::as_str);
    owned.or_else(|| panic.downcast_ref::<&str>().copied()).unwrap_or("without a message")
}
