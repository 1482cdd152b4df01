//! The processor time of another process, as the operating system counts it. What the process itself says does not matter.

#[cfg(target_os = "linux")]
use raykata::worker::Thread;
use std::time::Duration;

/// The time that the threads of a process have spent on a processor; `None` where this is not available.
///
/// On Linux it is the sum of `/proc/PID/task/*/schedstat`, which counts nanoseconds, but only of threads that still run. So
/// that a thread that has ended does not make a process faster, the sum is not below the time in `/proc/PID/stat`, which
/// includes these threads and counts hundredths of a second.
#[cfg(target_os = "linux")]
pub fn processor_time(process: u32) -> Option<Duration> {
    let mut exact = Duration::ZERO;
    for task in std::fs::read_dir(format!("/proc/{process}/task")).ok()?.flatten() {
        // A thread may end while it is read.
        exact += Thread::at(task.path()).ran().unwrap_or_default();
    }
    let coarse = ticks(&std::fs::read_to_string(format!("/proc/{process}/stat")).ok()?)?;
    // Two numbers are rounded down in `stat`, and read a moment later.
    let at_least = (10 * Duration::from_millis(coarse)).saturating_sub(Duration::from_millis(20));
    Some(exact.max(at_least)).filter(|time| !time.is_zero())
}

/// User time and system time in the text of a file `stat`, in hundredths of a second.
#[cfg(target_os = "linux")]
fn ticks(stat: &str) -> Option<u64> {
    // The name of the program stands in parentheses and may contain spaces and parentheses.
    let (_, rest) = stat.rsplit_once(')')?;
    let mut fields = rest.split_whitespace().skip(11);
    let mut next = || fields.next()?.parse::<u64>().ok();
    Some(next()? + next()?)
}

/// The time that the threads of a process have spent on a processor; `None` where this is not available.
#[cfg(not(target_os = "linux"))]
pub fn processor_time(_: u32) -> Option<Duration> {
    None
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn files_of_the_kernel_are_read() {
        let stat = "7 (a) b (c) S 1 7 7 0 -1 4194560 182 0 0 0 31 11 0 0 20 0 1 0 433 1 2";
        assert_eq!(ticks(stat), Some(42));
        assert_eq!(ticks("7 (a"), None);
    }

    #[test]
    fn a_process_that_does_not_exist_has_no_time() {
        assert_eq!(processor_time(u32::MAX), None);
        assert!(processor_time(std::process::id()).is_some());
    }
}
