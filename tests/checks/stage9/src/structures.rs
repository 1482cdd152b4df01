//! Structures to search. Where they divide follows a pattern that knows nothing of the primitives, and each leaf lists what
//! touches it, by the definition. The last cell lists one primitive too many, wherever that primitive is: a search must
//! allow for it, and as answers to the exercises these structures are wrong.

use checks::tree::around;
use glam::{DVec3, UVec3, Vec3, uvec3};
use raykata::aabb::Aabb;
use raykata::partition::{Bsp, Cell, CutPlane, Grid, KdTree, Octree};

/// Boxes with room for rounding, numbered; what is not a number is left out.
fn loose(boxes: &[Aabb]) -> (Vec<(u32, Aabb)>, Aabb) {
    let usable = |one: &&Aabb| !one.is_empty();
    let all = around(boxes.iter().filter(usable));
    let largest = all.min.abs().max_element().max(all.max.abs().max_element());
    // 2⁻²⁰ of the largest coordinate: four steps of it.
    let room = largest * (-20f32).exp2();
    let widen = |one: &Aabb| Aabb::new(one.min - room, one.max + room);
    let kept = boxes.iter().enumerate().filter(|(_, one)| usable(one));
    let kept: Vec<(u32, Aabb)> = kept.map(|(id, one)| (id as u32, widen(one))).collect();
    let all = around(kept.iter().map(|(_, one)| one));
    (kept, all)
}

fn in_cell(boxes: &[(u32, Aabb)], cell: &Cell) -> Vec<(u32, Aabb)> {
    boxes.iter().filter(|(_, one)| cell.touches(one)).copied().collect()
}

/// From the largest number down: of two hits at one `t` the larger number comes first.
fn ids(boxes: &[(u32, Aabb)]) -> Vec<u32> {
    boxes.iter().rev().map(|(id, _)| *id).collect()
}

/// What a cell lists; the last one, one primitive too many.
fn listed(boxes: &[(u32, Aabb)], cell: &Cell, is_last: bool) -> Vec<u32> {
    let mut inside = ids(&in_cell(boxes, cell));
    if let (true, Some((first, _))) = (is_last, boxes.first())
        && !inside.contains(first)
    {
        inside.push(*first);
    }
    inside
}

/// A grid of so many cells.
pub(super) fn grid(boxes: &[Aabb], resolution: UVec3) -> Grid {
    let (boxes, bounds) = loose(boxes);
    grid_within(&boxes, bounds, resolution)
}

/// A grid in a given box.
pub(super) fn grid_within(boxes: &[(u32, Aabb)], bounds: Aabb, resolution: UVec3) -> Grid {
    let mut grid = Grid { bounds, resolution, starts: vec![0], items: Vec::new() };
    let UVec3 { x: nx, y: ny, z: nz } = resolution;
    for number in 0..nx * ny * nz {
        let cell = grid.cell(uvec3(number % nx, number / nx % ny, number / (nx * ny)));
        grid.items.extend(listed(boxes, &cell, number + 1 == nx * ny * nz));
        grid.starts.push(grid.items.len() as u32);
    }
    grid
}

/// An octree over the box around all: of eight octants three are divided again.
pub(super) fn octree(boxes: &[Aabb], max_depth: usize) -> Octree {
    let (boxes, bounds) = loose(boxes);
    if boxes.is_empty() {
        return Octree::empty();
    }
    let mut octree = Octree::new(bounds);
    let mut waiting = vec![(0, Cell::new(&bounds), 0, true)];
    while let Some((node, cell, depth, is_divided)) = waiting.pop() {
        if depth >= max_depth || !is_divided {
            octree.set_leaf(node, &listed(&boxes, &cell, waiting.is_empty()));
            continue;
        }
        let first = octree.divide(node, depth + 1, max_depth);
        let octants = (0..8)
            .map(|octant| (first + octant as u32, cell.octant(octant), depth + 1, (octant + depth) % 3 == 0));
        waiting.extend(octants);
    }
    octree
}

/// A kd-tree with planes in the middle, across x, y, z by turns. Every fifth node is a leaf.
pub(super) fn kd_tree(boxes: &[Aabb], max_depth: usize) -> KdTree {
    let (boxes, bounds) = loose(boxes);
    let mut tree = KdTree::new(bounds);
    if !boxes.is_empty() {
        add_kd_node(&mut tree, &boxes, Cell::new(&bounds), 0, max_depth);
    }
    tree
}

fn add_kd_node(tree: &mut KdTree, boxes: &[(u32, Aabb)], cell: Cell, depth: usize, max_depth: usize) -> u32 {
    let node = tree.add_node(depth, max_depth);
    if depth >= max_depth || node % 5 == 4 {
        tree.set_leaf(node, &listed(boxes, &cell, false));
        return node;
    }
    let axis = depth % 3;
    let at = cell.middle()[axis] as f32;
    let [left, right] =
        cell.cut(axis, f64::from(at)).map(|side| add_kd_node(tree, boxes, side, depth + 1, max_depth));
    tree.set_children(node, axis, at, left, right);
    node
}

/// A BSP tree with planes in many directions, each through a corner of some primitive. Every seventh node is a leaf.
pub(super) fn bsp(hulls: &[Vec<Vec3>], max_depth: usize) -> Bsp {
    let usable = |hull: &[Vec3]| hull.iter().all(|corner| corner.is_finite());
    let ids: Vec<u32> = (0..hulls.len() as u32).filter(|&id| usable(&hulls[id as usize])).collect();
    let mut bsp = Bsp::default();
    if !ids.is_empty() {
        add_bsp_node(&mut bsp, hulls, &ids, 0, max_depth);
    }
    bsp
}

fn add_bsp_node(bsp: &mut Bsp, hulls: &[Vec<Vec3>], ids: &[u32], depth: usize, max_depth: usize) -> u32 {
    let node = bsp.add_node(depth, max_depth);
    if depth >= max_depth || ids.is_empty() || node % 7 == 6 {
        bsp.set_leaf(node, &ids.iter().rev().copied().collect::<Vec<u32>>());
        return node;
    }
    let normals = [DVec3::X, DVec3::new(0.0, 1.0, 1.0), DVec3::new(-1.0, 1.0, 0.0), DVec3::NEG_Z, DVec3::ONE];
    let normal = normals[depth % normals.len()].normalize();
    // Through a corner, so that planes and primitives touch.
    let corner = hulls[ids[ids.len() / 2] as usize][0].as_dvec3();
    let plane = CutPlane { normal, offset: normal.dot(corner) };
    let [back, front] =
        on_sides(hulls, ids, &plane).map(|side| add_bsp_node(bsp, hulls, &side, depth + 1, max_depth));
    bsp.set_children(node, plane, back, front);
    node
}

/// The primitives behind and in front of a plane, with four steps of the largest coordinate as room.
pub(super) fn on_sides(hulls: &[Vec<Vec3>], ids: &[u32], plane: &CutPlane) -> [Vec<u32>; 2] {
    let reaches = |id: u32, side: f64| {
        hulls[id as usize].iter().any(|corner| {
            let room = f64::from(corner.abs().max_element()) * (-20f64).exp2();
            side * plane.distance(*corner) >= -room
        })
    };
    [-1.0, 1.0].map(|side| ids.iter().copied().filter(|&id| reaches(id, side)).collect())
}
