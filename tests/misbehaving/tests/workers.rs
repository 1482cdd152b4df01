//! Code in a worker may panic, loop, overflow its stack or end its process. Then only the current call fails,
//! with a message that says what happened, and the next call is answered normally.

mod asking;

use asking::{ask, how_it_crashed};
use raykata::frame::{Unwatched, Watch};
use raykata::kit::{Door, Frames, KitError, RenderJob, View};
use raykata_cli::worker::Worker;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

fn door() -> Door<Worker> {
    Door(Worker::new(env!("CARGO_BIN_EXE_misbehaving-worker").into(), Duration::from_secs(2)))
}

#[test]
fn an_honest_answer_crosses_the_pipe() {
    assert_eq!(ask(&door(), 10.0), Ok(vec![Some(10.0)]));
}

#[test]
fn a_panic_keeps_its_place() {
    let Err(KitError::Panicked { message, place }) = ask(&door(), -1.0) else { panic!("no panic") };
    assert_eq!(message, "on purpose");
    assert!(place.contains("misbehaving/src/main.rs:"), "{place}");
}

#[test]
fn each_way_to_die_is_reported_and_the_next_call_is_answered() {
    let door = door();
    assert!(how_it_crashed(ask(&door, -2.0)).contains("exit status: 0"));
    assert_eq!(ask(&door, 10.0), Ok(vec![Some(10.0)]));
    how_it_crashed(ask(&door, -3.0));
    assert_eq!(how_it_crashed(ask(&door, -4.0)), "the stack overflowed: is there an infinite recursion?");
    assert_eq!(ask(&door, 10.0), Ok(vec![Some(10.0)]));
}

#[test]
fn an_endless_loop_ends() {
    let door = door();
    let started = Instant::now();
    assert_eq!(ask(&door, -5.0), Err(KitError::TimedOut { seconds: 2 }));
    assert_eq!(ask(&door, -11.0), Err(KitError::Waited { seconds: 2 }));
    // Test only that the call ends: without the watchdog this test hangs.
    assert!(started.elapsed() < Duration::from_secs(60));
    assert_eq!(ask(&door, 10.0), Ok(vec![Some(10.0)]));
}

#[test]
fn what_student_code_prints_does_not_reach_the_pipe() {
    assert_eq!(ask(&door(), -6.0), Ok(vec![None]));
}

#[test]
fn an_answer_of_the_wrong_kind_or_length_is_refused() {
    let door = door();
    for radius in [-7.0, -8.0, -25.0] {
        assert!(matches!(ask(&door, radius), Err(KitError::Malformed { .. })), "{radius}");
    }
}

#[test]
fn a_program_that_is_not_there_is_reported() {
    let door = Door(Worker::new("no/such/worker".into(), Duration::from_secs(2)));
    assert!(how_it_crashed(ask(&door, 10.0)).starts_with("it cannot be started"));
}

#[test]
fn a_frame_through_the_pipe_is_the_frame_that_is_linked() {
    let file = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/stage2.toml"));
    let mut scene = raykata::scene::load::load(file).expect("the scene");
    (scene.film.width, scene.film.height) = (40, 25);
    let job = RenderJob { scene, view: View::Shaded, seed: 3, threads: 2, count: true, reuse: false };

    struct Seen(AtomicU64);
    impl Watch for Seen {
        fn progress(&self, done: u64, total: u64) {
            assert_eq!(total, 1000);
            self.0.fetch_max(done, Ordering::Relaxed);
        }
    }
    let seen = Seen(AtomicU64::new(0));
    let piped = door().render(&job, &seen).expect("not cancelled");
    let linked = solutions::kit().render(&job, &Unwatched).expect("not cancelled");
    assert_eq!((piped.film, piped.counts, piped.notes), (linked.film, linked.counts, linked.notes));
    assert_eq!(seen.0.load(Ordering::Relaxed), 1000);
}

#[test]
fn a_frame_that_is_no_longer_wanted_ends() {
    struct Unwanted;
    impl Watch for Unwanted {
        fn progress(&self, _: u64, _: u64) {}
        fn cancelled(&self) -> bool {
            true
        }
    }
    let file = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/stage1.toml"));
    let scene = raykata::scene::load::load(file).expect("the scene");
    let job = RenderJob { scene, view: View::Shaded, seed: 3, threads: 1, count: false, reuse: false };
    let door = door();
    assert_eq!(door.render(&job, &Unwanted), None);
    assert_eq!(ask(&door, 10.0), Ok(vec![Some(10.0)]));
}
