//! The questions of searches about the primitives below a structure.

use crate::aabb::Aabb;
use crate::bvh::Probe;
use crate::count::Event;
use crate::partition::Cells;
use crate::ray::Ray;
use crate::shape::Triangle;
use glam::Vec3;

/// The primitives below a structure, with the questions that searches ask about them.
pub trait Primitives: Probe + Cells {
    /// Whether events are counted.
    const COUNTS: bool;

    /// The number of primitives; their indices are `0..n_primitives`.
    fn n_primitives(&self) -> u32;

    /// Counts one event.
    fn count(&mut self, event: Event);

    /// Notes that a ray was tested against a box, and whether it enters it. The box is made only if it is kept.
    fn tested(&mut self, bounds: impl FnOnce() -> Aabb, hit: bool);

    /// Whether `conservative_slab` of stage 10 tests boxes; otherwise `slab` of stage 3.
    fn conservative(&self) -> bool;

    /// The reciprocal of each component of the direction of the ray; infinite where a component is 0.
    fn inverse_direction(&self) -> Vec3;

    /// Whether `may_hit` of stage 12 may reject triangles before they are tested: it is written, and the triangle test of the
    /// plan rounds no more than `may_hit`. A test that rounds more could report a hit of a triangle that `may_hit` rejects,
    /// and then a wide tree would find other hits than the other accelerators.
    fn may_sort_out(&self) -> bool;

    /// Whether hits of triangles are those of the watertight test of stage 10.
    fn is_watertight(&self) -> bool;

    /// The `t` of the hit with a primitive in the range of the ray, without a count.
    fn hit_uncounted(&mut self, primitive: u32, ray: &Ray) -> Option<f32>;

    /// The same for a primitive that is `triangle`, can be hit from both sides and does not move.
    fn hit_triangle(&mut self, primitive: u32, triangle: &Triangle, ray: &Ray) -> Option<f32>;
}
