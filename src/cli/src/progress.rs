//! A progress bar on standard error. It is drawn on a terminal only, not into a file or a pipe.

use crate::queue::lock;
use std::fmt::Write as _;
use std::io::{IsTerminal, Write};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::time::{Duration, Instant};

/// The time between two drawings.
const PAUSE: Duration = Duration::from_millis(100);

/// The time between two drawings while no progress is reported.
const TICK: Duration = Duration::from_millis(500);

/// The columns of the bar, and of the whole line.
const BAR: usize = 30;
const LINE: usize = 79;

/// A line that shows the progress of a task.
#[derive(Clone)]
pub struct ProgressBar(Arc<Shared>);

struct Shared {
    visible: bool,
    over: AtomicBool,
    state: Mutex<State>,
}

struct State {
    done: u64,
    /// The number of steps; 0 while it is unknown.
    total: u64,
    message: String,
    began: Instant,
    drawn: Option<Instant>,
}

impl ProgressBar {
    /// A bar for `total` steps; 0 if their number is unknown.
    pub fn new(total: u64) -> ProgressBar {
        let (message, began) = (String::new(), Instant::now());
        let state = Mutex::new(State { done: 0, total, message, began, drawn: None });
        let visible = std::io::stderr().is_terminal();
        ProgressBar(Arc::new(Shared { visible, over: AtomicBool::new(false), state }))
    }

    fn state(&self) -> MutexGuard<'_, State> {
        lock(&self.0.state)
    }

    fn change(&self, change: impl FnOnce(&mut State)) {
        let mut state = self.state();
        change(&mut state);
        let waits = state.drawn.is_some_and(|drawn| drawn.elapsed() < PAUSE);
        if self.0.visible && !waits {
            state.draw();
        }
    }

    /// Adds `steps` finished steps.
    pub fn inc(&self, steps: u64) {
        self.change(|state| state.done += steps);
    }

    /// Sets the number of finished steps and of all steps.
    pub fn set(&self, done: u64, total: u64) {
        self.change(|state| (state.done, state.total) = (done, total));
    }

    /// Sets the number of all steps.
    pub fn set_length(&self, total: u64) {
        self.change(|state| state.total = total);
    }

    /// Sets the message that says what is being done.
    pub fn set_message(&self, message: impl Into<String>) {
        self.change(|state| state.message = message.into());
    }

    /// Starts again from 0 with another message, because the next steps take another time each.
    pub fn begin(&self, message: impl Into<String>, total: u64) {
        self.change(|state| {
            (state.done, state.total, state.began) = (0, total, Instant::now());
            state.message = message.into();
        });
    }

    /// Redraws the line regularly, so that the elapsed time is up to date.
    pub fn tick(&self) {
        let bar = self.clone();
        if !bar.0.visible {
            return;
        }
        std::thread::spawn(move || {
            while !bar.0.over.load(Ordering::Relaxed) && Arc::strong_count(&bar.0) > 1 {
                bar.change(|_| ());
                std::thread::sleep(TICK);
            }
        });
    }

    /// Removes the line while `print` runs.
    pub fn suspend<T>(&self, print: impl FnOnce() -> T) -> T {
        let mut state = self.state();
        self.clear(&mut state);
        print()
    }

    /// Removes the line after the last step.
    pub fn finish_and_clear(&self) {
        self.0.over.store(true, Ordering::Relaxed);
        let mut state = self.state();
        self.clear(&mut state);
    }

    fn clear(&self, state: &mut State) {
        if self.0.visible && state.drawn.take().is_some() {
            let _ = write!(std::io::stderr(), "\r\u{1b}[K");
        }
    }
}

impl State {
    fn draw(&mut self) {
        self.drawn = Some(Instant::now());
        let line = self.line(self.began.elapsed());
        // The terminal cuts a line that is longer than its rows, because a line that is continued below would stay there.
        let _ = write!(std::io::stderr(), "\r\u{1b}[?7l{line}\u{1b}[K\u{1b}[?7h");
    }

    fn line(&self, gone: Duration) -> String {
        let mut line = String::new();
        if self.total == 0 {
            let _ = write!(line, "{} elapsed  {}", clock(gone), self.message);
        } else {
            let share = (self.done as f64 / self.total as f64).min(1.0);
            let full = (share * BAR as f64) as usize;
            let _ = write!(line, "{}{} {:>3.0} %", "█".repeat(full), "░".repeat(BAR - full), 100.0 * share);
            if self.done > 0 {
                let left = gone.mul_f64((1.0 - share) / share.max(1e-9));
                let _ = write!(line, "  {} elapsed, {} left", clock(gone), clock(left));
            }
            let _ = write!(line, "  {}", self.message);
        }
        line.chars().take(LINE).collect()
    }
}

fn clock(time: Duration) -> String {
    let seconds = time.as_secs();
    match seconds {
        0..60 => format!("{seconds} s"),
        60..3600 => format!("{}:{:02} min", seconds / 60, seconds % 60),
        _ => format!("{}:{:02} h", seconds / 3600, seconds / 60 % 60),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_how_far_it_is_and_how_long_it_takes() {
        let mut state =
            State { done: 0, total: 0, message: "a frame".into(), began: Instant::now(), drawn: None };
        assert_eq!(state.line(Duration::from_secs(7)), "7 s elapsed  a frame");
        (state.done, state.total) = (1, 4);
        let line = state.line(Duration::from_secs(40));
        assert!(line.ends_with(" 25 %  40 s elapsed, 2:00 min left  a frame"), "{line}");
        state.message = "x".repeat(200);
        assert_eq!(state.line(Duration::from_secs(40)).chars().count(), LINE);
    }

    #[test]
    fn what_nobody_sees_is_counted_and_not_drawn() {
        let bar = ProgressBar::new(3);
        bar.tick();
        bar.inc(2);
        bar.set_message("two");
        assert_eq!(bar.suspend(|| 7), 7);
        // One lock at a time: it is not taken twice by the same thread.
        let done_and_message = |bar: &ProgressBar| {
            let state = bar.state();
            (state.done, state.message.clone())
        };
        assert_eq!(done_and_message(&bar), (2, "two".to_owned()));
        bar.begin("anew", 5);
        assert_eq!(done_and_message(&bar), (0, "anew".to_owned()));
        assert_eq!(bar.state().total, 5);
        bar.finish_and_clear();
    }
}
