//! What is measured: the points, the ladders, the verdicts on hits, and the reference.

use super::error::Errors;
use super::parameter::Parameter;
use super::setting::Setting;
#[cfg(test)]
use crate::race::statistics::FEWEST;
use crate::race::statistics::{Median, paired_ratio};
use crate::report::quartiles;
use raykata::count::Counts;
use raykata::film::Film;
use raykata::message;
use raykata::scene::Accelerator;
use serde::{Deserialize, Serialize};

/// The measurements of one setting.
#[derive(Clone, Debug, Serialize)]
pub struct Point {
    #[serde(skip)]
    pub setting: Setting,
    /// The errors of the first round.
    pub errors: Errors,
    /// The root mean square error of each round.
    pub rmse: Vec<f64>,
    /// The bias of each round, with its standard error.
    pub biases: Vec<(f64, f64)>,
    pub counts: Counts,
    /// The oracle's verdicts on the hits, for parameters that decide only how they are found.
    pub hits: Option<Verdicts>,
    /// Seconds for the pixels: elapsed, on all threads, until the rounds have measured the processor time of one thread; then
    /// its median over them.
    pub seconds: f64,
    /// The processor time of each round, in seconds.
    pub times: Vec<f64>,
    /// Seconds to build the acceleration structure.
    pub build_seconds: f64,
    /// The same setting by the reference, in the same rounds, if another kit is measured beside it.
    pub reference: Option<Box<Point>>,
    /// The picture of the first round.
    #[serde(skip)]
    pub film: Film,
    /// The structure that the renderer used.
    #[serde(skip)]
    pub accelerator: Option<Accelerator>,
    #[serde(skip)]
    pub notes: Vec<String>,
}

impl Point {
    /// The mean error over all rounds.
    pub fn error(&self) -> f64 {
        self.rmse.iter().sum::<f64>() / self.rmse.len().max(1) as f64
    }

    /// The processor time as a multiple of that of `base`, paired by rounds. `None` for fewer rounds than an interval needs.
    pub fn time_ratio(&self, base: &Point) -> Option<Median> {
        paired_ratio(&self.times, &base.times)
    }

    /// The error as a multiple of that of `base`, in the same way.
    pub fn error_ratio(&self, base: &Point) -> Option<Median> {
        paired_ratio(&self.rmse, &base.rmse)
    }

    /// Whether the point takes less processor time than `base`, with 95 % confidence.
    pub fn is_faster(&self, base: &Point) -> bool {
        self.time_ratio(base).is_some_and(|ratio| ratio.high < 1.0)
    }

    /// Whether its error is smaller than that of `base`, with 95 % confidence.
    pub fn is_more_accurate(&self, base: &Point) -> bool {
        self.error_ratio(base).is_some_and(|ratio| ratio.high < 1.0)
    }

    /// Takes the median of the times, after this many complete rounds; what an incomplete one has measured is not paired.
    pub fn close(&mut self, rounds: u32) {
        let complete = rounds.max(1) as usize;
        self.times.truncate(complete);
        self.rmse.truncate(complete);
        self.biases.truncate(complete);
        if !self.times.is_empty() {
            self.seconds = quartiles(self.times.clone())[1];
        }
        self.reference.iter_mut().for_each(|reference| reference.close(rounds));
    }

    /// The mean bias over all rounds, and its standard error. `of_reference` is the error of the reference per channel of a
    /// pixel, of which there are `pixels`: the error of its mean is the same for all points, and adds to each.
    pub fn bias(&self, of_reference: f64, pixels: f64) -> (f64, f64) {
        let rounds = self.biases.len().max(1) as f64;
        let mean = self.biases.iter().map(|(bias, _)| bias).sum::<f64>() / rounds;
        let variance = self.biases.iter().map(|(_, error)| error.powi(2)).sum::<f64>() / rounds.powi(2);
        (mean, (variance + of_reference.powi(2) / pixels.max(1.0)).sqrt())
    }

    /// A point for tests, with these values.
    #[cfg(test)]
    pub fn made_up(setting: Setting, error: f64, seconds: f64, leaks: u64) -> Point {
        Point {
            setting,
            errors: Errors { rmse: error, similarity: 1.0, ..Errors::default() },
            rmse: vec![error; FEWEST],
            biases: vec![(0.0, 0.0); FEWEST],
            counts: Counts::default(),
            hits: Some(Verdicts { rays: 1000, wrong: leaks, leaks }),
            seconds,
            times: vec![seconds; FEWEST],
            build_seconds: 0.0,
            reference: None,
            film: Film { width: 0, height: 0, pixels: Vec::new() },
            accelerator: None,
            notes: Vec::new(),
        }
    }
}

/// A measured ladder: those of its levels that could be measured.
#[derive(Clone, Debug, Serialize)]
pub struct Series {
    pub parameter: Parameter,
    pub name: String,
    /// The name of each value, and the index of its point.
    pub levels: Vec<(String, usize)>,
    /// The index of the point that its times are compared with: the level nearest to the scene's own setting.
    pub base: usize,
}

/// All measurements.
#[derive(Default, Serialize)]
pub struct Measured {
    pub points: Vec<Point>,
    pub series: Vec<Series>,
    /// Sentences about values that were left out.
    pub left_out: Vec<String>,
    /// What the pictures lack because functions are not written yet, one sentence each.
    pub lacking: Vec<String>,
    /// The number of complete rounds.
    pub rounds: u32,
    /// Whether the operating system gave processor times; otherwise times are elapsed ones.
    pub processor_time: bool,
}

/// The oracle's counts for one setting.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Verdicts {
    /// The number of rays that were tested.
    pub rays: u64,
    /// The number of these rays that report a wrong first hit: another primitive, no hit, or a hit where
    /// there is none.
    pub wrong: u64,
    /// The number of wrong rays that passed through a closed surface.
    pub leaks: u64,
}

message! { Verdicts { rays, wrong, leaks } }

/// The reference of a scene.
pub struct Reference {
    pub film: Film,
    /// The number of samples per pixel.
    pub samples: u32,
    /// The estimated error of the reference itself: root mean square over all channels, in linear light.
    pub own_error: f64,
}
