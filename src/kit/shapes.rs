//! Stage 1, spheres and planes: queries.

use crate::message;
use crate::ray::Ray;
use crate::shape::{Plane, PlaneEquation, Sphere};

/// Asks where `ray` hits `sphere`; the answer is the `t` of the nearest hit that counts, if there is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphereQuery {
    /// The ray; its range says which hits count.
    pub ray: Ray,
    /// The sphere that is intersected.
    pub sphere: Sphere,
}

message! { SphereQuery { ray, sphere } }

/// Asks where `ray` hits `plane`; the answer is the `t` of the hit, if there is one that counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneQuery {
    /// The ray; its range says which hits count.
    pub ray: Ray,
    /// The infinite plane that is intersected.
    pub plane: Plane,
}

message! { PlaneQuery { ray, plane } }

/// Asks where `ray` hits the plane with these coefficients; the answer is the `t` of the hit, if there is one that
/// counts.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaneEquationQuery {
    /// The ray; its range says which hits count.
    pub ray: Ray,
    /// The infinite plane that is intersected.
    pub plane: PlaneEquation,
}

message! { PlaneEquationQuery { ray, plane } }
