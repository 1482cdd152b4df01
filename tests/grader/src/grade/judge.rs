//! The judge: runs the checks against the worker of a submission, over a socket. The judge's process contains no code of the
//! submission.

use super::result::{CheckResult, Outcome, Picture};
use super::sanity;
use crate::grade::report::clean;
use crate::kits::{Need, Source, Which};
use crate::queue;
use crate::sandbox::{Confinement, Purpose, Sandbox};
use crate::worker::{self, Worker};
use all_checks::STAGES;
use anyhow::{Result, ensure};
use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use checks::rubric;
use checks::{Broken, Check, Drawn, Verdict};
use raykata::frame::Watch;
use raykata::kit::{Answer, Door, Kit, KitError, Request, Transport, kit_error};
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, HashSet};
use std::mem::{Discriminant, discriminant};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Time limit per call, in processor time. The reference's slowest call takes half a second without optimisation.
const CALL_PATIENCE: Duration = Duration::from_secs(4);

/// Time limit for all checks of a submission together. The slowest failure is a call that never returns; the limit allows
/// 70 of them. Checks beyond the limit are not tried.
const BUDGET: Duration = Duration::from_secs(300);

/// Number of further seeds for a function that is right on the public inputs and wrong on hidden ones. A function that
/// fails with all of them is taken for memorised. Suppose that an honest mistake shows with every second seed. Then it
/// shows with all hidden seeds and not with the public inputs in 1 of 500 submissions.
const MORE_SEEDS: u64 = 7;

/// Longest message that is kept, in bytes.
const MOST_SAID: usize = 2048;

/// Checks, seed and sandbox with which submissions are judged.
pub struct Judge {
    /// The checks, in the order of the lecture.
    checks: Vec<Put>,
    /// Picks the hidden inputs.
    seed: u64,
    /// The sandbox around a worker.
    confinement: Confinement,
    /// The inputs of all checks, which are the same for all submissions.
    drawn: Arc<Drawn>,
}

/// A check, and the facts that were learned by running it against the reference.
struct Put {
    check: &'static Check,
    /// Whether the hidden inputs differ from the public ones.
    hides: bool,
    /// The functions that it calls.
    asks: HashSet<Discriminant<Request>>,
}

/// The result of a check.
struct Answered {
    outcome: Outcome,
    message: String,
    picture: Option<Picture>,
    /// Whether the answers are right on the public inputs and wrong with every hidden seed.
    special: bool,
}

impl Answered {
    fn new(outcome: Outcome, message: impl Into<String>) -> Answered {
        Answered { outcome, message: message.into(), picture: None, special: false }
    }
}

