//! The other side of a worker: starts the process, asks, and turns whatever happens into an answer or a [`KitError`].
//!
//! A process that panics, loops, overflows its stack or ends costs the call that it was asked, and nothing else: the
//! next call starts a new one.

mod autopsy;
mod watchdog;

pub use autopsy::last_words;
use autopsy::{cause_of_death, keep_start, shortened, wait_briefly};
use raykata::frame::Watch;
use raykata::kit::{Answer, KitError, Request, Transport, kit_error};
use raykata::worker::{self, LONGEST_MESSAGE, Reply};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;
use watchdog::Watchdog;

/// How long a call of a check may take. The slowest needs a tenth of a second.
pub const CALL_PATIENCE: Duration = Duration::from_secs(10);

/// How long a frame may go without progress: building a large hierarchy in a development build takes a while.
const FRAME_PATIENCE: Duration = Duration::from_secs(120);

/// The longest reply of a worker that nobody trusts: ten times what the largest frame of a check takes. It bounds what
/// the judge can be made to hold; values can take some times as much in memory as in a message.
const LONGEST_UNTRUSTED_REPLY: usize = 64 << 20;

/// How the process of a worker is started, and what its end means. Whoever runs code that nobody trusts puts a sandbox
/// between it and the machine.
pub trait Launcher: Send + Sync {
    /// The command that starts `program`.
    fn command(&self, program: &Path) -> Command;

    /// Starts the command.
    fn spawn(&self, command: Command) -> io::Result<Child>;

    /// Why the process ended, if the sandbox knows: it has this status and wrote this to standard error.
    fn death(&self, status: ExitStatus, stderr: &str) -> Option<Death>;

    /// How much processor time the process has used so far.
    fn cpu_time(&self, process: u32) -> Duration;
}

/// Why the process of a worker ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Death {
    /// It has used up its processor time.
    TimedOut,
    /// What this says.
    Crashed(String),
}

/// A kit in a process of its own.
pub struct Worker {
    program: PathBuf,
    /// What starts the processes of code that nobody trusts.
    launcher: Option<Arc<dyn Launcher>>,
    call_patience: Duration,
    frame_patience: Duration,
    asks_again: AtomicBool,
    process: Mutex<Option<Process>>,
}

impl Worker {
    /// A worker that will run `program` when it is first asked something.
    pub fn new(program: PathBuf, call_patience: Duration) -> Self {
        Worker {
            program,
            launcher: None,
            call_patience,
            frame_patience: FRAME_PATIENCE,
            asks_again: AtomicBool::new(false),
            process: Mutex::new(None),
        }
    }

    /// The same for code that nobody trusts, in the sandbox of `launcher`. It has `patience` for a frame, too, however often that says that it gets
    /// on. Time counts only while the worker computes, up to three times the patience, so that a busy machine does
    /// not change a verdict.
    pub fn sandboxed(program: PathBuf, patience: Duration, launcher: impl Launcher + 'static) -> Self {
        let launcher: Arc<dyn Launcher> = Arc::new(launcher);
        Worker { launcher: Some(launcher), frame_patience: patience, ..Worker::new(program, patience) }
    }

    /// The same for small pictures, of which some never end: it waits no longer for a frame than for any other call.
    /// But on a busy machine that may be too short, so what is late is asked once more, with the long wait; until that
    /// has been in vain.
    pub fn hasty(program: PathBuf, patience: Duration) -> Self {
        Worker {
            frame_patience: patience,
            asks_again: AtomicBool::new(true),
            ..Worker::new(program, patience)
        }
    }

    fn ask(&self, request: &Request, watch: &dyn Watch, patience: Duration) -> Result<Answer, KitError> {
        let mut slot = lock(&self.process);
        let start = || Process::start(&self.program, self.launcher.clone());
        let mut process = match slot.take().map_or_else(start, Ok) {
            Ok(process) => process,
            Err(error) => return Err(KitError::Crashed { how: format!("it cannot be started: {error}") }),
        };
        match process.ask(request, watch, patience) {
            Ok(Some(Reply::KitError(error))) => {
                *slot = Some(process);
                Err(shortened(error))
            }
            // That is for frames that are no longer wanted: from here it could be out of step.
            Ok(Some(Reply::Answer(answer))) if matches!(*answer, Answer::Render(None)) => {
                Err(KitError::Malformed { what: "no picture".into() })
            }
            Ok(Some(Reply::Answer(answer))) => {
                *slot = Some(process);
                Ok(*answer)
            }
            Ok(_) => Ok(Answer::Render(None)),
            Err(error) => {
                drop(slot);
                Err(process.post_mortem(&error, patience))
            }
        }
    }
}

impl Transport for Worker {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        let patience =
            if matches!(request, Request::Render(_)) { self.frame_patience } else { self.call_patience };
        let mut answer = self.ask(&request, watch, patience);
        let late = |answer: &Result<Answer, KitError>| matches!(answer, Err(KitError::TimedOut { .. }));
        if late(&answer) && self.asks_again.load(Ordering::Relaxed) {
            answer = self.ask(&request, watch, FRAME_PATIENCE);
            self.asks_again.store(!late(&answer), Ordering::Relaxed);
        }
        answer.unwrap_or_else(|error| kit_error::unwind(error))
    }
}

