//! Running a check: on a thread with a large stack, with a time limit, and with the same inputs in each run.

use crate::broken::{self, Broken, CheckResult};
use crate::calls::{Calls, Recorder, breaking_call};
use crate::drawn::{Drawn, Values};
use crate::judge::{Refuted, compare};
use crate::law::{self, Fails, judge_one};
use crate::patience::{self, PATIENCE};
use crate::picture::Replay;
use crate::process;
use crate::rubric;
use crate::symmetry::{Symmetries, Symmetry, TurnedKit};
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
pub use raykata::course::Verdict;
use raykata::frame::Unwatched;
use raykata::kit::{Door, Kit, KitError, Request, kit_error};
use raykata::worker::Thread;
use std::cell::Cell;
use std::collections::BTreeSet;
use std::ops::Range;
use std::panic::Location;
use std::sync::{Arc, Mutex, OnceLock, PoisonError, mpsc};
use std::time::Duration;

/// A check: a law with the stage and the name under which it is graded.
#[derive(Clone, Copy)]
pub struct Check {
    /// The stage it belongs to.
    pub stage: u8,
    /// The name of the check: a sentence about light or geometry, in snake case.
    pub name: &'static str,
    /// The function that tests whether a kit obeys the law.
    pub law: fn(&Trial<'_>) -> CheckResult,
    /// How its requests are [turned](crate::symmetry) for a hidden seed.
    pub symmetries: Symmetries,
}

/// The seed of the inputs that students have. Other seeds are hidden.
const PUBLIC_SEED: u64 = 0;

/// A run of a check on a kit, with its random inputs.
pub struct Trial<'a> {
    /// The kit whose answers are judged.
    pub kit: &'a dyn Kit,
    /// The name of the check. It selects the random inputs together with `seed`.
    pub name: &'static str,
    /// The seed of the random inputs.
    pub seed: u64,
    /// How often this trial has drawn inputs.
    draws: Cell<u32>,
    /// Where the inputs come from.
    inputs: Inputs,
    /// The calls so far.
    pub(crate) calls: Calls,
}

/// Where the inputs of a trial come from, and how many of them are used.
#[derive(Clone)]
pub struct Inputs {
    /// The inputs that were drawn before, if they are kept.
    pub drawn: Option<Arc<Drawn>>,
    /// Only one in so many inputs is used, and one in so many rows of a picture; at least 1. A grader that repeats a check
    /// with hidden inputs needs no more than a sample: these only have to show that the answers are not those to known
    /// inputs.
    pub one_in: usize,
    /// A kit whose answers are right. If there is one, a check of a text or a picture draws a scene for a hidden seed, and
    /// composes the expected text or picture from the answers of this kit.
    pub reference: Option<Arc<dyn Kit + Send + Sync>>,
    /// If there is a pixel, a check of a picture asks for this pixel alone.
    pub pixel: Option<Arc<Replay>>,
    /// Where the calls are kept for the caller.
    pub calls: Option<Calls>,
    /// Whether a failing input is replaced by a smaller one, which only a message needs.
    pub shrinks: bool,
}

/// The part of its inputs that a check uses with a hidden seed. All known inputs have passed before, and a table of known
/// answers fails on each hidden input, so an eighth is enough, and a class is graded in less time.
pub const ONE_HIDDEN_IN: usize = 8;

/// The fewest inputs of a law with a hidden seed, if it has as many: most rays miss small scenes, and among few of them no
/// answer may differ from a constant.
const FEWEST_HIDDEN: usize = 100;

impl Default for Inputs {
    fn default() -> Self {
        Inputs { drawn: None, one_in: 1, reference: None, pixel: None, calls: None, shrinks: true }
    }
}

impl<'a> Trial<'a> {
    /// A trial of `kit` by the check `name`, with the inputs of `seed`.
    pub fn new(kit: &'a dyn Kit, name: &'static str, seed: u64) -> Self {
        Trial { kit, name, seed, draws: Cell::new(0), inputs: Inputs::default(), calls: Calls::default() }
    }

