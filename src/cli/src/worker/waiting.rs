//! How long a process has waited for a processor.

use raykata::worker::Thread;
use std::time::Duration;

/// The time for which a process was ready to compute but had no processor, because others used them: that of its thread that
/// waited longest, which is about the time that its other threads waited at the same time. It is 0 where this is not known.
pub(super) fn waited(process: u32) -> Duration {
    let Ok(threads) = std::fs::read_dir(format!("/proc/{process}/task")) else { return Duration::ZERO };
    threads.flatten().map(|thread| Thread::at(thread.path()).waited()).max().unwrap_or_default()
}
