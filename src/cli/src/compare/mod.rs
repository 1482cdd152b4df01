//! `raykata compare`: the structures of stages 3, 8 and 9 on one scene: build time, memory, tests per ray and
//! time of each, and pictures of its cells and of the cost of each pixel.
//!
//! `rows` (what is compared) · `measure` (counts and times) · `table` and `plot` (the report) · `drawing` (pictures)

mod drawing;
mod measure;
mod plot;
mod rows;
mod table;

use crate::args::{Argument, Given, Misuse, Opt, Spec, names};
use crate::kits::{Choice, Need, Source, root};
use crate::quality_options::{QualityOptions, Threads};
use crate::report::{load_scene, make_folder, with_at_most};
use anyhow::{Context, Result};
pub use drawing::{heat_color, projected, with_edges};
use measure::Bench;
use raykata::scene::Accelerator;
use rows::Of;
use std::path::{Path, PathBuf};

/// `raykata compare`.
pub static SPEC: Spec = Spec {
    name: "raykata compare",
    about: "Compare the acceleration structures on one scene.",
    arguments: &[Argument::required("SCENE", "The scene, a TOML file.")],
    options: &[
        &[
            Opt::value(
                "--of",
                "WHAT",
                "What is compared: all accelerators; the optimisations of a scene graph search; the kd-tree \
                 without each of its heuristics; grids of growing resolution; the tests of triangles and \
                 spheres; or instances and copies \
                 [default: structures].",
            )
            .choices(&names(&Of::NAMES)),
            Opt::value("--only", "LIST", "Only these accelerators, instead of all.")
                .choices(&names(&Accelerator::NAMES))
                .many(),
            Opt::value(
                "--rounds",
                "N",
                "How often each picture is timed, all in turn; the median counts [default: 3].",
            ),
            Opt::value(
                "--level",
                "N",
                "The level of the boxes and cells that are drawn; the root has level 0 [default: 6].",
            ),
            Opt::value(
                "--out",
                "FOLDER",
                "The folder for pictures, plot and numbers [default: out/NAME-compare].",
            )
            .short("-o"),
            Opt::flag("--table", "Print only the table: no pictures, no plot."),
            Opt::flag("--full", "Measure pictures of the scene's own size, not smaller ones."),
        ],
        Choice::OPTIONS,
        Threads::OPTIONS,
        QualityOptions::OPTIONS,
    ],
};

/// The scene, what is compared, and how often.
pub struct Options {
    scene: PathBuf,
    of: Of,
    only: Vec<Accelerator>,
    kit: Choice,
    rounds: u32,
    threads: Threads,
    level: u32,
    quality: QualityOptions,
    out: Option<PathBuf>,
    table: bool,
    full: bool,
}

/// The most pixels of a measured picture, without `--full` and `--size`. The scene of the README then takes about 10 s on two
/// cores.
const MEASURED_PIXELS: f64 = 50_000.0;

impl Options {
    /// Reads the arguments and options.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        given.exclude("--only", "--of")?;
        Ok(Options {
            scene: given.required(0)?.into(),
            of: given.choice("--of", &Of::NAMES)?.unwrap_or(Of::Structures),
            only: given.choices("--only", &Accelerator::NAMES)?,
            kit: Choice::read(given)?,
            rounds: given.number("--rounds", 1..=1000)?.unwrap_or(3),
            threads: Threads::read(given)?,
            level: given.number("--level", 0..=64)?.unwrap_or(6),
            quality: QualityOptions::read(given)?,
            out: given.path("--out"),
            table: given.has("--table"),
            full: given.has("--full"),
        })
    }
}

/// Measures, prints the table and writes the rest. Returns whether all rows make the same picture; copies and
/// instances may differ, because a ray that is transformed into another space is rounded, and so may tests of shapes.
pub fn run(options: &Options) -> Result<bool> {
    let mut scene = load_scene(&options.scene, options.quality.limits())?;
    options.quality.apply(&mut scene)?;
    let name = options.scene.file_stem().context("the scene has no name")?.to_string_lossy().into_owned();
    let out = options.out.clone().unwrap_or_else(|| Path::new("out").join(format!("{name}-compare")));
    let root = root()?;
    let source = Source::prepare(&root, options.kit.or_reference(&root), Need::Frames)?;
    let kit = &*source.fresh();

    // Measure smaller pictures, unless a size is given.
    if !options.full && !options.quality.names_a_size() {
        let small = with_at_most(MEASURED_PIXELS, &scene);
        if small.film != scene.film {
            println!("smaller pictures are measured; `--full` measures those of the scene's own size");
        }
        scene = small;
    }
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
    // Methods round differently, and so do rays that are transformed into the space of an instance.
    Ok(matches!(options.of, Of::Instances | Of::Methods)
        || measured.iter().all(|row| row.different_pixels == 0))
}
