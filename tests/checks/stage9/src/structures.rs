//! Plain builders of all four structures, so that searches are judged on what is right by construction.

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
        let inside = in_cell(boxes, &cell);
        grid.items.extend(ids(&inside));
        grid.starts.push(grid.items.len() as u32);
    }
    grid
}

/// An octree over the box around all.
pub(super) fn octree(boxes: &[Aabb], leaf_size: usize, max_depth: usize) -> Octree {
    let (boxes, bounds) = loose(boxes);
    if boxes.is_empty() {
        return Octree::empty();
    }
    let mut octree = Octree::new(bounds);
    in_octants(&mut octree, 0, &boxes, Cell::new(&bounds), 0, (leaf_size, max_depth));
    octree
}

fn in_octants(
    octree: &mut Octree,
    node: u32,
    boxes: &[(u32, Aabb)],
    cell: Cell,
    depth: usize,
    limits: (usize, usize),
) {
    if boxes.len() <= limits.0 || depth >= limits.1 {
        return octree.set_leaf(node, &ids(boxes));
    }
    let first = octree.divide(node, depth + 1, limits.1);
    for octant in 0..8 {
        let part = cell.octant(octant);
        in_octants(octree, first + octant as u32, &in_cell(boxes, &part), part, depth + 1, limits);
    }
}

/// A kd-tree with planes in the middle, across x, y, z by turns.
pub(super) fn kd_tree(boxes: &[Aabb], leaf_size: usize, max_depth: usize) -> KdTree {
    let (boxes, bounds) = loose(boxes);
    let mut tree = KdTree::new(bounds);
    if !boxes.is_empty() {
        halve(&mut tree, &boxes, Cell::new(&bounds), 0, (leaf_size, max_depth));
    }
    tree
}

fn halve(tree: &mut KdTree, boxes: &[(u32, Aabb)], cell: Cell, depth: usize, limits: (usize, usize)) -> u32 {
    let node = tree.add_node(depth, limits.1);
    if boxes.len() <= limits.0 || depth >= limits.1 {
        tree.set_leaf(node, &ids(boxes));
        return node;
    }
    let axis = depth % 3;
    let at = cell.middle()[axis] as f32;
    let [below, above] = cell.cut(axis, f64::from(at));
    let left = halve(tree, &in_cell(boxes, &below), below, depth + 1, limits);
    let right = halve(tree, &in_cell(boxes, &above), above, depth + 1, limits);
    tree.set_children(node, axis, at, left, right);
    node
}

/// A BSP tree with planes in many directions, each through the middle of what it divides.
pub(super) fn bsp(hulls: &[Vec<Vec3>], leaf_size: usize, max_depth: usize) -> Bsp {
    let usable = |hull: &[Vec3]| hull.iter().all(|corner| corner.is_finite());
    let ids: Vec<u32> = (0..hulls.len() as u32).filter(|&id| usable(&hulls[id as usize])).collect();
    let mut bsp = Bsp::default();
    if !ids.is_empty() {
        by_planes(&mut bsp, hulls, &ids, 0, (leaf_size, max_depth));
    }
    bsp
}

fn by_planes(bsp: &mut Bsp, hulls: &[Vec<Vec3>], ids: &[u32], depth: usize, limits: (usize, usize)) -> u32 {
    let node = bsp.add_node(depth, limits.1);
    if ids.len() <= limits.0 || depth >= limits.1 {
        bsp.set_leaf(node, &ids.iter().rev().copied().collect::<Vec<u32>>());
        return node;
    }
    let normals = [DVec3::X, DVec3::new(0.0, 1.0, 1.0), DVec3::new(-1.0, 1.0, 0.0), DVec3::NEG_Z, DVec3::ONE];
    let normal = normals[depth % normals.len()].normalize();
    // Through a corner, so that planes and primitives touch.
    let corner = hulls[ids[ids.len() / 2] as usize][0].as_dvec3();
    let plane = CutPlane { normal, offset: normal.dot(corner) };
    let [behind, before] = on_sides(hulls, ids, &plane);
    let back = by_planes(bsp, hulls, &behind, depth + 1, limits);
    let front = by_planes(bsp, hulls, &before, depth + 1, limits);
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
