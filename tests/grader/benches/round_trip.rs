//! What a call through a worker costs: `cargo bench -p grader --bench round_trip`.
//!
//! Each batch size is asked many times, linked and through the pipe by turns; the median of each is printed.

use glam::Vec3;
use grader::kits::{Source, build_worker, root};
use raykata::kit::{Kit, TriangleQuery};
use raykata::ray::Ray;
use raykata::shape::Triangle;
use std::hint::black_box;
use std::time::Instant;

const ROUNDS: usize = 201;

fn main() -> anyhow::Result<()> {
    let worker = Source::Worker(build_worker(&root()?, "solutions")?).fresh();
    let linked = Source::Solutions.fresh();

    println!("{:>8}  {:>12}  {:>12}  {:>14}", "queries", "linked µs", "worker µs", "ns a query");
    for batch in [1, 100, 10_000] {
        let queries = vec![query(); batch];
        let (mut by_link, mut by_pipe) = (Vec::new(), Vec::new());
        for _ in 0..ROUNDS {
            by_link.push(microseconds(&*linked, &queries));
            by_pipe.push(microseconds(&*worker, &queries));
        }
        let (linked, worker) = (median(by_link), median(by_pipe));
        println!("{batch:>8}  {linked:>12.2}  {worker:>12.2}  {:>14.1}", 1000.0 * worker / batch as f64);
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
