//! Stage 11, light transport: queries.

use crate::emitter::AreaEmitter;
use glam::{Vec2, Vec3};
use serde::{Deserialize, Serialize};

/// Asks which point of an emitter two random numbers sample; the answer is an
/// [`EmitterSample`](crate::emitter::EmitterSample).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EmitterQuery {
    /// The emitter.
    pub emitter: AreaEmitter,
    /// The point that the emitter illuminates, in world units.
    pub from: Vec3,
    /// Two random numbers, `0 <= u < 1` each.
    pub u: Vec2,
}

/// Asks for the density with which a direction to an emitter is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct EmitterPdfQuery {
    /// The emitter.
    pub emitter: AreaEmitter,
    /// The point that the emitter illuminates, in world units.
    pub from: Vec3,
    /// The direction, of unit length.
    pub direction: Vec3,
}

/// Asks whether a path survives Russian roulette.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RouletteQuery {
    /// The factor per channel with which light that the path finds contributes to the pixel, at least 0.
    pub weight: Vec3,
    /// The number of surfaces that the path has met.
    pub bounce: u32,
    /// A random number, `0 <= u < 1`.
    pub u: f32,
}
