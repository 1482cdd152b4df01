//! `raykata gauntlet`: what accuracy costs. Methods against distributions, judged exactly; with `--rays`, the long run
//! that looks for a leak in the reference.

pub mod agreement;
mod leak_table;
mod leaving;
mod long;
mod methods;
mod printed;
pub mod traversal;

use crate::kits::{Source, Which};
use crate::report::{Thousands, bar_of_steps};
use agreement::Agreement;
use anyhow::Result;
use clap::Args;
use glam::Vec3;
use methods::METHODS;
use oracle::gauntlet::distributions::DISTRIBUTIONS;
use oracle::gauntlet::table::{Cell, Judged, compare, judge, nanoseconds};
use raykata::kit::{Kit, TriangleQuery, mishap};
use raykata::ray::Ray;
use raykata::shape::Triangle;
use serde::Serialize;
use std::hint::black_box;
use std::path::PathBuf;

/// How long, and whose code.
#[derive(Args)]
pub struct Options {
    /// Whose triangle tests join the methods.
    #[arg(long, value_enum, default_value_t = Which::Solutions)]
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
pub fn run(options: &Options) -> Result<bool> {
    match options.rays {
        Some(rays) => long::run(rays, options.seed, &options.state),
        None => tables(options),
    }
}

/// A question to a method.
type Input = (Ray, Triangle);
/// The `t` of each hit.
type Answers = Vec<Option<f32>>;
/// Answers many questions.
type Ask<'a> = Box<dyn Fn(&[Input]) -> Answers + 'a>;

/// A method or a function of the kit: its name, and how it answers all inputs.
struct Row<'a> {
    name: String,
    answer: Ask<'a>,
}

fn rows(kit: &dyn Kit) -> Vec<Row<'_>> {
    let methods = METHODS.iter().map(|method| Row {
        name: method.name.into(),
        answer: Box::new(|inputs| inputs.iter().map(|(ray, triangle)| (method.hit)(ray, triangle)).collect()),
    });
    let mut rows: Vec<Row<'_>> = methods.collect();
    let example = (Ray::new(Vec3::Z, Vec3::NEG_Z), Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y });
    type Function = fn(&dyn Kit, &[TriangleQuery]) -> Vec<Option<raykata::kit::TriangleHit>>;
    let asked: [(&str, Function); 3] = [
        ("kit: triangle_cramer", |kit, queries| kit.triangle_cramer(queries)),
        ("kit: triangle_gram", |kit, queries| kit.triangle_gram(queries)),
        ("kit: triangle_choice", |kit, queries| kit.triangle_choice(queries)),
    ];
    for (name, ask) in asked {
        let answer = move |inputs: &[Input]| {
            let queries: Vec<TriangleQuery> =
                inputs.iter().map(|&(ray, triangle)| TriangleQuery { ray, triangle }).collect();
            ask(kit, &queries).into_iter().map(|hit| hit.map(|hit| hit.t)).collect()
        };
        // A row that is not written yet is left out, with a word about it.
        match mishap::catch(|| answer(&[example])) {
            Ok(_) => rows.push(Row { name: name.into(), answer: Box::new(answer) }),
            Err(mishap) => println!("{name} is left out: {mishap}"),
        }
    }
    rows
}

/// A method in three numbers.
#[derive(Clone, Debug, Serialize)]
pub struct Summary {
    /// What it is called.
    pub name: String,
    /// Of one call, with the answer stored.
    pub nanoseconds: f64,
    /// Verdicts that are not the exact one, mean over all distributions.
    pub wrong_per_million: f64,
    /// Rays from inside closed meshes, at edges and vertices, that meet nothing.
    pub leaks_per_million: f64,
}

/// Inputs of each distribution, and rays at the edges and at the vertices of each mesh, for a [`summary`].
const INPUTS_OF_SUMMARY: usize = 10_000;

