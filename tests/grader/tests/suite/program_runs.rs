//! Runs a program, for the tests of `grader` and of `author`.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

pub fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

pub fn run(program: &str, arguments: impl IntoIterator<Item = impl AsRef<OsStr>>) -> Output {
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

/// Runs the program with the words of a line. Returns its exit code and what it prints.
pub fn said(program: &str, line: &str) -> (Option<i32>, String, String) {
    let output = run(program, line.split_whitespace());
    let (out, err) = printed(&output);
    (output.status.code(), out, err)
}

/// Demands that the help of the program lists each command, and that the command's own help has these words, which are separated by
/// spaces.
pub fn explains(program: &str, name: &str, commands: &[(&str, &str)]) {
    let (code, all, _) = said(program, "--help");
    assert_eq!(code, Some(0));
    for (command, parts) in commands {
        assert!(all.lines().any(|line| line.starts_with(&format!("  {command} "))), "no {command} in\n{all}");
        let (code, help, complaint) = said(program, &format!("{command} --help"));
        assert!(code == Some(0) && complaint.is_empty(), "{command}: {complaint}");
        assert!(help.contains(&format!("\nUsage: {name} {command}")), "{help}");
        assert!(help.lines().all(|line| line.chars().count() <= 80), "{help}");
        for part in parts.split(' ') {
            assert!(help.contains(part), "no {part} in\n{help}");
        }
        assert_eq!(said(program, &format!("help {command}")).1, help);
    }
    assert_eq!(said(program, "--version").1, format!("{name} {}\n", env!("CARGO_PKG_VERSION")));
}

/// Demands that each line ends the program with code 2 and this complaint.
pub fn does_not_understand(program: &str, lines: &[(&str, &str)]) {
    for (line, complaint) in lines {
        let (code, out, err) = said(program, line);
        assert!(code == Some(2) && out.is_empty() && err.contains(complaint), "{line}: {code:?} {out} {err}");
    }
}
