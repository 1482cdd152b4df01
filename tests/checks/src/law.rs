//! A law over random inputs: they are drawn and judged together, and an input that breaks the law shrinks to a smaller one.

use crate::broken::{Broken, CheckResult};
use crate::calls::Calls;
use proptest::strategy::ValueTree;
use raykata::kit::{KitError, kit_error};

/// The largest number of smaller inputs that are tried when a law is broken.
const SHRINK_STEPS: usize = 400;

/// What a panic says by itself: words of its message, and the mistake that they prove.
const PANICS: [(&str, &str); 10] = crate::named![
    "only for the primitives of the leaf" => "a free lane of a block is asked for: the last block of a leaf may not be full",
    "so the recursion never ends" =>
        "a side of a split is empty, so the other one is divided again and again: halve the list there",
    "the search does not end" => "a step of the search does not advance along the ray, so it does not end",
    "only t_max may change" => "the probe is asked with another ray than those of the packet",
    "subtract with overflow" => "a difference of whole numbers does not fit into its type: it is below 0, or too small",
    "add with overflow" => "a sum of whole numbers does not fit into its type: saturate it, or take a larger type",
    "multiply with overflow" => "a product of whole numbers does not fit into its type: saturate it, or take a larger type",
    "`None` value" => "`None` is unwrapped: the input has no such value, and this case needs an answer of its own",
    "divide by zero" => "a whole number is divided by 0: this case needs an answer of its own",
    "index out of bounds" => "an index is not below the length of its list",
];

/// A panic that no batch of inputs has caught, with its mistake.
pub(crate) fn panic_text(message: &str, place: &str) -> String {
    let known = PANICS.into_iter().find(|(words, _)| message.contains(words));
    let looks = known.map_or(String::new(), |(_, text)| format!("\n  looks like: {text}"));
    format!("{}{looks}", KitError::Panicked { message: message.into(), place: place.into() })
}

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
            let known = PANICS.map(|(words, text)| (message.contains(words), text));
            Broken::with_texts("one with which your code panics", panic, "an answer", "the definition")
                .explained_by(known)
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
