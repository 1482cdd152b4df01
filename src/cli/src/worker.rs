//! The caller's side of a worker: starts the process, sends requests, and returns an answer or a [`KitError`].
//!
//! If a process panics, loops, overflows its stack or ends, only the current call fails: the next call starts a new
//! process.

mod autopsy;
mod launcher;
mod waiting;
mod watchdog;
mod withheld;

use crate::queue::lock;
pub use autopsy::last_words;
use autopsy::{cause_of_death, keep_start, shortened, wait_briefly};
pub use launcher::{Death, Launcher};
use raykata::frame::{Unwatched, Watch};
use raykata::kit::{Answer, KitError, RenderJob, Request, Transport, kit_error};
use raykata::worker::{self, LONGEST_MESSAGE, Reply};
use std::io::{self, BufReader, BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::thread::JoinHandle;
use std::time::Duration;
use watchdog::Watchdog;
use withheld::Withheld;

/// The longest time for a call of a check. The slowest needs a tenth of a second.
pub const CALL_PATIENCE: Duration = Duration::from_secs(10);

/// The longest time without progress in a frame, because building a large hierarchy in a development build
/// takes long.
const FRAME_PATIENCE: Duration = Duration::from_secs(120);

/// The longest reply of an untrusted worker, in bytes, to a request that asks for no picture. It bounds the memory of the
/// judge: a decoded list of empty lists takes 24 times as much. The longest answer of the reference to a check has 0.4 MB.
const LONGEST_UNTRUSTED: usize = 4 << 20;

/// The longest reply of an untrusted worker to `request`, in bytes.
fn longest_reply(request: &Request) -> usize {
    let size = |job: &RenderJob| u64::from(job.scene.film.width) * u64::from(job.scene.film.height);
    // A pixel has 12 bytes.
    let bytes = usize::try_from(12 * request.frame().map_or(0, size)).unwrap_or(LONGEST_MESSAGE);
    bytes.saturating_add(LONGEST_UNTRUSTED).min(LONGEST_MESSAGE)
}

/// A kit in a separate process.
pub struct Worker {
    program: PathBuf,
    /// Starts the processes of untrusted code.
    launcher: Option<Arc<dyn Launcher>>,
    call_patience: Duration,
    frame_patience: Duration,
    /// What the program has written, for a call whose output is asked for.
    output: Option<Output>,
    /// Whether the tables of searches stay here, so that the worker must ask for each entry.
    withholds: AtomicBool,
    process: Mutex<Option<Process>>,
    /// The process that answers a call at the moment, which [`Worker::stop`] ends.
    running: Mutex<Option<Arc<Mutex<Child>>>>,
    /// No process starts from now on. It is set and read while `running` is locked.
    is_retired: AtomicBool,
    /// The processor time of the processes that have ended.
    ended: Mutex<Duration>,
}

impl Worker {
    /// A worker that starts `program` at its first call.
    pub fn new(program: PathBuf, call_patience: Duration) -> Self {
        Worker {
            program,
            launcher: None,
            call_patience,
            frame_patience: FRAME_PATIENCE,
            output: None,
            withholds: AtomicBool::new(false),
            process: Mutex::new(None),
            running: Mutex::new(None),
            is_retired: AtomicBool::new(false),
            ended: Mutex::default(),
        }
    }

    /// The same for untrusted code, in the sandbox of `launcher`. A frame has the time `patience` as well,
    /// even if it reports progress. Only processor time counts, within three times `patience` of elapsed
    /// time without the time that it waits for a processor, so that a busy machine does not change a verdict.
    pub fn sandboxed(program: PathBuf, patience: Duration, launcher: impl Launcher + 'static) -> Self {
        let launcher: Arc<dyn Launcher> = Arc::new(launcher);
        Worker { launcher: Some(launcher), ..Worker::new(program, patience).with_short_frames() }
    }

    /// The answer to `request` by a process of its own, and the beginning of what the student's code prints meanwhile.
    pub fn alone(program: PathBuf, request: Request) -> (Result<Answer, KitError>, String) {
        let output = Output::default();
        let worker = Worker { output: Some(output.clone()), ..Worker::new(program, CALL_PATIENCE) };
        let answer = kit_error::catch(|| worker.call(request, &Unwatched));
        // The process ends here, so that its last line is known.
        drop(worker);
        (answer, std::mem::take(&mut *lock(&output)))
    }

    /// The same, but a frame without progress has no more time than a call: for pictures that are small or may never end.
    pub fn with_short_frames(self) -> Self {
        Worker { frame_patience: self.call_patience, ..self }
    }

    /// From now on keeps the tables of searches here, or no longer. The worker then asks for each entry, and the counts in an
    /// answer are those of the questions. A question takes about 10 µs.
    pub fn withhold_tables(&self, withholds: bool) {
        self.withholds.store(withholds, Ordering::Relaxed);
    }

    /// The processor time that the processes of untrusted code have used so far. It is 0 for trusted code.
    pub fn cpu_time(&self) -> Duration {
        let running = lock(&self.process).as_ref().map_or(Duration::ZERO, Process::cpu_time);
        *lock(&self.ended) + running
    }

    /// Ends the process that answers a call at the moment, also if its code never ends. That call fails as if the process had
    /// crashed.
    pub fn stop(&self) {
        if let Some(child) = lock(&self.running).take() {
            let _ = lock(&child).kill();
        }
    }

    /// The same, and every later call fails, so that a call that begins at this moment is not missed.
    pub fn retire(&self) {
        let mut running = lock(&self.running);
        self.is_retired.store(true, Ordering::Relaxed);
        if let Some(child) = running.take() {
            let _ = lock(&child).kill();
        }
    }

    /// The number of the process, if one is running.
    pub fn process(&self) -> Option<u32> {
        lock(&self.process).as_ref().map(|process| lock(&process.child).id())
    }

    fn ask(&self, request: &Request, watch: &dyn Watch, patience: Duration) -> Result<Answer, KitError> {
        let mut slot = lock(&self.process);
        let start = || Process::start(&self.program, self.launcher.clone(), self.output.clone());
        let mut process = match slot.take().map_or_else(start, Ok) {
            Ok(process) => process,
            Err(error) => return Err(KitError::Crashed { how: format!("it cannot be started: {error}") }),
        };
        {
            let mut running = lock(&self.running);
            if self.is_retired.load(Ordering::Relaxed) {
                return Err(KitError::Crashed { how: "it was stopped".into() });
            }
            *running = Some(process.child.clone());
        }
        let blank = self.withholds.load(Ordering::Relaxed).then(|| withheld::withheld(request)).flatten();
        let mut tables = blank.as_ref().map(|_| Withheld::of(request));
        match process.ask(blank.as_ref().unwrap_or(request), tables.as_mut(), watch, patience) {
            // A process that answers has neither ended nor exceeded its time.
            Ok(Some(Reply::KitError(
                KitError::Crashed { .. } | KitError::TimedOut { .. } | KitError::Waited { .. },
            ))) if self.launcher.is_some() => {
                Err(KitError::Malformed { what: "an end that did not happen".into() })
            }
            Ok(Some(Reply::KitError(error))) => {
                *slot = Some(process);
                Err(shortened(error))
            }
            // Only the caller can cancel a frame: refuse this answer, and end the process, which may be out of step.
            Ok(Some(Reply::Answer(answer))) if matches!(*answer, Answer::Render(None)) => {
                Err(KitError::Malformed { what: "no picture".into() })
            }
            Ok(Some(Reply::Answer(mut answer))) => {
                *slot = Some(process);
                if let Some(tables) = tables {
                    tables.correct(&mut answer);
                }
                Ok(*answer)
            }
            Ok(_) => Ok(Answer::Render(None)),
            Err(error) => {
                drop(slot);
                *lock(&self.ended) += process.cpu_time();
                Err(process.post_mortem(&error, patience))
            }
        }
    }
}

impl Transport for Worker {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        let patience = if request.frame().is_some() { self.frame_patience } else { self.call_patience };
        self.ask(&request, watch, patience).unwrap_or_else(|error| kit_error::unwind(error))
    }

    fn waited(&self) -> Duration {
        let process = lock(&self.running).as_ref().map(|child| lock(child).id());
        process.map_or(Duration::ZERO, waiting::waited)
    }
}

