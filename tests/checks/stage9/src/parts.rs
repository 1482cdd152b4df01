//! The intervals of a ray in the nodes of a structure, computed by the definition: every node is tested.

use super::searches::Parts;
use checks::double::box_interval;
use glam::uvec3;
use raykata::aabb::Aabb;
use raykata::partition::{Bsp, Cell, CutPlane, Grid, KdTree, Octree, OctreeNode};
use raykata::ray::Ray;

/// The interval of a ray in a cell that is widened a little, so that cells that the ray only touches are included.
fn part(ray: &Ray, cell: &Cell) -> Option<(f64, f64)> {
    part_of(ray, cell, (cell.max - cell.min).max_element() * (-16f64).exp2())
}

fn part_of(ray: &Ray, cell: &Cell, room: f64) -> Option<(f64, f64)> {
    let wide = Aabb::new((cell.min - room).as_vec3(), (cell.max + room).as_vec3());
    let (near, far) = box_interval(ray, &wide);
    let (near, far) = (near.max(f64::from(ray.t_min)), far.min(f64::from(ray.t_max)));
    (near <= far).then_some((near, far))
}

fn numbered(grid: &Grid) -> impl Iterator<Item = (u32, Cell)> {
    let n = grid.resolution;
    (0..n.element_product()).map(move |i| (i, grid.cell(uvec3(i % n.x, i / n.x % n.y, i / (n.x * n.y)))))
}

pub(super) fn of_grid(grid: &Grid, ray: &Ray) -> Parts {
    numbered(grid).filter_map(|(i, cell)| part(ray, &cell).map(|(near, far)| (i, near, far))).collect()
}

/// The cells that the ray enters, or passes by within `room`.
pub(super) fn near_grid(grid: &Grid, ray: &Ray, room: f64) -> Parts {
    numbered(grid)
        .filter_map(|(i, cell)| part_of(ray, &cell, room).map(|(near, far)| (i, near, far)))
        .collect()
}

/// The cells that the ray passes through well inside their faces.
pub(super) fn inside_grid(grid: &Grid, ray: &Ray) -> Parts {
    numbered(grid)
        .filter_map(|(i, cell)| part_of(ray, &cell, -0.01).map(|(near, far)| (i, near, far)))
        .collect()
}

pub(super) fn of_octree(octree: &Octree, ray: &Ray) -> Parts {
    let mut parts = Vec::new();
    octree.walk(usize::MAX, |node, cell, _| {
        parts.extend(part(ray, &cell).map(|(near, far)| (node, near, far)))
    });
    parts
}

pub(super) fn of_leaves(octree: &Octree, parts: &Parts) -> Vec<u32> {
    let is_leaf = |node: u32| matches!(octree.nodes[node as usize], OctreeNode::Leaf { .. });
    parts.iter().map(|(node, ..)| *node).filter(|&node| is_leaf(node)).collect()
}

pub(super) fn of_kd_tree(tree: &KdTree, ray: &Ray) -> Parts {
    let mut parts = Vec::new();
    tree.walk(usize::MAX, |node, cell, _| {
        parts.extend(part(ray, &cell).map(|(near, far)| (node, near, far)))
    });
    parts
}

pub(super) fn of_bsp(bsp: &Bsp, ray: &Ray) -> Parts {
    let mut parts = Vec::new();
    bsp.walk(|node, above, _| {
        let mut part = (f64::from(ray.t_min), f64::from(ray.t_max));
        for (plane, side) in above {
            part = on_side(ray, plane, *side, part);
        }
        if part.0 <= part.1 {
            parts.push((node, part.0, part.1));
        }
    });
    parts
}

fn on_side(ray: &Ray, plane: &CutPlane, side: f64, (t, t_end): (f64, f64)) -> (f64, f64) {
    let (height, rate) =
        (side * plane.distance(ray.origin), side * plane.normal.dot(ray.direction.as_dvec3()));
    let room = (-16f64).exp2() * (1.0 + height.abs());
    match rate {
        0.0 if height >= -room => (t, t_end),
        0.0 => (f64::INFINITY, f64::NEG_INFINITY),
        rate if rate > 0.0 => (t.max((-room - height) / rate), t_end),
        rate => (t, t_end.min((-room - height) / rate)),
    }
}
