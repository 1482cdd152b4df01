//! What the kernel says about processes, and ending those that a program has left behind.

use nix::errno::Errno;
use nix::sys::signal::{Signal, kill};
use nix::sys::wait::waitpid;
use nix::unistd::{Pid, SysconfVar, sysconf};
use std::io;
use std::time::{Duration, Instant};

/// How long the end of killed processes may take: they end at once unless the machine is in trouble.
const END_PATIENCE: Duration = Duration::from_secs(10);

struct Status {
    parent: i32,
    group: i32,
    cpu: Duration,
}

fn status(process: i32) -> Option<Status> {
    let line = std::fs::read(format!("/proc/{process}/stat")).ok()?;
    // The name, in parentheses, may hold anything; what follows does not.
    let after_name = line.iter().rposition(|byte| *byte == b')')? + 2;
    let fields: Vec<&str> = std::str::from_utf8(line.get(after_name..)?).ok()?.split(' ').collect();
    let number = |index: usize| fields.get(index)?.parse::<u64>().ok();
    // Of the process and of the children it has waited for, in the kernel and outside.
    let ticks = number(11)? + number(12)? + number(13)? + number(14)?;
    let ticks_per_second = sysconf(SysconfVar::CLK_TCK).ok()??.max(1) as f64;
    Some(Status {
        parent: number(1)? as i32,
        group: number(2)? as i32,
        cpu: Duration::from_secs_f64(ticks as f64 / ticks_per_second),
    })
}

/// The processor time that a process has used, also one that has ended and was not yet waited for.
pub fn cpu_time(process: u32) -> Option<Duration> {
    Some(status(process as i32)?.cpu)
}

/// The processes of a group besides its leader, with their parents.
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

/// How many processes there are in a group besides its leader.
pub fn count(group: u32) -> usize {
    members(group as i32).map_or(0, |members| members.len())
}

/// Ends what is left of a group whose leader has ended and was not yet waited for, and waits for it.
///
/// We are the reaper of orphans, so the top of what is left are children of ours: until we have waited for one, its
/// number belongs to it and to nobody else. Their own children come to us in turn.
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
