//! Diagrams of acceleration structures: the steps of a ray through them, and the costs of cuts.

use crate::Touch;
use crate::svg::{Drawing, Ink, Middle, SMALL, Start, TEXT, View};
use anyhow::Result;
use glam::{UVec3, Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::kit::{CellsAnswer, CellsQuery, GridQuery, KdQuery, Kit};
use raykata::partition::{KdHeuristics, KdNode, KdTree};
use raykata::ray::Ray;

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

/// The ray of the diagrams, and the `t` at which it enters each box.
fn ray_and_hits(kit: &dyn Kit, touch: &mut Touch) -> (Ray, Vec<f32>) {
    let names = ["origin of the ray", "end of the ray"];
    let [from, to] = names.map(|name| touch.point(VIEW, name, [-0.9, -0.2], [8.6, 5.3]).with_z(0.5));
    let ray = Ray::new(from, (to - from) / END);
    let queries: Vec<_> = boxes().into_iter().map(|bounds| raykata::kit::SlabQuery { ray, bounds }).collect();
    let hits =
        kit.slab(&queries).into_iter().map(|hit| hit.map_or(f32::INFINITY, |(enter, _)| enter)).collect();
    (ray, hits)
}

/// The `t` at the end of a ray that hits nothing.
const END: f32 = 9.2;

const VIEW: View = View { origin: [100.0, 560.0], scale: 104.0 };

fn at(point: Vec3) -> [f64; 2] {
    VIEW.at(f64::from(point.x), f64::from(point.y))
}

/// Draws boxes and ray; the boxes that the search tested are filled darker.
fn draw_search(drawing: &mut Drawing, ray: &Ray, answer: &CellsAnswer, touch: &Touch) {
    for (index, bounds) in (0..).zip(boxes()) {
        let tested = answer.tests.contains(&index);
        let ink = if tested { Ink::Color(1) } else { Ink::Faint };
        drawing.rectangle(at(bounds.min), at(bounds.max), ink, if tested { 0.55 } else { 0.35 });
        drawing.frame(at(bounds.min), at(bounds.max), ink.pen(2.0));
    }
    if !touch.is_still {
        drawing.line(at(ray.origin), at(ray.at(END)), Ink::Text.pen(1.5).dashed());
    }
    let end = answer.hit.map_or(END, |hit| hit.t);
    drawing.arrow(at(ray.origin), at(ray.at(end)), Ink::Text.pen(3.5));
    if answer.hit.is_some() {
        drawing.dot(at(ray.at(end)), 9.0, Ink::Text);
    }
}

/// Marks a cell, and writes when it was visited.
fn draw_visit(drawing: &mut Drawing, bounds: &Aabb, step: usize) {
    drawing.rectangle(at(bounds.min), at(bounds.max), Ink::Color(4), 0.2);
    let [x, y] = at(vec3(bounds.min.x, bounds.max.y, 0.0));
    drawing.text([x + 8.0, y + 24.0], Start, SMALL, Ink::Color(4), &step.to_string());
}

/// A ray through a uniform grid: the cells that it visits, numbered, up to the first hit.
pub fn draw_grid(kit: &dyn Kit, touch: &mut Touch) -> Result<String> {
    let (ray, hits) = ray_and_hits(kit, touch);
    let columns = touch.whole(4, 1, 16);
    let resolution = UVec3::new(columns, (5 * columns).div_ceil(8), 1);
    let query = GridQuery { bounds: boxes(), resolution };
    let grid = kit.grid_build(&[query]).remove(0);
    let answer = kit.grid_search(&[CellsQuery { cells: grid.clone(), ray, hits }]).remove(0);

    let mut drawing = Drawing::new("The cells of a grid that a ray visits, in order", 1000.0, 620.0);
    for (step, &visited) in (1..).zip(&answer.visits) {
        let [x, y] = [visited % grid.resolution.x, visited / grid.resolution.x];
        draw_visit(&mut drawing, &grid.cell(UVec3::new(x, y, 0)).to_box(), step);
    }
    for (axis, count) in [(0, grid.resolution.x), (1, grid.resolution.y)] {
        for index in 0..=count {
            let plane = grid.plane(axis, index) as f32;
            let end =
                |limit: Vec3| if axis == 0 { vec3(plane, limit.y, 0.0) } else { vec3(limit.x, plane, 0.0) };
            drawing.line(at(end(grid.bounds.min)), at(end(grid.bounds.max)), Ink::Faint.pen(1.5));
        }
    }
    draw_search(&mut drawing, &ray, &answer, touch);
    let text = format!("{} cells visited, boxes tested: {}", answer.visits.len(), answer.tests.len());
    drawing.text([100.0, 604.0], Start, TEXT, Ink::Text, &text);
    show(touch, "cells visited", answer.visits.len(), &answer);
    Ok(drawing.svg())
}

/// Shows what a search cost, and its hit.
fn show(touch: &mut Touch, what: &str, visits: usize, answer: &CellsAnswer) {
    touch.value(what, visits);
    touch.value("boxes tested", format!("{} of {}", answer.tests.len(), BOXES.len()));
    touch.value("t of the hit", answer.hit.map_or("none".to_owned(), |hit| hit.t.to_string()));
}

/// A ray through a kd-tree: its leaves in the order of the visits, up to the first hit.
pub fn draw_kd_tree(kit: &dyn Kit, touch: &mut Touch) -> Result<String> {
    let (ray, hits) = ray_and_hits(kit, touch);
    let leaf_size = touch.whole(4, 1, 11) as usize;
    let query = KdQuery { bounds: boxes(), heuristics: KdHeuristics::default(), leaf_size };
    let tree = kit.kd_build(&[query]).remove(0);
    let answer = kit.kd_search(&[CellsQuery { cells: tree.clone(), ray, hits }]).remove(0);

    let mut drawing = Drawing::new("The leaves of a kd-tree that a ray visits, in order", 1000.0, 600.0);
    let cells = leaves(&tree);
    let visited = answer.visits.iter().filter_map(|node| cells.iter().find(|(leaf, _)| leaf == node));
    for (step, (_, cell)) in (1..).zip(visited) {
        draw_visit(&mut drawing, cell, step);
    }
    for (_, cell) in &cells {
        drawing.frame(at(cell.min), at(cell.max), Ink::Faint.pen(2.0));
    }
    draw_search(&mut drawing, &ray, &answer, touch);
    let n_leaves = answer.visits.iter().filter(|&node| cells.iter().any(|(leaf, _)| leaf == node)).count();
    let text = format!(
        "{n_leaves} of {} leaves and {} inner nodes visited, {} boxes tested",
        cells.len(),
        answer.visits.len() - n_leaves,
        answer.tests.len()
    );
    drawing.text([500.0, 588.0], Middle, SMALL, Ink::Text, &text);
    show(touch, "leaves visited", n_leaves, &answer);
    Ok(drawing.svg())
}

/// All leaves, each with its cell.
pub fn leaves(tree: &KdTree) -> Vec<(u32, Aabb)> {
    let mut found = Vec::new();
    let mut open = vec![(0u32, tree.bounds)];
    while let Some((node, cell)) = open.pop() {
        match tree.nodes[node as usize] {
            KdNode::Leaf { .. } => found.push((node, cell)),
            KdNode::Inner { axis, at, left, right } => {
                let (mut below, mut above) = (cell, cell);
                below.max[usize::from(axis)] = at;
                above.min[usize::from(axis)] = at;
                open.extend([(right, above), (left, below)]);
            }
        }
    }
    found
}
