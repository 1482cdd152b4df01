//! Structures to search. They divide by a pattern that does not depend on the primitives, and each leaf lists the
//! primitives that touch it, by the definition. The last cell lists one primitive too many, wherever that primitive is.
//! A search must allow for it, and as answers to the exercises these structures are wrong. A grid is made for one ray,
//! from its hits.

use super::parts;
use super::scenes::{Scene, Thing};
use checks::prelude::*;
use checks::tree::around;
use checks::tree::closest_of;
use glam::UVec3;
use raykata::partition::{Bsp, BspNode, Cell, CutPlane, Grid, KdTree, Octree, PolygonBsp, PolygonBspNode};

/// Numbered boxes with room for rounding. Empty boxes are left out.
fn loose(boxes: &[Aabb]) -> (Vec<(u32, Aabb)>, Aabb) {
    let usable = |one: &&Aabb| !one.is_empty();
    let all = around(boxes.iter().filter(usable));
    let largest = all.min.abs().max_element().max(all.max.abs().max_element());
    // Use 2⁻²⁰ of the largest coordinate as room.
    let room = largest * (-20f32).exp2();
    let widen = |one: &Aabb| Aabb::new(one.min - room, one.max + room);
    let kept = boxes.iter().enumerate().filter(|(_, one)| usable(one));
    let kept: Vec<(u32, Aabb)> = kept.map(|(id, one)| (id as u32, widen(one))).collect();
    let all = around(kept.iter().map(|(_, one)| one));
    (kept, all)
}

/// The numbers in descending order: of two hits at the same `t` the larger number comes first.
fn ids(boxes: &[(u32, Aabb)]) -> Vec<u32> {
    boxes.iter().rev().map(|(id, _)| *id).collect()
}

/// The list of a cell. The last cell lists one primitive too many.
fn listed(boxes: &[(u32, Aabb)], cell: &Cell, is_last: bool) -> Vec<u32> {
    let touches = |(_, one): &&(u32, Aabb)| cell.touches(one);
    let mut inside = ids(&boxes.iter().filter(touches).copied().collect::<Vec<_>>());
    if let (true, Some((first, _))) = (is_last, boxes.first())
        && !inside.contains(first)
    {
        inside.push(*first);
    }
    inside
}

/// The box around all boxes with room for rounding, and that room.
pub(super) fn around_loosely(boxes: &[Aabb]) -> (Aabb, f64) {
    let (_, all) = loose(boxes);
    let room = f64::from(all.min.abs().max_element().max(all.max.abs().max_element())) * (-20f64).exp2();
    (all, room)
}

/// A grid with these lists, one per cell.
pub(super) fn filled(bounds: Aabb, resolution: UVec3, lists: &[Vec<u32>]) -> Grid {
    let mut grid = Grid { bounds, resolution, starts: vec![0], items: Vec::new() };
    for list in lists {
        grid.items.extend(list);
        grid.starts.push(grid.items.len() as u32);
    }
    grid
}

/// A grid for one ray only: a primitive is listed in the cells in which the ray hits the primitive. All primitives
/// except the closest one are listed in some other cells as well, so that a cell may list primitives that are far away.
///
/// A search returns the same hit as in a grid that lists boxes, because a search knows primitives only by their hits.
pub(super) fn grid_for(ray: &Ray, scene: &Scene, (bounds, room): (Aabb, f64), resolution: UVec3) -> Grid {
    // Compute the hits without the rounding of different formulas.
    let hits = Scene { rough: false, ..scene.clone() }.hits(ray);
    let first = closest_of(&scene.hits(ray), ray).map(|(primitive, _)| primitive);
    let n_cells = resolution.element_product();
    let mut lists = vec![Vec::new(); n_cells as usize];
    // Find the cells along the ray.
    let way = parts::of_grid(&filled(bounds, resolution, &lists), ray, |_| room);
    // List the primitives in descending order: of two hits at the same `t` the larger number comes first.
    for id in (0..hits.len() as u32).rev() {
        let t = f64::from(hits[id as usize]);
        // Allow eight times the rounding error of `t`.
        let slack = (-21f64).exp2() * t.abs();
        let at_hit = way.iter().filter(|(_, near, far)| near - slack <= t && t <= far + slack);
        let mut cells: Vec<u32> = at_hit.map(|(cell, ..)| *cell).collect();
        if cells.is_empty() && t.is_finite() {
            // List a primitive that is hit outside the ray's range in all cells.
            cells = (0..n_cells).collect();
        }
        let elsewhere = (0..n_cells).filter(|cell| first != Some(id) && (cell + id) % 4 == 0);
        let elsewhere: Vec<u32> = elsewhere.filter(|cell| !cells.contains(cell)).collect();
        cells.extend(elsewhere);
        cells.into_iter().for_each(|cell| lists[cell as usize].push(id));
    }
    filled(bounds, resolution, &lists)
}

/// An octree over the box around all boxes, in which some octants of each node are divided again.
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

/// A kd-tree with planes in the middle of the cells, across x, y, z in turn. Every fifth node is a leaf.
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
    without_polygons(&by_planes(hulls, max_depth, false))
}

/// A BSP tree with triangles in its nodes, each plane that of a triangle or through a corner of another primitive. It does
/// not split triangles: one that crosses a plane is passed on whole. Every seventh node is a leaf.
pub(super) fn polygon_bsp(hulls: &[Vec<Vec3>], max_depth: usize) -> PolygonBsp {
    by_planes(hulls, max_depth, true)
}

