//! Runs a program, for the tests of `grader` and of `author`.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

pub fn run(program: &str, arguments: &[&str]) -> Output {
    Command::new(program).current_dir(root()).args(arguments).output().expect("the program starts")
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

/// A shell that may mount a small file system, which no other process sees; `None` without the rights for it.
pub fn small_disk(script: &str) -> Option<Command> {
    let mut try_it = Command::new("unshare");
    try_it.args(["--mount", "sh", "-c", "mount -t tmpfs -o size=4k tmpfs /mnt"]);
    if !try_it.output().is_ok_and(|output| output.status.success()) {
        return None;
    }
    let mut shell = Command::new("unshare");
    shell.args(["--mount", "sh", "-eu", "-c", script]).current_dir(root()).stdin(Stdio::null());
    Some(shell)
}
