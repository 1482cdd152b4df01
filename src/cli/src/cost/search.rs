//! The best settings for a time or an error. Some parameters have a best value that does not depend on the others; the rest is
//! a greedy search: from the cheapest value of every parameter, always the step that lowers the error most for its time.

use super::measure::Bench;
use super::measured::{Measured, Point, Reference, Series};
use super::parameter::Parameter;
use super::setting::Setting;
use crate::report::{FrameBar, bar_of_steps};
use anyhow::Result;
use raykata::scene::{Sampler, Scene};
use serde::Serialize;

/// The goal of the search.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Goal {
    /// The smallest error within this many seconds.
    Seconds(f64),
    /// The shortest time with at most this error.
    Error(f64),
}

/// One step of the search: a parameter is set to a higher level.
#[derive(Clone, Debug, Serialize)]
pub struct Step {
    pub parameter: Parameter,
    pub to: String,
    pub error: f64,
    /// The time of a picture of the full size, in seconds.
    pub seconds: f64,
}

/// A parameter that the search leaves at its level, and the effect of one more level.
#[derive(Clone, Debug, Serialize)]
pub struct OneMoreLevel {
    pub parameter: Parameter,
    /// Its value.
    pub at: String,
    /// The factors by which one more level changes time and error, for example 1.5.
    pub time_factor: f64,
    pub error_factor: f64,
}

/// The proposed settings for a goal, and the steps of the search.
#[derive(Clone, Debug, Serialize)]
pub struct Advice {
    pub goal: Goal,
    /// The proposed values of the parameters.
    pub values: Vec<(Parameter, String)>,
    pub steps: Vec<Step>,
    pub left: Vec<OneMoreLevel>,
    /// Values that are faster but let rays through closed surfaces, one sentence each.
    pub passed_over: Vec<String>,
    /// Error and time of the scene's own settings.
    pub own_error: f64,
    pub own_seconds: f64,
    /// The expected error and time of the proposal, and those measured when it was rendered in full size.
    pub expected_error: f64,
    pub expected_seconds: f64,
    pub verified_error: Option<f64>,
    pub verified_seconds: Option<f64>,
    /// The command that renders the proposal.
    pub command: String,
    #[serde(skip)]
    pub setting: Setting,
}

/// Parameters with a best value that does not depend on the others: the fastest of the equally accurate values.
const CHOSEN_ONCE: [Parameter; 10] = [
    Parameter::Accelerator,
    Parameter::Split,
    Parameter::LeafSize,
    Parameter::GridResolution,
    Parameter::Intersection,
    Parameter::SphereTest,
    Parameter::Precision,
    Parameter::KdHeuristics,
    Parameter::Savings,
    Parameter::Copies,
];

/// Parameters that the proposal leaves at the scene's own value: another one shows another scene, or lets light leak.
pub const KEPT: [Parameter; 4] =
    [Parameter::IndirectLight, Parameter::Fresnel, Parameter::Tessellation, Parameter::RayOffset];

/// The factor up to which a larger error counts as the same.
const AS_GOOD: f64 = 1.02;

/// The fraction of a budget that is planned; the rest is a reserve, because frame times differ by some percent.
const SHARE: f64 = 0.95;

/// The most samples per pixel that are proposed.
const MOST_SAMPLES: u32 = 65_536;

/// How often the number of samples is corrected, each time by at least a twentieth, because times vary by
/// some percent.
const ATTEMPTS: u32 = 4;

/// Searches settings for pictures of the size of `full` by pictures of `small`, and renders the proposal. `None` if the program is
/// being stopped, or if even the cheapest setting takes too long.
pub fn advise(
    bench: &Bench<'_>,
    [small, full]: [&Scene; 2],
    measured: &Measured,
    right: &Reference,
    goal: Goal,
) -> Result<Option<Advice>> {
    let pixels = |scene: &Scene| f64::from(scene.film.width) * f64::from(scene.film.height);
    // Choose the parameters whose best value does not depend on the others.
    let (start, passed_over) = with_what_is_best(measured, &Setting::of(small));
    let mut search = Search {
        bench,
        scene: small,
        measured,
        right,
        goal,
        full: pixels(full) / pixels(small),
        known: Vec::new(),
        ladders: Vec::new(),
        steps: Vec::new(),
    };
    // Search the values of the other parameters.
    let Some(now) = search.run(start)? else { return Ok(None) };
    // Measure one more step of each parameter, and the scene's own settings.
    let left = search.one_step_more(&now)?;
    let Some(own) = search.point(&Setting::of(small))? else { return Ok(None) };
    // Render the proposal with other random numbers, in the small size for its error and in full size for its time.
    let others = Bench { seed: bench.seed + (1 << 20), ..*bench };
    let verified = others.point(small, &now.setting, right, false)?;
    let bar = FrameBar::new("the proposal, in full size");
    let job = others.job(&now.setting.apply(full), others.seed, false);
    let frame = others.render(&job, None, &bar)?;
    bar.finish();
    Ok(Some(Advice {
        goal,
        values: [search.values(&now), names_of_chosen(measured, &now.setting)].concat(),
        left,
        passed_over,
        own_error: own.error(),
        own_seconds: search.seconds(&own),
        expected_error: now.error(),
        expected_seconds: search.seconds(&now),
        verified_error: verified.map(|point| point.error()),
        verified_seconds: frame.map(|frame| frame.build_seconds + frame.render_seconds),
        command: String::new(),
        steps: search.steps,
        setting: now.setting,
    }))
}

