//! Stage 8 · scene graph: each shape has its own space, and one mesh can have a hundred thousand instances.
//!
//! Slides: "Scene Graph", "Ray-Scene Intersection", "Bounding Volumes", "Transformations" (meshes), "Rotate Bounding
//! Boxes", "Combine Transformations".
//!
//! Given: [`Graph`], whose nodes have children and primitives; [`Probe`] with `enter` (where the ray enters the bounding
//! volume of a node) and `hit` (where it hits a primitive).

use glam::{Affine3A, DAffine3, Vec3};
use raykata::aabb::Aabb;
use raykata::bvh::{PrimitiveHit, Probe};
use raykata::graph::{Graph, GraphOptimisations, Placement};
use raykata::ray::Ray;
use raykata::shape::Sphere;

/// Transforms a ray from the world to the space of an object, so that each hit has the same `t` in both spaces.
///
/// `to_object` is the inverse transform, from the world to the object. The origin is transformed as a point and the
/// direction as a vector, which keeps the length that the transform gives it. `t_min`, `t_max` and `time` stay the
/// same. For an object far from the origin of the world, single precision loses digits of the ray's origin; double
/// precision keeps them.
///
/// Pitfall: the slide transforms the direction by the inverse *transpose*, which is for normals only. For scales along
/// the axes both give the same result, so tests with such scales do not show the mistake. A normalized direction is
/// wrong, too: it changes the unit of `t`, which then cannot be compared with the `t` of another object.
#[inline]
pub fn ray_to_object(ray: &Ray, to_object: &Affine3A) -> Ray {
    todo!("transform the origin as a point and the direction as a vector; do not normalize it")
}

/// Transforms the unit normal `normal` of a surface from the space of its object to the world. The result has unit
/// length.
///
/// `to_object` is the inverse of the transform to the world, so its transpose is the inverse transpose that normals
/// need. A normal that points outwards still does after the transform, also for a reflection.
///
/// Pitfall: a normal that is transformed like a point is not perpendicular to a stretched surface. Do not flip the result
/// for a negative determinant.
pub fn normal_to_world(normal: Vec3, to_object: &Affine3A) -> Vec3 {
    todo!("multiply by the transpose of to_object, then normalize")
}

/// Computes the transform from the space of a node to the world, and its inverse.
///
/// `path` holds the transforms `M₁ M₂ … Mₙ` from the root to the node itself, each from a node to its parent.
/// `to_world` is their product `M₁ M₂ … Mₙ`, and `to_object` is `Mₙ⁻¹ … M₂⁻¹ M₁⁻¹`. An empty path gives the identity
/// for both. The result is `None` if some determinant is exactly 0 or some inverse is not finite. A small or negative
/// determinant is valid.
///
/// Pitfall: the inverse of a product is the product of the inverses in reverse order.
pub fn placement(path: &[Affine3A]) -> Option<Placement> {
    todo!("multiply the transforms from the root to the node, and the inverses in reverse order")
}

/// Computes an axis-aligned box that contains all points of `bounds` after the transform `to_world`.
///
/// It is the box around the eight transformed corners, rounded outwards, and larger than the exact box by a few rounding
/// errors of the terms at most. An empty box (`min` above `max` on some axis) gives [`Aabb::EMPTY`].
///
/// Pitfall: rounded to nearest, the largest corner lies inside the exact box in half of all cases, and a ray that hits
/// the object there misses the box.
///
/// Source: Arvo, "Transforming axis-aligned bounding boxes", Graphics Gems, 1990; slide "Rotate Bounding Boxes".
pub fn bounds_to_world(to_world: &Affine3A, bounds: &Aabb) -> Aabb {
    todo!("sum the smaller and the larger product per axis, and round outwards")
}

/// Computes a sphere that contains all `points`, of which there is at least one.
///
/// It need not be the smallest such sphere, but its radius must be at most twice as large, apart from a few rounding
/// errors of the coordinates. The sphere around the centre of the points' bounding box is small enough. No point may lie
/// outside, also not by a rounding error.
///
/// Pitfall: a radius that is rounded to nearest is too small in half of all cases. Round it up.
pub fn bounding_sphere(points: &[Vec3]) -> Sphere {
    todo!("take the centre of the points' box and the largest distance from it, rounded up")
}

/// Computes the `t` at which `ray` enters the sphere: the slab test's counterpart for bounding spheres.
///
/// The result lies in `t_min..=t_max` and counts lengths of the direction, which may have any length but 0; the radius is
/// above 0. The result is `t_min` if the ray starts inside, and
/// `None` if the sphere lies beside the ray, behind it or beyond `t_max`. The surface belongs to the sphere. The result
/// must not be later than the exact entry, and may be earlier by a few rounding errors.
///
/// Pitfall: a search compares this `t` with the `t` of hits. If it is late by a rounding error, the search skips a sphere
/// that contains a hit at the same `t`.
pub fn enter_bounding_sphere(ray: &Ray, sphere: &Sphere) -> Option<f32> {
    todo!("return the nearer root, or t_min from inside; None if the ray misses the sphere")
}

/// Finds the closest hit of `ray` in a scene graph: tests a node's own primitives first, then visits its children. Node
/// 0 is the root; a graph without nodes gives `None`.
///
/// Of two hits at the same `t` the smaller primitive number wins. `probe.hit` tests a primitive; test each one at most
/// once. `savings` switches on three optimisations, and the hit is the same for all combinations:
///
/// - `volumes`: call `probe.enter` once for each node before its primitives are tested, also for the root, and skip a
///   node that the ray does not enter, with all nodes below. Without `volumes`, `enter` is never called, and every node
///   is visited.
/// - `skip`: skip a node that the ray enters beyond the closest hit so far. Decide this when you are about to visit the
///   node. A node that begins exactly at the closest hit must be visited.
/// - `sort`: visit the entered children in the order in which the ray enters them. Without `sort`, visit them as listed.
///
/// Pitfall: a hit at exactly `t_max` does not count. If the range shrinks to the closest hit, a hit at the same `t`
/// with a smaller number is lost.
pub fn closest_hit_in_graph(
    graph: &Graph,
    probe: &mut impl Probe,
    ray: &Ray,
    savings: GraphOptimisations,
) -> Option<PrimitiveHit> {
    todo!("test the node's primitives, then visit the children as savings says")
}
