//! Stage 8 · scene graph: every shape in a space of its own, and one mesh in a hundred thousand places.
//!
//! Slides: "Scene Graph", "Ray-Scene Intersection", "Bounding Volumes", "Transformations" (meshes), "Rotate Bounding
//! Boxes", "Combine Transformations".
//!
//! Given: [`Graph`], whose nodes have children and primitives; [`Probe`] with `enter` (where the ray enters the volume
//! around a node) and `hit` (where it hits a primitive).

use glam::{Affine3A, DAffine3, Vec3};
use raykata::aabb::Aabb;
use raykata::bvh::{PrimitiveHit, Probe};
use raykata::graph::{Graph, Placement, Savings};
use raykata::ray::Ray;
use raykata::shape::Sphere;

/// The same ray in the space of an object: a hit has the same `t` in both.
///
/// Where the formula lies: the slide sends the direction through the inverse *transpose*, which is for normals only (and
/// the same for scales along the axes, so that such tests do not notice). And a direction that is made a unit vector again
/// changes `t`, which can then not be compared with the `t` of another object.
#[inline]
pub fn ray_to_object(ray: &Ray, to_object: &Affine3A) -> Ray {
    todo!("carry the origin as a point and the direction as a vector; leave its length alone")
}

/// The unit normal in the world of a surface whose normal in its own space is `normal`: through the transpose of
/// `to_object`, the inverse transpose of the way to the world. Outside stays outside, in a mirror, too.
pub fn normal_to_world(normal: Vec3, to_object: &Affine3A) -> Vec3 {
    todo!("multiply by the transpose of to_object, then make it a unit vector")
}

/// Where a node stands whose ancestors' transforms, from the root down to its own, are `path`: `M₁ M₂ … Mₙ` to the world,
/// and `Mₙ⁻¹ … M₂⁻¹ M₁⁻¹` back. `None` if one of them cannot be undone.
pub fn placement(path: &[Affine3A]) -> Option<Placement> {
    todo!("multiply the transforms from the root down, and the inverses the other way round")
}

/// A box around `bounds` after the transform `to_world`, with no point of it outside and little room: its eight corners,
/// rounded outwards. The empty box stays empty.
///
/// Where the formula lies: rounded to nearest, the largest corner ends up inside the true box in half of all cases, and
/// a ray at it misses.
pub fn bounds_to_world(to_world: &Affine3A, bounds: &Aabb) -> Aabb {
    todo!("transform what matters of the eight corners, and round outwards")
}

/// A sphere that holds all of `points`, one or more. It need not be the smallest, but no radius may be more than twice as
/// large as that: around the middle of their box is small enough.
pub fn bounding_sphere(points: &[Vec3]) -> Sphere {
    todo!("take a centre, and the largest distance from it, rounded up")
}

/// Where `ray` enters the sphere, within `t_min..=t_max`: at `t_min` if it starts inside; `None` if it does not come into
/// it. The like of the slab test for spheres.
pub fn enter_bounding_sphere(ray: &Ray, sphere: &Sphere) -> Option<f32> {
    todo!("the nearer root, or t_min from inside; nothing if the ray passes or ends before")
}

/// The closest hit in a scene graph: a node's own primitives, then the nodes below. Of two hits at the same `t` the smaller
/// primitive number wins. `savings` says which questions are to be saved; the hit is the same for all of them.
///
/// - `volumes`: ask `enter` for a node first, the root included, and leave out what the ray does not enter. Without it,
///   `enter` is never asked, and there is nothing to skip or to sort by.
/// - `skip`: what is entered beyond the closest hit so far is left out.
/// - `sort`: of the children that are entered, the nearest is looked into first.
pub fn closest_hit_in_graph(
    graph: &Graph,
    probe: &mut impl Probe,
    ray: &Ray,
    savings: Savings,
) -> Option<PrimitiveHit> {
    todo!("hit the node's primitives, then look into the children that are worth it")
}
