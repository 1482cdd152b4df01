//! Measuring: errors and counts, which do not wobble, and times by turns, which do.

use super::error::{Errors, errors};
use super::hits::Verdicts;
use super::ladder::{Ladder, Parameter};
use super::reference::Reference;
use super::setting::Setting;
use crate::report::{FrameBar, bar_of_steps, quartiles};
use anyhow::Result;
use raykata::count::Counts;
use raykata::film::Film;
use raykata::frame::Watch;
use raykata::kit::{Kit, RenderJob, Rendering, View, kit_error};
use raykata::scene::Scene;
use serde::Serialize;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A small picture that takes longer is left out: in all rounds together it would take minutes. What is known to be dear is
/// left out by numbers that no clock knows (`ladder`); this is for code that is slower than anybody expects.
const PATIENCE: Duration = Duration::from_secs(60);

/// Who is measured, and how.
pub struct Bench<'a> {
    pub kit: &'a dyn Kit,
    pub rounds: u32,
    pub threads: usize,
    /// Picks the random numbers of the first round; each round has others.
    pub seed: u64,
    /// Set once nobody wants to go on.
    pub stop: &'a AtomicBool,
}

/// A setting, measured.
#[derive(Clone, Debug, Serialize)]
pub struct Point {
    #[serde(skip)]
    pub setting: Setting,
    /// Of the first round.
    pub errors: Errors,
    /// Root mean square error of each round.
    pub rmse: Vec<f64>,
    pub counts: Counts,
    /// What the oracle says of the hits, for parameters that decide only how they are found.
    pub hits: Option<Verdicts>,
    /// Seconds for the pixels, the median over all rounds.
    pub seconds: f64,
    /// Seconds to build what finds hits.
    pub build_seconds: f64,
    /// Half the distance between the quartiles of those seconds for the pixels.
    pub spread: f64,
    /// Of the first round.
    #[serde(skip)]
    pub film: Film,
    #[serde(skip)]
    times: Vec<f64>,
    #[serde(skip)]
    notes: Vec<String>,
}

impl Point {
    /// The mean over all rounds.
    pub fn error(&self) -> f64 {
        self.rmse.iter().sum::<f64>() / self.rmse.len().max(1) as f64
    }

    /// One that nobody has measured.
    #[cfg(test)]
    pub fn made_up(setting: Setting, error: f64, seconds: f64, leaks: u64) -> Point {
        Point {
            setting,
            errors: Errors { rmse: error, relative_mse: 0.0, similarity: 1.0, not_a_number: 0 },
            rmse: vec![error],
            counts: Counts::default(),
            hits: Some(Verdicts { rays: 1000, wrong: leaks, leaks }),
            seconds,
            build_seconds: 0.0,
            spread: 0.0,
            film: Film { width: 0, height: 0, pixels: Vec::new() },
            times: Vec::new(),
            notes: Vec::new(),
        }
    }
}

/// A ladder, measured: its levels that could be.
#[derive(Clone, Debug, Serialize)]
pub struct Series {
    pub parameter: Parameter,
    pub name: String,
    /// What each value is called, and its place among the points.
    pub levels: Vec<(String, usize)>,
}

/// What came of it.
#[derive(Default, Serialize)]
pub struct Measured {
    pub points: Vec<Point>,
    pub series: Vec<Series>,
    /// Values that were left out, and why.
    pub left_out: Vec<String>,
    /// What pictures lack, because it is not written yet, one sentence each.
    pub lacking: Vec<String>,
    /// How many rounds there were.
    pub rounds: u32,
}

/// Ends a frame that takes too long, or that nobody wants, and shows how far it is.
struct Patience<'a> {
    stop: &'a AtomicBool,
    until: Option<Instant>,
    bar: Option<&'a FrameBar>,
}

impl Watch for Patience<'_> {
    fn progress(&self, done: u64, total: u64) {
        if let Some(bar) = self.bar {
            bar.progress(done, total);
        }
    }

    fn building(&self, placed: u64, total: u64) {
        if let Some(bar) = self.bar {
            bar.building(placed, total);
        }
    }

    fn cancelled(&self) -> bool {
        self.stop.load(Ordering::Relaxed) || self.until.is_some_and(|until| Instant::now() > until)
    }
}

