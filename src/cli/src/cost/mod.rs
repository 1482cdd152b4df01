//! `raykata cost`: measures how much each parameter of a scene lowers the error and how much time it costs.
//!
//! `options` (the command line) · `called`, `ladder` and `setting` (the parameters and their values) ·
//! `kept` (the pictures of a stopped run) · `reference` (the converged picture) · `error` (differences from it) · `hits` (exact verdicts) · `measure`
//! (counts, times) · `slope` (how fast the error falls) · `search` (the best settings for a time
//! or an error) · `equal_time` (values with equal times) · `table`, `page`, `plot`, `files` (the report) · `headline` and `landscape` (brute force
//! against a hierarchy)

mod called;
mod equal_time;
mod error;
mod files;
mod headline;
mod hits;
mod kept;
mod ladder;
mod landscape;
mod measure;
mod measured;
mod options;
mod page;
mod parameter;
pub mod plot;
mod reference;
mod search;
mod setting;
mod slope;
mod table;

use crate::args::{Given, wrapped};
use crate::fingerprint;
use crate::kits::{Need, Source, Which, has_solutions, root};
use crate::lock::Lock;
use crate::quality_options::arguments;
use crate::race::racers::build_both;
use crate::race::statistics::FEWEST;
use crate::report::{FrameBar, load_scene, make_folder, name_of, with_at_most};
use anyhow::{Context, Result, bail};
use called::Called;
use kept::KeptPictures;
use ladder::Ladder;
use measure::{Bench, Rank, ranks};
pub use measured::Verdicts;
use measured::{Measured, Reference};
use options::CostOptions;
pub use options::SPEC;
use parameter::Parameter;
use raykata::effects::Effects;
use raykata::kit::{Kit, KitError, Rendering, kit_error};
use raykata::scene::{Accelerator, Quality, Scene};
use search::{Advice, Goal, advise};
use serde::Serialize;
use setting::Setting;
use slope::Slope;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// The contents of the report.
#[derive(Serialize)]
pub struct Report<'a> {
    scene: String,
    /// The command that makes this report.
    command: String,
    kit: &'static str,
    width: u32,
    height: u32,
    full_width: u32,
    full_height: u32,
    own_sampler: String,
    reference_samples: u32,
    reference_error: f64,
    /// Whether the report shows the bias, which matters where paths are cut off.
    has_bias: bool,
    #[serde(flatten)]
    measured: &'a Measured,
    /// The indices of the points on the Pareto front, from the fastest on.
    pareto_front: Vec<usize>,
    /// The indices of the points that may lie on it: their times or errors vary too much to say.
    unclear: Vec<usize>,
    /// Where the reference pictures come from, and whose code stands beside it, in a sentence; empty for the reference alone.
    beside: String,
    /// The index of the point with the scene's own settings.
    own: Option<usize>,
    /// The slope of error over samples, by the name of the ladder.
    slopes: Vec<(String, Slope)>,
    /// Parameters that change nothing in this scene, and why.
    not_offered: NotOffered,
    advice: Option<Advice>,
    numerics: Vec<Summary>,
    /// Whether the measurement was stopped before its end.
    partial: bool,
    /// Seconds that the measurement took.
    took: f64,
    #[serde(skip)]
    right: &'a Reference,
}

/// Parameters that change nothing, and why.
type NotOffered = Vec<(Parameter, String)>;

impl Report<'_> {
    /// The mark of a point: on the Pareto front, perhaps, or not.
    fn mark(&self, index: usize) -> &'static str {
        if !self.has_intervals() {
            return "";
        }
        match (self.pareto_front.contains(&index), self.unclear.contains(&index)) {
            (true, _) => "•",
            (_, true) => "?",
            _ => "",
        }
    }

    /// What the marks mean, or why there are none.
    fn about_marks(&self) -> String {
        let rounds = self.measured.rounds;
        if !self.has_intervals() {
            let rounds = if rounds == 1 { "one round".into() } else { format!("{rounds} rounds") };
            return format!("{rounds}: no interval, so no value is ranked; {FEWEST} rounds have one");
        }
        let unclear = match self.unclear.len() {
            0 => String::new(),
            n => format!("; {n} values marked ? are too noisy to rank: more rounds narrow their intervals"),
        };
        format!(
            "• no other value is both as fast and as accurate, and better in one of them (Pareto front): its 95 % intervals \
             say so; values that leak more rays than the tightest, and fixed ray offsets, are left out{unclear}"
        )
    }

    /// Whether there are enough rounds for intervals.
    fn has_intervals(&self) -> bool {
        self.measured.rounds as usize >= FEWEST
    }

    /// What the times are.
    fn about_times(&self) -> &'static str {
        if self.measured.processor_time {
            "processor time of one thread"
        } else {
            "ELAPSED time of one thread, because this system gives no processor time of another process"
        }
    }
}

