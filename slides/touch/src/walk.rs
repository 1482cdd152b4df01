//! Diagrams of acceleration structures: the steps of a ray through them.

use crate::Touch;
use crate::svg::{Drawing, Ink, Middle, Point, SMALL, Start, TEXT, View};
use anyhow::{Result, ensure};
use glam::{UVec3, Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::bvh::Contents;
use raykata::kit::{BuildQuery, CellsQuery, GridQuery, KdQuery, Kit, SearchQuery, SlabQuery, Table};
use raykata::partition::{KdHeuristics, KdNode, KdTree};
use raykata::ray::Ray;
use raykata::scene::Split;

/// Boxes in the plane, in a square of 8 by 5 units.
const BOXES: [[f32; 4]; 11] = [
    [0.4, 0.5, 1.0, 1.1],
    [0.7, 3.1, 1.5, 3.9],
    [1.9, 0.3, 2.6, 0.8],
    [2.3, 4.0, 2.9, 4.7],
    [2.9, 1.1, 3.5, 1.6],
    [3.6, 3.2, 4.1, 3.7],
    [4.4, 0.5, 5.3, 1.0],
    [5.2, 4.1, 5.7, 4.6],
    [6.0, 2.9, 6.8, 3.6],
    [6.4, 0.6, 7.0, 1.3],
    [7.2, 4.2, 7.8, 4.8],
];

/// The boxes of the diagrams.
pub fn boxes() -> Vec<Aabb> {
    BOXES.iter().map(|[x0, y0, x1, y1]| Aabb::new(vec3(*x0, *y0, 0.0), vec3(*x1, *y1, 1.0))).collect()
}

/// The ray of the diagrams, through two points, the second of which lies at `t`.
fn ray(touch: &mut Touch, t: f32) -> Ray {
    let names = ["origin of the ray", "end of the ray"];
    let [from, to] = names.map(|name| touch.point(VIEW, name, [-0.9, -0.2], [8.6, 5.3]).with_z(0.5));
    Ray::new(from, (to - from) / t)
}

/// The `t` at which a ray enters each box; infinite if it misses the box.
pub fn hits(kit: &dyn Kit, ray: Ray) -> Vec<f32> {
    let queries: Vec<_> = boxes().into_iter().map(|bounds| SlabQuery { ray, bounds }).collect();
    kit.slab(&queries).into_iter().map(|hit| hit.map_or(f32::INFINITY, |(enter, _)| enter)).collect()
}

/// The `t` at the end of a ray that hits nothing.
const END: f32 = 9.2;

const VIEW: View = View { origin: [100.0, 560.0], scale: 104.0 };

/// Where a point stands in the diagrams of the boxes.
pub fn at(point: Vec3) -> [f64; 2] {
    VIEW.at(f64::from(point.x), f64::from(point.y))
}

/// Begins with boxes and ray, as far as the drawing reaches.
fn draw_boxes(drawing: &mut Drawing, ray: &Ray) {
    drawing.step();
    for bounds in boxes() {
        drawing.rectangle(at(bounds.min), at(bounds.max), Ink::Faint, 0.35);
        drawing.frame(at(bounds.min), at(bounds.max), Ink::Faint.pen(2.0));
    }
    drawing.arrow(at(ray.origin), at(ray.at(END)), Ink::Faint.pen(2.0));
}

/// Draws a step for each visited cell, with the boxes that it lists, then the ray up to its hit. Circles mark the far planes.
fn draw_visits(
    drawing: &mut Drawing,
    kit: &dyn Kit,
    ray: &Ray,
    cells: &[(Aabb, Vec<u32>)],
    hit: Option<f32>,
) {
    let leaves = |bounds: Aabb| kit.slab(&[SlabQuery { ray: *ray, bounds }])[0].map_or(0.0, |span| span.1);
    for (step, (cell, listed)) in (1..).zip(cells) {
        let text = format!("cell {step}, up to t = {:.2}; boxes: {}", leaves(*cell), listed.len());
        drawing.step_with(CAPTION, &text, |drawing| {
            for (axis, ink) in [(Vec3::X, Ink::Color(0)), (Vec3::Y, Ink::Color(3))] {
                let far = 1000.0 * (Vec3::ONE - axis);
                let slab = Aabb::new(axis * cell.min - far, axis * cell.max + far);
                drawing.circle(at(ray.at(leaves(slab))), 9.0, ink.pen(4.0));
            }
        });
        drawing.rectangle(at(cell.min), at(cell.max), Ink::Color(4), 0.2);
        let [x, y] = at(vec3(cell.min.x, cell.max.y, 0.0));
        drawing.text([x + 8.0, y + 24.0], Start, SMALL, Ink::Color(4), &step.to_string());
        listed.iter().for_each(|&index| draw_tested(drawing, index));
    }
    draw_hit(drawing, ray, hit);
}

/// Marks a box that was tested.
fn draw_tested(drawing: &mut Drawing, index: u32) {
    let bounds = boxes()[index as usize];
    drawing.rectangle(at(bounds.min), at(bounds.max), Ink::Color(1), 0.4);
    drawing.frame(at(bounds.min), at(bounds.max), Ink::Color(1).pen(2.0));
}

/// Ends with the ray up to its hit, or up to its end.
fn draw_hit(drawing: &mut Drawing, ray: &Ray, hit: Option<f32>) {
    drawing.step();
    drawing.arrow(at(ray.origin), at(ray.at(hit.unwrap_or(END))), Ink::Text.pen(3.5));
    if let Some(t) = hit {
        drawing.dot(at(ray.at(t)), 9.0, Ink::Text);
    }
}

/// Where the caption stands.
const CAPTION: Point = [100.0, 604.0];

/// A hierarchy over the boxes, level by level, and the search for the closest hit of a ray in it.
pub fn draw_hierarchy(kit: &dyn Kit, touch: &mut Touch) -> Result<String> {
    let ray = ray(touch, 7.2);
    let (split, leaf_size) = (Split::ALL[touch.whole(4, 0, 2) as usize], touch.whole(5, 1, 11) as usize);
    let bvh = kit.build(&[BuildQuery { bounds: boxes(), split, leaf_size }]).remove(0);
    let queries: Vec<_> = bvh.nodes.iter().map(|node| SlabQuery { ray, bounds: node.bounds }).collect();
    let miss = (f32::INFINITY, f32::NEG_INFINITY);
    let spans = kit.slab(&queries).into_iter().map(|span| span.unwrap_or(miss)).collect();
    let table = Table { boxes: spans, primitives: hits(kit, ray) };
    let mut drawing = Drawing::new("A hierarchy of boxes, and the search of a ray in it", 1000.0, 620.0);
    draw_boxes(&mut drawing, &ray);
    let children = |node: u32| match bvh.nodes[node as usize].contents {
        Contents::Inner { left, right } => vec![left, right],
        Contents::Leaf { .. } => Vec::new(),
    };
    let frame = |drawing: &mut Drawing, node: u32, ink: Ink, width: f64| {
        let bounds = bvh.nodes[node as usize].bounds;
        drawing.frame(at(bounds.min), at(bounds.max), ink.pen(width));
    };
    // Draw the boxes of each level.
    let mut level = vec![0];
    for depth in 0..bvh.depth() {
        drawing.remark(CAPTION, &format!("level {depth}; nodes: {}", level.len()));
        level.iter().for_each(|&node| frame(&mut drawing, node, Ink::Color(0), 2.0));
        level = level.iter().flat_map(|&node| children(node)).collect();
    }
    // Search as stage 3 does: nearest child first, and no node that begins behind the closest hit.
    let (mut open, mut visited, mut tested, mut within, mut hit) = (vec![0], 0, 0, ray, None);
    open.retain(|&root| table.enter(root, &ray).is_some());
    while let Some(node) = open.pop() {
        let (what, ink) = match table.enter(node, &within) {
            Some(_) => ("opened", Ink::Color(1)),
            None => ("skipped", Ink::Faint),
        };
        let (enter, t_max) = (table.boxes[node as usize].0, within.t_max);
        let text = format!("entered at t = {enter:.2}, {what}; t_max = {t_max:.2}");
        drawing.step_with(CAPTION, &text, |drawing| frame(drawing, node, Ink::Color(3), 12.0));
        frame(&mut drawing, node, ink, 5.0);
        if what == "skipped" {
            continue;
        }
        visited += 1;
        if let Contents::Leaf { first, count } = bvh.nodes[node as usize].contents {
            tested += count;
            for &index in bvh.primitives(first, count) {
                draw_tested(&mut drawing, index);
                hit = table.hit(index, &within).or(hit);
                within.t_max = hit.unwrap_or(within.t_max);
            }
        }
        let enter = |child: &u32| table.boxes[*child as usize].0;
        let mut below = children(node);
        below.retain(|&child| table.enter(child, &ray).is_some());
        below.sort_by(|p, q| enter(q).total_cmp(&enter(p)));
        open.extend(below);
    }
    // The search of the kit must open as many nodes, and find the same hit.
    let answer = kit.closest_hit(&[SearchQuery { bvh: bvh.clone(), ray, table }]).remove(0);
    let found = (answer.counts.node_visits, answer.hit.map(|hit| hit.t));
    ensure!(found == (visited, hit), "`closest_hit` opens and finds {found:?}");
    draw_hit(&mut drawing, &ray, hit);
    let closest = hit.map_or("none".to_owned(), |t| format!("t = {t:.2}"));
    let text = format!("{visited} of {} nodes opened, closest hit {closest}", bvh.nodes.len());
    drawing.text(CAPTION, Start, TEXT, Ink::Text, &text);
    show(touch, ("nodes opened", visited as usize), tested as usize, hit);
    Ok(drawing.svg())
}

/// A ray through a uniform grid: the cells that it visits, numbered, up to the first hit.
pub fn draw_grid(kit: &dyn Kit, touch: &mut Touch) -> Result<String> {
    let ray = ray(touch, END);
    let hits = hits(kit, ray);
    let columns = touch.whole(4, 1, 16);
    let resolution = UVec3::new(columns, (5 * columns).div_ceil(8), 1);
    let query = GridQuery { bounds: boxes(), resolution };
    let grid = kit.grid_build(&[query]).remove(0);
    let answer = kit.grid_search(&[CellsQuery { cells: grid.clone(), ray, hits }]).remove(0);

    let mut drawing = Drawing::new("The cells of a grid that a ray visits, in order", 1000.0, 620.0);
    draw_boxes(&mut drawing, &ray);
    drawing.remark(CAPTION, &format!("{} by {} cells of one size", resolution.x, resolution.y));
    for (axis, count) in [(0, grid.resolution.x), (1, grid.resolution.y)] {
        for index in 0..=count {
            let plane = grid.plane(axis, index) as f32;
            let end = |p: Vec3| if axis == 0 { vec3(plane, p.y, 0.0) } else { vec3(p.x, plane, 0.0) };
            drawing.line(at(end(grid.bounds.min)), at(end(grid.bounds.max)), Ink::Faint.pen(1.5));
        }
    }
    let cell = |&number: &u32| {
        let at = UVec3::new(number % grid.resolution.x, number / grid.resolution.x, 0);
        (grid.cell(at).to_box(), grid.primitives(number).to_vec())
    };
    let cells: Vec<_> = answer.visits.iter().map(cell).collect();
    draw_visits(&mut drawing, kit, &ray, &cells, answer.hit.map(|hit| hit.t));
    let text = format!("{} cells visited, boxes tested: {}", answer.visits.len(), answer.tests.len());
    drawing.text(CAPTION, Start, TEXT, Ink::Text, &text);
    show(touch, ("cells visited", answer.visits.len()), answer.tests.len(), answer.hit.map(|hit| hit.t));
    Ok(drawing.svg())
}

/// Shows what a search cost, and its hit.
fn show(touch: &mut Touch, visits: (&str, usize), tests: usize, hit: Option<f32>) {
    touch.value(visits.0, visits.1);
    touch.value("boxes tested", format!("{tests} of {}", BOXES.len()));
    touch.value("t of the hit", hit.map_or("none".to_owned(), |t| t.to_string()));
}

/// The planes of a kd-tree, level by level, and a ray through it: its leaves in the order of the visits, up to the first hit.
pub fn draw_kd_tree(kit: &dyn Kit, touch: &mut Touch) -> Result<String> {
    let ray = ray(touch, END);
    let hits = hits(kit, ray);
    let leaf_size = touch.whole(4, 1, 11) as usize;
    let query = KdQuery { bounds: boxes(), heuristics: KdHeuristics::default(), leaf_size };
    let tree = kit.kd_build(&[query]).remove(0);
    let answer = kit.kd_search(&[CellsQuery { cells: tree.clone(), ray, hits }]).remove(0);

    let mut drawing = Drawing::new("The leaves of a kd-tree that a ray visits, in order", 1000.0, 612.0);
    draw_boxes(&mut drawing, &ray);
    // Draw the cells of each level over those of the level above.
    let mut level = vec![(0, tree.bounds)];
    for depth in 0..tree.depth() {
        drawing.remark(CAPTION, &format!("level {depth}; cells: {}", level.len()));
        for (_, cell) in &level {
            drawing.frame(at(cell.min), at(cell.max), Ink::Faint.pen(3.0));
        }
        level = level.iter().flat_map(|&(node, cell)| divided(&tree, node, cell)).flatten().collect();
    }
    let cells = leaves(&tree);
    let listed = |&(node, cell): &(u32, Aabb)| (cell, tree.listed(node).to_vec());
    let leaf = |node: &u32| cells.iter().find(|(leaf, _)| leaf == node).map(listed);
    let visited: Vec<_> = answer.visits.iter().filter_map(leaf).collect();
    draw_visits(&mut drawing, kit, &ray, &visited, answer.hit.map(|hit| hit.t));
    let (n, tests) = (visited.len(), answer.tests.len());
    let (all, inner) = (cells.len(), answer.visits.len() - n);
    let text = format!("{n} of {all} leaves and {inner} inner nodes visited, {tests} boxes tested");
    drawing.text([500.0, CAPTION[1]], Middle, SMALL, Ink::Text, &text);
    show(touch, ("leaves visited", n), tests, answer.hit.map(|hit| hit.t));
    Ok(drawing.svg())
}

/// The two cells below a node; `None` for a leaf.
fn divided(tree: &KdTree, node: u32, cell: Aabb) -> Option<[(u32, Aabb); 2]> {
    let KdNode::Inner { axis, at, left, right } = tree.nodes[node as usize] else { return None };
    let (mut below, mut above) = (cell, cell);
    below.max[usize::from(axis)] = at;
    above.min[usize::from(axis)] = at;
    Some([(left, below), (right, above)])
}

/// All leaves, each with its cell.
pub fn leaves(tree: &KdTree) -> Vec<(u32, Aabb)> {
    let mut found = Vec::new();
    let mut open = vec![(0u32, tree.bounds)];
    while let Some((node, cell)) = open.pop() {
        match divided(tree, node, cell) {
            None => found.push((node, cell)),
            Some([left, right]) => open.extend([right, left]),
        }
    }
    found
}
