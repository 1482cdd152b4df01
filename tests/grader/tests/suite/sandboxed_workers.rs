//! Tests the judge with sandboxed workers that misbehave: each bad call gives one error, and the judge never waits for
//! ever.

#[path = "../../../misbehaving/tests/asking/mod.rs"]
mod asking;

use asking::{ask, how_it_crashed, query};
use grader::kits::{self, Need, Program, Source, Which};
use grader::sandbox::{Purpose, Sandbox};
use grader::worker::Worker;
use raykata::frame::{Unwatched, Watch};
use raykata::kit::{Door, Frames, KitError, RenderJob, Shapes, SphereQuery, View, kit_error};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::Duration;

fn sandboxed(program: impl Into<PathBuf>, seconds: u64) -> Door<Worker> {
    Door(Worker::sandboxed(program.into(), Duration::from_secs(seconds), Sandbox::new(Purpose::Worker)))
}

/// The program that misbehaves. It is a separate package, because it links the solutions.
fn misbehaving() -> PathBuf {
    static BUILT: OnceLock<PathBuf> = OnceLock::new();
    let build = || {
        let program = Program { package: "misbehaving", name: "misbehaving-worker", feature: None };
        let built = kits::build(&kits::root().expect("a kit"), "a worker that misbehaves", [program]);
        let [program] = built.expect("it builds");
        program
    };
    BUILT.get_or_init(build).clone()
}

fn door() -> Door<Worker> {
    sandboxed(misbehaving(), 1)
}

fn crash(door: &Door<Worker>, radius: f32) -> String {
    how_it_crashed(ask(door, radius))
}

#[test]
fn an_honest_worker_passes_every_check_in_a_sandbox() {
    for (_, checks) in all_checks::STAGES {
        for check in *checks {
            // Use the time limit of the student's program: some checks are slow while other tests run.
            let kit = sandboxed(misbehaving(), 10);
            let kit: std::sync::Arc<dyn raykata::kit::Kit + Send + Sync> = std::sync::Arc::new(kit);
            assert_eq!(checks::run(check, &kit, 0), checks::Verdict::Passed, "{}", check.name);
        }
    }
}

#[test]
fn each_death_is_reported_and_the_next_call_is_answered() {
    let door = door();
    assert!(crash(&door, -2.0).contains("exit status: 0"));
    assert_eq!(ask(&door, 10.0), Ok(vec![Some(10.0)]));
    assert!(crash(&door, -3.0).contains("SIGABRT"));
    assert!(crash(&door, -4.0).starts_with("the stack overflowed, or memory was touched"));
    assert_eq!(crash(&door, -10.0), "it used more memory than its limit of 1 GiB");
    assert_eq!(ask(&door, 10.0), Ok(vec![Some(10.0)]));
    assert!(
        crash(&sandboxed("/no/such/worker", 1), 10.0)
            .contains("cannot be started: the sandbox: /no/such/worker")
    );
}

#[test]
fn files_and_processes_are_out_of_reach() {
    for radius in [-12.0, -13.0] {
        let Err(KitError::Panicked { message, .. }) = ask(&door(), radius) else { panic!("no panic") };
        assert_eq!(message, "Err(PermissionDenied)");
    }
}

#[test]
fn loops_and_sleepers_end_and_a_slow_machine_is_no_loop() {
    let door = door();
    assert_eq!(ask(&door, -5.0), Err(KitError::TimedOut { seconds: 1 }));
    assert_eq!(ask(&door, -11.0), Err(KitError::Waited { seconds: 3 }));
    // It sleeps for three seconds, as on a busy machine. The limit counts processor time, so the call succeeds.
    assert!(ask(&sandboxed(misbehaving(), 2), -14.0).is_ok());
}

#[test]
fn what_is_no_answer_is_an_error() {
    let door = door();
    for radius in [-7.0, -8.0, -20.0, -21.0, -22.0, -23.0, -25.0] {
        let outcome = ask(&door, radius);
        assert!(matches!(outcome, Err(KitError::Malformed { .. })), "{radius}: {outcome:?}");
        assert_eq!(ask(&door, 10.0), Ok(vec![Some(10.0)]));
    }
}

#[test]
fn a_worker_that_does_not_read_does_not_stop_the_judge() {
    // Send more than a socket buffers, so that writing blocks.
    let many: Vec<SphereQuery> = std::iter::repeat_n(query(10.0), 200_000).collect();
    // This program neither answers nor reads.
    let outcome = kit_error::catch(|| sandboxed("/usr/bin/yes", 1).sphere_algebraic(&many));
    assert_eq!(outcome, Err(KitError::TimedOut { seconds: 1 }));
    // This worker answers this question and all later ones without reading them.
    let door = door();
    assert_eq!(ask(&door, -24.0), Ok(vec![Some(1.0)]));
    let outcome = kit_error::catch(|| door.sphere_algebraic(&many));
    assert_eq!(outcome, Err(KitError::Waited { seconds: 3 }));
}

#[test]
fn a_frame_in_a_sandbox_is_the_frame_outside() {
    let file = Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/stage2.toml"));
    let mut scene = raykata::scene::load::load(file).expect("the scene");
    (scene.film.width, scene.film.height) = (40, 25);
    // Ask for two threads. A sandbox allows none.
    let job = RenderJob { scene, view: View::Shaded, seed: 3, threads: 2, count: true, reuse: false };
    let watch: &dyn Watch = &Unwatched;
    let kit = sandboxed(misbehaving(), 10);
    let sandboxed = kit.render(&job, watch).expect("the frame is not cancelled");
    let solutions = Source::prepare(&kits::root().expect("a kit"), Which::Solutions, Need::Frames);
    let free = solutions.expect("it builds").fresh().render(&job, watch).expect("the frame is not cancelled");
    assert_eq!((sandboxed.film, sandboxed.counts, sandboxed.notes), (free.film, free.counts, free.notes));
}
