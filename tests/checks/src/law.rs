//! A law over random inputs: they are drawn and judged together, and an input that breaks the law shrinks to a smaller one.

use crate::broken::{Broken, CheckResult};
use crate::calls::Calls;
use crate::drawn::Values;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;
use raykata::kit::{KitError, kit_error};
use std::any::Any;
use std::sync::Arc;

/// The largest number of smaller inputs that are tried when a law is broken.
const SHRINK_STEPS: usize = 400;

/// Inputs together with their judge, for code that does not know their type. `values` is always a `Vec` of inputs.
pub(crate) trait Law {
    /// Draws `cases` inputs.
    fn draw(&self, cases: usize, runner: &mut TestRunner) -> Values;
    /// The number of inputs.
    fn count(&self, values: &AnyValues) -> usize;
    /// Judges all inputs.
    fn judge(&self, values: &AnyValues) -> Vec<CheckResult>;
    /// Judges one input.
    fn judge_one(&self, values: &AnyValues, index: usize) -> Vec<CheckResult>;
    /// The tree of smaller inputs to which the input with this index can shrink.
    fn tree<'a>(&'a self, cases: usize, runner: &mut TestRunner, index: usize) -> Option<Box<dyn Tree + 'a>>;
}

pub(crate) type AnyValues = dyn Any + Send + Sync;

/// A tree of smaller inputs, for code that does not know their type.
pub(crate) trait Tree {
    fn simplify(&mut self) -> bool;
    fn complicate(&mut self) -> bool;
    /// Judges the current input.
    fn judge(&self) -> Vec<CheckResult>;
}

/// Inputs of one type with the function that judges them.
pub(crate) struct Judged<S: Strategy, J> {
    /// How inputs are drawn.
    pub inputs: S,
    /// The judge.
    pub judge: J,
    /// The inputs before those that are drawn.
    pub chosen: Vec<S::Value>,
}

impl<S: Strategy, J: Fn(&[S::Value]) -> Vec<CheckResult>> Law for Judged<S, J>
where
    S::Value: Clone + Send + Sync + 'static,
{
    fn draw(&self, cases: usize, runner: &mut TestRunner) -> Values {
        let mut values = self.chosen.clone();
        for _ in 0..cases {
            if let Ok(tree) = self.inputs.new_tree(runner) {
                values.push(tree.current());
            }
        }
        Arc::new(values)
    }

    fn count(&self, values: &AnyValues) -> usize {
        values.downcast_ref::<Vec<S::Value>>().map_or(0, Vec::len)
    }

    fn judge(&self, values: &AnyValues) -> Vec<CheckResult> {
        values.downcast_ref::<Vec<S::Value>>().map_or_else(Vec::new, |values| (self.judge)(values))
    }

    fn judge_one(&self, values: &AnyValues, index: usize) -> Vec<CheckResult> {
        let values = values.downcast_ref::<Vec<S::Value>>();
        values.map_or_else(Vec::new, |values| (self.judge)(&values[index..=index]))
    }

    fn tree<'a>(&'a self, cases: usize, runner: &mut TestRunner, index: usize) -> Option<Box<dyn Tree + 'a>> {
        // A chosen input is small already.
        let drawn = index.checked_sub(self.chosen.len())?;
        let tree = (0..cases).filter_map(|_| self.inputs.new_tree(runner).ok()).nth(drawn)?;
        Some(Box::new(JudgedTree { tree, judge: &self.judge }))
    }
}

struct JudgedTree<'a, T, J> {
    tree: T,
    judge: &'a J,
}

impl<T: ValueTree, J: Fn(&[T::Value]) -> Vec<CheckResult>> Tree for JudgedTree<'_, T, J> {
    fn simplify(&mut self) -> bool {
        self.tree.simplify()
    }

    fn complicate(&mut self) -> bool {
        self.tree.complicate()
    }

    fn judge(&self) -> Vec<CheckResult> {
        (self.judge)(&[self.tree.current()])
    }
}

/// The broken law of one input, if it breaks one, with the call that breaks it. A panic counts.
pub(crate) fn judge_one(judge: &dyn Fn() -> Vec<CheckResult>, calls: &Calls) -> Option<Broken> {
    calls.batches().clear();
    let mut broken = match kit_error::catch(judge) {
        Ok(outcomes) => outcomes.into_iter().find_map(Result::err)?,
        Err(KitError::Panicked { message, place }) => {
            let panic = format!("a panic at {place}: {message}");
            Broken::with_texts("one with which your code panics", panic, "an answer", "the definition")
        }
        Err(error) => kit_error::unwind(error),
    };
    broken.details.call = calls.of(&broken, true);
    Some(broken)
}

/// Searches for a smaller input that breaks the law as well, by the same mistake if one is known.
pub(crate) fn shrink(mut tree: Box<dyn Tree + '_>, first: Broken, calls: &Calls) -> Broken {
    // All failing inputs together prove the mistakes, so a smaller input keeps its diagnosis.
    let (mistakes, diagnosis) = (first.details.mistakes.clone(), first.diagnosis.clone());
    let mut smallest = first;
    let mut steps = 0;
    let mut going = tree.simplify();
    while going && steps < SHRINK_STEPS {
        steps += 1;
        going = match judge_one(&|| tree.judge(), calls) {
            Some(broken) if mistakes.first().is_none_or(|mistake| broken.is_explained_by(mistake)) => {
                smallest = broken;
                tree.simplify()
            }
            _ => tree.complicate(),
        };
    }
    smallest.details.mistakes = mistakes;
    Broken { diagnosis, ..smallest }
}
