//! The best for your time: from the cheapest setting upwards, always by the step that buys the most.

use super::climb::{Climb, Tried};
use super::ladder::{Knob, Setting};
use super::measure::{Bench, Measured, Point, Series};
use super::reference::Reference;
use crate::report::FrameBar;
use anyhow::Result;
use raykata::scene::Scene;
use serde::Serialize;

/// What is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Goal {
    /// The least error for so many seconds.
    Seconds(f64),
    /// The least time for no more error than this.
    Error(f64),
}

/// One knob, turned by one rung.
#[derive(Clone, Debug, Serialize)]
pub struct Step {
    pub knob: Knob,
    pub to: String,
    pub error: f64,
    /// Of a picture of the full size.
    pub seconds: f64,
}

/// A knob that stays where it is, and what one more rung of it would do.
#[derive(Clone, Debug, Serialize)]
pub struct Left {
    pub knob: Knob,
    /// Where it stays.
    pub at: String,
    /// How much time, and how much error, one more rung would take: 1.5 for half as much again.
    pub time_factor: f64,
    pub error_factor: f64,
}

/// Settings for a goal, and the way to them.
#[derive(Clone, Debug, Serialize)]
pub struct Advice {
    pub goal: Goal,
    /// The values of all knobs that this is about.
    pub values: Vec<(Knob, String)>,
    pub steps: Vec<Step>,
    pub left: Vec<Left>,
    /// What the scene's own settings come to.
    pub own_error: f64,
    pub own_seconds: f64,
    /// What is expected of the proposal, and what came of it when it was rendered in full size.
    pub expected_error: f64,
    pub expected_seconds: f64,
    pub verified_error: Option<f64>,
    pub verified_seconds: Option<f64>,
    /// How to render what is proposed.
    pub command: String,
    #[serde(skip)]
    pub setting: Setting,
}

/// Turns a knob of one setting to where another has it.
pub fn turned(to: &Setting, knob: Knob, setting: &Setting) -> Setting {
    let (from, mut turned) = (&to.quality, setting.clone());
    let quality = &mut turned.quality;
    match knob {
        Knob::Samples => quality.samples_per_pixel = from.samples_per_pixel,
        Knob::Sampler => quality.sampler = from.sampler,
        Knob::LightSamples => quality.light_samples = from.light_samples,
        Knob::GlossSamples => quality.gloss_samples = from.gloss_samples,
        Knob::Depth => quality.max_depth = from.max_depth,
        Knob::MinContribution => quality.min_contribution = from.min_contribution,
        Knob::SmoothNormals => turned.smooth = to.smooth,
        Knob::Intersection => quality.triangle_method = from.triangle_method,
        Knob::Precision => quality.precision = from.precision,
        Knob::Accelerator => quality.accelerator = from.accelerator,
        Knob::Split => quality.split = from.split,
        Knob::LeafSize => quality.leaf_size = from.leaf_size,
        Knob::GridResolution => quality.grid_resolution = from.grid_resolution,
    }
    turned
}

/// How far the error of a setting may lie above that of another and still count as the same.
pub const AS_GOOD: f64 = 1.02;

/// Knobs of which one value is best whatever the others are: the fastest of those that are as accurate.
const CHOSEN_ONCE: [Knob; 6] = [
    Knob::Accelerator,
    Knob::Split,
    Knob::LeafSize,
    Knob::GridResolution,
    Knob::Intersection,
    Knob::Precision,
];

