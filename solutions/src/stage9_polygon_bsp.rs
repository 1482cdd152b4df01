//! Stage 9 · the BSP tree of the slide: the polygons lie in its nodes, and a polygon that crosses a
//! plane is split.
//!
//! Slides: `slides/stage09.md`.
//!
//! Given: [`PolygonBsp`] with `add_node`, `set_leaf` and `set_children`; [`CutPlane`] with
//! `distance`, `across` and `keep`, which clips a polygon; [`ListGrowth`], whose `divide` returns
//! `None` where all nodes together would list more than
//! [`MOST_REFERENCES`](raykata::partition::MOST_REFERENCES) references per primitive, which is the
//! most that is allowed. A hull of three to seven corners that lie in one plane is a convex
//! polygon, with its corners in order. Every other hull is a solid: the eight corners of a box, or
//! corners without a plane.
//!
//! A search returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller
//! primitive number wins. A hit may lie outside the leaf that lists its primitive. Without a hit or
//! a node, the result is `None`.

// <solution>
use crate::stage9_bsp::{median_plane, newell_plane, room};
use crate::stage9_cells::{may_stop_before, near_and_far, range, test_cell};
// <stub> use crate::stage9_cells::{ROUNDING, may_stop_before, part_above, range, test_cell};
// </solution>
use glam::{DVec3, Vec3};
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cells, CutPlane, ListGrowth, PolygonBsp, PolygonBspNode};
use raykata::ray::Ray;

/// Each node holds the polygons on its plane; those that cross it are split. The planes of a convex
/// body have all its polygons on one side: what does their tree look like?
///
/// Exactly:
///
/// 1. A plane is that of a polygon, or across an axis. Prefer one that splits few polygons and
///    leaves few primitives on its fuller side.
/// 2. A node lists all polygons in its plane, and no solids.
/// 3. A point within [`PolygonBsp::room`] of a plane counts as on it; choose it from 0 to a 1000th
///    of the largest coordinate. Clip at the plane itself.
/// 4. Pass each part to its side, and a solid to each side that it reaches.
/// 5. Every part of every polygon lies on the plane of a node that lists it, and a leaf lists at
///    most `leaf_size` solids, or those that no plane divides. Exceptions: at `max_depth` (root:
///    0), and where [`ListGrowth::divide`] returns `None`.
/// 6. Leave out hulls without corners. Without a usable hull there are no nodes.
///
/// Source: Fuchs et al., SIGGRAPH 1980.
pub fn build(hulls: &[Vec<Vec3>], leaf_size: usize, max_depth: usize) -> PolygonBsp {
    // <solution>
    // Leave out hulls that have no corner or a corner that is not finite.
    let usable = |hull: &[Vec3]| !hull.is_empty() && hull.iter().all(|corner| corner.is_finite());
    let ids = (0..hulls.len() as u32).filter(|&id| usable(&hulls[id as usize]));
    let corners = || hulls.iter().filter(|hull| usable(hull)).flatten().map(|corner| corner.as_dvec3());
    let low = corners().fold(DVec3::INFINITY, DVec3::min);
    let high = corners().fold(DVec3::NEG_INFINITY, DVec3::max);
    let room = room(low, high);

    // Find the plane of each hull, and divide the hulls.
    let part = |id: u32| {
        let corners: Vec<DVec3> = hulls[id as usize].iter().map(|corner| corner.as_dvec3()).collect();
        Part { id, plane: plane_of(&corners, room), corners }
    };
    let parts: Vec<Part> = ids.map(part).collect();
    let mut bsp = PolygonBsp { room, ..PolygonBsp::default() };
    if !parts.is_empty() {
        divide(&mut bsp, &Rules { room, leaf_size, max_depth }, parts, (0, ListGrowth::ROOT));
    }
    bsp
    // <stub> todo!("choose a plane, list the polygons in it, split the polygons that cross it, and build both sides")
    // </solution>
}

// <solution>
/// A part of a polygon, or a whole solid.
#[derive(Clone)]
struct Part {
    id: u32,
    corners: Vec<DVec3>,
    /// The plane of the polygon; `None` for a solid.
    plane: Option<CutPlane>,
}

