//! The time limit of a check. Time for which nothing could compute because others used the processors does not count, so that
//! a busy machine changes no verdict.

use std::sync::mpsc::{Receiver, RecvTimeoutError};
use std::time::{Duration, Instant};

/// The time limit of a check. The slowest check, `steps_in_an_empty_cornell_box_agree_with_radiosity`, takes the
/// reference half a second in a development build.
pub(crate) const PATIENCE: Duration = Duration::from_secs(15);

/// Receives the outcome of a check; `None` if there is none within the time limit. `waited` is the time for which its code has
/// waited for a processor so far.
pub(crate) fn receive<T>(outcome: &Receiver<T>, waited: impl Fn() -> Duration) -> Option<T> {
    let begin = Instant::now();
    let before = waited();
    let mut rest = Some(PATIENCE);
    while let Some(time) = rest {
        match outcome.recv_timeout(time) {
            Ok(outcome) => return Some(outcome),
            Err(RecvTimeoutError::Disconnected) => return None,
            Err(RecvTimeoutError::Timeout) => {
                rest = left(begin.elapsed(), waited().saturating_sub(before));
            }
        }
    }
    None
}

/// The part of the time limit that is left; `None` if nothing is.
fn left(elapsed: Duration, waited: Duration) -> Option<Duration> {
    PATIENCE.checked_sub(elapsed.saturating_sub(waited)).filter(|rest| !rest.is_zero())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc;

    #[test]
    fn time_without_a_processor_does_not_count() {
        assert_eq!(left(PATIENCE, Duration::ZERO), None);
        assert_eq!(left(PATIENCE, Duration::from_secs(4)), Some(Duration::from_secs(4)));
        assert_eq!(left(3 * PATIENCE, 2 * PATIENCE), None);
        // Both are measured one after the other, so the second may be larger.
        assert_eq!(left(Duration::ZERO, Duration::from_secs(1)), Some(PATIENCE));
    }

    #[test]
    fn a_thread_that_ends_without_an_outcome_is_not_waited_for() {
        let (send, outcome) = mpsc::channel::<()>();
        drop(send);
        assert_eq!(receive(&outcome, || Duration::ZERO), None);
    }
}
