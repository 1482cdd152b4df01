//! A process that can be ended at any time, with all processes that it has started.

use anyhow::{Context, Result};
use raykata::kit::Door;
use raykata_cli::queue::lock;
use raykata_cli::worker::Worker;
use std::io::{BufReader, Read};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// The process that a run has started at the moment, if any, and its kit. A run starts one process after the other.
#[derive(Default)]
pub struct Process {
    is_over: AtomicBool,
    child: Mutex<Option<Child>>,
    kit: Mutex<Option<Arc<Door<Worker>>>>,
}

/// Ends a process and those that it has started.
fn end(child: &mut Child) {
    #[cfg(unix)]
    if let Ok(id) = i32::try_from(child.id()) {
        use nix::sys::signal::{Signal, killpg};
        let _ = killpg(nix::unistd::Pid::from_raw(id), Signal::SIGKILL);
    }
    #[cfg(not(unix))]
    let _ = child.kill();
    let _ = child.wait();
}

impl Process {
    /// Ends the process, and starts no other one from now on.
    pub fn end(&self) {
        self.is_over.store(true, Ordering::Relaxed);
        if let Some(child) = &mut *lock(&self.child) {
            end(child);
        }
        if let Some(kit) = lock(&self.kit).take() {
            kit.0.retire();
        }
    }

    /// Starts a kit, whose process ends with the run.
    pub fn start_kit(&self, worker: Worker) -> Arc<Door<Worker>> {
        let kit = Arc::new(Door(worker));
        *lock(&self.kit) = Some(kit.clone());
        // The flag is set before `end` looks for a kit.
        if self.is_over() {
            kit.0.retire();
        }
        kit
    }

    /// Whether the run is over.
    pub fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }

    /// Starts a process, reads what it writes, and returns whether it succeeded and what it wrote to standard error.
    /// `Ok(None)` if the run is over.
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
        let mut slot = lock(&self.child);
        if self.is_over() {
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
        let Some(mut child) = lock(&self.child).take().filter(|_| !self.is_over()) else { return Ok(None) };
        let succeeded = child.wait()?.success();
        result?;
        Ok(Some((succeeded, words)))
    }
}
