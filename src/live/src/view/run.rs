//! One run: compile the exercises and render the scene, from coarse to fine. Everything happens in processes, so that a save can
//! end a run at any time, also if the code of the student never ends.
//!
//! Optimised code takes many times as long to compile as code without optimisation, and renders about ten times as fast. So a
//! run compiles twice: first without optimisation, for a coarse picture and one with a sample per pixel, and then with
//! optimisation, for the finished picture.

use super::quick_tree::quickly_built;
use super::reference::{Origin, Reference};
use super::studio::{Kit, PATIENCE, Pass, Studio, job};
use anyhow::{Context, Result, anyhow, bail};
use live::compiler::{Compiled, compile};
use live::course::{judge, keep, stages};
use live::process::Process;
use raykata::frame::{Tile, Unwatched, Watch};
use raykata::kit::{Door, Frames, RenderJob, Rendering, View, kit_error};
use raykata::scene::Scene;
use raykata_cli::finish::{self, encoded};
use raykata_cli::kits::{Need, Program, Which, cargo_build, profile};
use raykata_cli::queue::lock;
use raykata_cli::report::{Thousands, read_scene, words_of_building};
use raykata_cli::verdicts::{CheckVerdict, Verdict};
use raykata_cli::worker::Worker;
use serde_json::json;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// The longest time that the coarse picture has all processors for itself.
const HEAD_START: Duration = Duration::from_secs(2);

/// The time without a pixel after which the checks look for a function that does not end.
const SILENCE: Duration = Duration::from_secs(10);

const COARSE: Pass = Pass { name: "coarse", scale: 4 };
const SINGLE: Pass = Pass { name: "one sample per pixel", scale: 1 };
const FINAL: Pass = Pass { name: "all samples", scale: 1 };

/// A run. It is cancelled when it is dropped.
pub struct Run(Arc<Work>);

/// What a run does at the moment.
struct Work {
    studio: Arc<Studio>,
    number: u64,
    /// The build without optimisation, and the one with it.
    builds: [Process; 2],
    /// The kits that work at the moment.
    kits: Mutex<Vec<Kits>>,
    is_over: AtomicBool,
    /// The optimised code takes over.
    is_quick_over: AtomicBool,
    /// The optimised code has finished some pixels, or a part of a structure.
    moves: AtomicBool,
}

/// The kits of a picture.
#[derive(Clone)]
struct Kits {
    /// Renders.
    renderer: Kit,
    /// Encodes colours, and answers questions about pixels. It answers them also after the run, as long as the picture is shown.
    helper: Kit,
}

impl Kits {
    fn end(&self) {
        self.renderer.0.retire();
        self.helper.0.stop();
    }
}

impl Run {
    /// Starts a run, which reports to the studio.
    pub fn start(studio: Arc<Studio>, number: u64, file: PathBuf) -> Run {
        let work = Arc::new(Work {
            studio,
            number,
            builds: Default::default(),
            kits: Mutex::default(),
            is_over: AtomicBool::new(false),
            is_quick_over: AtomicBool::new(false),
            moves: AtomicBool::new(false),
        });
        let own = work.clone();
        std::thread::spawn(move || {
            if let Err(error) = own.everything(&file) {
                own.fail(&error);
            }
        });
        Run(work)
    }
}

impl Drop for Run {
    fn drop(&mut self) {
        self.0.end();
    }
}

impl Work {
    fn is_over(&self) -> bool {
        self.is_over.load(Ordering::Relaxed)
    }

    fn end(&self) {
        self.is_over.store(true, Ordering::Relaxed);
        self.builds.iter().for_each(Process::end);
        lock(&self.kits).drain(..).for_each(|kits| kits.end());
    }

    /// Shows why there is no picture, and ends the run. A run that was cancelled fails silently.
    fn fail(&self, error: &anyhow::Error) {
        if !self.is_over() {
            self.studio.failure(self.number, &format!("{error:#}"));
            self.end();
        }
    }

    /// Kits that run this program, and end with the run. If `is_over` holds already, they are ended at once.
    fn start_kits(&self, program: &Path, is_over: &dyn Fn() -> bool) -> Kits {
        let kit = || Arc::new(Door(Worker::new(program.to_owned(), PATIENCE)));
        let new = Kits { renderer: kit(), helper: kit() };
        // Ask under the lock: whoever ends the run sets the flag first, and ends the kits of the list afterwards.
        let mut kits = lock(&self.kits);
        if is_over() {
            new.end();
        } else {
            kits.push(new.clone());
        }
        new
    }

