//! Which acceleration structure a frame uses: the one that the scene names, or else the best one whose functions are written.

use super::written::Written;
use crate::kit::{Function, StudentFunctions};
use crate::scene::{Accelerator, Quality};

/// The structure that the scene requests, or the best one whose functions are written.
pub(super) fn choose_accelerator<F: StudentFunctions>(
    quality: &Quality,
    written: &Written<F>,
    notes: &mut Vec<String>,
) -> Option<Accelerator> {
    // Use the structure of the scene, or else a hierarchy.
    let wanted = quality.accelerator;
    let wanted = if wanted == Accelerator::Auto { fastest_hierarchy(quality, written) } else { wanted };
    if wanted != Accelerator::BruteForce {
        let boxes = written.has(Function::slab) || written.has(Function::conservative_slab);
        if boxes && written.has_all(HIERARCHY) {
            let (stage, functions) = extra_functions(wanted);
            let name = wanted.name();
            if wanted.is_wide() && !written.has_all(extra_functions(Accelerator::WideBvh).1) {
                notes.push(format!("a hierarchy replaces `{name}`: stage {stage} is not written yet"));
                return Some(Accelerator::Bvh);
            }
            if written.has_all(functions) {
                return Some(wanted);
            }
            if wanted.is_wide() {
                notes.push(format!(
                    "a wide tree replaces `{name}`: the bonus of stage {stage} is not written yet"
                ));
                return Some(Accelerator::WideBvh);
            }
            notes.push(format!("a hierarchy replaces `{name}`: stage {stage} is not written yet"));
            return Some(Accelerator::Bvh);
        }
        notes.push("every ray tests every primitive: stage 3 is not written yet".into());
    }
    // Without stage 3, test every primitive; without stage 2, paint the shapes in their order.
    if written.has(Function::brute_force) {
        return Some(Accelerator::BruteForce);
    }
    notes.push(
        "later shapes are painted over earlier ones, near or far: `brute_force` of stage 2 is not written yet".into(),
    );
    None
}

/// The hierarchy of a scene that names no structure: that of stage 12 once everything that makes it fast is written.
fn fastest_hierarchy<F: StudentFunctions>(quality: &Quality, written: &Written<F>) -> Accelerator {
    // Only the builder of stage 3 has other splits and leaf sizes.
    let default = Quality::default();
    let is_default = (quality.split, quality.leaf_size) == (default.split, default.leaf_size);
    let builds = written.has(Function::build_parallel) || written.has(Function::build_binned);
    let (_, needed) = extra_functions(Accelerator::WideBvh);
    if is_default && builds && written.has(Function::may_hit) && written.has_all(needed) {
        Accelerator::WideBvh
    } else {
        Accelerator::Bvh
    }
}

/// The functions that a bounding volume hierarchy needs, beside a test of boxes. Every structure needs them, because
/// they bound primitives.
const HIERARCHY: &[Function] = &[
    Function::triangle_bounds,
    Function::sphere_bounds,
    Function::union,
    Function::build,
    Function::closest_hit,
    Function::any_hit,
];

/// The functions that a structure needs beside those of a hierarchy, and their stage.
fn extra_functions(accelerator: Accelerator) -> (u8, &'static [Function]) {
    match accelerator {
        Accelerator::Auto | Accelerator::BruteForce | Accelerator::Bvh => (3, &[]),
        Accelerator::BvhBothChildren => (3, &[Function::closest_hit_both]),
        Accelerator::BoundingBoxes => (8, &[Function::closest_hit_in_graph]),
        Accelerator::BoundingSpheres => {
            (8, &[Function::closest_hit_in_graph, Function::bounding_sphere, Function::enter_bounding_sphere])
        }
        Accelerator::CachedBoundingBoxes => {
            (8, &[Function::closest_hit_in_graph, Function::closest_hit_with_child_cache])
        }
        Accelerator::CachedBvh => (9, &[Function::cached_search]),
        Accelerator::WideBvh => (
            12,
            &[
                Function::flatten,
                Function::collapse,
                Function::enter_boxes,
                Function::wide_closest_hit,
                Function::wide_any_hit,
            ],
        ),
        Accelerator::PacketBvh => (9, &[Function::packet_search]),
        Accelerator::Grid => (
            9,
            &[Function::cell_span, Function::grid_resolution, Function::grid_build, Function::grid_search],
        ),
        Accelerator::Octree => (9, &[Function::cell_span, Function::octree_build, Function::octree_search]),
        Accelerator::OctreeByNeighbours => {
            (9, &[Function::cell_span, Function::octree_build, Function::octree_by_neighbours])
        }
        Accelerator::OctreeByCells => {
            (9, &[Function::cell_span, Function::octree_build, Function::octree_by_cells])
        }
        Accelerator::KdTree => (9, &[Function::cell_span, Function::kd_build, Function::kd_search]),
        Accelerator::Bsp => (9, &[Function::cell_span, Function::bsp_build, Function::bsp_search]),
        Accelerator::PolygonBsp => {
            (9, &[Function::cell_span, Function::polygon_bsp_build, Function::polygon_bsp_search])
        }
    }
}
