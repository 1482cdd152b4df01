//! `raykata check`, and `raykata` without a command: the points of a student and the next step.

use crate::lint;
use all_checks::STAGES;
use anyhow::Result;
use checks::broken::with_output;
use checks::calls::breaking_call;
use checks::rubric::{self, CheckEntry, RUBRIC, Score};
use checks::{Check, CheckResult, Verdict};
use raykata::kit::{Door, Kit, KitError};
use raykata::worker::send;
use raykata_cli::finish;
use raykata_cli::kits::{Source, Which, with_exercises};
use raykata_cli::queue;
use raykata_cli::report::bar_of_steps;
use raykata_cli::verdicts::CheckVerdict;
use raykata_cli::worker::{CALL_PATIENCE, Worker};
use std::ffi::OsStr;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};
use std::time::Duration;

/// The longest time of a call after another call that does not end. The slowest call of the reference needs a tenth of it.
const SHORT_PATIENCE: Duration = Duration::from_secs(1);

/// A check and its verdict.
struct Graded {
    check: &'static Check,
    verdict: Verdict,
    entry: CheckEntry,
}

impl Graded {
    fn passed(&self) -> bool {
        self.verdict == Verdict::Passed
    }

    /// Whether the course asks for the check, and it does not pass.
    fn is_open(&self) -> bool {
        self.entry.is_asked_for() && !self.passed()
    }

    fn earned(&self) -> u32 {
        if self.passed() { self.entry.points } else { 0 }
    }
}

/// Runs the checks of the stages for which `wanted` is true on all cores, each with a kit of its own, and hands each verdict to
/// `report` as soon as it is known, with the error if this is the first call that does not end. From then on a call gets a tenth
/// of the time, because most of them wait for the same function. One that exceeds it may be slow and right: it is not judged.
fn run_checks(
    source: &Source,
    wanted: impl Fn(u8) -> bool,
    report: impl Fn(&Graded, Option<KitError>) -> Result<()> + Sync,
) -> Result<Vec<Graded>> {
    let of_stages = STAGES.iter().filter(|(stage, _)| wanted(*stage));
    let checks: Vec<&'static Check> = of_stages.flat_map(|(_, checks)| checks.iter()).collect();
    let first_endless = OnceLock::new();
    queue::run(&queue::one_a_core(), &checks, |(), &check| {
        let endless = first_endless.get().copied();
        let patience = if endless.is_some() { SHORT_PATIENCE } else { CALL_PATIENCE };
        let worker = Worker::new(source.program.clone(), patience).with_short_frames();
        let kit: Arc<dyn Kit + Send + Sync> = Arc::new(Door(worker));
        let examined = checks::examine(check, &kit, 0, checks::Inputs::default());
        let call = breaking_call(&examined);
        let is_late =
            |error: &&KitError| matches!(error, KitError::TimedOut { .. } | KitError::Waited { .. });
        let hangs = examined.as_ref().err().filter(is_late);
        let hangs = hangs.filter(|_| first_endless.set(check.name).is_ok()).cloned();
        let (mut verdict, entry) =
            (verdict(check, examined, endless), rubric::entry(check.stage, check.name));
        if let (Verdict::Failed(message), Some(call)) = (&mut verdict, call) {
            *message = with_output(message, &Worker::alone(source.program.clone(), call).1);
        }
        let graded = Graded { check, verdict, entry };
        report(&graded, hangs)?;
        Ok(graded)
    })
}

/// The verdict on a check that ran after the check `endless` has found a call that does not end, or with the whole time.
fn verdict(check: &Check, examined: Result<CheckResult, KitError>, endless: Option<&str>) -> Verdict {
    let short = SHORT_PATIENCE.as_secs();
    match (endless, &examined) {
        (Some(endless), Err(KitError::TimedOut { seconds } | KitError::Waited { seconds }))
            if *seconds == short =>
        {
            checks::without_answer(
                check,
                format_args!(
                    "not judged: no answer after {short} s, and a call of the check {endless} does not end.\n  Repair that \
                 call first: then each call has {} s again.",
                    CALL_PATIENCE.as_secs()
                ),
            )
        }
        _ => checks::verdict(check, examined),
    }
}

/// The same, with a progress bar. It tells at once which check has found a call that does not end.
fn run_checks_with_bar(source: &Source, wanted: impl Fn(u8) -> bool) -> Result<Vec<Graded>> {
    let bar = bar_of_steps(0);
    bar.set_message("checks");
    bar.tick();
    let graded = run_checks(source, wanted, |graded, hangs| {
        bar.set_message(format!("checks of stage {}", graded.check.stage));
        if let Some(error) = hangs {
            bar.suspend(|| eprintln!("{}: {error}\nThe other checks go on.", graded.check.name));
        }
        Ok(())
    });
    bar.finish_and_clear();
    graded
}