/// Judges the ray/triangle tests of a kit together with others.
pub type Numerics<'a> = dyn Fn(&dyn Kit) -> Vec<Summary> + 'a;

/// Three numbers about a ray/triangle test.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// Its name.
    pub name: String,
    /// Nanoseconds per call, with the answer stored.
    pub nanoseconds: f64,
    /// Wrong verdicts per million inputs, the mean over all distributions.
    pub wrong_per_million: f64,
    /// Rays per million that start inside a closed mesh, aim at its edges and vertices, and hit nothing.
    pub leaks_per_million: f64,
}

/// Measures, prints a table and writes the report. `Ok(false)` if it was stopped. With `numerics` the report
/// has a section about ray/triangle tests; `package` is that of this program in the command that starts it.
pub fn run(given: &Given, package: Option<&str>, numerics: Option<&Numerics<'_>>) -> Result<bool> {
    let options = &CostOptions::read(given)?;
    // Build the kit and prepare the measurement.
    let began = Instant::now();
    let root = root()?;
    let which = options.kit.or_reference(&root);
    // The reference stands beside a student's kit, where it is, built with the same options as in a race.
    let (source, beside) = match which {
        Which::Exercises if has_solutions(&root) => {
            let [reference, own] = build_both(&root)?;
            let of = |which, program| Source { which, program };
            (of(which, own), Some(of(Which::Solutions, reference)))
        }
        _ => (Source::prepare(&root, which, Need::Frames)?, None),
    };
    let kit = &*source.fresh();
    let reference = beside.as_ref().map(Source::fresh);
    let about_reference = match (which, &beside) {
        (Which::Exercises, None) => NO_REFERENCE,
        (Which::Exercises, Some(_)) => BESIDE,
        _ => "",
    };
    let stop = stopped_by_ctrl_c()?;
    let bench = Bench {
        kit,
        reference: reference.as_deref().map(|kit| kit as &dyn Kit),
        rounds: options.rounds,
        threads: options.threads,
        seed: options.seed,
        stop: &stop,
        kept: None,
    };

    // Without a scene, measure the headline example.
    let Some(file) = &options.scene else {
        let out = options.out.clone().unwrap_or_else(|| Path::new("out").join("headline"));
        let hierarchy = options.quality.accelerator().unwrap_or(Accelerator::Auto);
        let _lock = Lock::on(&out)?;
        let code = fingerprint::of_files([&source.program])?;
        return headline::run(&bench, hierarchy, options.most, &out, &code);
    };
    // Read the scene, in its own size and in that of the measured pictures.
    let mut full = load_scene(file, options.quality.limits)?;
    let as_written = full.quality;
    options.quality.apply(&mut full)?;
    let pixels = options.pixels();
    let mut small = if options.quality.size.is_some() { full.clone() } else { with_at_most(pixels, &full) };
    let has_goal = options.budget.is_some() || options.error.is_some();
    if !(options.full || has_goal || options.quality.names_samples()) {
        let samples = &mut small.quality.samples_per_pixel;
        if *samples > options.most_samples() {
            println!("with {} samples per pixel in place of {samples}", options.most_samples());
            *samples = options.most_samples();
        }
    }
    let name = name_of(file)?;
    let out = options.out.clone().unwrap_or_else(|| Path::new("out").join(format!("{name}-cost")));
    let _lock = Lock::on(&out)?;

    // Continue a run that was stopped. Each code that renders has its own pictures and its own reference.
    let code = fingerprint::of_files(beside.iter().chain([&source]).map(|source| &source.program))?;
    let kept = KeptPictures::open(&out, &code)?;
    let bench = Bench { kept: Some(&kept), ..bench };

    // Fix the structure that the renderer chooses, so that no level of a ladder chooses another.
    let look = look(&bench, &small)?;
    if let Some(look) = &look {
        for scene in [&mut small, &mut full] {
            scene.quality.accelerator = look.accelerator.unwrap_or(scene.quality.accelerator);
        }
    }
    let own_notes = look.as_ref().map_or(Vec::new(), |look| look.notes.clone());
    // Choose the values to measure.
    let (ladders, not_offered) = ladders(kit, &small, look.as_ref(), options)?;
    for (parameter, why) in &not_offered {
        println!("{}", wrapped(&format!("{}: not offered, because {why}", parameter.name()), 2));
    }
    // Render the reference, or continue it.
    if !about_reference.is_empty() {
        println!("{}", wrapped(about_reference, 0));
    }
    println!(
        "the reference picture: {} samples per pixel, {} × {} pixels, {} rounds",
        options.reference, small.film.width, small.film.height, options.rounds
    );
    if !options.full {
        println!("`--full` measures larger pictures, more rounds and a better reference");
    }
    let cache = Path::new("out").join("references");
    if options.equal_time {
        let reference = |scene: &Scene| reference::reference(&bench, scene, options.reference, &cache, &code);
        let complete =
            equal_time::run(&bench, &small, &ladders, &own_notes, &options.light_sizes, &out, reference)?;
        if complete {
            kept.finish()?;
        }
        return Ok(complete);
    }
    let Some(right) = reference::reference(&bench, &small, options.reference, &cache, &code)? else {
        println!("stopped; the next run continues this reference");
        return Ok(false);
    };
    println!("its own error: {:.1e}\n", right.own_error);

    // Measure errors, counts and times, and judge the hits.
    let mut measured = bench.measure(&small, ladders, &right, &own_notes)?;
    hits::judge(&root, &bench, &small, &mut measured)?;
    // Search the best settings for the goal.
    let goal = options.budget.map(Goal::Seconds).or(options.error.map(Goal::Error));
    let advice = match goal {
        Some(goal) if !bench.stopped() => advise(&bench, [&small, &full], &measured, &right, goal)?,
        _ => None,
    };
    let advice = advice.map(|advice| {
        let size = options.quality.size.is_some().then_some((full.film.width, full.film.height));
        Advice { command: command_for(file, &as_written, &full.quality, &advice, size), ..advice }
    });
    // Measure the ray/triangle tests, if that is possible here.
    let about_tests = measured.series.iter().any(|series| series.parameter == Parameter::Intersection);
    let numerics = match numerics {
        Some(numerics) if about_tests && !bench.stopped() => numerics(kit),
        _ => Vec::new(),
    };
    // Print and write the report.
    let ranks = ranks(&measured.points);
    let of_rank = |wanted: Rank| {
        let mut of_rank: Vec<usize> = (0..ranks.len()).filter(|&index| ranks[index] == wanted).collect();
        of_rank.sort_by(|&a, &b| measured.points[a].seconds.total_cmp(&measured.points[b].seconds));
        of_rank
    };
    let report = Report {
        scene: name,
        command: command(package),
        beside: about_reference.to_owned(),
        kit: which.package(),
        width: small.film.width,
        height: small.film.height,
        full_width: full.film.width,
        full_height: full.film.height,
        own_sampler: full.quality.sampler.name().replace('_', " "),
        reference_samples: right.samples,
        reference_error: right.own_error,
        has_bias: full.indirect_light,
        measured: &measured,
        pareto_front: of_rank(Rank::Front),
        unclear: of_rank(Rank::Unclear),
        own: measured.points.iter().position(|point| point.setting == Setting::of(&small)),
        slopes: slopes(&measured),
        not_offered,
        advice,
        numerics,
        partial: bench.stopped(),
        took: began.elapsed().as_secs_f64(),
        right: &right,
    };
    table::print(&report);
    make_folder(&out)?;
    files::write(&out, &report)?;
    page::write(&out.join("index.html"), &report)?;
    if !report.partial {
        kept.finish()?;
    }
    println!("\nthe report: {} ({:.0} s)", out.join("index.html").display(), report.took);
    Ok(!report.partial)
}

