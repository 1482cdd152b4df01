//! The other side of a worker: starts the process, asks, and turns whatever happens into an answer or a [`Mishap`].
//!
//! A process that panics, loops, overflows its stack or ends costs the call that it was asked, and nothing else: the
//! next call starts a new one.

use raykata::frame::Watch;
use raykata::kit::{Answer, Mishap, Request, Transport, mishap};
use raykata::worker::{self, Reply};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::PathBuf;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How long a call of a check may take. The slowest needs a tenth of a second.
pub const CALL_PATIENCE: Duration = Duration::from_secs(10);

/// How long a frame may go without progress: building a large hierarchy in a development build takes a while.
const FRAME_PATIENCE: Duration = Duration::from_secs(120);

/// How much of what a worker writes to standard error is kept.
const KEPT_STDERR: u64 = 64 * 1024;

/// A kit in a process of its own.
pub struct Worker {
    program: PathBuf,
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
            call_patience,
            frame_patience: FRAME_PATIENCE,
            asks_again: AtomicBool::new(false),
            process: Mutex::new(None),
        }
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

    fn ask(&self, request: &Request, watch: &dyn Watch, patience: Duration) -> Result<Answer, Mishap> {
        let mut slot = lock(&self.process);
        let mut process = match slot.take().map_or_else(|| Process::start(&self.program), Ok) {
            Ok(process) => process,
            Err(error) => return Err(Mishap::Crashed { how: format!("it cannot be started: {error}") }),
        };
        match process.ask(request, watch, patience) {
            Ok(Some(Reply::Mishap(mishap))) => {
                *slot = Some(process);
                Err(mishap)
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
        let late = |answer: &Result<Answer, Mishap>| matches!(answer, Err(Mishap::TimedOut { .. }));
        if late(&answer) && self.asks_again.load(Ordering::Relaxed) {
            answer = self.ask(&request, watch, FRAME_PATIENCE);
            self.asks_again.store(!late(&answer), Ordering::Relaxed);
        }
        answer.unwrap_or_else(|mishap| mishap::unwind(mishap))
    }
}

struct Process {
    child: Arc<Mutex<Child>>,
    to_worker: Box<dyn Write + Send>,
    from_worker: Box<dyn Read + Send>,
    watchdog: Arc<Watchdog>,
    stderr: std::thread::JoinHandle<String>,
}

impl Process {
    fn start(program: &PathBuf) -> io::Result<Process> {
        let mut command = Command::new(program);
        command.stdout(Stdio::null()).stderr(Stdio::piped());
        let (mut child, to_worker, from_worker) = spawn(command)?;
        let stderr = child.stderr.take().ok_or_else(|| io::Error::other("no standard error"))?;
        let child = Arc::new(Mutex::new(child));
        Ok(Process {
            watchdog: Watchdog::guard(&child),
            child,
            to_worker,
            from_worker,
            stderr: std::thread::spawn(move || keep_start(stderr)),
        })
    }

    /// `None` if `watch` no longer wants the answer.
    fn ask(&mut self, request: &Request, watch: &dyn Watch, patience: Duration) -> io::Result<Option<Reply>> {
        self.watchdog.bark_after(patience);
        worker::send(&mut self.to_worker, request)?;
        loop {
            match worker::receive(&mut self.from_worker)? {
                Reply::Progress { done, total } => {
                    watch.progress(done, total);
                    if watch.cancelled() {
                        return Ok(None);
                    }
                    self.watchdog.bark_after(patience);
                }
                reply => {
                    self.watchdog.rest();
                    return Ok(Some(reply));
                }
            }
        }
    }

    /// Why the process no longer answers.
    fn post_mortem(mut self, error: &io::Error, patience: Duration) -> Mishap {
        let timed_out = self.watchdog.barked.load(Ordering::Relaxed);
        // The pipe may close a moment before the process is gone; then it ends by itself.
        let status =
            if error.kind() == io::ErrorKind::InvalidData { None } else { wait_briefly(&self.child) };
        let _ = lock(&self.child).kill();
        let status = status.or_else(|| lock(&self.child).wait().ok());
        self.to_worker = Box::new(io::sink());
        self.from_worker = Box::new(io::empty());
        let stderr =
            std::mem::replace(&mut self.stderr, std::thread::spawn(String::new)).join().unwrap_or_default();
        if timed_out {
            return Mishap::TimedOut { seconds: patience.as_secs() };
        }
        Mishap::Crashed { how: cause_of_death(status, &stderr) }
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

fn wait_briefly(child: &Mutex<Child>) -> Option<ExitStatus> {
    let until = Instant::now() + Duration::from_millis(500);
    while Instant::now() < until {
        if let Ok(Some(status)) = lock(child).try_wait() {
            return Some(status);
        }
        std::thread::yield_now();
    }
    None
}

fn cause_of_death(status: Option<ExitStatus>, stderr: &str) -> String {
    if stderr.contains("has overflowed its stack") {
        return "the stack overflowed: a recursion that never ends?".into();
    }
    match status {
        None => "for an unknown reason".into(),
        Some(status) => match stderr.lines().rev().find(|line| !line.trim().is_empty()) {
            Some(last) => format!("{status}; its last words: {}", last.chars().take(160).collect::<String>()),
            None => status.to_string(),
        },
    }
}

/// Reads to the end and keeps the beginning.
fn keep_start(mut stderr: impl Read) -> String {
    let mut kept = Vec::new();
    let _ = stderr.by_ref().take(KEPT_STDERR).read_to_end(&mut kept);
    let _ = io::copy(&mut stderr, &mut io::sink());
    String::from_utf8_lossy(&kept).into_owned()
}

/// Ends a process that does not answer in time. One thread a process; it sleeps between calls.
struct Watchdog {
    deadline: Mutex<Deadline>,
    changed: Condvar,
    barked: AtomicBool,
}

#[derive(Clone, Copy, PartialEq)]
enum Deadline {
    None,
    At(Instant),
    Retired,
}

impl Watchdog {
    fn guard(child: &Arc<Mutex<Child>>) -> Arc<Watchdog> {
        let watchdog = Arc::new(Watchdog {
            deadline: Mutex::new(Deadline::None),
            changed: Condvar::new(),
            barked: AtomicBool::new(false),
        });
        let (on_duty, child) = (watchdog.clone(), child.clone());
        std::thread::spawn(move || on_duty.watch(&child));
        watchdog
    }

    fn watch(&self, child: &Mutex<Child>) {
        let mut deadline = lock(&self.deadline);
        loop {
            deadline = match *deadline {
                Deadline::Retired => return,
                Deadline::None => self.changed.wait(deadline).unwrap_or_else(PoisonError::into_inner),
                Deadline::At(end) => match end.checked_duration_since(Instant::now()) {
                    Some(left) => {
                        self.changed.wait_timeout(deadline, left).unwrap_or_else(PoisonError::into_inner).0
                    }
                    None => {
                        self.barked.store(true, Ordering::Relaxed);
                        let _ = lock(child).kill();
                        return;
                    }
                },
            };
        }
    }

    fn bark_after(&self, patience: Duration) {
        self.set(Deadline::At(Instant::now() + patience));
    }

    fn rest(&self) {
        self.set(Deadline::None);
    }

    fn retire(&self) {
        self.set(Deadline::Retired);
    }

    fn set(&self, deadline: Deadline) {
        *lock(&self.deadline) = deadline;
        self.changed.notify_one();
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

type Pipes = (Child, Box<dyn Write + Send>, Box<dyn Read + Send>);

#[cfg(unix)]
fn spawn(mut command: Command) -> io::Result<Pipes> {
    use std::os::fd::OwnedFd;
    use std::os::unix::net::UnixStream;
    let (ours, theirs) = UnixStream::pair()?;
    // The command keeps its end open until it is dropped; then only the worker has it, and its end is our end of file.
    let child = command.stdin(Stdio::from(OwnedFd::from(theirs))).spawn()?;
    drop(command);
    let writer = ours.try_clone()?;
    Ok((child, Box::new(BufWriter::new(writer)), Box::new(BufReader::new(ours))))
}

#[cfg(not(unix))]
fn spawn(mut command: Command) -> io::Result<Pipes> {
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
    let (Some(stdin), Some(stdout)) = (child.stdin.take(), child.stdout.take()) else {
        return Err(io::Error::other("no pipes"));
    };
    Ok((child, Box::new(BufWriter::new(stdin)), Box::new(BufReader::new(stdout))))
}