/// The state of a search.
struct Search<'a> {
    bench: &'a Bench<'a>,
    scene: &'a Scene,
    measured: &'a Measured,
    right: &'a Reference,
    goal: Goal,
    /// The number of pixels in full size divided by that of the measured picture.
    full: f64,
    /// The settings that have been measured. Each is measured once and then kept.
    known: Vec<Point>,
    /// The parameters that the search changes, and the current level of each.
    ladders: Vec<(&'a Series, usize)>,
    steps: Vec<Step>,
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

impl Search<'_> {
    /// The measurement of `setting`; `None` if it takes too long or the program is being stopped.
    fn point(&mut self, setting: &Setting) -> Result<Option<Point>> {
        if let Some(point) = self.known.iter().find(|point| point.setting == *setting) {
            return Ok(Some(point.clone()));
        }
        let point = self.bench.point(self.scene, setting, self.right, false)?;
        self.known.extend(point.clone());
        Ok(point)
    }

    /// Seconds for a picture of the full size; the build time stays the same.
    fn seconds(&self, point: &Point) -> f64 {
        point.seconds * self.full + point.build_seconds
    }

    /// Starts at the lowest level of all ladders, with everything else as in `start`, and continues until the goal is reached or
    /// no step helps. `None` if even the start takes too long, or if the program is being stopped.
    fn run(&mut self, start: Setting) -> Result<Option<Point>> {
        let measured = self.measured;
        let turned = |series: &&Series| {
            !(series.levels.is_empty()
                || is_chosen_once(series.parameter)
                || KEPT.contains(&series.parameter))
        };
        self.ladders = measured.series.iter().filter(turned).map(|series| (series, 0)).collect();
        let foot = self.ladders.iter().fold(start, |setting, (series, _)| {
            setting.turned(series.parameter, &measured.points[series.levels[0].1].setting)
        });
        let bar = bar_of_steps(self.ladders.iter().map(|(series, _)| series.levels.len()).sum());
        bar.set_message("looking for the best settings");
        let Some(mut now) = self.point(&foot)? else { return Ok(None) };
        while !matches!(self.goal, Goal::Error(target) if now.error() <= target) {
            let best = self.best_step(&now)?;
            if self.bench.stopped() {
                return Ok(None);
            }
            let Some(Candidate { ladder, level, point, .. }) = best else { break };
            self.ladders[ladder].1 = level;
            let series = self.ladders[ladder].0;
            now = self.step(point, series.parameter, series.levels[level].0.clone());
            bar.inc(1);
        }
        bar.finish_and_clear();
        self.spend_the_rest(now).map(Some)
    }

    /// Notes a step to `point`, and returns that point.
    fn step(&mut self, point: Point, parameter: Parameter, to: String) -> Point {
        let (error, seconds) = (point.error(), self.seconds(&point));
        self.steps.push(Step { parameter, to, error, seconds });
        point
    }

    fn fits(&self, point: &Point) -> bool {
        match self.goal {
            Goal::Seconds(budget) => self.seconds(point) <= SHARE * budget,
            Goal::Error(_) => true,
        }
    }

    /// The setting of `now` with one ladder at another level.
    fn turned_to(&self, now: &Point, ladder: usize, level: usize) -> Setting {
        let series = self.ladders[ladder].0;
        now.setting.turned(series.parameter, &self.measured.points[series.levels[level].1].setting)
    }

    fn best_step(&mut self, now: &Point) -> Result<Option<Candidate>> {
        let mut best: Option<Candidate> = None;
        for ladder in 0..self.ladders.len() {
            let (series, at) = self.ladders[ladder];
            // Try the next level and the one after it, because some parameters help only after a larger step.
            for level in (at + 1..series.levels.len()).take(2) {
                let Some(point) = self.point(&self.turned_to(now, ladder, level))? else { continue };
                let gain = (now.error() / point.error().max(1e-12)).ln();
                // Bound the time from below, because a step of no measurable time would have an infinite worth.
                let time = (point.seconds - now.seconds).max(0.01 * now.seconds);
                let worth = gain / time;
                let helps = self.fits(&point) && point.error() * AS_GOOD < now.error();
                if helps && best.as_ref().is_none_or(|best| worth > best.worth) {
                    best = Some(Candidate { ladder, level, point, worth });
                }
            }
        }
        Ok(best)
    }

    /// Spends the rest of a budget on samples, whose levels are a factor of two apart.
    fn spend_the_rest(&mut self, now: Point) -> Result<Point> {
        let Goal::Seconds(budget) = self.goal else { return Ok(now) };
        if !self.ladders.iter().any(|(series, _)| series.parameter == Parameter::Samples) {
            return Ok(now);
        }
        let samples = |point: &Point| point.setting.quality.samples_per_pixel;
        let (mut priced, mut most) = (now.clone(), MOST_SAMPLES);
        for _ in 0..ATTEMPTS {
            // Take as many samples as fit into the budget at the last measured time per sample.
            let price = priced.seconds * self.full / f64::from(samples(&priced));
            let pays_for = ((SHARE * budget - priced.build_seconds) / price.max(1e-9)) as u32;
            if pays_for.min(most) <= samples(&now) {
                break;
            }
            let mut more = now.setting.clone();
            more.quality.samples_per_pixel = pays_for.min(most);
            let Some(point) = self.point(&more)? else { break };
            if self.fits(&point) {
                if point.error() < now.error() {
                    return Ok(self.step(point, Parameter::Samples, pays_for.min(most).to_string()));
                }
                break;
            }
            most = samples(&point) - samples(&point) / 20;
            priced = point;
        }
        Ok(now)
    }

    /// The effect of one more step of each parameter.
    fn one_step_more(&mut self, now: &Point) -> Result<Vec<OneMoreLevel>> {
        let mut left = Vec::new();
        for ladder in 0..self.ladders.len() {
            let (series, at) = self.ladders[ladder];
            if at + 1 == series.levels.len() {
                continue;
            }
            let more = self.turned_to(now, ladder, at + 1);
            // Skip the samples if they already lie above the next level, or at it.
            let has_fewer = more.quality.samples_per_pixel < now.setting.quality.samples_per_pixel;
            if has_fewer || more == now.setting {
                continue;
            }
            if let Some(more) = self.point(&more)? {
                left.push(OneMoreLevel {
                    parameter: series.parameter,
                    at: series.levels[at].0.clone(),
                    time_factor: more.seconds / now.seconds.max(1e-9),
                    error_factor: more.error() / now.error().max(1e-12),
                });
            }
        }
        Ok(left)
    }

    /// The value of each parameter that the search changes.
    fn values(&self, now: &Point) -> Vec<(Parameter, String)> {
        let value = |&(series, level): &(&Series, usize)| match series.parameter {
            Parameter::Samples => (series.parameter, now.setting.quality.samples_per_pixel.to_string()),
            parameter => (parameter, series.levels[level].0.clone()),
        };
        self.ladders.iter().map(value).collect()
    }
}

