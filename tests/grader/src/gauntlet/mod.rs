//! `grader gauntlet`: what accuracy costs. Methods against distributions, judged exactly; with `--rays`, the long run
//! that looks for a leak in the reference.

pub mod agreement;
mod long;
mod methods;
mod printed;
mod scenes;
mod secondary_rays;

use crate::kits::{Need, Source, Which};
use crate::report::Thousands;
use agreement::Agreement;
use anyhow::Result;
use judge::gauntlet::{Input, Row, rows_of_kit, tables};
use methods::METHODS;
use raykata::kit::Kit;
use raykata_cli::args::{Given, Misuse, Opt, Spec, names};
use raykata_cli::cost::{self, Summary};
use std::path::{Path, PathBuf};

/// `grader gauntlet`.
pub static SPEC: Spec = Spec {
    name: "grader gauntlet",
    about: "Show what accuracy costs: ways to intersect a triangle against hard inputs, judged exactly.",
    arguments: &[],
    options: &[&[
        Opt::value("--kit", "NAME", "Whose triangle tests join the methods [default: solutions].")
            .choices(&names(&Which::NAMES)),
        Opt::value(
            "--inputs",
            "N",
            "Inputs of each distribution, and rays at each closed mesh [default: 20000].",
        ),
        Opt::value("--seed", "N", "Picks the inputs [default: 1]."),
        Opt::value(
            "--rays",
            "N",
            "Instead of the table: so many rays at edges and as many at vertices for each structure of the reference, \
             and so many at boxes. Goes on where it was stopped.",
        ),
        Opt::value(
            "--state",
            "FILE",
            "Where the long run keeps what it has done [default: out/gauntlet.json].",
        ),
    ]],
};

/// `grader cost`: the same line as `raykata cost`.
pub static COST: Spec = Spec {
    name: "grader cost",
    about: "The same as `raykata cost`, with a chapter about ways to intersect a triangle.",
    arguments: cost::SPEC.arguments,
    options: cost::SPEC.options,
};

/// How long, and whose code.
pub struct Options {
    kit: Which,
    inputs: u64,
    seed: u64,
    rays: Option<u64>,
    state: PathBuf,
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
        })
    }
}

/// Measures as `raykata cost` does, and the methods; whether all went well.
pub fn cost(options: &cost::Options) -> Result<bool> {
    cost::run(options, "cargo run --release -p grader --", Some(&summary))
}

/// Runs the gauntlet; whether nothing leaked.
pub fn run(root: &Path, options: &Options) -> Result<bool> {
    let reference = Source::prepare(root, Which::Solutions, Need::Frames)?;
    if let Some(rays) = options.rays {
        return long::run(&reference, rays, options.seed, &options.state);
    }
    let source = Source::prepare(root, options.kit, Need::Checks)?;
    let kit = source.fresh();
    tables(rows(&*kit), options.inputs, options.seed)?;
    println!();
    agreement_table(&reference, options)
}

/// All methods and the functions of the kit.
fn rows(kit: &dyn Kit) -> Vec<Row<'_>> {
    let methods = METHODS.iter().map(|method| {
        let hit = method.hit;
        let answer =
            move |inputs: &[Input]| inputs.iter().map(|(ray, triangle)| hit(ray, triangle)).collect();
        Row { name: method.name.into(), answer: Box::new(answer), method: Some(hit) }
    });
    methods.chain(rows_of_kit(kit)).collect()
}

/// All methods and the functions of the kit in short.
pub fn summary(kit: &dyn Kit) -> Vec<Summary> {
    judge::gauntlet::summary(rows(kit))
}

/// The reference's searches on scenes that are hard to search; whether all answers are right.
fn agreement_table(reference: &Source, options: &Options) -> Result<bool> {
    let all = agreement::all(reference, options.seed, (options.inputs / 20).max(100))?;
    println!(
        "searches against all triangles, exactly (brute force and 18 searches of hierarchies, on each scene)"
    );
    println!("{:<30}{:>10}{:>10}{:>10}{:>12}{:>8}", "", "answers", "hits", "ties", "by rounding", "wrong");
    for scene in all.chunk_by(|one, next| one.scene == next.scene) {
        let sum = |what: fn(&Agreement) -> u64| Thousands(scene.iter().map(what).sum()).to_string();
        println!(
            "{:<30}{:>10}{:>10}{:>10}{:>12}{:>8}",
            scene[0].scene,
            sum(|one| one.rays),
            sum(|one| one.hits),
            sum(|one| one.ties),
            sum(|one| one.roundings),
            sum(|one| one.mismatches)
        );
    }
    println!(
        "by rounding: the ray passes exactly through an edge, and double precision took it for a neighbour or a miss.\n\
         wrong: not among the triangles that are exactly met first, or not what asking all triangles finds."
    );
    Ok(all.iter().all(|one| one.mismatches == 0))
}
