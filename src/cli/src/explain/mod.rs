//! `raykata explain`: the effects that a scene needs and the parts that need them, the cost of each effect,
//! and the effects that are left out.

mod indirect;
mod needs;
mod subsets;
mod why;

use crate::args::{Argument, Given, Opt, Spec, wrapped};
use crate::columns::Columns;
use crate::kits::Choice;
use crate::quality_options::QualityOptions;
use crate::report::{Thousands, bar_of_steps, counted, job, quartiles, render, with_at_most};
use anyhow::{Result, bail};
use raykata::count::Counts;
use raykata::effects::{Effect, Effects};
use raykata::kit::{BoundQuery, Kit, KitError, kit_error};
use raykata::light_path::PathEffects;
use raykata::scene::Scene;
use std::fmt::Display;
use std::path::Path;
use std::process::ExitCode;

/// `raykata explain`.
pub static SPEC: Spec = Spec {
    name: "raykata explain",
    about: "Show which effects a scene needs, why, what each costs, and which are left out.",
    arguments: &[Argument::required("SCENE", "The scene, a TOML file.")],
    options: &[
        &[
            Opt::value(
                "--rounds",
                "N",
                "How often each picture is rendered: with all effects and without each effect, in turn \
                 [default: 5].",
            ),
            Opt::flag("--full", "Measure pictures of the scene's own size and samples, not smaller ones."),
            Opt::flag(
                "--subsets",
                "Instead: the cost of each set of the effects that the scene needs, 2ⁿ lines for n effects.",
            ),
        ],
        Choice::OPTIONS,
        QualityOptions::OPTIONS,
    ],
};

/// The most samples per pixel of a picture that is measured, without `--full`. Several are left, so that effects with one
/// random number per sample, as a lens, still show their work.
const MEASURED_SAMPLES: u32 = 4;

/// The most samples of a picture that is measured, without `--full`. With five rounds and ten effects, the scene of the README
/// then takes about 10 s on two cores.
const MEASURED_WORK: f64 = 150_000.0;

/// A scene, the kit, and the effects that the scene needs.
struct Explained<'a> {
    scene: &'a Scene,
    kit: &'a dyn Kit,
    effects: Effects,
    /// What the paths of indirect light need; `None` if the scene has none, or if that function is not written yet.
    paths: Option<PathEffects>,
}

impl Explained<'_> {
    /// The analysis of `scene` by the kit.
    fn new<'a>(scene: &'a Scene, kit: &'a dyn Kit) -> Result<Explained<'a>> {
        let effects = match kit_error::catch(|| kit.effects(std::slice::from_ref(scene))) {
            Err(KitError::NotWritten { place, .. }) => {
                bail!("explain works from stage 7 on, and {place} is not written yet")
            }
            effects => effects?.remove(0),
        };
        let paths = match kit_error::catch(|| kit.paths_called_for(std::slice::from_ref(scene))) {
            _ if !effects.indirect_light => None,
            Ok(mut paths) => Some(paths.remove(0)),
            Err(KitError::NotWritten { .. }) => None,
            Err(error) => return Err(error.into()),
        };
        Ok(Explained { scene, kit, effects, paths })
    }

    fn called_for(&self) -> Vec<Effect> {
        Effect::ALL.into_iter().filter(|&effect| self.effects.calls_for(effect)).collect()
    }
}

/// Analyses the scene, measures its effects, and prints the report.
pub fn run(given: &Given) -> Result<ExitCode> {
    let (quality, kit) = (QualityOptions::read(given)?, Choice::read(given)?);
    let rounds = given.number("--rounds", 1..=1000)?.unwrap_or(5);
    let file = Path::new(given.required(0)?);
    let scene = quality.load(file)?;
    let kit = &*kit.start()?;
    let explained = Explained::new(&scene, kit)?;
    println!("{}: {}\n", file.display(), size(&scene));
    let subsets = given.has("--subsets");
    if !subsets {
        asked(&explained);
    }
    // Measure a smaller picture, whose shares of time are those of the whole one.
    let small = if given.has("--full") { scene.clone() } else { smaller(&scene) };
    let measured = Explained::new(&small, kit)?;
    if small.film != scene.film || small.quality != scene.quality {
        let measured = format!("measured with {}; `--full` measures the whole picture", size(&small));
        println!("{}\n", wrapped(&measured, 0));
    }
    if subsets {
        subsets::print(&measured)?;
        return Ok(ExitCode::SUCCESS);
    }
    cost(&measured, rounds)?;
    needs::samples(&measured)?;
    needs::rays_per_hit(&measured)?;
    bounds(&measured)?;
    indirect::depth(&measured)?;
    Ok(ExitCode::SUCCESS)
}