fn is_chosen_once(parameter: Parameter) -> bool {
    CHOSEN_ONCE.contains(&parameter) || parameter == Parameter::Sampler
}

/// The setting with the best value of every parameter that is chosen once, and a sentence for each faster
/// value that leaks.
fn with_what_is_best(measured: &Measured, own: &Setting) -> (Setting, Vec<String>) {
    let (mut setting, mut passed_over) = (own.clone(), Vec::new());
    let leaks = |point: &Point| point.hits.map_or(0, |hits| hits.leaks);
    for series in measured.series.iter().filter(|series| CHOSEN_ONCE.contains(&series.parameter)) {
        let levels = || series.levels.iter().map(|(name, index)| (name, &measured.points[*index]));
        // A ladder of another structure than the chosen one says nothing about it.
        let is_other = |point: &Point| point.setting.quality.accelerator != setting.quality.accelerator;
        if series.parameter != Parameter::Accelerator && levels().all(|(_, point)| is_other(point)) {
            continue;
        }
        let least = levels().map(|(_, point)| point.error()).fold(f64::INFINITY, f64::min);
        let good = || levels().filter(|(_, point)| point.error() <= AS_GOOD * least);
        // Leave out values that leak: this picture may not show it, but another scene may.
        let fewest = good().map(|(_, point)| leaks(point)).min().unwrap_or_default();
        let tight = good().filter(|(_, point)| leaks(point) == fewest);
        let tight: Vec<_> = tight.map(|(_, point)| point).collect();
        let Some(fastest) = tight.iter().min_by(|a, b| a.seconds.total_cmp(&b.seconds)) else { continue };
        // Keep the scene's own value unless another is faster with 95 % confidence.
        let stays = tight.iter().find(|point| point.setting == *own && !fastest.is_faster(point));
        let best = stays.unwrap_or(fastest);
        setting = setting.turned(series.parameter, &best.setting);
        let faster = good().filter(|(_, point)| leaks(point) > fewest && point.is_faster(best));
        passed_over.extend(faster.map(|(name, point)| {
            let rays = point.hits.map_or(0, |hits| hits.rays);
            format!("{} {name} is faster, but {} of {rays} rays leak", series.parameter.name(), leaks(point))
        }));
    }
    if let Some(best) = best_sampler(measured) {
        setting = setting.turned(Parameter::Sampler, &best.setting);
    }
    (setting, passed_over)
}