/// All methods and the functions of the kit in short.
pub fn summary(kit: &dyn Kit) -> Vec<Summary> {
    const SEED: u64 = 1;
    let rows = rows(kit);
    let bar = bar_of_steps(rows.len());
    bar.set_message("ray/triangle tests");
    let judged: Vec<Judged> =
        DISTRIBUTIONS.iter().map(|distribution| judge(distribution, SEED, INPUTS_OF_SUMMARY)).collect();
    let summaries = rows.into_iter().map(|row| {
        let wrong = judged.iter().map(|judged| compare(judged, &(row.answer)(&judged.inputs)).wrong);
        let summary = Summary {
            nanoseconds: nanoseconds(&judged[0], |inputs| {
                black_box((row.answer)(black_box(inputs)));
            }),
            wrong_per_million: 1e4 * wrong.sum::<f64>() / judged.len() as f64,
            leaks_per_million: leak_table::per_million(&row, SEED, INPUTS_OF_SUMMARY as u64),
            name: row.name,
        };
        bar.inc(1);
        summary
    });
    let summaries = summaries.collect();
    bar.finish_and_clear();
    summaries
}

fn tables(options: &Options) -> Result<bool> {
    let source = Source::here(options.kit)?;
    let kit = &*source.fresh();
    let rows = rows(kit);
    let bar = bar_of_steps(DISTRIBUTIONS.len() + rows.len());
    let judged: Vec<Judged> = DISTRIBUTIONS
        .iter()
        .map(|distribution| {
            bar.inc(1);
            judge(distribution, options.seed, options.inputs as usize)
        })
        .collect();
    let mut cells: Vec<Vec<Cell>> = Vec::new();
    let mut times = Vec::new();
    for row in &rows {
        cells.push(judged.iter().map(|judged| compare(judged, &(row.answer)(&judged.inputs))).collect());
        times.push(nanoseconds(&judged[0], |inputs| {
            black_box((row.answer)(black_box(inputs)));
        }));
        bar.inc(1);
    }
    bar.finish_and_clear();

    let heads: Vec<&str> = DISTRIBUTIONS.iter().map(|distribution| distribution.name).collect();
    print_table("wrong %", &rows, &heads, |row, column| percent(cells[row][column].wrong), Some(&times));
    print_table("worst μ", &rows, &heads, |row, column| short(cells[row][column].margin), None);
    print_table("t, ulps", &rows, &heads, |row, column| short(cells[row][column].ulps), None);
    println!(
        "wrong %: verdicts that are not the exact one; ns: of one call, with the answer stored (interior).\n\
         worst μ: how many roundings the worst of them was from flipping; a stable method stays below 64.\n\
         t, ulps: 99 of 100 hits have a t that is off by less.\n\n\
         The distributions:"
    );
    for distribution in &DISTRIBUTIONS {
        println!("  {:<9} {}", distribution.name, distribution.what);
    }
    println!();
    leak_table::table(&rows, options.seed, options.inputs)?;
    println!();
    Ok(agreement_table(options))
}

/// The reference's searches on scenes that are hard to search; whether all answers are right.
fn agreement_table(options: &Options) -> bool {
    let all = agreement::all(options.seed, (options.inputs / 20).max(100));
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
    all.iter().all(|one| one.mismatches == 0)
}

fn print_table(
    title: &str,
    rows: &[Row<'_>],
    heads: &[&str],
    cell: impl Fn(usize, usize) -> String,
    times: Option<&[f64]>,
) {
    let columns: String = heads.iter().map(|head| format!("{head:>9}")).collect();
    println!("{title:<36}{columns}{}", if times.is_some() { "       ns" } else { "" });
    for (index, row) in rows.iter().enumerate() {
        let cells: String = (0..heads.len()).map(|column| format!("{:>9}", cell(index, column))).collect();
        let time = times.map_or(String::new(), |times| format!("{:>9.1}", times[index]));
        println!("{:<36}{cells}{time}", row.name);
    }
    println!();
}

fn percent(share: f64) -> String {
    match share {
        0.0 => "0".into(),
        share if share < 0.01 => "<0.01".into(),
        share => format!("{share:.2}"),
    }
}

/// Three digits, whatever the size.
fn short(number: f64) -> String {
    match number {
        0.0 => "0".into(),
        n if n < 0.01 => "<0.01".into(),
        n if n < 1000.0 => format!("{n:.2}"),
        n => format!("{n:.0e}"),
    }
}
