//! Stage 3 · bounding volume hierarchies: boxes in boxes, so that most of a scene is never tested.
//!
//! Slides: "Bounding Volume Hierarchy", "Object Median", "Spatial Median", "Surface Area Heuristic", the box
//! intersection with `t_b = t_x ∩ t_y ∩ t_z`, "Sort Bounding Volume Intersections". A stage is one file, however long.
//!
//! Given: [`Bvh`] with `add_node`, `set_leaf` and `set_children`; [`Probe`] with `open` (what a node holds), `enter`
//! (where the ray enters its box) and `hit` (where it hits a primitive). Searches ask the probe and nothing else.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, INTERSECTION_COST, PrimitiveHit, PrimitiveRef, Probe, TRAVERSAL_COST};
use raykata::ray::Ray;
use raykata::scene::Split;
use raykata::shape::{Sphere, Triangle};

/// The smallest box around a triangle. No padding: a flat box is a box.
pub fn triangle_bounds(triangle: &Triangle) -> Aabb {
    // <solution>
    Aabb::new(triangle.a.min(triangle.b).min(triangle.c), triangle.a.max(triangle.b).max(triangle.c))
    // <stub> todo!("take the smallest and the largest coordinate on each axis")
    // </solution>
}

/// A box around a sphere, tight to a rounding.
pub fn sphere_bounds(sphere: &Sphere) -> Aabb {
    // <solution>
    let (low, high) = (sphere.center - sphere.radius, sphere.center + sphere.radius);
    // Rounding to nearest may cut a sliver off the sphere; one step outwards puts it back.
    Aabb::new(low.map(f32::next_down), high.map(f32::next_up))
    // <stub> todo!("go one radius from the centre on each axis")
    // </solution>
}

/// The smallest box around two boxes. [`Aabb::EMPTY`] changes nothing.
pub fn union(first: &Aabb, second: &Aabb) -> Aabb {
    // <solution>
    // f32::min and max drop a NaN; those of Vec3 keep or drop it depending on the order, and a broken primitive that
    // was kept would break the boxes of all others.
    let pick = |choose: fn(f32, f32) -> f32, p: Vec3, q: Vec3| {
        Vec3::new(choose(p.x, q.x), choose(p.y, q.y), choose(p.z, q.z))
    };
    Aabb::new(pick(f32::min, first.min, second.min), pick(f32::max, first.max, second.max))
    // <stub> todo!("take the smaller min and the larger max")
    // </solution>
}

/// The middle of a box.
pub fn centroid(bounds: &Aabb) -> Vec3 {
    // <solution>
    0.5 * bounds.min + 0.5 * bounds.max // halved first: the sum of two huge corners would overflow
    // <stub> todo!("return the middle of the box")
    // </solution>
}

/// The area of all six faces of a box; 0 for the empty box.
pub fn surface_area(bounds: &Aabb) -> f32 {
    // <solution>
    if bounds.is_empty() {
        return 0.0;
    }
    let size = bounds.max - bounds.min;
    2.0 * (size.x * size.y + size.y * size.z + size.z * size.x)
    // <stub> todo!("add up the six faces; an empty box has none")
    // </solution>
}

/// Where `ray` enters and leaves `bounds`, both within `ray.t_min..=ray.t_max`; `None` if it does neither. A ray that
/// starts inside enters at `t_min`. The box is closed: to touch it is to hit it. `inverse_direction` is `1 / ray.direction`, which
/// the caller computes once for many boxes; it is infinite on an axis along which the ray does not move.
///
/// Where the formula lies: `t_b⁻ ≥ 0` rejects every box that the ray starts in; "corner cases are covered by IEEE"
/// is untrue for `0 · ∞`, which is NaN, and for a direction of -0.0; `<` in place of `≤` loses flat boxes; and rounding
/// loses 6 of 100 rays that are aimed at a corner.
#[inline]
pub fn slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)> {
    // <solution>
    let (mut near, mut far) = (f32::NEG_INFINITY, f32::INFINITY);
    for axis in 0..3 {
        // The sign bit and not `< 0`: 1 / -0.0 is -∞, and the planes must swap for it, too.
        let (first, last) = if inverse_direction[axis].is_sign_negative() {
            (bounds.max[axis], bounds.min[axis])
        } else {
            (bounds.min[axis], bounds.max[axis])
        };
        let enter = (first - ray.origin[axis]) * inverse_direction[axis];
        let leave = (last - ray.origin[axis]) * inverse_direction[axis];
        // In this order a NaN changes nothing: the ray runs within the plane of a face, and that is inside.
        if enter > near {
            near = enter;
        }
        if leave < far {
            far = leave;
        }
    }
    let (near, far) = ((near * EARLIER).max(ray.t_min), (far * LATER).min(ray.t_max));
    (near <= far).then_some((near, far))
    // <stub> todo!("intersect the intervals of the three axes with the range of the ray")
    // </solution>
}

