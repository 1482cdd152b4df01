//! Stage 3 · bounding volume hierarchies: a tree of boxes, with which a ray tests only a small part of a scene.
//!
//! Slides: "Bounding Volume Hierarchy", "Object Median", "Spatial Median", "Surface Area Heuristic", the box
//! intersection with `t_b = t_x ∩ t_y ∩ t_z`, "Sort Bounding Volume Intersections".
//!
//! Given: [`Bvh`] with `add_node`, `set_leaf` and `set_children`; [`Probe`] with `open` (the contents of a node),
//! `enter` (the `t` at which the ray enters its box) and `hit` (the `t` at which the ray hits a primitive). The
//! searches take all boxes and hits from the probe, which also counts the calls.

use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::bvh::{Bvh, Contents, INTERSECTION_COST, PrimitiveHit, PrimitiveRef, Probe, TRAVERSAL_COST};
use raykata::ray::Ray;
use raykata::scene::Split;
use raykata::shape::{Sphere, Triangle};

/// The smallest box around a triangle.
///
/// Each side is exactly a coordinate of a corner. Boxes are closed, so a flat box needs no padding.
pub fn triangle_bounds(triangle: &Triangle) -> Aabb {
    // <solution>
    Aabb::new(triangle.a.min(triangle.b).min(triangle.c), triangle.a.max(triangle.b).max(triangle.c))
    // <stub> todo!("take the smallest and the largest coordinate on each axis")
    // </solution>
}

/// The box around a sphere: from `center - radius` to `center + radius` on each axis.
///
/// Each side may be off by the rounding of the sum or difference, and may lie up to two more floats outwards.
pub fn sphere_bounds(sphere: &Sphere) -> Aabb {
    // <solution>
    let (low, high) = (sphere.center - sphere.radius, sphere.center + sphere.radius);
    // Move each side one float outwards, because rounding to nearest may cut off a part of the sphere.
    Aabb::new(low.map(f32::next_down), high.map(f32::next_up))
    // <stub> todo!("go one radius from the centre on each axis")
    // </solution>
}

/// The smallest box around two boxes.
///
/// The union of a box and [`Aabb::EMPTY`] is the box. A coordinate that is NaN is ignored: the result has the
/// coordinate of the other box, so that a primitive with NaN does not change the boxes of other primitives.
///
/// Pitfall: `Vec3::min` and `Vec3::max` keep or drop a NaN depending on the order of the operands. `f32::min` and
/// `f32::max` always drop it.
pub fn union(first: &Aabb, second: &Aabb) -> Aabb {
    // <solution>
    // Use f32::min and f32::max on each axis, because they drop a NaN in either order.
    let pick = |choose: fn(f32, f32) -> f32, p: Vec3, q: Vec3| {
        Vec3::new(choose(p.x, q.x), choose(p.y, q.y), choose(p.z, q.z))
    };
    Aabb::new(pick(f32::min, first.min, second.min), pick(f32::max, first.max, second.max))
    // <stub> todo!("take the smaller min and the larger max")
    // </solution>
}

/// The middle of a box, which is the average of its corners.
pub fn centroid(bounds: &Aabb) -> Vec3 {
    // <solution>
    // Halve first, because the sum of two huge corners would overflow.
    0.5 * bounds.min + 0.5 * bounds.max
    // <stub> todo!("return the middle of the box")
    // </solution>
}

/// The surface area of a box: the sum of its six faces, in square world units. It is 0 for the empty box.
pub fn surface_area(bounds: &Aabb) -> f32 {
    // <solution>
    if bounds.is_empty() {
        return 0.0;
    }
    let size = bounds.max - bounds.min;
    2.0 * (size.x * size.y + size.y * size.z + size.z * size.x)
    // <stub> todo!("add up the six faces; return 0 for an empty box")
    // </solution>
}