struct Rules {
    room: f64,
    leaf_size: usize,
    max_depth: usize,
}

/// The plane of a polygon; `None` for the corners of a solid.
fn plane_of(corners: &[DVec3], room: f64) -> Option<CutPlane> {
    if !(3..8).contains(&corners.len()) {
        return None;
    }
    // Refuse corners that do not lie in one plane. Parts of the polygon are then within the whole
    // room of it.
    let plane = newell_plane(corners)?;
    let is_flat = corners.iter().all(|corner| 2.0 * height(&plane, *corner).abs() <= room);
    is_flat.then_some(plane)
}

fn height(plane: &CutPlane, point: DVec3) -> f64 {
    plane.normal.dot(point) - plane.offset
}

/// Where a part is: behind the plane, in front of it, or both; neither for a polygon in the plane.
fn reaches(part: &Part, plane: &CutPlane, room: f64) -> [bool; 2] {
    [-1.0, 1.0].map(|side| {
        let mut heights = part.corners.iter().map(|corner| side * height(plane, *corner));
        match part.plane {
            Some(_) => heights.any(|height| height > room),
            // A solid that touches the plane is on both sides.
            None => heights.any(|height| height >= -room),
        }
    })
}

/// The numbers of parts behind a plane, in front of it, and in it.
#[derive(Clone, Copy)]
struct Counts {
    n_back: usize,
    n_front: usize,
    n_on: usize,
}

fn count(parts: &[Part], plane: &CutPlane, room: f64) -> Counts {
    let mut counts = Counts { n_back: 0, n_front: 0, n_on: 0 };
    for part in parts {
        let [behind, before] = reaches(part, plane, room);
        counts.n_back += usize::from(behind);
        counts.n_front += usize::from(before);
        counts.n_on += usize::from(!behind && !before);
    }
    counts
}

/// The planes to choose from: those of up to sixteen polygons, and one across the longest extent.
fn candidates(parts: &[Part]) -> Vec<CutPlane> {
    // Take at most sixteen polygons, spread over the list, because testing each plane against all
    // takes too long.
    let polygons: Vec<CutPlane> = parts.iter().filter_map(|part| part.plane).collect();
    let step = polygons.len().div_ceil(16).max(1);
    let of_polygons = polygons.into_iter().step_by(step);

    // Put one plane across the axis of the longest extent, between the two middle centres. The
    // planes of a convex body do not divide its polygons, and this plane does.
    let corners = || parts.iter().flat_map(|part| &part.corners);
    let low = corners().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = corners().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let axis = (high - low).max_position();
    let center = |part: &Part| part.corners.iter().map(|c| c[axis]).sum::<f64>() / part.corners.len() as f64;
    let across = median_plane(axis, parts.iter().map(center).collect());
    of_polygons.chain([across]).collect()
}

/// The plane that leaves the fewest parts on its fuller side, where each part on both sides counts
/// as [`SPLIT`] more; `None` if no plane divides the parts.
fn choose(parts: &[Part], room: f64) -> Option<(CutPlane, Counts)> {
    let counted = candidates(parts).into_iter().map(|plane| (plane, count(parts, &plane, room)));
    let on_both = |counts: &Counts| counts.n_back + counts.n_front + counts.n_on - parts.len();
    let fuller = |counts: &Counts| counts.n_back.max(counts.n_front);
    // A plane without a polygon must leave fewer parts on each side, and less than 60 % of them on
    // both.
    let divides = |counts: &Counts| fuller(counts) < parts.len() && 10 * on_both(counts) < 6 * parts.len();
    counted
        .filter(|(_, counts)| counts.n_on > 0 || divides(counts))
        .min_by_key(|(_, counts)| fuller(counts) + SPLIT * on_both(counts))
}

/// The cost of a part on both sides, relative to one on the fuller side. With 2, parts are on both
/// sides too often, and a ray makes more visits. With 30, the planes of polygons are chosen that
/// leave most others on one side, until the tree is too deep and a ray makes more primitive tests
/// (`raykata compare scenes/showcase.toml --only polygon-bsp` counts both).
const SPLIT: usize = 8;