// <solution>
/// Both ends are results of three roundings (1/d, the difference, the product), each off by at most `u = 2⁻²⁴`. Making
/// the way out longer by twice their bound γ₃ = 3u / (1 - 3u) means that no box is missed by rounding (Ize, "Robust BVH
/// Ray Traversal", JCGT 2013). Measured: without this, 6 of 100 rays that are aimed at corners miss.
const LATER: f32 = 1.0 + 2.0 * (3.0 * f32::EPSILON / 2.0);

/// The way in is compared with the `t` of hits, which is rounded in another way: unless it is early by as much, a box is
/// skipped that holds a hit at the very `t` of the best one. Measured: without this, 1 of 500 rays in a room of flat walls
/// and 2 or 3 of 500 in a stadium with something small in it find another triangle than brute force.
const EARLIER: f32 = 1.0 - 2.0 * (3.0 * f32::EPSILON / 2.0);
// </solution>

/// Object median: sort along the longest axis of the box around all, and give each side half. Reorders `primitives`
/// so that those before the returned index go left. Two primitives or more; neither side may be empty.
pub fn split_object_median(primitives: &mut [PrimitiveRef]) -> usize {
    // <solution>
    let axis = longest_axis(&bounds_of(primitives));
    let middle = primitives.len() / 2;
    // Only the middle element has to find its place. The id breaks ties, so the same scene gives the same tree.
    primitives.select_nth_unstable_by(middle, |p, q| {
        p.centroid[axis].total_cmp(&q.centroid[axis]).then(p.id.cmp(&q.id))
    });
    middle
    // <stub> todo!("order the primitives by centroid along the longest axis and split in half")
    // </solution>
}

/// Spatial median: cut the box around all in the middle of its longest axis; a primitive goes where its centroid is.
/// Reorders and returns as [`split_object_median`] does.
///
/// Where the formula lies: when all centroids are on one side, that side is the whole problem again, and the
/// recursion never ends. Fall back on something that divides.
pub fn split_spatial_median(primitives: &mut [PrimitiveRef]) -> usize {
    // <solution>
    let bounds = bounds_of(primitives);
    let axis = longest_axis(&bounds);
    let cut = centroid(&bounds)[axis];

    let mut middle = 0;
    for i in 0..primitives.len() {
        if primitives[i].centroid[axis] < cut {
            primitives.swap(i, middle);
            middle += 1;
        }
    }
    if middle == 0 || middle == primitives.len() {
        return split_object_median(primitives);
    }
    middle
    // <stub> todo!("cut the box in the middle of its longest axis; mind the case that all go to one side")
    // </solution>
}

