//! The judge: runs the checks against the worker of a submission, over a socket. The judge's process contains no code of the
//! submission.

use super::counted::Costly;
use super::result::{CheckResult, Outcome, Picture};
use crate::grade::report::clean;
use crate::kits::{Need, Source, Which};
use crate::queue::{self, lock};
use crate::sandbox::{Confinement, Purpose, Sandbox};
use crate::worker::{self, Worker};
use all_checks::STAGES;
use anyhow::{Result, ensure};
use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use checks::rubric;
use checks::{Broken, Check, Drawn, Inputs, ONE_HIDDEN_IN, Verdict};
use raykata::frame::Watch;
use raykata::kit::{Answer, Door, Kit, KitError, Request, Transport, kit_error};
use sha2::{Digest, Sha256};
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::mem::{Discriminant, discriminant};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Time limit per call, in processor time. The reference's slowest call takes half a second without optimisation.
pub const CALL_PATIENCE: Duration = Duration::from_secs(4);

/// Processor time for all checks of a submission together. The slowest failure is a call that never returns; the limit allows
/// 70 of them. Checks beyond the limit are not tried.
const BUDGET: Duration = Duration::from_secs(300);

/// Elapsed time for all checks of a submission together, in limits of a call (6.5 minutes), for code that waits and does not
/// compute. With the last check and the compiler, a submission takes less than 8 minutes; Gradescope stops after 10.
const LONGEST: u32 = 97;

/// The calls of a function that may wait and not compute. Checks that call it are not tried afterwards.
const MOST_WAITS: usize = 2;

/// Longest message that is kept, in bytes.
const MOST_SAID: usize = 2048;

/// Checks, seed and sandbox with which submissions are judged.
pub struct Judge {
    /// The checks, in the order of the lecture.
    checks: Vec<PreparedCheck>,
    /// Picks the hidden inputs.
    seed: u64,
    /// The sandbox around a worker.
    confinement: Confinement,
    /// The inputs of all checks, which are the same for all submissions, and the texts and pictures that are expected for
    /// hidden ones.
    drawn: Arc<Drawn>,
    /// The reference. It has answered all questions about hidden texts and pictures before the first submission is judged.
    reference: Arc<dyn Kit + Send + Sync>,
}

/// A check, and the facts that were learned by running it against the reference.
#[derive(Clone)]
struct PreparedCheck {
    check: &'static Check,
    /// Whether the hidden inputs differ from the public ones.
    varies: bool,
    /// Whether they are drawn, and not public ones that are turned and scaled.
    draws: bool,
    /// Whether it judges the cost of a search, so that the judge counts.
    counts: bool,
    /// The functions that it calls.
    asks: HashSet<Discriminant<Request>>,
}

/// The result of a check.
struct Answered {
    outcome: Outcome,
    message: String,
    picture: Option<Picture>,
    /// The function that waited and did not compute.
    waits: Option<Discriminant<Request>>,
    /// The elapsed time, without that in which the worker had no processor.
    took: Duration,
}

impl Answered {
    fn new(outcome: Outcome, message: impl Into<String>) -> Answered {
        Answered { outcome, message: message.into(), picture: None, waits: None, took: Duration::ZERO }
    }
}

/// The results of all checks on a submission.
pub struct Judgement {
    /// The results, in the order of the checks.
    pub checks: Vec<CheckResult>,
    /// The first check that failed in one process and passed in another.
    pub unsteady: Option<&'static Check>,
    /// The processor time of the submission's processes.
    pub spent: Duration,
}

