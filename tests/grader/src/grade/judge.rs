//! The verdict on a submission: the laws are put to its worker, over a pipe, by a process that holds no code of it.

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

/// How long a call may take, in processor time. The slowest of the reference takes half a second without optimisation.
const CALL_PATIENCE: Duration = Duration::from_secs(4);

/// How long all checks of a submission may take together. With the slowest way to fail, a call that never returns, that
/// is enough for 70 checks; what is left then is not tried.
const BUDGET: Duration = Duration::from_secs(300);

/// How often a function that is right on the known inputs and wrong on hidden ones is asked again. An honest mistake that
/// one run in two meets is met by all of them and not by the known inputs in 1 of 500 submissions that have it.
const MORE_SEEDS: u64 = 7;

/// How much of a message is kept.
const MOST_SAID: usize = 2048;

/// What a submission is asked, and how.
pub struct Judge {
    /// In the order of the lecture.
    checks: Vec<Put>,
    /// Picks the hidden inputs.
    seed: u64,
    /// Lerp a worker and the machine.
    confinement: Confinement,
    /// The inputs of all checks, which are the same for all submissions.
    drawn: Arc<Drawn>,
}

/// A check, and what is known of it from putting it to the reference.
struct Put {
    check: &'static Check,
    /// Whether hidden inputs are others than those that students have.
    hides: bool,
    /// The functions that it asks.
    asks: HashSet<Discriminant<Request>>,
}

/// What came of a check.
struct Answered {
    outcome: Outcome,
    message: String,
    picture: Option<Picture>,
    /// Whether the known inputs are the only ones on which it is right.
    special: bool,
}

impl Answered {
    fn new(outcome: Outcome, message: impl Into<String>) -> Answered {
        Answered { outcome, message: message.into(), picture: None, special: false }
    }
}

