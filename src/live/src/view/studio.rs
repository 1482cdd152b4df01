//! What is shown at the moment: the scene, the picture as far as it is rendered, and what went wrong. Pages get each change as
//! a message, and a page that opens gets everything.

use super::events::{Close, Pages, message};
use super::pixel;
use super::reference::{Origin, Reference};
use super::reports;
use super::run::Run;
use anyhow::{Context, Result, ensure};
use live::compiler::CompilerError;
use live::files::{Files, names_in};
use raykata::film::{Film, encode_srgb};
use raykata::frame::Tile;
use raykata::kit::{Door, Frames, RenderJob, View, kit_error};
use raykata::scene::Scene;
use raykata_cli::finish::encoded;
use raykata_cli::html::base64;
use raykata_cli::queue::lock;
use raykata_cli::report::render;
use raykata_cli::worker::Worker;
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::mpsc::Receiver;
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, SystemTime};

/// The time between two looks at the files.
const PAUSE: Duration = Duration::from_millis(100);

/// The longest time for the rays of a pixel or the boxes of a level. A structure may have to be built first.
pub const PATIENCE: Duration = Duration::from_secs(60);

/// A kit in a process of its own.
pub type Kit = Arc<Door<Worker>>;

/// The state of the page.
pub struct Studio {
    /// The folder of the kit.
    pub root: PathBuf,
    state: Mutex<State>,
    pages: Pages,
    run: Mutex<Option<Run>>,
}

struct State {
    /// The number of the run. What an earlier run sends is ignored.
    run: u64,
    file: PathBuf,
    /// The scene as it was read for this run.
    scene: Option<Arc<Scene>>,
    /// What is being done, in words.
    status: Value,
    errors: Vec<CompilerError>,
    /// Why there is no picture, if the compiler is not the reason.
    failure: String,
    facts: Value,
    /// The picture so far, in linear light, and as it is shown.
    film: Film,
    rgb: Vec<u8>,
    /// Answers questions about pixels with the code of the picture.
    kit: Option<Kit>,
    reference: Option<Arc<Reference>>,
}

/// Where the pixels of a tile belong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pass {
    /// What the pass is, in words.
    pub name: &'static str,
    /// The number of pixels of the picture that one pixel of the pass covers in each direction.
    pub scale: u32,
}

impl Studio {
    /// Shows this scene.
    pub fn new(root: PathBuf, file: PathBuf) -> Studio {
        let state = State {
            run: 0,
            file,
            scene: None,
            status: json!({ "phase": "starting", "words": "starting" }),
            errors: Vec::new(),
            failure: String::new(),
            facts: Value::Null,
            film: Film::new(0, 0),
            rgb: Vec::new(),
            kit: None,
            reference: None,
        };
        Studio { root, state: Mutex::new(state), pages: Pages::default(), run: Mutex::new(None) }
    }

