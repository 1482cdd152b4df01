//! Stage 9 · the BSP tree: planes of any direction divide space, above all the planes of the
//! polygons themselves.
//!
//! Slides: `slides/stage09.md`.
//!
//! Given: [`Bsp`] with `add_node`, `set_leaf` and `set_children`; [`CutPlane`] with `distance` and
//! `across`; [`ListGrowth`], whose `divide` returns `None` where all leaves together would list
//! more than [`MOST_REFERENCES`](raykata::partition::MOST_REFERENCES) references per primitive,
//! which is the most that is allowed. A hull is the list of corners of a polygon, or the eight
//! corners of a box.
//!
//! A search returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller
//! primitive number wins. A hit may lie outside the leaf that lists its primitive. Without a hit or
//! a node, the result is `None`.

// <solution>
use crate::stage9_cells::{may_stop_before, near_and_far, range, test_cell};
// <stub> use crate::stage9_cells::{ROUNDING, may_stop_before, part_above, range, test_cell};
// </solution>
use glam::{DVec3, Vec3};
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Bsp, BspNode, Cells, CutPlane, ListGrowth};
use raykata::ray::Ray;

/// Planes of any direction divide space. Candidates are the planes of the polygons and, because
/// those of a convex body do not divide it, one across the longest extent through the median
/// centre. What if many polygons lie in one plane, or around one line?
///
/// Exactly:
///
/// 1. Choose a plane that leaves few primitives on its fuller side, and few on both.
/// 2. Make a leaf of at most `leaf_size` primitives, at `max_depth` (the root is at depth 0), if no
///    plane leaves fewer primitives on each side and less than 60 % of them on both, or if
///    [`ListGrowth::divide`] returns `None`.
/// 3. List a primitive once in every leaf that it overlaps; one that touches a plane is on both
///    sides.
/// 4. Leave out hulls without corners. Without a usable hull there are no nodes.
///
/// Source: "Binary Space Partition (BSP) Tree".
pub fn build(hulls: &[Vec<Vec3>], leaf_size: usize, max_depth: usize) -> Bsp {
    // <solution>
    // Leave out hulls that have no corner or a corner that is not finite.
    let usable = |hull: &[Vec3]| !hull.is_empty() && hull.iter().all(|corner| corner.is_finite());
    let ids: Vec<u32> = (0..hulls.len() as u32).filter(|&id| usable(&hulls[id as usize])).collect();
    let corners: Vec<DVec3> = ids.iter().flat_map(|&id| &hulls[id as usize]).map(|p| p.as_dvec3()).collect();
    let low = corners.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = corners.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);

    let mut bsp = Bsp::default();
    if !ids.is_empty() {
        let scene = Scene { hulls, room: room(low, high), leaf_size, max_depth };
        divide(&mut bsp, &scene, &ids, (0, ListGrowth::ROOT));
    }
    bsp
    // <stub> todo!("make a leaf if the primitives are few; else choose a plane and build both sides")
    // </solution>
}

// <solution>
/// How far from a plane a corner still counts as on it, as much as `padded_boxes` allows for
/// rounding: 2⁻¹⁸ of the extent from `low` to `high`, and at least 2⁻²² of the largest coordinate.
pub(crate) fn room(low: DVec3, high: DVec3) -> f64 {
    let extent = (high - low).max_element() * (-18f64).exp2();
    extent.max(low.abs().max(high.abs()).max_element() * (-22f64).exp2())
}

/// The plane of the first corner of a polygon, with the polygon's normal; `None` if it has no area.
pub(crate) fn newell_plane(corners: &[DVec3]) -> Option<CutPlane> {
    // Compute the normal by Newell's method: the sum over the edges is twice the area times the
    // normal, also if some corners lie in a line.
    let edges = corners.iter().zip(corners.iter().cycle().skip(1));
    let doubled = edges.map(|(p, q)| (*p - corners[0]).cross(*q - corners[0])).sum::<DVec3>();
    let normal = doubled.try_normalize()?;
    Some(CutPlane { normal, offset: normal.dot(corners[0]) })
}

/// The plane across `axis` between the two middle ones of these centres.
pub(crate) fn median_plane(axis: usize, mut centers: Vec<f64>) -> CutPlane {
    centers.sort_by(f64::total_cmp);
    let (p, q) = (centers[(centers.len() - 1) / 2], centers[centers.len() / 2]);
    CutPlane::across(axis, 0.5 * (p + q))
}

struct Scene<'a> {
    hulls: &'a [Vec<Vec3>],
    room: f64,
    leaf_size: usize,
    max_depth: usize,
}

