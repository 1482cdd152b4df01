//! Restricts this process and then replaces it by the program. The process has one thread and runs no code between a fork
//! and an exec, so safe code is enough.

use super::{Confinement, Purpose, ResourceLimits, Restrictions, files, filter};
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

/// Becomes the program. It gets the arguments that [`super::Sandbox::command`] writes, and returns only if there is an error.
pub(super) fn launch(mut arguments: impl Iterator<Item = OsString>) -> Result<Infallible> {
    let mut next = || arguments.next().context("an argument is missing");
    let judge: i32 = text(&next()?)?.parse().context("the judge has no number")?;
    let (purpose, confinement, limits, n_readable, n_writable): Restrictions =
        serde_json::from_str(text(&next()?)?).context("unknown restrictions")?;
    let mut paths = |n| (0..n).map(|_| Ok(PathBuf::from(next()?))).collect::<Result<Vec<_>>>();
    let (readable, writable, program) = (paths(n_readable)?, paths(n_writable)?, paths(1)?.remove(0));
    let who = format!("{purpose:?}").to_lowercase();
    ensure!(writable.is_empty() || purpose.writes(), "a {who} must not write");
    close_inherited()?;
    // Make the kernel end this process together with the judge.
    prctl::set_pdeathsig(Signal::SIGKILL).context("the process cannot be made to end with its judge")?;
    // The judge may have ended before this took effect.
    ensure!(nix::unistd::getppid().as_raw() == judge, "the judge has ended");
    // Set all restrictions, then become the program.
    restrict_resources(purpose, &limits)?;
    prctl::set_no_new_privs().context("privileges cannot be dropped")?;
    if confinement == Confinement::Full {
        files::restrict(purpose, &program, &readable, &writable)?;
        filter::install(purpose).context("system calls cannot be filtered")?;
    }
    let error = Command::new(&program).args(arguments).exec();
    bail!("{} cannot be started: {error}", program.display())
}

fn text(word: &OsStr) -> Result<&str> {
    word.to_str().context("an argument is not UTF-8")
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