impl Judge {
    /// Prepares all checks of these stages by running them against the reference. A check whose questions do not depend on
    /// the seed runs only once per submission. If the reference itself fails a check with this seed, the check uses only
    /// the public inputs, and a warning is printed.
    pub fn of(root: &Path, stages: &[u8], seed: u64, confinement: Confinement) -> Result<Judge> {
        // A small seed draws like any other, and 0 does not mean the public inputs.
        let digest = Sha256::digest(seed.to_le_bytes());
        let seed = digest.iter().take(8).fold(0, |seed, byte| seed << 8 | u64::from(*byte)).max(1);
        // Collect the checks of the stages, and build the reference.
        checks::golden::seal();
        let reference = Source::prepare(root, Which::Solutions, Need::Checks)?.program;
        let of_stages = STAGES.iter().filter(|(number, _)| stages.contains(number));
        let checks: Vec<&'static Check> = of_stages.flat_map(|(_, checks)| checks.iter()).collect();
        // Compare the questions of each check with the public seed and with the hidden one. This also draws all inputs, and
        // composes the expected texts and pictures, so that no submission waits for the reference or fails with it.
        let drawn = Arc::<Drawn>::default();
        let prepare = |reference: &Arc<Worker>, check: &&'static Check| {
            let kit: Arc<dyn Kit + Send + Sync> = Arc::new(Door(reference.clone()));
            let [(known, passes), (hidden, passes_hidden)] =
                [0, seed].map(|seed| asked(reference, check, seed, inputs(seed, &drawn, &kit)));
            ensure!(
                passes,
                "the reference fails {} of stage {}: is the kit complete?",
                check.name,
                check.stage
            );
            if !passes_hidden {
                eprintln!("warning: {} of stage {} uses only the public inputs", check.name, check.stage);
            }
            let costly: Arc<dyn Kit + Send + Sync> = Arc::new(Door(Costly(reference.clone())));
            let counts = known.has_costs && !checks::passes(check, &costly, 0);
            let varies = passes_hidden && known.questions.finalize() != hidden.questions.finalize();
            let draws = varies && !check.symmetries.turn_public_inputs();
            Ok(PreparedCheck { check, varies, draws, counts, asks: known.functions })
        };
        let worker = || Arc::new(Worker::new(reference.clone(), worker::CALL_PATIENCE));
        let workers: Vec<_> = (0..queue::cores()).map(|_| worker()).collect();
        let checks = queue::run(&workers, &checks, prepare)?;
        let reference: Arc<dyn Kit + Send + Sync> = Arc::new(Door(worker()));
        Ok(Judge { checks, seed, confinement, drawn, reference })
    }

    /// The same judge with these checks only.
    pub fn only(&self, is_chosen: impl Fn(u8, &str) -> bool) -> Judge {
        let mut checks = self.checks.clone();
        checks.retain(|prepared| is_chosen(prepared.check.stage, prepared.check.name));
        Judge { checks, drawn: self.drawn.clone(), reference: self.reference.clone(), ..*self }
    }

    /// Runs all checks against the program `worker`. Checks of the files in `replaced` get the outcome given there.
    ///
    /// No check may depend on an earlier one. If the program `may_remember` earlier questions, or has answered one check in
    /// two ways, each check gets a new process. All public inputs come before all hidden ones, and to other processes, so that
    /// no message about public inputs depends on hidden ones.
    pub fn judge(
        &self,
        worker: &Path,
        replaced: &BTreeMap<String, (Outcome, String)>,
        may_remember: bool,
        call_patience: Duration,
    ) -> Judgement {
        let start = || {
            let sandbox = Sandbox::with(self.confinement, Purpose::Worker);
            Arc::new(Worker::sandboxed(worker.to_owned(), call_patience, sandbox))
        };
        let mut processes = Processes::new(&start, may_remember);
        let (mut waits, mut took) = (Vec::new(), Duration::ZERO);
        let mut answer = |processes: &mut Processes<'_>, prepared: &PreparedCheck, seed| {
            if processes.spent() > BUDGET || took > LONGEST * call_patience {
                let message = "not tried: earlier checks used up the time of the submission";
                return Answered::new(Outcome::NotTried, message);
            }
            if waits.iter().filter(|function| prepared.asks.contains(function)).count() >= MOST_WAITS {
                let message =
                    "not tried: in earlier checks it waited twice and gave no answer; repair these first";
                return Answered::new(Outcome::NotTried, message);
            }
            let answered = processes.answer(prepared.check, |worker| {
                let answered = self.ask(prepared, worker, seed);
                took += answered.took;
                answered
            });
            waits.extend(answered.waits);
            answered
        };
        let mut judged: Vec<Answered> = Vec::new();
        for prepared in &self.checks {
            let answered = answer(&mut processes, prepared, 0);
            // The message of an empty exercise names its file. Replace it by the reason why the file was replaced.
            let mut lost = replaced.iter().filter(|_| answered.outcome == Outcome::NotWritten);
            let lost = lost.find(|(file, _)| answered.message.contains(file.as_str()));
            judged.push(lost.map_or(answered, |(_, (outcome, message))| Answered::new(*outcome, message)));
        }
        processes.renew();
        for (prepared, answered) in self.checks.iter().zip(&mut judged) {
            if answered.outcome == Outcome::Passed && prepared.varies {
                *answered = answer(&mut processes, prepared, self.seed);
            }
        }
        let checks = self.results(judged);
        Judgement { checks, unsteady: processes.unsteady, spent: processes.spent() }
    }

    /// The results of the checks that were answered so.
    fn results(&self, judged: Vec<Answered>) -> Vec<CheckResult> {
        let proven = self.proven(&judged);
        let results = self.checks.iter().zip(judged).map(|(prepared, answered)| {
            let others = self.missing_proofs(prepared, &proven);
            // Right answers to known inputs, turned or not, can be a table.
            if answered.outcome == Outcome::Passed && !prepared.draws && !others.is_empty() {
                let message = format!(
                    "{}  right, but its inputs are known ones, turned or scaled: it counts when one of these checks of the same \
                     function passes: {}\n",
                    header(prepared.check),
                    others.join(", ")
                );
                return result(prepared.check, Answered::new(Outcome::Unproven, message));
            }
            result(prepared.check, answered)
        });
        results.collect()
    }

    /// The functions that a check with drawn inputs asks and that pass it.
    fn proven(&self, judged: &[Answered]) -> HashSet<Discriminant<Request>> {
        let passed = self.checks.iter().zip(judged);
        let passed =
            passed.filter(|(prepared, answered)| prepared.draws && answered.outcome == Outcome::Passed);
        passed.flat_map(|(prepared, _)| prepared.asks.iter().copied()).collect()
    }

    /// The checks with drawn inputs that ask the functions of `prepared` that are not `proven`.
    fn missing_proofs(
        &self,
        prepared: &PreparedCheck,
        proven: &HashSet<Discriminant<Request>>,
    ) -> Vec<&'static str> {
        let open: HashSet<_> = prepared.asks.difference(proven).collect();
        let asks_one =
            |other: &&PreparedCheck| other.draws && other.asks.iter().any(|asked| open.contains(asked));
        self.checks.iter().filter(asks_one).map(|other| other.check.name).collect()
    }

    /// Returns the graded stages.
    pub fn stages(&self) -> BTreeSet<u8> {
        self.checks.iter().map(|prepared| prepared.check.stage).collect()
    }

    /// Returns the names of the checks.
    pub fn checks(&self) -> Vec<&'static str> {
        self.checks.iter().map(|prepared| prepared.check.name).collect()
    }

    /// Gives every check the same outcome.
    pub fn all(&self, outcome: Outcome, message: &str) -> Vec<CheckResult> {
        self.checks.iter().map(|prepared| result(prepared.check, Answered::new(outcome, message))).collect()
    }

    /// Runs one check with the inputs of this seed, which are the public ones for 0.
    fn ask(&self, prepared: &PreparedCheck, worker: Arc<Worker>, seed: u64) -> Answered {
        // If the hidden inputs decide, count only there.
        worker.withhold_tables(prepared.counts && (seed != 0 || !prepared.varies));
        let calls = Arc::<Calls>::default();
        let (begin, computed, lacked) = (Instant::now(), worker.cpu_time(), worker.waited());
        let mut examined = self.examine(prepared, worker.clone(), seed, &calls);
        let took = begin.elapsed().saturating_sub(worker.waited().saturating_sub(lacked));
        // A check has more time than a call. Calls that return may also wait.
        if let Err(KitError::TimedOut { seconds }) = examined
            && seconds > CALL_PATIENCE.as_secs()
            && 3 * worker.cpu_time().saturating_sub(computed) < Duration::from_secs(seconds)
        {
            examined = Err(KitError::Waited { seconds });
        }
        let waits = matches!(examined, Err(KitError::Waited { .. })).then(|| *lock(&calls.last)).flatten();
        let answered = if seed == 0 { public(prepared, examined) } else { hidden(prepared, &examined) };
        Answered { waits, took, ..answered }
    }

    fn examine(
        &self,
        prepared: &PreparedCheck,
        worker: Arc<Worker>,
        seed: u64,
        calls: &Arc<Calls>,
    ) -> Result<checks::CheckResult, KitError> {
        let kit: Arc<dyn Kit + Send + Sync> =
            Arc::new(Door(StoppableWorker { worker, calls: calls.clone(), seed }));
        let inputs = inputs(seed, &self.drawn, &self.reference);
        let examined = checks::examine(prepared.check, &kit, seed, inputs);
        // A check that hangs continues on its own thread. It ends there, because it gets no more answers.
        calls.over.store(true, Ordering::Relaxed);
        examined
    }
}

