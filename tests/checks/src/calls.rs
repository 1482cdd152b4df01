//! The calls that a check makes, with their answers.

use crate::broken::{Broken, CheckResult, words};
use crate::structure;
use raykata::frame::Watch;
use raykata::kit::{Answer, Kit, KitError, Request, Transport, kit_error};
use std::hash::{BuildHasher, BuildHasherDefault, DefaultHasher};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// A batch of calls of one function, and their answers once they are known.
pub type Batch = (Request, Option<Answer>);

/// Swaps that put `n` queries into another order for each seed but 0, whose inputs are public.
pub fn swaps(seed: u64, n: usize) -> Vec<(usize, usize)> {
    let draw =
        |i: usize| BuildHasherDefault::<DefaultHasher>::default().hash_one((seed, n, i)) as usize % (i + 1);
    if seed == 0 { Vec::new() } else { (1..n).map(|i| (i, draw(i))).collect() }
}

/// The batches of a check, in the order in which it asks.
#[derive(Clone, Default)]
pub struct Calls(Arc<Mutex<Vec<Batch>>>);

impl Calls {
    /// The batches so far.
    pub fn batches(&self) -> MutexGuard<'_, Vec<Batch>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The call that gives the word with this index of a table, if the name of a function precedes each of its answers there.
    pub(crate) fn of_table(&self, words: &[&str], index: usize) -> Option<Request> {
        let batches = self.batches();
        let calls = || batches.iter().filter_map(|(request, _)| Some((request, request.queries()?)));
        let name =
            *words[..index].iter().rfind(|word| calls().any(|(_, (function, _))| function == **word))?;
        // Only one batch may ask this function, with one call per answer of the table.
        let mut of_name = calls().filter(|(_, (function, _))| *function == name);
        let (request, (_, queries)) = of_name.next().filter(|_| of_name.next().is_none())?;
        let count = |words: &[&str]| words.iter().filter(|word| **word == name).count();
        if queries.len() == count(words) { request.only(count(&words[..index]) - 1) } else { None }
    }

    /// The call that breaks the law, if it was part of a batch in which each input has one call. If `is_alone`, all batches were
    /// asked about this input, and the first ones are judged; otherwise the last batches are about it. Of these calls it is
    /// the first one whose function the input names, and whose answer is printed as yours, if there is one.
    pub(crate) fn of(&self, broken: &Broken, is_alone: bool) -> Option<Request> {
        let Some((index, n_inputs)) = broken.details.index.or(is_alone.then_some((0, 1))) else {
            // A law about one input ends at the call that breaks it. A call that is too long to read is no help.
            let request = self.batches().last()?.0.clone();
            let (function, queries) = request.queries()?;
            let is_it = queries.len() == 1 && words(&broken.input).any(|word| word == function);
            return request
                .only(0)
                .filter(|call| is_it && call.call().is_some_and(|call| call.len() < 1 << 17));
        };
        let fits = |(request, answer): &Batch| {
            let (function, queries) = request.queries()?;
            let call = request.only(index).filter(|_| queries.len() == n_inputs)?;
            let values = answer.as_ref().map(|answer| answer.values()).unwrap_or_default();
            let is_printed = values.get(index).is_some_and(|one| format!("{one:?}").contains(&broken.yours));
            Some(((broken.input.contains(function), is_printed), call))
        };
        let mut fitting: Vec<_> = self.batches().iter().filter_map(fits).collect();
        // The last one of equal keys is the maximum.
        if is_alone {
            fitting.reverse();
        }
        fitting.into_iter().max_by_key(|(key, _)| *key).map(|(_, call)| call)
    }
}

/// The call that breaks the law, if it is a single one.
pub fn breaking_call(examined: &Result<CheckResult, KitError>) -> Option<Request> {
    examined.as_ref().ok()?.as_ref().err()?.details.call.clone()
}

/// Passes each request on, and the answer back unless it is malformed.
pub(crate) struct Recorder<'a> {
    pub(crate) kit: &'a dyn Kit,
    /// Where requests and answers are kept, if a message needs them.
    pub(crate) calls: Option<Calls>,
}

impl Transport for Recorder<'_> {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        self.calls.iter().for_each(|calls| calls.batches().push((request.clone(), None)));
        let answer = request.answer(self.kit, watch);
        if let Some(what) = structure::fault(&answer) {
            kit_error::unwind(KitError::Malformed { what });
        }
        let keep = |batch: &mut Batch| batch.1 = Some(answer.clone());
        self.calls.iter().for_each(|calls| calls.batches().last_mut().into_iter().for_each(keep));
        answer
    }

    fn waited(&self) -> Duration {
        self.kit.waited()
    }
}
