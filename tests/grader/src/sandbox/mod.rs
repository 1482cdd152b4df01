//! The wall around everything that a submission makes run: the syntax check, the compiler, the linker, the worker.
//!
//! A launcher, which is this same program started with a hidden word, takes rights away from itself and then becomes
//! the program: limits on resources, no new privileges, Landlock for files, seccomp for the rest of the kernel. None
//! of it needs privileges, and none can be given back. Whatever cannot be set up ends the launcher: nothing ever runs
//! half sandboxed.

mod ended;
#[cfg(target_os = "linux")]
mod files;
#[cfg(target_os = "linux")]
mod filter;
#[cfg(target_os = "linux")]
mod launcher;
mod probes;
#[cfg(target_os = "linux")]
pub mod processes;
#[cfg(target_os = "linux")]
mod run;

#[cfg(not(target_os = "linux"))]
#[path = "elsewhere.rs"]
mod run;

use ended::how_it_died;
pub use ended::{Ended, How};
pub use probes::{Level, got_through, self_test};
pub use run::{run, spawn_guarded};

use crate::worker::{Death, Launcher, last_words};
use std::ffi::OsString;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};
use std::sync::OnceLock;
use std::time::Duration;

/// The first argument of a launcher.
const LAUNCH: &str = "--in-a-sandbox";

/// The first argument of a program that tries what should not work.
const PROBE: &str = "--probe-the-sandbox";

/// How a launcher that could not sandbox itself ends.
pub const NOT_LAUNCHED: i32 = 126;

/// What its message begins with.
pub const NOT_LAUNCHED_BECAUSE: &str = "the sandbox: ";

/// What a sandboxed program is for, which decides what it may ask of the kernel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// Answers calls over the socket that is its standard input: no files to write, no threads, no processes, no
    /// sockets of its own. It reads itself and the shared libraries of the system.
    Worker,
    /// Reads text and says what it thinks: the syntax check. As a worker.
    Reader,
    /// rustc making a library or only metadata: threads, no processes.
    Compiler,
    /// rustc linking a program: as the compiler, with processes (cc, ld).
    Linker,
}

/// How much of the machine a sandboxed process may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// Address space.
    pub memory_bytes: u64,
    /// Processor time, of each process.
    pub cpu_seconds: u64,
    /// The longest file.
    pub file_bytes: u64,
    /// Open files, pipes and sockets.
    pub open_files: u64,
    /// Processes and threads, counted over everything that the user runs. The kernel does not count those of root; a
    /// worker is kept from starting any by its filter.
    pub processes: u64,
}

impl Purpose {
    /// What is enough for honest code.
    pub fn limits(self) -> Limits {
        match self {
            // A check needs some ten megabytes. Its calls have a patience of their own; the processor time is for all
            // calls of a check together, and what a frame may take.
            Purpose::Worker => Limits {
                memory_bytes: 1 << 30,
                cpu_seconds: 120,
                file_bytes: 0,
                open_files: 32,
                processes: 1,
            },
            // Milliseconds for the longest file that is taken.
            Purpose::Reader => Limits { cpu_seconds: 10, ..Purpose::Worker.limits() },
            // rustc maps half a gigabyte and needs a second; the results have a few megabytes. The user may have
            // hundreds of processes of other kinds.
            Purpose::Compiler | Purpose::Linker => Limits {
                memory_bytes: 3 << 30,
                cpu_seconds: 10,
                file_bytes: 256 << 20,
                open_files: 512,
                processes: 4096,
            },
        }
    }

    /// Whether it may write at all.
    fn writes(self) -> bool {
        matches!(self, Purpose::Compiler | Purpose::Linker)
    }

    fn word(self) -> &'static str {
        match self {
            Purpose::Worker => "worker",
            Purpose::Reader => "reader",
            Purpose::Compiler => "compiler",
            Purpose::Linker => "linker",
        }
    }

    #[cfg(target_os = "linux")]
    fn of_word(word: &std::ffi::OsStr) -> Option<Purpose> {
        let all = [Purpose::Worker, Purpose::Reader, Purpose::Compiler, Purpose::Linker];
        all.into_iter().find(|purpose| word == purpose.word())
    }
}

/// How closed a sandbox is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Confinement {
    /// Nothing gets through that is not allowed, or nothing runs.
    Full,
    /// On the instructor's own word, where the kernel has no confinement: limits on resources hold, files, networks and other
    /// processes are open.
    LimitsOnly,
}

impl Confinement {
    fn word(self) -> &'static str {
        match self {
            Confinement::Full => "closed",
            Confinement::LimitsOnly => "open",
        }
    }

    #[cfg(target_os = "linux")]
    fn of_word(word: &std::ffi::OsStr) -> Option<Confinement> {
        [Confinement::Full, Confinement::LimitsOnly]
            .into_iter()
            .find(|confinement| word == confinement.word())
    }
}

/// Confinement around a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sandbox {
    /// What it is for.
    pub purpose: Purpose,
    /// How closed it is.
    pub confinement: Confinement,
    /// What it may use.
    pub limits: Limits,
    /// Files and folders that it may read, besides itself and the libraries of the system.
    pub readable: Vec<PathBuf>,
    /// Folders that it may write, if it is a compiler or a linker. The first is where it starts and keeps its
    /// temporary files.
    pub writable: Vec<PathBuf>,
}

