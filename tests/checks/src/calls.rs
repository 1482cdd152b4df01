//! The calls that a check makes, with their answers.

use crate::broken::Broken;
use raykata::frame::Watch;
use raykata::kit::{Answer, Kit, Request, Transport};
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
    /// asked about this input, and the first ones are judged; otherwise the last batches are about it.
    pub(crate) fn of(&self, broken: &Broken, is_alone: bool) -> Option<Request> {
        let (index, n_inputs) = broken.details.index.unwrap_or((0, 1));
        let batches = self.batches();
        let named = batches.iter().filter_map(|(request, _)| Some((request.queries()?, request)));
        let mut fitting: Vec<_> = named.filter(|((_, queries), _)| queries.len() == n_inputs).collect();
        if !is_alone {
            fitting.reverse();
        }
        let is_named = |((function, _), _): &&((&str, _), _)| broken.input.contains(function);
        fitting.iter().find(is_named).or(fitting.first())?.1.only(index)
    }
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
