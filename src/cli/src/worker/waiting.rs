//! How long a process has waited for a processor.

use raykata::worker::Thread;
use std::time::Duration;

/// The time for which a process was ready to compute but had no processor, because others used them: that of its thread that
/// waited longest, which is about the time that its other threads waited at the same time. It is 0 where this is not known.
pub(super) fn waited(process: u32) -> Duration {
    most(process, |thread| Some(thread.waited())).unwrap_or_default()
}

/// The longest of these times of the threads of a process; `None` where it is not known.
pub(super) fn most(process: u32, time: impl Fn(&Thread) -> Option<Duration>) -> Option<Duration> {
    let threads = std::fs::read_dir(format!("/proc/{process}/task")).ok()?;
    threads.flatten().filter_map(|thread| time(&Thread::at(thread.path()))).max()
}
