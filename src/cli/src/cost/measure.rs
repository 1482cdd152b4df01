//! Measures errors and counts, which are exact, and times, which vary and are therefore measured in turn.

use super::error::errors;
use super::kept::KeptPictures;
use super::ladder::Ladder;
use super::measured::{Measured, Point, Reference, Series};
use super::setting::Setting;
use crate::report::{FrameBar, bar_of_steps, job, quartiles};
use anyhow::Result;
use raykata::frame::Watch;
use raykata::kit::{Kit, RenderJob, Rendering, kit_error};
use raykata::scene::Scene;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// The longest time for a small picture. One that takes longer is left out, because in all rounds together it
/// would take minutes. Settings that are known to be slow are left out by their number of primitives
/// (`ladder`); this limit is for code that is slower than expected.
const PATIENCE: Duration = Duration::from_secs(60);

/// The kit that is measured, and how.
pub struct Bench<'a> {
    pub kit: &'a dyn Kit,
    pub rounds: u32,
    pub threads: usize,
    /// The seed of the first round; each round has another one.
    pub seed: u64,
    /// Set when the program is being stopped.
    pub stop: &'a AtomicBool,
    /// The pictures that a stopped run has measured, and where this run keeps its own.
    pub kept: Option<&'a KeptPictures>,
}

/// Cancels a frame that takes too long or is no longer wanted, and shows its progress.
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

    /// Renders a picture without a time limit; `None` if the program is being stopped.
    pub fn frame(&self, scene: &Scene, seed: u64, count: bool) -> Result<Option<Rendering>> {
        self.render(&self.job(scene, seed, count), None, None)
    }

    pub fn job(&self, scene: &Scene, seed: u64, count: bool) -> RenderJob {
        RenderJob { seed, threads: self.threads, count, ..job(scene.clone()) }
    }

    /// The same with a deadline, and with a progress bar.
    pub fn render(
        &self,
        job: &RenderJob,
        until: Option<Instant>,
        bar: Option<&FrameBar>,
    ) -> Result<Option<Rendering>> {
        let name = match self.kept {
            Some(kept) => Some((kept, kept.name(job)?)),
            None => None,
        };
        if let Some(known) = name.as_ref().and_then(|(kept, name)| kept.take(name)) {
            return Ok(Some(known));
        }
        let frame = kit_error::catch(|| self.kit.render(job, &Patience { stop: self.stop, until, bar }))?;
        if let (Some((kept, name)), Some(frame)) = (name, &frame) {
            kept.add(&name, frame)?;
        }
        Ok(frame)
    }

    /// Measures one setting: errors, one time, and counts if `count` is set, which takes longer. `None` if it
    /// takes too long.
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
            biases: vec![(errors.bias, errors.bias_error)],
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

    /// Measures all ladders: each setting once with counts, then all in turn, with other random numbers in
    /// each round.
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
                        "{} {name}: a small picture takes longer than {} s",
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
                // A frame is `None` only if the program is being stopped; then this round is incomplete and
                // not counted.
                let Some(frame) = self.frame(&point.setting.apply(scene), seed, false)? else { break };
                point.times.push(frame.render_seconds);
                if round > 0 {
                    let errors = errors(&frame.film, &right.film)?;
                    point.rmse.push(errors.rmse);
                    point.biases.push((errors.bias, errors.bias_error));
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
            // The times of an incomplete round are used for the points that have one.
            if !point.times.is_empty() {
                let [low, median, high] = quartiles(std::mem::take(&mut point.times));
                (point.seconds, point.spread) = (median, (high - low) / 2.0);
            }
            point.rmse.truncate(measured.rounds.max(1) as usize);
            point.biases.truncate(measured.rounds.max(1) as usize);
        }
        Ok(measured)
    }
}

/// The factor above which two errors count as equal, because they differ by rounding only.
const DIFFERENT: f64 = 0.999;

/// The Pareto front, from the fastest to the most accurate point: no other point is both faster and more
/// accurate. Settings that let rays through closed surfaces are left out, because the error of a picture
/// hardly shows a leak.
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
        let scene = crate::report::scene_of_kit("stage1");
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