    /// Compiles and renders.
    fn everything(self: &Arc<Self>, file: &Path) -> Result<()> {
        // Read the scene.
        let scene = Arc::new(read_scene(file)?);
        let name = file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        let recorded = Reference::recorded(&self.studio.root, &name, &scene);
        self.studio.begin(self.number, &scene, recorded.map(Arc::new));
        // Compile the exercises without optimisation.
        self.studio.status(self.number, "compiling", "compiling your code");
        let begin = Instant::now();
        let Some(program) = self.compile(true)? else { return Ok(()) };
        let compiled = begin.elapsed();
        // The errors of earlier runs are gone, because the code compiles.
        self.studio.problems(self.number, Vec::new(), "");
        // Compile them with optimisation, after the coarse picture or a moment.
        let (coarse_is_there, wait) = channel();
        let other = self.clone();
        let (other_file, other_scene) = (file.to_owned(), scene.clone());
        std::thread::spawn(move || {
            if let Err(error) = other.fully(&wait, &other_file, &other_scene, compiled) {
                other.fail(&error);
            }
        });
        let rendered = self.quickly(&program, &scene, &coarse_is_there);
        // The processes of this kit may be ended by the other thread.
        if self.is_quick_over.load(Ordering::Relaxed) { Ok(()) } else { rendered }
    }

    /// Renders with code that is not optimised.
    fn quickly(&self, program: &Path, scene: &Scene, coarse_is_there: &Sender<()>) -> Result<()> {
        let is_over = || self.is_over() || self.is_quick_over.load(Ordering::Relaxed);
        let kits = self.start_kits(program, &is_over);
        self.studio.answered_by(self.number, &kits.helper);
        let mut job = job(scene, View::Shaded, false);
        job.scene.quality.samples_per_pixel = 1;
        let film = &mut job.scene.film;
        let (width, height) = (film.width, film.height);
        (film.width, film.height) = (width.div_ceil(COARSE.scale), height.div_ceil(COARSE.scale));
        // Take a structure that is quickly built; if that fails, take that of the scene.
        let own = job.scene.quality;
        if let Some(quick) = quickly_built(&self.studio.root, &own) {
            job.scene.quality = quick;
        }
        let mut coarse = self.render(&kits, &job, COARSE, &is_over);
        if coarse.is_err() && job.scene.quality != own {
            job.scene.quality = own;
            coarse = self.render(&kits, &job, COARSE, &is_over);
        }
        let coarse = coarse?;
        let _ = coarse_is_there.send(());
        if coarse.is_some() {
            (job.scene.film.width, job.scene.film.height) = (width, height);
            self.render(&kits, &job, SINGLE, &is_over)?;
        }
        Ok(())
    }

    /// Compiles with optimisation, renders the finished picture, runs the checks of its stage, and then renders the reference if
    /// there are solutions.
    fn fully(&self, wait: &Receiver<()>, file: &Path, scene: &Scene, compiled: Duration) -> Result<()> {
        let _ = wait.recv_timeout(HEAD_START);
        let Some(program) = self.compile(false)? else { return Ok(()) };
        if self.is_over() {
            return Ok(());
        }
        // Let the optimised code take over.
        self.is_quick_over.store(true, Ordering::Relaxed);
        let earlier: Vec<Kits> = lock(&self.kits).drain(..).collect();
        let kits = self.start_kits(&program, &|| self.is_over());
        self.studio.answered_by(self.number, &kits.helper);
        // End the others now, because a question that one of them answers at the moment goes to the new one.
        earlier.iter().for_each(Kits::end);
        let job = job(scene, View::Shaded, true);
        let (waits, ends) = channel::<()>();
        let rendered = std::thread::scope(|scope| {
            scope.spawn(|| self.seek_endless_loop(ends, file, &program));
            let rendered = self.render(&kits, &job, FINAL, &|| self.is_over());
            drop(waits);
            rendered
        })?;
        let Some(rendering) = rendered else { return Ok(()) };
        let facts = facts(&rendering, compiled);
        self.studio.finished(self.number, facts.clone());
        if let Err(error) = self.finish(file, &program, (&job.scene, &rendering), &kits.helper, facts) {
            let words = format!("the picture is finished, but its stage is not checked: {error:#}");
            self.studio.status(self.number, "done", &words);
        }
        if !self.studio.rendered_reference(self.number) && self.studio.root.join("solutions").is_dir() {
            self.reference(&job)?;
        }
        Ok(())
    }