    fn state(&self) -> MutexGuard<'_, State> {
        lock(&self.state)
    }

    /// Starts a run now and at each change of the exercises or of the scene.
    pub fn follow(self: &Arc<Self>) {
        let mut files = Files::new(live::exercises(&self.root));
        let mut shown = self.scene_time();
        self.start();
        loop {
            std::thread::sleep(PAUSE);
            let scene = self.scene_time();
            if files.have_changed() || scene != shown {
                shown = scene;
                self.start();
            }
        }
    }

    /// The file of the scene, and the time of its last change.
    fn scene_time(&self) -> (PathBuf, Option<SystemTime>) {
        let file = self.state().file.clone();
        let time = std::fs::metadata(&file).and_then(|about| about.modified()).ok();
        (file, time)
    }

    /// Cancels the run and starts another one.
    fn start(self: &Arc<Self>) {
        let mut run = lock(&self.run);
        drop(run.take());
        let (number, file) = {
            let mut state = self.state();
            state.run += 1;
            state.facts = Value::Null;
            (state.run, state.file.clone())
        };
        *run = Some(Run::start(self.clone(), number, file));
    }

    /// Ends all processes.
    pub fn stop(&self) {
        drop(lock(&self.run).take());
    }

    /// Shows another scene of the kit; `false` if there is none of this name.
    pub fn open(&self, name: &str) -> bool {
        let known = scenes(&self.root).iter().any(|scene| scene == name);
        if known {
            let mut state = self.state();
            // Another scene begins with an empty picture and its own reference, also if it is a copy.
            state.scene = None;
            state.file = self.root.join("scenes").join(format!("{name}.toml"));
        }
        known
    }

    /// Changes the state and sends the message that `change` returns, if the run is the current one.
    fn change(&self, run: u64, change: impl FnOnce(&mut State) -> (&'static str, Value)) {
        let mut state = self.state();
        if state.run == run {
            let (event, data) = change(&mut state);
            self.pages.publish(event, &data);
        }
    }

    /// Says what is being done.
    pub fn status(&self, run: u64, phase: &str, words: &str) {
        self.change(run, |state| {
            state.status = json!({ "run": run, "phase": phase, "words": words });
            ("status", state.status.clone())
        });
    }

    /// Replaces the errors of the compiler, and the other reason why there is no picture.
    pub fn problems(&self, run: u64, errors: Vec<CompilerError>, failure: &str) {
        self.change(run, |state| {
            (state.errors, state.failure) = (errors, failure.to_owned());
            ("errors", errors_of(state))
        });
    }

    /// Shows the errors of the compiler.
    pub fn errors(&self, run: u64, errors: Vec<CompilerError>) {
        self.problems(run, errors, "");
        self.status(run, "errors", "your code does not compile");
    }

    /// Says why there is no picture.
    pub fn failure(&self, run: u64, why: &str) {
        self.problems(run, Vec::new(), why);
        self.status(run, "failed", "there is no picture");
    }

    /// Begins the picture of a scene. If it has the size of the last picture, that stays until tiles replace it.
    pub fn begin(&self, run: u64, scene: &Arc<Scene>, reference: Option<Arc<Reference>>) {
        self.change(run, |state| {
            let (width, height) = (scene.film.width, scene.film.height);
            let is_same = state.scene.as_ref().is_some_and(|old| old == scene);
            if !is_same {
                state.film = Film::new(width, height);
                state.rgb = vec![0; 3 * width as usize * height as usize];
                state.reference = reference;
            }
            state.scene = Some(scene.clone());
            ("scene", scene_of(&self.root, state))
        });
    }

    /// The reference of the scene that is shown, if it was rendered.
    pub fn rendered_reference(&self, run: u64) -> bool {
        let state = self.state();
        state.run == run && state.reference.as_ref().is_some_and(|one| one.origin == Origin::Rendered)
    }

    /// Shows the reference.
    pub fn reference(&self, run: u64, reference: Reference) {
        self.change(run, |state| {
            state.reference = Some(Arc::new(reference));
            ("scene", scene_of(&self.root, state))
        });
    }

    /// Lets this kit answer questions about pixels.
    pub fn answered_by(&self, run: u64, kit: &Kit) {
        let mut state = self.state();
        if state.run == run {
            state.kit = Some(kit.clone());
        }
    }

    /// Shows a finished tile. The kit encodes its colours if the scene uses gamma 2, because that is an exercise.
    pub fn tile(&self, run: u64, pass: Pass, tile: &Tile, kit: &Door<Worker>) {
        let Some(scene) = self.state().scene.clone() else { return };
        let colors = Film { width: tile.width, height: 1, pixels: tile.pixels.clone() };
        let rgb = encoded(&scene, &colors, kit);
        self.change(run, |state| {
            let (width, height) = (state.film.width, state.film.height);
            for (index, color) in tile.pixels.iter().enumerate() {
                let (column, row) = (index as u32 % tile.width, index as u32 / tile.width);
                for y in 0..pass.scale {
                    for x in 0..pass.scale {
                        let (x, y) = ((tile.x + column) * pass.scale + x, (tile.y + row) * pass.scale + y);
                        if x < width && y < height {
                            let at = y as usize * width as usize + x as usize;
                            state.film.pixels[at] = *color;
                            state.rgb[3 * at..3 * at + 3].copy_from_slice(&rgb[3 * index..3 * index + 3]);
                        }
                    }
                }
            }
            let data = json!({
                "run": run, "pass": pass.name, "scale": pass.scale, "x": tile.x, "y": tile.y, "width": tile.width,
                "rgb": base64(&rgb),
            });
            ("tile", data)
        });
    }

    /// Shows what the finished picture cost and lacks.
    pub fn finished(&self, run: u64, facts: Value) {
        self.change(run, |state| {
            state.facts = facts;
            ("facts", state.facts.clone())
        });
        self.status(run, "done", "the picture is finished");
    }

    /// Opens a page: the messages that show the present state, and all later messages until `close` is called.
    pub fn subscribe(&self, close: Close) -> (Vec<String>, Receiver<Arc<str>>) {
        // Copy the state under its lock, and encode it afterwards.
        let state = self.state();
        let (scene, errors) = (scene_of(&self.root, &state), errors_of(&state));
        let (run, width, rgb) = (state.run, state.film.width, state.rgb.clone());
        let (status, facts, later) = (state.status.clone(), state.facts.clone(), self.pages.open(close));
        drop(state);
        let scenes = json!(scenes(&self.root));
        let whole = (width > 0).then(|| {
            json!({
                "run": run, "pass": "whole", "scale": 1, "x": 0, "y": 0, "width": width, "rgb": base64(&rgb),
            })
        });
        let before =
            [("scenes", scenes), ("scene", scene), ("errors", errors), ("status", status)].into_iter();
        let all = before.chain(whole.map(|whole| ("tile", whole))).chain([("facts", facts)]);
        (all.map(|(event, data)| message(event, &data)).collect(), later)
    }

    /// The reference picture.
    pub fn reference_picture(&self) -> Result<Value> {
        let reference = self.state().reference.clone().context("this scene has no reference")?;
        Ok(json!({
            "width": reference.width, "height": reference.height, "scale": reference.scale,
            "rgb": base64(&reference.rgb),
        }))
    }

    /// The difference to the reference, four times as bright, and the pixel that differs most.
    pub fn difference(&self) -> Result<Value> {
        let state = self.state();
        let reference = state.reference.clone().context("this scene has no reference")?;
        let scene = state.scene.clone().context("there is no picture yet")?;
        let difference = reference.difference(scene.film.tone, &state.film, &state.rgb)?;
        let command = command_of(&self.root, &state.file, difference.worst);
        Ok(json!({
            "width": reference.width, "height": reference.height, "scale": reference.scale,
            "rgb": base64(&difference.rgb), "worst": difference.worst, "yours": difference.yours,
            "expected": difference.expected, "differ": difference.differ,
            "total": reference.width * reference.height, "command": command,
        }))
    }

    /// The answer of the kit that is shown. If another one has replaced it meanwhile, which ends it, that one is asked again.
    fn ask(&self, question: impl Fn(&Arc<Scene>, &Kit, &Path) -> Result<Value>) -> Result<Value> {
        loop {
            let (scene, kit, file) = {
                let state = self.state();
                let scene = state.scene.clone().context("there is no picture yet")?;
                let kit = state.kit.clone().context("your code has not rendered this picture yet")?;
                (scene, kit, state.file.clone())
            };
            let answer = question(&scene, &kit, &file);
            let is_same = self.state().kit.as_ref().is_none_or(|now| Arc::ptr_eq(now, &kit));
            if answer.is_ok() || is_same {
                return answer;
            }
        }
    }

    /// The rays behind a pixel, and the boxes that are tested for them.
    pub fn pixel(&self, x: u32, y: u32) -> Result<Value> {
        self.ask(|scene, kit, file| {
            ensure!(x < scene.film.width && y < scene.film.height, "there is no pixel {x},{y}");
            let job = job(scene, View::Shaded, false);
            let rays = kit_error::catch(|| kit.visits(&job, x, y))?;
            Ok(json!({
                "x": x, "y": y, "command": command_of(&self.root, file, [x, y]),
                "rays": pixel::rays(scene, &rays),
            }))
        })
    }

    /// The outlines of the boxes or cells of a level of the structure.
    pub fn level(&self, depth: u32) -> Result<Value> {
        self.ask(|scene, kit, _| {
            let edges = kit_error::catch(|| kit.outlines(&job(scene, View::Shaded, false), depth))?;
            Ok(json!({ "depth": depth, "count": edges.len(), "lines": pixel::lines(scene, &edges) }))
        })
    }

    /// The node visits of each pixel as colours, with one sample per pixel; without a structure, its primitive tests.
    pub fn heat(&self) -> Result<Value> {
        self.ask(|scene, kit, _| heat(scene, kit))
    }

    /// The reports of `cost`, `compare` and `strip --stages`.
    pub fn reports(&self) -> Value {
        reports::list(&self.root, &self.state().file.clone())
    }
}

