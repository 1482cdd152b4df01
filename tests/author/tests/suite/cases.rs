//! Tests the catalogue of hard cases: there are 118, each with an existing check or test, or with a reason why it has none.

use super::program_runs::root;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::process::Command;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(dead_code, reason = "texts for readers of the file")]
struct HardCase {
    name: String,
    input: String,
    required: String,
    #[serde(default)]
    checks: Vec<String>,
    #[serde(default)]
    tests: Vec<String>,
    uncovered: Option<String>,
}

#[test]
fn every_case_is_seen_to() {
    let root = root();
    let text = std::fs::read_to_string(root.join("tests/cases.toml")).expect("a text");
    let catalogue: BTreeMap<String, Vec<HardCase>> = toml::from_str(&text).expect("the catalogue");
    let cases = &catalogue["case"];
    assert_eq!(cases.len(), 118);
    let folders = ["src", "solutions/tests", "tests/author/tests"];
    let listed = Command::new("git").args(["grep", "-h", "^ *fn "]).args(folders).current_dir(&root).output();
    let Some(functions) = listed.ok().filter(|listed| listed.status.success()) else {
        return println!("this is no checkout, whose functions could be listed");
    };
    let functions = String::from_utf8_lossy(&functions.stdout);
    for case in cases {
        for check in &case.checks {
            let exists = all_checks::STAGES.iter().any(|(_, all)| all.iter().any(|one| one.name == check));
            assert!(exists, "{}: there is no check `{check}`", case.name);
        }
        for test in &case.tests {
            assert!(functions.contains(&format!("fn {test}()")), "{}: there is no test `{test}`", case.name);
        }
        let is_covered = case.checks.len() + case.tests.len() > 0;
        assert!(is_covered != case.uncovered.is_some(), "{}: a check or test, or else a reason", case.name);
    }
}
