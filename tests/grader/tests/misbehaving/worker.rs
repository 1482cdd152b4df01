//! A worker that does everything wrong, for `workers.rs`. The radius of the first sphere says what, if it is
//! below zero; other questions are answered as the reference would.

use raykata::kit::{Answer, Request};
use std::hint::black_box;

fn recurse(depth: u64) -> u64 {
    if black_box(depth) == u64::MAX { 0 } else { 1 + black_box(recurse(depth + 1)) }
}

/// Late for ever, but only once: the process that is asked next finds the mark that the one before left, and goes on.
fn late_once(mark: u32) {
    let mark = std::env::temp_dir().join(format!("raykata-late-{mark}"));
    if std::fs::File::create_new(&mark).is_ok() {
        loop {
            std::thread::park();
        }
    }
    let _ = std::fs::remove_file(mark);
}

fn main() {
    raykata::worker::serve_with(&|request, watch| {
        if let Request::SphereAlgebraic(queries) = request {
            match queries[0].sphere.radius as i32 {
                -1 => panic!("on purpose"),
                -2 => std::process::exit(0),
                -3 => std::process::abort(),
                -4 => println!("{}", recurse(0)),
                -5 => loop {
                    std::hint::spin_loop();
                },
                -6 => println!("test result: ok. 24 passed; 0 failed"),
                -7 => return Answer::SphereAlgebraic(vec![]),
                -9 => late_once(queries[0].ray.t_max as u32),
                -8 => return Answer::EncodeGamma(vec![1]),
                _ => {}
            }
        }
        request.answer(&solutions::Kit, watch)
    });
}
