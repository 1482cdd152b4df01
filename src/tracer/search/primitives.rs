//! The questions of searches about the primitives below a structure.

use super::wide::Wide;
use crate::aabb::Aabb;
use crate::bvh::{PrimitiveHit, Probe};
use crate::count::Event;
use crate::partition::Cells;
use crate::ray::Ray;
use glam::Vec3;

/// The primitives below a structure, with the questions that searches ask about them.
pub trait Primitives: Probe + Cells {
    /// The number of primitives; their indices are `0..n_primitives`.
    fn n_primitives(&self) -> u32;

    /// Counts one event.
    fn count(&mut self, event: Event);

    /// Notes that a ray was tested against a box, and whether it enters it.
    fn tested(&mut self, bounds: &Aabb, hit: bool);

    /// Whether `conservative_slab` of stage 10 tests boxes; otherwise `slab` of stage 3.
    fn conservative(&self) -> bool;

    /// The reciprocal of each component of the direction of the ray; infinite where a component is 0.
    fn inverse_direction(&self) -> Vec3;

    /// The closest hit of `ray` in a wide tree over these primitives, or `None`.
    fn closest_in_wide(&mut self, wide: &Wide, ray: &Ray) -> Option<PrimitiveHit>;

    /// Whether `ray` hits anything in a wide tree over these primitives.
    fn any_in_wide(&mut self, wide: &Wide, ray: &Ray) -> bool;
}
