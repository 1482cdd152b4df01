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

// <solution>
use crate::stage3_traversal::{keep_closest, nearer};
use raykata::rounding::UNIT_ROUNDOFF;
// </solution>

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
    // <solution>
    Ray {
        // Use double precision, because far from the origin large terms cancel.
        origin: to_object.as_daffine3().transform_point3(ray.origin.as_dvec3()).as_vec3(),
        // Keep the length, because a unit direction changes t. The transpose is for normals only.
        direction: to_object.transform_vector3(ray.direction),
        ..*ray
    }
    // <stub> todo!("transform the origin as a point and the direction as a vector; do not normalize it")
    // </solution>
}

/// A normal goes through the inverse transpose, `n = M⁻ᵀ n₀`, and so stays perpendicular to the
/// surface. Stretch a sphere along x: do its normals turn towards the x axis?
///
/// `to_object` is M⁻¹, and `normal` has unit length. The result has unit length, too. It points
/// outwards if `normal` does, also for a reflection.
pub fn normal_to_world(normal: Vec3, to_object: &Affine3A) -> Vec3 {
    // <solution>
    // Multiply by the inverse transpose. It needs no sign: n · (M v) stays n₀ · v, so an outward
    // normal stays outward, also for a reflection.
    let rows = to_object.as_daffine3().matrix3.transpose();
    (rows * normal.as_dvec3()).normalize_or_zero().as_vec3()
    // <stub> todo!("multiply by the transpose of to_object, then normalize")
    // </solution>
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
    // <solution>
    // Multiply the transforms from the root to the node, and the inverses in reverse order.
    let (mut to_world, mut to_object) = (DAffine3::IDENTITY, DAffine3::IDENTITY);
    for to_parent in path {
        let to_parent = to_parent.as_daffine3();
        // Reject a transform without an inverse.
        let from_parent = to_parent.inverse();
        if to_parent.matrix3.determinant() == 0.0 || !from_parent.is_finite() {
            return None;
        }
        to_world *= to_parent;
        to_object = from_parent * to_object;
    }
    Some(Placement { to_world: to_world.as_affine3a(), to_object: to_object.as_affine3a() })
    // <stub> todo!("multiply the transforms from the root to the node, and the inverses in reverse order")
    // </solution>
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
    // <solution>
    // Return the empty box for an empty box, because sums of infinite corners can be NaN.
    if bounds.min.cmpgt(bounds.max).any() {
        return Aabb::EMPTY;
    }
    let columns = [to_world.matrix3.x_axis, to_world.matrix3.y_axis, to_world.matrix3.z_axis].map(Vec3::from);
    let translation = Vec3::from(to_world.translation);
    let (mut min, mut max) = (Vec3::ZERO, Vec3::ZERO);
    for row in 0..3 {
        // Sum the smaller and the larger product per axis of the box (Arvo), in double precision.
        let (mut low, mut high) = (f64::from(translation[row]), f64::from(translation[row]));
        for (axis, column) in columns.iter().enumerate() {
            let factor = f64::from(column[row]);
            let ends = [factor * f64::from(bounds.min[axis]), factor * f64::from(bounds.max[axis])];
            low += ends[0].min(ends[1]);
            high += ends[0].max(ends[1]);
        }
        // Round outwards by one float. The conversion to single precision errs by less than that.
        min[row] = (low as f32).next_down();
        max[row] = (high as f32).next_up();
    }
    Aabb::new(min, max)
    // <stub> todo!("sum the smaller and the larger product per axis, and round outwards")
    // </solution>
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
    // <solution>
    let min = points.iter().fold(Vec3::INFINITY, |low, point| low.min(*point));
    let max = points.iter().fold(Vec3::NEG_INFINITY, |high, point| high.max(*point));
    let center = 0.5 * min + 0.5 * max;
    let distance = |point: &Vec3| point.as_dvec3().distance(center.as_dvec3());
    let radius = points.iter().map(distance).fold(0.0, f64::max);
    // Round the radius up: rounded to nearest, it is too small in half of all cases.
    Sphere { center, radius: (radius as f32).next_up() }
    // <stub> todo!("take the centre of the points' box and the largest distance from it, rounded up")
    // </solution>
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
    // <solution>
    let (direction, to_center) = (ray.direction.as_dvec3(), sphere.center.as_dvec3() - ray.origin.as_dvec3());
    let radius = f64::from(sphere.radius);
    // Compare the distance of the line from the centre with the radius. The line is closest to the
    // centre at t = b / a, and the square of this distance is |to_center × direction|² / a.
    let (a, b) = (direction.length_squared(), to_center.dot(direction));
    let discriminant = a * radius * radius - to_center.cross(direction).length_squared();
    if !(discriminant >= 0.0) {
        return None;
    }
    // Compute both roots, widen the interval by the rounding errors, and clamp it to the ray's
    // range.
    let (enter, leave) = ((b - discriminant.sqrt()) / a, (b + discriminant.sqrt()) / a);
    let enter = ((enter - ROOM * enter.abs()) as f32).max(ray.t_min);
    let leave = ((leave + ROOM * leave.abs()) as f32).min(ray.t_max);
    (enter <= leave).then_some(enter)
    // <stub> todo!("return the nearer root, or t_min from inside; None if the ray misses the sphere")
    // </solution>
}

