//! The options of grading, and the grader that is made from them.

use super::grader::Grader;
use super::judge::{CALL_PATIENCE, Judge};
use super::result::Session;
use super::worker_builder::{self, WorkerBuilder};
use crate::course::{self, HandedIn};
use crate::files_below::files_below;
use crate::sandbox::{self, Confinement};
use all_checks::STAGES;
use anyhow::{Context, Result, bail};
use raykata::course::stages_of;
use raykata::rubric;
use raykata_cli::args::{Given, Misuse, Opt};
use sha2::{Digest, Sha256};
use std::fs;
use std::hash::{BuildHasher, RandomState};
use std::path::Path;
use std::sync::Arc;

/// The options that `grader grade` and `grader grade-one` share.
#[derive(Default)]
pub struct GradingOptions {
    /// The numbers of the stages, in ascending order.
    pub(super) stages: Option<Vec<u8>>,
    pub(super) seed: Option<u64>,
    pub(super) allow: Vec<String>,
    pub(super) insecure: bool,
}

impl GradingOptions {
    /// The options for the command line.
    pub const OPTIONS: &[Opt] = &[
        Opt::value("--stages", "LIST", "The stages, as `3`, `1-4` or `1-4,10` [default: all]."),
        Opt::value(
            "--seed",
            "N",
            "Picks the hidden inputs [default: drawn at random]. Set it when you grade the submissions of a class one by \
             one; otherwise each gets different inputs.",
        ),
        Opt::value(
            "--allow",
            "LIST",
            "Rules of the syntax check to switch off, by the names in its messages.",
        )
        .many(),
        course::OPTION,
        Opt::flag("--insecure", "Grade even if there is no sandbox. Submissions then have all your rights."),
    ];

    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Result<GradingOptions, Misuse> {
        Ok(GradingOptions {
            stages: given.parsed("--stages", stages_of)?,
            seed: given.number("--seed", 0..=u64::MAX)?,
            allow: given.list("--allow", |rule| Ok::<_, String>(rule.to_owned()))?,
            insecure: given.has("--insecure"),
        })
    }

    /// Makes a grader, and the session that the reports describe. Without the options, stages and seed are those of
    /// `begun`, the earlier run, or the stages are those of the course.
    pub fn begin(&self, root: &Path, begun: Option<&Session>) -> Result<(Grader, Session)> {
        let (confinement, isolation) = self.confinement()?;
        let builder = WorkerBuilder::prepare(root, confinement)?;
        let course = rubric::course();
        if let Some(stage) = self.stages.iter().flatten().find(|stage| course.leaves_out(**stage)) {
            bail!("--stages names stage {stage}, which the course file leaves out: change one of the two");
        }
        // Another course file decides which of the graded stages count.
        let begun_stages = begun.map(|begun| match begun.course == course::name(course) {
            true => begun.stages.clone(),
            false => begun.graded().into_iter().filter(|stage| !course.leaves_out(*stage)).collect(),
        });
        let all = STAGES.iter().map(|(number, _)| *number);
        let of_course = || all.filter(|number| !course.leaves_out(*number)).collect();
        let session = Session {
            kit: kit(root, &self.allow, &builder)?,
            stages: self.stages.clone().or(begun_stages).unwrap_or_else(of_course),
            seed: self.seed.or(begun.map(|session| session.seed)).unwrap_or_else(draw_seed),
            isolation,
            dropped: Vec::new(),
            course: course::name(course),
            due: course.due.iter().map(|(stage, due)| (*stage, due.to_string())).collect(),
        };
        // Run the checks against the reference to prepare the judge.
        let judge = Judge::of(root, &session.stages, session.seed, confinement)?;
        let allowed = self.allow.clone();
        let grader = Grader {
            builder: Arc::new(builder),
            judge: Arc::new(judge),
            confinement,
            allowed,
            handed_in: HandedIn::new(),
            call_patience: CALL_PATIENCE,
            shared: None,
        };
        Ok((grader, session))
    }

    /// Tests the sandbox. Returns how strict it is, and a line about it for the reports.
    fn confinement(&self) -> Result<(Confinement, String)> {
        match sandbox::self_test() {
            Ok(level) => Ok((Confinement::Full, level)),
            Err(error) if self.insecure => {
                eprintln!("warning: submissions run without a sandbox: {error:#}");
                let isolation = "resource limits only, by choice of the instructor (--insecure)";
                Ok((Confinement::LimitsOnly, isolation.into()))
            }
            Err(error) => Err(error.context(
                "the sandbox does not hold on this machine, so no submission is run (--insecure runs them anyway, with \
                 your rights)",
            )),
        }
    }
}

/// Draws a random seed from the random keys of the standard library's hash tables.
pub(crate) fn draw_seed() -> u64 {
    RandomState::new().hash_one("seed")
}

/// Returns the version of the kit, with a fingerprint of everything that decides a grade.
fn kit(root: &Path, allow: &[String], builder: &WorkerBuilder) -> Result<String> {
    let mut hash = Sha256::new();
    hash.update(builder.fingerprint());
    hash.update(allow.join(","));
    // Add all files that decide a grade to the fingerprint.
    let decide = ["tests/checks", "tests/golden", "tests/oracle"];
    for folder in decide.into_iter().filter(|folder| root.join(folder).exists()) {
        for path in files_below(root, folder, &|_| true)? {
            hash.update(fs::read(root.join(&path)).context(path)?);
        }
    }
    Ok(format!("{} ({})", env!("CARGO_PKG_VERSION"), &worker_builder::hex(&hash.finalize())[..12]))
}
