//! A check as a test in a process of its own, whose output is not shown, except what one call prints.

use crate::broken::with_output;
use crate::trial::{Check, Verdict, verdict};
use raykata::kit::{KitError, kit_error};
use std::io::{self, BufRead, BufReader};
use std::process::Command;

/// Set in a process that runs one check for another process.
const ALONE: &str = "RAYKATA_CHECK_ALONE";

/// The line before and after what is shown.
const MARK: &str = "---- raykata: shown ----";

/// The longest text that is shown, in bytes.
const LONGEST: usize = 1 << 16;

/// Whether this process runs one check for another process.
pub(crate) fn is_alone() -> bool {
    std::env::var_os(ALONE).is_some()
}

/// Marks what `work` prints as shown. A panic of the code was part of the check.
pub(crate) fn show(work: impl FnOnce()) {
    println!("\n{MARK}");
    let _ = kit_error::catch(work);
    println!("\n{MARK}");
}

/// The message of the test of this check, which runs in another process; `None` if it passes.
pub(crate) fn message_of(check: &Check, path: &str) -> Option<String> {
    let (passed, shown) = shown(path).unwrap_or_else(|error| (false, vec![error.to_string()]));
    match &shown[..] {
        [_, _, _] if passed => None,
        [_, printed, _, message, _] => Some(with_output(message, printed)),
        // The process has ended before there was a message.
        others => match verdict(check, Err(KitError::Crashed { how: others.concat() })) {
            Verdict::Failed(message) => Some(message),
            _ => None,
        },
    }
}

/// Whether the test passes, and the output of the process, divided at the marks. Between shown parts it has only its last line.
/// If the test passes, nothing is shown after what the call prints.
fn shown(path: &str) -> io::Result<(bool, Vec<String>)> {
    // The path begins with the name of the crate.
    let (_, name) = path.split_once("::").unwrap_or_default();
    let (output, to_output) = io::pipe()?;
    let mut command = Command::new(std::env::current_exe()?);
    command
        .args([name, "--exact", "--nocapture"])
        .env(ALONE, "1")
        .stdout(to_output.try_clone()?)
        .stderr(to_output);
    let mut child = command.spawn()?;
    // The command holds its end of the pipe.
    drop(command);
    let mut parts = vec![String::new()];
    for line in BufReader::new(output).split(b'\n') {
        let line = String::from_utf8_lossy(&line?).into_owned();
        let is_shown = parts.len() % 2 == 0;
        match parts.last_mut() {
            _ if line == MARK => parts.push(String::new()),
            Some(part) if is_shown && part.len() < LONGEST => *part += &format!("{line}\n"),
            Some(part) if !is_shown && !line.trim().is_empty() => *part = line,
            _ => {}
        }
    }
    Ok((child.wait()?.success(), parts))
}