/// Writes the verdicts of a stage to `out` as messages, each as soon as it is known.
pub fn tell(source: &Source, stage: u8, out: impl Write + Send) -> Result<()> {
    let out = Mutex::new(out);
    let report = |graded: &Graded, _| {
        let (check, verdict) = (graded.check.name.into(), graded.verdict.clone());
        Ok(send(&mut *out.lock().unwrap_or_else(PoisonError::into_inner), &CheckVerdict { check, verdict })?)
    };
    run_checks(source, |number| number == stage, report).map(drop)
}

/// The columns of the terminal.
fn columns() -> usize {
    #[cfg(unix)]
    if let Ok(size) = rustix::termios::tcgetwinsize(std::io::stdout())
        && size.ws_col > 0
    {
        return size.ws_col.into();
    }
    80
}

/// Prints the scorecard, and the finish of the stage if all its checks passed that are asked for; `Ok(true)` if all passed.
pub fn scorecard(root: &Path, source: &Source, stage: Option<u8>) -> Result<bool> {
    if source.which == Which::Exercises {
        warnings(root)?.iter().for_each(|warning| eprintln!("{warning}"));
    }
    let wanted = |number| is_asked_for(number) && stage.is_none_or(|stage| stage == number);
    let graded = run_checks_with_bar(source, wanted)?;
    for (number, _) in STAGES.iter().filter(|(number, _)| wanted(*number)) {
        let of_stage: Vec<&Graded> = graded.iter().filter(|one| one.check.stage == *number).collect();
        println!("{}", stage_line(*number, &of_stage));
        for one in &of_stage {
            let word = match &one.verdict {
                Verdict::Passed => "ok",
                Verdict::NotWritten { .. } => "not written",
                Verdict::Failed(_) => "FAILED",
            };
            let CheckEntry { points, title, .. } = &one.entry;
            let (earned, level) = (one.earned(), one.entry.level().word());
            println!("  {word:<11}  {earned:>2}/{points:<2} {level:<8}  {:<52}  {title}", one.check.name);
        }
        println!();
    }
    for one in &graded {
        if let Verdict::Failed(message) = &one.verdict {
            println!("{message}");
        }
    }
    for (place, (task, waiting)) in gaps(&graded) {
        let checks = if waiting == 1 { "1 check waits" } else { &format!("{waiting} checks wait") };
        println!("not written yet: {place}\n  {task} ({checks} for it)");
    }
    let passed = graded.iter().filter(|one| one.passed()).count();
    println!("\n{}\n{passed} passed, {} failed", score(&graded), graded.len() - passed);
    let is_done = !graded.iter().any(Graded::is_open);
    // The verdict does not depend on the picture.
    if let Some(stage) = stage.filter(|_| is_done)
        && let Err(error) = finish::show(root, source.which, stage, columns())
    {
        eprintln!("{error:#}");
    }
    Ok(is_done)
}

/// What the grader refuses or stops in the exercises, one line each.
fn warnings(root: &Path) -> Result<Vec<String>> {
    let files = std::fs::read_dir(root.join("exercises/src"))?.flatten().map(|file| file.path());
    // The programs around the exercises are not handed in.
    let of_kit = ["lib", "worker", "frames"].map(|name| Some(OsStr::new(name)));
    let mut files: Vec<_> = files.filter(|file| !of_kit.contains(&file.file_stem())).collect();
    files.sort();
    let of_file = |file: &PathBuf| {
        let findings =
            std::fs::read_to_string(file).map(|text| lint::read(&text).findings).unwrap_or_default();
        let place = file.strip_prefix(root).unwrap_or(file).display().to_string();
        findings.into_iter().map(move |finding| {
            let then = match finding.is_left_to_sandbox() {
                true => "when it is graded, a function that reaches this line fails",
                false => "the grader refuses this file",
            };
            format!("warning: {place}:{}: {}; {then}", finding.line, finding.why)
        })
    };
    Ok(files.iter().flat_map(of_file).collect())
}

/// Whether the course asks for this stage.
fn is_asked_for(stage: u8) -> bool {
    rubric::stages().iter().any(|(number, _)| *number == stage)
}

/// The gaps, `(place, (task, number of checks that wait for it))`, in the order of the lecture.
fn gaps(graded: &[Graded]) -> Vec<(String, (String, usize))> {
    let mut gaps: Vec<(String, (String, usize))> = Vec::new();
    for one in graded {
        if let Verdict::NotWritten { task, place } = &one.verdict {
            match gaps.iter_mut().find(|(known, _)| known == place) {
                Some((_, (_, waiting))) => *waiting += 1,
                None => gaps.push((place.clone(), (task.clone(), 1))),
            }
        }
    }
    gaps
}

