//! Ends a process that does not answer in time.

use super::launcher::Launcher;
use super::waiting;
use crate::queue::lock;
use raykata::kit::KitError;
use raykata::worker::Thread;
use std::process::Child;
use std::sync::{Arc, Condvar, Mutex, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// The limit of elapsed time in units of the patience, for a process of untrusted code that sleeps or reads. With a larger
/// limit it would delay the grading of a class.
const MOST_TIMES: u32 = 3;

/// The fraction of its patience after which the times of a call are measured. Most calls end earlier and cost no
/// measurement.
const COUNTED_AFTER: u32 = 20;

/// Ends a process that exceeds its time. It has one thread per process, which sleeps between calls.
///
/// The time for which the process or its caller waits for a processor does not count, so that a busy machine does not end it.
pub(super) struct Watchdog {
    state: Mutex<State>,
    changed: Condvar,
    /// Why it has ended the process.
    barked: OnceLock<KitError>,
    /// Measures the processor time of untrusted code. If it is set, time counts only while the process computes.
    launcher: Option<Arc<dyn Launcher>>,
}

struct State {
    deadline: Deadline,
    /// When the thread wakes by itself; `None` if it waits for a call. Waking it for each call would cost more than most
    /// calls.
    wakes: Option<Instant>,
}

#[derive(Clone, PartialEq)]
enum Deadline {
    None,
    At(Call, Instant),
    Retired,
}

#[derive(Clone, PartialEq)]
struct Call {
    /// The thread that waits for the answer.
    caller: Thread,
    asked: Instant,
    patience: Duration,
    /// The times of the process when measuring began.
    before: Option<Times>,
}

/// The times of a process so far.
#[derive(Clone, Copy, Default, PartialEq)]
struct Times {
    /// Its processor time, if it is known.
    computed: Option<Duration>,
    /// The time for which it or its caller had no processor.
    waited: Duration,
}

impl Watchdog {
    /// Starts a watchdog for this process.
    pub(super) fn guard(child: &Arc<Mutex<Child>>, launcher: Option<Arc<dyn Launcher>>) -> Arc<Watchdog> {
        let watchdog = Arc::new(Watchdog {
            state: Mutex::new(State { deadline: Deadline::None, wakes: None }),
            changed: Condvar::new(),
            barked: OnceLock::new(),
            launcher,
        });
        let (on_duty, child) = (watchdog.clone(), child.clone());
        std::thread::spawn(move || on_duty.watch(&child));
        watchdog
    }

    fn watch(&self, child: &Mutex<Child>) {
        let process = lock(child).id();
        let times = |call: &Call| Times {
            computed: match &self.launcher {
                Some(launcher) => Some(launcher.cpu_time(process)),
                None => waiting::most(process, |thread| thread.ran()),
            },
            waited: waiting::waited(process) + call.caller.waited(),
        };
        let mut state = lock(&self.state);
        loop {
            let (call, end) = match &state.deadline {
                Deadline::Retired => return,
                Deadline::None => {
                    state.wakes = None;
                    state = self.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
                    continue;
                }
                Deadline::At(call, end) => (call.clone(), *end),
            };
            let now = Instant::now();
            if now < end {
                // Sleep until the times are to be measured, or else until the deadline.
                let measured = call.asked + call.patience / COUNTED_AFTER;
                let measures = call.before.is_none();
                if measures && now >= measured {
                    state.deadline = Deadline::At(Call { before: Some(times(&call)), ..call }, end);
                    continue;
                }
                let wakes = if measures { measured.min(end) } else { end };
                state.wakes = Some(wakes);
                let waited = self.changed.wait_timeout(state, wakes - now);
                state = waited.unwrap_or_else(PoisonError::into_inner).0;
                continue;
            }
            match call.more_time(times(&call), self.launcher.is_some()) {
                Ok(later) => state.deadline = Deadline::At(call, later),
                Err(late) => {
                    let _ = self.barked.set(late);
                    let _ = lock(child).kill();
                    return;
                }
            }
        }
    }

    /// The reason why it has ended the process, if it has.
    pub(super) fn reason(&self) -> Option<KitError> {
        self.barked.get().cloned()
    }

    pub(super) fn bark_after(&self, patience: Duration) {
        let (asked, caller) = (Instant::now(), Thread::current());
        let mut state = lock(&self.state);
        state.deadline = Deadline::At(Call { caller, asked, patience, before: None }, asked + patience);
        // A thread that wakes early enough by itself then sees the new deadline.
        if state.wakes.is_none_or(|wakes| wakes > asked + patience / COUNTED_AFTER) {
            self.changed.notify_one();
        }
    }

    pub(super) fn rest(&self) {
        lock(&self.state).deadline = Deadline::None;
    }

    pub(super) fn retire(&self) {
        lock(&self.state).deadline = Deadline::Retired;
        self.changed.notify_one();
    }
}

impl Call {
    /// The time of the next test if the process may continue, or else why not. Only the processor time of untrusted code
    /// counts.
    fn more_time(&self, times: Times, is_untrusted: bool) -> Result<Instant, KitError> {
        let before = self.before.unwrap_or_default();
        let waited = times.waited.saturating_sub(before.waited);
        let now = Instant::now();
        let elapsed = (now - self.asked).saturating_sub(waited);
        let computed =
            times.computed.map(|computed| computed.saturating_sub(before.computed.unwrap_or_default()));
        let (spent, most) = match computed {
            Some(computed) if is_untrusted => (computed, MOST_TIMES),
            _ => (elapsed, 1),
        };
        let last = self.asked + self.patience * most + waited;
        match self.patience.checked_sub(spent).filter(|wanting| !wanting.is_zero() && now < last) {
            Some(wanting) => Ok((now + wanting).min(last)),
            // Code that has computed for less than a part of the time waits.
            None if computed.is_some_and(|computed| computed * MOST_TIMES < elapsed) => {
                Err(KitError::Waited { seconds: (self.patience * most).as_secs() })
            }
            None => Err(KitError::TimedOut { seconds: self.patience.as_secs() }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The reason why a call with a limit of 2 s ends after so many seconds, if it does.
    fn ends(elapsed: u64, computed: u64, waited: u64, is_untrusted: bool) -> Option<KitError> {
        let seconds = Duration::from_secs;
        let call = Call {
            caller: Thread::default(),
            asked: Instant::now() - seconds(elapsed),
            patience: seconds(2),
            before: Some(Times { computed: Some(Duration::ZERO), waited: seconds(5) }),
        };
        let times = Times { computed: Some(seconds(computed)), waited: seconds(5 + waited) };
        call.more_time(times, is_untrusted).err()
    }

    #[test]
    fn time_without_a_processor_does_not_count() {
        assert_eq!(ends(3, 3, 0, false), Some(KitError::TimedOut { seconds: 2 }));
        assert_eq!(ends(3, 1, 2, false), None);
        assert_eq!(ends(9, 3, 6, false), Some(KitError::TimedOut { seconds: 2 }));
    }

    #[test]
    fn untrusted_code_may_sleep_for_a_while_but_compute_no_longer() {
        assert_eq!(ends(3, 1, 0, true), None);
        assert_eq!(ends(3, 2, 0, true), Some(KitError::TimedOut { seconds: 2 }));
        assert_eq!(ends(7, 1, 0, true), Some(KitError::Waited { seconds: 6 }));
        assert_eq!(ends(7, 1, 3, true), None);
        assert_eq!(ends(7, 0, 0, false), Some(KitError::Waited { seconds: 2 }));
    }
}