impl Bench<'_> {
    pub fn stopped(&self) -> bool {
        self.stop.load(Ordering::Relaxed)
    }

    /// A picture, however long it takes; `None` if nobody wants it any more.
    pub fn frame(&self, scene: &Scene, seed: u64, count: bool) -> Result<Option<Rendering>> {
        self.render(&self.job(scene, seed, count), None, None)
    }

    pub fn job(&self, scene: &Scene, seed: u64, count: bool) -> RenderJob {
        RenderJob { scene: scene.clone(), view: View::Shaded, seed, threads: self.threads, count }
    }

    /// The same, until some moment, and with a bar for whoever waits.
    pub fn render(
        &self,
        job: &RenderJob,
        until: Option<Instant>,
        bar: Option<&FrameBar>,
    ) -> Result<Option<Rendering>> {
        Ok(kit_error::catch(|| self.kit.render(job, &Patience { stop: self.stop, until, bar }))?)
    }

    /// Measures one setting without regard to others: errors, one time, and counts, if it is to count, which takes time.
    /// `None` if it takes too long.
    pub fn point(
        &self,
        scene: &Scene,
        setting: &Setting,
        right: &Reference,
        count: bool,
    ) -> Result<Option<Point>> {
        let until = Some(Instant::now() + PATIENCE);
        let job = self.job(&setting.apply(scene), self.seed, count);
        let Some(frame) = self.render(&job, until, None)? else {
            return Ok(None);
        };
        let errors = errors(&frame.film, &right.film)?;
        Ok(Some(Point {
            setting: setting.clone(),
            rmse: vec![errors.rmse],
            errors,
            counts: frame.counts,
            hits: None,
            seconds: frame.render_seconds,
            build_seconds: frame.build_seconds,
            spread: 0.0,
            film: frame.film,
            times: Vec::new(),
            notes: frame.notes,
        }))
    }

    /// Measures all ladders: each setting once with counts, then all by turns, with other random numbers each round.
    pub fn measure(&self, scene: &Scene, ladders: Vec<Ladder>, right: &Reference) -> Result<Measured> {
        let n_levels: usize = ladders.iter().map(|ladder| ladder.levels.len()).sum();
        let bar = bar_of_steps(n_levels * (1 + self.rounds as usize));
        let mut measured = Measured::default();
        for ladder in ladders {
            bar.set_message(format!("{}: counting", ladder.name));
            let mut levels = Vec::new();
            for (name, setting) in ladder.levels {
                let known = measured.points.iter().position(|point| point.setting == setting);
                let point = match known {
                    Some(_) => None,
                    None => self.point(scene, &setting, right, true)?,
                };
                match (known, point) {
                    (Some(known), _) => levels.push((name, known)),
                    (None, Some(point)) => {
                        for note in &point.notes {
                            if !measured.lacking.contains(note) {
                                measured.lacking.push(note.clone());
                            }
                        }
                        levels.push((name, measured.points.len()));
                        measured.points.push(point);
                    }
                    (None, None) if self.stopped() => {}
                    (None, None) => measured.left_out.push(format!(
                        "{} {name}: a small picture takes more than {} s",
                        ladder.name,
                        PATIENCE.as_secs()
                    )),
                }
                bar.inc(1);
            }
            measured.left_out.extend(ladder.left_out);
            measured.series.push(Series { parameter: ladder.parameter, name: ladder.name, levels });
        }
        bar.set_length((n_levels + measured.points.len() * self.rounds as usize) as u64);
        for round in 0..self.rounds {
            bar.set_message(format!("times, round {} of {}", round + 1, self.rounds));
            for point in &mut measured.points {
                let seed = self.seed + u64::from(round);
                // Only who is stopped gives up here, so either all points have this round or it does not count.
                let Some(frame) = self.frame(&point.setting.apply(scene), seed, false)? else { break };
                point.times.push(frame.render_seconds);
                if round > 0 {
                    point.rmse.push(errors(&frame.film, &right.film)?.rmse);
                }
                bar.inc(1);
            }
            if self.stopped() {
                break;
            }
            measured.rounds += 1;
        }
        bar.finish_and_clear();
        for point in &mut measured.points {
            // A round that was broken off counts for those that it came to.
            if !point.times.is_empty() {
                let [low, median, high] = quartiles(std::mem::take(&mut point.times));
                (point.seconds, point.spread) = (median, (high - low) / 2.0);
            }
            point.rmse.truncate(measured.rounds.max(1) as usize);
        }
        Ok(measured)
    }
}

/// A smaller difference between errors is one of rounding, not of accuracy.
const DIFFERENT: f64 = 0.999;

/// The points that no other beats in both error and time, from the fastest to the most accurate. What lets rays through
/// closed surfaces is not among them, for the error of a picture hardly shows it.
pub fn pareto_front(points: &[Point]) -> Vec<usize> {
    let leaks = |point: &Point| point.hits.map(|hits| hits.leaks);
    let fewest = points.iter().filter_map(leaks).min();
    let is_tight = |index: &usize| leaks(&points[*index]).is_none_or(|leaks| Some(leaks) == fewest);
    let mut order: Vec<usize> = (0..points.len()).filter(is_tight).collect();
    order.sort_by(|&a, &b| {
        let (a, b) = (&points[a], &points[b]);
        a.seconds.total_cmp(&b.seconds).then(a.error().total_cmp(&b.error()))
    });
    let mut least = f64::INFINITY;
    order.retain(|&index| {
        let error = points[index].error();
        let better = error < DIFFERENT * least;
        least = least.min(error);
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_holds_what_nothing_beats_and_nothing_that_leaks() {
        let scene = crate::report::load_scene(std::path::Path::new("../../scenes/stage1.toml")).unwrap();
        let point = |error, seconds, leaks| Point::made_up(Setting::of(&scene), error, seconds, leaks);
        let points = [
            point(0.1, 1.0, 0),
            point(0.05, 0.5, 7),    // leaks
            point(0.09999, 1.5, 0), // hardly more accurate
            point(0.02, 4.0, 0),
            point(0.03, 5.0, 0), // slower and less accurate
        ];
        assert_eq!(pareto_front(&points), [0, 3]);
    }
}
