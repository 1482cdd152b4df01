//! Runs the program.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Runs a command line whose words have no spaces.
pub fn raykata(line: &str) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_raykata"));
    program.current_dir(root()).args(line.split_whitespace()).output().expect("the program starts")
}

/// What a command printed to standard output and to standard error.
pub fn printed(output: &Output) -> (String, String) {
    (String::from_utf8_lossy(&output.stdout).into(), String::from_utf8_lossy(&output.stderr).into())
}

/// What a command printed to standard output; it must succeed.
#[track_caller]
pub fn said(line: &str) -> String {
    let output = raykata(line);
    let (said, complaint) = printed(&output);
    assert!(output.status.success(), "{line}: {said}{complaint}");
    said
}

/// What a command printed to standard error; it must end with this code.
#[track_caller]
pub fn complaint(line: &str, code: i32) -> String {
    let output = raykata(line);
    let (said, complaint) = printed(&output);
    assert_eq!(output.status.code(), Some(code), "{line}: {said}{complaint}");
    complaint
}