/// Proposes settings. `full` is how many times as many pixels the picture has in full size.
pub fn advise(
    bench: &Bench<'_>,
    scene: &Scene,
    measured: &Measured,
    right: &Reference,
    goal: Goal,
    full: f64,
) -> Result<Option<Advice>> {
    let mut tried = Tried { bench, scene, right, known: Vec::new() };
    let start = with_what_is_best(measured, &Setting::of(scene));
    let turned_by_steps: Vec<&Series> = measured
        .series
        .iter()
        .filter(|series| !series.rungs.is_empty() && !is_chosen_once(series.knob))
        .collect();
    let Some(mut climb) = Climb::new(&mut tried, measured, turned_by_steps, start, goal, full)? else {
        return Ok(None);
    };
    if !climb.go_up()? {
        return Ok(None);
    }
    climb.spend_the_rest()?;
    let left = climb.one_step_more()?;
    let values = [climb.values(), names_of_chosen(measured, &climb.now.setting)].concat();
    let (now, steps) = (climb.now, climb.steps);
    let Some(own) = tried.point(&Setting::of(scene))? else { return Ok(None) };
    Ok(Some(Advice {
        goal,
        values,
        steps,
        left,
        own_error: own.error(),
        own_seconds: seconds_in_full(&own, full),
        expected_error: now.error(),
        expected_seconds: seconds_in_full(&now, full),
        verified_error: None,
        verified_seconds: None,
        command: String::new(),
        setting: now.setting,
    }))
}

/// Seconds of a picture with so many times as many pixels; what is built is the same.
pub fn seconds_in_full(point: &Point, full: f64) -> f64 {
    point.seconds * full + point.build_seconds
}

fn is_chosen_once(knob: Knob) -> bool {
    CHOSEN_ONCE.contains(&knob) || knob == Knob::Sampler
}

/// The setting with every knob that is chosen once at its best value.
fn with_what_is_best(measured: &Measured, own: &Setting) -> Setting {
    let mut setting = own.clone();
    for series in measured.series.iter().filter(|series| CHOSEN_ONCE.contains(&series.knob)) {
        let points = || series.rungs.iter().map(|(_, index)| &measured.points[*index]);
        let least = points().map(Point::error).fold(f64::INFINITY, f64::min);
        let good = points().filter(|point| point.error() <= AS_GOOD * least);
        if let Some(best) = good.min_by(|a, b| a.seconds.total_cmp(&b.seconds)) {
            setting = turned(&best.setting, series.knob, &setting);
        }
    }
    match best_sampler(measured) {
        Some(best) => turned(&best.setting, Knob::Sampler, &setting),
        None => setting,
    }
}

/// Renders the proposal in full size, with other random numbers, and its error in the small size.
pub fn verify(
    bench: &Bench<'_>,
    small: &Scene,
    full: &Scene,
    right: &Reference,
    advice: &mut Advice,
) -> Result<()> {
    let others = Bench { seed: bench.seed + (1 << 20), ..*bench };
    advice.verified_error = others.point(small, &advice.setting, right, false)?.map(|point| point.error());
    let bar = FrameBar::new("the proposal, in full size");
    let job = others.job(&advice.setting.apply(full), others.seed, false);
    let frame = others.render(&job, None, Some(&bar))?;
    bar.finish();
    advice.verified_seconds = frame.map(|frame| frame.build_seconds + frame.render_seconds);
    Ok(())
}

/// The sampler with the least error at the most samples, if they were compared.
fn best_sampler(measured: &Measured) -> Option<&Point> {
    let samplers = measured.series.iter().filter(|series| series.knob == Knob::Sampler);
    let last = samplers.filter_map(|series| series.rungs.last()).map(|(_, index)| &measured.points[*index]);
    last.min_by(|a, b| a.error().total_cmp(&b.error()))
}

fn names_of_chosen(measured: &Measured, setting: &Setting) -> Vec<(Knob, String)> {
    let of_series = |series: &Series| {
        let is_same = |index: &usize| {
            let value = &measured.points[*index].setting;
            turned(value, series.knob, setting) == *setting
        };
        let name = match series.knob {
            Knob::Sampler => {
                series.rungs.first().filter(|(_, index)| is_same(index)).map(|_| series.name.clone())
            }
            _ => series.rungs.iter().find(|(_, index)| is_same(index)).map(|(name, _)| name.clone()),
        };
        Some((series.knob, name?))
    };
    measured.series.iter().filter(|series| is_chosen_once(series.knob)).filter_map(of_series).collect()
}
