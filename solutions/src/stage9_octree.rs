//! Stage 9 · the octree: cells with many primitives are divided into eight octants. It has two
//! searches.
//!
//! Slides: `slides/stage09.md`.
//!
//! Given: [`Octree`] with `divide` and `set_leaf`; [`Cell`] with `octant`, `middle` and `touches`;
//! [`ListGrowth`], whose `divide` returns `None` where all leaves together would list more than
//! [`MOST_REFERENCES`](raykata::partition::MOST_REFERENCES) references per primitive, which is the
//! most that is allowed.
//!
//! A search returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller
//! primitive number wins. A hit may lie outside the leaf that lists its primitive. Without a hit or
//! a node, or if the ray misses the bounds, the result is `None`.

use crate::stage9_cells::{around, may_stop_before, padded_boxes, span, test_cell};
use glam::DVec3;
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, ListGrowth, Octree, OctreeNode};
use raykata::ray::Ray;

// <solution>
use crate::stage9_cells::{ROUNDING, crossing, first_axis, part_above};
// </solution>

/// Makes a cube of the box around all padded boxes, and divides every cell with too many primitives
/// into eight octants. A thousand copies of one box are in the same octants at every level. When
/// does the build end?
///
/// Exactly:
///
/// 1. Divide a cell, unless it holds at most `leaf_size` primitives, is at `max_depth` (the root is
///    at depth 0), its octants together would hold about three times as many or more, or
///    [`ListGrowth::divide`] returns `None`.
/// 2. List a primitive once in every leaf that its box touches.
/// 3. Leave out empty boxes. Without a usable box the tree has no nodes.
///
/// Source: "Octree" (recursively subdivide box-shaped cells into 8 octants).
pub fn build(bounds: &[Aabb], leaf_size: usize, max_depth: usize) -> Octree {
    // <solution>
    let boxes = padded_boxes(bounds);
    if boxes.is_empty() {
        return Octree::empty();
    }
    // Extend the box to a cube from its lower corner: around its middle, a flat box would lie
    // between the octants.
    let around = around(&boxes);
    let side = (around.max - around.min).max_element().min(f32::MAX);
    let mut cube = Aabb::new(around.min, (around.min + side).max(around.max));
    cube.max = cube.max.map(|x| x.min(f32::MAX));

    let mut octree = Octree::new(cube);
    let limits = LeafRule { leaf_size, max_depth };
    divide(&mut octree, 0, &boxes, Cell::new(&cube), (0, ListGrowth::ROOT), &limits);
    octree
    // <stub> todo!("make a leaf if the primitives are few; else divide the cell and build all eight octants")
    // </solution>
}

// <solution>
struct LeafRule {
    leaf_size: usize,
    max_depth: usize,
}

fn divide(
    octree: &mut Octree,
    node: u32,
    boxes: &[(u32, Aabb)],
    cell: Cell,
    (depth, growth): (usize, ListGrowth),
    limits: &LeafRule,
) {
    // List the boxes that touch each octant.
    let octants: [Vec<(u32, Aabb)>; 8] = std::array::from_fn(|octant| {
        let part = cell.octant(octant);
        boxes.iter().filter(|(_, one)| part.touches(one)).copied().collect()
    });
    // Make a leaf if the primitives are few, or if dividing does not help.
    let n_below: usize = octants.iter().map(Vec::len).sum();
    let is_leaf = boxes.len() <= limits.leaf_size || depth >= limits.max_depth || n_below > 3 * boxes.len();
    let Some(growth) = growth.divide(boxes.len(), n_below).filter(|_| !is_leaf) else {
        let ids: Vec<u32> = boxes.iter().map(|(id, _)| *id).collect();
        return octree.set_leaf(node, &ids);
    };
    // Divide the node, and build its octants.
    let first = octree.divide(node, depth + 1, limits.max_depth);
    for (octant, boxes) in octants.iter().enumerate() {
        divide(octree, first + octant as u32, boxes, cell.octant(octant), (depth + 1, growth), limits);
    }
}
// </solution>