impl Sandbox {
    /// Closed, with the usual limits, and nothing to read or write.
    pub fn new(purpose: Purpose) -> Sandbox {
        Sandbox::with(Confinement::Full, purpose)
    }

    /// The same with other confinement.
    pub fn with(confinement: Confinement, purpose: Purpose) -> Sandbox {
        Sandbox { purpose, confinement, limits: purpose.limits(), readable: vec![], writable: vec![] }
    }

    /// The command that runs `program` in here. Its environment is empty, but for where a linker looks for tools and
    /// where temporary files go. Add arguments; do not change the environment.
    pub fn command(&self, program: &Path) -> Command {
        let limits = &self.limits;
        let mut command = Command::new(launcher());
        command
            .args([LAUNCH, self.confinement.word(), self.purpose.word()])
            .arg(std::process::id().to_string());
        for limit in
            [limits.cpu_seconds, limits.memory_bytes, limits.file_bytes, limits.open_files, limits.processes]
        {
            command.arg(limit.to_string());
        }
        for paths in [&self.readable, &self.writable] {
            command.arg(paths.len().to_string()).args(paths.iter().map(|path| absolute(path)));
        }
        command.arg(absolute(program)).env_clear();
        let start = self.writable.first().map_or_else(|| PathBuf::from("/"), |folder| absolute(folder));
        if self.purpose.writes() {
            command.env("TMPDIR", &start);
        }
        if self.purpose == Purpose::Linker {
            command.env("PATH", "/usr/bin:/bin");
        }
        command.current_dir(start);
        command
    }
}

impl Launcher for Sandbox {
    fn command(&self, program: &Path) -> Command {
        Sandbox::command(self, program)
    }

    fn spawn(&self, command: Command) -> io::Result<Child> {
        spawn_guarded(command)
    }

    fn death(&self, status: ExitStatus, stderr: &str) -> Option<Death> {
        if status.code() == Some(NOT_LAUNCHED) && stderr.starts_with(NOT_LAUNCHED_BECAUSE) {
            let why = last_words(stderr).unwrap_or_default();
            return Some(Death::Crashed(format!("it cannot be started: {why}")));
        }
        how_it_died(status, stderr, self.limits.memory_bytes)
    }

    #[cfg(target_os = "linux")]
    fn cpu_time(&self, process: u32) -> Duration {
        processes::cpu_time(process).unwrap_or_default()
    }

    /// Unknown: then all time counts.
    #[cfg(not(target_os = "linux"))]
    fn cpu_time(&self, _: u32) -> Duration {
        Duration::MAX
    }
}

/// The program starts elsewhere than the command is made.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// Where the processor time is among the arguments of a launcher; before it come confinement, purpose and parent.
#[cfg(target_os = "linux")]
const CPU_SECONDS_AT: usize = 4;

static LAUNCHER: OnceLock<PathBuf> = OnceLock::new();

/// The program that sandboxes itself: this one, or, for tests and benchmarks, the tool that cargo has put near them.
fn launcher() -> PathBuf {
    LAUNCHER.get().cloned().unwrap_or_else(|| {
        let here = std::env::current_exe().unwrap_or_default();
        let folder = here.parent().unwrap_or(Path::new("/"));
        let folder = if folder.ends_with("deps") { folder.parent().unwrap_or(folder) } else { folder };
        folder.join(format!("grader{}", std::env::consts::EXE_SUFFIX))
    })
}

/// This program, as something to run in a sandbox: for a reader.
pub fn this_program() -> PathBuf {
    let launcher = launcher();
    launcher.canonicalize().unwrap_or(launcher)
}

/// First thing in `main`: a process that was started as a launcher, or to probe a sandbox, goes no further.
pub fn launch_if_asked() {
    let mut arguments = std::env::args_os().skip(1);
    let word = arguments.next().unwrap_or_default();
    if word == PROBE {
        probes::act(arguments.next().unwrap_or_default().to_string_lossy().as_ref());
        std::process::exit(0);
    }
    if word == LAUNCH {
        eprintln!("{NOT_LAUNCHED_BECAUSE}{}", launch(arguments.collect()));
        std::process::exit(NOT_LAUNCHED);
    }
    // By way of the kernel and not by name: it stays the same program when cargo builds a new one meanwhile.
    let myself = Path::new("/proc/self/exe");
    if let Some(launcher) = if myself.exists() { Some(myself.into()) } else { std::env::current_exe().ok() } {
        let _ = LAUNCHER.set(launcher);
    }
}

/// Comes back only with what went wrong.
#[cfg(target_os = "linux")]
fn launch(arguments: Vec<OsString>) -> anyhow::Error {
    match launcher::launch(arguments) {
        Err(error) => error,
        Ok(never) => match never {},
    }
}

#[cfg(not(target_os = "linux"))]
fn launch(_: Vec<OsString>) -> anyhow::Error {
    anyhow::anyhow!("{}", run::ONLY_LINUX)
}