/// Surface area heuristic: of all ways to cut the primitives, sorted along some axis, in two, the one with the least
/// `A(L) n(L) + A(R) n(R)`. `None` if a leaf is cheaper than the best cut:
/// `TRAVERSAL_COST · A(P) + INTERSECTION_COST · (A(L) n(L) + A(R) n(R)) ≥ INTERSECTION_COST · A(P) n(P)`.
///
/// Where the formula lies: the slide divides by `A(P)`, which is 0 for primitives in a line, and 0/0 is NaN. Multiply
/// the whole comparison by `A(P)` instead. The slide also leaves out the two costs, without which no leaf ever wins.
pub fn split_surface_area(primitives: &mut [PrimitiveRef]) -> Option<usize> {
    // <solution>
    let mut best: Option<(f32, usize, usize)> = None; // cost, axis, middle
    for axis in 0..3 {
        sort_along(primitives, axis);

        // area_right[i] is the area of the box around primitives[i..].
        let mut area_right = vec![0.0; primitives.len()];
        let mut right = Aabb::EMPTY;
        for (i, primitive) in primitives.iter().enumerate().rev() {
            right = union(&right, &primitive.bounds);
            area_right[i] = surface_area(&right);
        }

        let mut left = Aabb::EMPTY;
        for middle in 1..primitives.len() {
            left = union(&left, &primitives[middle - 1].bounds);
            let n_left = middle as f32;
            let n_right = (primitives.len() - middle) as f32;
            let cost = surface_area(&left) * n_left + area_right[middle] * n_right;
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, middle));
            }
        }
    }

    let (cost, axis, middle) = best?;
    let area = surface_area(&bounds_of(primitives));
    let as_leaf = INTERSECTION_COST * area * primitives.len() as f32;
    if !(TRAVERSAL_COST * area + INTERSECTION_COST * cost < as_leaf) {
        return None;
    }
    sort_along(primitives, axis);
    Some(middle)
    // <stub> todo!("find the cut with the least A(L) n(L) + A(R) n(R) over all three axes")
    // </solution>
}

// <solution>
fn bounds_of(primitives: &[PrimitiveRef]) -> Aabb {
    primitives.iter().fold(Aabb::EMPTY, |all, primitive| union(&all, &primitive.bounds))
}

fn longest_axis(bounds: &Aabb) -> usize {
    let size = bounds.max - bounds.min;
    if size.x >= size.y && size.x >= size.z {
        0
    } else if size.y >= size.z {
        1
    } else {
        2
    }
}

fn sort_along(primitives: &mut [PrimitiveRef], axis: usize) {
    primitives.sort_unstable_by(|p, q| p.centroid[axis].total_cmp(&q.centroid[axis]).then(p.id.cmp(&q.id)));
}
// </solution>

/// Builds a hierarchy over primitives with these boxes, from the top down. No leaf holds more than `leaf_size`.
/// With [`Split::SurfaceArea`] a smaller group is still divided if that is cheaper than a leaf.
///
/// Where the formula lies: the slide stops at `e - s < N_leaf`, so with `N_leaf = 1` it divides single primitives for
/// ever.
pub fn build(bounds: &[Aabb], split: Split, leaf_size: usize) -> Bvh {
    // <solution>
    let mut primitives: Vec<PrimitiveRef> = bounds
        .iter()
        .enumerate()
        .map(|(id, bounds)| PrimitiveRef { id: id as u32, bounds: *bounds, centroid: centroid(bounds) })
        .collect();
    let mut bvh = Bvh::for_primitives(primitives.len());
    if !primitives.is_empty() {
        subdivide(&mut bvh, &mut primitives, split, leaf_size.max(1));
    }
    bvh
    // <stub> todo!("make a leaf if the primitives are few enough; else split them and build both halves")
    // </solution>
}

// <solution>
fn subdivide(bvh: &mut Bvh, primitives: &mut [PrimitiveRef], split: Split, leaf_size: usize) -> u32 {
    let node = bvh.add_node(bounds_of(primitives));
    match choose_split(primitives, split, leaf_size) {
        None => bvh.set_leaf(node, primitives),
        Some(middle) => {
            let (below, above) = primitives.split_at_mut(middle);
            let left = subdivide(bvh, below, split, leaf_size);
            let right = subdivide(bvh, above, split, leaf_size);
            bvh.set_children(node, left, right);
        }
    }
    node
}

fn choose_split(primitives: &mut [PrimitiveRef], split: Split, leaf_size: usize) -> Option<usize> {
    let fits = primitives.len() <= leaf_size;
    match split {
        _ if primitives.len() == 1 => None,
        Split::ObjectMedian | Split::SpatialMedian if fits => None,
        Split::ObjectMedian => Some(split_object_median(primitives)),
        Split::SpatialMedian => Some(split_spatial_median(primitives)),
        Split::SurfaceArea => {
            let cheaper = split_surface_area(primitives);
            // No cut pays, but a leaf may not hold so many: divide by count.
            cheaper.or_else(|| (!fits).then(|| split_object_median(primitives)))
        }
    }
}
// </solution>