/// The answer of a check with the public inputs.
fn public(prepared: &PreparedCheck, examined: Result<checks::CheckResult, KitError>) -> Answered {
    let (outcome, picture) = (outcome(&examined), picture(&examined));
    match checks::verdict(prepared.check, examined) {
        Verdict::Passed => Answered::new(Outcome::Passed, ""),
        Verdict::Failed(message) => Answered { picture, ..Answered::new(outcome, message) },
        Verdict::NotWritten { task, place } => {
            Answered::new(outcome, format!("not written yet: {place}\n  {task}"))
        }
    }
}

/// The answer of a check with the hidden inputs. The message quotes nothing, because the worker knows these inputs.
fn hidden(prepared: &PreparedCheck, examined: &Result<checks::CheckResult, KitError>) -> Answered {
    match outcome(examined) {
        Outcome::Passed => Answered::new(Outcome::Passed, ""),
        Outcome::Wrong | Outcome::NotWritten => {
            let message = format!(
                "{}  right on the inputs that you have, wrong on others: look for an answer for special cases\n",
                header(prepared.check)
            );
            Answered::new(Outcome::WrongOnHidden, message)
        }
        other => Answered::new(other, format!("{}\n  on hidden inputs", other.words())),
    }
}

/// The processes of a submission, one at a time.
struct Processes<'a> {
    start: &'a dyn Fn() -> Arc<Worker>,
    /// Whether an answer may depend on earlier questions, so that no process may be used twice.
    may_remember: bool,
    /// The first check that failed in one process and passed in another. From then on no process is used twice either.
    unsteady: Option<&'static Check>,
    /// The process of the check before, if it may be used again.
    seasoned: Option<Arc<Worker>>,
    /// The processor time of the processes before.
    spent: Duration,
}