/// The work of each pixel as colours.
fn heat(scene: &Scene, kit: &Kit) -> Result<Value> {
    let mut job = job(scene, View::Work, true);
    job.scene.quality.samples_per_pixel = 1;
    let work = render(&**kit, &job)?;
    let has_visits = work.film.pixels.iter().any(|pixel| pixel.x > 0.0);
    let (what, channel) = if has_visits { ("node visits", 0) } else { ("primitive tests", 2) };
    let counts: Vec<f32> = work.film.pixels.iter().map(|pixel| pixel[channel]).collect();
    let most = counts.iter().copied().fold(1.0, f32::max);
    let color = |count: &f32| raykata_cli::compare::heat_color(*count, most).to_array().map(encode_srgb);
    let rgb: Vec<u8> = counts.iter().flat_map(color).collect();
    let mean = counts.iter().copied().map(f64::from).sum::<f64>() / counts.len().max(1) as f64;
    Ok(json!({
        "width": scene.film.width, "height": scene.film.height, "scale": 1, "rgb": base64(&rgb), "most": most,
        "mean": mean, "what": what,
    }))
}

/// A frame of the scene.
pub fn job(scene: &Scene, view: View, count: bool) -> RenderJob {
    RenderJob { view, count, ..raykata_cli::report::job(scene.clone()) }
}

