//! What became of a worker that no longer answers.

use super::lock;
use crate::jail::{NOT_LAUNCHED, NOT_LAUNCHED_BECAUSE, how_it_died};
use raykata::kit::Mishap;
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

/// `memory` is how much it was given, if it was in a jail.
pub(super) fn cause_of_death(
    status: Option<ExitStatus>,
    stderr: &str,
    memory: Option<u64>,
    patience: Duration,
) -> Mishap {
    let crashed = |how: &str| Mishap::Crashed { how: how.into() };
    if stderr.contains("has overflowed its stack") {
        return crashed("the stack overflowed: a recursion that never ends?");
    }
    let Some(status) = status else { return crashed("for an unknown reason") };
    if let Some(memory) = memory {
        if status.code() == Some(NOT_LAUNCHED) && stderr.starts_with(NOT_LAUNCHED_BECAUSE) {
            return crashed(&format!("it cannot be started: {}", last_words(stderr).unwrap_or_default()));
        }
        match how_it_died(status, stderr) {
            Some(Jailed::Time) => return Mishap::TimedOut { seconds: patience.as_secs() },
            Some(Jailed::Memory) => {
                return crashed(&format!("it took more memory than the {} it was given", size(memory)));
            }
            Some(Jailed::Other(how)) => return crashed(how),
            None => {}
        }
    }
    match last_words(stderr) {
        Some(last) => crashed(&format!("{status}; its last words: {last}")),
        None => crashed(&status.to_string()),
    }
}

/// What ended a process in a jail.
pub enum Jailed {
    /// It has used up its processor time.
    Time,
    /// It has used up its memory.
    Memory,
    /// What this says.
    Other(&'static str),
}

fn size(bytes: u64) -> String {
    if bytes.is_multiple_of(1 << 30) {
        format!("{} GiB", bytes >> 30)
    } else {
        format!("{} MiB", bytes >> 20)
    }
}

fn last_words(stderr: &str) -> Option<String> {
    let last = stderr.lines().rev().find(|line| !line.trim().is_empty())?;
    Some(last.chars().take(160).collect())
}

/// With no more words than anybody reads.
pub(super) fn shortened(mishap: Mishap) -> Mishap {
    let short = |words: String| match words.char_indices().nth(KEPT_WORDS) {
        Some((end, _)) => format!("{} …", &words[..end]),
        None => words,
    };
    match mishap {
        Mishap::NotWritten { task, place } => Mishap::NotWritten { task: short(task), place: short(place) },
        Mishap::Panicked { message, place } => {
            Mishap::Panicked { message: short(message), place: short(place) }
        }
        Mishap::Crashed { how } => Mishap::Crashed { how: short(how) },
        Mishap::Nonsense { what } => Mishap::Nonsense { what: short(what) },
        Mishap::TimedOut { seconds } => Mishap::TimedOut { seconds },
    }
}

/// Reads to the end and keeps the beginning.
pub(super) fn keep_start(mut stderr: impl Read) -> String {
    let mut kept = Vec::new();
    let _ = stderr.by_ref().take(KEPT_STDERR).read_to_end(&mut kept);
    let _ = io::copy(&mut stderr, &mut io::sink());
    String::from_utf8_lossy(&kept).into_owned()
}
