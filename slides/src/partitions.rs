//! Diagrams of partitions of space: three searches of an octree, and sheets across a diagonal in two trees.

use anyhow::Result;
use glam::{DVec2, DVec3, Vec3, dvec2, vec3};
use raykata::aabb::Aabb;
use raykata::kit::{BspQuery, CellsAnswer, CellsQuery, KdQuery, Kit, OctreeQuery};
use raykata::partition::{Bsp, BspNode, KdHeuristics, Octree, OctreeNode};
use raykata::ray::Ray;
use raykata_cli::svg::{Drawing, Ink, LARGE, Middle, Point, SMALL, Start, View, plane};
use touch::walk::{boxes, hits, leaves};

/// A node of the lower half of an octree, with its cell, its depth and its position in the row of this depth.
struct Node {
    index: u32,
    cell: Aabb,
    depth: usize,
    column: usize,
}

/// An octree over boxes in the plane, searched in three ways along the same ray.
pub fn octree_searches(kit: &dyn Kit) -> Result<String> {
    // The ray stays in the lower half of all cells.
    let ray = Ray::new(vec3(-0.6, 1.95, 0.3), vec3(1.0, 0.085, 0.0));
    let hits = hits(kit, ray);
    let query = OctreeQuery { bounds: boxes(), leaf_size: 1, max_depth: 4 };
    let octree = kit.octree_build(&[query]).remove(0);
    let query = [CellsQuery { cells: octree.clone(), ray, hits }];
    let mut drawing = Drawing::new("Three searches of one octree", 1000.0, 550.0);
    // The octree is flat: take the nodes level by level, and of each eight children the four with the smaller z.
    let mut nodes: Vec<Node> = Vec::new();
    octree.walk(16, |index, cell, depth| {
        let cell = cell.to_box();
        if cell.min.z <= octree.bounds.min.z {
            let column = nodes.iter().filter(|node| node.depth == depth).count();
            nodes.push(Node { index, cell, depth, column });
        }
    });
    nodes.sort_by_key(|node| node.depth);
    // Draw the cells and the tree level by level in the first panel.
    drawing.step();
    draw_objects(&mut drawing, 14.0);
    let at = cells_at(14.0);
    for depth in 0..octree.depth() {
        let shown = &nodes[..nodes.partition_point(|node| node.depth <= depth)];
        drawing.remark([14.0, 508.0], &format!("{} levels, {} nodes", depth + 1, shown.len()));
        for node in shown {
            drawing.frame(at(node.cell.min), at(node.cell.max), Ink::Faint.pen(1.5));
        }
        draw_levels(&mut drawing, shown, &CellsAnswer::default(), 14.0);
    }
    for (panel, (name, answer)) in [
        ("closest_hit", kit.octree_search(&query).remove(0)),
        ("…_by_cells", kit.octree_by_cells(&query).remove(0)),
        ("…_by_neighbours", kit.octree_by_neighbours(&query).remove(0)),
    ]
    .into_iter()
    .enumerate()
    {
        let left = 14.0 + 334.0 * panel as f64;
        drawing.step();
        if panel > 0 {
            draw_objects(&mut drawing, left);
        }
        draw_cells(&mut drawing, &octree, &nodes, &ray, &answer, left);
        draw_levels(&mut drawing, &nodes, &answer, left);
        drawing.text([left, 508.0], Start, SMALL, Ink::Text, name);
        let text = format!("{} visits", answer.visits.len());
        drawing.text([left, 538.0], Start, SMALL, Ink::Color(1), &text);
    }
    Ok(drawing.svg())
}

fn visits(answer: &CellsAnswer, node: u32) -> usize {
    answer.visits.iter().filter(|&&visit| visit == node).count()
}

fn draw_cells(
    drawing: &mut Drawing,
    octree: &Octree,
    nodes: &[Node],
    ray: &Ray,
    answer: &CellsAnswer,
    left: f64,
) {
    let at = cells_at(left);
    for node in
        nodes.iter().filter(|node| matches!(octree.nodes[node.index as usize], OctreeNode::Leaf { .. }))
    {
        if visits(answer, node.index) > 0 {
            drawing.rectangle(at(node.cell.min), at(node.cell.max), Ink::Color(1), 0.2);
        }
        drawing.frame(at(node.cell.min), at(node.cell.max), Ink::Faint.pen(1.5));
    }
    let end = answer.hit.map_or(8.3, |hit| hit.t);
    drawing.arrow(at(ray.at(0.55)), at(ray.at(end)), Ink::Text.pen(3.0));
}

/// Where a point of the plane stands in the panel that begins at `left`.
fn cells_at(left: f64) -> impl Fn(Vec3) -> Point + Copy {
    plane([left - 8.0, 306.0], 39.0).1
}

fn draw_objects(drawing: &mut Drawing, left: f64) {
    let at = cells_at(left);
    for bounds in boxes() {
        drawing.rectangle(at(bounds.min), at(bounds.max), Ink::Color(0), 0.5);
    }
}

