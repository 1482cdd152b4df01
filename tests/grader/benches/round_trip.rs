//! Measures the cost of a call through a worker: `cargo bench -p grader --bench round_trip`.
//!
//! The benchmark calls each batch size many times and prints the median. Computing an answer costs the same for each query.
//! The batch of 10,000 shows this cost together with that of sending one query.

use glam::Vec3;
use grader::kits::{Need, Source, Which, root};
use raykata::kit::{Kit, TriangleQuery};
use raykata::ray::Ray;
use raykata::shape::Triangle;
use std::hint::black_box;
use std::time::Instant;

const ROUNDS: usize = 201;

fn main() -> anyhow::Result<()> {
    let worker = Source::prepare(&root()?, Which::Solutions, Need::Checks)?.fresh();

    println!("{:>8}  {:>12}  {:>14}", "queries", "worker µs", "ns per query");
    for batch in [1, 100, 10_000] {
        let queries = vec![query(); batch];
        let took = median((0..ROUNDS).map(|_| microseconds(&*worker, &queries)).collect());
        println!("{batch:>8}  {took:>12.2}  {:>14.1}", 1000.0 * took / batch as f64);
    }
    Ok(())
}

fn query() -> TriangleQuery {
    let triangle = Triangle { a: Vec3::ZERO, b: Vec3::X, c: Vec3::Y };
    TriangleQuery { ray: Ray::new(Vec3::new(0.25, 0.25, 1.0), Vec3::NEG_Z), triangle }
}

fn microseconds(kit: &dyn Kit, queries: &[TriangleQuery]) -> f64 {
    let started = Instant::now();
    black_box(kit.triangle_choice(black_box(queries)));
    started.elapsed().as_secs_f64() * 1e6
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
