//! Measures errors and counts, which are exact, and times, which vary and are therefore measured in turn.

use super::error::errors;
use super::kept::KeptPictures;
use super::ladder::Ladder;
use super::measured::{Measured, Point, Reference, Series};
use super::setting::Setting;
use crate::race::statistics::Median;
use crate::report::{bar_of_steps, job};
use anyhow::Result;
use raykata::frame::{Unwatched, Watch};
use raykata::kit::{Kit, RenderJob, Rendering, kit_error};
use raykata::scene::Scene;
use std::cmp::Ordering;
use std::sync::atomic::{AtomicBool, Ordering::Relaxed};
use std::time::{Duration, Instant};

/// The longest time for a small picture. One that takes longer is left out, because in all rounds together it
/// would take minutes. Settings that are known to be slow are left out by their number of primitives
/// (`ladder`); this limit is for code that is slower than expected.
const PATIENCE: Duration = Duration::from_secs(60);

/// The kit that is measured, and how.
#[derive(Clone, Copy)]
pub struct Bench<'a> {
    pub kit: &'a dyn Kit,
    /// The reference, if it is measured beside the kit.
    pub reference: Option<&'a dyn Kit>,
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
    bar: &'a dyn Watch,
}

impl Watch for Patience<'_> {
    fn progress(&self, done: u64, total: u64) {
        self.bar.progress(done, total);
    }

    fn building(&self, placed: u64, total: u64) {
        self.bar.building(placed, total);
    }

    fn cancelled(&self) -> bool {
        self.stop.load(Relaxed) || self.until.is_some_and(|until| Instant::now() > until)
    }
}

