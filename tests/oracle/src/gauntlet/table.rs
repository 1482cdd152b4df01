//! Measures how often each method is wrong on each distribution, the margin of its worst mistake, and the
//! error of `t`.

use super::distributions::Distribution;
use crate::exact::{Body, meet, t_error_in_ulps, triangle};
use crate::splitmix::Random;
use raykata::kit::least_seconds;
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// Inputs of a distribution with their exact answers.
pub struct Judged {
    /// Rays and triangles.
    pub inputs: Vec<(Ray, Triangle)>,
    /// Whether each ray hits the closed triangle.
    pub hits: Vec<bool>,
}

/// Draws `count` inputs and asks the oracle.
pub fn judge(distribution: &Distribution, seed: u64, count: usize) -> Judged {
    let mut random = Random::new(seed, 0);
    let inputs: Vec<(Ray, Triangle)> = (0..count).map(|_| (distribution.draw)(&mut random)).collect();
    let hit = |(ray, triangle): &(Ray, Triangle)| {
        meet(ray, Body::Triangle(*triangle)).is_some_and(|meeting| meeting.verdict.is_hit())
    };
    let hits = inputs.iter().map(hit).collect();
    Judged { inputs, hits }
}

/// The results of a method on a distribution.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Cell {
    /// The percentage of wrong verdicts.
    pub wrong: f64,
    /// The largest margin of a wrong verdict, in roundings; 0 if none is wrong. A stable method is wrong only
    /// below 64.
    pub margin: f64,
    /// The error of `t`, in ulps, that 99 of 100 hits stay below.
    pub ulps: f64,
}

/// Compares the answers, which are the `t` of the hits, with the exact ones.
pub fn compare(judged: &Judged, answers: &[Option<f32>]) -> Cell {
    let (mut wrong, mut margin) = (0, 0.0f64);
    let mut errors = Vec::new();
    for (((ray, shape), &hits), answer) in judged.inputs.iter().zip(&judged.hits).zip(answers) {
        if answer.is_some() != hits {
            wrong += 1;
            margin = margin.max(triangle::margin(ray, shape).unwrap_or(0.0));
        } else if let (Some(t), true) = (answer, errors.len() < 2000) {
            errors.extend(t_error_in_ulps(ray, Body::Triangle(*shape), *t).map(f64::abs));
        }
    }
    errors.sort_by(f64::total_cmp);
    let ulps = errors.get(errors.len() * 99 / 100).copied().unwrap_or(0.0);
    Cell { wrong: 100.0 * f64::from(wrong) / judged.inputs.len() as f64, margin, ulps }
}

/// Nanoseconds of one call, the best of five rounds over all inputs.
pub fn nanoseconds(judged: &Judged, mut answer_all: impl FnMut(&[(Ray, Triangle)])) -> f64 {
    1e9 * least_seconds(|| answer_all(&judged.inputs)) / judged.inputs.len() as f64
}
