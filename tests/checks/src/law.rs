//! A law over random inputs: they are drawn and judged together, and an input that breaks the law shrinks to a smaller one.

use crate::broken::{Broken, CheckResult};
use crate::calls::Calls;
use proptest::strategy::ValueTree;
use raykata::kit::{KitError, kit_error};

/// The largest number of smaller inputs that are tried when a law is broken.
const SHRINK_STEPS: usize = 400;

/// Whether the input fails that this function judges.
pub(crate) type Fails<'a> = dyn FnMut(&dyn Fn() -> Vec<CheckResult>) -> bool + 'a;

/// Searches for a smaller input than that of `tree`.
pub(crate) fn shrink<T: ValueTree>(
    mut tree: T,
    judge: impl Fn(&[T::Value]) -> Vec<CheckResult>,
    fails: &mut Fails<'_>,
) {
    let mut is_new = tree.simplify();
    for _ in 0..SHRINK_STEPS {
        is_new = match is_new {
            true if fails(&|| judge(&[tree.current()])) => tree.simplify(),
            true => tree.complicate(),
            false => return,
        };
    }
}

/// The broken law of one input, if it breaks one, with the call that breaks it. A panic and a malformed answer count.
pub(crate) fn judge_one(judge: &dyn Fn() -> Vec<CheckResult>, calls: &Calls) -> Option<Broken> {
    calls.batches().clear();
    let mut broken = match kit_error::catch(judge) {
        Ok(outcomes) => outcomes.into_iter().find_map(Result::err)?,
        Err(KitError::Panicked { message, place }) => {
            let panic = format!("a panic at {place}: {message}");
            Broken::with_texts("one with which your code panics", panic, "an answer", "the definition")
        }
        Err(KitError::Malformed { what }) => Broken::with_texts(
            "one for which the answer is malformed",
            what,
            "a well-formed answer",
            "the definition",
        ),
        Err(error) => kit_error::unwind(error),
    };
    broken.details.call = calls.of(&broken, true);
    Some(broken)
}
