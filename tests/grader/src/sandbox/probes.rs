//! Tests the sandbox: tries actions that a sandboxed program must not be able to do. This program runs the tests itself, so
//! no compiler is needed.

use super::{Ended, How, PROBE, Purpose, Sandbox, run, this_program};
use anyhow::{Context, Result, bail};
use nix::sched::{CloneFlags, unshare};
use nix::sys::memfd::{MFdFlags, memfd_create};
use nix::sys::resource::{Resource, setrlimit};
use nix::sys::signal::kill;
use nix::unistd::{Pid, getppid, setsid};
use std::io::{self, Write};
use std::path::Path;
use std::time::Duration;

/// Time limit of the tests on a very busy machine. They need milliseconds, and the test of processor time needs a second, for which
/// a process of low priority waited longer than 30 s on a machine with four times as many processes as cores.
const PATIENCE: Duration = Duration::from_secs(120);

/// Most output of the tests, in bytes. They print far less.
const CAP: usize = 64 << 10;

/// Tries to break out of a worker's sandbox. Returns the restrictions that hold on this machine, in words, or an error if an action
/// succeeds or if there is no sandbox.
pub fn self_test() -> Result<String> {
    let sandbox = Sandbox::new(Purpose::Worker);
    let brief =
        Sandbox { limits: super::ResourceLimits { cpu_seconds: 1, ..sandbox.limits }, ..sandbox.clone() };
    // Run all tests at the same time.
    let (through, spun, flooded) = std::thread::scope(|scope| {
        let spun = scope.spawn(|| act_in(&brief, "spin", PATIENCE));
        let flooded = scope.spawn(|| act_in(&sandbox, "flood", PATIENCE));
        (got_through(&sandbox), spun.join(), flooded.join())
    });
    // Collect the actions that succeeded.
    let mut through = through.context("the sandbox does not work on this machine")?;
    let how = |ended: std::thread::Result<Result<Ended>>| match ended {
        Ok(Ok(ended)) => Some(ended.how),
        _ => None,
    };
    if how(spun) != Some(How::UsedUpCpu) {
        through.push("use more processor time than allowed".into());
    }
    if how(flooded) != Some(How::WroteTooMuch) {
        through.push("write without end".into());
    }
    if !through.is_empty() {
        bail!("the sandbox does not hold on this machine: a sandboxed program could {}", through.join(", "));
    }
    Ok(format!("{}, seccomp, resource limits, no new privileges", landlock_level()?))
}

fn landlock_level() -> Result<String> {
    let mut command = std::process::Command::new(super::launcher());
    command.args([PROBE, "level"]).env_clear();
    let ended = run(command, b"", PATIENCE, CAP)?;
    Ok(String::from_utf8_lossy(&ended.stdout).trim().to_owned())
}

/// Returns the tested actions that a program could do in `sandbox`, as ends of the sentence "it could …". A sandbox for
/// compilers or linkers allows some on purpose: threads, processes.
pub fn got_through(sandbox: &Sandbox) -> Result<Vec<String>> {
    let ended = act_in(sandbox, "all", PATIENCE)?;
    let said = String::from_utf8_lossy(&ended.stdout);
    let mut through = Vec::new();
    // Compare line by line, because an action that was not tried proves nothing.
    let mut lines = said.lines();
    for (name, _) in PROBES {
        match lines.next().and_then(|line| line.strip_suffix(name)) {
            Some("contained: ") => {}
            Some("through: ") => through.push((*name).to_owned()),
            _ => bail!(
                "the tests of the sandbox could not be run ({:?}): {}",
                ended.how,
                String::from_utf8_lossy(&ended.stderr).trim()
            ),
        }
    }
    Ok(through)
}

fn act_in(sandbox: &Sandbox, what: &str, patience: Duration) -> Result<Ended> {
    let mut command = sandbox.command(&this_program());
    command.args([PROBE, what]);
    Ok(run(command, b"", patience, CAP)?)
}