impl Judge {
    /// All checks of these stages. The reference is asked first: a check whose questions are the same with every seed is
    /// put once, and one on which the reference itself fails with this seed is unfair; its seed is left out, with a word.
    pub fn of(root: &Path, stages: &[u8], seed: u64, confinement: Confinement) -> Result<Judge> {
        checks::golden::seal();
        let reference = Source::prepare(root, Which::Solutions, Need::Checks)?.program;
        let of_stages = STAGES.iter().filter(|(number, _)| stages.contains(number));
        let checks: Vec<&'static Check> = of_stages.flat_map(|(_, checks)| checks.iter()).collect();
        let hides = |reference: &Arc<Worker>, check: &&'static Check| {
            let [(known, asks, passes), (hidden, _, passes_hidden)] =
                [0, seed].map(|seed| asked(reference, check, seed));
            ensure!(passes, "the reference fails {} of stage {}: is the kit whole?", check.name, check.stage);
            if !passes_hidden {
                eprintln!("{} of stage {} is put with the known inputs alone", check.name, check.stage);
            }
            Ok(Put { check, hides: passes_hidden && known != hidden, asks })
        };
        let worker = || Arc::new(Worker::new(reference.clone(), worker::CALL_PATIENCE));
        let workers: Vec<_> = (0..queue::cores()).map(|_| worker()).collect();
        let checks = queue::run(&workers, &checks, hides)?;
        Ok(Judge { checks, seed, confinement, drawn: Arc::default() })
    }

    /// Puts all checks to the program `worker`; those of the files in `replaced` have their outcome already.
    ///
    /// No check depends on another: where the program `may_remember` what it was asked, each has a process of its own.
    /// Elsewhere one process answers as long as it passes, and whatever it fails it is asked again as if for the first
    /// time.
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
                let asked = seasoned.take().map(|worker| (self.ask(put, worker.clone(), until), worker));
                // Nothing that was asked before makes an exercise empty, or a call endless.
                let settled = |asked: &(Answered, Arc<Worker>)| {
                    matches!(asked.0.outcome, Outcome::Passed | Outcome::NotWritten | Outcome::TooLong)
                };
                let (answered, worker) = asked.filter(settled).unwrap_or_else(|| {
                    let worker = fresh();
                    (self.ask(put, worker.clone(), until), worker)
                });
                // Behind a check that has not come to an end its thread may still ask.
                let alone = answered.outcome != Outcome::TooLong;
                seasoned = (alone && !may_remember).then_some(worker);
                // A check of several functions does not say which of them it was.
                if answered.special && put.asks.len() == 1 {
                    by_heart.extend(&put.asks);
                }
                // The empty exercise says which file it is, and why it is empty is known.
                let mut lost = replaced.iter().filter(|_| answered.outcome == Outcome::NotWritten);
                let lost = lost.find(|(file, _)| answered.message.contains(file.as_str()));
                match lost {
                    Some((_, (outcome, message))) => Answered::new(*outcome, message),
                    None => answered,
                }
            })
            .collect();
        let results = self.checks.iter().zip(judged).map(|(put, answered)| {
            // Whose inputs everybody knows proves nothing of a function that knows its inputs.
            if answered.outcome == Outcome::Passed && !put.hides && !put.asks.is_disjoint(&by_heart) {
                return result(put.check, Answered::new(Outcome::WrongOnHidden, hidden_message(put.check)));
            }
            result(put.check, answered)
        });
        results.collect()
    }

    /// The same outcome for every check.
    pub fn all(&self, outcome: Outcome, message: &str) -> Vec<CheckResult> {
        self.checks.iter().map(|put| result(put.check, Answered::new(outcome, message))).collect()
    }

    /// Puts one check to a worker.
    fn ask(&self, put: &Put, worker: Arc<Worker>, until: Instant) -> Answered {
        let check = put.check;
        if Instant::now() > until {
            let message = "not tried: the checks before this one have used up the time of the submission";
            return Answered::new(Outcome::NotTried, message);
        }
        let over = Arc::new(AtomicBool::new(false));
        let kit: Arc<dyn Kit + Send + Sync> = Arc::new(Door(Asked { worker, over: over.clone() }));
        // With the inputs that students have, so that they can see again what they are told.
        let examine = |seed| checks::examine_with(check, &kit, seed, Some(self.drawn.clone()));
        let known = examine(0);
        let answered = match outcome(&known) {
            Outcome::Passed if !put.hides => Answered::new(Outcome::Passed, ""),
            Outcome::Passed => match outcome(&examine(self.seed)) {
                Outcome::Wrong | Outcome::NotWritten => {
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
        // A check that hangs is left behind on a thread of its own: without answers it comes to an end.
        over.store(true, Ordering::Relaxed);
        answered
    }
}

fn hidden_message(check: &Check) -> String {
    format!(
        "{}  right on the inputs that you have, wrong on others: an answer for special cases?\n",
        rubric::entry(check.stage, check.name).header()
    )
}

fn outcome(examined: &Result<checks::Outcome, KitError>) -> Outcome {
    match examined {
        Ok(Ok(())) => Outcome::Passed,
        Ok(Err(_)) | Err(KitError::Panicked { .. } | KitError::Malformed { .. }) => Outcome::Wrong,
        Err(KitError::NotWritten { .. }) => Outcome::NotWritten,
        Err(KitError::TimedOut { .. }) => Outcome::TooLong,
        Err(KitError::Crashed { .. }) => Outcome::Crashed,
    }
}

/// What was compared, where pictures were.
fn picture(examined: &Result<checks::Outcome, KitError>) -> Option<Picture> {
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

/// What the reference is asked by a check: a fingerprint of the questions, and to which functions; and whether it passes.
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

/// The reference, with somebody who writes down what it is asked.
struct Overheard {
    reference: Arc<Worker>,
    heard: Arc<Mutex<(Sha256, HashSet<Discriminant<Request>>)>>,
}

impl Transport for Overheard {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        let mut message = Vec::new();
        // Into a vector nothing fails.
        let _ = raykata::worker::send(&mut message, &request);
        let mut heard = self.heard.lock().unwrap_or_else(PoisonError::into_inner);
        heard.0.update(message);
        heard.1.insert(discriminant(&request));
        drop(heard);
        self.reference.call(request, watch)
    }
}

/// A worker that is asked until the verdict is there.
struct Asked {
    worker: Arc<Worker>,
    over: Arc<AtomicBool>,
}

impl Transport for Asked {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        if self.over.load(Ordering::Relaxed) {
            kit_error::unwind(KitError::Crashed { how: "the verdict was there before".into() });
        }
        let answer = self.worker.call(request, watch);
        match sanity::fault(&answer) {
            None => answer,
            Some(what) => kit_error::unwind(KitError::Malformed { what }),
        }
    }
}
