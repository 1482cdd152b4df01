//! Packages that were built for the first picture and the first check are not built again for the tests of the workspace.
//!
//! Cargo builds a package once per set of features. The features add up over all packages that are built together. So one
//! more dependency of the grader can make cargo build serde, and every package that depends on it, twice. If this test
//! fails, name the feature in the workspace's manifest, as for `serde_core`.

use super::program_runs::root;
use std::collections::BTreeSet;
use std::process::Command;

/// The kit and the exercises, which are built with and without frames on purpose.
const TWO_BUILDS: [&str; 2] = ["exercises ", "solutions "];

/// Returns all packages that this selection builds, each with its version and its features.
fn packages(selection: &[&str]) -> BTreeSet<String> {
    let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
    let output = Command::new(cargo)
        .current_dir(root())
        .args(["tree", "--offline", "--locked", "--prefix", "none", "--format", "{p} [{f}]", "--edges"])
        .args(selection)
        .output()
        .expect("cargo starts");
    assert!(output.status.success(), "{selection:?}: {}", String::from_utf8_lossy(&output.stderr));
    // A package that is shown again is marked with (*).
    let lines = String::from_utf8_lossy(&output.stdout).replace(" (*)", "");
    lines.lines().filter(|line| !line.is_empty()).map(str::to_owned).collect()
}

#[test]
fn nothing_is_built_twice() {
    let tests = packages(&["normal,build,dev", "--workspace"]);
    assert!(tests.iter().any(|package| package.starts_with("serde_core ")), "{tests:?}");
    for selection in [
        // `cargo run` and `cargo test --test stage3`.
        &["normal,build"][..],
        &["normal,build,dev"],
        &["normal,build", "--package", "raykata-cli"],
        // The programs that they build: workers and the judge.
        &["normal,build", "--package", "solutions", "--features", "frames"],
        &["normal,build", "--package", "exercises", "--features", "frames"],
        &["normal,build", "--package", "judge"],
        &["normal,build", "--package", "live"],
        // The programs of instructors and authors.
        &["normal,build", "--package", "grader"],
        &["normal,build", "--package", "author"],
    ] {
        let built = packages(selection);
        assert!(built.len() > 30, "{selection:?} builds too few packages: {built:?}");
        let again: Vec<&String> = built
            .difference(&tests)
            .filter(|package| !TWO_BUILDS.iter().any(|name| package.starts_with(name)))
            .collect();
        let names: Vec<&str> = again.iter().filter_map(|package| package.split(' ').next()).collect();
        let others: Vec<&String> = tests
            .iter()
            .filter(|package| package.split(' ').next().is_some_and(|name| names.contains(&name)))
            .collect();
        assert!(
            again.is_empty(),
            "`cargo test --workspace` builds these again with other features, and all packages that depend on \
             them:\n{selection:?}: {again:#?}\nthe tests: {others:#?}"
        );
    }
}
