//! Runs the program.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

pub fn grader(arguments: &[&str]) -> Output {
    let program = Command::new(env!("CARGO_BIN_EXE_grader")).current_dir(root()).args(arguments).output();
    program.expect("the program starts")
}

pub fn printed(output: &Output) -> (String, String) {
    (String::from_utf8_lossy(&output.stdout).into(), String::from_utf8_lossy(&output.stderr).into())
}

/// Whether tests that take long are left out, which the test then says.
pub fn leaves_out_what_takes_long() -> bool {
    let leaves_out = std::env::var_os("CI_LONG").is_none();
    if leaves_out {
        println!("SKIPPED: tried only with CI_LONG=1");
    }
    leaves_out
}
