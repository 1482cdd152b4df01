//! One run: compile the exercises, then run the checks of a stage, or render its picture. Everything happens in processes of
//! its own, so that a save can end a run at any time, also if the code of the student never ends.

use crate::pixels::Pixels;
use anyhow::{Context, Result, bail};
use image::RgbImage;
use live::compiler::{Compiled, CompilerError, compile};
use live::picture::{encoded, read_scene};
use live::process::Process;
use live::scene_of;
use raykata::frame::Watch;
use raykata::kit::{Frames, kit_error};
use raykata::worker::receive;
use raykata_cli::kits::{Need, Program, Which, cargo_build, profile};
use raykata_cli::report::{job, make_folder_of, words_of_building};
use raykata_cli::verdicts::CheckVerdict;
use raykata_cli::worker::{CALL_PATIENCE, Worker};
use std::io::{BufReader, ErrorKind, Read};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
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
    /// How far a picture is, in words.
    Progress(String),
    /// A picture is finished.
    Picture(Pixels),
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
    /// Renders the scene of a stage, with this many pixels in width and height.
    Render(u8, u32, u32),
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
            if process.is_over() { Ok(()) } else { check(paths, &worker, stage, process, report) }
        }),
        Task::Try(check) => {
            let mut command = Command::new(&paths.judge);
            command.arg("try").arg(&paths.root).arg(&worker).arg(check);
            let mut tried = String::new();
            process.follow(command, |out| Ok(_ = out.read_to_string(&mut tried)?))?;
            report(Event::Tried(tried));
            Ok(())
        }
        Task::Render(stage, width, height) => {
            render(&paths.root, &worker, (stage, width, height), process, report)
        }
    }
}

/// Lets the judge run the checks of a stage.
fn check(paths: &Paths, worker: &Path, stage: u8, process: &Process, report: &impl Fn(Event)) -> Result<()> {
    let begin = Instant::now();
    let mut command = Command::new(&paths.judge);
    command.arg("verdicts").arg(&paths.root).arg(worker).arg(stage.to_string());
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

/// Renders the scene of a stage in the size of the terminal, with one sample per pixel.
fn render(
    root: &Path,
    worker: &Path,
    (stage, width, height): (u8, u32, u32),
    process: &Process,
    report: &(impl Fn(Event) + Sync),
) -> Result<()> {
    let mut scene = read_scene(&scene_of(root, stage))?;
    (scene.film.width, scene.film.height, scene.quality.samples_per_pixel) = (width, height, 1);
    let kit = process.start_kit(Worker::new(worker.to_owned(), CALL_PATIENCE).with_short_frames());
    let rendered = kit_error::catch(|| kit.render(&job(scene.clone()), &FrameProgress(report)));
    if process.is_over() {
        return Ok(());
    }
    let film = rendered?.context("the frame was cancelled")?.film;
    let rgb = encoded(&scene, &film, &kit);
    let picture = RgbImage::from_raw(width, height, rgb).context("the picture has another size")?;
    let file = root.join("out/watch.png");
    make_folder_of(&file)?;
    picture.save(&file).with_context(|| format!("{} cannot be written", file.display()))?;
    report(Event::Picture(Pixels::of(&picture, width)));
    Ok(())
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
