//! The best for your time: from the cheapest setting upwards, always by the step that buys the most.

use super::ladder::{Knob, Setting};
use super::measure::{Bench, Measured, Point};
use super::reference::Reference;
use crate::report::bar_of_steps;
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
    #[serde(skip)]
    pub setting: Setting,
}

/// Turns a knob of one setting to where another has it.
fn turned(to: &Setting, knob: Knob, setting: &Setting) -> Setting {
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
const AS_GOOD: f64 = 1.02;

/// How much of the budget is spent on purpose: frames differ by some percent from one to the next.
const SHARE: f64 = 0.95;

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
    let own = Setting::of(scene);
    let mut setting = own.clone();
    let (ladders, chosen): (Vec<_>, Vec<_>) = measured
        .series
        .iter()
        .filter(|series| !series.rungs.is_empty() && series.knob != Knob::Sampler)
        .partition(|series| !CHOSEN_ONCE.contains(&series.knob));
    for series in chosen {
        let points = || series.rungs.iter().map(|(_, index)| &measured.points[*index]);
        let least = points().map(Point::error).fold(f64::INFINITY, f64::min);
        let good = points().filter(|point| point.error() <= AS_GOOD * least);
        if let Some(best) = good.min_by(|a, b| a.seconds.total_cmp(&b.seconds)) {
            setting = turned(&best.setting, series.knob, &setting);
        }
    }
    if let Some(best) = best_sampler(measured) {
        setting = turned(&best.setting, Knob::Sampler, &setting);
    }
    // All others begin at the cheapest value.
    let mut at = vec![0; ladders.len()];
    for series in &ladders {
        setting = turned(&measured.points[series.rungs[0].1].setting, series.knob, &setting);
    }
    let turns_samples = ladders.iter().any(|series| series.knob == Knob::Samples);
    let bar = bar_of_steps(ladders.iter().map(|series| series.rungs.len()).sum());
    bar.set_message("looking for the best settings");
    let mut known: Vec<Point> = Vec::new();
    let Some(mut now) = point(bench, scene, &setting, right, &mut known)? else { return Ok(None) };
    let mut steps = Vec::new();
    let in_full = |point: &Point| point.seconds * full + point.build_seconds;
    let fits = |point: &Point| match goal {
        Goal::Seconds(budget) => in_full(point) <= SHARE * budget,
        Goal::Error(_) => true,
    };
    let reached = |point: &Point| matches!(goal, Goal::Error(target) if point.error() <= target);
    loop {
        if reached(&now) {
            break;
        }
        let mut best: Option<(f64, usize, usize, Point)> = None;
        for (index, series) in ladders.iter().enumerate() {
            // The next rung and the one after it: some knobs help only when they are turned far enough.
            for rung in (at[index] + 1..series.rungs.len()).take(2) {
                let to = &measured.points[series.rungs[rung].1].setting;
                let Some(candidate) =
                    point(bench, scene, &turned(to, series.knob, &setting), right, &mut known)?
                else {
                    if bench.stopped() {
                        return Ok(None);
                    }
                    continue;
                };
                let gain = (now.error() / candidate.error().max(1e-12)).ln();
                let cost = (candidate.seconds - now.seconds).max(0.01 * now.seconds);
                let worth = gain / cost;
                if fits(&candidate)
                    && candidate.error() * AS_GOOD < now.error()
                    && best.as_ref().is_none_or(|(most, ..)| worth > *most)
                {
                    best = Some((worth, index, rung, candidate));
                }
            }
        }
        let Some((_, index, rung, next)) = best else { break };
        at[index] = rung;
        setting = next.setting.clone();
        now = next;
        let (knob, to) = (ladders[index].knob, ladders[index].rungs[rung].0.clone());
        steps.push(Step { knob, to, error: now.error(), seconds: in_full(&now) });
        bar.inc(1);
    }
    if let Goal::Seconds(budget) = goal {
        // Rungs are a factor of two apart; what is left of the budget goes to as many samples as it pays for.
        let times = (SHARE * budget - now.build_seconds) / (now.seconds * full).max(1e-9);
        let samples = (f64::from(now.setting.quality.samples_per_pixel) * times) as u32;
        if turns_samples && samples > now.setting.quality.samples_per_pixel {
            let mut more = now.setting.clone();
            more.quality.samples_per_pixel = samples.min(65_536);
            if let Some(candidate) = point(bench, scene, &more, right, &mut known)?
                .filter(|more| fits(more) && more.error() < now.error())
            {
                let (knob, to) = (Knob::Samples, more.quality.samples_per_pixel.to_string());
                steps.push(Step { knob, to, error: candidate.error(), seconds: in_full(&candidate) });
                (setting, now) = (more, candidate);
            }
        }
    }
    let mut left = Vec::new();
    for (index, series) in ladders.iter().enumerate() {
        let Some((_, next)) = series.rungs.get(at[index] + 1) else { continue };
        let more = turned(&measured.points[*next].setting, series.knob, &setting);
        // Samples may have been turned to between two rungs, or to the next.
        if more.quality.samples_per_pixel < setting.quality.samples_per_pixel || more == setting {
            continue;
        }
        if let Some(more) = point(bench, scene, &more, right, &mut known)? {
            left.push(Left {
                knob: series.knob,
                at: series.rungs[at[index]].0.clone(),
                time_factor: more.seconds / now.seconds.max(1e-9),
                error_factor: more.error() / now.error().max(1e-12),
            });
        }
    }
    let mut values: Vec<(Knob, String)> =
        ladders.iter().zip(&at).map(|(series, &rung)| (series.knob, series.rungs[rung].0.clone())).collect();
    for (_, value) in values.iter_mut().filter(|(knob, _)| *knob == Knob::Samples) {
        *value = setting.quality.samples_per_pixel.to_string();
    }
    values.extend(names_of_chosen(measured, &setting));
    let Some(own) = point(bench, scene, &own, right, &mut known)? else { return Ok(None) };
    bar.finish_and_clear();
    Ok(Some(Advice {
        goal,
        values,
        steps,
        left,
        own_error: own.error(),
        own_seconds: in_full(&own),
        expected_error: now.error(),
        expected_seconds: in_full(&now),
        verified_error: None,
        verified_seconds: None,
        setting,
    }))
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
    let frame = others.frame(&advice.setting.apply(full), others.seed, false)?;
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
    let of_series = |series: &super::measure::Series| {
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
    let chosen = |knob: Knob| CHOSEN_ONCE.contains(&knob) || knob == Knob::Sampler;
    measured.series.iter().filter(|series| chosen(series.knob)).filter_map(of_series).collect()
}

/// Measured once, however often it is asked for.
fn point(
    bench: &Bench<'_>,
    scene: &Scene,
    setting: &Setting,
    right: &Reference,
    known: &mut Vec<Point>,
) -> Result<Option<Point>> {
    if let Some(point) = known.iter().find(|point| point.setting == *setting) {
        return Ok(Some(point.clone()));
    }
    let point = bench.point(scene, setting, right, false)?;
    known.extend(point.clone());
    Ok(point)
}
