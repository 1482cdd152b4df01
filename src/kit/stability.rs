//! Stage 10 in plain data.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Where does a ray start that leaves a surface?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OffsetQuery {
    /// The rounded point on the surface.
    pub point: Vec3,
    /// How far the true surface may be from it, along each axis.
    pub error: Vec3,
    /// Unit normal of the surface, on either side.
    pub normal: Vec3,
    /// Where the ray goes.
    pub direction: Vec3,
}
