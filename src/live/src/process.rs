//! A process that can be ended at any time, with all processes that it has started.

use anyhow::{Context, Result};
use std::io::{BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

/// The process that a run has started at the moment, if any. A run starts one process after the other.
#[derive(Default)]
pub struct Process {
    is_over: AtomicBool,
    child: Mutex<Option<Child>>,
}

/// Ends a process and those that it has started.
#[cfg(unix)]
fn end(child: &mut Child) {
    use nix::sys::signal::{Signal, killpg};
    use nix::unistd::Pid;
    if let Ok(id) = i32::try_from(child.id()) {
        let _ = killpg(Pid::from_raw(id), Signal::SIGKILL);
    }
    let _ = child.wait();
}

#[cfg(not(unix))]
fn end(child: &mut Child) {
    let _ = child.kill();
    let _ = child.wait();
}

impl Process {
    /// Ends the process, and starts no other one from now on.
    pub fn end(&self) {
        self.is_over.store(true, Ordering::Relaxed);
        if let Some(child) = &mut *self.child() {
            end(child);
        }
    }

    /// Whether the run is over.
    pub fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }

    fn child(&self) -> std::sync::MutexGuard<'_, Option<Child>> {
        self.child.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Starts a process, reads what it writes, and returns whether it succeeded and what it wrote to standard error.
    /// `Ok(None)` if the run is over.
    ///
    /// # Errors
    ///
    /// If the process cannot be started, or if `read` fails.
    pub fn follow(
        &self,
        mut command: Command,
        read: impl FnOnce(&mut BufReader<std::process::ChildStdout>) -> Result<()>,
    ) -> Result<Option<(bool, String)>> {
        // Give the process a group of its own, so that `end` reaches those that it starts.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        // Start it under the lock, so that a cancel before this sees no child and prevents it, and one after this ends it.
        let mut slot = self.child();
        if self.is_over.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let name = command.get_program().to_string_lossy().into_owned();
        let child = command.spawn().with_context(|| format!("{name} cannot be started"))?;
        let child = slot.insert(child);
        let stdout = child.stdout.take().context("no standard output")?;
        let mut stderr = child.stderr.take().context("no standard error")?;
        drop(slot);
        let words = std::thread::spawn(move || {
            let mut bytes = Vec::new();
            let _ = stderr.read_to_end(&mut bytes);
            String::from_utf8_lossy(&bytes).into_owned()
        });
        let result = read(&mut BufReader::new(stdout));
        let words = words.join().unwrap_or_default();
        let Some(mut child) = self.child().take().filter(|_| !self.is_over.load(Ordering::Relaxed)) else {
            return Ok(None);
        };
        let succeeded = child.wait()?.success();
        result?;
        Ok(Some((succeeded, words)))
    }

    /// The same for a process whose standard output is of no interest.
    ///
    /// # Errors
    ///
    /// If the process cannot be started.
    pub fn follow_silently(&self, command: Command) -> Result<Option<(bool, String)>> {
        self.follow(command, |out| Ok(_ = std::io::copy(out, &mut std::io::sink())?))
    }
}