/// What a program has written to standard output and standard error.
type Output = Arc<Mutex<String>>;

struct Process {
    child: Arc<Mutex<Child>>,
    to_worker: Box<dyn Write + Send>,
    from_worker: Box<dyn Read + Send>,
    watchdog: Arc<Watchdog>,
    /// Reads what the process writes to standard error, until its end.
    stderr: Option<JoinHandle<String>>,
    output: Option<Output>,
    launcher: Option<Arc<dyn Launcher>>,
}

impl Process {
    fn start(
        program: &Path,
        launcher: Option<Arc<dyn Launcher>>,
        output: Option<Output>,
    ) -> io::Result<Process> {
        let own = || worker::child(program);
        let mut command = launcher.as_ref().map_or_else(own, |launcher| launcher.command(program));
        let (errors, stderr) = io::pipe()?;
        let stdout = if output.is_some() { Stdio::from(stderr.try_clone()?) } else { Stdio::null() };
        command.stdout(stdout).stderr(stderr);
        let (child, to_worker, from_worker) = spawn(command, launcher.as_deref())?;
        let child = Arc::new(Mutex::new(child));
        let kept = output.clone();
        let keep = move || {
            let start = keep_start(errors);
            kept.inspect(|kept| lock(kept).clone_from(&start));
            start
        };
        Ok(Process {
            watchdog: Watchdog::guard(&child, launcher.clone()),
            child,
            to_worker,
            from_worker,
            stderr: Some(std::thread::spawn(keep)),
            output,
            launcher,
        })
    }

