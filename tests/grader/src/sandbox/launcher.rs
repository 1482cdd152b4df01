//! Takes rights away from this process and becomes the program. Single-threaded, and safe code: nothing happens
//! between a fork and an exec.

use super::{Confinement, Limits, Purpose, files, filter};
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

/// On top of the stack that a worker uses where it can have a thread: the program's own frames and its arguments.
const STACK_ROOM: u64 = 8 << 20;

/// After the soft limit comes a signal that says what happened; the hard one kills without a word, as want of memory
/// does, so it has to come later.
const CPU_GRACE_SECONDS: u64 = 2;

pub(super) fn launch(arguments: Vec<OsString>) -> Result<Infallible> {
    let mut arguments = arguments.into_iter();
    let asked = Asked::from(&mut arguments)?;
    close_inherited()?;
    prctl::set_pdeathsig(Signal::SIGKILL).context("it cannot be made to end with its judge")?;
    // The judge may have ended before that took effect.
    ensure!(nix::unistd::getppid().as_raw() == asked.judge, "the judge has ended");
    restrict_resources(asked.purpose, &asked.limits)?;
    prctl::set_no_new_privs().context("privileges cannot be given up")?;
    if asked.confinement == Confinement::Full {
        files::restrict(asked.purpose, &asked.program, &asked.readable, &asked.writable)?;
        filter::install(asked.purpose).context("system calls cannot be filtered")?;
    }
    let error = Command::new(&asked.program).args(arguments).exec();
    bail!("{} cannot be started: {error}", asked.program.display())
}

struct Asked {
    confinement: Confinement,
    purpose: Purpose,
    judge: i32,
    limits: Limits,
    readable: Vec<PathBuf>,
    writable: Vec<PathBuf>,
    program: PathBuf,
}

impl Asked {
    /// Of what [`super::Sandbox::command`] writes.
    fn from(arguments: &mut impl Iterator<Item = OsString>) -> Result<Asked> {
        let mut next = || arguments.next().context("an argument is missing");
        let confinement = Confinement::of_word(&next()?).context("no such confinement")?;
        let purpose = Purpose::of_word(&next()?).context("no such purpose")?;
        let judge = number(&next()?)? as i32;
        let limits = Limits {
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
        ensure!(writable.is_empty() || purpose.writes(), "a {} writes nothing", purpose.word());
        Ok(Asked { confinement, purpose, judge, limits, readable, writable, program: next()?.into() })
    }
}

fn number(word: &OsStr) -> Result<u64> {
    let word = word.to_str().context("not a number")?;
    word.parse().with_context(|| format!("{word} is not a number"))
}

/// Whatever the judge has open, and its parents: all but the standard streams.
fn close_inherited() -> Result<()> {
    let open = std::fs::read_dir("/proc/self/fd").context("open files cannot be listed (is /proc there?)")?;
    let open: Vec<RawFd> = open
        .map(|entry| entry.ok()?.file_name().to_str()?.parse().ok())
        .collect::<Option<_>>()
        .context("open files cannot be listed")?;
    for descriptor in open.into_iter().filter(|descriptor| *descriptor > 2) {
        match nix::unistd::close(descriptor) {
            // The listing itself, which is closed by now.
            Ok(()) | Err(nix::errno::Errno::EBADF) => {}
            Err(error) => bail!("an open file cannot be closed: {error}"),
        }
    }
    Ok(())
}

fn restrict_resources(purpose: Purpose, limits: &Limits) -> Result<()> {
    let stack = match purpose {
        // Answers on its first thread, as it can have no other.
        Purpose::Worker | Purpose::Reader => raykata::worker::STACK_BYTES as u64 + STACK_ROOM,
        // What systems give; the threads of a compiler say how much they want.
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
        // No traces of a crash on disk.
        (Resource::RLIMIT_CORE, 0, 0),
    ] {
        // A machine may allow less than we would; then that is the limit.
        let (_, most) = nix::sys::resource::getrlimit(resource).context("limits cannot be read")?;
        setrlimit(resource, soft.min(most), hard.min(most))
            .with_context(|| format!("the limit {resource:?} cannot be set to {soft}"))?;
    }
    Ok(())
}