/// The size of a picture, in words.
fn size(scene: &Scene) -> String {
    let samples = counted(scene.quality.samples_per_pixel, "sample");
    format!("{} × {} pixels, {samples} each", scene.film.width, scene.film.height)
}

/// The scene with at most [`MEASURED_SAMPLES`] per pixel, and with as many pixels as [`MEASURED_WORK`] allows.
fn smaller(scene: &Scene) -> Scene {
    let samples = scene.quality.samples_per_pixel.min(MEASURED_SAMPLES);
    let mut small = with_at_most(MEASURED_WORK / f64::from(samples), scene);
    small.quality.samples_per_pixel = samples;
    small
}

/// The smallest error that a screen shows: one of its 256 steps of brightness.
const STEP: f32 = 1.0 / 255.0;

/// The column at which reasons begin.
const REASON_COLUMN: usize = 18;

fn asked(explained: &Explained<'_>) {
    let Explained { scene, effects, .. } = explained;
    println!("needed            by");
    for effect in Effect::ALL {
        let asking = why::asked_by(effect, scene, effects);
        if !asking.is_empty() {
            println!("  {effect:<14}  {}", wrapped(&why::list(&asking), REASON_COLUMN));
        }
    }
    for (what, parts) in why::seen(scene, effects) {
        println!("  {what:<14}  {}", wrapped(&parts, REASON_COLUMN));
    }
    if effects.indirect_light {
        indirect::asked(explained);
    }
    println!("\nnot simulated     because");
    for effect in Effect::ALL.into_iter().filter(|&effect| !effects.calls_for(effect)) {
        println!("  {effect:<14}  {}", wrapped(&why::not_asked(effect, scene), REASON_COLUMN));
    }
    for (index, light) in effects.lights.iter().enumerate().filter(|(_, light)| light.samples == 0) {
        println!("  light {:<9}  it emits no light", index + 1);
        debug_assert!(!light.shadows);
    }
    let shown = scene.shown();
    for (index, name) in scene.material_names.iter().enumerate().skip(1) {
        if !shown.iter().any(|shape| shape.materials.contains(&index)) {
            println!("  {:<14}  no shape has this material", format!("`{name}`"));
        }
    }
    println!();
}

/// Renders the scene with all effects and without each effect, in turn, and prints the differences.
fn cost(explained: &Explained<'_>, rounds: u32) -> Result<()> {
    // Render the scene with all effects and without each of them, in turn.
    let called = explained.called_for();
    let scenes: Vec<Scene> = std::iter::once(explained.scene.clone())
        .chain(called.iter().map(|effect| effect.removed_from(explained.scene)))
        .collect();
    let mut counts = vec![Counts::default(); scenes.len()];
    let mut seconds = vec![Vec::new(); scenes.len()];
    let bar = bar_of_steps(rounds as usize * scenes.len());
    for _ in 0..rounds {
        for (index, scene) in scenes.iter().enumerate() {
            let rendering = render(explained.kit, &job(scene.clone()))?;
            counts[index] = rendering.counts;
            seconds[index].push(rendering.render_seconds);
            bar.inc(1);
        }
    }
    bar.finish_and_clear();

    // Print what the picture saves without each effect.
    let with = &seconds[0];
    let work = |counts: &Counts| [counts.rays(), counts.random_numbers, counts.texture_reads];
    const COLUMNS: Columns = Columns("  ", &[-16, 13, 15, 13, 15]);
    let heads: [&dyn Display; 5] =
        [&"costs", &"its rays", &"random numbers", &"image reads", &"share of time"];
    println!("{}", COLUMNS.row(&heads));
    for (index, effect) in called.iter().enumerate() {
        let without = &seconds[index + 1];
        // Compare pictures of the same round, because they were rendered within moments of each other.
        let shares = with.iter().zip(without).map(|(with, without)| 100.0 * (1.0 - without / with)).collect();
        let (share, spread) = median_and_spread(shares);
        let time = spread_of(rounds, &format!("{share:.0} %"), &format!("{spread:.0}"));
        let [all, rest] = [&counts[0], &counts[index + 1]].map(work);
        let [rays, numbers, reads] = [0, 1, 2].map(|kind| signed(all[kind], rest[kind]));
        println!("{}", COLUMNS.row(&[&format!("  {effect}"), &rays, &numbers, &reads, &time]));
    }
    let (whole, spread) = median_and_spread(with.clone());
    let time = spread_of(rounds, &format!("{whole:.3} s"), &format!("{spread:.3}"));
    let [rays, numbers, reads] = work(&counts[0]).map(Thousands);
    println!("{}", COLUMNS.row(&[&"  everything", &rays, &numbers, &reads, &time]));
    let times = match rounds {
        1 => "Times are from one round, so they show no spread.".to_owned(),
        _ => {
            format!("Times are medians of {rounds} rounds with their median deviation, all pictures in turn.")
        }
    };
    let note = format!(
        "Each line is what the picture saves without that effect. The lines need not add up, because a mirror \
         shows shadows. {times}"
    );
    println!("  {}\n", wrapped(&note, 2));
    Ok(())
}

