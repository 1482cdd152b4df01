//! `raykata cost`: which knob buys how much accuracy for how much time on a scene, and where it is wasted.
//!
//! `ladder` (which knobs, which values) · `reference` (what is right) · `error` (how far off) · `measure` (counts, times) ·
//! `slope` (how fast error falls) · `headline` (brute force against a hierarchy) · `advice` (the best for your time) · `table`, `page`, `plot`, `files` (how it is told)

mod advice;
mod error;
mod files;
mod headline;
mod ladder;
mod measure;
mod page;
mod plot;
mod reference;
mod slope;
mod table;

use crate::kits::{Choice, Source, Which};
use crate::knobs::Knobs;
use crate::report::{load_scene, make_folder};
use advice::{Advice, Goal};
use anyhow::{Context, Result, bail};
use clap::Args;
use ladder::{Called, Knob, Ladder};
use measure::{Bench, Measured, front};
use raykata::effects::Effects;
use raykata::kit::{Kit, Mishap, mishap};
use raykata::scene::Scene;
use reference::Reference;
use serde::Serialize;
use sha2::{Digest, Sha256};
use slope::Slope;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Which scene, which knobs, and how long.
#[derive(Args)]
pub struct Options {
    /// The scene, a TOML file.
    #[arg(required_unless_present = "headline")]
    scene: Option<PathBuf>,
    /// Instead: brute force against the hierarchy on a landscape of more and more triangles, on 3840 × 2160 pixels.
    #[arg(long, conflicts_with = "scene")]
    headline: bool,
    /// How many triangles the largest landscape has.
    #[arg(long, default_value_t = 12_000_000, requires = "headline", value_parser = clap::value_parser!(u64).range(2..=16_000_000))]
    most: u64,
    /// The knobs to turn [default: all that the scene calls for].
    #[arg(long = "knob", value_enum, value_delimiter = ',')]
    turned: Vec<Knob>,
    #[command(flatten)]
    kit: Choice,
    /// Propose the settings with the least error for so much time, such as 60s or 1500ms, in the scene's own size.
    #[arg(long, value_parser = parse_seconds, conflicts_with = "error")]
    budget: Option<f64>,
    /// Propose the fastest settings with no more root mean square error than this.
    #[arg(long, value_parser = parse_error)]
    error: Option<f64>,
    /// Samples a pixel of the reference; more make its own error smaller.
    #[arg(long, default_value_t = 1024, value_parser = clap::value_parser!(u32).range(128..=1_048_576))]
    reference: u32,
    /// How often each picture is made, by turns and with other random numbers; medians and means count.
    #[arg(long, default_value_t = 5, value_parser = clap::value_parser!(u32).range(1..=1000))]
    rounds: u32,
    /// Threads; 0 takes one a core.
    #[arg(long, default_value_t = 0, value_parser = clap::value_parser!(u16).range(0..=1024))]
    threads: u16,
    /// Picks the random numbers.
    #[arg(long, default_value_t = 0)]
    seed: u64,
    #[command(flatten)]
    knobs: Knobs,
    /// The folder for the report, plots and tables [default: out/NAME-cost].
    #[arg(long, short)]
    out: Option<PathBuf>,
}

/// Pictures that are measured have at most so many pixels, unless a size was given: some hundred of them are made.
const MOST_PIXELS: f64 = 10_000.0;

/// Everything that is told.
#[derive(Serialize)]
pub struct Told<'a> {
    scene: String,
    /// How to make this again.
    command: String,
    kit: &'static str,
    width: u32,
    height: u32,
    full_width: u32,
    full_height: u32,
    own_sampler: &'static str,
    reference_samples: u32,
    reference_error: f64,
    #[serde(flatten)]
    told_of: Counted<'a>,
    #[serde(skip)]
    measured: &'a Measured,
    /// Places of the points that no other beats, from the fastest on.
    front: Vec<usize>,
    /// The place of the scene's own settings.
    own: Option<usize>,
    /// Slopes of error over samples, by the name of the ladder.
    slopes: Vec<(String, Slope)>,
    /// Knobs that buy nothing here, and why.
    not_offered: NotOffered,
    advice: Option<Advice>,
    #[cfg(feature = "author")]
    numerics: Vec<crate::gauntlet::Summary>,
    /// Whether it was stopped before its end.
    partial: bool,
    /// Seconds that all this took.
    took: f64,
    #[serde(skip)]
    right: &'a Reference,
}

/// Knobs, and why they buy nothing.
type NotOffered = Vec<(Knob, String)>;

/// What was measured, for machines.
#[derive(Serialize)]
struct Counted<'a> {
    series: &'a [measure::Series],
    points: &'a [measure::Point],
    left_out: &'a [String],
    rounds: u32,
}

