//! The goal of the search for the best settings, and its steps.

use super::measured::Point;
use super::parameter::Parameter;
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
pub struct Left {
    pub parameter: Parameter,
    /// Its value.
    pub at: String,
    /// The factors by which one more level changes time and error, for example 1.5.
    pub time_factor: f64,
    pub error_factor: f64,
}

/// The factor up to which a larger error counts as the same.
pub const AS_GOOD: f64 = 1.02;

/// Seconds for a picture with `full` times as many pixels; the build time stays the same.
pub fn seconds_in_full(point: &Point, full: f64) -> f64 {
    point.seconds * full + point.build_seconds
}