/// A median with its spread, which one round does not have.
fn spread_of(rounds: u32, median: &str, spread: &str) -> String {
    if rounds == 1 { median.to_owned() } else { format!("{median} ± {spread}") }
}

/// The median, and the median of the distances from it.
fn median_and_spread(values: Vec<f64>) -> (f64, f64) {
    let [_, middle, _] = quartiles(values.clone());
    let [_, deviation, _] = quartiles(values.iter().map(|value| (value - middle).abs()).collect());
    (middle, deviation)
}

/// `with - without` as text, with its sign.
fn signed(with: u64, without: u64) -> String {
    match with.checked_sub(without) {
        Some(more) => Thousands(more).to_string(),
        None => format!("-{}", Thousands(without - with)),
    }
}

/// Prints the predicted and the counted numbers of rays.
fn bounds(explained: &Explained<'_>) -> Result<()> {
    let Explained { scene, kit, effects, .. } = explained;
    let query = BoundQuery { scene: (*scene).clone(), effects: effects.clone() };
    if effects.indirect_light {
        return indirect::bounds(explained);
    }
    let most = kit_error::catch(|| kit.most_rays(std::slice::from_ref(&query)))?.remove(0);
    let counted = render(*kit, &job((*scene).clone()))?.counts;
    bounds_table(&[
        ("from the camera", most.primary, counted.primary),
        ("to lights", most.shadow, counted.shadow),
        ("reflected", most.reflection, counted.reflection),
        ("refracted", most.transmission, counted.transmission),
    ]);
    println!("  {}", wrapped(&about_hits(&counted), 2));
    Ok(())
}

/// Prints lines of predicted and counted rays.
fn bounds_table(lines: &[(&str, u64, u64)]) {
    const COLUMNS: Columns = Columns("  ", &[-18, 18, 13]);
    println!("{}", COLUMNS.row(&[&"rays", &"at most, predicted", &"counted"]));
    for (what, most, counted) in lines {
        let most = match *most {
            u64::MAX => "too many to count".to_owned(),
            most => Thousands(most).to_string(),
        };
        println!("{}", COLUMNS.row(&[&format!("  {what}"), &most, &Thousands(*counted)]));
    }
}

/// How many rays hit a surface, in words.
fn about_hits(counted: &Counts) -> String {
    let seen = counted.rays() - counted.shadow;
    format!(
        "{} of {} rays other than shadow rays hit a surface. Shadow rays start only there, and only to lights in \
         front of it. Of the {} tests of primitives, {} needed exact arithmetic, {:.3} per ray.",
        Thousands(counted.hits),
        Thousands(seen),
        Thousands(counted.primitive_tests),
        Thousands(counted.exact_tests),
        counted.exact_tests as f64 / counted.rays().max(1) as f64
    )
}
