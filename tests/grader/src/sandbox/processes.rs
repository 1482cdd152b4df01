//! Reads the kernel's data about processes, and ends processes that a program has left behind.

use nix::errno::Errno;
use nix::sys::signal::{Signal, kill};
use nix::sys::wait::waitpid;
use nix::unistd::{Pid, SysconfVar, sysconf};
use std::io;
use std::time::{Duration, Instant};

/// Time limit for the end of killed processes. They usually end at once.
const END_PATIENCE: Duration = Duration::from_secs(10);

struct Status {
    parent: i32,
    group: i32,
    cpu: Duration,
}

fn status(process: i32) -> Option<Status> {
    let line = std::fs::read(format!("/proc/{process}/stat")).ok()?;
    // The name in parentheses may contain any characters, so parse only the part after it.
    let after_name = line.iter().rposition(|byte| *byte == b')')? + 2;
    let fields: Vec<&str> = std::str::from_utf8(line.get(after_name..)?).ok()?.split(' ').collect();
    let number = |index: usize| fields.get(index)?.parse::<u64>().ok();
    // Times in user and kernel mode, of the process and of the children that it has waited for.
    let ticks = number(11)? + number(12)? + number(13)? + number(14)?;
    let ticks_per_second = sysconf(SysconfVar::CLK_TCK).ok()??.max(1) as f64;
    Some(Status {
        parent: number(1)? as i32,
        group: number(2)? as i32,
        cpu: Duration::from_secs_f64(ticks as f64 / ticks_per_second),
    })
}

/// Returns the processor time of a process. The process may have ended if it was not yet waited for.
pub fn cpu_time(process: u32) -> Option<Duration> {
    Some(status(process as i32)?.cpu)
}

/// Returns the processes of a group except its leader, with their parents.
fn members(group: i32) -> io::Result<Vec<(i32, i32)>> {
    let mut members = Vec::new();
    for entry in std::fs::read_dir("/proc")? {
        let Some(process) = entry?.file_name().to_str().and_then(|name| name.parse().ok()) else { continue };
        if process == group {
            continue;
        }
        if let Some(status) = status(process)
            && status.group == group
        {
            members.push((process, status.parent));
        }
    }
    Ok(members)
}

/// Returns the number of processes in a group, except its leader.
pub fn count(group: u32) -> usize {
    members(group as i32).map_or(0, |members| members.len())
}

/// Ends the remaining processes of a group and waits for them. The leader must have ended and must not have been waited
/// for.
///
/// This process is the reaper of orphans, so the topmost remaining processes are its children. The kernel does not reuse
/// the id of a child before it was waited for. The children of an ended process then become children of this process.
pub fn end_group(leader: u32) -> io::Result<()> {
    let until = Instant::now() + END_PATIENCE;
    let myself = std::process::id() as i32;
    loop {
        let members = members(leader as i32)?;
        if members.is_empty() {
            return Ok(());
        }
        if Instant::now() > until {
            return Err(io::Error::other("processes of a submission do not end"));
        }
        for (process, _) in members.into_iter().filter(|(_, parent)| *parent == myself) {
            let process = Pid::from_raw(process);
            match kill(process, Signal::SIGKILL) {
                Ok(()) | Err(Errno::ESRCH) => {}
                Err(error) => return Err(error.into()),
            }
            while waitpid(process, None) == Err(Errno::EINTR) {}
        }
    }
}