/// Measures, prints a table and writes the report. `Ok(false)` if it was stopped.
pub fn run(options: &Options) -> Result<bool> {
    let began = Instant::now();
    let which = options.kit.or_reference();
    let source = Source::here(which)?;
    let kit = &*source.fresh();
    let stop = stopped_by_ctrl_c()?;
    let bench = Bench {
        kit,
        rounds: options.rounds,
        threads: usize::from(options.threads),
        seed: options.seed,
        stop: &stop,
    };

    let Some(file) = &options.scene else {
        let out = options.out.clone().unwrap_or_else(|| Path::new("out").join("headline"));
        return headline::run(&bench, options.most, &out);
    };
    let mut full = load_scene(file)?;
    options.knobs.apply(&mut full);
    let small = if options.knobs.names_a_size() { full.clone() } else { shrunk(&full) };
    let name = file.file_stem().context("the scene has no name")?.to_string_lossy().into_owned();
    let out = options.out.clone().unwrap_or_else(|| Path::new("out").join(format!("{name}-cost")));

    let (ladders, not_offered) = ladders(kit, &bench, &small, &options.turned)?;
    for (knob, why) in &not_offered {
        println!("{}: not offered, for {why}", knob.name());
    }
    println!(
        "the reference: {} samples a pixel, {} × {} pixels",
        options.reference, small.film.width, small.film.height
    );
    let code = fingerprint(&source)?;
    let cache = Path::new("out").join("references");
    let Some(right) = reference::reference(&bench, &small, options.reference, &cache, &code)? else {
        println!("stopped; the reference goes on from here next time");
        return Ok(false);
    };
    println!("its own error: {:.1e}\n", right.own_error);

    let measured = bench.measure(&small, ladders, &right)?;
    let goal = options.budget.map(Goal::Seconds).or(options.error.map(Goal::Error));
    let advice = match goal {
        Some(goal) if !bench.stopped() => advised(&bench, &small, &full, &measured, &right, goal)?,
        _ => None,
    };
    #[cfg(feature = "author")]
    let numerics = match measured.series.iter().any(|series| series.knob == Knob::Intersection) {
        true if !bench.stopped() => crate::gauntlet::summary(kit),
        _ => Vec::new(),
    };
    let told = Told {
        scene: name,
        command: command(),
        kit: kit_name(which),
        width: small.film.width,
        height: small.film.height,
        full_width: full.film.width,
        full_height: full.film.height,
        own_sampler: ladder::sampler_name(full.quality.sampler),
        reference_samples: right.samples,
        reference_error: right.own_error,
        told_of: Counted {
            series: &measured.series,
            points: &measured.points,
            left_out: &measured.left_out,
            rounds: measured.rounds,
        },
        measured: &measured,
        front: front(&measured.points),
        own: measured.points.iter().position(|point| point.setting == ladder::Setting::of(&small)),
        slopes: slopes(&measured),
        not_offered,
        advice,
        #[cfg(feature = "author")]
        numerics,
        partial: bench.stopped(),
        took: began.elapsed().as_secs_f64(),
        right: &right,
    };
    table::print(&told);
    make_folder(&out)?;
    files::write(&out, &told)?;
    page::write(&out.join("index.html"), &told)?;
    println!("\nthe report: {} ({:.0} s)", out.join("index.html").display(), told.took);
    Ok(!told.partial)
}

/// The ladders of all knobs that are to be turned, and those that buy nothing. It is an error to ask for one of those.
fn ladders(
    kit: &dyn Kit,
    bench: &Bench<'_>,
    scene: &Scene,
    turned: &[Knob],
) -> Result<(Vec<Ladder>, NotOffered)> {
    let effects = match mishap::catch(|| kit.effects(std::slice::from_ref(scene))) {
        Ok(mut effects) => effects.remove(0),
        Err(Mishap::NotWritten { place, .. }) => {
            println!("what a scene calls for is not written yet ({place}), so every knob is offered");
            Effects::everything(scene)
        }
        Err(mishap) => return Err(mishap.into()),
    };
    let mut pixel = scene.clone();
    (pixel.film.width, pixel.film.height, pixel.quality.samples_per_pixel) = (1, 1, 1);
    let primitives = bench.frame(&pixel, 0, true)?.map_or(0, |frame| frame.primitives);
    let called = Called { scene, effects: &effects, primitives };
    let (mut ladders, mut not_offered) = (Vec::new(), Vec::new());
    for &knob in <Knob as clap::ValueEnum>::value_variants() {
        match knob.ladders(&called) {
            Ok(these) if turned.is_empty() || turned.contains(&knob) => ladders.extend(these),
            Ok(_) => {}
            Err(why) if turned.contains(&knob) => bail!("{} buys nothing here: {why}", knob.name()),
            Err(why) => not_offered.push((knob, why)),
        }
    }
    Ok((ladders, not_offered))
}

