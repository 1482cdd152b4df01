//! Finds out why a worker does not answer any more.

use super::launcher::{Death, Launcher};
use crate::queue::lock;
use raykata::kit::KitError;
use std::io::{self, Read};
use std::process::{Child, ExitStatus};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// The number of bytes of a worker's standard error that are kept.
const KEPT_STDERR: u64 = 64 * 1024;

/// The number of characters of a student's message that are passed on to reports.
const KEPT_WORDS: usize = 2000;

pub(super) fn wait_briefly(child: &Mutex<Child>) -> Option<ExitStatus> {
    let until = Instant::now() + Duration::from_millis(500);
    while Instant::now() < until {
        if let Ok(Some(status)) = lock(child).try_wait() {
            return Some(status);
        }
        std::thread::yield_now();
    }
    None
}

/// The reason why the process ended. `launcher` has started it if its code is untrusted.
pub(super) fn cause_of_death(
    status: Option<ExitStatus>,
    stderr: &str,
    launcher: Option<&dyn Launcher>,
    patience: Duration,
) -> KitError {
    let crashed = |how: &str| KitError::Crashed { how: how.into() };
    if stderr.contains("has overflowed its stack") {
        return crashed("the stack overflowed: is there an infinite recursion?");
    }
    let Some(status) = status else { return crashed("for an unknown reason") };
    match launcher.and_then(|launcher| launcher.death(status, stderr)) {
        Some(Death::TimedOut) => return KitError::TimedOut { seconds: patience.as_secs() },
        Some(Death::Crashed(how)) => return KitError::Crashed { how },
        None => {}
    }
    match last_words(stderr) {
        Some(last) => crashed(&format!("{status}; its last line on standard error: {last}")),
        None => crashed(&status.to_string()),
    }
}

/// The last line that says something, shortened to the length of a message. Below the reason of an abort the standard library
/// prints a backtrace, whose lines are indented, and notes about it.
pub fn last_words(stderr: &str) -> Option<String> {
    let is_about_backtrace = |line: &&str| {
        line.starts_with([' ', '\t']) || line.starts_with("note: ") || *line == "stack backtrace:"
    };
    let mut lines = stderr.lines().rev().filter(|line| !line.trim().is_empty());
    let last = lines.clone().find(|line| !is_about_backtrace(line)).or_else(|| lines.next())?;
    Some(last.chars().take(160).collect())
}

/// The error with its texts shortened.
pub(super) fn shortened(error: KitError) -> KitError {
    let short = |words: String| match words.char_indices().nth(KEPT_WORDS) {
        Some((end, _)) => format!("{} …", &words[..end]),
        None => words,
    };
    match error {
        KitError::NotWritten { task, place, function } => {
            KitError::NotWritten { task: short(task), place: short(place), function }
        }
        KitError::Panicked { message, place } => {
            KitError::Panicked { message: short(message), place: short(place) }
        }
        KitError::Crashed { how } => KitError::Crashed { how: short(how) },
        KitError::Malformed { what } => KitError::Malformed { what: short(what) },
        late @ (KitError::TimedOut { .. } | KitError::Waited { .. }) => late,
    }
}

/// Reads to the end and keeps the beginning.
pub(super) fn keep_start(mut stderr: impl Read) -> String {
    let mut kept = Vec::new();
    let _ = stderr.by_ref().take(KEPT_STDERR).read_to_end(&mut kept);
    let _ = io::copy(&mut stderr, &mut io::sink());
    String::from_utf8_lossy(&kept).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_words_are_no_part_of_a_backtrace() {
        let abort = "memory allocation of 9 bytes failed\nstack backtrace:\n   0: f\n\nnote: Some details are omitted\n";
        assert_eq!(last_words(abort).as_deref(), Some("memory allocation of 9 bytes failed"));
        assert_eq!(last_words("  indented\n\n").as_deref(), Some("  indented"));
    }
}