fn errors_of(state: &State) -> Value {
    json!({ "errors": state.errors, "failure": state.failure })
}

fn scene_of(root: &Path, state: &State) -> Value {
    let reference = state.reference.as_ref().map_or("there is none for this scene", |one| one.source());
    json!({
        "run": state.run, "name": state.file.file_stem().unwrap_or_default().to_string_lossy(),
        "file": shown(root, &state.file), "width": state.film.width, "height": state.film.height,
        "reference": state.reference.is_some(), "source": reference,
    })
}

/// The path of a file as the user would type it at the root.
fn shown(root: &Path, file: &Path) -> String {
    // The path of the scene has no links, but that of the kit may have some.
    let real = root.canonicalize().unwrap_or_default();
    file.strip_prefix(root).or_else(|_| file.strip_prefix(real)).unwrap_or(file).display().to_string()
}

/// The command that shows the rays of a pixel in the terminal.
fn command_of(root: &Path, file: &Path, [x, y]: [u32; 2]) -> String {
    let kit = raykata_cli::kits::with_exercises(root);
    format!("cargo run -- tree {} --pixel {x},{y}{kit}", shown(root, file))
}

/// The names of the scenes of the kit.
fn scenes(root: &Path) -> Vec<String> {
    let strip = |name: String| name.strip_suffix(".toml").map(str::to_owned);
    let mut names: Vec<String> = names_in(&root.join("scenes")).into_iter().filter_map(strip).collect();
    // The scenes of the stages come first, in the order of the stages.
    let stage = |name: &str| name.strip_prefix("stage").and_then(|number| number.parse().ok());
    names.sort_by_key(|name| (stage(name).unwrap_or(u32::MAX), name.clone()));
    names
}
