//! `grader gauntlet`: shows what accuracy costs. It runs intersection methods on distributions of hard inputs and judges
//! them by exact arithmetic. With `--rays` it starts the long run, which searches for leaks in the reference.
//!
//! `agreement` (searches) · `long` (the long run) · `methods` and `printed` (triangle tests) · `secondary_rays` · `files`
//! (the tables as a page)

pub mod agreement;
mod files;
mod long;
mod methods;
mod printed;
mod secondary_rays;

use crate::kits::{Need, Source, Which};
use crate::report::Thousands;
use agreement::Agreement;
use anyhow::Result;
use judge::boxes_and_offsets;
use judge::gauntlet::{Input, Row, rows_of_kit, tables};
use judge::table::Table;
use methods::METHODS;
use raykata::kit::Kit;
use raykata_cli::args::{Given, Misuse, Opt, Spec, names};
use raykata_cli::cost::{self, Summary};
use std::path::{Path, PathBuf};

/// `grader gauntlet`.
pub static SPEC: Spec = Spec {
    name: "grader gauntlet",
    about: "Show what accuracy costs: compare triangle tests on hard inputs with exact arithmetic.",
    arguments: &[],
    options: &[&[
        Opt::value(
            "--kit",
            "NAME",
            "The kit whose triangle tests are compared as well [default: solutions].",
        )
        .choices(&names(&Which::NAMES)),
        Opt::value(
            "--inputs",
            "N",
            "The number of inputs per distribution, and of rays per closed mesh [default: 20000].",
        ),
        Opt::value("--seed", "N", "Picks the inputs [default: 1]."),
        Opt::value(
            "--rays",
            "N",
            "Instead of the tables: trace N rays at edges and N at vertices per structure of the reference, and N per \
             other trial. Continues a stopped run.",
        ),
        Opt::value(
            "--state",
            "FILE",
            "The file for the progress of the long run [default: out/gauntlet.json].",
        ),
        Opt::value("--out", "FOLDER", "Also write the tables to this folder: index.html and gauntlet.csv.")
            .short("-o"),
    ]],
};

/// `grader cost`, with the same options as `raykata cost`.
pub static COST: Spec = Spec {
    name: "grader cost",
    about: "The same as `raykata cost`, with a chapter about triangle tests.",
    arguments: cost::SPEC.arguments,
    options: cost::SPEC.options,
};

/// The options of `grader gauntlet`.
pub struct Options {
    kit: Which,
    inputs: u64,
    seed: u64,
    rays: Option<u64>,
    state: PathBuf,
    out: Option<PathBuf>,
}

impl Options {
    /// Reads the options from the command line.
    pub fn read(given: &Given) -> Result<Options, Misuse> {
        Ok(Options {
            kit: given.choice("--kit", &Which::NAMES)?.unwrap_or(Which::Solutions),
            inputs: given.number("--inputs", 100..=u64::MAX)?.unwrap_or(20_000),
            seed: given.number("--seed", 0..=u64::MAX)?.unwrap_or(1),
            rays: given.number("--rays", 0..=u64::MAX)?,
            state: given.path("--state").unwrap_or_else(|| "out/gauntlet.json".into()),
            out: given.path("--out"),
        })
    }
}

/// Measures the same as `raykata cost`, and the intersection methods. Returns whether it succeeded.
pub fn cost(options: &cost::Options) -> Result<bool> {
    cost::run(options, "cargo run --release -p grader --", Some(&summary))
}

/// Runs the gauntlet. Returns whether no ray leaked.
pub fn run(root: &Path, options: &Options) -> Result<bool> {
    let reference = Source::prepare(root, Which::Solutions, Need::Frames)?;
    let (tables, succeeded) = match options.rays {
        Some(rays) => {
            let (table, succeeded) = long::run(&reference, rays, options.seed, &options.state)?;
            (vec![table], succeeded)
        }
        None => {
            let source = Source::prepare(root, options.kit, Need::Checks)?;
            let kit = source.fresh();
            let mut tables = tables(rows(&*kit), options.inputs, options.seed)?;
            tables.extend(boxes_and_offsets::tables(&*kit, options.inputs, options.seed));
            let (table, succeeded) = agreement_table(&reference, options)?;
            tables.push(table);
            (tables, succeeded)
        }
    };
    for table in &tables {
        println!("{}", table.text());
    }
    if let Some(out) = &options.out {
        files::write(out, "gauntlet", &tables)?;
        println!("the tables: {}", out.join("index.html").display());
    }
    Ok(succeeded)
}

/// Returns the rows of all methods and of the kit's functions.
fn rows(kit: &dyn Kit) -> Vec<Row<'_>> {
    let methods = METHODS.iter().map(|method| {
        let hit = method.hit;
        let answer =
            move |inputs: &[Input]| inputs.iter().map(|(ray, triangle)| hit(ray, triangle)).collect();
        Row { name: method.name.into(), answer: Box::new(answer), method: Some(hit) }
    });
    methods.chain(rows_of_kit(kit)).collect()
}

/// Returns the short results of all methods and of the kit's functions.
pub fn summary(kit: &dyn Kit) -> Vec<Summary> {
    judge::gauntlet::summary(rows(kit))
}

/// The results of the reference's searches on scenes that are hard to search, and whether all answers are right.
fn agreement_table(reference: &Source, options: &Options) -> Result<(Table, bool)> {
    let all = agreement::all(reference, options.seed, (options.inputs / 20).max(100))?;
    let row = |scene: &[Agreement]| {
        let sum = |what: fn(&Agreement) -> u64| Thousands(scene.iter().map(what).sum()).to_string();
        let cells =
            [sum(|one| one.rays), sum(|one| one.hits), sum(|one| one.ties), sum(|one| one.mismatches)];
        (scene[0].scene.to_owned(), cells.to_vec())
    };
    let table = Table {
        title: "searches compared with exact tests of all triangles".into(),
        heads: ["answers", "hits", "ties", "wrong"].map(str::to_owned).to_vec(),
        rows: all.chunk_by(|one, next| one.scene == next.scene).map(row).collect(),
        notes: vec![
            "Brute force and the other searches of the reference in each scene. wrong: not a".into(),
            "triangle that is met first by exact arithmetic, or not the hit of brute force.".into(),
        ],
    };
    Ok((table, all.iter().all(|one| one.mismatches == 0)))
}
