//! One run: compile the exercises, then run the checks of a stage, or render its picture. Everything happens in processes of
//! its own, so that a save can end a run at any time, also if the code of the student never ends.

use crate::compiler::{CompilerError, error_in};
use crate::pixels::Pixels;
use anyhow::{Context, Result, bail};
use raykata::worker::receive;
use raykata_cli::kits::{Need, Program, Which, cargo_build};
use raykata_cli::verdicts::CheckVerdict;
use std::io::{BufRead, BufReader, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::Sender;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// What a run reports.
#[derive(Debug)]
pub enum Event {
    /// A check has a verdict.
    Verdict(CheckVerdict),
    /// The compiler has finished without errors.
    Compiled(Duration),
    /// The exercises do not compile.
    Errors(Vec<CompilerError>),
    /// All checks of this stage have a verdict.
    Checked(u8, Duration),
    /// A picture is finished.
    Picture(Pixels),
    /// The run cannot go on, for this reason.
    Broken(String),
}

/// An event, and the number of its run. Events of a run that was cancelled may still arrive.
pub struct Report {
    /// The number of the run.
    pub run: u64,
    /// What happened.
    pub event: Event,
}

/// What a run does after it has compiled the exercises.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Task {
    /// Runs the checks of a stage.
    Check(u8),
    /// Renders the scene of a stage, with this many pixels in width and height.
    Render(u8, u32, u32),
}

/// A run. It is cancelled when it is dropped.
pub struct Run(Arc<Process>);

/// The process of a run at the moment.
#[derive(Default)]
struct Process {
    is_over: AtomicBool,
    child: Mutex<Option<Child>>,
}

impl Run {
    /// Starts a run, which reports to `reports`.
    pub fn start(root: PathBuf, task: Task, run: u64, reports: Sender<Report>) -> Run {
        let process = Arc::new(Process::default());
        let own = process.clone();
        std::thread::spawn(move || {
            // The receiver is gone only when the program ends.
            let report = |event| _ = reports.send(Report { run, event });
            if let Err(error) = work(&root, task, &own, &report) {
                report(Event::Broken(format!("{error:#}")));
            }
        });
        Run(process)
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        self.0.is_over.store(true, Ordering::Relaxed);
        if let Some(child) = &mut *self.0.child() {
            end(child);
        }
    }
}

/// Ends a process and those that it has started.
#[cfg(unix)]
fn end(child: &mut Child) {
    use nix::sys::signal::{Signal, killpg};
    use nix::unistd::Pid;
    if let Ok(id) = i32::try_from(child.id()) {
        let _ = killpg(Pid::from_raw(id), Signal::SIGKILL);
    }
    let _ = child.wait();
}

#[cfg(not(unix))]
fn end(child: &mut Child) {
    let _ = child.kill();
    let _ = child.wait();
}

impl Process {
    fn child(&self) -> std::sync::MutexGuard<'_, Option<Child>> {
        self.child.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Starts a process, reads what it writes, and returns whether it succeeded and what it wrote to standard error.
    /// `Ok(None)` if the run is over.
    fn follow(
        &self,
        mut command: Command,
        read: impl FnOnce(&mut BufReader<std::process::ChildStdout>) -> Result<()>,
    ) -> Result<Option<(bool, String)>> {
        // Give the process a group of its own, so that `end` reaches those that it starts.
        #[cfg(unix)]
        std::os::unix::process::CommandExt::process_group(&mut command, 0);
        command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
        // Start it under the lock, so that a cancel before this sees no child and prevents it, and one after this ends it.
        let mut slot = self.child();
        if self.is_over.load(Ordering::Relaxed) {
            return Ok(None);
        }
        let name = command.get_program().to_string_lossy().into_owned();
        let child = command.spawn().with_context(|| format!("{name} cannot be started"))?;
        let child = slot.insert(child);
        let stdout = child.stdout.take().context("no standard output")?;
        let mut stderr = child.stderr.take().context("no standard error")?;
        drop(slot);
        let words = std::thread::spawn(move || {
            let mut bytes = Vec::new();
            let _ = stderr.read_to_end(&mut bytes);
            String::from_utf8_lossy(&bytes).into_owned()
        });
        let result = read(&mut BufReader::new(stdout));
        let words = words.join().unwrap_or_default();
        let Some(mut child) = self.child().take().filter(|_| !self.is_over.load(Ordering::Relaxed)) else {
            return Ok(None);
        };
        let succeeded = child.wait()?.success();
        result?;
        Ok(Some((succeeded, words)))
    }
}