    /// Runs the checks of the stage that the scene belongs to. If all pass, the picture is kept in the album, and the page says
    /// what it cost and what comes next.
    fn finish(
        &self,
        file: &Path,
        program: &Path,
        (scene, rendering): (&Scene, &Rendering),
        kit: &Door<Worker>,
        mut facts: serde_json::Value,
    ) -> Result<()> {
        let root = &self.studio.root;
        let mut stages = stages();
        let Some(at) = stages.iter().position(|stage| self.shows(stage.number, file)) else { return Ok(()) };
        let number = stages[at].number;
        let working = format!("the picture is finished, and the checks of stage {number} run");
        self.studio.status(self.number, "checking", &working);
        if self.judge(number, program, |verdict| keep(&mut stages, verdict))? && stages[at].is_done() {
            let album = finish::file_of(number, true);
            let picture = finish::keep(root, &album, scene, rendering, kit)?;
            let lines = picture.lines.into_iter().chain([finish::next_step(number)]);
            facts["done"] = json!({ "stage": number, "lines": lines.collect::<Vec<_>>() });
        }
        self.studio.finished(self.number, facts);
        Ok(())
    }

    /// Whether this is the scene of a stage.
    fn shows(&self, stage: u8, file: &Path) -> bool {
        finish::scene_of(&self.studio.root, stage).canonicalize().ok() == file.canonicalize().ok()
    }

    /// Runs the checks of a stage; `false` if the run is over.
    fn judge(&self, stage: u8, program: &Path, report: impl FnMut(CheckVerdict)) -> Result<bool> {
        let (root, process) = (&self.studio.root, &self.builds[1]);
        match compile(process, cargo_build(root, &[Program::JUDGE])?, Program::JUDGE)? {
            Some(Compiled::Program(path)) => judge(process, &path, [root, program], stage, report),
            _ => Ok(false),
        }
    }

    /// If a picture has no pixel for a while, runs the checks of its stage, and shows the first one that gets no answer.
    fn seek_endless_loop(&self, ends: Receiver<()>, file: &Path, program: &Path) {
        let waited = ends.recv_timeout(SILENCE) == Err(RecvTimeoutError::Timeout);
        let Some(stage) = stages().into_iter().find(|stage| self.shows(stage.number, file)) else { return };
        if !waited || self.moves.load(Ordering::Relaxed) {
            return;
        }
        let words = format!("no pixel yet: do the functions end? The checks of stage {} run", stage.number);
        self.studio.status(self.number, "rendering", &words);
        let _ = self.judge(stage.number, program, |CheckVerdict { verdict, .. }| match verdict {
            Verdict::Failed(message) if message.contains("no answer after") => self.fail(&anyhow!(message)),
            _ => {}
        });
    }