impl Scene<'_> {
    /// The primitives that reach behind the plane, and those that reach in front of it.
    fn sides(&self, ids: &[u32], plane: &CutPlane) -> [Vec<u32>; 2] {
        let reaches = |id: u32, side: f64| {
            self.hulls[id as usize].iter().any(|corner| side * plane.distance(*corner) >= -self.room)
        };
        [-1.0, 1.0].map(|side| ids.iter().copied().filter(|&id| reaches(id, side)).collect())
    }

    /// The plane of a hull, if all its corners lie in one.
    fn plane_of(&self, id: u32) -> Option<CutPlane> {
        let hull: Vec<DVec3> = self.hulls[id as usize].iter().map(|corner| corner.as_dvec3()).collect();
        let plane = newell_plane(&hull)?;
        // Refuse a hull of which a corner lies off the plane.
        self.hulls[id as usize]
            .iter()
            .all(|corner| plane.distance(*corner).abs() <= self.room)
            .then_some(plane)
    }

    /// The planes to choose from: those of up to sixteen polygons, and one across the longest
    /// extent.
    fn candidates(&self, ids: &[u32]) -> Vec<CutPlane> {
        // Take at most sixteen polygons, spread over the list, because testing each plane against
        // all takes too long.
        let step = ids.len().div_ceil(16);
        let of_polygons = ids.iter().step_by(step).filter_map(|&id| self.plane_of(id));
        // Choose the axis of the longest extent: repeated cuts across one axis make thin slices,
        // and a ray crosses them all.
        let hull =
            |id: u32, axis: usize| self.hulls[id as usize].iter().map(move |corner| f64::from(corner[axis]));
        let extent = |axis: usize| {
            let all = || ids.iter().flat_map(|&id| hull(id, axis));
            all().fold(f64::NEG_INFINITY, f64::max) - all().fold(f64::INFINITY, f64::min)
        };
        let longest = (0..3).max_by(|&p, &q| extent(p).total_cmp(&extent(q)));
        let across = longest.map(|axis| {
            let center = |id: u32| hull(id, axis).sum::<f64>() / self.hulls[id as usize].len() as f64;
            median_plane(axis, ids.iter().map(|&id| center(id)).collect())
        });
        of_polygons.chain(across).collect()
    }

    /// The plane that leaves the fewest primitives on its fuller side, where each primitive on both
    /// sides counts as [`STRADDLER`] more; `None` if no plane divides the primitives.
    fn choose(&self, ids: &[u32]) -> Option<(CutPlane, [Vec<u32>; 2])> {
        let cuts = self.candidates(ids).into_iter().map(|plane| (plane, self.sides(ids, &plane)));
        let on_both = |[back, front]: &[Vec<u32>; 2]| back.len() + front.len() - ids.len();
        let fuller = |[back, front]: &[Vec<u32>; 2]| back.len().max(front.len());
        let divides =
            |sides: &[Vec<u32>; 2]| fuller(sides) < ids.len() && 10 * on_both(sides) < 6 * ids.len();
        cuts.filter(|(_, sides)| divides(sides))
            .min_by_key(|(_, sides)| fuller(sides) + STRADDLER * on_both(sides))
    }
}

/// The cost of a primitive on both sides, relative to one on the fuller side. With 0, 8 and 30 a
/// ray makes fewer and fewer visits (`raykata compare scenes/showcase.toml --only bsp` counts
/// them).
const STRADDLER: usize = 30;

fn divide(bsp: &mut Bsp, scene: &Scene<'_>, ids: &[u32], (depth, growth): (usize, ListGrowth)) -> u32 {
    // Choose a plane, unless the node must be a leaf; then build both sides.
    let node = bsp.add_node(depth, scene.max_depth);
    let divided = ids.len() > scene.leaf_size && depth < scene.max_depth;
    let chosen = divided.then(|| scene.choose(ids)).flatten().and_then(|(plane, sides)| {
        // Refuse the plane if the two sides repeat too many primitives.
        let growth = growth.divide(ids.len(), sides[0].len() + sides[1].len())?;
        Some((plane, sides, growth))
    });
    match chosen {
        None => bsp.set_leaf(node, ids),
        Some((plane, [behind, before], growth)) => {
            let back = divide(bsp, scene, &behind, (depth + 1, growth));
            let front = divide(bsp, scene, &before, (depth + 1, growth));
            bsp.set_children(node, plane, back, front);
        }
    }
    node
}
// </solution>

/// At each plane, search the side of the ray's origin first and the other side second, each with
/// the part of the ray that is on it. The slide returns `no_intersection` if `t < min_t` or
/// `t < max_t`. Where is a ray that ends before the plane?
///
/// Exactly:
///
/// 1. Visit a node at most once, and only if the ray enters it before the best hit.
/// 2. A ray in the plane, or that starts on it, is on both sides: a primitive in the plane may be
///    listed on one side only. Its computed height may be a rounding error in place of 0.
///
/// Source: "Binary Space Partition (BSP) Tree".
pub fn closest_hit(bsp: &Bsp, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    if bsp.nodes.is_empty() {
        return None;
    }
    let mut ray = *ray;
    let mut best = None;
    search(bsp, 0, range(&ray), probe, &mut ray, &mut best);
    best
    // <stub> todo!("search the near side of each plane first, then the far side unless the best hit is before it")
    // </solution>
}

// <solution>
fn search(
    bsp: &Bsp,
    node: u32,
    part: (f64, f64),
    probe: &mut impl Cells,
    ray: &mut Ray,
    best: &mut Option<PrimitiveHit>,
) {
    // Stop if the best hit lies before this node.
    if may_stop_before(best, part.0) {
        return;
    }
    probe.visit(node);
    match bsp.nodes[node as usize] {
        BspNode::Leaf { first, count } => test_cell(bsp.primitives(first, count), probe, ray, best),
        BspNode::Inner { plane, back, front } => {
            // A ray that does not cross the plane is on one side along its whole length.
            // Find the part of the ray on each side, and search the nearer side first.
            let in_order = near_and_far(&plane, [back, front], 0.0, ray, part);
            for (child, part) in in_order.into_iter().flatten() {
                search(bsp, child, part, probe, ray, best);
            }
        }
    }
}
// </solution>
