//! Ends a process that does not answer in time.

use super::launcher::{Launcher, lock};
use super::waiting;
use raykata::worker::Thread;
use std::process::Child;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
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
    barked: AtomicBool,
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
    /// Its processor time, if nothing else counts.
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
            barked: AtomicBool::new(false),
            launcher,
        });
        let (on_duty, child) = (watchdog.clone(), child.clone());
        std::thread::spawn(move || on_duty.watch(&child));
        watchdog
    }

    fn watch(&self, child: &Mutex<Child>) {
        let process = lock(child).id();
        let times = |call: &Call| Times {
            computed: self.launcher.as_ref().map(|launcher| launcher.cpu_time(process)),
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
            match call.more_time(times(&call)) {
                Some(later) => state.deadline = Deadline::At(call, later),
                None => {
                    self.barked.store(true, Ordering::Relaxed);
                    let _ = lock(child).kill();
                    return;
                }
            }
        }
    }

    pub(super) fn has_barked(&self) -> bool {
        self.barked.load(Ordering::Relaxed)
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
    /// The time of the next test if the process may continue.
    fn more_time(&self, times: Times) -> Option<Instant> {
        let before = self.before.unwrap_or_default();
        let waited = times.waited.saturating_sub(before.waited);
        let now = Instant::now();
        let (spent, most) = match times.computed {
            Some(computed) => (computed.saturating_sub(before.computed.unwrap_or_default()), MOST_TIMES),
            None => ((now - self.asked).saturating_sub(waited), 1),
        };
        let last = self.asked + self.patience * most + waited;
        let wanting = self.patience.checked_sub(spent).filter(|wanting| !wanting.is_zero())?;
        (now < last).then(|| (now + wanting).min(last))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whether a call with a limit of 2 s goes on after so many seconds.
    fn goes_on(elapsed: u64, computed: Option<u64>, waited: u64) -> bool {
        let call = Call {
            caller: Thread::default(),
            asked: Instant::now() - Duration::from_secs(elapsed),
            patience: Duration::from_secs(2),
            before: Some(Times {
                computed: computed.map(|_| Duration::ZERO),
                waited: Duration::from_secs(5),
            }),
        };
        let times = Times {
            computed: computed.map(Duration::from_secs),
            waited: Duration::from_secs(5) + Duration::from_secs(waited),
        };
        call.more_time(times).is_some()
    }

    #[test]
    fn time_without_a_processor_does_not_count() {
        assert!(!goes_on(3, None, 0));
        assert!(goes_on(3, None, 2));
        assert!(!goes_on(9, None, 6));
    }

    #[test]
    fn untrusted_code_may_sleep_for_a_while_but_compute_no_longer() {
        assert!(goes_on(3, Some(1), 0));
        assert!(!goes_on(3, Some(2), 0));
        assert!(!goes_on(7, Some(1), 0));
        assert!(goes_on(7, Some(1), 3));
    }
}