    /// The processor time so far, of untrusted code. It is also known for a process that has ended and was not waited for.
    fn cpu_time(&self) -> Duration {
        self.launcher.as_ref().map_or(Duration::ZERO, |launcher| launcher.cpu_time(lock(&self.child).id()))
    }

    /// The reply to `request`; `None` if `watch` cancelled it. Questions are answered from `tables`.
    fn ask(
        &mut self,
        request: &Request,
        mut tables: Option<&mut Withheld<'_>>,
        watch: &dyn Watch,
        patience: Duration,
    ) -> io::Result<Option<Reply>> {
        let trusted = self.launcher.is_none();
        // Start the watchdog before writing, because a worker that does not read would block the write forever.
        self.watchdog.bark_after(patience);
        worker::send(&mut self.to_worker, request)?;
        let longest = if trusted { LONGEST_MESSAGE } else { longest_reply(request) };
        let refused = |why: &'static str| Err(io::Error::other(why));
        loop {
            match worker::receive_up_to(&mut self.from_worker, longest)? {
                Reply::Progress { .. } | Reply::Building { .. } if request.frame().is_none() => {
                    return refused("it reports the progress of a frame, but no frame was requested");
                }
                reply @ (Reply::Progress { .. } | Reply::Building { .. }) => {
                    match reply {
                        Reply::Building { placed, total } => watch.building(placed, total),
                        Reply::Progress { done, total } => watch.progress(done, total),
                        _ => {}
                    }
                    if watch.cancelled() {
                        return Ok(None);
                    }
                    // Do not extend the time of untrusted code, which could report progress forever.
                    if trusted {
                        self.watchdog.bark_after(patience);
                    }
                }
                // A tile is never the last message of a frame, so `progress` notices that it was cancelled.
                Reply::Tile(tile) => match request {
                    Request::RenderInTiles(job) if tile.fits(job.scene.film.width, job.scene.film.height) => {
                        watch.tile(&tile);
                    }
                    _ => return refused("it sends pixels that were not requested"),
                },
                Reply::Question(question) => match &mut tables {
                    Some(tables) => worker::send(&mut self.to_worker, &tables.answer(&question))?,
                    None => return refused("it asks a question, but its request has all tables"),
                },
                reply => {
                    self.watchdog.rest();
                    return Ok(Some(reply));
                }
            }
        }
    }

