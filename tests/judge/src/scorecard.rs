//! `raykata check`, and `raykata` without a command: the points of a student and the next step.

use all_checks::STAGES;
use anyhow::Result;
use checks::rubric::{self, CheckEntry, RUBRIC, Score};
use checks::{Check, Inputs, Verdict};
use raykata::worker::send;
use raykata_cli::kits::{Source, with_exercises};
use raykata_cli::{queue, verdicts};
use std::io::Write;
use std::path::Path;
use std::sync::{Mutex, PoisonError};

/// A check and its verdict.
pub struct Graded {
    /// The check.
    pub check: &'static Check,
    /// The verdict.
    pub verdict: Verdict,
    /// The rubric's entry for the check.
    pub entry: CheckEntry,
}

impl Graded {
    fn passed(&self) -> bool {
        self.verdict == Verdict::Passed
    }

    fn earned(&self) -> u32 {
        if self.passed() { self.entry.points } else { 0 }
    }
}

/// Runs all checks of the stages for which `wanted` is true, each with a kit of its own, on all cores.
pub fn run_checks(source: &Source, wanted: impl Fn(u8) -> bool) -> Result<Vec<Graded>> {
    run_checks_on(queue::cores(), source, wanted, 0, &Inputs::default())
}

/// The same on this many threads, with the inputs of `seed` from `inputs`.
pub fn run_checks_on(
    threads: usize,
    source: &Source,
    wanted: impl Fn(u8) -> bool,
    seed: u64,
    inputs: &Inputs,
) -> Result<Vec<Graded>> {
    let checks: Vec<&'static Check> =
        STAGES.iter().filter(|(stage, _)| wanted(*stage)).flat_map(|(_, checks)| checks.iter()).collect();
    let grade = |_: &(), &check: &&'static Check| {
        let examined = checks::examine_with(check, &source.fresh(), seed, inputs.clone());
        let verdict = checks::verdict(check, examined);
        Ok(Graded { check, verdict, entry: rubric::entry(check.stage, check.name) })
    };
    queue::run(&vec![(); threads], &checks, grade)
}

/// Writes the verdicts of a stage to `out` as messages, each as soon as it is known.
pub fn tell(source: &Source, stage: u8, out: impl Write + Send) -> Result<()> {
    let out = Mutex::new(out);
    let checks: Vec<&'static Check> =
        STAGES.iter().filter(|(number, _)| *number == stage).flat_map(|(_, checks)| checks.iter()).collect();
    queue::run(&queue::one_a_core(), &checks, |(), &check| {
        let verdict = checks::run(check, &source.fresh(), 0);
        let mut out = out.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(send(&mut *out, &verdicts::CheckVerdict { check: check.name.into(), verdict })?)
    })?;
    Ok(())
}

/// Prints the scorecard; `Ok(true)` if all checks passed that are asked for.
pub fn scorecard(source: &Source, stage: Option<u8>) -> Result<bool> {
    let wanted = |number| is_asked_for(number) && stage.is_none_or(|stage| stage == number);
    let graded = run_checks(source, wanted)?;
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
        println!("not written yet: {place}\n  {task} ({})", wait_for_it(waiting));
    }
    let passed = graded.iter().filter(|one| one.passed()).count();
    println!("\n{}\n{passed} passed, {} failed", score(&graded), graded.len() - passed);
    Ok(graded.iter().all(|one| !one.entry.is_asked_for() || one.passed()))
}

/// Whether the course asks for this stage.
fn is_asked_for(stage: u8) -> bool {
    rubric::stages().iter().any(|(number, _)| *number == stage)
}

fn wait_for_it(checks: usize) -> String {
    if checks == 1 { "1 check waits for it".into() } else { format!("{checks} checks wait for it") }
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
    let graded = run_checks(source, is_asked_for)?;
    let course = rubric::course();
    if !course.title.is_empty() {
        println!("{}\n", course.title);
    }
    if graded.iter().all(|one| matches!(one.verdict, Verdict::NotWritten { .. })) {
        println!("{}\n", course.text("welcome"));
    }
    for (number, _) in STAGES.iter().filter(|(number, _)| is_asked_for(*number)) {
        let of_stage: Vec<&Graded> = graded.iter().filter(|one| one.check.stage == *number).collect();
        println!("{}", stage_line(*number, &of_stage));
        if let Some(due) = course
            .due
            .get(number)
            .filter(|_| of_stage.iter().any(|one| one.entry.is_asked_for() && !one.passed()))
        {
            println!("           {} {due}", course.text("due"));
        }
    }
    println!();
    // What is not asked for comes after everything else.
    let open =
        |asked_for| graded.iter().find(move |one| one.entry.is_asked_for() == asked_for && !one.passed());
    match open(true).or(open(false)) {
        None => println!(
            "Everything passes. `cargo run --release -- render scenes/showcase.toml{}` shows it.",
            with_exercises(root)
        ),
        Some(next) => {
            let (stage, name) = (next.check.stage, next.check.name);
            match &next.verdict {
                Verdict::NotWritten { task, place } => {
                    let slide = &next.entry.slide;
                    let (next, slides) = (course.text("next"), course.text("slides"));
                    println!("{next}: {place}\n  {task}\n  {slides}: {slide} (slides/stage{stage:02}.md)\n");
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