    /// `public` for the seed that students have, and a value drawn from `hidden` for any other seed.
    ///
    /// Each call draws anew from the same random numbers. Draw values that must be independent as a tuple.
    pub fn varied<S: Strategy>(&self, public: S::Value, hidden: S) -> S::Value {
        if self.seed == PUBLIC_SEED {
            return public;
        }
        hidden.new_tree(&mut self.runner()).map_or(public, |tree| tree.current())
    }

    /// A size of a build: `n` for the seed that students have, and up to a fifth less or more for any other seed.
    pub fn about(&self, n: usize) -> usize {
        self.varied(n, n - n / 5..n + n / 5)
    }

    /// The kit whose answers are the expected ones: only for a hidden seed, and only if the judge has one.
    fn reference(&self) -> Option<&Arc<dyn Kit + Send + Sync>> {
        self.inputs.reference.as_ref().filter(|_| self.seed != PUBLIC_SEED)
    }

    /// `public` if the expected text or picture is a file, and a value drawn from `hidden` if it is composed from the
    /// answers of the reference. Draw values that must be independent as a tuple.
    pub fn composed<S: Strategy>(&self, public: S::Value, hidden: S) -> S::Value {
        if self.reference().is_some() { self.varied(public, hidden) } else { public }
    }

    /// What `compute` returns. It is computed once per seed and kept with the inputs.
    fn kept<T: Send + Sync + 'static>(
        &self,
        caller: &'static Location<'static>,
        compute: &dyn Fn() -> T,
    ) -> Option<Arc<T>> {
        let key = (self.name, self.seed, caller, self.draws.replace(self.draws.get() + 1));
        let compute = || -> Values { Arc::new(compute()) };
        let value = self.inputs.drawn.as_ref().map_or_else(compute, |drawn| drawn.get(key, &compute));
        value.downcast::<T>().ok()
    }

    /// What `compose` makes of the answers of the reference; `None` if the expected value is a file.
    #[track_caller]
    pub(crate) fn expected<T: Send + Sync + 'static>(
        &self,
        compose: impl Fn(&dyn Kit) -> T,
    ) -> Option<Arc<T>> {
        let reference = self.reference()?;
        self.kept(Location::caller(), &|| compose(&**reference))
    }

    /// Draws `cases` inputs, calls `judge` with all of them at once, and shrinks the first input that breaks the law.
    #[track_caller]
    pub fn forall<S: Strategy<Value: Clone + Send + Sync + 'static>>(
        &self,
        cases: usize,
        inputs: S,
        judge: impl Fn(&[S::Value]) -> Vec<CheckResult>,
    ) -> CheckResult {
        self.forall_and(&[], cases, inputs, judge)
    }

    /// The same as [`Trial::forall`], with the inputs `chosen` before those that are drawn, in one batch.
    ///
    /// A chosen input is reported as it is. Choose inputs to which every known mistake gives another answer: a message
    /// names a mistake only if it [explains](crate::Broken::explained_by) all failing inputs.
    #[track_caller]
    pub fn forall_and<S: Strategy<Value: Clone + Send + Sync + 'static>>(
        &self,
        chosen: &[S::Value],
        cases: usize,
        inputs: S,
        judge: impl Fn(&[S::Value]) -> Vec<CheckResult>,
    ) -> CheckResult {
        let cases = cases.div_ceil(self.inputs.one_in).max(FEWEST_HIDDEN.min(cases));
        // Ask about one input first: where the function is not written, the others need not be drawn, which takes longest.
        let first = || Some(inputs.new_tree(&mut self.runner()).ok()?.current());
        if let Some(first) = chosen.first().cloned().or_else(first) {
            self.ask_about_one(&|| judge(std::slice::from_ref(&first)));
        }
        let draw = || {
            let mut runner = self.runner();
            let trees = (0..cases).filter_map(|_| inputs.new_tree(&mut runner).ok());
            chosen.iter().cloned().chain(trees.map(|tree| tree.current())).collect::<Vec<_>>()
        };
        let values = self.kept(Location::caller(), &draw).unwrap_or_default();
        let size = |index: usize| format!("{:?}", values[index]).len();
        let shrink = |drawn: usize, fails: &mut Fails<'_>| {
            // Draw the inputs again with their trees of smaller inputs, which only this step needs.
            let mut runner = self.runner();
            let tree = (0..cases).filter_map(|_| inputs.new_tree(&mut runner).ok()).nth(drawn);
            tree.into_iter().for_each(|tree| law::shrink(tree, &judge, fails));
        };
        self.hold(chosen.len(), values.len(), &|range| judge(&values[range]), &size, &shrink)
    }

    /// Draws `cases` inputs, asks a function of the kit about all of them at once, and [judges](compare) each answer.
    #[track_caller]
    pub fn each<S: Strategy<Value: Clone + Send + Sync + 'static>, A, R: Into<Refuted>>(
        &self,
        cases: usize,
        inputs: S,
        ask: impl Fn(&'a dyn Kit, &[S::Value]) -> Vec<A>,
        judge: impl Fn(&S::Value, A) -> Result<R, Broken>,
    ) -> CheckResult {
        self.each_and(&[], cases, inputs, ask, judge)
    }

    /// The same as [`Trial::each`], with [chosen](Trial::forall_and) inputs before those that are drawn.
    #[track_caller]
    pub fn each_and<S: Strategy<Value: Clone + Send + Sync + 'static>, A, R: Into<Refuted>>(
        &self,
        chosen: &[S::Value],
        cases: usize,
        inputs: S,
        ask: impl Fn(&'a dyn Kit, &[S::Value]) -> Vec<A>,
        judge: impl Fn(&S::Value, A) -> Result<R, Broken>,
    ) -> CheckResult {
        self.forall_and(chosen, cases, inputs, |queries| compare(queries, ask(self.kit, queries), &judge))
    }

    /// Ends the check if the function is not written or does not return.
    fn ask_about_one(&self, judge: &dyn Fn() -> Vec<CheckResult>) {
        let n_batches = self.calls.batches().len();
        match kit_error::catch(judge) {
            Ok(_) | Err(KitError::Panicked { .. } | KitError::Malformed { .. }) => {
                self.calls.batches().truncate(n_batches);
            }
            Err(error) => kit_error::unwind(error),
        }
    }

    /// The part of [`Trial::forall`] that does not depend on the type of the inputs, so that it is compiled only once.
    /// `judge` judges a range of the inputs, of which the first ones are chosen. `size` is how long one is as a text, and `shrink`
    /// searches for a smaller input than the one that was drawn with this index.
    fn hold(
        &self,
        n_chosen: usize,
        n_inputs: usize,
        judge: &dyn Fn(Range<usize>) -> Vec<CheckResult>,
        size: &dyn Fn(usize) -> usize,
        shrink: &dyn Fn(usize, &mut Fails<'_>),
    ) -> CheckResult {
        let alone = |index: usize| judge_one(&|| judge(index..index + 1), &self.calls);
        let outcomes = match kit_error::catch(|| judge(0..n_inputs)) {
            Ok(outcomes) => outcomes,
            // The code panicked on an input of the batch, or built no tree: judge the inputs one by one to find it. If none fails
            // alone, the batch has failed all the same.
            Err(error @ (KitError::Panicked { .. } | KitError::Malformed { .. })) => {
                let failing = (0..n_inputs).find_map(|index| Some((index, alone(index)?)));
                let (n_passed, broken) = failing.unwrap_or_else(|| kit_error::unwind(error));
                [vec![Ok(()); n_passed], vec![Err(broken)]].concat()
            }
            Err(error) => kit_error::unwind(error),
        };
        let Some((first, mut broken)) = broken::first_broken(outcomes.clone()) else {
            self.calls.batches().clear();
            return Ok(());
        };
        if !self.inputs.shrinks {
            return Err(broken);
        }
        // All failing inputs together prove the mistakes, so a smaller input has one of them and keeps the diagnosis. It breaks
        // the law in the same way, so that an input that is too small does not shrink to one that overflows.
        let drawn = broken.clone();
        let mistake = drawn.details.mistakes.first();
        let is_same = |smaller: &Broken| {
            mistake.is_none_or(|one| smaller.is_explained_by(one)) && smaller.is_like(&drawn)
        };
        // Begin with an input that was chosen, or with the smallest one.
        let fails = |&index: &usize| outcomes[index].as_ref().is_err_and(is_same);
        let size = |index: &usize| if *index < n_chosen { 0 } else { size(*index) };
        let smallest = (first..outcomes.len()).filter(fails).min_by_key(size).unwrap_or(first);
        if let Some(smaller) = alone(smallest).filter(is_same) {
            broken = smaller;
        }
        if let Some(drawn) = smallest.checked_sub(n_chosen) {
            shrink(drawn, &mut |judge| {
                judge_one(judge, &self.calls).filter(is_same).map(|smaller| broken = smaller).is_some()
            });
        }
        broken.details.mistakes.clone_from(&drawn.details.mistakes);
        Err(Broken { diagnosis: drawn.diagnosis, ..broken })
    }

    /// Only one in so many rows of a picture is judged.
    pub(crate) fn row_step(&self) -> usize {
        self.inputs.one_in
    }

    /// The pixel that is asked for again, if it is only one.
    pub(crate) fn pixel(&self) -> Option<&Replay> {
        self.inputs.pixel.as_deref()
    }

    /// Whether the inputs are those that students have, so that a command repeats them.
    pub(crate) fn is_public(&self) -> bool {
        self.seed == PUBLIC_SEED
    }

    /// A generator that makes the same random choices in each run.
    fn runner(&self) -> TestRunner {
        let mut seed = [0; 32];
        seed[..8].copy_from_slice(&self.seed.to_le_bytes());
        seed[8..16].copy_from_slice(&fingerprint(self.name).to_le_bytes());
        let config = Config { failure_persistence: None, ..Config::default() };
        TestRunner::new_with_rng(config, TestRng::from_seed(RngAlgorithm::ChaCha, &seed))
    }
}

