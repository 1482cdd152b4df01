//! `raykata compare`: the structures of stages 3, 8 and 9 on one scene: build time, memory, tests per ray and
//! time of each, and pictures of its cells and of the cost of each pixel.
//!
//! `rows` (what is compared) · `measure` (counts and times) · `table` and `plot` (the report) · `drawing` (pictures)

mod drawing;
mod measure;
mod plot;
mod rows;
mod table;

use crate::args::{Argument, Given, Opt, Spec, names, wrapped};
use crate::kits::Choice;
use crate::program::exit_code;
use crate::quality_options::{QualityOptions, THREADS, threads};
use crate::report::{make_folder, name_of, with_at_most, write_file};
use anyhow::Result;
pub use drawing::{heat_color, projected, with_edges};
use measure::{Bench, Measured};
use raykata::scene::Accelerator;
use rows::Comparison;
use std::collections::BTreeMap;
use std::path::Path;
use std::process::ExitCode;

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
            .choices(&names(&Comparison::NAMES)),
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
        THREADS,
        QualityOptions::OPTIONS,
    ],
};

/// The most pixels of a measured picture, without `--full` and `--size`. The scene of the README then takes about 10 s on two
/// cores.
const MEASURED_PIXELS: f64 = 50_000.0;

/// Measures, prints the table and writes the rest. It succeeds if all rows make the same picture; copies and instances may
/// differ, because a ray that is transformed into another space is rounded, and so may tests of shapes.
pub fn run(given: &Given) -> Result<ExitCode> {
    // Read the command line.
    given.exclude("--only", "--of")?;
    let file = Path::new(given.required(0)?);
    let of = given.choice("--of", &Comparison::NAMES)?.unwrap_or(Comparison::Structures);
    let only = given.choices("--only", &Accelerator::NAMES)?;
    let (kit, quality, threads) = (Choice::read(given)?, QualityOptions::read(given)?, threads(given)?);
    let rounds = given.number("--rounds", 1..=1000)?.unwrap_or(3);
    let level = given.number("--level", 0..=64)?.unwrap_or(6);
    let mut scene = quality.load(file)?;
    let name = name_of(file)?;
    let out = given.path("--out").unwrap_or_else(|| Path::new("out").join(format!("{name}-compare")));
    let kit = &*kit.start()?;

    // Measure smaller pictures, unless a size is given.
    if !given.has("--full") && quality.size.is_none() {
        let small = with_at_most(MEASURED_PIXELS, &scene);
        if small.film != scene.film {
            println!("smaller pictures are measured; `--full` measures those of the scene's own size");
        }
        scene = small;
    }
    let rows = rows::rows(of, &only, &scene);
    let mut measured = Bench { kit, rounds, threads }.measure(&scene, &rows)?;
    // A row that lacks what another row has, because its functions are not written yet, measures something else.
    let mut in_all = measured[0].notes.clone();
    in_all.retain(|note| measured.iter().all(|row| row.notes.contains(note)));
    let lacks = |row: &Measured| {
        row.notes.iter().find(|note| note.contains("not written yet") && !in_all.contains(note)).cloned()
    };
    let mut left_out: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for row in measured.extract_if(.., |row| lacks(row).is_some()) {
        left_out.entry(lacks(&row).unwrap_or_default()).or_default().push(row.name);
    }
    let title = format!("{name}.toml, {} × {} pixels", scene.film.width, scene.film.height);
    table::print(&title, &measured);
    for (why, names) in left_out {
        println!("{}", wrapped(&format!("left out: {}: {why}", names.join(" · ")), 2));
    }
    if !given.has("--table") {
        make_folder(&out)?;
        drawing::write(&out, kit, &scene, &measured, level)?;
        write_file(&out.join("compare.svg"), plot::svg(&title, &measured).as_bytes())?;
        write_file(&out.join("compare.json"), &serde_json::to_vec_pretty(&measured)?)?;
        println!("\npictures, plot and numbers are in {}", out.display());
    }
    // Methods round differently, and so do rays that are transformed into the space of an instance.
    let may_differ = matches!(of, Comparison::Instances | Comparison::Methods);
    Ok(exit_code(may_differ || measured.iter().all(|row| row.different_pixels == 0)))
}
