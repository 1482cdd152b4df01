//! The oracle: exact answers about rays and shapes, and hard inputs to ask it about.
//!
//! `exact` decides hits, order and rounding of all finite `f32` inputs. `gauntlet` draws hard inputs for triangles,
//! boxes and closed meshes, and judges methods by `exact`. `splitmix` generates random inputs.

pub mod exact;
pub mod gauntlet;
pub mod splitmix;

/// The largest margin, in roundings, at which a stable method may give a wrong verdict. Stable methods stay
/// below 30, and unstable ones reach 1e5 and more (`raykata gauntlet` shows both).
pub const STABLE: f64 = 64.0;
