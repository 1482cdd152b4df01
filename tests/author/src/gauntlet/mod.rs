//! `author gauntlet`: shows what accuracy costs. It runs intersection methods on distributions of hard inputs and judges
//! them by exact arithmetic.
//!
//! `methods` (triangle tests) · `files` (the tables as a page)

mod files;
mod methods;

use anyhow::Result;
use grader::kits::{Need, Source, Which, root};
use judge::boxes_and_offsets;
use judge::gauntlet::{Input, Row, rows_of_kit, tables};
use methods::METHODS;
use raykata::kit::Kit;
use raykata_cli::args::{Given, Opt, Spec, names};
use raykata_cli::cost::{self, Summary};

/// `author gauntlet`.
pub static SPEC: Spec = Spec {
    name: "author gauntlet",
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
        Opt::value("--out", "FOLDER", "Also write the tables to this folder: index.html and gauntlet.csv.")
            .short("-o"),
    ]],
};

/// `author cost`, with the same options as `raykata cost`.
pub static COST: Spec = Spec {
    name: "author cost",
    about: "The same as `raykata cost`, with a chapter about triangle tests.",
    arguments: cost::SPEC.arguments,
    options: cost::SPEC.options,
};

/// Measures the same as `raykata cost`, and the intersection methods. Returns whether it succeeded.
pub fn cost(given: &Given) -> Result<bool> {
    cost::run(given, Some("author"), Some(&summary))
}

/// Runs the gauntlet.
pub fn run(given: &Given) -> Result<bool> {
    let which = given.choice("--kit", &Which::NAMES)?.unwrap_or(Which::Solutions);
    let inputs = given.number("--inputs", 100..=u64::MAX)?.unwrap_or(20_000);
    let seed = given.number("--seed", 0..=u64::MAX)?.unwrap_or(1);
    let kit = Source::prepare(&root()?, which, Need::Checks)?.fresh();
    let mut tables = tables(rows(&*kit), inputs, seed)?;
    tables.extend(boxes_and_offsets::tables(&*kit, inputs, seed));
    for table in &tables {
        println!("{}", table.text());
    }
    if let Some(out) = given.path("--out") {
        files::write(&out, "gauntlet", &tables)?;
        println!("the tables: {}", out.join("index.html").display());
    }
    Ok(true)
}

/// Returns the rows of all methods and of the kit's functions.
fn rows(kit: &dyn Kit) -> Vec<Row<'_>> {
    let methods = METHODS.into_iter().map(|(name, hit)| {
        let answer =
            move |inputs: &[Input]| inputs.iter().map(|(ray, triangle)| hit(ray, triangle)).collect();
        Row { name: name.into(), answer: Box::new(answer), method: Some(hit), seconds: None }
    });
    methods.chain(rows_of_kit(kit)).collect()
}

/// Returns the short results of all methods and of the kit's functions.
pub fn summary(kit: &dyn Kit) -> Vec<Summary> {
    judge::gauntlet::summary(rows(kit))
}