    /// Renders a frame and shows its tiles; `None` if it was cancelled.
    fn render(
        &self,
        kits: &Kits,
        job: &RenderJob,
        pass: Pass,
        is_over: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<Rendering>> {
        let words = format!("rendering, {}", pass.name);
        self.studio.status(self.number, "rendering", &words);
        let watch = Tiles { work: self, helper: &kits.helper, pass, is_over };
        let rendering = kit_error::catch(|| kits.renderer.render(job, &watch));
        if is_over() { Ok(None) } else { Ok(rendering?) }
    }

    /// Renders the reference.
    fn reference(&self, job: &RenderJob) -> Result<()> {
        let worker = Program::worker(Which::Solutions, Need::Frames);
        let cargo = cargo_build(&self.studio.root, &[worker])?;
        let program = match compile(&self.builds[1], cargo, worker)? {
            Some(Compiled::Program(program)) => program,
            Some(Compiled::Errors(_)) => bail!("the solutions do not compile"),
            None => return Ok(()),
        };
        let kit = self.start_kits(&program, &|| self.is_over()).renderer;
        let rendered = kit_error::catch(|| kit.render(job, &Unwatched));
        if self.is_over() {
            return Ok(());
        }
        if let Some(Rendering { film, .. }) = rendered? {
            let rgb = encoded(&job.scene, &film, &*kit);
            let (width, height) = (film.width, film.height);
            self.studio
                .reference(self.number, Reference { width, height, scale: 1, rgb, origin: Origin::Rendered });
        }
        Ok(())
    }

    /// Compiles the exercises and returns a copy of the program; `None` if that fails, which the page shows, or if the run is
    /// over.
    fn compile(&self, quick: bool) -> Result<Option<PathBuf>> {
        let worker = Program::worker(Which::Exercises, Need::Frames);
        let mut cargo = cargo_build(&self.studio.root, &[worker])?;
        if quick {
            // Compile the exercises as `cargo test` does: without optimisation, and only what has changed.
            let profile = profile().unwrap_or("dev".into());
            for setting in ["opt-level=0", "incremental=true", "codegen-units=64"] {
                cargo.arg("--config").arg(format!("profile.{profile}.package.exercises.{setting}"));
            }
        }
        match compile(&self.builds[usize::from(!quick)], cargo, worker)? {
            Some(Compiled::Program(program)) => {
                Ok(Some(copied(&program, if quick { "exercises-quick" } else { "exercises-full" })?))
            }
            Some(Compiled::Errors(errors)) => {
                self.studio.errors(self.number, errors);
                Ok(None)
            }
            None => Ok(None),
        }
    }
}

/// The folder of copies of programs, beside the programs themselves.
const COPIES: &str = "programs-of-view";

/// Copies a program, because the next build replaces it. Each process of `view` has copies of its own: two may show two scenes.
fn copied(program: &Path, name: &str) -> Result<PathBuf> {
    let folder = program.parent().context("the program is in no folder")?.join(COPIES);
    std::fs::create_dir_all(&folder).context("the folder for the program cannot be created")?;
    let copy = folder.join(format!("{name}-{}{}", std::process::id(), std::env::consts::EXE_SUFFIX));
    if !copy.exists() {
        remove_old_copies(&folder);
    }
    let _ = std::fs::remove_file(&copy);
    std::fs::copy(program, &copy).with_context(|| format!("cannot write {}", copy.display()))?;
    Ok(copy)
}

/// Removes copies that no process of `view` has renewed for a day. One that is still in use only starts again at its next save.
fn remove_old_copies(folder: &Path) {
    const DAY: Duration = Duration::from_secs(24 * 3600);
    for file in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let age = file.metadata().and_then(|data| data.modified()).ok().and_then(|time| time.elapsed().ok());
        if age.is_some_and(|age| age > DAY) {
            let _ = std::fs::remove_file(file.path());
        }
    }
}

/// What a finished picture cost and lacks.
fn facts(rendering: &Rendering, compiled: Duration) -> serde_json::Value {
    let counts = &rendering.counts;
    let rays = counts.rays();
    json!({
        "notes": rendering.notes, "levels": rendering.structure.map_or(0, |size| size.levels),
        "rows": [
            ["primitives", Thousands(rendering.primitives).to_string()],
            ["nodes of the structure", rendering.structure.map_or("none".into(), |size| Thousands(size.nodes).to_string())],
            ["rays", Thousands(rays).to_string()],
            ["node visits per ray", format!("{:.1}", counts.node_visits as f64 / rays.max(1) as f64)],
            ["primitive tests per ray", format!("{:.1}", counts.primitive_tests as f64 / rays.max(1) as f64)],
            ["compile, without optimisation", format!("{:.1} s", compiled.as_secs_f64())],
            ["build the structure", format!("{:.2} s", rendering.build_seconds)],
            ["render", format!("{:.2} s", rendering.render_seconds)],
        ],
    })
}

/// Passes tiles on to the studio.
struct Tiles<'a> {
    work: &'a Work,
    helper: &'a Kit,
    pass: Pass,
    is_over: &'a (dyn Fn() -> bool + Sync),
}

impl Watch for Tiles<'_> {
    fn progress(&self, _: u64, _: u64) {}

    fn building(&self, placed: u64, total: u64) {
        if !(self.is_over)() {
            self.work.moves.fetch_or(self.pass == FINAL && placed > 0, Ordering::Relaxed);
            self.work.studio.status(self.work.number, "building", &words_of_building(placed, total));
        }
    }

    fn wants_tiles(&self) -> bool {
        true
    }

    fn tile(&self, tile: &Tile) {
        if !(self.is_over)() {
            self.work.moves.fetch_or(self.pass == FINAL, Ordering::Relaxed);
            self.work.studio.tile(self.work.number, self.pass, tile, self.helper);
        }
    }

    fn cancelled(&self) -> bool {
        (self.is_over)()
    }
}
