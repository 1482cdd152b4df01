//! Long runs that are killed continue where they were.

use super::author;
use super::program_runs::{leaves_out_what_takes_long, printed, root};
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

fn said(output: &Output) -> String {
    let (said, complained) = printed(output);
    format!("{said}{complained}")
}

fn started(arguments: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_author"));
    command.current_dir(root()).args(arguments).stdin(Stdio::null());
    command.stdout(Stdio::null()).stderr(Stdio::null()).spawn().expect("the program starts")
}

/// The students that are graded, with their grades.
fn graded(out: &Path) -> Vec<(String, String)> {
    let Ok(connection) = rusqlite::Connection::open(out.join("grades.sqlite")) else { return Vec::new() };
    let Ok(mut statement) = connection.prepare("SELECT student, json FROM graded ORDER BY student") else {
        return Vec::new();
    };
    statement.query_map([], |row| Ok((row.get(0)?, row.get(1)?))).unwrap().filter_map(Result::ok).collect()
}

/// Kills a run as soon as something is true.
fn kill_when(mut run: Child, is_time: impl Fn() -> bool) {
    let late = Instant::now() + Duration::from_secs(900);
    while !is_time() {
        assert!(run.try_wait().expect("its state").is_none(), "it ended before it was killed");
        assert!(Instant::now() < late, "the run makes no progress");
        std::thread::sleep(Duration::from_millis(5));
    }
    run.kill().expect("killed");
    run.wait().expect("ended");
}

/// A rehearsal takes minutes, so it is killed only with `CI_LONG=1`.
#[test]
fn a_rehearsal_that_is_killed_continues() {
    if leaves_out_what_takes_long() {
        return;
    }
    let out = tempfile::tempdir().unwrap();
    let folder = out.path().to_string_lossy().into_owned();
    let arguments = ["rehearse", "--honest", "--students", "9", "--jobs", "1", "--out", &folder];
    kill_when(started(&arguments), || graded(out.path()).len() >= 2);
    let before = graded(out.path());
    assert!(before.len() < 9);
    let again = author(&arguments);
    assert!(said(&again).contains("--resume"), "{}", said(&again));
    let output = author(&[&arguments[..], &["--resume"]].concat());
    assert!(said(&output).contains("0 of 9 grades are wrong"), "{}", said(&output));
    let after = graded(out.path());
    assert!(before.iter().all(|row| after.contains(row)), "nothing was graded twice");
}
