//! What became of a worker that no longer answers.

use super::{Death, Launcher, lock};
use raykata::kit::KitError;
use std::io::{self, Read};
use std::process::{Child, ExitStatus};
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// How much of what a worker writes to standard error is kept.
const KEPT_STDERR: u64 = 64 * 1024;

/// How much of a message of student code is passed on: it goes into reports.
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

/// `launcher` is what started it, if nobody trusts it.
pub(super) fn cause_of_death(
    status: Option<ExitStatus>,
    stderr: &str,
    launcher: Option<&dyn Launcher>,
    patience: Duration,
) -> KitError {
    let crashed = |how: &str| KitError::Crashed { how: how.into() };
    if stderr.contains("has overflowed its stack") {
        return crashed("the stack overflowed: a recursion that never ends?");
    }
    let Some(status) = status else { return crashed("for an unknown reason") };
    match launcher.and_then(|launcher| launcher.death(status, stderr)) {
        Some(Death::TimedOut) => return KitError::TimedOut { seconds: patience.as_secs() },
        Some(Death::Crashed(how)) => return KitError::Crashed { how },
        None => {}
    }
    match last_words(stderr) {
        Some(last) => crashed(&format!("{status}; its last words: {last}")),
        None => crashed(&status.to_string()),
    }
}

/// The last line that is not empty, with no more letters than a message has room for.
pub fn last_words(stderr: &str) -> Option<String> {
    let last = stderr.lines().rev().find(|line| !line.trim().is_empty())?;
    Some(last.chars().take(160).collect())
}

/// With no more words than anybody reads.
pub(super) fn shortened(error: KitError) -> KitError {
    let short = |words: String| match words.char_indices().nth(KEPT_WORDS) {
        Some((end, _)) => format!("{} …", &words[..end]),
        None => words,
    };
    match error {
        KitError::NotWritten { task, place } => {
            KitError::NotWritten { task: short(task), place: short(place) }
        }
        KitError::Panicked { message, place } => {
            KitError::Panicked { message: short(message), place: short(place) }
        }
        KitError::Crashed { how } => KitError::Crashed { how: short(how) },
        KitError::Malformed { what } => KitError::Malformed { what: short(what) },
        KitError::TimedOut { seconds } => KitError::TimedOut { seconds },
    }
}

/// Reads to the end and keeps the beginning.
pub(super) fn keep_start(mut stderr: impl Read) -> String {
    let mut kept = Vec::new();
    let _ = stderr.by_ref().take(KEPT_STDERR).read_to_end(&mut kept);
    let _ = io::copy(&mut stderr, &mut io::sink());
    String::from_utf8_lossy(&kept).into_owned()
}
