//! The calls that a check makes, with their answers.

use crate::broken::{Broken, CheckResult};
use raykata::frame::Watch;
use raykata::kit::{Answer, Kit, KitError, Request, Transport};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

/// A batch of calls of one function, and their answers once they are known.
pub type Batch = (Request, Option<Answer>);

/// The batches of a check, in the order in which it asks.
#[derive(Clone, Default)]
pub struct Calls(Arc<Mutex<Vec<Batch>>>);

impl Calls {
    /// The batches so far.
    pub fn batches(&self) -> MutexGuard<'_, Vec<Batch>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The call that breaks the law, if it was part of a batch in which each input has one call. If `is_alone`, all batches were
    /// asked about this input, and the first ones are judged; otherwise the last batches are about it. Of several calls it is
    /// the one whose function and numbers the input names.
    pub(crate) fn of(&self, broken: &Broken, is_alone: bool) -> Option<Request> {
        let (index, n_inputs) = broken.details.index.or(is_alone.then_some((0, 1)))?;
        let numbers = |text: &str| -> Vec<String> {
            let words = text.split(|sign: char| !(sign.is_ascii_alphanumeric() || "+-.".contains(sign)));
            words.filter(|word| word.parse::<f32>().is_ok()).map(str::to_owned).collect()
        };
        let of_input = numbers(&broken.input);
        let likeness = |(function, request): &(&str, Request)| {
            let of_call = numbers(&request.call().unwrap_or_default());
            let n_shared = of_input.iter().filter(|number| of_call.contains(number)).count();
            (broken.input.contains(function), n_shared)
        };
        let fits = |(request, _): &Batch| {
            let (function, queries) = request.queries()?;
            Some((function, request.only(index).filter(|_| queries.len() == n_inputs)?))
        };
        // `max_by_key` returns the last one of several.
        let mut fitting: Vec<_> = self.batches().iter().filter_map(fits).collect();
        if is_alone {
            fitting.reverse();
        }
        fitting.into_iter().max_by_key(likeness).map(|(_, request)| request)
    }
}

/// The call that breaks the law, if it is a single one.
pub fn breaking_call(examined: &Result<CheckResult, KitError>) -> Option<Request> {
    examined.as_ref().ok()?.as_ref().err()?.details.call.clone()
}

/// Passes each request on, and keeps it with its answer.
pub(crate) struct Recorder<'a> {
    pub(crate) kit: &'a dyn Kit,
    pub(crate) calls: Calls,
}

impl Transport for Recorder<'_> {
    fn call(&self, request: Request, watch: &dyn Watch) -> Answer {
        self.calls.batches().push((request.clone(), None));
        let answer = request.answer(self.kit, watch);
        if let Some(batch) = self.calls.batches().last_mut() {
            batch.1 = Some(answer.clone());
        }
        answer
    }

    fn waited(&self) -> Duration {
        self.kit.waited()
    }
}
