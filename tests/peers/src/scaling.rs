//! How much faster two threads build the binary tree than one.

use crate::reference;
use raykata::shape::Triangle;
use raykata::wide::Forks;
use rayon::{ThreadPool, ThreadPoolBuilder};
use solutions::stage12_build::build_parallel;
use std::time::Instant;

/// An odd number, so that there is a median.
const ROUNDS: usize = 9;

/// The ratio of the elapsed times of `build_parallel` on one and on two threads, which build in turn: the median of all rounds, and the
/// smallest and largest. Other work on the machine disturbs it, because elapsed time counts and not processor time.
pub fn measured(triangles: &[Triangle]) -> String {
    let bounds = reference::bounds(triangles);
    let pool = |threads| ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
    let seconds = |pool: &ThreadPool| {
        pool.install(|| {
            let started = Instant::now();
            std::hint::black_box(build_parallel(&bounds, &mut Forks::new(rayon::current_num_threads() > 1)));
            started.elapsed().as_secs_f64()
        })
    };
    let (one, two) = (pool(1), pool(2));
    // The first round fills the caches and does not count.
    let mut rounds: Vec<[f64; 3]> = (0..=ROUNDS)
        .map(|_| {
            let (alone, together) = (seconds(&one), seconds(&two));
            [alone / together, alone, together]
        })
        .skip(1)
        .collect();
    rounds.sort_by(|p, q| p[0].total_cmp(&q[0]));
    let [ratio, alone, together] = rounds[ROUNDS / 2];
    format!(
        "two threads build {ratio:.2} times as fast as one ({alone:.2} s, {together:.2} s; rounds from {:.2} to {:.2})",
        rounds[0][0],
        rounds[ROUNDS - 1][0]
    )
}