/// The sampler with the smallest error at the largest number of samples, if samplers were compared.
fn best_sampler(measured: &Measured) -> Option<&Point> {
    let samplers = measured.series.iter().filter(|series| series.parameter == Parameter::Sampler);
    let last = samplers.filter_map(|series| series.levels.last()).map(|(_, index)| &measured.points[*index]);
    // One sample in the centre is not compared with many elsewhere.
    let spreads = |point: &&Point| point.setting.quality.sampler != Sampler::Center;
    last.filter(spreads).min_by(|a, b| a.error().total_cmp(&b.error()))
}

fn names_of_chosen(measured: &Measured, setting: &Setting) -> Vec<(Parameter, String)> {
    let of_series = |series: &Series| {
        let is_same = |(_, index): &&(String, usize)| {
            let value = &measured.points[*index].setting;
            setting.turned(series.parameter, value) == *setting
        };
        let (level, _) = series.levels.iter().find(is_same)?;
        // Each sampler has a ladder, whose levels are numbers of samples.
        let name = if series.parameter == Parameter::Sampler { &series.name } else { level };
        Some((series.parameter, name.clone()))
    };
    measured.series.iter().filter(|series| is_chosen_once(series.parameter)).filter_map(of_series).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::scene_of_kit;
    use raykata::scene::Quality;
    use raykata::scene::TriangleMethod::{Cramer, Gram, Watertight};

    /// The measurements of a parameter whose values have these names and points.
    fn measured(parameter: Parameter, values: [&str; 3], points: Vec<Point>) -> Measured {
        let levels = values.map(str::to_owned).into_iter().zip(0..).collect();
        let series = vec![Series { parameter, name: parameter.name().into(), levels, base: 0 }];
        Measured { points, series, ..Measured::default() }
    }

    #[test]
    fn what_leaks_is_not_proposed_however_fast_it_is() {
        let scene = scene_of_kit("stage2");
        let own = Setting::of(&scene);
        let by =
            |triangle_method| Setting { quality: Quality { triangle_method, ..own.quality }, ..own.clone() };
        let points = vec![
            Point::made_up(by(Gram), 0.02, 1.0, 239),
            Point::made_up(by(Cramer), 0.02, 3.0, 106),
            Point::made_up(by(Watertight), 0.02, 2.0, 0),
        ];
        let measured = measured(Parameter::Intersection, ["gram", "cramer", "watertight"], points);
        let (best, passed_over) = with_what_is_best(&measured, &by(Gram));
        assert_eq!(best.quality.triangle_method, Watertight);
        assert_eq!(passed_over, ["triangle test gram is faster, but 239 of 1000 rays leak"]);
    }

    #[test]
    fn what_is_hardly_faster_is_not_worth_a_change() {
        let scene = scene_of_kit("stage2");
        let own = Setting::of(&scene);
        let with = |leaf_size| Setting { quality: Quality { leaf_size, ..own.quality }, ..own.clone() };
        let chosen = |fastest: f64, slowest: f64| {
            let mut points = vec![
                Point::made_up(with(2), 0.02, fastest, 0),
                Point::made_up(own.clone(), 0.02, 1.0, 0),
                Point::made_up(with(8), 0.02, 1.2, 0),
            ];
            // One round in six is slower than the scene's own value.
            points[0].times[5] = slowest;
            let measured = measured(Parameter::LeafSize, ["2", "4", "8"], points);
            with_what_is_best(&measured, &own).0.quality.leaf_size
        };
        assert_eq!((own.quality.leaf_size, chosen(0.7, 1.1), chosen(0.7, 0.9)), (4, 4, 2));
    }
}
