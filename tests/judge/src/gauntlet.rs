//! Measures ray/triangle tests on distributions of hard inputs and on closed meshes, against exact arithmetic.

use crate::leak_table;
use crate::table::Table;
use anyhow::Result;
use glam::Vec3;
use oracle::gauntlet::distributions::{DISTRIBUTIONS, Distribution};
use oracle::gauntlet::table::{Cell, Judged, compare, judge, nanoseconds};
use raykata::kit::{Kit, Request, TriangleHit, TriangleQuery, kit_error};
use raykata::ray::Ray;
use raykata::shape::Triangle;
use raykata_cli::cost::Summary;
use raykata_cli::report::bar_of_steps;
use std::hint::black_box;

/// An input of a method: a ray and a triangle.
pub type Input = (Ray, Triangle);
/// The `t` of each hit.
pub type Answers = Vec<Option<f32>>;
/// Answers a batch of inputs.
type Ask<'a> = Box<dyn Fn(&[Input]) -> Answers + Sync + 'a>;

/// Measures a batch of inputs, in seconds.
type Stopwatch<'a> = Box<dyn Fn(&[Input]) -> Option<f64> + Sync + 'a>;

/// A method, or a function of the kit.
pub struct Row<'a> {
    /// The name of the method.
    pub name: String,
    /// Answers all inputs.
    pub answer: Ask<'a>,
    /// The method itself, if a call is cheap. Then triangles are tested one by one, and none after the first hit.
    pub method: Option<fn(&Ray, &Triangle) -> Option<f32>>,
    /// The seconds for a batch, measured in the process of the functions, if that is another one.
    pub seconds: Option<Stopwatch<'a>>,
}

impl Row<'_> {
    /// Nanoseconds per call, with the answer stored.
    fn nanoseconds(&self, judged: &Judged) -> f64 {
        match self.seconds.as_ref().and_then(|seconds| seconds(&judged.inputs)) {
            Some(seconds) => 1e9 * seconds / judged.inputs.len() as f64,
            None => nanoseconds(judged, |inputs| {
                black_box((self.answer)(black_box(inputs)));
            }),
        }
    }
}

/// The functions of the kit that are written.
pub fn rows_of_kit(kit: &dyn Kit) -> Vec<Row<'_>> {
    let example = (Ray::new(Vec3::Z, Vec3::NEG_Z), Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y });
    type Function = fn(&dyn Kit, &[TriangleQuery]) -> Vec<Option<TriangleHit>>;
    type Message = fn(Vec<TriangleQuery>) -> Request;
    let asked: [(&str, Function, Message); 4] = [
        ("kit: triangle_cramer", |kit, queries| kit.triangle_cramer(queries), Request::TriangleCramer),
        ("kit: triangle_gram", |kit, queries| kit.triangle_gram(queries), Request::TriangleGram),
        ("kit: triangle_choice", |kit, queries| kit.triangle_choice(queries), Request::TriangleChoice),
        ("kit: watertight", |kit, queries| kit.watertight(queries), Request::Watertight),
    ];
    let queries = |inputs: &[Input]| -> Vec<TriangleQuery> {
        inputs.iter().map(|&(ray, triangle)| TriangleQuery { ray, triangle }).collect()
    };
    let mut rows = Vec::new();
    for (name, ask, message) in asked {
        let answer = move |inputs: &[Input]| {
            ask(kit, &queries(inputs)).into_iter().map(|hit| hit.map(|hit| hit.t)).collect()
        };
        let seconds = move |inputs: &[Input]| kit.seconds_of(message(queries(inputs)));
        if is_written(name, || answer(&[example])) {
            let (answer, seconds) = (Box::new(answer), Some(Box::new(seconds) as _));
            rows.push(Row { name: name.into(), answer, method: None, seconds });
        }
    }
    rows
}