fn score<'a>(graded: impl IntoIterator<Item = &'a Graded>) -> Score {
    graded.into_iter().map(|one| (one.entry.level(), one.earned(), one.entry.points)).collect()
}

fn stage_line(number: u8, graded: &[&Graded]) -> String {
    let title = RUBRIC.get(&format!("stage{number}")).map_or("", |stage| &stage.title);
    let asked_for = || graded.iter().filter(|one| one.entry.is_asked_for());
    let passed = asked_for().filter(|one| one.passed()).count();
    let n = asked_for().count();
    format!(
        "stage {number:>2} · {title:<28} {passed:>2} of {n:<2} checks   {}",
        score(graded.iter().copied())
    )
}

/// Prints the points of the student, and the next step.
pub fn status(root: &Path, source: &Source) -> Result<()> {
    let graded = run_checks_with_bar(source, is_asked_for)?;
    let course = rubric::course();
    if !course.title.is_empty() {
        println!("{}\n", course.title);
    }
    if graded.iter().all(|one| matches!(one.verdict, Verdict::NotWritten { .. })) {
        let weeks = if course.stages.is_empty() { course.text("weeks") } else { "" };
        println!("{}\n", format!("{}\n{weeks}", course.text("welcome")).trim_end());
    }
    for (number, _) in STAGES.iter().filter(|(number, _)| is_asked_for(*number)) {
        let of_stage: Vec<&Graded> = graded.iter().filter(|one| one.check.stage == *number).collect();
        println!("{}", stage_line(*number, &of_stage));
        if let Some(due) = course.due.get(number).filter(|_| of_stage.iter().any(|one| one.is_open())) {
            println!("           {} {due}", course.text("due"));
        }
    }
    println!();
    let album = std::fs::read_dir(root.join(finish::ALBUM)).map_or(0, Iterator::count);
    if album > 0 {
        println!("{}: {album} of your pictures\n", finish::ALBUM);
    }
    // What is not asked for comes after everything else.
    let next = graded.iter().find(|one| one.is_open());
    match next.or(graded.iter().find(|one| !one.passed())) {
        None => {
            // A course may end before the stages that the showcase needs.
            let last = rubric::stages().last().map_or(0, |(number, _)| *number);
            let scene = finish::scene_of(root, last);
            let scene = scene.strip_prefix(root).unwrap_or(&scene).display();
            let which = with_exercises(root);
            println!("Everything passes. `cargo run --release -- render {scene}{which}` shows it.");
        }
        Some(next) => {
            let (stage, name) = (next.check.stage, next.check.name);
            match &next.verdict {
                Verdict::NotWritten { task, place } => {
                    let slide = next.entry.taught();
                    let (next, slides) = (course.text("next"), course.text("slides"));
                    println!("{next}: {place}\n  {task}\n  {slides}: {slide}\n");
                }
                Verdict::Failed(message) => println!("{}, `{name}` fails:\n{message}", course.text("next")),
                Verdict::Passed => {}
            }
            println!("  {}:  cargo test --test stage{stage} {name}", course.text("run_it"));
            println!("  {}:  cargo run -- hint {name}", course.text("a_hint"));
            println!("  {}:  cargo run -- watch", course.text("after_each_save"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slow_code_is_not_called_endless_after_an_endless_loop() {
        let check = &STAGES[0].1[0];
        let message = |seconds, endless| match verdict(check, Err(KitError::TimedOut { seconds }), endless) {
            Verdict::Failed(message) => message,
            other => panic!("{other:?}"),
        };
        let endless = Some("sphere_algebraic_touches");
        let short = message(SHORT_PATIENCE.as_secs(), endless);
        assert!(
            short.contains(
                "  not judged: no answer after 1 s, and a call of the check sphere_algebraic_touches"
            )
        );
        assert!(!short.contains("infinite"), "{short}");
        for endless in [endless, None] {
            assert!(
                message(CALL_PATIENCE.as_secs(), endless)
                    .contains("no answer after 10 s: is there an infinite")
            );
        }
    }

    #[test]
    fn a_check_warns_of_what_the_grader_refuses_or_stops() {
        let root = tempfile::tempdir().expect("a folder");
        let folder = root.path().join("exercises/src");
        std::fs::create_dir_all(&folder).expect("a folder");
        std::fs::write(folder.join("worker.rs"), "use std::process::ExitCode;").expect("a file");
        std::fs::write(folder.join("stage1_shapes.rs"), "use std::fs;\nunsafe fn f() {}\n").expect("a file");
        let warnings = warnings(root.path()).expect("they are read").join("\n");
        assert_eq!(warnings.lines().count(), 2, "{warnings}");
        assert!(warnings.contains("exercises/src/stage1_shapes.rs:1: `std::fs`: an exercise must not read"));
        assert!(warnings.ends_with("unsafe code is not part of any exercise; the grader refuses this file"));
    }
}
