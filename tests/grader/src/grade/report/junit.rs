//! `junit.xml`, for CI servers. A test suite is a submission, a test case is a check.

use super::machines::is_error;
use super::messages;
use crate::grade::result::{CheckResult, Class, Graded, Outcome};
use anyhow::Result;
use quick_junit::{NonSuccessKind, Report, TestCase, TestCaseStatus, TestSuite};

/// Returns the whole file, which is valid in the schema of Jenkins (`junit-10.xsd` of its xUnit plugin). It contains no times,
/// because they differ from run to run.
pub(super) fn junit(class: &Class) -> Result<Vec<u8>> {
    let mut report = Report::new("raykata grade");
    report.add_test_suites(class.students.iter().map(suite));
    let mut bytes = Vec::new();
    report.serialize(&mut bytes)?;
    // The schema allows this count only in a test suite. No check is skipped.
    Ok(String::from_utf8(bytes)?.replacen(" skipped=\"0\"", "", 1).into_bytes())
}

fn suite(graded: &Graded) -> TestSuite {
    let mut suite = TestSuite::new(graded.student.as_str());
    let (earned, of) = graded.points();
    suite.add_property(("points", earned.to_string().as_str()));
    suite.add_property(("of", of.to_string().as_str()));
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
