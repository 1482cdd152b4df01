//! A law over random inputs: they are drawn and judged together, and an input that breaks the law shrinks to a smaller one.

use crate::broken::{Broken, CheckResult};
use crate::calls::Calls;
use crate::drawn::Values;
use proptest::strategy::{Strategy, ValueTree};
use proptest::test_runner::TestRunner;
use raykata::kit::{KitError, kit_error};
use std::any::Any;
use std::ops::Range;
use std::sync::Arc;

/// The largest number of smaller inputs that are tried when a law is broken.
const SHRINK_STEPS: usize = 400;

/// Inputs together with their judge, for code that does not know their type. `values` is always a `Vec` of inputs.
pub(crate) trait Law {
    /// Draws `cases` inputs.
    fn draw(&self, cases: usize, runner: &mut TestRunner) -> Values;
    /// The number of inputs.
    fn count(&self, values: &AnyValues) -> usize;
    /// Judges the inputs with these indices.
    fn judge(&self, values: &AnyValues, range: Range<usize>) -> Vec<CheckResult>;
    /// Searches for a smaller input than the one with this index that `fails` as well. It gets the judge of each input.
    fn shrink(&self, cases: usize, runner: &mut TestRunner, index: usize, fails: &mut Fails<'_>);
}

pub(crate) type AnyValues = dyn Any + Send + Sync;

/// Whether the input fails that this function judges.
type Fails<'a> = dyn FnMut(&dyn Fn() -> Vec<CheckResult>) -> bool + 'a;

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

    fn judge(&self, values: &AnyValues, range: Range<usize>) -> Vec<CheckResult> {
        let values = values.downcast_ref::<Vec<S::Value>>();
        values.map_or_else(Vec::new, |values| (self.judge)(&values[range]))
    }

    fn shrink(&self, cases: usize, runner: &mut TestRunner, index: usize, fails: &mut Fails<'_>) {
        // A chosen input is small already.
        let Some(drawn) = index.checked_sub(self.chosen.len()) else { return };
        // Draw the inputs again with their trees of smaller inputs, which only this step needs.
        let tree = (0..cases).filter_map(|_| self.inputs.new_tree(runner).ok()).nth(drawn);
        let Some(mut tree) = tree else { return };
        let mut is_new = tree.simplify();
        for _ in 0..SHRINK_STEPS {
            is_new = match is_new {
                true if fails(&|| (self.judge)(&[tree.current()])) => tree.simplify(),
                true => tree.complicate(),
                false => return,
            };
        }
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
