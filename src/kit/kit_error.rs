//! The reasons why student code does not return an answer.

use super::Function;
use crate::message;
use std::cell::RefCell;
use std::fmt;
use std::panic::{self, AssertUnwindSafe, PanicHookInfo};
use std::sync::Once;

/// The reason why there is no answer.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum KitError {
    /// The code reached a `todo!`.
    NotWritten {
        /// The text of the `todo!`: what is to be written.
        task: String,
        /// The place of the `todo!` as `file:line`.
        place: String,
        /// The innermost student function that was running; `None` if that was in another process.
        function: Option<Function>,
    },
    /// The code panicked.
    Panicked {
        /// The message of the panic.
        message: String,
        /// The place of the panic as `file:line`.
        place: String,
    },
    /// The process that runs the code ended.
    Crashed {
        /// A sentence that says how it ended.
        how: String,
    },
    /// The code did not return in time.
    TimedOut {
        /// The time after which it was stopped, in seconds.
        seconds: u64,
    },
    /// The code did not return in time, and waited for most of it.
    Waited {
        /// The time after which it was stopped, in seconds.
        seconds: u64,
    },
    /// The answer does not fit the request: it is of another kind, or has another length.
    Malformed {
        /// The beginning of the answer, or a sentence that says what is wrong.
        what: String,
    },
}

message! { enum KitError {
    NotWritten { task, place; function }, Panicked { message, place }, Crashed { how }, TimedOut { seconds },
    Waited { seconds }, Malformed { what }
} }

impl fmt::Display for KitError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            KitError::NotWritten { task, place, .. } => write!(f, "not written yet: {place}\n  {task}"),
            KitError::Panicked { message, place } => write!(f, "your code panicked at {place}\n  {message}"),
            KitError::Crashed { how } => write!(f, "your code ended its process: {how}"),
            KitError::TimedOut { seconds } => {
                write!(f, "no answer after {seconds} s: is there an infinite loop or recursion?")
            }
            KitError::Waited { seconds } => write!(
                f,
                "no answer after {seconds} s: your code waits and does not compute. Does it wait for standard input \
                 (`stdin`), which never comes, or for a lock, or sleep?"
            ),
            KitError::Malformed { what } => write!(f, "the answer does not fit the request: {what}"),
        }
    }
}

impl std::error::Error for KitError {}

/// Unwinds with `error`, which [`catch`] returns. A transport calls this if there is no answer.
///
/// # Panics
///
/// Always.
pub fn unwind(error: KitError) -> ! {
    panic::resume_unwind(Box::new(error))
}

/// Unwinds with [`KitError::Malformed`] and the first 200 characters of the answer; a hostile answer may be very
/// long.
pub(super) fn wrong_answer(answer: &dyn fmt::Debug) -> ! {
    let mut beginning = LimitedText { words: String::new(), room: 200 };
    // Formatting fails when `LimitedText` is full, so ignore its result.
    let _ = fmt::write(&mut beginning, format_args!("{answer:?}"));
    unwind(KitError::Malformed { what: beginning.words })
}

struct LimitedText {
    words: String,
    room: usize,
}

impl fmt::Write for LimitedText {
    fn write_str(&mut self, more: &str) -> fmt::Result {
        for letter in more.chars() {
            self.room = self.room.checked_sub(1).ok_or(fmt::Error)?;
            self.words.push(letter);
        }
        Ok(())
    }
}

/// What is known of a panic before it is caught.
#[derive(Default)]
struct LastPanic {
    /// The message and the place; `None` if it began on another thread.
    words: Option<(String, String)>,
    /// The first student function that it left, which is the innermost one.
    function: Option<Function>,
}

thread_local! {
    /// `None` if panics of this thread are not caught; otherwise the last panic, for [`catch`].
    static CAUGHT: RefCell<Option<LastPanic>> = const { RefCell::new(None) };
}

/// Notes that a panic on this thread leaves `function`.
pub(super) fn note_function(function: Function) {
    CAUGHT.with_borrow_mut(|caught| {
        if let Some(last) = caught {
            last.function.get_or_insert(function);
        }
    });
}

/// Runs `work` and returns its result. A panic of `work` on this thread prints nothing.
///
/// # Errors
///
/// If `work` panics: the [`KitError`] with which it unwound, [`KitError::NotWritten`] for a `todo!`, and
/// [`KitError::Panicked`] otherwise.
pub fn catch<T>(work: impl FnOnce() -> T) -> Result<T, KitError> {
    install_hook();
    let outer = CAUGHT.replace(Some(LastPanic::default()));
    let result = panic::catch_unwind(AssertUnwindSafe(work));
    let LastPanic { words, function } = CAUGHT.replace(outer).unwrap_or_default();
    result.map_err(|payload| match payload.downcast::<KitError>() {
        Ok(error) => *error,
        Err(payload) => {
            let (message, place) = words.unwrap_or_else(|| (words_of(&*payload), "another thread".into()));
            match message.strip_prefix("not yet implemented") {
                Some(task) => {
                    let task = task.trim_start_matches(": ").to_owned();
                    KitError::NotWritten { task, place, function }
                }
                None => KitError::Panicked { message, place },
            }
        }
    })
}

fn install_hook() {
    static INSTALLED: Once = Once::new();
    INSTALLED.call_once(|| {
        let previous = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            let ours = CAUGHT.with_borrow_mut(|caught| match caught {
                Some(last) => {
                    let words = Some((words_of(info.payload()), place_of(info)));
                    *last = LastPanic { words, function: None };
                    true
                }
                None => false,
            });
            if !ours {
                previous(info);
            }
        }));
    });
}

fn words_of(payload: &(dyn std::any::Any + Send)) -> String {
    match (payload.downcast_ref::<String>(), payload.downcast_ref::<&str>()) {
        (Some(words), _) => words.clone(),
        (None, Some(words)) => (*words).to_owned(),
        (None, None) => "a panic without a message".to_owned(),
    }
}

fn place_of(info: &PanicHookInfo<'_>) -> String {
    info.location().map_or_else(
        || "an unknown place".to_owned(),
        |place| format!("{}:{}", place.file().replace('\\', "/"), place.line()),
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[allow(clippy::todo, reason = "a gap is what this is about")]
    fn a_gap_reads_as_not_written_yet() {
        let gap = catch(|| -> i32 { todo!("add the numbers") });
        let Err(KitError::NotWritten { task, place, .. }) = gap else { panic!("{gap:?}") };
        assert_eq!(task, "add the numbers");
        assert!(place.starts_with("src/kit/kit_error.rs:"), "{place}");
    }

    #[test]
    fn a_panic_keeps_its_words_and_its_place() {
        let broken = catch(|| Vec::<i32>::new()[3]);
        let Err(KitError::Panicked { message, .. }) = broken else { panic!("{broken:?}") };
        assert_eq!(message, "index out of bounds: the len is 0 but the index is 3");
    }

    #[test]
    fn an_inner_catch_leaves_the_outer_one_in_place() {
        let outer = catch(|| {
            assert!(catch(|| panic!("inner")).is_err());
            panic!("outer")
        });
        let Err(KitError::Panicked { message, .. }) = outer else { panic!("no panic") };
        assert_eq!(message, "outer");
    }
}
