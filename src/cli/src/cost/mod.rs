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
mod plot;
mod reference;
mod search;
mod setting;
mod slope;
mod table;

use crate::args::{Given, wrapped};
use crate::kits::{Need, Source, root};
use crate::lock::Lock;
use crate::quality_options::arguments;
use crate::report::{FrameBar, load_scene, make_folder, name_of, with_at_most};
use anyhow::{Context, Result, bail};
use called::Called;
use kept::KeptPictures;
use ladder::Ladder;
use measure::{Bench, pareto_front};
pub use measured::Verdicts;
use measured::{Measured, Reference};
use options::CostOptions;
pub use options::SPEC;
use parameter::Parameter;
use raykata::effects::Effects;
use raykata::kit::{Kit, KitError, kit_error};
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
/// has a section about ray/triangle tests; `program` is the command that starts this program.
pub fn run(given: &Given, program: &str, numerics: Option<&Numerics<'_>>) -> Result<bool> {
    let options = &CostOptions::read(given)?;
    // Build the kit and prepare the measurement.
    let began = Instant::now();
    let root = root()?;
    let which = options.kit.or_reference(&root);
    let source = Source::prepare(&root, which, Need::Frames)?;
    let kit = &*source.fresh();
    let stop = stopped_by_ctrl_c()?;
    let bench = Bench {
        kit,
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
        return headline::run(&bench, hierarchy, options.most, &out, &fingerprint(&source)?);
    };
    // Read the scene, in its own size and in that of the measured pictures.
    let mut full = load_scene(file, options.quality.limits)?;
    let as_written = full.quality;
    options.quality.apply(&mut full)?;
    let pixels = options.pixels();
    let mut small = if options.quality.names_a_size() { full.clone() } else { with_at_most(pixels, &full) };
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

    // Continue a run that was stopped.
    let code = fingerprint(&source)?;
    let kept = KeptPictures::open(&out, &code)?;
    let bench = Bench { kept: Some(&kept), ..bench };

    // Choose the values to measure.
    let (ladders, not_offered) = ladders(kit, &bench, &small, options)?;
    for (parameter, why) in &not_offered {
        println!("{}", wrapped(&format!("{}: not offered, because {why}", parameter.name()), 2));
    }
    // Render the reference, or continue it.
    println!(
        "the reference: {} samples per pixel, {} × {} pixels, {} rounds",
        options.reference, small.film.width, small.film.height, options.rounds
    );
    if !options.full {
        println!("`--full` measures larger pictures, more rounds and a better reference");
    }
    let cache = Path::new("out").join("references");
    if options.equal_time {
        let reference = |scene: &Scene| reference::reference(&bench, scene, options.reference, &cache, &code);
        let complete = equal_time::run(&bench, &small, &ladders, &options.light_sizes, &out, reference)?;
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
    let mut measured = bench.measure(&small, ladders, &right)?;
    hits::judge(&root, &bench, &small, &mut measured)?;
    // Search the best settings for the goal.
    let goal = options.budget.map(Goal::Seconds).or(options.error.map(Goal::Error));
    let advice = match goal {
        Some(goal) if !bench.stopped() => advise(&bench, [&small, &full], &measured, &right, goal)?,
        _ => None,
    };
    let advice = advice.map(|advice| {
        let size = options.quality.names_a_size().then_some((full.film.width, full.film.height));
        Advice { command: command_for(file, &as_written, &advice, size), ..advice }
    });
    // Measure the ray/triangle tests, if that is possible here.
    let about_tests = measured.series.iter().any(|series| series.parameter == Parameter::Intersection);
    let numerics = match numerics {
        Some(numerics) if about_tests && !bench.stopped() => numerics(kit),
        _ => Vec::new(),
    };
    // Print and write the report.
    let report = Report {
        scene: name,
        command: command(program),
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
        pareto_front: pareto_front(&measured.points),
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

/// The ladders of all parameters to measure, and the parameters that change nothing. It is an error to
/// request one of those.
fn ladders(
    kit: &dyn Kit,
    bench: &Bench<'_>,
    scene: &Scene,
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
    let mut pixel = scene.clone();
    (pixel.film.width, pixel.film.height, pixel.quality.samples_per_pixel) = (1, 1, 1);
    let bar = FrameBar::new("looking at the scene");
    let frame = bench.render(&bench.job(&pixel, 0, true), None, Some(&bar))?;
    bar.finish();
    let primitives = frame.map_or(0, |frame| frame.primitives);
    let called = Called { scene, effects: &effects, primitives, most_samples: options.most_samples() };
    let (mut ladders, mut not_offered) = (Vec::new(), Vec::new());
    for (_, parameter) in Parameter::NAMES {
        match parameter.ladders(&called) {
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

/// The command that renders the proposal.
fn command_for(file: &Path, as_written: &Quality, advice: &Advice, size: Option<(u32, u32)>) -> String {
    let flat = if advice.setting.smooth { "" } else { "  # and `smooth = false` for its meshes" };
    let size = size.map_or(String::new(), |(width, height)| format!(" --size {width}x{height}"));
    let turned = arguments(as_written, &advice.setting.quality);
    format!("cargo run --release -- render {}{size}{turned}{flat}", file.display())
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

/// A name for the code that renders, because each code has its own reference.
fn fingerprint(source: &Source) -> Result<String> {
    let program = &source.program;
    let bytes = std::fs::read(program).with_context(|| format!("cannot read {}", program.display()))?;
    Ok(crate::fingerprint::fingerprint([&bytes[..]]))
}

/// The command line with which this program was started.
fn command(program: &str) -> String {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    format!("{program} {}", arguments.join(" "))
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
