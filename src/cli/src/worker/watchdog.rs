//! Ends a process that does not answer in time.

use super::{Launcher, lock};
use std::process::Child;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The limit of elapsed time in units of the patience, for a process that sleeps or reads. The time that it waits for a
/// processor does not count. With a larger limit a process that sleeps would delay the grading of a class.
const MOST_TIMES: u32 = 3;

/// The fraction of its patience after which the processor time of a call is measured. Most calls end earlier
/// and cost no measurement.
const COUNTED_AFTER: u32 = 20;

/// Ends a process that exceeds its time. It has one thread per process, which sleeps between calls.
pub(super) struct Watchdog {
    deadline: Mutex<Deadline>,
    changed: Condvar,
    barked: AtomicBool,
    /// Measures the times of the process. If it is set, time counts only while the process computes.
    launcher: Option<Arc<dyn Launcher>>,
}

#[derive(Clone, Copy, PartialEq)]
enum Deadline {
    None,
    At(Call, Instant),
    Retired,
}

#[derive(Clone, Copy, PartialEq)]
struct Call {
    asked: Instant,
    patience: Duration,
    /// The times of the process when measuring began.
    before: Option<Times>,
}

/// The times of a process so far.
#[derive(Clone, Copy, Default, PartialEq)]
struct Times {
    computed: Duration,
    waited: Duration,
}

impl Watchdog {
    /// Starts a watchdog for this process.
    pub(super) fn guard(child: &Arc<Mutex<Child>>, launcher: Option<Arc<dyn Launcher>>) -> Arc<Watchdog> {
        let watchdog = Arc::new(Watchdog {
            deadline: Mutex::new(Deadline::None),
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
        let fair = self.launcher.is_some();
        let times = || match &self.launcher {
            Some(launcher) => {
                Times { computed: launcher.cpu_time(process), waited: launcher.waited(process) }
            }
            None => Times { computed: Duration::MAX, waited: Duration::ZERO },
        };
        let mut deadline = lock(&self.deadline);
        loop {
            deadline = match *deadline {
                Deadline::Retired => return,
                Deadline::None => self.changed.wait(deadline).unwrap_or_else(PoisonError::into_inner),
                Deadline::At(call, end) => match end.checked_duration_since(Instant::now()) {
                    Some(left) => {
                        let early = call.patience / COUNTED_AFTER;
                        let left = match call.before {
                            None if fair => early.saturating_sub(call.asked.elapsed()).min(left),
                            _ => left,
                        };
                        let (mut deadline, timed_out) =
                            self.changed.wait_timeout(deadline, left).unwrap_or_else(PoisonError::into_inner);
                        if let Deadline::At(call, _) = &mut *deadline
                            && timed_out.timed_out()
                            && fair
                            && call.before.is_none()
                            && call.asked.elapsed() >= early
                        {
                            call.before = Some(times());
                        }
                        deadline
                    }
                    None => match call.more_time(times()) {
                        Some(later) => {
                            *deadline = Deadline::At(call, later);
                            deadline
                        }
                        None => {
                            self.barked.store(true, Ordering::Relaxed);
                            let _ = lock(child).kill();
                            return;
                        }
                    },
                },
            };
        }
    }

    pub(super) fn has_barked(&self) -> bool {
        self.barked.load(Ordering::Relaxed)
    }

    pub(super) fn bark_after(&self, patience: Duration) {
        let asked = Instant::now();
        self.set(Deadline::At(Call { asked, patience, before: None }, asked + patience));
    }

    pub(super) fn rest(&self) {
        self.set(Deadline::None);
    }

    pub(super) fn retire(&self) {
        self.set(Deadline::Retired);
    }

    fn set(&self, deadline: Deadline) {
        *lock(&self.deadline) = deadline;
        self.changed.notify_one();
    }
}

impl Call {
    /// The time of the next test if the process may continue.
    fn more_time(&self, times: Times) -> Option<Instant> {
        let before = self.before.unwrap_or_default();
        let computed = times.computed.saturating_sub(before.computed);
        let last = self.asked + self.patience * MOST_TIMES + times.waited.saturating_sub(before.waited);
        let wanting = self.patience.checked_sub(computed).filter(|wanting| !wanting.is_zero())?;
        let now = Instant::now();
        (now < last).then(|| (now + wanting).min(last))
    }
}