impl Judge {
    /// Prepares all checks of these stages by running them against the reference. A check whose questions do not depend on
    /// the seed runs only once per submission. If the reference itself fails a check with this seed, the check uses only
    /// the public inputs, and a warning is printed.
    pub fn of(root: &Path, stages: &[u8], seed: u64, confinement: Confinement) -> Result<Judge> {
        // Collect the checks of the stages, and build the reference.
        checks::golden::seal();
        let reference = Source::prepare(root, Which::Solutions, Need::Checks)?.program;
        let of_stages = STAGES.iter().filter(|(number, _)| stages.contains(number));
        let checks: Vec<&'static Check> = of_stages.flat_map(|(_, checks)| checks.iter()).collect();
        // Compare the questions of each check with the public seed and with the hidden one.
        let hides = |reference: &Arc<Worker>, check: &&'static Check| {
            let [(known, asks, passes), (hidden, _, passes_hidden)] =
                [0, seed].map(|seed| asked(reference, check, seed));
            ensure!(
                passes,
                "the reference fails {} of stage {}: is the kit complete?",
                check.name,
                check.stage
            );
            if !passes_hidden {
                eprintln!("warning: {} of stage {} uses only the public inputs", check.name, check.stage);
            }
            Ok(Put { check, hides: passes_hidden && known != hidden, asks })
        };
        let worker = || Arc::new(Worker::new(reference.clone(), worker::CALL_PATIENCE));
        let workers: Vec<_> = (0..queue::cores()).map(|_| worker()).collect();
        let checks = queue::run(&workers, &checks, hides)?;
        Ok(Judge { checks, seed, confinement, drawn: Arc::default() })
    }

    /// Runs all checks against the program `worker`. Checks of the files in `replaced` get the outcome given there.
    ///
    /// No check may depend on an earlier one. If the program `may_remember` earlier questions, each check gets a new
    /// process. Otherwise one process answers until a check fails. A check with a wrong answer or a crash is then repeated
    /// in a new process.
    pub fn judge(
        &self,
        worker: &Path,
        replaced: &BTreeMap<String, (Outcome, String)>,
        may_remember: bool,
    ) -> Vec<CheckResult> {
        let fresh = || {
            let sandbox = Sandbox::with(self.confinement, Purpose::Worker);
            Arc::new(Worker::sandboxed(worker.to_owned(), CALL_PATIENCE, sandbox))
        };
        let mut seasoned: Option<Arc<Worker>> = None;
        let until = Instant::now() + BUDGET;
        let mut by_heart = HashSet::new();
        let judged: Vec<Answered> = self
            .checks
            .iter()
            .map(|put| {
                // Use the process of the check before if it may be used again, otherwise a new one.
                let asked = seasoned.take().map(|worker| (self.ask(put, worker.clone(), until), worker));
                // Earlier questions cannot cause these outcomes.
                let settled = |asked: &(Answered, Arc<Worker>)| {
                    matches!(asked.0.outcome, Outcome::Passed | Outcome::NotWritten | Outcome::TooLong)
                };
                let (answered, worker) = asked.filter(settled).unwrap_or_else(|| {
                    let worker = fresh();
                    (self.ask(put, worker.clone(), until), worker)
                });
                // After a timeout the thread of the check may still send questions.
                let alone = answered.outcome != Outcome::TooLong;
                seasoned = (alone && !may_remember).then_some(worker);
                // A check of several functions does not tell which of them is memorised.
                if answered.special && put.asks.len() == 1 {
                    by_heart.extend(&put.asks);
                }
                // The message of an empty exercise names its file. Replace it by the reason why the file was replaced.
                let mut lost = replaced.iter().filter(|_| answered.outcome == Outcome::NotWritten);
                let lost = lost.find(|(file, _)| answered.message.contains(file.as_str()));
                match lost {
                    Some((_, (outcome, message))) => Answered::new(*outcome, message),
                    None => answered,
                }
            })
            .collect();
        let results = self.checks.iter().zip(judged).map(|(put, answered)| {
            // A check with public inputs only proves nothing about a function that has memorised its answers.
            if answered.outcome == Outcome::Passed && !put.hides && !put.asks.is_disjoint(&by_heart) {
                return result(put.check, Answered::new(Outcome::WrongOnHidden, hidden_message(put.check)));
            }
            result(put.check, answered)
        });
        results.collect()
    }

    /// Gives every check the same outcome.
    pub fn all(&self, outcome: Outcome, message: &str) -> Vec<CheckResult> {
        self.checks.iter().map(|put| result(put.check, Answered::new(outcome, message))).collect()
    }

    /// Runs one check against a worker.
    fn ask(&self, put: &Put, worker: Arc<Worker>, until: Instant) -> Answered {
        let check = put.check;
        if Instant::now() > until {
            let message = "not tried: earlier checks used up the time of the submission";
            return Answered::new(Outcome::NotTried, message);
        }
        let over = Arc::new(AtomicBool::new(false));
        let kit: Arc<dyn Kit + Send + Sync> = Arc::new(Door(StoppableWorker { worker, over: over.clone() }));
        // Use the public inputs first, so that students can reproduce the message.
        let examine = |seed| checks::examine_with(check, &kit, seed, Some(self.drawn.clone()));
        let known = examine(0);
        // If these pass, use the hidden inputs.
        let answered = match outcome(&known) {
            Outcome::Passed if !put.hides => Answered::new(Outcome::Passed, ""),
            Outcome::Passed => match outcome(&examine(self.seed)) {
                Outcome::Wrong | Outcome::NotWritten => {
                    // Try further seeds to detect memorised answers.
                    let mut seeds = (1..=MORE_SEEDS).map(|number| self.seed.wrapping_add(number));
                    let special = seeds.all(|seed| {
                        let again = outcome(&checks::examine(check, &kit, seed));
                        matches!(again, Outcome::Wrong | Outcome::NotWritten)
                    });
                    Answered { special, ..Answered::new(Outcome::WrongOnHidden, hidden_message(check)) }
                }
                Outcome::Passed => Answered::new(Outcome::Passed, ""),
                other => Answered::new(other, format!("{}\n  on hidden inputs", other.words())),
            },
            other => {
                let picture = picture(&known);
                match checks::verdict(check, known) {
                    Verdict::Passed => Answered::new(Outcome::Passed, ""),
                    Verdict::Failed(message) => Answered { picture, ..Answered::new(other, message) },
                    Verdict::NotWritten { task, place } => {
                        Answered::new(other, format!("not written yet: {place}\n  {task}"))
                    }
                }
            }
        };
        // A check that hangs continues on its own thread. It ends there, because it gets no more answers.
        over.store(true, Ordering::Relaxed);
        answered
    }
}

