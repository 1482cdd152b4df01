//! Runs the program.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output};
use std::time::{Duration, Instant};

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

/// Waits until `is_time`, and kills the process then.
pub fn kill_when(run: &mut Child, is_time: impl Fn() -> bool) {
    let late = Instant::now() + Duration::from_secs(300);
    while !is_time() {
        assert!(run.try_wait().expect("its state").is_none(), "it ended before it was killed");
        assert!(Instant::now() < late, "it is not time to kill it");
        std::thread::sleep(Duration::from_millis(2));
    }
    run.kill().expect("killed");
    run.wait().expect("ended");
}

/// Checks that `said` contains each of these texts.
#[track_caller]
pub fn has_lines(said: &str, lines: &[&str]) {
    for line in lines {
        assert!(said.contains(line), "no `{line}` in\n{said}");
    }
}

/// Checks that a command line is understood, and that its scenes exist. `place` is where it stands.
#[track_caller]
pub fn is_understood(place: &str, line: &str) {
    // `--help` prints the help in place of the work, after all words before it were understood.
    let output = raykata(&format!("{line} --help"));
    assert!(output.status.success(), "{place}: {line}: {}", printed(&output).1);
    for scene in line.split_whitespace().filter(|word| word.starts_with("scenes/")) {
        assert!(root().join(scene).is_file(), "{place}: there is no {scene}");
    }
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
