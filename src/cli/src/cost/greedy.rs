//! The greedy search: from the cheapest value of every parameter, always the step that lowers the error most
//! for its time.

use super::goal::{AS_GOOD, Goal, Left, Step, seconds_in_full};
use super::measure::Bench;
use super::measured::{Measured, Point, Reference, Series};
use super::parameter::Parameter;
use super::setting::Setting;
use crate::progress::ProgressBar;
use crate::report::bar_of_steps;
use anyhow::Result;
use raykata::scene::Scene;

/// The fraction of a budget that is planned; the rest is a reserve, because frame times differ by some percent.
const SHARE: f64 = 0.95;

/// The most samples per pixel that are proposed.
const MOST_SAMPLES: u32 = 65_536;

/// How often the number of samples is corrected, each time by at least a twentieth, because times vary by
/// some percent.
const ATTEMPTS: u32 = 4;

/// The settings that have been measured. Each is measured once and then kept.
pub struct Tried<'a> {
    pub bench: &'a Bench<'a>,
    pub scene: &'a Scene,
    pub right: &'a Reference,
    pub known: Vec<Point>,
}

impl Tried<'_> {
    /// The measurement of `setting`; `None` if it takes too long or the program is being stopped.
    pub fn point(&mut self, setting: &Setting) -> Result<Option<Point>> {
        if let Some(point) = self.known.iter().find(|point| point.setting == *setting) {
            return Ok(Some(point.clone()));
        }
        let point = self.bench.point(self.scene, setting, self.right, false)?;
        self.known.extend(point.clone());
        Ok(point)
    }
}

/// The state of a search.
pub struct GreedySearch<'a, 't> {
    tried: &'a mut Tried<'t>,
    measured: &'a Measured,
    ladders: Vec<&'a Series>,
    /// The current level of each ladder.
    at: Vec<usize>,
    goal: Goal,
    full: f64,
    pub now: Point,
    pub steps: Vec<Step>,
    bar: ProgressBar,
}

/// A possible next step.
struct Candidate {
    /// The ladder, and the level after the step.
    ladder: usize,
    level: usize,
    point: Point,
    /// The logarithm of the error reduction, per second.
    worth: f64,
}

impl<'a, 't> GreedySearch<'a, 't> {
    /// Starts at the lowest level of all ladders, with everything else as in `start`. `None` if even that
    /// takes too long.
    pub fn new(
        tried: &'a mut Tried<'t>,
        measured: &'a Measured,
        ladders: Vec<&'a Series>,
        start: Setting,
        goal: Goal,
        full: f64,
    ) -> Result<Option<GreedySearch<'a, 't>>> {
        let foot = ladders.iter().fold(start, |setting, series| {
            setting.turned(series.parameter, &measured.points[series.levels[0].1].setting)
        });
        let bar = bar_of_steps(ladders.iter().map(|series| series.levels.len()).sum());
        bar.set_message("looking for the best settings");
        let Some(now) = tried.point(&foot)? else { return Ok(None) };
        let at = vec![0; ladders.len()];
        Ok(Some(GreedySearch { tried, measured, ladders, at, goal, full, now, steps: Vec::new(), bar }))
    }

    /// Continues until the goal is reached or no step helps. `false` if the program is being stopped.
    pub fn go_up(&mut self) -> Result<bool> {
        while !self.has_arrived() {
            let best = self.best_step()?;
            if self.tried.bench.stopped() {
                return Ok(false);
            }
            let Some(Candidate { ladder, level, point, .. }) = best else { break };
            self.at[ladder] = level;
            let (name, _) = &self.ladders[ladder].levels[level];
            self.go_to(point, self.ladders[ladder].parameter, name.clone());
            self.bar.inc(1);
        }
        self.bar.finish_and_clear();
        Ok(true)
    }

    fn has_arrived(&self) -> bool {
        matches!(self.goal, Goal::Error(target) if self.now.error() <= target)
    }

    fn fits(&self, point: &Point) -> bool {
        match self.goal {
            Goal::Seconds(budget) => seconds_in_full(point, self.full) <= SHARE * budget,
            Goal::Error(_) => true,
        }
    }