/// Ray-box intersection by slabs: the `t` at which `ray` enters `bounds` and the `t` at which it leaves. The ray is
/// inside the box while it is between the two planes of each of the three axes (`t_b = t_x ∩ t_y ∩ t_z`).
///
/// Both results lie in `ray.t_min..=ray.t_max`, whose ends count here. A ray that starts inside enters at `t_min`.
/// The result is `None` if the ray misses the box within that range, and always for [`Aabb::EMPTY`]. The box is
/// closed: a ray that touches a face, an edge or a corner hits it, also a ray that runs within a face, and a box
/// without thickness can be hit. A ray that is aimed exactly at a corner must not miss by rounding, so the result may
/// be wider than the exact interval by a few roundings. That holds for `ray.t_min >= 0`.
///
/// `inverse_direction` is `1 / ray.direction`, which the caller computes once for many boxes. It is infinite on an axis
/// along which the ray does not move, with the sign of the zero. It is also infinite where a component of the direction
/// is so small that `1/d` overflows (below 2.9e-39).
///
/// Pitfall: `t_b⁻ ≥ 0` rejects every box that the ray starts in. "Corner cases are covered by IEEE" is wrong for
/// `0 · ∞`, which is NaN, and for a direction of -0.0. `<` instead of `≤` loses flat boxes. Rounding loses 6 of 100
/// rays that are aimed at a corner.
#[inline]
pub fn slab(ray: &Ray, inverse_direction: Vec3, bounds: &Aabb) -> Option<(f32, f32)> {
    // <solution>
    let (mut near, mut far) = (f32::NEG_INFINITY, f32::INFINITY);
    for axis in 0..3 {
        // Choose the plane that the ray passes first, by the sign bit and not by `< 0`: 1 / -0.0 is -∞, and the
        // planes must be swapped for it as well.
        let (first, last) = if inverse_direction[axis].is_sign_negative() {
            (bounds.max[axis], bounds.min[axis])
        } else {
            (bounds.min[axis], bounds.max[axis])
        };
        // Compute the t of both planes. Subtract first, because b/d - o/d would be ∞ - ∞ for d = 0.
        let enter = (first - ray.origin[axis]) * inverse_direction[axis];
        let leave = (last - ray.origin[axis]) * inverse_direction[axis];
        // Intersect the intervals. A NaN means that the ray runs within the plane of a face, which is inside: in this
        // order the comparison is false for NaN and changes nothing.
        if enter > near {
            near = enter;
        }
        if leave < far {
            far = leave;
        }
    }
    // Widen the interval by the rounding errors, and intersect it with the ray's range.
    let (near, far) = ((near * EARLIER).max(ray.t_min), (far * LATER).min(ray.t_max));
    (near <= far).then_some((near, far))
    // <stub> todo!("intersect the intervals of the three axes with the range of the ray")
    // </solution>
}

// <solution>
/// The factor by which `slab` enlarges the exit. Entry and exit have three roundings each (1/d, the difference, the
/// product), and each rounding has a relative error of at most `u = 2⁻²⁴`. Enlarging the exit by twice the bound
/// γ₃ = 3u / (1 - 3u) means that rounding loses no box (Ize, "Robust BVH Ray Traversal", JCGT 2013). Measured:
/// without this factor 6 of 100 rays that are aimed at corners miss.
const LATER: f32 = 1.0 + 2.0 * (3.0 * f32::EPSILON / 2.0);

/// The factor by which `slab` makes the entry smaller. A search compares the entry with the `t` of the best hit,
/// which is rounded in another way. Without this factor it may skip a box that contains a hit at the same `t`.
/// Measured: without it 1 of 500 rays in a room of flat walls, and 2 or 3 of 500 in a stadium with a small object,
/// find another triangle than brute force.
const EARLIER: f32 = 1.0 - 2.0 * (3.0 * f32::EPSILON / 2.0);
// </solution>

/// Object median split: order the primitives by centroid along the longest axis of the box around all of them, and
/// put half of them on each side.
///
/// `primitives` has at least two elements. The function reorders them and returns an index: the primitives before it
/// go to the left side, the others to the right side. The sides hold n / 2 primitives each; if n is odd, either side
/// may hold one more. Neither side may be empty. Equal centroids may go to either side. A centroid may be NaN, so
/// sort with `total_cmp`.
pub fn split_object_median(primitives: &mut [PrimitiveRef]) -> usize {
    // <solution>
    let axis = longest_axis(&bounds_of(primitives));
    // Move the smaller half to the front. A complete sort is not necessary. The id breaks ties, so that the same
    // scene always gives the same tree.
    let middle = primitives.len() / 2;
    primitives.select_nth_unstable_by(middle, |p, q| {
        p.centroid[axis].total_cmp(&q.centroid[axis]).then(p.id.cmp(&q.id))
    });
    middle
    // <stub> todo!("order the primitives by centroid along the longest axis and split in half")
    // </solution>
}

/// Spatial median split: cut the box around all primitives in the middle of its longest axis. Each primitive goes to
/// the side on which its centroid lies.
///
/// Input and result are as for [`split_object_median`]: neither side may be empty. A centroid exactly on the cut may
/// go to either side.
///
/// Pitfall: if all centroids are on one side, that side is the whole problem again, and the recursion never ends. Use
/// another split then, for example the object median.
pub fn split_spatial_median(primitives: &mut [PrimitiveRef]) -> usize {
    // <solution>
    // Find the middle of the longest axis.
    let bounds = bounds_of(primitives);
    let axis = longest_axis(&bounds);
    let cut = centroid(&bounds)[axis];

    // Swap each primitive below the cut to the front. `middle` counts them.
    let mut middle = 0;
    for i in 0..primitives.len() {
        if primitives[i].centroid[axis] < cut {
            primitives.swap(i, middle);
            middle += 1;
        }
    }
    // Use the object median if one side is empty.
    if middle == 0 || middle == primitives.len() {
        return split_object_median(primitives);
    }
    middle
    // <stub> todo!("cut the box in the middle of its longest axis; handle the case that all go to one side")
    // </solution>
}