/// From cell to cell: goes down from the root to the leaf that contains the point of entry, tests
/// its primitives, and continues with the leaf behind its exit. To which of two cells does a point
/// on their face belong? And is the rounded exit on the face?
///
/// Visit every node on the way down to a leaf, and each leaf at most once.
///
/// Source: "Octree" (trace rays through neighbor cells).
pub fn closest_hit_by_cells(octree: &Octree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    if octree.nodes.is_empty() {
        return None;
    }
    // Find the point at which the ray enters the root cell.
    let root = Cell::new(&octree.bounds);
    let (enter, leave) = span(ray, &root)?;
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let mut point = (origin + enter * direction).clamp(root.min, root.max);
    let mut ray = *ray;
    let mut best = None;
    loop {
        // Test the primitives of the leaf that contains the point.
        let (first, count, cell) = leaf_at(octree, probe, point, direction);
        test_cell(octree.primitives(first, count), probe, &mut ray, &mut best);

        // Find the face through which the ray leaves the leaf.
        let far = DVec3::select(direction.cmpgt(DVec3::ZERO), cell.max, cell.min);
        let exits = [0, 1, 2].map(|axis| crossing(origin[axis], direction[axis], far[axis]));
        let axis = first_axis(exits);
        let (exit, face) = (exits[axis], far[axis]);
        // Stop at the end of the root cell or of the ray, or if the best hit lies before the exit.
        let outside = if direction[axis] > 0.0 { face == root.max[axis] } else { face == root.min[axis] };
        if exit.is_infinite() || exit > leave || outside || may_stop_before(&best, exit) {
            return best;
        }
        // Move the point to the exit, exactly on the face: a rounding error could put it back into
        // the same cell.
        point = (origin + exit * direction).clamp(cell.min, cell.max);
        point[axis] = face;
    }
    // <stub> todo!("go down to the leaf that contains the point, test its primitives, and continue at its exit")
    // </solution>
}

// <solution>
/// The leaf that contains `point`. A point on a face is in the cell that a ray in this direction is
/// about to enter.
fn leaf_at(octree: &Octree, probe: &mut impl Cells, point: DVec3, direction: DVec3) -> (u32, u32, Cell) {
    let (mut node, mut cell) = (0, Cell::new(&octree.bounds));
    loop {
        probe.visit(node);
        match octree.nodes[node as usize] {
            OctreeNode::Leaf { first, count } => return (first, count, cell),
            OctreeNode::Inner { first } => {
                // Go to the octant that contains the point.
                let octant = octant_at(&cell, point, direction);
                (node, cell) = (first + octant as u32, cell.octant(octant));
            }
        }
    }
}

/// The octant of a cell that contains `point`. On a middle plane, the direction decides which one
/// the ray is about to enter.
pub fn octant_at(cell: &Cell, point: DVec3, direction: DVec3) -> usize {
    let middle = cell.middle();
    let is_upper =
        |axis: usize| point[axis] > middle[axis] || point[axis] == middle[axis] && !(direction[axis] < 0.0);
    (0..3).map(|axis| usize::from(is_upper(axis)) << axis).sum()
}
// </solution>

/// From the root down: sorts the octants that the ray enters by their entries, searches them in
/// this order, and stops at one that begins behind the best hit. What if the ray enters four
/// octants at the same `t`? And what if a primitive is hit outside its octant?
///
/// Visit each node at most once, and only if the ray enters it before the best hit.
///
/// Source: "Octree" (sort eight boxes front-to-back).
pub fn closest_hit(octree: &Octree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    if octree.nodes.is_empty() {
        return None;
    }
    let root = Cell::new(&octree.bounds);
    let part = span(ray, &root)?;
    let mut ray = *ray;
    let mut best = None;
    search(octree, (0, root), part, probe, &mut ray, &mut best);
    best
    // <stub> todo!("sort the octants by where the ray enters them, and search them in that order")
    // </solution>
}

// <solution>
/// Searches below `node` with its cell, in which the ray is for `part`.
fn search(
    octree: &Octree,
    (node, cell): (u32, Cell),
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
    let first = match octree.nodes[node as usize] {
        OctreeNode::Leaf { first, count } => {
            return test_cell(octree.primitives(first, count), probe, ray, best);
        }
        OctreeNode::Inner { first } => first,
    };
    // Find the parts of the ray on both sides of the three middle planes, empty where it never is.
    // They are enough for all eight octants, each of which is on one side of each plane.
    const NEVER: (f64, f64) = (f64::INFINITY, f64::NEG_INFINITY);
    let (origin, direction, middle) = (ray.origin.as_dvec3(), ray.direction.as_dvec3(), cell.middle());
    let sides = [0, 1, 2].map(|axis| {
        let (height, rate) = (origin[axis] - middle[axis], direction[axis]);
        let room = ROUNDING * height.abs();
        [(-height, -rate), (height, rate)].map(|(h, r)| part_above(h, r, room, part).unwrap_or(NEVER))
    });
    // Visit the octants from front to back, without sorting: a ray that ascends along all axes
    // passes them in the order of their numbers, and each axis along which it descends exchanges
    // its two sides.
    let descends: usize = (0..3).map(|axis| usize::from(direction[axis] < 0.0) << axis).sum();
    for octant in (0..8).map(|i| i ^ descends) {
        let [x, y, z] = [0, 1, 2].map(|axis| sides[axis][octant >> axis & 1]);
        let part = (x.0.max(y.0).max(z.0), x.1.min(y.1).min(z.1));
        if part.0 <= part.1 {
            search(octree, (first + octant as u32, cell.octant(octant)), part, probe, ray, best);
        }
    }
}
// </solution>