/// The tree as rows of dots, which are larger for more visits.
fn draw_levels(drawing: &mut Drawing, nodes: &[Node], answer: &CellsAnswer, left: f64) {
    let row = |depth: usize| nodes.iter().filter(|node| node.depth == depth).count();
    let at = |node: &Node| -> Point {
        let share = (node.column as f64 + 0.5) / row(node.depth) as f64;
        [left + 312.0 * share, 342.0 + 40.0 * node.depth as f64]
    };
    for node in nodes {
        match visits(answer, node.index) {
            0 => drawing.dot(at(node), 3.5, Ink::Faint),
            n => drawing.dot(at(node), 2.5 + 2.0 * (n as f64).min(6.0), Ink::Color(1)),
        }
    }
}

/// Six parallel sheets across a diagonal, in a kd-tree and in a BSP tree.
pub fn bsp_sheets(kit: &dyn Kit) -> Result<String> {
    let along = vec3(1.0, 1.0, 0.0).normalize();
    let across = vec3(1.0, -1.0, 0.0).normalize();
    // Each sheet is a square that is seen from its edge.
    let sheet = |index: i32| {
        let middle = vec3(2.2, 2.2, 0.0) + (0.8 * index as f32 - 2.0) * across;
        let [from, to] = [middle - 0.95 * along, middle + 0.95 * along];
        vec![from, to, to + Vec3::Z, from + Vec3::Z]
    };
    let hulls: Vec<Vec<Vec3>> = (0..6).map(sheet).collect();
    let bounds: Vec<Aabb> = hulls
        .iter()
        .map(|hull| {
            hull.iter().fold(Aabb::EMPTY, |all, &corner| Aabb::new(all.min.min(corner), all.max.max(corner)))
        })
        .collect();
    let query = KdQuery { bounds, heuristics: KdHeuristics::NONE, leaf_size: 1 };
    let kd_tree = kit.kd_build(&[query]).remove(0);
    let query = BspQuery { hulls: hulls.clone(), leaf_size: 1, max_depth: 16 };
    let bsp = kit.bsp_build(&[query]).remove(0);
    let mut drawing = Drawing::new("Six sheets in a kd-tree and in a BSP tree", 1000.0, 560.0);
    let trees = [("kd-tree", kd_tree.items.len()), ("BSP tree", bsp.items.len())];
    for (panel, (name, references)) in trees.into_iter().enumerate() {
        let view = View { origin: [40.0 + 500.0 * panel as f64, 460.0], scale: 98.0 };
        let at = |v: DVec3| -> Point { view.at(v.x, v.y) };
        drawing.step();
        for hull in &hulls {
            drawing.line(at(hull[0].as_dvec3()), at(hull[1].as_dvec3()), Ink::Color(0).pen(5.0));
        }
        if panel == 0 {
            drawing.step();
            for (_, cell) in leaves(&kd_tree) {
                drawing.frame(at(cell.min.as_dvec3()), at(cell.max.as_dvec3()), Ink::Color(3).pen(2.0));
            }
        } else {
            let square = [dvec2(0.0, 0.0), dvec2(4.4, 0.0), dvec2(4.4, 4.4), dvec2(0.0, 4.4)];
            drawing.frame(view.at(0.0, 0.0), view.at(4.4, 4.4), Ink::Faint.pen(2.0));
            for level in 1..bsp.depth() {
                drawing.step();
                draw_planes(&mut drawing, view, &bsp, 0, level, square.to_vec());
            }
        }
        let text = format!("{name}: {references} references");
        drawing.text([view.origin[0] + 210.0, 525.0], Middle, LARGE, Ink::Text, &text);
    }
    Ok(drawing.svg())
}

/// Draws the planes of a level below `node`, whose own plane is level 1, each in its region of the plane z = 0.
fn draw_planes(drawing: &mut Drawing, view: View, bsp: &Bsp, node: u32, level: usize, region: Vec<DVec2>) {
    let BspNode::Inner { plane, back, front } = bsp.nodes[node as usize] else { return };
    let distance = |point: DVec2| plane.normal.truncate().dot(point) - plane.offset;
    let (mut behind, mut before, mut cut) = (Vec::new(), Vec::new(), Vec::new());
    for (index, &point) in region.iter().enumerate() {
        let next = region[(index + 1) % region.len()];
        let [here, there] = [distance(point), distance(next)];
        if here <= 0.0 {
            behind.push(point)
        } else {
            before.push(point)
        }
        if (here <= 0.0) != (there <= 0.0) {
            let crossing = point.lerp(next, here / (here - there));
            behind.push(crossing);
            before.push(crossing);
            cut.push(view.at(crossing.x, crossing.y));
        }
    }
    if level == 1 {
        return drawing.polyline(&cut, Ink::Color(1).pen(2.5).dashed());
    }
    draw_planes(drawing, view, bsp, back, level - 1, behind);
    draw_planes(drawing, view, bsp, front, level - 1, before);
}
