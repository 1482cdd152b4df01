//! Restricts this process and then replaces it by the program. The process has one thread and runs no code between a fork
//! and an exec, so safe code is enough.

use super::{Confinement, Purpose, ResourceLimits, files, filter};
use anyhow::{Context, Result, bail, ensure};
use nix::sys::prctl;
use nix::sys::resource::{Resource, setrlimit};
use nix::sys::signal::Signal;
use std::convert::Infallible;
use std::ffi::{OsStr, OsString};
use std::os::fd::RawFd;
use std::os::unix::process::CommandExt;
use std::path::PathBuf;
use std::process::Command;

/// Extra stack for the program's first frames and its arguments, in bytes. A worker outside of a sandbox answers on a
/// thread without these.
const STACK_ROOM: u64 = 8 << 20;

/// Seconds between the soft and the hard limit of processor time. The soft limit sends a specific signal. The hard limit
/// kills the process like a lack of memory does, so it must come later.
const CPU_GRACE_SECONDS: u64 = 2;

/// Becomes the program. It returns only if there is an error.
pub(super) fn launch(mut arguments: impl Iterator<Item = OsString>) -> Result<Infallible> {
    let asked = LaunchRequest::from(&mut arguments)?;
    close_inherited()?;
    // Make the kernel end this process together with the judge.
    prctl::set_pdeathsig(Signal::SIGKILL).context("the process cannot be made to end with its judge")?;
    // The judge may have ended before this took effect.
    ensure!(nix::unistd::getppid().as_raw() == asked.judge, "the judge has ended");
    // Set all restrictions, then become the program.
    restrict_resources(asked.purpose, &asked.limits)?;
    prctl::set_no_new_privs().context("privileges cannot be dropped")?;
    if asked.confinement == Confinement::Full {
        files::restrict(asked.purpose, &asked.program, &asked.readable, &asked.writable)?;
        filter::install(asked.purpose).context("system calls cannot be filtered")?;
    }
    let error = Command::new(&asked.program).args(arguments).exec();
    bail!("{} cannot be started: {error}", asked.program.display())
}

struct LaunchRequest {
    confinement: Confinement,
    purpose: Purpose,
    judge: i32,
    limits: ResourceLimits,
    readable: Vec<PathBuf>,
    writable: Vec<PathBuf>,
    program: PathBuf,
}

impl LaunchRequest {
    /// Parses the arguments that [`super::Sandbox::command`] writes.
    fn from(arguments: &mut impl Iterator<Item = OsString>) -> Result<LaunchRequest> {
        let mut next = || arguments.next().context("an argument is missing");
        let confinement = Confinement::of_word(&next()?).context("unknown confinement")?;
        let purpose = Purpose::of_word(&next()?).context("unknown purpose")?;
        let judge = number(&next()?)? as i32;
        let limits = ResourceLimits {
            cpu_seconds: number(&next()?)?,
            memory_bytes: number(&next()?)?,
            file_bytes: number(&next()?)?,
            open_files: number(&next()?)?,
            processes: number(&next()?)?,
        };
        let mut paths = || -> Result<Vec<PathBuf>> {
            let count = number(&next()?)?;
            (0..count).map(|_| Ok(PathBuf::from(next()?))).collect()
        };
        let (readable, writable) = (paths()?, paths()?);
        ensure!(writable.is_empty() || purpose.writes(), "a {} must not write", purpose.word());
        Ok(LaunchRequest { confinement, purpose, judge, limits, readable, writable, program: next()?.into() })
    }
}

fn number(word: &OsStr) -> Result<u64> {
    let word = word.to_str().context("not a number")?;
    word.parse().with_context(|| format!("{word} is not a number"))
}

/// Closes all open files of the judge and its parents, except the standard streams.
fn close_inherited() -> Result<()> {
    let open = std::fs::read_dir("/proc/self/fd").context("open files cannot be listed (is /proc there?)")?;
    let open: Vec<RawFd> = open
        .map(|entry| entry.ok()?.file_name().to_str()?.parse().ok())
        .collect::<Option<_>>()
        .context("open files cannot be listed")?;
    for descriptor in open.into_iter().filter(|descriptor| *descriptor > 2) {
        match nix::unistd::close(descriptor) {
            // This is the listing itself, which is already closed.
            Ok(()) | Err(nix::errno::Errno::EBADF) => {}
            Err(error) => bail!("an open file cannot be closed: {error}"),
        }
    }
    Ok(())
}

fn restrict_resources(purpose: Purpose, limits: &ResourceLimits) -> Result<()> {
    let stack = match purpose {
        // These answer on their first thread, because they may start no other.
        Purpose::Worker | Purpose::Reader => raykata::worker::STACK_BYTES as u64 + STACK_ROOM,
        // The usual size. The threads of a compiler set their own stack sizes.
        Purpose::Compiler | Purpose::Linker => 8 << 20,
    };
    let cpu = limits.cpu_seconds;
    for (resource, soft, hard) in [
        (Resource::RLIMIT_CPU, cpu, cpu.saturating_add(CPU_GRACE_SECONDS)),
        (Resource::RLIMIT_AS, limits.memory_bytes, limits.memory_bytes),
        (Resource::RLIMIT_FSIZE, limits.file_bytes, limits.file_bytes),
        (Resource::RLIMIT_NOFILE, limits.open_files, limits.open_files),
        (Resource::RLIMIT_NPROC, limits.processes, limits.processes),
        (Resource::RLIMIT_STACK, stack, stack),
        // Write no core dumps.
        (Resource::RLIMIT_CORE, 0, 0),
    ] {
        // If the machine has a lower limit, keep it.
        let (_, most) = nix::sys::resource::getrlimit(resource).context("limits cannot be read")?;
        setrlimit(resource, soft.min(most), hard.min(most))
            .with_context(|| format!("the limit {resource:?} cannot be set to {soft}"))?;
    }
    Ok(())
}