/// Said where a student's kit is measured and the solutions are there.
const BESIDE: &str = "Each value is measured with your code and with the reference (solutions), in the same rounds; errors are \
                      against pictures of the reference.";

/// Said where a student's kit is measured alone.
const NO_REFERENCE: &str = "There is no reference here, because a hand-out has no solutions: errors are against converged pictures of \
                            your own code, so they show its noise and not its mistakes.";

/// A picture of one pixel, which says how the renderer plans the scene; `None` if the program is being stopped.
fn look(bench: &Bench<'_>, scene: &Scene) -> Result<Option<Rendering>> {
    let mut pixel = scene.clone();
    (pixel.film.width, pixel.film.height, pixel.quality.samples_per_pixel) = (1, 1, 1);
    let bar = FrameBar::new("looking at the scene");
    let frame = bench.render(&bench.job(&pixel, 0, true), None, &bar);
    bar.finish();
    frame
}

/// The ladders of all parameters to measure, and the parameters that change nothing. It is an error to
/// request one of those.
fn ladders(
    kit: &dyn Kit,
    scene: &Scene,
    look: Option<&Rendering>,
    options: &CostOptions,
) -> Result<(Vec<Ladder>, NotOffered)> {
    let turned = &options.turned;
    let effects = match kit_error::catch(|| kit.effects(std::slice::from_ref(scene))) {
        Ok(mut effects) => effects.remove(0),
        Err(KitError::NotWritten { place, .. }) => {
            println!("the effects analysis is not written yet ({place}), so every parameter is offered");
            Effects::everything(scene)
        }
        Err(error) => return Err(error.into()),
    };
    let called = Called {
        scene,
        effects: &effects,
        primitives: look.map_or(0, |look| look.primitives),
        most_samples: options.most_samples(),
        shares_meshes: scene.quality.copies || look.is_some_and(|look| look.bytes_of_parts > 0),
    };
    let searches = look.is_none_or(|look| look.accelerator.is_some());
    let (mut ladders, mut not_offered) = (Vec::new(), Vec::new());
    for (_, parameter) in Parameter::NAMES {
        let ladders_of = match !searches && parameter.is_geometric() {
            true => Err("no search for hits is written yet".into()),
            false => parameter.ladders(&called),
        };
        match ladders_of {
            Ok(_) if options.equal_time && !parameter.has_equal_time(turned) => {}
            Ok(these) if turned.is_empty() || turned.contains(&parameter) => ladders.extend(these),
            Ok(_) => {}
            Err(why) if turned.contains(&parameter) => {
                bail!("{} changes nothing here: {why}", parameter.name())
            }
            Err(why) => not_offered.push((parameter, why)),
        }
    }
    Ok((ladders, not_offered))
}

