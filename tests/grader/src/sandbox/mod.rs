//! The sandbox around every program that handles a submission: the syntax check, the compiler, the linker, the worker.
//!
//! The launcher is this same program, started with a special first argument. It restricts itself and then becomes the
//! sandboxed program. The restrictions are resource limits, no new privileges, Landlock for files and seccomp for other
//! system calls. They need no privileges and cannot be removed. If one of them cannot be set up, the launcher ends and runs
//! nothing.

mod ended;
mod files;
mod filter;
mod launcher;
mod probes;
pub mod processes;
mod run;

use ended::how_it_died;
pub use ended::{Ended, How};
pub use probes::{got_through, self_test};
pub use run::{run, spawn_guarded};

use crate::worker::{Death, Launcher, last_words};
use serde::{Deserialize, Serialize};
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};
use std::sync::OnceLock;
use std::time::Duration;

/// The first argument of a launcher.
const LAUNCH: &str = "--in-a-sandbox";

/// The first argument of a program that tests the sandbox.
const PROBE: &str = "--probe-the-sandbox";

/// The exit code of a launcher that could not sandbox itself.
pub const NOT_LAUNCHED: i32 = 126;

/// The beginning of its message.
pub const NOT_LAUNCHED_BECAUSE: &str = "the sandbox: ";

/// The purpose of a sandboxed program, which decides its rights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Purpose {
    /// A worker: answers calls over the socket that is its standard input. It may not write files, start threads or
    /// processes, or open sockets. It may read only itself and the system's shared libraries.
    Worker,
    /// The syntax check: reads text and writes its findings. It has the rights of a worker.
    Reader,
    /// rustc that makes a library: it may start threads but no processes.
    Compiler,
    /// rustc that links a program: it may also start processes (cc, ld).
    Linker,
}

/// The resource limits of a sandboxed process.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ResourceLimits {
    /// Most address space, in bytes.
    pub memory_bytes: u64,
    /// Most processor time per process, in seconds.
    pub cpu_seconds: u64,
    /// Longest file, in bytes.
    pub file_bytes: u64,
    /// Most open files, pipes and sockets.
    pub open_files: u64,
    /// Most processes and threads, counted over all processes of the user. The kernel does not count those of root. The
    /// seccomp filter prevents a worker from starting any.
    pub processes: u64,
}

impl Purpose {
    /// Returns limits that are sufficient for honest code.
    pub fn limits(self) -> ResourceLimits {
        match self {
            // A check needs about ten megabytes. Each call has its own time limit. This limit of processor time is for all
            // calls of a process together, and for a frame.
            Purpose::Worker => ResourceLimits {
                memory_bytes: 1 << 30,
                cpu_seconds: 120,
                file_bytes: 0,
                open_files: 32,
                processes: 1,
            },
            // The longest allowed file takes milliseconds.
            Purpose::Reader => ResourceLimits { cpu_seconds: 10, ..Purpose::Worker.limits() },
            // rustc maps half a gigabyte and needs a second. Its output has a few megabytes. The user may run hundreds of
            // other processes.
            Purpose::Compiler | Purpose::Linker => ResourceLimits {
                memory_bytes: 3 << 30,
                cpu_seconds: 10,
                file_bytes: 256 << 20,
                open_files: 512,
                processes: 4096,
            },
        }
    }

    /// Returns whether the program may write files.
    fn writes(self) -> bool {
        matches!(self, Purpose::Compiler | Purpose::Linker)
    }
}

/// The strictness of a sandbox.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Confinement {
    /// All restrictions hold. If one of them cannot be set up, nothing runs.
    Full,
    /// Only resource limits hold; files, network and other processes are accessible. The instructor may choose this for
    /// kernels without Landlock or seccomp.
    LimitsOnly,
}

