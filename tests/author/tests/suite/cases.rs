//! Tests the catalogue of hard cases: there are 118, each with an existing check or test, or with a reason why it has none.

use author::cases::read;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Returns the texts of all Rust files below a folder.
fn sources(folder: &Path) -> String {
    let mut text = String::new();
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("an entry").path();
        if path.is_dir() {
            text += &sources(&path);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            text += &std::fs::read_to_string(path).expect("a text");
        }
    }
    text
}

#[test]
fn every_case_is_seen_to() {
    let cases = read(&root()).unwrap_or_else(|error| panic!("{error:#}"));
    assert_eq!(cases.len(), 118);
    let sources: String = ["src", "solutions/tests", "tests/author/tests"]
        .iter()
        .map(|folder| sources(&root().join(folder)))
        .collect();
    for case in &cases {
        for check in &case.checks {
            let exists = all_checks::STAGES.iter().any(|(_, all)| all.iter().any(|one| one.name == check));
            assert!(exists, "{}: there is no check `{check}`", case.name);
        }
        for test in &case.tests {
            assert!(sources.contains(&format!("fn {test}()")), "{}: there is no test `{test}`", case.name);
        }
        let is_covered = case.checks.len() + case.tests.len() > 0;
        assert!(is_covered != case.uncovered.is_some(), "{}: a check or test, or else a reason", case.name);
    }
}
