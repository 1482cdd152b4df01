//! `raykata compare`: the structures of stages 3, 8 and 9 side by side on one scene: what each costs to build, in memory,
//! in questions a ray and in time; and pictures of where it divides space and of where rays are dear.
//!
//! `rows` (what is compared) · `measure` (how) · `table` and `plot` (how it is told) · `drawing` (pictures)

mod drawing;
mod measure;
mod plot;
mod rows;
mod table;

use crate::kits::{Choice, Source};
use crate::knobs::{Knobs, Threads};
use crate::report::{load_scene, make_folder};
use anyhow::{Context, Result};
use clap::Args;
use measure::Bench;
use raykata::scene::Accelerator;
use rows::Of;
use std::path::{Path, PathBuf};

/// Which scene, what of it, and how long.
#[derive(Args)]
pub struct Options {
    /// The scene, a TOML file.
    scene: PathBuf,
    /// What is compared.
    #[arg(long, value_enum, default_value_t = Of::Structures)]
    of: Of,
    /// Only these accelerators, instead of all.
    #[arg(long, value_delimiter = ',', value_parser = crate::knobs::parse_accelerator, conflicts_with = "of")]
    only: Vec<Accelerator>,
    #[command(flatten)]
    kit: Choice,
    /// How often each picture is timed, by turns; the median counts.
    #[arg(long, default_value_t = 3, value_parser = clap::value_parser!(u32).range(1..=1000))]
    rounds: u32,
    #[command(flatten)]
    threads: Threads,
    /// How deep the boxes and cells lie that are drawn, the root being at level 0.
    #[arg(long, default_value_t = 6, value_parser = clap::value_parser!(u32).range(0..=64))]
    level: u32,
    #[command(flatten)]
    knobs: Knobs,
    /// The folder for pictures, plot and numbers [default: out/NAME-compare].
    #[arg(long, short)]
    out: Option<PathBuf>,
    /// Only the table: no pictures, no plot.
    #[arg(long)]
    table: bool,
}

/// Measures, prints the table and writes the rest. Whether all rows make the same picture; copies and instances need not,
/// for a ray that is carried into another space is rounded.
pub fn run(options: &Options) -> Result<bool> {
    let mut scene = load_scene(&options.scene)?;
    options.knobs.apply(&mut scene);
    let name = options.scene.file_stem().context("the scene has no name")?.to_string_lossy().into_owned();
    let out = options.out.clone().unwrap_or_else(|| Path::new("out").join(format!("{name}-compare")));
    let source = Source::here(options.kit.or_reference())?;
    let kit = &*source.fresh();

    let rows = rows::rows(options.of, &options.only, &scene);
    let bench = Bench { kit, rounds: options.rounds, threads: options.threads.count() };
    let measured = bench.measure(&scene, &rows)?;
    let title = format!("{name}.toml, {} × {} pixels", scene.film.width, scene.film.height);
    table::print(&title, &measured);
    if !options.table {
        make_folder(&out)?;
        drawing::write(&out, kit, &scene, &measured, options.level)?;
        plot::write(&out.join("compare.svg"), &title, &measured)?;
        table::write_json(&out.join("compare.json"), &measured)?;
        println!("\npictures, plot and numbers are in {}", out.display());
    }
    Ok(options.of == Of::Instances || measured.iter().all(|row| row.different_pixels == 0))
}
