//! The oracle: exact answers about rays and shapes, and hard inputs to ask it about.
//!
//! `exact` decides hits, order and rounding of all finite `f32` inputs. `gauntlet` draws inputs at the edges of triangles,
//! boxes and closed meshes, and judges any method by `exact`. `splitmix` is where random inputs come from.

pub mod exact;
pub mod gauntlet;
pub mod splitmix;

/// A stable method may give a wrong verdict only where at most this many roundings decide. Stable methods stay below 30,
/// broken ones begin at 1e5 (`raykata gauntlet` shows both).
pub const STABLE: f64 = 64.0;
