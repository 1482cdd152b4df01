//! One run: compile the exercises, then run the checks of a stage, or render its picture. Everything happens in processes of
//! its own, so that a save can end a run at any time, also if the code of the student never ends.

use anyhow::Result;
use live::compiler::{Compiled, CompilerError, compile};
use live::course::judge;
use live::process::Process;
use raykata::frame::Watch;
use raykata::worker::child;
use raykata_cli::finish::{self, Picture};
use raykata_cli::kits::{Need, Program, Which, cargo_build, profile};
use raykata_cli::report::words_of_building;
use raykata_cli::verdicts::CheckVerdict;
use raykata_cli::worker::{CALL_PATIENCE, Worker};
use std::io::Read;
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::time::{Duration, Instant};

/// The time between two looks at the files.
pub const PAUSE: Duration = Duration::from_millis(150);

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
    /// How far a picture is, in words.
    Progress(String),
    /// A picture is finished.
    Picture(Picture),
    /// What `raykata try` prints.
    Tried(String),
    /// The run cannot go on, for this reason.
    Broken(String),
}

/// What a run does after it has compiled the exercises.
#[derive(Clone, Debug, PartialEq)]
pub enum Task {
    /// Runs the checks of these stages, one stage after the other.
    Check(Vec<u8>),
    /// Renders the scene of a stage to this file, from the root of the kit.
    Render(u8, String),
    /// Repeats the call of the message of a check, as `raykata try` does.
    Try(&'static str),
}

/// Where the kit and its programs are.
#[derive(Clone)]
pub struct Paths {
    /// The folder of the kit.
    pub root: PathBuf,
    /// The program that runs the checks.
    pub judge: PathBuf,
}

/// A run. It is cancelled when it is dropped.
pub struct Run {
    process: Arc<Process>,
    /// What it reports. Each run has its own events, so those of a cancelled run are gone.
    pub events: Receiver<Event>,
    /// Keeps the channel open, so that a reader can wait for a time without events.
    _sender: Sender<Event>,
}

impl Run {
    /// Starts a run.
    pub fn start(paths: Paths, task: Task) -> Run {
        let process = Arc::new(Process::default());
        let (sender, events) = channel();
        let (own, _sender) = (process.clone(), sender.clone());
        std::thread::spawn(move || {
            // The receiver is gone if the run was cancelled.
            let report = |event| _ = sender.send(event);
            if let Err(error) = work(&paths, task, &own, &report) {
                report(Event::Broken(format!("{error:#}")));
            }
        });
        Run { process, events, _sender }
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        self.process.end();
    }
}

/// Does the work of a run.
fn work(paths: &Paths, task: Task, process: &Process, report: &(impl Fn(Event) + Sync)) -> Result<()> {
    // Compile the exercises.
    let begin = Instant::now();
    let need = match task {
        Task::Check(_) | Task::Try(_) => Need::Checks,
        Task::Render(..) => Need::Frames,
    };
    let worker = Program::worker(Which::Exercises, need);
    let mut cargo = cargo_build(&paths.root, &[worker])?;
    // Compile for checks as `cargo test` does: without optimisation and incrementally, which takes a fifth of the time.
    if !matches!(task, Task::Render(..)) && profile().is_none() {
        cargo.args(["--profile", "test"]);
    }
    let worker = match compile(process, cargo, worker)? {
        Some(Compiled::Program(worker)) => worker,
        Some(Compiled::Errors(errors)) => {
            report(Event::Errors(errors));
            return Ok(());
        }
        None => return Ok(()),
    };
    report(Event::Compiled(begin.elapsed()));
    match task {
        Task::Check(stages) => stages.iter().try_for_each(|&stage| {
            let begin = Instant::now();
            let verdict = |verdict| report(Event::Verdict(verdict));
            if judge(process, &paths.judge, [&paths.root, &worker], stage, verdict)? {
                report(Event::Checked(stage, begin.elapsed()));
            }
            Ok(())
        }),
        Task::Try(check) => {
            let mut command = child(&paths.judge);
            command.arg("try").arg(&paths.root).arg(&worker).arg(check);
            let mut tried = String::new();
            process.follow(command, |out| Ok(_ = out.read_to_string(&mut tried)?))?;
            report(Event::Tried(tried));
            Ok(())
        }
        Task::Render(stage, file) => {
            let kit = process.start_kit(Worker::new(worker, CALL_PATIENCE).with_short_frames());
            let picture = finish::render(&paths.root, stage, &file, &*kit, &FrameProgress(report));
            if !process.is_over() {
                report(Event::Picture(picture?));
            }
            Ok(())
        }
    }
}

/// Reports the progress of a frame in words.
struct FrameProgress<'a, F>(&'a F);

impl<F: Fn(Event) + Sync> Watch for FrameProgress<'_, F> {
    fn progress(&self, done: u64, total: u64) {
        self.0(Event::Progress(format!("{} % of the pixels", 100 * done / total.max(1))));
    }

    fn building(&self, placed: u64, total: u64) {
        self.0(Event::Progress(words_of_building(placed, total)));
    }
}
