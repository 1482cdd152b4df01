//! Stage 9 · the octree from neighbour to neighbour: the search goes up only as far as it must, and then down again.
//!
//! Slides: "Octree" (trace rays through neighbor cells; generally fewer cells). Samet, "Implementing Ray Tracing with
//! Octrees and Neighbor Finding", 1989.
//!
//! Given: [`Octree`]; [`Cell`] with `octant` and `middle`.

use crate::stage9_cells::{may_stop_before, span, test_cell};
use glam::DVec3;
use raykata::bvh::PrimitiveHit;
use raykata::partition::{Cell, Cells, Octree, OctreeNode};
use raykata::ray::Ray;

// <solution>
use crate::stage9_cells::{Exit, first_exit};
use crate::stage9_octree::octant_at;
// </solution>

/// Finds the closest hit from leaf to leaf, like `closest_hit_by_cells`, but without a return to the root for each leaf:
/// goes up to the smallest cell that contains both the leaf and its neighbour, and down from there.
///
/// Returns the hit with the smallest `t` in the range of the ray; at equal `t` the smaller primitive number wins.
/// `None` if there is no hit, if the ray misses the bounds, or if there is no node. Visit a node when the search comes to
/// it from above, and visit each node at most once, and only if the ray enters it before the best hit. A hit may lie outside
/// the leaf that lists its primitive.
///
/// A simple way is a stack with the nodes from the root to the leaf: an octree stores no links from children to parents, and
/// a table of all neighbours would take more memory than the tree. At the exit, take nodes off the stack while the exit is on
/// the far side of the node above. Half of all neighbours have the same parent, a quarter the same grandparent, and so on,
/// so on average the search goes up two levels, however deep the tree is. The recursion of `closest_hit` keeps the same
/// stack, and also visits each node once, but computes the intervals of all eight octants.
///
/// Pitfall: the neighbour can be larger than the leaf, or divided into smaller leaves. Only the cell with both of them says
/// which. A point that is not set exactly on the face can lead back into the leaf.
///
/// Slide: "Octree" (trace rays through neighbor cells).
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
        // Find the face through which the ray leaves the leaf. Stop at the end of the ray, or if the best hit lies before.
        let far = DVec3::select(direction.cmpgt(DVec3::ZERO), cell.max, cell.min);
        let Exit { axis, t: exit } = first_exit(origin, direction, far);
        if exit.is_infinite() || exit > leave || may_stop_before(&best, exit) {
            break;
        }
        // Move the point to the exit, exactly on the face.
        point = (origin + exit * direction).clamp(cell.min, cell.max);
        point[axis] = far[axis];
        // Go up while the face is also the far face of the cell. The root has no neighbour, so the path ends there.
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