/// The FNV-1a hash, which is the same on every machine and in every version.
fn fingerprint(name: &str) -> u64 {
    name.bytes()
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

/// Runs one check.
pub fn run(check: &Check, kit: &Arc<dyn Kit + Send + Sync>, seed: u64) -> Verdict {
    verdict(check, examine(check, kit, seed, Inputs::default()))
}

/// Whether `kit` passes a check. Faster than [`run`] if it fails, because there is no message with a small input.
pub fn passes(check: &Check, kit: &Arc<dyn Kit + Send + Sync>, seed: u64) -> bool {
    matches!(examine(check, kit, seed, Inputs { shrinks: false, ..Inputs::default() }), Ok(Ok(())))
}

/// Whether the law holds for these inputs, or the error that prevented an answer.
pub fn examine(
    check: &Check,
    kit: &Arc<dyn Kit + Send + Sync>,
    seed: u64,
    inputs: Inputs,
) -> Result<CheckResult, KitError> {
    let (send, outcome) = mpsc::channel();
    let check = *check;
    let thread = Arc::new(OnceLock::new());
    let (itself, its_kit) = (thread.clone(), kit.clone());
    // A thread that exceeds the time limit is left running and ends with the process.
    let spawned = std::thread::Builder::new()
        .name(check.name.into())
        .stack_size(raykata::worker::STACK_BYTES)
        .spawn(move || {
            let _ = itself.set(Thread::current());
            let calls = inputs.calls.clone().unwrap_or_default();
            let kit: &dyn Kit =
                &Door(Recorder { kit: &*its_kit, calls: inputs.shrinks.then(|| calls.clone()) });
            let trial = Trial { inputs, calls: calls.clone(), ..Trial::new(kit, check.name, seed) };
            // A scene that is drawn needs no turn.
            let is_drawn = check.symmetries == Symmetries::Composed && trial.reference().is_some();
            let symmetries = if is_drawn { Symmetries::None } else { check.symmetries };
            let symmetry = trial.varied(Symmetry::IDENTITY, symmetries.strategy());
            let turned = Door(TurnedKit { kit, symmetry });
            let is_turned = symmetry != Symmetry::IDENTITY;
            let trial = if is_turned { Trial { kit: &turned, ..trial } } else { trial };
            let mut outcome = kit_error::catch(|| (check.law)(&trial));
            if let Ok(Err(broken)) = &mut outcome
                && broken.details.call.is_none()
            {
                broken.details.call = calls.of(broken, false);
            }
            let _ = send.send(outcome);
        });
    if let Err(error) = spawned {
        return Err(KitError::Crashed { how: format!("the check could not be started: {error}") });
    }
    let late = Err(KitError::TimedOut { seconds: PATIENCE.as_secs() });
    patience::receive(&outcome, || thread.get().map_or(Duration::ZERO, Thread::waited) + kit.waited())
        .unwrap_or(late)
}

/// The result of [`examine`] with the message for the student.
pub fn verdict(check: &Check, examined: Result<CheckResult, KitError>) -> Verdict {
    let entry = rubric::entry(check.stage, check.name);
    match examined {
        Ok(Ok(())) => Verdict::Passed,
        Ok(Err(broken)) => Verdict::Failed(broken.message(check.name, &entry)),
        Err(KitError::NotWritten { task, place, .. }) => Verdict::NotWritten { task, place },
        Err(KitError::Panicked { message, place }) => {
            without_answer(check, law::panic_text(&message, &place))
        }
        Err(error) => without_answer(check, error),
    }
}

/// The verdict on a check that has no answer, for this reason.
pub fn without_answer(check: &Check, why: impl std::fmt::Display) -> Verdict {
    let header = rubric::entry(check.stage, check.name).header();
    Verdict::Failed(format!("{header}  {why}\n{}", broken::next_commands(check.stage, check.name)))
}

/// Whether no test of this process has printed this gap before. Several checks wait for one function, and the harness prints
/// nothing about a failed test that prints nothing itself.
fn is_first(gap: &str) -> bool {
    static PRINTED: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    PRINTED.lock().unwrap_or_else(PoisonError::into_inner).insert(gap.to_owned())
}

/// Runs the check whose test has this path as a test of `kit`: prints the message for the student if the check fails, and ends the
/// test. The code prints in every call, so the check runs in a process of its own, and only what one call prints is shown.
/// With `--nocapture` it runs here, and everything is shown.
pub fn grade(checks: &[Check], path: &str, kit: Arc<dyn Kit + Send + Sync>) {
    let (_, name) = path.rsplit_once("::").unwrap_or_default();
    let Some(check) = checks.iter().find(|check| check.name == name) else {
        panic!("there is no check `{name}` in this stage");
    };
    let is_alone = process::is_alone();
    let shows_all = std::env::args().any(|argument| argument == "--nocapture" || argument == "--no-capture");
    let message = if is_alone || shows_all {
        let examined = examine(check, &kit, PUBLIC_SEED, Inputs::default());
        if is_alone {
            let answer = |call: Request| _ = call.answer(&*kit, &Unwatched);
            process::show(|| breaking_call(&examined).into_iter().for_each(answer));
        }
        match verdict(check, examined) {
            Verdict::Passed => None,
            Verdict::NotWritten { task, place } => Some(format!("not written yet: {place}\n  {task}")),
            Verdict::Failed(message) => Some(message),
        }
    } else {
        process::message_of(check, path)
    };
    let Some(message) = message else { return };
    if is_alone {
        process::show(|| println!("{message}"));
    } else if !message.starts_with("not written yet") || is_first(&message) {
        println!("{}", message.trim_end());
    }
    // End the test without the text and the backtrace of a panic, because the message is complete.
    std::panic::resume_unwind(Box::new("the check failed"));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::broken::Broken;
    use raykata::kit::KitError;

    /// A trial whose kit is never called: every call would end with an error.
    fn with_trial<T>(check: impl FnOnce(&Trial<'_>) -> T) -> T {
        struct Silent;
        impl raykata::kit::Transport for Silent {
            fn call(&self, _: raykata::kit::Request, _: &dyn raykata::frame::Watch) -> raykata::kit::Answer {
                kit_error::unwind(KitError::Crashed { how: "this kit does not answer".into() })
            }
        }
        check(&Trial::new(&raykata::kit::Door(Silent), "a_check", 1))
    }

    fn refuse_above(limit: i32) -> impl Fn(&[i32]) -> Vec<CheckResult> {
        move |values| {
            let judge = |value: &i32| {
                if *value <= limit { Ok(()) } else { Err(Broken::new(format!("{value}"), "", "", "")) }
            };
            values.iter().map(judge).collect()
        }
    }

    #[test]
    fn the_smallest_input_is_found_and_the_same_every_time() {
        let find = || with_trial(|trial| trial.forall(200, 0..1000i32, refuse_above(41))).unwrap_err().input;
        assert_eq!(find(), "42");
        assert_eq!(find(), "42");
        assert_eq!(with_trial(|trial| trial.forall(200, 0..1000i32, refuse_above(1000))), Ok(()));
    }

    #[test]
    fn numbers_shrink_to_simple_ones_that_break_the_law_in_the_same_way() {
        let find = |range: Range<f32>, breaks: fn(f32) -> Option<&'static str>| {
            let judge = |number: &f32| match breaks(*number) {
                None => Ok(()),
                Some(yours) => Err(Broken::with_texts(format!("{number:?}"), yours, "", "")),
            };
            let law = |numbers: &[f32]| numbers.iter().map(judge).collect();
            with_trial(|trial| trial.forall(200, crate::generate::number(range), law)).unwrap_err().input
        };
        assert_eq!(find(0.4..90.0, |number| (number > 0.7).then_some("large")), "1.0");
        assert_eq!(find(-90.0..0.0, |number| (number < -1.2).then_some("small")), "-2.0");
        assert_eq!(find(400.0..2e3, |number| (number > 600.0).then_some("large")), "1000.0");
        // A small number does not shrink to a large one, although 1 breaks the law as well.
        let of_two_kinds = |number: f32| if number < 0.2 { Some("small") } else { Some("large 7") };
        assert_eq!(find(0.01..0.21, of_two_kinds).len(), "0.1".len());
    }

    #[test]
    fn a_panic_is_traced_to_the_smallest_input_that_makes_it() {
        let law = |values: &[i32]| {
            values
                .iter()
                .map(|value| if *value < 42 { Ok(()) } else { panic!("{value} is too large") })
                .collect()
        };
        let broken = with_trial(|trial| trial.forall(200, 0..1000i32, law)).unwrap_err();
        assert!(broken.yours.ends_with(": 42 is too large"), "{}", broken.yours);
    }

    #[test]
    fn a_batch_fails_although_each_of_its_inputs_passes_alone() {
        let law =
            |values: &[i32]| if values.len() < 5 { vec![Ok(()); values.len()] } else { panic!("too many") };
        let failed = kit_error::catch(|| with_trial(|trial| trial.forall(5, 0..9i32, law)));
        assert!(matches!(failed, Err(KitError::Panicked { .. })), "{failed:?}");
    }

    #[test]
    #[allow(clippy::todo, reason = "this test is about gaps")]
    fn a_gap_stays_a_gap() {
        let law = |_: &[i32]| -> Vec<CheckResult> { todo!("write it") };
        let gap = kit_error::catch(|| with_trial(|trial| trial.forall(5, 0..9i32, law)));
        assert!(matches!(gap, Err(KitError::NotWritten { .. })), "{gap:?}");
    }
}
