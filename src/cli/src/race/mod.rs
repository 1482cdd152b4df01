//! `raykata race`: which of two kits renders a scene faster.
//!
//! Each kit is a worker process. They render the same whole frames in turn, the structures included, and this program reads
//! their processor times from the operating system.
//!
//! `racers` (folders and builds) · `processor_time` · `pictures` (are they the same?) · `statistics` · `table`

mod pictures;
mod processor_time;
pub mod racers;
pub mod statistics;
mod table;

use crate::args::{Argument, Given, Opt, Spec};
use crate::kits::{Choice, Which, root};
use crate::program::exit_code;
use crate::quality_options::QualityOptions;
use crate::report::{bar_of_steps, counted, job, render, with_at_most};
use crate::worker::{CALL_PATIENCE, Worker};
use anyhow::{Context, Result};
use pictures::different_pixels;
use processor_time::processor_time;
use racers::Racer;
use raykata::kit::{Door, RenderJob, Rendering};
use raykata::scene::Scene;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};
use table::{Lane, Race};

/// `raykata race`.
pub static SPEC: Spec = Spec {
    name: "raykata race",
    about: "Compare the speed of your code with that of another folder of exercises.",
    arguments: &[Argument::required("SCENE", "The scene, a TOML file.")],
    options: &[
        &[
            Opt::value(
                "--against",
                "FOLDER",
                "Another folder of exercises, whose code is run as yours is; several can be given, and speeds \
                 are relative to the first [default: the reference, if the kit has it].",
            )
            .many(),
            Opt::value("--rounds", "N", "How often each kit renders the picture [default: 15]."),
            Opt::flag("--full", "Render pictures of the scene's own size, not smaller ones."),
        ],
        Choice::OPTIONS,
        QualityOptions::OPTIONS,
    ],
};

/// The most pixels of a picture, without `--full` and `--size`: a race in the scenes of the README then takes about a minute.
const RACED_PIXELS: f64 = 50_000.0;

/// Runs the race and prints its table. It succeeds if all kits make the same picture.
pub fn run(given: &Given) -> Result<ExitCode> {
    let file = Path::new(given.required(0)?);
    let (kit, quality) = (Choice::read(given)?, QualityOptions::read(given)?);
    let against = given.repeated("--against", |text| Ok::<_, String>(PathBuf::from(text)))?;
    let rounds = given.number("--rounds", statistics::FEWEST..=10_000)?.unwrap_or(15);
    let mut scene = quality.load(file)?;
    if !given.has("--full") && quality.size.is_none() {
        scene = with_at_most(RACED_PIXELS, &scene);
    }
    // Find the kits before anything is built. The first opponent is the baseline, and comes first.
    let root = root()?;
    let mut racers = match against.as_slice() {
        [] => vec![racers::of_kit(&root, Which::Solutions)?],
        folders => folders.iter().map(|folder| racers::in_folder(&root, folder)).collect::<Result<_>>()?,
    };
    racers.push(racers::of_kit(&root, kit.or_exercises())?);
    let programs = racers::build(&root, &racers)?;

    let samples = counted(scene.quality.samples_per_pixel, "sample");
    let (width, height) = (scene.film.width, scene.film.height);
    let title = format!("{}, {width} × {height} pixels, {samples} each", file.display());
    let contestant = |(racer, program): (Racer, PathBuf)| Contestant {
        name: racer.name,
        kit: Door(Worker::new(program, CALL_PATIENCE)),
    };
    let contestants: Vec<Contestant> = racers.into_iter().zip(programs).map(contestant).collect();
    let race = measure(&scene, title, &contestants, rounds)?;
    println!("{}", race.report().trim_end());
    Ok(exit_code(race.is_valid()))
}

/// A kit in its process.
struct Contestant {
    name: String,
    kit: Door<Worker>,
}

impl Contestant {
    /// Renders a frame, and returns it with the time that the operating system measured: processor time, or else elapsed time.
    fn frame(&self, scene: &Scene, seed: u64, by_processor: bool) -> Result<(Rendering, Duration)> {
        let job = RenderJob { seed, threads: 1, count: false, reuse: false, ..job(scene.clone()) };
        let clock = || self.kit.0.process().and_then(processor_time).unwrap_or_default();
        let (before, started) = (clock(), Instant::now());
        let rendering = render(&self.kit, &job);
        let rendering = rendering.with_context(|| format!("{} cannot finish its frame", self.name))?;
        let time = if by_processor { clock().saturating_sub(before) } else { started.elapsed() };
        Ok((rendering, time))
    }
}

/// Lets all kits render the scene in turn.
fn measure(scene: &Scene, title: String, contestants: &[Contestant], rounds: usize) -> Result<Race> {
    let processor_time = processor_time(std::process::id()).is_some();
    let lane = |contestant: &Contestant| Lane { name: contestant.name.clone(), ..Lane::default() };
    let mut race = Race {
        title,
        pixels: scene.film.width as usize * scene.film.height as usize,
        processor_time,
        lanes: contestants.iter().map(lane).collect(),
    };
    let bar = bar_of_steps((rounds + 1) * contestants.len());
    // Render a round that does not count: it starts the processes and reads their programs from the disk.
    for round in 0..=rounds {
        let mut expected = None;
        for (lane, contestant) in race.lanes.iter_mut().zip(contestants) {
            // Another seed per round gives other random numbers, so that no frame is that of an earlier round.
            let (rendering, time) = contestant.frame(scene, round as u64, processor_time)?;
            if round == 0 {
                lane.notes = rendering.notes;
            } else {
                lane.seconds.push(time.as_secs_f64());
            }
            let expected = expected.get_or_insert_with(|| rendering.film.clone());
            lane.different_pixels = lane.different_pixels.max(different_pixels(expected, &rendering.film));
            bar.inc(1);
        }
        // More rounds do not repair a wrong picture.
        if round > 0 && !race.has_opponent() {
            break;
        }
    }
    bar.finish_and_clear();
    Ok(race)
}
