//! Runs a command to its end, even if it does not end by itself.

use super::{Ended, How, processes};
use crate::queue::lock;
use nix::errno::Errno;
use nix::sys::prctl;
use nix::sys::wait::{Id, WaitPidFlag, WaitStatus, waitid};
use nix::unistd::Pid;
use std::io::{self, Read, Write};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Mutex, OnceLock};
use std::time::{Duration, Instant};

/// First pause between two looks at a process. It is short, because some processes need only a millisecond.
const FIRST_PAUSE: Duration = Duration::from_micros(200);
const LONGEST_PAUSE: Duration = Duration::from_millis(5);

/// Most processes of a command. A linker needs four. The kernel's own limit does not apply to root.
const MOST_PROCESSES: usize = 32;

/// The time between two counts of the processes. One count takes about a millisecond.
const COUNT_EVERY: Duration = Duration::from_millis(50);

/// Runs a command to its end. Writes `stdin` to it and keeps up to `cap` bytes of its standard output and of its standard
/// error. Ends the command if it writes more, or after `patience`. No process of it is left running.
pub fn run(mut command: Command, stdin: &[u8], patience: Duration, cap: usize) -> io::Result<Ended> {
    guard_this_process()?;
    let cpu_limit = cpu_limit(&command);
    // Start a new process group, which sandboxed programs cannot leave. All children are found by this group.
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).process_group(0);
    let mut child = spawn(command)?;
    let (to_it, stdout, stderr) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
    let flooded = AtomicBool::new(false);
    std::thread::scope(|scope| {
        // Ignore errors: the program need not read its input.
        scope.spawn(move || to_it.map(|mut pipe| pipe.write_all(stdin)));
        let stdout = scope.spawn(|| keep(stdout, cap, &flooded));
        let stderr = scope.spawn(|| keep(stderr, cap, &flooded));
        // Wait for the end of the process, or for a reason to end it.
        let verdict = wait(&child, patience, &flooded);
        // End the processes even after an error, because otherwise the threads above never end.
        let ended = end(&mut child);
        let (stdout, stderr) = (stdout.join().unwrap_or_default(), stderr.join().unwrap_or_default());
        let (status, cpu) = ended?;
        let how = match verdict? {
            Some(how) => how,
            None if flooded.load(Ordering::Relaxed) => How::WroteTooMuch,
            None => how_it_ended(status, cpu, cpu_limit),
        };
        Ok(Ended { how, stdout, stderr, cpu })
    })
}

/// Starts a sandboxed command. The caller must end it.
pub fn spawn_guarded(mut command: Command) -> io::Result<Child> {
    guard_this_process()?;
    command.process_group(0);
    spawn(command)
}

/// Starts a command on a thread that lasts as long as the program, because a sandboxed process ends with the thread that
/// started it.
fn spawn(command: Command) -> io::Result<Child> {
    type Order = (Command, Sender<io::Result<Child>>);
    static SPAWNER: OnceLock<io::Result<Mutex<Sender<Order>>>> = OnceLock::new();
    let spawner = SPAWNER.get_or_init(|| {
        let (orders, inbox) = channel::<Order>();
        std::thread::Builder::new().name("spawner".into()).spawn(move || {
            for (mut command, answer) in inbox {
                let child = command.spawn();
                // Close this process's copies of the child's pipes.
                drop(command);
                let _ = answer.send(child);
            }
        })?;
        Ok(Mutex::new(orders))
    });
    let gone = || io::Error::other("the thread that starts processes is gone");
    let spawner = spawner.as_ref().map_err(|error| io::Error::new(error.kind(), error.to_string()))?;
    let (answer, answered) = channel();
    lock(spawner).send((command, answer)).map_err(|_| gone())?;
    answered.recv().map_err(|_| gone())?
}

/// Makes this process the reaper of its orphaned descendants, and its memory unreadable for others.
fn guard_this_process() -> io::Result<()> {
    static GUARDED: OnceLock<nix::Result<()>> = OnceLock::new();
    let guarded =
        GUARDED.get_or_init(|| prctl::set_child_subreaper(true).and_then(|()| prctl::set_dumpable(false)));
    guarded.map_err(io::Error::from)
}

/// Returns the limit of processor time in the arguments of a launcher.
fn cpu_limit(command: &Command) -> Option<Duration> {
    let mut arguments = command.get_args();
    if arguments.next()? != super::LAUNCH {
        return None;
    }
    // The number of the judge comes first.
    let (_, _, limits, ..): super::Restrictions = serde_json::from_str(arguments.nth(1)?.to_str()?).ok()?;
    Some(Duration::from_secs(limits.cpu_seconds))
}

/// Reads to the end, or up to `cap` bytes.
fn keep(pipe: Option<impl Read>, cap: usize, flooded: &AtomicBool) -> Vec<u8> {
    let mut kept = Vec::new();
    if let Some(pipe) = pipe {
        let _ = pipe.take(cap as u64 + 1).read_to_end(&mut kept);
    }
    if kept.len() > cap {
        kept.truncate(cap);
        flooded.store(true, Ordering::Relaxed);
    }
    kept
}

/// Waits until a process has ended by itself (`None`) or must be ended for the returned reason.
fn wait(child: &Child, patience: Duration, flooded: &AtomicBool) -> io::Result<Option<How>> {
    let started = Instant::now();
    let (mut pause, mut counted) = (FIRST_PAUSE, started);
    while !has_ended(child, WaitPidFlag::WNOHANG)? {
        if flooded.load(Ordering::Relaxed) {
            return Ok(Some(How::WroteTooMuch));
        }
        if started.elapsed() > patience {
            return Ok(Some(How::TookTooLong));
        }
        if counted.elapsed() > COUNT_EVERY {
            if processes::count(child.id()) > MOST_PROCESSES {
                return Ok(Some(How::TooManyProcesses));
            }
            counted = Instant::now();
        }
        std::thread::sleep(pause);
        pause = (pause * 2).min(LONGEST_PAUSE);
    }
    Ok(None)
}

/// Returns whether a process has ended, without reaping it, so that its id is not reused.
fn has_ended(child: &Child, flag: WaitPidFlag) -> io::Result<bool> {
    let child = Pid::from_raw(child.id() as i32);
    loop {
        return match waitid(Id::Pid(child), WaitPidFlag::WEXITED | WaitPidFlag::WNOWAIT | flag) {
            Ok(status) => Ok(status != WaitStatus::StillAlive),
            Err(Errno::EINTR) => continue,
            Err(error) => Err(error.into()),
        };
    }
}

/// Ends a process and all processes that it has started.
fn end(child: &mut Child) -> io::Result<(ExitStatus, Duration)> {
    // Kill the leader and wait for its end, but do not reap it, so that its id stays that of the group.
    child.kill()?;
    has_ended(child, WaitPidFlag::empty())?;
    let cpu = processes::cpu_time(child.id()).unwrap_or_default();
    // End the rest of the group, then reap the leader.
    let group_ended = processes::end_group(child.id());
    let status = child.wait()?;
    group_ended?;
    Ok((status, cpu))
}

fn how_it_ended(status: ExitStatus, cpu: Duration, cpu_limit: Option<Duration>) -> How {
    use nix::libc::{SIGKILL, SIGXCPU};
    match (status.code(), status.signal()) {
        (Some(code), _) => How::Exited(code),
        (_, Some(SIGXCPU)) => How::UsedUpCpu,
        (_, Some(SIGKILL)) if cpu_limit.is_some_and(|limit| cpu >= limit) => How::UsedUpCpu,
        (_, signal) => How::Signalled(signal.unwrap_or_default()),
    }
}