/// A sandbox for a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Sandbox {
    /// The purpose of the program.
    pub purpose: Purpose,
    /// The strictness.
    pub confinement: Confinement,
    /// The resource limits.
    pub limits: ResourceLimits,
    /// Files and folders that the program may read, besides itself and the system's libraries.
    pub readable: Vec<PathBuf>,
    /// Folders that a compiler or linker may write. The first one is its working folder and holds its temporary files.
    pub writable: Vec<PathBuf>,
}

impl Sandbox {
    /// Makes a full sandbox with the default limits and no files to read or write.
    pub fn new(purpose: Purpose) -> Sandbox {
        Sandbox::with(Confinement::Full, purpose)
    }

    /// Makes such a sandbox with another strictness.
    pub fn with(confinement: Confinement, purpose: Purpose) -> Sandbox {
        Sandbox { purpose, confinement, limits: purpose.limits(), readable: vec![], writable: vec![] }
    }

    /// Returns the command that runs `program` in this sandbox. Its environment contains only the search path of a linker
    /// and the folder for temporary files. You may add arguments; do not change the environment.
    pub fn command(&self, program: &Path) -> Command {
        // Pass the parent, the restrictions, the paths and the program to the launcher.
        let paths = self.readable.iter().chain(&self.writable).map(PathBuf::as_path).chain([program]);
        let restrictions: Restrictions =
            (self.purpose, self.confinement, self.limits, self.readable.len(), self.writable.len());
        // A launcher without restrictions ends.
        let restrictions = serde_json::to_string(&restrictions).unwrap_or_default();
        let mut command = Command::new(launcher());
        command.args([LAUNCH, &std::process::id().to_string(), &restrictions]);
        command.args(paths.map(absolute)).env_clear();
        // Set the working folder and the environment.
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
            return Some(Death::Crashed(format!("the worker cannot be started: {why}")));
        }
        how_it_died(status, stderr, self.limits.memory_bytes)
    }

    fn cpu_time(&self, process: u32) -> Duration {
        processes::cpu_time(process).unwrap_or_default()
    }
}

/// Returns the absolute path, because the program starts in another working folder.
fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_owned())
}

/// What a launcher gets by one argument, as JSON, with the numbers of readable and writable paths. The paths follow as arguments
/// of their own, because they may not be UTF-8.
type Restrictions = (Purpose, Confinement, ResourceLimits, usize, usize);

static LAUNCHER: OnceLock<PathBuf> = OnceLock::new();

/// Returns the program that sandboxes itself: this one, or, in tests and benchmarks, the grader that cargo has built.
fn launcher() -> PathBuf {
    LAUNCHER.get().cloned().unwrap_or_else(|| {
        let here = std::env::current_exe().unwrap_or_default();
        let folder = here.parent().unwrap_or(Path::new("/"));
        let folder = if folder.ends_with("deps") { folder.parent().unwrap_or(folder) } else { folder };
        folder.join(format!("grader{}", std::env::consts::EXE_SUFFIX))
    })
}

/// Returns the path of this program, so that a reader can run it in a sandbox.
pub fn this_program() -> PathBuf {
    let launcher = launcher();
    launcher.canonicalize().unwrap_or(launcher)
}

/// Runs the launcher or the sandbox test if this process was started for it, and does not return then. Call this at the
/// start of `main`.
pub fn launch_if_asked() {
    let mut arguments = std::env::args_os().skip(1);
    let word = arguments.next().unwrap_or_default();
    if word == PROBE {
        probes::act(arguments.next().unwrap_or_default().to_string_lossy().as_ref());
        std::process::exit(0);
    }
    if word == LAUNCH {
        let Err(error) = launcher::launch(arguments);
        eprintln!("{NOT_LAUNCHED_BECAUSE}{error}");
        std::process::exit(NOT_LAUNCHED);
    }
    // Use the kernel's link to this program. It stays the same program even if cargo builds a new one.
    let myself = Path::new("/proc/self/exe");
    if let Some(launcher) = if myself.exists() { Some(myself.into()) } else { std::env::current_exe().ok() } {
        let _ = LAUNCHER.set(launcher);
    }
}