/// Runs a test in the sandboxed process.
pub(super) fn act(what: &str) {
    match what {
        "spin" => loop {
            std::hint::spin_loop();
        },
        "flood" => while io::stdout().write_all(&[b'x'; 4096]).is_ok() {},
        "sleep" => std::thread::sleep(Duration::from_secs(3600)),
        "environment" => println!("{:?}", std::env::vars_os().collect::<Vec<_>>()),
        "level" => match super::files::level() {
            Ok(level) => println!("{level}"),
            Err(error) => eprintln!("{error:#}"),
        },
        "descriptors" => {
            let open = (0..1024).filter(|descriptor| nix::unistd::close(*descriptor + 3).is_ok());
            println!("{}", open.count());
        }
        "all" => {
            for (name, try_it) in PROBES {
                let outcome = if is_contained(&try_it()) { "contained" } else { "through" };
                println!("{outcome}: {name}");
            }
        }
        _ => {}
    }
}

/// Returns whether the action was refused or found nothing. Any other error, such as no answer from the other end, means
/// that the kernel allowed the attempt.
fn is_contained(outcome: &io::Result<()>) -> bool {
    use io::ErrorKind::{NotFound, OutOfMemory, PermissionDenied};
    matches!(outcome, Err(error) if [NotFound, OutOfMemory, PermissionDenied].contains(&error.kind()))
}

type Probe = (&'static str, fn() -> io::Result<()>);

const ELSEWHERE: &str = "/tmp";

const PROBES: &[Probe] = &[
    ("read a file of the system", || std::fs::read("/etc/passwd").map(drop)),
    ("list the root folder", || std::fs::read_dir("/").map(drop)),
    ("read its judge's environment", || std::fs::read(of_judge("environ")).map(drop)),
    ("write its own memory as a file", || {
        std::fs::File::options().write(true).open("/proc/self/mem").map(drop)
    }),
    ("write a file in a shared folder", || {
        let file = elsewhere("file");
        std::fs::write(&file, "x")?;
        std::fs::remove_file(&file)
    }),
    ("make a symbolic link", || {
        let link = elsewhere("link");
        std::os::unix::fs::symlink("/etc/passwd", &link)?;
        std::fs::remove_file(&link)
    }),
    ("make a folder", || {
        let folder = elsewhere("folder");
        std::fs::create_dir(&folder)?;
        std::fs::remove_dir(&folder)
    }),
    ("set permissions", || {
        let myself = this_program();
        std::fs::set_permissions(&myself, myself.metadata()?.permissions())
    }),
    ("connect to a port", || std::net::TcpStream::connect(("127.0.0.1", 9)).map(drop)),
    ("listen on a port", || std::net::TcpListener::bind(("127.0.0.1", 0)).map(drop)),
    ("open a datagram socket", || std::net::UdpSocket::bind(("127.0.0.1", 0)).map(drop)),
    ("make a pair of sockets", || std::os::unix::net::UnixStream::pair().map(drop)),
    ("start a process", || std::process::Command::new("/bin/sh").args(["-c", ":"]).status().map(drop)),
    ("start a thread", || std::thread::Builder::new().spawn(|| {}).map(drop)),
    ("allocate 100 GB", || {
        Vec::<u8>::new().try_reserve_exact(100 << 30).map_err(|_| io::ErrorKind::OutOfMemory.into())
    }),
    // Signal 0 only tests the permission.
    ("signal its judge", || Ok(kill(getppid(), None)?)),
    ("signal all processes", || Ok(kill(Pid::from_raw(-1), None)?)),
    ("leave its group", || Ok(setsid().map(drop)?)),
    ("enter a new namespace", || Ok(unshare(CloneFlags::CLONE_NEWUSER)?)),
    ("raise its own limits", || Ok(setrlimit(Resource::RLIMIT_CPU, 1 << 20, 1 << 20)?)),
    ("make a file in memory", || Ok(memfd_create("probe", MFdFlags::empty()).map(drop)?)),
];

fn of_judge(file: &str) -> String {
    format!("/proc/{}/{file}", std::os::unix::process::parent_id())
}

fn elsewhere(what: &str) -> std::path::PathBuf {
    Path::new(ELSEWHERE).join(format!("raykata-probe-{}-{what}", std::process::id()))
}
