//! A worker that misbehaves, for the tests beside it and for those of the grader. A negative radius of the
//! first sphere selects how; all other requests are answered by the reference.

use raykata::frame::Tile;
use raykata::kit::{Answer, Request};
use raykata::worker::{Reply, send};
use std::hint::black_box;
use std::io::Write;
use std::time::Duration;

fn recurse(depth: u64) -> u64 {
    if black_box(depth) == u64::MAX { 0 } else { 1 + black_box(recurse(depth + 1)) }
}

/// The pipe to the judge, opened without the library.
#[cfg(unix)]
fn pipe() -> impl std::io::Write {
    use std::os::fd::AsFd;
    let stdin = std::io::stdin().as_fd().try_clone_to_owned().expect("a pipe");
    std::os::unix::net::UnixStream::from(stdin)
}

#[cfg(not(unix))]
fn pipe() -> impl std::io::Write {
    std::io::stdout()
}

fn say(reply: &Reply) -> bool {
    send(&mut pipe(), reply).is_ok()
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
                -8 => return Answer::EncodeGamma(vec![1]),
                -10 => drop(black_box(vec![1_u8; 3 << 30])),
                -11 => std::thread::sleep(Duration::from_secs(3600)),
                -14 => std::thread::sleep(Duration::from_secs(3)),
                -12 => panic!("{:?}", std::fs::read("/etc/passwd").map_err(|error| error.kind())),
                -13 => panic!(
                    "{:?}",
                    std::process::Command::new("/bin/sh").spawn().map_err(|error| error.kind())
                ),
                // Bytes that are not a message.
                -20 => drop(pipe().write_all(&[8, 0, 0, 0, 255, 255, 255, 255, 255, 255, 255, 255])),
                // A message that never ends.
                -21 => drop(pipe().write_all(&[255; 4096])),
                -22 => while say(&Reply::Progress { done: 0, total: 1 }) {},
                // Pixels, although no frame was requested.
                -25 => drop(say(&Reply::Tile(Tile { x: 0, y: 0, width: 1, pixels: vec![glam::Vec3::ONE] }))),
                -23 => drop(say(&Reply::Answer(Box::new(Answer::Render(None))))),
                // Answers to all future requests.
                -24 => while say(&Reply::Answer(Box::new(Answer::SphereAlgebraic(vec![Some(1.0)])))) {},
                _ => {}
            }
        }
        request.answer(&*solutions::kit(), watch)
    });
}