impl<'a> Processes<'a> {
    fn new(start: &'a dyn Fn() -> Arc<Worker>, may_remember: bool) -> Processes<'a> {
        Processes { start, may_remember, unsteady: None, seasoned: None, spent: Duration::ZERO }
    }

    /// Asks the process of the check before, or else a new one. An answer that earlier questions may have caused is not
    /// used: a new process is asked.
    fn answer(&mut self, check: &'static Check, mut ask: impl FnMut(Arc<Worker>) -> Answered) -> Answered {
        let asked = self.seasoned.clone().map(&mut ask);
        // Earlier questions cannot cause these outcomes.
        let settled = |asked: &Answered| {
            matches!(asked.outcome, Outcome::Passed | Outcome::NotWritten | Outcome::TooLong)
        };
        let answered = match asked {
            Some(asked) if settled(&asked) => asked,
            unsettled => {
                self.renew();
                let answered = ask(self.seasoned.insert((self.start)()).clone());
                if unsettled.is_some() && answered.outcome == Outcome::Passed {
                    self.unsteady.get_or_insert(check);
                }
                answered
            }
        };
        // After a timeout the thread of the check may still send questions.
        if answered.outcome == Outcome::TooLong || self.may_remember || self.unsteady.is_some() {
            self.renew();
        }
        answered
    }

    /// Ends the process, so that the next check gets a new one.
    fn renew(&mut self) {
        self.spent = self.spent();
        self.seasoned = None;
    }

    /// The processor time of all processes so far.
    fn spent(&self) -> Duration {
        self.spent + self.seasoned.as_ref().map_or(Duration::ZERO, |worker| worker.cpu_time())
    }
}

/// The inputs of a check.
fn inputs(seed: u64, drawn: &Arc<Drawn>, reference: &Arc<dyn Kit + Send + Sync>) -> Inputs {
    let one_in = if seed == 0 { 1 } else { ONE_HIDDEN_IN };
    Inputs { drawn: Some(drawn.clone()), one_in, reference: Some(reference.clone()), ..Inputs::default() }
}

/// The first lines of a message about a check.
fn header(check: &Check) -> String {
    rubric::entry(check.stage, check.name).header()
}

fn outcome(examined: &Result<checks::CheckResult, KitError>) -> Outcome {
    match examined {
        Ok(Ok(())) => Outcome::Passed,
        Ok(Err(_)) | Err(KitError::Panicked { .. } | KitError::Malformed { .. }) => Outcome::Wrong,
        Err(KitError::NotWritten { .. }) => Outcome::NotWritten,
        Err(KitError::TimedOut { .. } | KitError::Waited { .. }) => Outcome::TooLong,
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
    let message = clean::clean(message.trim_end(), MOST_SAID);
    CheckResult { picture, ..CheckResult::new(check.stage, check.name, outcome, message) }
}

/// What a check asked the reference.
#[derive(Clone, Default)]
struct AskedQuestions {
    /// A fingerprint of the questions.
    questions: Sha256,
    /// The functions that were called.
    functions: HashSet<Discriminant<Request>>,
    /// Whether an answer contains costs.
    has_costs: bool,
}

/// Runs a check against the reference. Returns what was asked, and whether it passes.
fn asked(reference: &Arc<Worker>, check: &Check, seed: u64, inputs: Inputs) -> (AskedQuestions, bool) {
    let record = Arc::<Mutex<AskedQuestions>>::default();
    let recording = RecordingWorker { reference: reference.clone(), record: record.clone() };
    let kit: Arc<dyn Kit + Send + Sync> = Arc::new(Door(recording));
    let passes = matches!(checks::examine(check, &kit, seed, inputs), Ok(Ok(())));
    let record = lock(&record).clone();
    (record, passes)
}

/// The reference, with a record of the questions.
struct RecordingWorker {
    reference: Arc<Worker>,
    record: Arc<Mutex<AskedQuestions>>,
}

impl Transport for RecordingWorker {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        let mut message = Vec::new();
        // Writing into a vector cannot fail.
        let _ = raykata::worker::send(&mut message, &request);
        let function = discriminant(&request);
        let mut answer = self.reference.call(request, watch);
        let mut record = lock(&self.record);
        record.questions.update(message);
        record.functions.insert(function);
        record.has_costs |= !answer.costs().is_empty();
        drop(record);
        answer
    }

    fn waited(&self) -> Duration {
        self.reference.waited()
    }
}

/// The calls of a check.
#[derive(Default)]
struct Calls {
    /// Whether the check has its verdict.
    over: AtomicBool,
    /// The function that was called last.
    last: Mutex<Option<Discriminant<Request>>>,
}

/// A worker that gets questions until the check has its verdict.
struct StoppableWorker {
    worker: Arc<Worker>,
    calls: Arc<Calls>,
    /// The seed of the inputs; 0 for public ones.
    seed: u64,
}

impl Transport for StoppableWorker {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        if self.calls.over.load(Ordering::Relaxed) {
            kit_error::unwind(KitError::Crashed { how: "the check has ended".into() });
        }
        *lock(&self.calls.last) = Some(discriminant(&request));
        self.worker.call(request, watch)
    }

    fn waited(&self) -> Duration {
        self.worker.waited()
    }

    // No one earns points by the places of known questions: hidden ones come in another order in each class.
    fn swaps(&self, n: usize) -> Vec<(usize, usize)> {
        checks::calls::swaps(self.seed, n)
    }
}

#[cfg(test)]
mod hostile;
#[cfg(test)]
mod varied;
