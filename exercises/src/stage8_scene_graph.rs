//! Stage 8 · scene graph: each shape has its own space, and one mesh can have a hundred thousand
//! instances.
//!
//! Slides: `slides/stage08.md`.
//!
//! Given: [`Graph`], whose nodes have children and primitives; [`Probe`] with `enter` (where the
//! ray enters the bounding volume of a node) and `hit` (where it hits a primitive).

use glam::{Affine3A, DAffine3, Vec3};
use raykata::aabb::Aabb;
use raykata::bvh::{PrimitiveHit, Probe};
use raykata::graph::{Graph, GraphOptimisations, Placement};
use raykata::ray::Ray;
use raykata::shape::Sphere;

/// Moves the ray into the space of the object: `o' = M⁻¹(o - b)` and `d' = M⁻¹ d`. The same `t`
/// then belongs to the same point in both spaces. What would a unit direction do to `t`?
/// `to_object` is this inverse.
///
/// Exactly:
///
/// 1. The origin is wrong by at most a few rounding errors of its terms.
/// 2. The direction keeps its transformed length.
/// 3. `t_min`, `t_max` and `time` stay the same.
#[inline]
pub fn ray_to_object(ray: &Ray, to_object: &Affine3A) -> Ray {
    todo!("transform the origin as a point and the direction as a vector; do not normalize it")
}

/// A normal goes through the inverse transpose, `n = M⁻ᵀ n₀`, and so stays perpendicular to the
/// surface. Stretch a sphere along x: do its normals turn towards the x axis?
///
/// `to_object` is M⁻¹, and `normal` has unit length. The result has unit length, too. It points
/// outwards if `normal` does, also for a reflection.
pub fn normal_to_world(normal: Vec3, to_object: &Affine3A) -> Vec3 {
    todo!("multiply by the transpose of to_object, then normalize")
}

/// The transforms from the space of a node to the world and back. `path` holds `M₁ M₂ … Mₙ` from
/// the root to the node, each from a node to its parent; `to_world` is their product.
///
/// Exactly:
///
/// 1. `to_object` is `Mₙ⁻¹ … M₂⁻¹ M₁⁻¹`.
/// 2. An empty path gives the identity for both.
/// 3. `None` if some determinant is 0 or some inverse is not finite. A small or negative
///    determinant is valid.
pub fn placement(path: &[Affine3A]) -> Option<Placement> {
    todo!("multiply the transforms from the root to the node, and the inverses in reverse order")
}

/// The axis-aligned box around the eight corners of `bounds` after the transform `to_world`. A
/// corner is a sum of rounded terms. Where may rounding move it?
///
/// Exactly:
///
/// 1. The box contains all transformed points of `bounds`.
/// 2. It is larger than the exact box by a few rounding errors of the terms at most.
/// 3. An empty box (`min` above `max` on some axis) gives an empty box.
///
/// Source: Arvo, "Transforming axis-aligned bounding boxes", Graphics Gems, 1990; "Rotate Bounding
/// Boxes".
pub fn bounds_to_world(to_world: &Affine3A, bounds: &Aabb) -> Aabb {
    todo!("sum the smaller and the larger product per axis, and round outwards")
}

/// A sphere that contains all `points`, of which there is at least one. The centre of their
/// bounding box is a good centre, and the farthest point gives the radius. What if it is rounded?
///
/// Exactly:
///
/// 1. No point lies outside, also not by a rounding error.
/// 2. The radius is at most twice the smallest possible one, apart from a few rounding errors of
///    the coordinates.
pub fn bounding_sphere(points: &[Vec3]) -> Sphere {
    todo!("take the centre of the points' box and the largest distance from it, rounded up")
}

/// The slab test's counterpart for bounding spheres: the nearer root is the `t` at which `ray`
/// enters. A search compares it with the `t` of hits. What if it is late by one rounding error?
///
/// Exactly:
///
/// 1. `t` counts lengths of the direction, which may have any length but 0. The radius is above 0.
/// 2. The result is in `t_min..=t_max`; from inside it is `t_min`.
/// 3. It is never later than the exact entry as an `f32`, and earlier by at most 10⁻⁵ of the distance
///    to the centre plus the radius.
/// 4. `None` if the sphere lies beside the ray, behind it or beyond `t_max`. The surface belongs to
///    the sphere.
pub fn enter_bounding_sphere(ray: &Ray, sphere: &Sphere) -> Option<f32> {
    todo!("return the nearer root, or t_min from inside; None if the ray misses the sphere")
}

/// The closest hit of `ray` in a scene graph: test a node's own primitives, then visit its
/// children. Node 0 is the root; a graph without nodes gives `None`. A hit at exactly `t_max` does
/// not count. How far may the range shrink after a hit?
///
/// Exactly:
///
/// 1. The hit is the same for all combinations of `savings`. At equal `t` the smaller primitive
///    number wins.
/// 2. Test each primitive at most once.
/// 3. `volumes`: call `probe.enter` once per node before its primitives are tested, also for the
///    root; skip a node that the ray does not enter, with all nodes below. Off: never call it, and
///    visit all nodes.
/// 4. `skip`: just before you visit a node, skip it if the ray enters it beyond the closest hit so
///    far, not exactly there.
/// 5. `sort`: visit the entered children in the order of their entries. Off: as listed.
pub fn closest_hit_in_graph(
    graph: &Graph,
    probe: &mut impl Probe,
    ray: &Ray,
    savings: GraphOptimisations,
) -> Option<PrimitiveHit> {
    todo!("test the node's primitives, then visit the children as savings says")
}
