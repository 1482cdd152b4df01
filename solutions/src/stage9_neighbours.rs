//! Stage 9 · the octree from neighbour to neighbour: the search goes up only as far as it must, and
//! then down again.
//!
//! Slides: `slides/stage09.md`. Source: Samet, "Implementing Ray Tracing with Octrees and Neighbor
//! Finding", 1989.
//!
//! Given: [`Octree`]; [`Cell`] with `octant` and `middle`.
//!
//! A search returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller
//! primitive number wins. A hit may lie outside the leaf that lists its primitive. Without a hit or
//! a node, or if the ray misses the bounds, the result is `None`.

use crate::stage9_cells::{may_stop_before, span, test_cell};
use glam::DVec3;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, Octree, OctreeNode};
use raykata::ray::Ray;

// <solution>
use crate::stage9_cells::{crossing, first_axis};
use crate::stage9_octree::octant_at;
// </solution>

/// From leaf to leaf like `closest_hit_by_cells`, but without a return to the root: goes up to the
/// smallest cell that contains both the leaf and its neighbour, and down from there. An octree
/// stores no links to parents: how do you get up? And how large can a neighbour be?
///
/// Visit a node when the search comes to it from above, at most once, and only if the ray enters it
/// before the best hit.
///
/// Source: "Octree" (trace rays through neighbor cells).
pub fn closest_hit_by_neighbours(octree: &Octree, probe: &mut impl Cells, ray: &Ray) -> Option<PrimitiveHit> {
    // <solution>
    if octree.nodes.is_empty() {
        return None;
    }
    // Find the point at which the ray enters the root cell.
    let root = Cell::new(&octree.bounds);
    let (enter, leave) = span(ray, &root)?;
    let (origin, direction) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
    let mut point = (origin + enter * direction).clamp(root.min, root.max);
    let (mut ray, mut best) = (*ray, None);
    // The nodes from the root to the current one, with their cells.
    probe.visit(0);
    let mut path = vec![(0, root)];
    while let Some(&(node, cell)) = path.last() {
        // Go down to the leaf that contains the point.
        let (first, count) = match octree.nodes[node as usize] {
            OctreeNode::Leaf { first, count } => (first, count),
            OctreeNode::Inner { first } => {
                let octant = octant_at(&cell, point, direction);
                let child = first + octant as u32;
                probe.visit(child);
                path.push((child, cell.octant(octant)));
                continue;
            }
        };
        // Test its primitives.
        test_cell(octree.primitives(first, count), probe, &mut ray, &mut best);
        // Find the face through which the ray leaves the leaf. Stop at the end of the ray, or if
        // the best hit lies before.
        let far = DVec3::select(direction.cmpgt(DVec3::ZERO), cell.max, cell.min);
        let exits = [0, 1, 2].map(|axis| crossing(origin[axis], direction[axis], far[axis]));
        let axis = first_axis(exits);
        let exit = exits[axis];
        if exit.is_infinite() || exit > leave || may_stop_before(&best, exit) {
            break;
        }
        // Move the point to the exit, exactly on the face.
        point = (origin + exit * direction).clamp(cell.min, cell.max);
        point[axis] = far[axis];
        // Go up while the face is also the far face of the cell. The root has no neighbour, so the
        // path ends there.
        let is_far = |cell: &Cell| {
            let face = if direction[axis] > 0.0 { cell.max[axis] } else { cell.min[axis] };
            face == far[axis]
        };
        while path.last().is_some_and(|(_, cell)| is_far(cell)) {
            path.pop();
        }
    }
    best
    // <stub> todo!("keep the nodes from the root to the leaf; at the exit go up while the face is shared, then down")
    // </solution>
}