impl Bench<'_> {
    pub fn stopped(&self) -> bool {
        self.stop.load(Relaxed)
    }

    /// The same with the reference as the kit, which is always the source of converged pictures.
    pub fn of_reference(&self) -> Bench<'_> {
        Bench { kit: self.reference.unwrap_or(self.kit), ..*self }
    }

    /// Renders a picture on one thread without a time limit, and returns its processor time, or the elapsed time where the
    /// operating system does not say that. `None` if the program is being stopped.
    pub fn timed(&self, scene: &Scene, seed: u64) -> Result<Option<(Rendering, f64)>> {
        let job = RenderJob { threads: 1, ..self.job(scene, seed, false) };
        let frame = self.render(&job, None, &Unwatched)?;
        Ok(frame.map(|frame| {
            let seconds = frame.processor_seconds.unwrap_or(frame.render_seconds);
            (frame, seconds)
        }))
    }

    pub fn job(&self, scene: &Scene, seed: u64, count: bool) -> RenderJob {
        RenderJob { seed, threads: self.threads, count, ..job(scene.clone()) }
    }

    /// Renders a picture, with a deadline and a progress bar; `None` if it takes too long or the program is being stopped.
    pub fn render(
        &self,
        job: &RenderJob,
        until: Option<Instant>,
        bar: &dyn Watch,
    ) -> Result<Option<Rendering>> {
        let name = match self.kept {
            Some(kept) => {
                let is_reference =
                    self.reference.is_some_and(|reference| std::ptr::addr_eq(reference, self.kit));
                Some((kept, kept.name(job, is_reference)?))
            }
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

    /// Measures one setting: errors, elapsed time, and counts if `count` is set, which takes longer. `None` if it
    /// takes too long. The reference is measured beside it if there is one and counts are wanted.
    pub fn point(
        &self,
        scene: &Scene,
        setting: &Setting,
        right: &Reference,
        count: bool,
    ) -> Result<Option<Point>> {
        let until = Some(Instant::now() + PATIENCE);
        let job = self.job(&setting.apply(scene), self.seed, count);
        let Some(frame) = self.render(&job, until, &Unwatched)? else { return Ok(None) };
        let errors = errors(&frame.film, &right.film)?;
        let reference = match self.reference {
            Some(reference) if count => {
                let alone = Bench { kit: reference, ..*self };
                // Without a count the reference of the reference is not measured; its counts are not shown.
                alone.point(scene, setting, right, false)?.map(Box::new)
            }
            _ => None,
        };
        Ok(Some(Point {
            setting: setting.clone(),
            rmse: vec![errors.rmse],
            biases: vec![(errors.bias, errors.bias_error)],
            errors,
            counts: frame.counts,
            hits: None,
            seconds: frame.render_seconds,
            times: Vec::new(),
            build_seconds: frame.build_seconds,
            reference,
            film: frame.film,
            accelerator: frame.accelerator,
            notes: frame.notes,
        }))
    }

    /// Measures all ladders: each setting once with counts, then all in turn, with other random numbers in
    /// each round. `own_notes` says what the picture of the scene's own setting lacks. A level that lacks more is left out, because
    /// it would compare something else under its name.
    pub fn measure(
        &self,
        scene: &Scene,
        ladders: Vec<Ladder>,
        right: &Reference,
        own_notes: &[String],
    ) -> Result<Measured> {
        let n_levels: usize = ladders.iter().map(|ladder| ladder.levels.len()).sum();
        let bar = bar_of_steps(n_levels * (1 + self.rounds as usize));
        let mut measured =
            Measured { processor_time: true, lacking: own_notes.to_vec(), ..Measured::default() };
        for ladder in ladders {
            bar.set_message(format!("{}: counting", ladder.name));
            let mut levels = Vec::new();
            for (name, setting) in ladder.levels {
                bar.inc(1);
                if let Some(known) = measured.points.iter().position(|point| point.setting == setting) {
                    levels.push((name, known));
                    continue;
                }
                let point = self.point(scene, &setting, right, true)?;
                let why = match &point {
                    Some(point) => missing(point, own_notes),
                    None => Some(format!("a small picture takes longer than {} s", PATIENCE.as_secs())),
                };
                match (point, why) {
                    (None, _) if self.stopped() => {}
                    (_, Some(why)) => measured.left_out.push(format!("{} {name}: {why}", ladder.name)),
                    (point, None) => {
                        levels.push((name, measured.points.len()));
                        measured.points.extend(point);
                    }
                }
            }
            measured.left_out.extend(ladder.left_out);
            let own = Setting::of(scene);
            let n_differences = |index: &usize| measured.points[*index].setting.differences(&own).len();
            let base = levels.iter().map(|(_, index)| *index).min_by_key(n_differences).unwrap_or_default();
            measured.series.push(Series { parameter: ladder.parameter, name: ladder.name, levels, base });
        }
        bar.set_length((n_levels + measured.points.len() * self.rounds as usize) as u64);
        for round in 0..self.rounds {
            bar.set_message(format!("times, round {} of {}", round + 1, self.rounds));
            for point in &mut measured.points {
                // A frame is missing only if the program is being stopped; then this round is incomplete and not counted.
                let Some(of_processor) = self.round(scene, round, point, right)? else { break };
                measured.processor_time &= of_processor;
                if let (Some(kit), Some(reference)) = (self.reference, &mut point.reference) {
                    Bench { kit, ..*self }.round(scene, round, reference, right)?;
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
            point.close(measured.rounds);
        }
        Ok(measured)
    }

    /// Measures a point in a round; `None` if the program is being stopped, else whether the time is processor time.
    fn round(&self, scene: &Scene, round: u32, point: &mut Point, right: &Reference) -> Result<Option<bool>> {
        let seed = self.seed + u64::from(round);
        let Some((frame, seconds)) = self.timed(&point.setting.apply(scene), seed)? else { return Ok(None) };
        point.times.push(seconds);
        if round > 0 {
            let errors = errors(&frame.film, &right.film)?;
            point.rmse.push(errors.rmse);
            point.biases.push((errors.bias, errors.bias_error));
        }
        Ok(Some(frame.processor_seconds.is_some()))
    }
}

/// Why a picture is not what its level says: what it lacks beside the scene's own picture, or another structure.
fn missing(point: &Point, own_notes: &[String]) -> Option<String> {
    let unwritten = |note: &&String| note.contains("not written") || note.contains("not finished");
    let more: Vec<&str> = point
        .notes
        .iter()
        .filter(unwritten)
        .filter(|note| !own_notes.contains(note))
        .map(String::as_str)
        .collect();
    let asked = point.setting.quality.accelerator;
    match point.accelerator {
        _ if !more.is_empty() => Some(more.join("; ")),
        Some(used) if used != asked => Some(format!("the renderer uses {} instead", used.name())),
        _ => None,
    }
}

/// An interval around 1 that ends within a tenth of it counts as equal where points are ranked: such a difference
/// is too small to choose a setting by, and without this bound two values of the same speed could never count as equal.
const SAME: f64 = 1.1;

/// Errors that differ by less come from rounding only, and count as equal.
const ROUNDING: f64 = 1.001;

/// How a value compares with others in time and error.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rank {
    /// No other value is both as fast and as accurate, and better in one of them: it is on the Pareto front.
    Front,
    /// Another value is, with 95 % confidence for each comparison.
    Beaten,
    /// The intervals do not say.
    Unclear,
}

/// The rank of each point. Settings that let more rays through closed surfaces than the tightest are beaten, because the error
/// of a picture hardly shows a leak, and so are fixed ray offsets.
pub fn ranks(points: &[Point]) -> Vec<Rank> {
    let leaks = |point: &Point| point.hits.map(|hits| hits.leaks);
    let fewest = points.iter().filter_map(leaks).min();
    // A fixed ray offset is safe at the size of one scene at most.
    let is_fixed = |point: &Point| point.setting.quality.ray_offset > 0.0;
    let is_tight = |point: &Point| !is_fixed(point) && leaks(point).is_none_or(|leaks| Some(leaks) == fewest);
    let rank = |point: &Point| {
        if !is_tight(point) {
            return Rank::Beaten;
        }
        let others = || points.iter().filter(|other| is_tight(other) && other.setting != point.setting);
        let beats: Vec<Option<bool>> = others().map(|other| beats(other, point)).collect();
        if beats.contains(&Some(true)) {
            Rank::Beaten
        } else if beats.contains(&None) {
            Rank::Unclear
        } else {
            Rank::Front
        }
    };
    points.iter().map(rank).collect()
}

/// Whether `one` is at least as fast and as accurate as `other`, and better in one of them; `None` if it may be.
fn beats(one: &Point, other: &Point) -> Option<bool> {
    // Less, equal or more, if the interval says so.
    let order = |ratio: Option<Median>| match ratio? {
        ratio if ratio.low > 1.0 / ROUNDING && ratio.high < ROUNDING => Some(Ordering::Equal),
        ratio if ratio.high < 1.0 => Some(Ordering::Less),
        ratio if ratio.low > 1.0 => Some(Ordering::Greater),
        ratio if ratio.low > 1.0 / SAME && ratio.high < SAME => Some(Ordering::Equal),
        _ => None,
    };
    match (order(one.time_ratio(other)), order(one.error_ratio(other))) {
        (Some(Ordering::Greater), _) | (_, Some(Ordering::Greater)) => Some(false),
        (None, _) | (_, None) => None,
        (time, error) => Some(time == Some(Ordering::Less) || error == Some(Ordering::Less)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use raykata::scene::Quality;

    #[test]
    fn the_front_holds_what_nothing_beats_and_nothing_that_leaks_more_than_the_least() {
        let scene = crate::report::scene_of_kit("stage1");
        let mut samples = 0;
        let mut point = |error, seconds, leaks| {
            samples += 1;
            let quality = Quality { samples_per_pixel: samples, ..scene.quality };
            Point::made_up(Setting { quality, ..Setting::of(&scene) }, error, seconds, leaks)
        };
        let mut points = vec![
            point(0.1, 1.0, 0),
            point(0.05, 0.5, 7),    // leaks
            point(0.09999, 1.5, 0), // slower, and more accurate by rounding only
            point(0.02, 4.0, 0),
            point(0.03, 5.0, 0), // slower and less accurate
        ];
        use Rank::{Beaten, Front, Unclear};
        assert_eq!(ranks(&points), [Front, Beaten, Beaten, Front, Beaten]);
        // One noisy point may be faster than all others.
        points[4].times = vec![0.1, 30.0, 0.1, 30.0, 0.1, 30.0];
        assert_eq!(ranks(&points)[4], Unclear);
        // Too few rounds have no interval, and so no rank.
        for point in &mut points {
            point.close(1);
        }
        assert_eq!(ranks(&points), [Unclear, Beaten, Unclear, Unclear, Unclear]);
    }
}