/// Surface area heuristic: sort the primitives by centroid along each of the three axes, try all n - 1 cuts of each
/// order, and take the cut with the smallest `A(L) n(L) + A(R) n(R)`. `A` is the surface area of the box around a
/// side, `n` the number of its primitives, and P the parent with all primitives.
///
/// Input and index are as for [`split_object_median`]. The function returns `None` for a leaf, if no cut is cheaper:
/// `TRAVERSAL_COST · A(P) + INTERSECTION_COST · (A(L) n(L) + A(R) n(R)) ≥ INTERSECTION_COST · A(P) n(P)`. Of cuts
/// with equal cost any one is right. For boxes without area all costs are 0, and both a leaf and any cut are right.
///
/// Pitfall: the slide divides by `A(P)`, which is 0 for primitives in a line, and 0/0 is NaN. Multiply the whole
/// comparison by `A(P)` instead. The slide also leaves out the two costs, without which no leaf is ever cheaper.
pub fn split_surface_area(primitives: &mut [PrimitiveRef]) -> Option<usize> {
    // <solution>
    // Find the cheapest cut of all three axes: its cost, axis and index.
    let mut best: Option<(f32, usize, usize)> = None;
    for axis in 0..3 {
        sort_along(primitives, axis);

        // Compute the areas of all right sides in one pass: area_right[i] belongs to the box around primitives[i..].
        let mut area_right = vec![0.0; primitives.len()];
        let mut right = Aabb::EMPTY;
        for (i, primitive) in primitives.iter().enumerate().rev() {
            right = union(&right, &primitive.bounds);
            area_right[i] = surface_area(&right);
        }

        // Compute the cost of each cut while the left box grows, and keep the cheapest cut.
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

    // Return None if a leaf is not more expensive than the cut. A NaN gives a leaf, too.
    let (cost, axis, middle) = best?;
    let area = surface_area(&bounds_of(primitives));
    let as_leaf = INTERSECTION_COST * area * primitives.len() as f32;
    if !(TRAVERSAL_COST * area + INTERSECTION_COST * cost < as_leaf) {
        return None;
    }
    // Sort along the best axis again, because the last sort was along z.
    sort_along(primitives, axis);
    Some(middle)
    // <stub> todo!("find the cut with the least A(L) n(L) + A(R) n(R) over all three axes")
    // </solution>
}

// <solution>
/// The box around all primitives.
fn bounds_of(primitives: &[PrimitiveRef]) -> Aabb {
    primitives.iter().fold(Aabb::EMPTY, |all, primitive| union(&all, &primitive.bounds))
}

/// The axis along which a box is longest; of equal ones the first.
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

/// Sorts by centroid along an axis. The id breaks ties.
fn sort_along(primitives: &mut [PrimitiveRef], axis: usize) {
    primitives.sort_unstable_by(|p, q| p.centroid[axis].total_cmp(&q.centroid[axis]).then(p.id.cmp(&q.id)));
}
// </solution>

/// Builds a hierarchy over the primitives with these boxes, from the top down: a node gets the box around its
/// primitives, and it becomes a leaf or its primitives are split in two.
///
/// Primitive `i` has the box `bounds[i]`. Each primitive is in exactly one leaf, and each box contains everything
/// below it. Each leaf holds at least 1 and at most `leaf_size` primitives. With both medians `leaf_size` primitives
/// or fewer become a leaf. With [`Split::SurfaceArea`] such a group is still split if that is cheaper than a leaf,
/// and a larger group for which no cut is cheaper is split by the object median. Without primitives the hierarchy has
/// no node. The build ends for any boxes, also if all centroids are equal. A box of NaN goes into some leaf and does
/// not change the boxes of other primitives.
///
/// Pitfall: the slide stops at `e - s < N_leaf`. With `N_leaf = 1` it splits a single primitive forever.
pub fn build(bounds: &[Aabb], split: Split, leaf_size: usize) -> Bvh {
    // <solution>
    // Collect number, box and centroid of each primitive.
    let mut primitives: Vec<PrimitiveRef> = bounds
        .iter()
        .enumerate()
        .map(|(id, bounds)| PrimitiveRef { id: id as u32, bounds: *bounds, centroid: centroid(bounds) })
        .collect();
    // Build the tree below the root, unless there is nothing to build.
    let mut bvh = Bvh::for_primitives(primitives.len());
    if !primitives.is_empty() {
        subdivide(&mut bvh, &mut primitives, split, leaf_size.max(1));
    }
    bvh
    // <stub> todo!("make a leaf if the primitives are few enough; otherwise split them and build both halves")
    // </solution>
}

// <solution>
/// Builds the tree below a new node over these primitives, at least one, and returns the number of the node.
fn subdivide(bvh: &mut Bvh, primitives: &mut [PrimitiveRef], split: Split, leaf_size: usize) -> u32 {
    // Add the node before its children. Then make it a leaf, or split the primitives and build both sides.
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

/// The index at which the split strategy divides the primitives; `None` for a leaf.
fn choose_split(primitives: &mut [PrimitiveRef], split: Split, leaf_size: usize) -> Option<usize> {
    let fits = primitives.len() <= leaf_size;
    match split {
        _ if primitives.len() == 1 => None,
        Split::ObjectMedian | Split::SpatialMedian if fits => None,
        Split::ObjectMedian => Some(split_object_median(primitives)),
        Split::SpatialMedian => Some(split_spatial_median(primitives)),
        Split::SurfaceArea => {
            let cheaper = split_surface_area(primitives);
            // If no cut is cheaper but a leaf may not hold so many primitives, use the object median.
            cheaper.or_else(|| (!fits).then(|| split_object_median(primitives)))
        }
    }
}
// </solution>

/// The closest hit by the simple search of the lecture: if the ray enters the box of a node, search both children and
/// keep the nearer hit.
///
/// The result is the hit with the smallest `t` in the ray's range, or `None`. Of two hits at the same `t` the smaller
/// primitive number wins. A node is opened only if the ray enters its box (`probe.enter` returns `Some`).
pub fn closest_hit_both(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    let root = bvh.root()?;
    closest_below(root, bvh, probe, ray)
    // <stub> todo!("ask both children of every box that the ray enters, and keep the nearer hit")
    // </solution>
}

// <solution>
/// The closest hit below `node`.
fn closest_below(node: u32, bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    // Return if the ray misses the box.
    probe.enter(node, ray)?;
    // Search both children of an inner node, or ask all primitives of a leaf. Keep the nearest hit.
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

/// The closest hit by the fast search: of two children search the nearer one first, and skip every box that begins
/// beyond the best hit so far.
///
/// The result is the same hit as that of [`closest_hit_both`], also for two hits at the same `t`. The search opens
/// far fewer nodes: it lowers `t_max` at each hit, and compares the farther child's entry with `t_max` again after it
/// has searched the nearer child. If the ray enters both children at the same `t`, either may be searched first.
///
/// Pitfall: boxes overlap, so a hit in the nearer child may lie behind a hit in the farther child. And if `t_max`
/// becomes exactly `t`, another hit at the same `t` is not reported, because the range is open.
pub fn closest_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    // Enter the root, and search below it with a copy of the ray whose range shrinks.
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
/// Searches below `node`, whose box the ray enters. Each hit lowers `ray.t_max`.
fn search(node: u32, bvh: &Bvh, probe: &mut impl Probe, ray: &mut Ray, closest: &mut Option<PrimitiveHit>) {
    match probe.open(node) {
        Contents::Leaf { first, count } => {
            // Ask all primitives of the leaf.
            for &primitive in bvh.primitives(first, count) {
                let Some(t) = probe.hit(primitive, ray) else { continue };
                *closest = nearer(*closest, Some(PrimitiveHit { t, primitive }));
                // Set t_max one float above t, so that a primitive at exactly the same t is still reported.
                ray.t_max = t.next_up().min(ray.t_max);
            }
        }
        Contents::Inner { left, right } => match (probe.enter(left, ray), probe.enter(right, ray)) {
            (Some(enter_left), Some(enter_right)) => {
                // Search the nearer child. Then search the farther one unless its box begins beyond the best hit.
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

/// Whether any primitive is hit within the ray's range. A shadow ray needs no more than that.
///
/// The search stops at the first hit: after it, no further primitive is tested. A node is opened only if the ray
/// enters its box.
///
/// Pitfall: to enter a box is not yet a hit.
pub fn any_hit(bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> bool {
    // <solution>
    bvh.root().is_some_and(|root| any_below(root, bvh, probe, ray))
    // <stub> todo!("like closest_hit_both, but stop at the first hit")
    // </solution>
}

// <solution>
/// Whether any primitive below `node` is hit.
fn any_below(node: u32, bvh: &Bvh, probe: &mut impl Probe, ray: &Ray) -> bool {
    // Return if the ray misses the box.
    if probe.enter(node, ray).is_none() {
        return false;
    }
    // Stop at the first hit: `||` and `any` do not evaluate the rest.
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
