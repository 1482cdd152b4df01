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
    // <solution>
    Ray {
        // Far from the origin large terms cancel here: in double nothing of the small rest is lost.
        origin: to_object.as_daffine3().transform_point3(ray.origin.as_dvec3()).as_vec3(),
        direction: to_object.transform_vector3(ray.direction),
        ..*ray
    }
    // <stub> todo!("carry the origin as a point and the direction as a vector; leave its length alone")
    // </solution>
}

/// The unit normal in the world of a surface whose normal in its own space is `normal`: through the transpose of
/// `to_object`, the inverse transpose of the way to the world. Outside stays outside, in a mirror, too.
pub fn normal_to_world(normal: Vec3, to_object: &Affine3A) -> Vec3 {
    // <solution>
    let rows = to_object.as_daffine3().matrix3.transpose();
    (rows * normal.as_dvec3()).normalize_or_zero().as_vec3()
    // <stub> todo!("multiply by the transpose of to_object, then make it a unit vector")
    // </solution>
}

/// Where a node stands whose ancestors' transforms, from the root down to its own, are `path`: `M₁ M₂ … Mₙ` to the world,
/// and `Mₙ⁻¹ … M₂⁻¹ M₁⁻¹` back. `None` if one of them cannot be undone.
pub fn placement(path: &[Affine3A]) -> Option<Placement> {
    // <solution>
    let (mut to_world, mut to_object) = (DAffine3::IDENTITY, DAffine3::IDENTITY);
    for to_parent in path {
        let to_parent = to_parent.as_daffine3();
        let from_parent = to_parent.inverse();
        if to_parent.matrix3.determinant() == 0.0 || !from_parent.is_finite() {
            return None;
        }
        to_world *= to_parent;
        to_object = from_parent * to_object;
    }
    Some(Placement { to_world: to_world.as_affine3a(), to_object: to_object.as_affine3a() })
    // <stub> todo!("multiply the transforms from the root down, and the inverses the other way round")
    // </solution>
}

/// A box around `bounds` after the transform `to_world`, with no point of it outside and little room: its eight corners,
/// rounded outwards. The empty box stays empty.
///
/// Where the formula lies: rounded to nearest, the largest corner ends up inside the true box in half of all cases, and
/// a ray at it misses.
pub fn bounds_to_world(to_world: &Affine3A, bounds: &Aabb) -> Aabb {
    // <solution>
    if bounds.min.cmpgt(bounds.max).any() {
        return Aabb::EMPTY;
    }
    let columns = [to_world.matrix3.x_axis, to_world.matrix3.y_axis, to_world.matrix3.z_axis].map(Vec3::from);
    let translation = Vec3::from(to_world.translation);
    let (mut min, mut max) = (Vec3::ZERO, Vec3::ZERO);
    for row in 0..3 {
        // Each axis of the box goes to one end or the other (Arvo, "Transforming axis-aligned bounding boxes", 1990).
        let (mut low, mut high) = (f64::from(translation[row]), f64::from(translation[row]));
        for (axis, column) in columns.iter().enumerate() {
            let factor = f64::from(column[row]);
            let ends = [factor * f64::from(bounds.min[axis]), factor * f64::from(bounds.max[axis])];
            low += ends[0].min(ends[1]);
            high += ends[0].max(ends[1]);
        }
        // Rounding to single precision may go inwards, one step at most; the sums in double by much less.
        min[row] = (low as f32).next_down();
        max[row] = (high as f32).next_up();
    }
    Aabb::new(min, max)
    // <stub> todo!("transform what matters of the eight corners, and round outwards")
    // </solution>
}

