//! `junit.xml`, for CI servers. A test suite is a submission, a test case is a check.

use super::machines::is_error;
use super::{Each, messages};
use crate::grade::result::{CheckResult, Graded, Outcome};
use anyhow::{Context, Result};
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};
use std::io::Write;

/// The numbers of test cases in the whole file, which stand at its top.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Totals {
    tests: usize,
    failures: usize,
    errors: usize,
}

impl Totals {
    /// Adds the test cases of a submission.
    pub fn add(&mut self, graded: &Graded) {
        let trouble = usize::from(!graded.trouble.is_empty());
        let failed = || graded.checks.iter().filter(|check| check.outcome != Outcome::Passed);
        let errors = failed().filter(|check| is_error(check.outcome)).count();
        self.tests += graded.checks.len() + trouble;
        self.failures += failed().count() - errors;
        self.errors += errors + trouble;
    }
}

/// Writes the whole file, one submission after the other. It is valid in the schema of Jenkins (`junit-10.xsd` of its xUnit
/// plugin), and contains no times, because they differ from run to run.
pub(super) fn junit(totals: Totals, each: &Each<'_>, out: &mut dyn Write) -> Result<()> {
    let mut report = Report::new("raykata grade");
    (report.tests, report.failures, report.errors) = (totals.tests, totals.failures, totals.errors);
    out.write_all(opened(&report)?.as_bytes())?;
    each(&mut |graded| {
        // Take the element of the submission out of a file of its own.
        let mut report = Report::new("");
        report.add_test_suite(suite(&graded));
        let text = opened(&report)?;
        let (_, elements) = text.split_once("<testsuites").context("no test suites")?;
        let (_, suite) = elements.split_once(">\n").context("no test suite")?;
        Ok(out.write_all(suite.as_bytes())?)
    })?;
    Ok(out.write_all(END.as_bytes())?)
}

const END: &str = "</testsuites>\n";

/// Returns a file without its end, so that more test suites can follow.
fn opened(report: &Report) -> Result<String> {
    let mut bytes = Vec::new();
    report.serialize(&mut bytes)?;
    // The schema allows this count only in a test suite. No check is skipped.
    let text = String::from_utf8(bytes)?.replacen(" skipped=\"0\"", "", 1);
    Ok(text.strip_suffix(END).context("the file ends in another way")?.to_owned())
}

fn suite(graded: &Graded) -> TestSuite {
    let mut suite = TestSuite::new(graded.student.as_str());
    let score = graded.score();
    let (earned, of) = score.points();
    suite.add_property(("points", earned.to_string().as_str()));
    suite.add_property(("of", of.to_string().as_str()));
    suite.add_property(("core", score.core.0.to_string().as_str()));
    if score.bonus.0 > 0 {
        suite.add_property(("bonus", score.bonus.0.to_string().as_str()));
    }
    suite.add_test_cases(graded.checks.iter().map(case));
    if !graded.trouble.is_empty() {
        let mut status = TestCaseStatus::non_success(NonSuccessKind::Error);
        status.set_message("could not be graded").set_type("trouble").set_description(&graded.trouble);
        suite.add_test_case(TestCase::new("submission", status));
    }
    let remarks: Vec<String> =
        graded.remarks.iter().map(|remark| format!("{}: {}", remark.file, remark.what)).collect();
    if !remarks.is_empty() {
        suite.set_system_out(remarks.join("\n"));
    }
    if !graded.compiler.is_empty() {
        suite.set_system_err(&graded.compiler);
    }
    suite
}

fn case(check: &CheckResult) -> TestCase {
    let status = match check.outcome {
        Outcome::Passed => TestCaseStatus::success(),
        outcome => {
            let kind = if is_error(outcome) { NonSuccessKind::Error } else { NonSuccessKind::Failure };
            let mut status = TestCaseStatus::non_success(kind);
            status.set_message(messages::entry(check).title).set_type(outcome.words());
            status.set_description(messages::message(check));
            status
        }
    };
    let mut case = TestCase::new(check.name.as_str(), status);
    case.set_classname(format!("stage{}", check.stage));
    case
}