/// The command that renders the proposal. `own` is the setting of the scene with the structure that the renderer chooses.
fn command_for(
    file: &Path,
    as_written: &Quality,
    own: &Quality,
    advice: &Advice,
    size: Option<(u32, u32)>,
) -> String {
    let size = size.map_or(String::new(), |(width, height)| format!(" --size {width}x{height}"));
    let mut proposed = advice.setting.quality;
    // The structure that `auto` chooses needs no name, with the split and the leaf size that it is chosen by.
    let with_auto = |quality: &Quality| (quality.accelerator, quality.split, quality.leaf_size);
    if with_auto(&proposed) == with_auto(own) {
        proposed.accelerator = as_written.accelerator;
    }
    let turned = arguments(as_written, &proposed);
    let changes: Vec<&str> = advice.setting.changes.keys().map(|parameter| parameter.name()).collect();
    let changes = match changes.as_slice() {
        [] => String::new(),
        changes => format!("  # and change in the scene: {}", changes.join(", ")),
    };
    format!("{} render {}{size}{turned}{changes}", cargo_run(None), file.display())
}

/// The slopes of all ladders of samples.
fn slopes(measured: &Measured) -> Vec<(String, Slope)> {
    let of_series = |series: &measured::Series| {
        let samples: Vec<f64> = series.levels.iter().filter_map(|(name, _)| name.parse().ok()).collect();
        let round = |round: usize| {
            let error = |(_, index): &(String, usize)| measured.points[*index].rmse.get(round).copied();
            series.levels.iter().map(error).collect::<Option<Vec<f64>>>()
        };
        let rounds: Vec<Vec<f64>> = (0..measured.rounds as usize).filter_map(round).collect();
        Some((series.name.clone(), slope::slope(&samples, &rounds)?))
    };
    let of_samples =
        |series: &&measured::Series| matches!(series.parameter, Parameter::Samples | Parameter::Sampler);
    measured.series.iter().filter(of_samples).filter_map(of_series).collect()
}

/// The command line with which this program was started: by cargo, which says so in a variable, or directly.
fn command(package: Option<&str>) -> String {
    let mut arguments: Vec<String> = std::env::args().collect();
    if std::env::var_os("CARGO").is_some() {
        arguments[0] = cargo_run(package);
    }
    arguments.join(" ")
}

/// The command by which cargo runs a program of this workspace, in the profile of this one.
fn cargo_run(package: Option<&str>) -> String {
    let profile = if cfg!(debug_assertions) { "" } else { " --release" };
    let package = package.map_or(String::new(), |package| format!(" -p {package}"));
    format!("cargo run{profile}{package} --")
}

/// A flag that the first Ctrl-C sets; the second Ctrl-C ends the program.
fn stopped_by_ctrl_c() -> Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let pressed = stop.clone();
    ctrlc::set_handler(move || {
        if pressed.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        eprintln!(
            "\nstopping: the report of what has been measured follows; press Ctrl-C again to end at once"
        );
    })
    .context("no handler for Ctrl-C can be installed")?;
    Ok(stop)
}