/// Whether the function `name` of the kit answers `call`. If it is not written yet, prints that it is left out, and why.
pub(crate) fn is_written<A>(name: &str, call: impl FnOnce() -> A) -> bool {
    let answer = kit_error::catch(call);
    if let Err(error) = &answer {
        println!("{name} is left out: {error}");
    }
    answer.is_ok()
}

/// Inputs of each distribution, and rays at the edges and at the vertices of each mesh, for a [`summary`].
const INPUTS_OF_SUMMARY: usize = 10_000;

/// The summaries of all rows.
pub fn summary(rows: Vec<Row<'_>>) -> Vec<Summary> {
    const SEED: u64 = 1;
    let bar = bar_of_steps(rows.len());
    bar.set_message("ray/triangle tests");
    let judged: Vec<Judged> =
        DISTRIBUTIONS.iter().map(|distribution| judge(distribution, SEED, INPUTS_OF_SUMMARY)).collect();
    let summaries = rows.into_iter().map(|row| {
        let wrong = judged.iter().map(|judged| compare(judged, &(row.answer)(&judged.inputs)).wrong);
        let summary = Summary {
            nanoseconds: row.nanoseconds(&judged[0]),
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

/// How often each row is wrong on each distribution and by how much, and how often it leaks.
pub fn tables(rows: Vec<Row<'_>>, n_inputs: u64, seed: u64) -> Result<Vec<Table>> {
    let bar = bar_of_steps(DISTRIBUTIONS.len() + rows.len());
    let judged: Vec<Judged> = DISTRIBUTIONS
        .iter()
        .map(|distribution| {
            bar.inc(1);
            judge(distribution, seed, n_inputs as usize)
        })
        .collect();
    let mut cells: Vec<Vec<Cell>> = Vec::new();
    let mut times = Vec::new();
    for row in &rows {
        cells.push(judged.iter().map(|judged| compare(judged, &(row.answer)(&judged.inputs))).collect());
        times.push(row.nanoseconds(&judged[0]));
        bar.inc(1);
    }
    bar.finish_and_clear();

    let table = |title: &str, note: &str, cell: &dyn Fn(&Cell) -> String| Table {
        title: title.into(),
        heads: DISTRIBUTIONS.iter().map(|distribution| distribution.name.to_owned()).collect(),
        rows: rows
            .iter()
            .zip(&cells)
            .map(|(row, of)| (row.name.clone(), of.iter().map(cell).collect()))
            .collect(),
        notes: vec![note.to_owned()],
    };
    let mut wrong = table("wrong %: wrong verdicts", "ns: time per call, with the answer stored.", &|cell| {
        percent(cell.wrong)
    });
    wrong.heads.push("ns".into());
    for ((_, cells), time) in wrong.rows.iter_mut().zip(times) {
        cells.push(format!("{time:.1}"));
    }
    let margins = table(
        "worst μ: the margin of the worst wrong verdict, in roundings",
        "A stable method stays below 64.",
        &|cell| short(cell.margin),
    );
    let mut ulps =
        table("t, ulps: the error of t that 99 of 100 hits stay below", "The distributions:", &|cell| {
            short(cell.ulps)
        });
    let described = |one: &Distribution| format!("  {:<9} {}", one.name, one.what);
    ulps.notes.extend(DISTRIBUTIONS.iter().map(described));
    Ok(vec![wrong, margins, ulps, leak_table::table(&rows, seed, n_inputs)?])
}

/// A share in %, with two digits after the point.
pub(crate) fn percent(share: f64) -> String {
    match share {
        0.0 => "0".into(),
        share if share < 0.01 => "<0.01".into(),
        share => format!("{share:.2}"),
    }
}

/// The number with three digits.
fn short(number: f64) -> String {
    match number {
        0.0 => "0".into(),
        n if n < 0.01 => "<0.01".into(),
        n if n < 1000.0 => format!("{n:.2}"),
        n => format!("{n:.0e}"),
    }
}