/// A tree with the planes and leaves of `bsp`.
fn without_polygons(bsp: &PolygonBsp) -> Bsp {
    let node = |node: &PolygonBspNode| match *node {
        PolygonBspNode::Inner { plane, back, front, .. } => BspNode::Inner { plane, back, front },
        PolygonBspNode::Leaf { first, count } => BspNode::Leaf { first, count },
    };
    Bsp { nodes: bsp.nodes.iter().map(node).collect(), items: bsp.items.clone() }
}

/// The plane x + y = 0.
pub(super) fn diagonal() -> CutPlane {
    CutPlane { normal: DVec3::new(1.0, 1.0, 0.0).normalize(), offset: 0.0 }
}

/// A triangle in the plane x + y = 0.
pub(super) fn tile(z: f32) -> Thing {
    let [a, b, c] = [vec3(4.0, -4.0, z - 4.0), vec3(-4.0, 4.0, z - 4.0), vec3(0.0, 0.0, z + 4.0)];
    Thing::Tile(Triangle { a, b, c })
}

/// A tree of one plane with these primitives on it, behind it and in front of it.
pub(super) fn one_plane(plane: CutPlane, on_plane: &[u32], behind: &[u32], before: &[u32]) -> PolygonBsp {
    let mut bsp = PolygonBsp { room: 1e-6, ..PolygonBsp::default() };
    let root = bsp.add_node(0, 1);
    let [back, front] = [bsp.add_node(1, 1), bsp.add_node(1, 1)];
    bsp.set_leaf(back, behind);
    bsp.set_leaf(front, before);
    bsp.set_children(root, plane, on_plane, back, front);
    bsp
}

/// A tree of one plane with these primitives behind it and in front of it.
pub(super) fn two_leaves(plane: CutPlane, behind: &[u32], before: &[u32]) -> Bsp {
    without_polygons(&one_plane(plane, &[], behind, before))
}

/// The primitives behind and in front of a plane, with 2⁻²⁰ of the largest coordinate as room.
fn on_sides(hulls: &[Vec<Vec3>], ids: &[u32], plane: &CutPlane) -> [Vec<u32>; 2] {
    let reaches = |id: u32, side: f64| {
        hulls[id as usize].iter().any(|corner| {
            let room = f64::from(corner.abs().max_element()) * (-20f64).exp2();
            side * plane.distance(*corner) >= -room
        })
    };
    [-1.0, 1.0].map(|side| ids.iter().copied().filter(|&id| reaches(id, side)).collect())
}

/// A tree whose planes go through triangles, which are then in its nodes, or only through corners.
fn by_planes(hulls: &[Vec<Vec3>], max_depth: usize, through_triangles: bool) -> PolygonBsp {
    let usable = |hull: &[Vec3]| hull.iter().all(|corner| corner.is_finite());
    let ids: Vec<u32> = (0..hulls.len() as u32).filter(|&id| usable(&hulls[id as usize])).collect();
    let largest = ids.iter().flat_map(|&id| &hulls[id as usize]).map(|corner| corner.abs().max_element());
    let room = f64::from(largest.fold(0.0, f32::max)) * (-20f64).exp2();
    let mut bsp = PolygonBsp { room, ..PolygonBsp::default() };
    if !ids.is_empty() {
        add_plane_node(&mut bsp, hulls, &ids, (0, max_depth), through_triangles);
    }
    bsp
}

fn add_plane_node(
    bsp: &mut PolygonBsp,
    hulls: &[Vec<Vec3>],
    ids: &[u32],
    (depth, max_depth): (usize, usize),
    through_triangles: bool,
) -> u32 {
    let node = bsp.add_node(depth, max_depth);
    if depth >= max_depth || ids.is_empty() || node % 7 == 6 {
        bsp.set_leaf(node, &ids.iter().rev().copied().collect::<Vec<u32>>());
        return node;
    }
    let is_triangle = |hull: &[Vec3]| through_triangles && hull.len() == 3;
    let hull = &hulls[ids[ids.len() / 2] as usize];
    let normals = [DVec3::X, DVec3::new(0.0, 1.0, 1.0), DVec3::new(-1.0, 1.0, 0.0), DVec3::NEG_Z, DVec3::ONE];
    let corner = |i: usize| hull[i].as_dvec3();
    let of_triangle =
        is_triangle(hull).then(|| (corner(1) - corner(0)).cross(corner(2) - corner(0)).try_normalize());
    let normal = of_triangle.flatten().unwrap_or(normals[depth % normals.len()].normalize());
    // Put the plane through a corner of a primitive, so that they touch.
    let plane = CutPlane { normal, offset: normal.dot(corner(0)) };
    let is_on = |id: &u32| {
        let hull = &hulls[*id as usize];
        is_triangle(hull) && hull.iter().all(|corner| plane.distance(*corner).abs() <= bsp.room)
    };
    let (on_plane, others): (Vec<u32>, Vec<u32>) = ids.iter().partition(|id| is_on(id));
    let on_plane: Vec<u32> = on_plane.into_iter().rev().collect();
    let [back, front] = on_sides(hulls, &others, &plane)
        .map(|side| add_plane_node(bsp, hulls, &side, (depth + 1, max_depth), through_triangles));
    bsp.set_children(node, plane, &on_plane, back, front);
    node
}