// <solution>
/// The relative widening of the interval in a sphere: eight times the unit roundoff `u = 2⁻²⁴`. A
/// search compares the entry with the `t` of hits, which has other rounding errors. With this room
/// it does not skip a sphere that contains a hit at exactly the best `t`.
const ROOM: f64 = 8.0 * UNIT_ROUNDOFF as f64;
// </solution>

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
    // <solution>
    let mut search = GraphSearch { graph, savings, ray: *ray, closest: None };
    if !graph.nodes.is_empty() && search.enter(0, probe).is_some() {
        search.node(0, probe);
    }
    search.closest
    // <stub> todo!("test the node's primitives, then visit the children as savings says")
    // </solution>
}

// <solution>
/// The state of a search.
struct GraphSearch<'a> {
    graph: &'a Graph,
    savings: GraphOptimisations,
    /// The ray. With `skip`, its range ends one float beyond the closest hit.
    ray: Ray,
    closest: Option<PrimitiveHit>,
}

/// A node that the ray enters at `t`.
struct Entered {
    t: f32,
    node: u32,
}

impl GraphSearch<'_> {
    /// Where the ray enters a node; without `volumes` it enters every node at its start.
    fn enter(&self, node: u32, probe: &mut impl Probe) -> Option<f32> {
        if self.savings.volumes { probe.enter(node, &self.ray) } else { Some(self.ray.t_min) }
    }

    /// Visits a node and the nodes below it.
    fn node(&mut self, node: u32, probe: &mut impl Probe) {
        // Test the node's own primitives.
        let node = &self.graph.nodes[node as usize];
        for &primitive in &node.primitives {
            let Some(t) = probe.hit(primitive, &self.ray) else { continue };
            let hit = PrimitiveHit { t, primitive };
            if self.savings.skip {
                keep_closest(&mut self.closest, &mut self.ray, hit);
            } else {
                self.closest = nearer(self.closest, Some(hit));
            }
        }
        // Collect the children that the ray enters, and sort them by their entry.
        let enter = |&child: &u32| Some(Entered { t: self.enter(child, probe)?, node: child });
        let mut entered: Vec<Entered> = node.children.iter().filter_map(enter).collect();
        if self.savings.sort {
            entered.sort_by(|first, second| first.t.total_cmp(&second.t));
        }
        for child in entered {
            // Skip a child that begins beyond the closest hit, which an earlier child may have
            // changed.
            if child.t < self.ray.t_max {
                self.node(child.node, probe);
            }
        }
    }
}
// </solution>