    fn go_to(&mut self, point: Point, parameter: Parameter, to: String) {
        let seconds = seconds_in_full(&point, self.full);
        self.steps.push(Step { parameter, to, error: point.error(), seconds });
        self.now = point;
    }

    /// The current setting with one ladder at another level.
    fn turned_to(&self, ladder: usize, level: usize) -> Setting {
        let series = self.ladders[ladder];
        let to = &self.measured.points[series.levels[level].1].setting;
        self.now.setting.turned(series.parameter, to)
    }

    fn best_step(&mut self) -> Result<Option<Candidate>> {
        let mut best: Option<Candidate> = None;
        for ladder in 0..self.ladders.len() {
            // Try the next level and the one after it, because some parameters help only after a larger step.
            for level in (self.at[ladder] + 1..self.ladders[ladder].levels.len()).take(2) {
                let Some(point) = self.tried.point(&self.turned_to(ladder, level))? else { continue };
                let gain = (self.now.error() / point.error().max(1e-12)).ln();
                // Bound the time from below, because a step of no measurable time would have an infinite worth.
                let time = (point.seconds - self.now.seconds).max(0.01 * self.now.seconds);
                let worth = gain / time;
                let helps = self.fits(&point) && point.error() * AS_GOOD < self.now.error();
                if helps && best.as_ref().is_none_or(|best| worth > best.worth) {
                    best = Some(Candidate { ladder, level, point, worth });
                }
            }
        }
        Ok(best)
    }

    /// Spends the rest of a budget on samples, whose levels are a factor of two apart.
    pub fn spend_the_rest(&mut self) -> Result<()> {
        let Goal::Seconds(budget) = self.goal else { return Ok(()) };
        if !self.ladders.iter().any(|series| series.parameter == Parameter::Samples) {
            return Ok(());
        }
        let samples = |point: &Point| point.setting.quality.samples_per_pixel;
        let (mut priced, mut most) = (self.now.clone(), MOST_SAMPLES);
        for _ in 0..ATTEMPTS {
            // Take as many samples as fit into the budget at the last measured time per sample.
            let price = priced.seconds * self.full / f64::from(samples(&priced));
            let pays_for = ((SHARE * budget - priced.build_seconds) / price.max(1e-9)) as u32;
            if pays_for.min(most) <= samples(&self.now) {
                break;
            }
            let mut more = self.now.setting.clone();
            more.quality.samples_per_pixel = pays_for.min(most);
            let Some(point) = self.tried.point(&more)? else { break };
            if self.fits(&point) {
                if point.error() < self.now.error() {
                    self.go_to(point, Parameter::Samples, pays_for.min(most).to_string());
                }
                break;
            }
            most = samples(&point) - samples(&point) / 20;
            priced = point;
        }
        Ok(())
    }

    /// The effect of one more step of each parameter.
    pub fn one_step_more(&mut self) -> Result<Vec<Left>> {
        let mut left = Vec::new();
        for ladder in 0..self.ladders.len() {
            let (series, at) = (self.ladders[ladder], self.at[ladder]);
            if at + 1 == series.levels.len() {
                continue;
            }
            let more = self.turned_to(ladder, at + 1);
            let here = &self.now.setting;
            // Skip the samples if they already lie above the next level, or at it.
            if more.quality.samples_per_pixel < here.quality.samples_per_pixel || more == *here {
                continue;
            }
            if let Some(more) = self.tried.point(&more)? {
                left.push(Left {
                    parameter: series.parameter,
                    at: series.levels[at].0.clone(),
                    time_factor: more.seconds / self.now.seconds.max(1e-9),
                    error_factor: more.error() / self.now.error().max(1e-12),
                });
            }
        }
        Ok(left)
    }

    /// The current value of each parameter.
    pub fn values(&self) -> Vec<(Parameter, String)> {
        let value = |(series, &level): (&&Series, &usize)| match series.parameter {
            Parameter::Samples => (series.parameter, self.now.setting.quality.samples_per_pixel.to_string()),
            parameter => (parameter, series.levels[level].0.clone()),
        };
        self.ladders.iter().zip(&self.at).map(value).collect()
    }
}
