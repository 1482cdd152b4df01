//! The best settings for a time or an error, by greedy search: from the cheapest setting, always the step
//! that lowers the error most for its time.

use super::goal::{AS_GOOD, Goal, Left, Step, seconds_in_full};
use super::greedy::{GreedySearch, Tried};
use super::measure::Bench;
use super::measured::{Measured, Point, Reference, Series};
use super::parameter::Parameter;
use super::setting::Setting;
use crate::report::FrameBar;
use anyhow::Result;
use raykata::scene::Scene;
use serde::Serialize;

/// The proposed settings for a goal, and the steps of the search.
#[derive(Clone, Debug, Serialize)]
pub struct Advice {
    pub goal: Goal,
    /// The proposed values of the parameters.
    pub values: Vec<(Parameter, String)>,
    pub steps: Vec<Step>,
    pub left: Vec<Left>,
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
const CHOSEN_ONCE: [Parameter; 7] = [
    Parameter::Accelerator,
    Parameter::Split,
    Parameter::LeafSize,
    Parameter::GridResolution,
    Parameter::Intersection,
    Parameter::SphereTest,
    Parameter::Precision,
];

/// Proposes settings. `full` is the number of pixels in full size divided by that of the measured picture.
pub fn advise(
    bench: &Bench<'_>,
    scene: &Scene,
    measured: &Measured,
    right: &Reference,
    goal: Goal,
    full: f64,
) -> Result<Option<Advice>> {
    // Choose the parameters whose best value does not depend on the others.
    let mut tried = Tried { bench, scene, right, known: Vec::new() };
    let (start, passed_over) = with_what_is_best(measured, &Setting::of(scene));
    // Search the values of the other parameters.
    let turned_by_steps: Vec<&Series> = measured
        .series
        .iter()
        .filter(|series| !series.levels.is_empty() && !is_chosen_once(series.parameter))
        .collect();
    let Some(mut search) = GreedySearch::new(&mut tried, measured, turned_by_steps, start, goal, full)?
    else {
        return Ok(None);
    };
    if !search.go_up()? {
        return Ok(None);
    }
    // Spend the rest of the budget, and measure one more step of each parameter.
    search.spend_the_rest()?;
    let left = search.one_step_more()?;
    let values = [search.values(), names_of_chosen(measured, &search.now.setting)].concat();
    let (now, steps) = (search.now, search.steps);
    // Compare with the scene's own settings.
    let Some(own) = tried.point(&Setting::of(scene))? else { return Ok(None) };
    Ok(Some(Advice {
        goal,
        values,
        steps,
        left,
        passed_over,
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

fn is_chosen_once(parameter: Parameter) -> bool {
    CHOSEN_ONCE.contains(&parameter) || parameter == Parameter::Sampler
}

/// Whether `one` is faster than `other` by more than the spread of their times.
fn is_faster(one: &Point, other: &Point) -> bool {
    one.seconds + one.spread + other.spread < other.seconds
}

/// The setting with the best value of every parameter that is chosen once, and a sentence for each faster
/// value that leaks.
fn with_what_is_best(measured: &Measured, own: &Setting) -> (Setting, Vec<String>) {
    let (mut setting, mut passed_over) = (own.clone(), Vec::new());
    let leaks = |point: &Point| point.hits.map_or(0, |hits| hits.leaks);
    for series in measured.series.iter().filter(|series| CHOSEN_ONCE.contains(&series.parameter)) {
        let levels = || series.levels.iter().map(|(name, index)| (name, &measured.points[*index]));
        let least = levels().map(|(_, point)| point.error()).fold(f64::INFINITY, f64::min);
        let good = || levels().filter(|(_, point)| point.error() <= AS_GOOD * least);
        // Leave out values that leak: this picture may not show it, but another scene may.
        let fewest = good().map(|(_, point)| leaks(point)).min().unwrap_or_default();
        let tight = good().filter(|(_, point)| leaks(point) == fewest);
        let tight: Vec<_> = tight.map(|(_, point)| point).collect();
        let Some(fastest) = tight.iter().min_by(|a, b| a.seconds.total_cmp(&b.seconds)) else { continue };
        // Keep the scene's own value unless another is faster by more than the spread of the times.
        let stays = tight.iter().find(|point| point.setting == *own && !is_faster(fastest, point));
        let best = stays.unwrap_or(fastest);
        setting = setting.turned(series.parameter, &best.setting);
        let faster = good().filter(|(_, point)| leaks(point) > fewest && is_faster(point, best));
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

/// Renders the proposal in full size with other random numbers, and measures its error in the small size.
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

/// The sampler with the smallest error at the largest number of samples, if samplers were compared.
fn best_sampler(measured: &Measured) -> Option<&Point> {
    let samplers = measured.series.iter().filter(|series| series.parameter == Parameter::Sampler);
    let last = samplers.filter_map(|series| series.levels.last()).map(|(_, index)| &measured.points[*index]);
    last.min_by(|a, b| a.error().total_cmp(&b.error()))
}

fn names_of_chosen(measured: &Measured, setting: &Setting) -> Vec<(Parameter, String)> {
    let of_series = |series: &Series| {
        let is_same = |index: &usize| {
            let value = &measured.points[*index].setting;
            setting.turned(series.parameter, value) == *setting
        };
        let name = match series.parameter {
            Parameter::Sampler => {
                series.levels.first().filter(|(_, index)| is_same(index)).map(|_| series.name.clone())
            }
            _ => series.levels.iter().find(|(_, index)| is_same(index)).map(|(name, _)| name.clone()),
        };
        Some((series.parameter, name?))
    };
    measured.series.iter().filter(|series| is_chosen_once(series.parameter)).filter_map(of_series).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use raykata::scene::Quality;
    use raykata::scene::TriangleMethod::{Cramer, Gram, Watertight};

    #[test]
    fn what_leaks_is_not_proposed_however_fast_it_is() {
        let scene =
            crate::report::load_scene(std::path::Path::new("../../scenes/stage2.toml"), Default::default())
                .unwrap();
        let own = Setting::of(&scene);
        let by =
            |triangle_method| Setting { quality: Quality { triangle_method, ..own.quality }, ..own.clone() };
        let points = vec![
            Point::made_up(by(Gram), 0.02, 1.0, 239),
            Point::made_up(by(Cramer), 0.02, 3.0, 106),
            Point::made_up(by(Watertight), 0.02, 2.0, 0),
        ];
        let levels = ["gram", "cramer", "watertight"].map(str::to_owned).into_iter().zip(0..).collect();
        let series = vec![Series { parameter: Parameter::Intersection, name: "intersection".into(), levels }];
        let measured = Measured { points, series, ..Measured::default() };
        let (best, passed_over) = with_what_is_best(&measured, &by(Gram));
        assert_eq!(best.quality.triangle_method, Watertight);
        assert_eq!(passed_over, ["intersection gram is faster, but 239 of 1000 rays leak"]);
    }

    #[test]
    fn what_is_hardly_faster_is_not_worth_a_change() {
        let scene =
            crate::report::load_scene(std::path::Path::new("../../scenes/stage2.toml"), Default::default())
                .unwrap();
        let own = Setting::of(&scene);
        let with = |leaf_size| Setting { quality: Quality { leaf_size, ..own.quality }, ..own.clone() };
        let chosen = |fastest: f64| {
            let mut points = vec![
                Point::made_up(with(2), 0.02, fastest, 0),
                Point::made_up(own.clone(), 0.02, 1.0, 0),
                Point::made_up(with(8), 0.02, 1.2, 0),
            ];
            points.iter_mut().for_each(|point| point.spread = 0.1);
            let levels = ["2", "4", "8"].map(str::to_owned).into_iter().zip(0..).collect();
            let series = vec![Series { parameter: Parameter::LeafSize, name: "leaf size".into(), levels }];
            with_what_is_best(&Measured { points, series, ..Measured::default() }, &own).0.quality.leaf_size
        };
        assert_eq!((own.quality.leaf_size, chosen(0.9), chosen(0.7)), (4, 4, 2));
    }
}
