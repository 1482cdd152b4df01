//! Stage 10, numerical stability: queries.

use glam::Vec3;
use serde::{Deserialize, Serialize};

/// Asks where a ray starts that leaves a surface (the ray offset that avoids shadow acne).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct OffsetQuery {
    /// The point on the surface, rounded to single precision, in world units.
    pub point: Vec3,
    /// The greatest distance of the true surface from `point` along each axis, in world units, at least 0.
    pub error: Vec3,
    /// The unit normal of the surface, on either side.
    pub normal: Vec3,
    /// The direction of the ray that leaves the surface.
    pub direction: Vec3,
}
