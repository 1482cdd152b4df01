//! `grader gauntlet`: what accuracy costs. Methods against distributions, judged exactly; with `--rays`, the long run
//! that looks for a leak in the reference.

pub mod agreement;
mod leaving;
mod long;
mod methods;
mod printed;
mod scenes;

use crate::kits::{Need, Source, Which};
use crate::report::Thousands;
use agreement::Agreement;
use anyhow::Result;
use clap::Args;
use judge::gauntlet::{Input, Row, rows_of_kit, tables};
use methods::METHODS;
use raykata::kit::Kit;
use raykata_cli::args::chosen;
use raykata_cli::cost::Summary;
use std::path::{Path, PathBuf};

/// How long, and whose code.
#[derive(Args)]
pub struct Options {
    /// Whose triangle tests join the methods: exercises or solutions.
    #[arg(long, default_value = "solutions", value_parser = |text: &str| chosen(text, &Which::NAMES))]
    kit: Which,
    /// Inputs of each distribution, and rays at each closed mesh.
    #[arg(long, default_value_t = 20_000, value_parser = clap::value_parser!(u64).range(100..))]
    inputs: u64,
    /// Picks the inputs.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Instead of the table: so many rays at edges and as many at vertices for each structure of the reference, and so
    /// many at boxes. Goes on where it was stopped.
    #[arg(long)]
    rays: Option<u64>,
    /// Where the long run keeps what it has done.
    #[arg(long, default_value = "out/gauntlet.json")]
    state: PathBuf,
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