fn advised(
    bench: &Bench<'_>,
    small: &Scene,
    full: &Scene,
    measured: &Measured,
    right: &Reference,
    goal: Goal,
) -> Result<Option<Advice>> {
    let pixels = |scene: &Scene| f64::from(scene.film.width) * f64::from(scene.film.height);
    let times = pixels(full) / pixels(small);
    let Some(mut advice) = advice::advise(bench, small, measured, right, goal, times)? else {
        return Ok(None);
    };
    advice::verify(bench, small, full, right, &mut advice)?;
    Ok(Some(advice))
}

/// Of all ladders of samples.
fn slopes(measured: &Measured) -> Vec<(String, Slope)> {
    let of_series = |series: &measure::Series| {
        let samples: Vec<f64> = series.rungs.iter().filter_map(|(name, _)| name.parse().ok()).collect();
        let round = |round: usize| {
            let error = |(_, index): &(String, usize)| measured.points[*index].rmse.get(round).copied();
            series.rungs.iter().map(error).collect::<Option<Vec<f64>>>()
        };
        let rounds: Vec<Vec<f64>> = (0..measured.rounds as usize).filter_map(round).collect();
        Some((series.name.clone(), slope::slope(&samples, &rounds)?))
    };
    let of_samples = |series: &&measure::Series| matches!(series.knob, Knob::Samples | Knob::Sampler);
    measured.series.iter().filter(of_samples).filter_map(of_series).collect()
}

/// The same scene with fewer pixels.
fn shrunk(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    let (width, height) = (f64::from(scene.film.width), f64::from(scene.film.height));
    let share = (MOST_PIXELS / (width * height)).sqrt().min(1.0);
    scene.film.width = ((width * share) as u32).max(1);
    scene.film.height = ((height * share) as u32).max(1);
    scene
}

/// Names the code that renders: another code has another reference.
fn fingerprint(source: &Source) -> Result<String> {
    let program = match source {
        #[cfg(feature = "author")]
        Source::Solutions => std::env::current_exe().context("this program cannot find itself")?,
        Source::Worker(program) => program.clone(),
    };
    let bytes = std::fs::read(&program).with_context(|| format!("cannot read {}", program.display()))?;
    Ok(Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect())
}

fn kit_name(which: Which) -> &'static str {
    match which {
        Which::Exercises => "exercises",
        #[cfg(feature = "author")]
        Which::Solutions => "solutions",
    }
}

/// As it was started, for whoever wants to see it again.
fn command() -> String {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    format!("cargo run --release -- {}", arguments.join(" "))
}

/// Set once somebody has pressed Ctrl-C; the second time ends the program.
fn stopped_by_ctrl_c() -> Result<Arc<AtomicBool>> {
    let stop = Arc::new(AtomicBool::new(false));
    let pressed = stop.clone();
    ctrlc::set_handler(move || {
        if pressed.swap(true, Ordering::Relaxed) {
            std::process::exit(130);
        }
        eprintln!("\nstopping: the report of what has been measured comes next; once more ends at once");
    })
    .context("Ctrl-C cannot be listened to")?;
    Ok(stop)
}

/// `60s`, `1500ms`, `2m` or a number of seconds.
fn parse_seconds(text: &str) -> Result<f64, String> {
    let units = [("ms", 0.001), ("s", 1.0), ("m", 60.0), ("", 1.0)];
    let number =
        |(unit, scale): (&str, f64)| Some(text.strip_suffix(unit)?.trim().parse::<f64>().ok()? * scale);
    match units.into_iter().find_map(number) {
        Some(seconds) if seconds > 0.0 && seconds.is_finite() => Ok(seconds),
        _ => Err("a time is a number above 0 with s, ms or m behind it, such as 60s".into()),
    }
}

fn parse_error(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(error) if error > 0.0 && error.is_finite() => Ok(error),
        _ => Err("an error is a number above 0, such as 0.01".into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_are_read_as_people_write_them() {
        let read = ["60s", "1500ms", "2m", "7", "0.5 s"].map(parse_seconds);
        assert_eq!(read, [60.0, 1.5, 120.0, 7.0, 0.5].map(Ok));
        for wrong in ["", "s", "-1s", "0", "inf", "soon"] {
            assert!(parse_seconds(wrong).is_err(), "{wrong}");
        }
    }
}