    /// The reason why the process does not answer, or what is wrong with its reply.
    fn post_mortem(mut self, error: &io::Error, patience: Duration) -> KitError {
        let late = self.watchdog.reason();
        // This kind of error means a refused message; errors of the pipe have other kinds.
        let malformed = late.is_none() && error.kind() == io::ErrorKind::Other;
        // The pipe may close a moment before the process ends, so wait briefly for its own exit status.
        let status = if malformed { None } else { wait_briefly(&self.child) };
        let _ = lock(&self.child).kill();
        let status = status.or_else(|| lock(&self.child).wait().ok());
        self.to_worker = Box::new(io::sink());
        self.from_worker = Box::new(io::empty());
        let stderr = self.stderr.take().and_then(|words| words.join().ok()).unwrap_or_default();
        if let Some(late) = late {
            return late;
        }
        if malformed {
            return KitError::Malformed { what: error.to_string() };
        }
        cause_of_death(status, &stderr, self.launcher.as_deref(), patience)
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        // End exactly this process and wait for it, so that no process remains.
        let mut child = lock(&self.child);
        let _ = child.kill();
        let _ = child.wait();
        drop(child);
        self.watchdog.retire();
        if self.output.is_some() {
            let _ = self.stderr.take().map(JoinHandle::join);
        }
    }
}

type Pipes = (Child, Box<dyn Write + Send>, Box<dyn Read + Send>);

#[cfg(unix)]
fn spawn(mut command: Command, launcher: Option<&dyn Launcher>) -> io::Result<Pipes> {
    use std::os::fd::OwnedFd;
    use std::os::unix::net::UnixStream;
    let (ours, theirs) = UnixStream::pair()?;
    // The command holds `theirs` until it is dropped. Then only the worker holds it, so we read an end of
    // file when the worker ends.
    command.stdin(Stdio::from(OwnedFd::from(theirs)));
    let child = match launcher {
        Some(launcher) => launcher.spawn(command)?,
        None => spawn_when_written(&mut command)?,
    };
    let writer = ours.try_clone()?;
    Ok((child, Box::new(BufWriter::new(writer)), Box::new(BufReader::new(ours))))
}

/// Starts a program that has just been written. For a moment another thread of this process may have it open for writing: in a
/// process that it is about to start, which has inherited the file.
#[cfg(unix)]
fn spawn_when_written(command: &mut Command) -> io::Result<Child> {
    let begin = std::time::Instant::now();
    loop {
        match command.spawn() {
            Err(error)
                if error.kind() == io::ErrorKind::ExecutableFileBusy
                    && begin.elapsed() < Duration::from_secs(2) =>
            {
                std::thread::sleep(Duration::from_millis(10));
            }
            result => return result,
        }
    }
}

#[cfg(not(unix))]
fn spawn(mut command: Command, _: Option<&dyn Launcher>) -> io::Result<Pipes> {
    let mut child = command.stdin(Stdio::piped()).stdout(Stdio::piped()).spawn()?;
    let (Some(stdin), Some(stdout)) = (child.stdin.take(), child.stdout.take()) else {
        return Err(io::Error::other("no pipes"));
    };
    Ok((child, Box::new(BufWriter::new(stdin)), Box::new(BufReader::new(stdout))))
}