/// The closest hit, the way of the lecture: enter a box, ask both children, keep the nearer answer. Of two hits at the
/// same `t` the smaller primitive number wins.
pub fn closest_hit_both(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    let root = bvh.root()?;
    closest_below(root, bvh, probe, ray)
    // <stub> todo!("ask both children of every box that the ray enters, and keep the nearer hit")
    // </solution>
}

// <solution>
fn closest_below(node: u32, bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    probe.enter(node, ray)?;
    match probe.open(node) {
        Contents::Inner { left, right } => {
            let in_left = closest_below(left, bvh, probe, ray);
            let in_right = closest_below(right, bvh, probe, ray);
            nearer(in_left, in_right)
        }
        Contents::Leaf { first, count } => bvh
            .primitives(first, count)
            .iter()
            .filter_map(|&primitive| probe.hit(primitive, ray).map(|t| PrimitiveHit { t, primitive }))
            .fold(None, |closest, hit| nearer(closest, Some(hit))),
    }
}

/// The hit with the smaller `t`; at the same `t` the one with the smaller primitive number.
fn nearer(first: Option<PrimitiveHit>, second: Option<PrimitiveHit>) -> Option<PrimitiveHit> {
    match (first, second) {
        (Some(p), Some(q)) => Some(if (q.t, q.primitive) < (p.t, p.primitive) { q } else { p }),
        (one, other) => one.or(other),
    }
}
// </solution>

/// The closest hit, the fast way: of two children enter the nearer one first, and skip a box that begins beyond the
/// best hit so far. Finds the same hit as [`closest_hit_both`] with a fraction of the visits.
pub fn closest_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    let root = bvh.root()?;
    let mut ray = *ray;
    let mut closest = None;
    probe.enter(root, &ray)?;
    search(root, bvh, probe, &mut ray, &mut closest);
    closest
    // <stub> todo!("enter the nearer child first, and skip boxes beyond the best hit")
    // </solution>
}

// <solution>
/// Searches below `node`, whose box the ray is known to enter. `ray.t_max` shrinks with every hit.
fn search(node: u32, bvh: &Bvh, probe: &mut impl Probe, ray: &mut Ray, closest: &mut Option<PrimitiveHit>) {
    match probe.open(node) {
        Contents::Leaf { first, count } => {
            for &primitive in bvh.primitives(first, count) {
                let Some(t) = probe.hit(primitive, ray) else { continue };
                *closest = nearer(*closest, Some(PrimitiveHit { t, primitive }));
                // One step beyond t, so that another primitive at the very same t is still heard.
                ray.t_max = t.next_up().min(ray.t_max);
            }
        }
        Contents::Inner { left, right } => match (probe.enter(left, ray), probe.enter(right, ray)) {
            (Some(enter_left), Some(enter_right)) => {
                let (near, far, enter_far) = if enter_left <= enter_right {
                    (left, right, enter_right)
                } else {
                    (right, left, enter_left)
                };
                search(near, bvh, probe, ray, closest);
                if enter_far < ray.t_max {
                    search(far, bvh, probe, ray, closest);
                }
            }
            (Some(_), None) => search(left, bvh, probe, ray, closest),
            (None, Some(_)) => search(right, bvh, probe, ray, closest),
            (None, None) => {}
        },
    }
}
// </solution>

/// Whether anything is hit within the ray's range: all that a shadow ray wants to know. Stops at the first hit.
pub fn any_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> bool {
    // <solution>
    bvh.root().is_some_and(|root| any_below(root, bvh, probe, ray))
    // <stub> todo!("like closest_hit_both, but stop at the first hit")
    // </solution>
}

// <solution>
fn any_below(node: u32, bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> bool {
    if probe.enter(node, ray).is_none() {
        return false;
    }
    match probe.open(node) {
        Contents::Inner { left, right } => {
            any_below(left, bvh, probe, ray) || any_below(right, bvh, probe, ray)
        }
        Contents::Leaf { first, count } => {
            bvh.primitives(first, count).iter().any(|&primitive| probe.hit(primitive, ray).is_some())
        }
    }
}
// </solution>
