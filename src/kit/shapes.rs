//! Stage 1 in plain data.

use crate::ray::Ray;
use crate::shape::{Plane, Sphere};
use serde::{Deserialize, Serialize};

/// Where does `ray` meet `sphere`?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SphereQuery {
    /// The ray.
    pub ray: Ray,
    /// The sphere.
    pub sphere: Sphere,
}

/// Where does `ray` meet `plane`?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct PlaneQuery {
    /// The ray.
    pub ray: Ray,
    /// The plane.
    pub plane: Plane,
}

/// Which of two roots is the first that counts for `ray`?
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct RootQuery {
    /// The two roots, in any order; either may be NaN.
    pub roots: [f32; 2],
    /// The ray whose range decides.
    pub ray: Ray,
}