/// A sphere that holds all of `points`, one or more. It need not be the smallest, but no radius may be more than twice as
/// large as that: around the middle of their box is small enough.
pub fn bounding_sphere(points: &[Vec3]) -> Sphere {
    // <solution>
    let min = points.iter().fold(Vec3::INFINITY, |low, point| low.min(*point));
    let max = points.iter().fold(Vec3::NEG_INFINITY, |high, point| high.max(*point));
    let center = 0.5 * min + 0.5 * max;
    let distance = |point: &Vec3| point.as_dvec3().distance(center.as_dvec3());
    let radius = points.iter().map(distance).fold(0.0, f64::max);
    Sphere { center, radius: (radius as f32).next_up() }
    // <stub> todo!("take a centre, and the largest distance from it, rounded up")
    // </solution>
}

/// Where `ray` enters the sphere, within `t_min..=t_max`: at `t_min` if it starts inside; `None` if it does not come into
/// it. The like of the slab test for spheres.
pub fn enter_bounding_sphere(ray: &Ray, sphere: &Sphere) -> Option<f32> {
    // <solution>
    let (direction, to_center) = (ray.direction.as_dvec3(), sphere.center.as_dvec3() - ray.origin.as_dvec3());
    let radius = f64::from(sphere.radius);
    // The line comes closest to the centre at t = b / a, and |to_center × direction|² / a is the square of that distance.
    let (a, b) = (direction.length_squared(), to_center.dot(direction));
    let reach = a * radius * radius - to_center.cross(direction).length_squared();
    if !(reach >= 0.0) {
        return None;
    }
    let (enter, leave) = ((b - reach.sqrt()) / a, (b + reach.sqrt()) / a);
    let enter = ((enter - ROOM * enter.abs()) as f32).max(ray.t_min);
    let leave = ((leave + ROOM * leave.abs()) as f32).min(ray.t_max);
    (enter <= leave).then_some(enter)
    // <stub> todo!("the nearer root, or t_min from inside; nothing if the ray passes or ends before")
    // </solution>
}

// <solution>
/// The way in is compared with the `t` of hits, which is rounded in another way: four roundings earlier, no sphere is skipped
/// that holds a hit at the very `t` of the best one.
const ROOM: f64 = 4.0 * f32::EPSILON as f64;
// </solution>

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
    // <solution>
    let mut search = GraphSearch { graph, savings, ray: *ray, closest: None };
    if !graph.nodes.is_empty() && search.enter(0, probe).is_some() {
        search.node(0, probe);
    }
    search.closest
    // <stub> todo!("hit the node's primitives, then look into the children that are worth it")
    // </solution>
}

// <solution>
struct GraphSearch<'a> {
    graph: &'a Graph,
    savings: Savings, // which questions not to ask
    /// With `skip`, its range ends at the closest hit.
    ray: Ray,
    closest: Option<PrimitiveHit>,
}

impl GraphSearch<'_> {
    fn enter(&self, node: u32, probe: &mut impl Probe) -> Option<f32> {
        if self.savings.volumes { probe.enter(node, &self.ray) } else { Some(self.ray.t_min) }
    }

    fn node(&mut self, node: u32, probe: &mut impl Probe) {
        let node = &self.graph.nodes[node as usize];
        for &primitive in &node.primitives {
            let Some(t) = probe.hit(primitive, &self.ray) else { continue };
            if self.closest.is_none_or(|best| (t, primitive) < (best.t, best.primitive)) {
                self.closest = Some(PrimitiveHit { t, primitive });
            }
            if self.savings.skip {
                // One step beyond t, so that another primitive at the very same t is still heard.
                self.ray.t_max = t.next_up().min(self.ray.t_max);
            }
        }
        let mut entered: Vec<(f32, u32)> =
            node.children.iter().filter_map(|&child| Some((self.enter(child, probe)?, child))).collect();
        if self.savings.sort {
            entered.sort_by(|first, second| first.0.total_cmp(&second.0));
        }
        for (enter, child) in entered {
            // A hit in an earlier child may have made this one too far.
            if enter < self.ray.t_max {
                self.node(child, probe);
            }
        }
    }
}
// </solution>