fn divide(
    bsp: &mut PolygonBsp,
    rules: &Rules,
    parts: Vec<Part>,
    (depth, growth): (usize, ListGrowth),
) -> u32 {
    // Choose a plane, unless the node must be a leaf.
    let node = bsp.add_node(depth, rules.max_depth);
    let is_done = parts.len() <= rules.leaf_size && parts.iter().all(|part| part.plane.is_none());
    let divided = !is_done && !parts.is_empty() && depth < rules.max_depth;
    let chosen = divided.then(|| choose(&parts, rules.room)).flatten().and_then(|(plane, counts)| {
        // Refuse the plane if the node and its two sides repeat too many primitives.
        let Counts { n_back, n_front, n_on } = counts;
        Some((plane, growth.divide(parts.len(), n_back + n_front + n_on)?))
    });
    let Some((plane, growth)) = chosen else {
        let ids: Vec<u32> = parts.iter().map(|part| part.id).collect();
        bsp.set_leaf(node, &ids);
        return node;
    };

    // List the polygons in the plane, and divide the other parts between the two sides.
    let (mut on_plane, mut sides) = (Vec::new(), [Vec::new(), Vec::new()]);
    for part in parts {
        match (reaches(&part, &plane, rules.room), part.plane) {
            ([false, false], _) => on_plane.push(part.id),
            ([true, false], _) => sides[0].push(part),
            ([false, true], _) => sides[1].push(part),
            // Split a polygon that crosses the plane. A solid remains whole.
            ([true, true], Some(_)) => {
                for (side, parts) in [-1.0, 1.0].into_iter().zip(&mut sides) {
                    let corners = plane.keep(&part.corners, side);
                    parts.push(Part { corners, ..part });
                }
            }
            ([true, true], None) => {
                sides[0].push(part.clone());
                sides[1].push(part);
            }
        }
    }
    // Build both sides.
    let [behind, before] = sides;
    let back = divide(bsp, rules, behind, (depth + 1, growth));
    let front = divide(bsp, rules, before, (depth + 1, growth));
    bsp.set_children(node, plane, &on_plane, back, front);
    node
}
// </solution>

/// Three steps per plane: search the side of the ray's origin, test the polygons on the plane,
/// search the other side. The slide returns `no_intersection` if `t < min_t` or `t < max_t`, else
/// the first hit. What if the plane is behind the ray? And where is a solid of the near side hit?
///
/// Exactly:
///
/// 1. Test the polygons of a node only if the ray comes to its plane within the part of the ray
///    that is in the node.
/// 2. Visit a node at most once, and only if the ray enters it before the best hit.
/// 3. A point within [`PolygonBsp::room`] of a plane counts as on it: a polygon in front of the
///    plane may extend behind it by this distance.
///
/// Source: "Binary Space Partition (BSP) Tree" (`ComputeBSPIntersection`).
pub fn closest_hit(bsp: &PolygonBsp, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    if bsp.nodes.is_empty() {
        return None;
    }
    let mut ray = *ray;
    let mut best = None;
    search(bsp, 0, range(&ray), probe, &mut ray, &mut best);
    best
    // <stub> todo!("search the near side of each plane, then the polygons on it, then the far side")
    // </solution>
}

// <solution>
fn search(
    bsp: &PolygonBsp,
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
        PolygonBspNode::Leaf { first, count } => test_cell(bsp.primitives(first, count), probe, ray, best),
        PolygonBspNode::Inner { plane, first, count, back, front } => {
            // Find the part of the ray on each side.
            let [near, far] = near_and_far(&plane, [back, front], bsp.room, ray, part);
            // No hit is final: a solid of the near side may be hit on the far side.
            // 1. Search the near side.
            if let Some((child, part)) = near {
                search(bsp, child, part, probe, ray, best);
            }
            // 2. Test the polygons on the plane, if the ray comes to it before the best hit.
            if let (Some(_), Some((_, (reached, _)))) = (near, far)
                && !may_stop_before(best, reached)
            {
                test_cell(bsp.primitives(first, count), probe, ray, best);
            }
            // 3. Search the far side.
            if let Some((child, part)) = far {
                search(bsp, child, part, probe, ray, best);
            }
        }
    }
}
// </solution>