fn hidden_message(check: &Check) -> String {
    format!(
        "{}  right on the inputs that you have, wrong on others: look for an answer for special cases\n",
        rubric::entry(check.stage, check.name).header()
    )
}

fn outcome(examined: &Result<checks::CheckResult, KitError>) -> Outcome {
    match examined {
        Ok(Ok(())) => Outcome::Passed,
        Ok(Err(_)) | Err(KitError::Panicked { .. } | KitError::Malformed { .. }) => Outcome::Wrong,
        Err(KitError::NotWritten { .. }) => Outcome::NotWritten,
        Err(KitError::TimedOut { .. }) => Outcome::TooLong,
        Err(KitError::Crashed { .. }) => Outcome::Crashed,
    }
}

/// Returns the compared pictures of a check about pictures.
fn picture(examined: &Result<checks::CheckResult, KitError>) -> Option<Picture> {
    let Ok(Err(Broken { picture: Some(png), .. })) = examined else { return None };
    let caption = "reference | yours | four times the difference".into();
    Some(Picture { caption, png: BASE64.encode(&png.0) })
}

fn result(check: &Check, answered: Answered) -> CheckResult {
    let Answered { outcome, message, picture, .. } = answered;
    let points = rubric::entry(check.stage, check.name).points;
    let earned = if outcome == Outcome::Passed { points } else { 0 };
    let message = clean::clean(message.trim_end(), MOST_SAID);
    CheckResult { stage: check.stage, name: check.name.into(), outcome, points, earned, message, picture }
}

/// Runs a check against the reference. Returns a fingerprint of the questions, the functions that were called, and whether
/// the reference passes.
fn asked(
    reference: &Arc<Worker>,
    check: &Check,
    seed: u64,
) -> (Vec<u8>, HashSet<Discriminant<Request>>, bool) {
    let heard = Arc::new(Mutex::new((Sha256::new(), HashSet::new())));
    let overheard = Overheard { reference: reference.clone(), heard: heard.clone() };
    let kit: Arc<dyn Kit + Send + Sync> = Arc::new(Door(overheard));
    let passes = matches!(checks::examine(check, &kit, seed), Ok(Ok(())));
    let (questions, functions) = heard.lock().unwrap_or_else(PoisonError::into_inner).clone();
    (questions.finalize().to_vec(), functions, passes)
}

/// The reference, with a record of the questions.
struct Overheard {
    reference: Arc<Worker>,
    heard: Arc<Mutex<(Sha256, HashSet<Discriminant<Request>>)>>,
}

impl Transport for Overheard {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        let mut message = Vec::new();
        // Writing into a vector cannot fail.
        let _ = raykata::worker::send(&mut message, &request);
        let mut heard = self.heard.lock().unwrap_or_else(PoisonError::into_inner);
        heard.0.update(message);
        heard.1.insert(discriminant(&request));
        drop(heard);
        self.reference.call(request, watch)
    }
}

/// A worker that gets questions until the check has its verdict.
struct StoppableWorker {
    worker: Arc<Worker>,
    over: Arc<AtomicBool>,
}

impl Transport for StoppableWorker {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        if self.over.load(Ordering::Relaxed) {
            kit_error::unwind(KitError::Crashed { how: "the check has ended".into() });
        }
        let answer = self.worker.call(request, watch);
        match sanity::fault(&answer) {
            None => answer,
            Some(what) => kit_error::unwind(KitError::Malformed { what }),
        }
    }
}
