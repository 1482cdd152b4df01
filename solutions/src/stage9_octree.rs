//! Stage 9 · the octree: cells that are divided in eight wherever there is much, and two ways through it.
//!
//! Slides: "Octree" (recursively subdivide box-shaped cells into 8 octants; trace rays through neighbor cells; "Or, check
//! rays versus octree boxes hierarchically": sort eight boxes front-to-back at each level).
//!
//! Given: [`Octree`] with `divide` and `set_leaf`; [`Cell`] with `octant`, `middle` and `touches`.

use crate::stage9_cells::{look_into, settled, span, widened};
use glam::DVec3;
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, Octree, OctreeNode};
use raykata::ray::Ray;

/// Divides the box around all, made a cube, into octants for as long as there are more than `leaf_size` primitives and it
/// helps, down to `max_depth` (the root is at depth 0). A primitive is listed in every leaf that its box reaches into,
/// touching included. Nothing makes no node.
///
/// Where the formula lies: a thousand copies of one box reach into the same octants again and again; if all octants
/// together would hold more than three times as many, a leaf is better.
pub fn build(bounds: &[Aabb], leaf_size: usize, max_depth: usize) -> Octree {
    // <solution>
    let widened = widened(bounds);
    if widened.boxes.is_empty() {
        return Octree::empty();
    }
    // From the corner of the box and not around its middle: what is flat would lie between the octants.
    let around = widened.around;
    let side = (around.max - around.min).max_element().min(f32::MAX);
    let mut cube = Aabb::new(around.min, (around.min + side).max(around.max));
    cube.max = cube.max.map(|x| x.min(f32::MAX));

    let mut octree = Octree::new(cube);
    divide(&mut octree, 0, &widened.boxes, Cell::new(&cube), 0, &Limits { leaf_size, max_depth });
    octree
    // <stub> todo!("make a leaf if the primitives are few; else divide the cell and build all eight octants")
    // </solution>
}

// <solution>
struct Limits {
    leaf_size: usize,
    max_depth: usize,
}

fn divide(octree: &mut Octree, node: u32, boxes: &[(u32, Aabb)], cell: Cell, depth: usize, limits: &Limits) {
    let octants: [Vec<(u32, Aabb)>; 8] = std::array::from_fn(|octant| {
        let part = cell.octant(octant);
        boxes.iter().filter(|(_, one)| part.touches(one)).copied().collect()
    });
    let n_below: usize = octants.iter().map(Vec::len).sum();
    if boxes.len() <= limits.leaf_size || depth >= limits.max_depth || n_below > 3 * boxes.len() {
        let ids: Vec<u32> = boxes.iter().map(|(id, _)| *id).collect();
        return octree.set_leaf(node, &ids);
    }
    let first = octree.divide(node, depth + 1, limits.max_depth);
    for (octant, boxes) in octants.iter().enumerate() {
        divide(octree, first + octant as u32, boxes, cell.octant(octant), depth + 1, limits);
    }
}
// </solution>

/// The closest hit, from cell to cell: find the leaf that holds the point at which the ray enters, look into it, go on
/// just past its exit. Every node on the way down to a leaf is visited.
pub fn closest_hit_by_cells(octree: &Octree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    if octree.nodes.is_empty() {
        return None;
    }
    let root = Cell::new(&octree.bounds);
    let (enter, leave) = span(ray, &root)?;
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let mut point = (origin + enter * direction).clamp(root.min, root.max);
    let mut ray = *ray;
    let mut best = None;
    loop {
        let (first, count, cell) = leaf_at(octree, probe, point, direction);
        look_into(octree.primitives(first, count), probe, &mut ray, &mut best);

        let (mut axis, mut exit, mut face) = (0, f64::INFINITY, 0.0);
        for candidate in 0..3 {
            let far = if direction[candidate] > 0.0 { cell.max[candidate] } else { cell.min[candidate] };
            let t = (far - origin[candidate]) / direction[candidate];
            if direction[candidate] != 0.0 && t < exit {
                (axis, exit, face) = (candidate, t, far);
            }
        }
        let outside = if direction[axis] > 0.0 { face == root.max[axis] } else { face == root.min[axis] };
        if exit.is_infinite() || exit > leave || outside || settled(&best, exit) {
            return best;
        }
        // Exactly on the face, and not beside the cell by a rounding: so each step gets ahead.
        point = (origin + exit * direction).clamp(cell.min, cell.max);
        point[axis] = face;
    }
    // <stub> todo!("go down to the leaf that holds the point, look into it, and go on at its exit")
    // </solution>
}

// <solution>
/// The leaf that holds `point`. A point on a face is in the cell that a ray in this direction is about to enter.
fn leaf_at(octree: &Octree, probe: &mut impl Cells, point: DVec3, direction: DVec3) -> (u32, u32, Cell) {
    let (mut node, mut cell) = (0, Cell::new(&octree.bounds));
    loop {
        probe.visit(node);
        match octree.nodes[node as usize] {
            OctreeNode::Leaf { first, count } => return (first, count, cell),
            OctreeNode::Inner { first } => {
                let middle = cell.middle();
                let upper = |axis: usize| {
                    point[axis] > middle[axis] || point[axis] == middle[axis] && !(direction[axis] < 0.0)
                };
                let octant = (0..3).map(|axis| usize::from(upper(axis)) << axis).sum::<usize>();
                (node, cell) = (first + octant as u32, cell.octant(octant));
            }
        }
    }
}
// </solution>

/// The closest hit, from the root down: of the octants that the ray meets the nearest one first, and none beyond the best
/// hit.
///
/// Where the formula lies: "sort eight boxes" needs an order for boxes that are entered at one `t`, and the hit of an
/// octant need not be in it: stop only at an octant that begins behind the best hit.
pub fn closest_hit(octree: &Octree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    if octree.nodes.is_empty() {
        return None;
    }
    let root = Cell::new(&octree.bounds);
    span(ray, &root)?;
    let mut ray = *ray;
    let mut best = None;
    search(octree, 0, &root, probe, &mut ray, &mut best);
    best
    // <stub> todo!("sort the octants by where the ray enters them, and search them in that order")
    // </solution>
}

// <solution>
fn search(
    octree: &Octree,
    node: u32,
    cell: &Cell,
    probe: &mut impl Cells,
    ray: &mut Ray,
    best: &mut Option<PrimitiveHit>,
) {
    probe.visit(node);
    match octree.nodes[node as usize] {
        OctreeNode::Leaf { first, count } => look_into(octree.primitives(first, count), probe, ray, best),
        OctreeNode::Inner { first } => {
            let mut met = [(0.0, 0, *cell); 8];
            let mut n_met = 0;
            for octant in 0..8 {
                let part = cell.octant(octant);
                if let Some((enter, _)) = span(ray, &part) {
                    met[n_met] = (enter, octant, part);
                    n_met += 1;
                }
            }
            // Stable, so octants that are entered at one t come in the order of their numbers.
            met[..n_met].sort_by(|p, q| p.0.total_cmp(&q.0));
            for (enter, octant, part) in &met[..n_met] {
                if settled(best, *enter) {
                    break;
                }
                search(octree, first + *octant as u32, part, probe, ray, best);
            }
        }
    }
}
// </solution>