/// Does the work of a run.
fn work(root: &Path, task: Task, process: &Process, report: &impl Fn(Event)) -> Result<()> {
    // Compile the exercises.
    let begin = Instant::now();
    let need = match task {
        Task::Check(_) => Need::Checks,
        Task::Render(..) => Need::Frames,
    };
    let (mut cargo, programs) = cargo_build(root, &[Program::worker(Which::Exercises, need)])?;
    cargo.arg("--message-format=json");
    let mut errors = Vec::new();
    let lines = |out: &mut BufReader<_>| {
        errors.extend(out.lines().map_while(Result::ok).filter_map(|line| error_in(&line)));
        Ok(())
    };
    let Some((compiled, words)) = process.follow(cargo, lines)? else { return Ok(()) };
    if !compiled {
        if errors.is_empty() {
            bail!("the exercises cannot be built:\n{}", words.trim());
        }
        report(Event::Errors(errors));
        return Ok(());
    }
    report(Event::Compiled(begin.elapsed()));
    let [worker] = &programs[..] else { bail!("the worker was not built") };
    match task {
        Task::Check(stage) => check(root, worker, stage, process, report),
        Task::Render(stage, width, height) => render(root, stage, (width, height), process, report),
    }
}

/// Lets the judge run the checks of a stage.
fn check(root: &Path, worker: &Path, stage: u8, process: &Process, report: &impl Fn(Event)) -> Result<()> {
    let begin = Instant::now();
    let judge = worker.with_file_name(format!("judge{}", std::env::consts::EXE_SUFFIX));
    let mut command = Command::new(judge);
    command.arg("verdicts").arg(root).arg(worker).arg(stage.to_string());
    let verdicts = |out: &mut BufReader<_>| loop {
        match receive::<CheckVerdict>(out) {
            Ok(verdict) => report(Event::Verdict(verdict)),
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Ok(()),
            Err(error) => return Err(error).context("the judge is not understood"),
        }
    };
    match process.follow(command, verdicts)? {
        None => {}
        Some((true, _)) => report(Event::Checked(stage, begin.elapsed())),
        Some((false, words)) => bail!("the judge has failed: {}", words.trim()),
    }
    Ok(())
}

/// Renders the scene of a stage in the size of the terminal.
fn render(
    root: &Path,
    stage: u8,
    (width, height): (u32, u32),
    process: &Process,
    report: &impl Fn(Event),
) -> Result<()> {
    let scene = scene_of(root, stage);
    let out = root.join("out/watch.png");
    let here = std::env::current_exe().context("the path of this program is unknown")?;
    let raykata = here.with_file_name(format!("raykata{}", std::env::consts::EXE_SUFFIX));
    let mut command = Command::new(raykata);
    command.current_dir(root).arg("render").arg(&scene).arg("--out").arg(&out);
    command.args(["--kit", "exercises", "--size", &format!("{width}x{height}"), "--spp", "1"]);
    let nothing = |out: &mut BufReader<_>| Ok(_ = std::io::copy(out, &mut std::io::sink())?);
    match process.follow(command, nothing)? {
        None => {}
        Some((true, _)) => report(Event::Picture(Pixels::read(&out, width)?)),
        Some((false, words)) => bail!("{}", words.trim().trim_start_matches("error: ")),
    }
    Ok(())
}

/// The scene that shows what a stage adds.
fn scene_of(root: &Path, stage: u8) -> PathBuf {
    let own = root.join(format!("scenes/stage{stage}.toml"));
    let file = match stage {
        _ if own.is_file() => return own,
        11 => "cornell.toml",
        _ => "showcase.toml",
    };
    root.join("scenes").join(file)
}