struct Process {
    child: Arc<Mutex<Child>>,
    to_worker: Box<dyn Write + Send>,
    from_worker: Box<dyn Read + Send>,
    watchdog: Arc<Watchdog>,
    stderr: std::thread::JoinHandle<String>,
    launcher: Option<Arc<dyn Launcher>>,
}

impl Process {
    fn start(program: &Path, launcher: Option<Arc<dyn Launcher>>) -> io::Result<Process> {
        let mut command = match &launcher {
            Some(launcher) => launcher.command(program),
            None => Command::new(program),
        };
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        let (mut child, to_worker, from_worker) = spawn(command, launcher.as_deref())?;
        let stderr = child.stderr.take().ok_or_else(|| io::Error::other("no standard error"))?;
        let child = Arc::new(Mutex::new(child));
        Ok(Process {
            watchdog: Watchdog::guard(&child, launcher.clone()),
            child,
            to_worker,
            from_worker,
            stderr: std::thread::spawn(move || keep_start(stderr)),
            launcher,
        })
    }

    /// `None` if `watch` no longer wants the answer.
    fn ask(&mut self, request: &Request, watch: &dyn Watch, patience: Duration) -> io::Result<Option<Reply>> {
        let trusted = self.launcher.is_none();
        let longest = if trusted { LONGEST_MESSAGE } else { LONGEST_UNTRUSTED_REPLY };
        // Before the question: a worker that does not read it may not stop us for ever.
        self.watchdog.bark_after(patience);
        worker::send(&mut self.to_worker, request)?;
        loop {
            match worker::receive_up_to(&mut self.from_worker, longest)? {
                Reply::Progress { .. } | Reply::Building { .. } if !matches!(request, Request::Render(_)) => {
                    return Err(io::Error::other("it says how far a frame is, and was asked for none"));
                }
                told @ (Reply::Progress { .. } | Reply::Building { .. }) => {
                    match told {
                        Reply::Building { placed, total } => watch.building(placed, total),
                        Reply::Progress { done, total } => watch.progress(done, total),
                        _ => {}
                    }
                    if watch.cancelled() {
                        return Ok(None);
                    }
                    // Code that nobody trusts could say so for ever.
                    if trusted {
                        self.watchdog.bark_after(patience);
                    }
                }
                reply => {
                    self.watchdog.rest();
                    return Ok(Some(reply));
                }
            }
        }
    }

    /// Why the process no longer answers, or what is wrong with what it says.
    fn post_mortem(mut self, error: &io::Error, patience: Duration) -> KitError {
        let timed_out = self.watchdog.has_barked();
        // That is how a message is refused; the pipe fails in other ways.
        let nonsense = !timed_out && error.kind() == io::ErrorKind::Other;
        // The pipe may close a moment before the process is gone; then it ends by itself.
        let status = if nonsense { None } else { wait_briefly(&self.child) };
        let _ = lock(&self.child).kill();
        let status = status.or_else(|| lock(&self.child).wait().ok());
        self.to_worker = Box::new(io::sink());
        self.from_worker = Box::new(io::empty());
        let stderr =
            std::mem::replace(&mut self.stderr, std::thread::spawn(String::new)).join().unwrap_or_default();
        if timed_out {
            return KitError::TimedOut { seconds: patience.as_secs() };
        }
        if nonsense {
            return KitError::Malformed { what: error.to_string() };
        }
        cause_of_death(status, &stderr, self.launcher.as_deref(), patience)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // By exact process id, and waited for, so that nothing is left behind.
        let mut child = lock(&self.child);
        let _ = child.kill();
        let _ = child.wait();
        drop(child);
        self.watchdog.retire();
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

type Pipes = (Child, Box<dyn Write + Send>, Box<dyn Read + Send>);

#[cfg(unix)]
fn spawn(mut command: Command, launcher: Option<&dyn Launcher>) -> io::Result<Pipes> {
    use std::os::fd::OwnedFd;
    use std::os::unix::net::UnixStream;
    let (ours, theirs) = UnixStream::pair()?;
    // The command keeps its end open until it is dropped; then only the worker has it, and its end is our end of file.
    command.stdin(Stdio::from(OwnedFd::from(theirs)));
    let child = match launcher {
        Some(launcher) => launcher.spawn(command)?,
        None => command.spawn()?,
    };
    let writer = ours.try_clone()?;
    Ok((child, Box::new(BufWriter::new(writer)), Box::new(BufReader::new(ours))))
}

#[cfg(not(unix))]
fn spawn(mut command: Command, _: Option<&dyn Launcher>) -> io::Result<Pipes> {
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
    let (Some(stdin), Some(stdout)) = (child.stdin.take(), child.stdout.take()) else {
        return Err(io::Error::other("no pipes"));
    };
    Ok((child, Box::new(BufWriter::new(stdin)), Box::new(BufReader::new(stdout))))
}
