//! Diagrams of solids as intervals on a line, of Loop subdivision, and of a scene graph.

use crate::pictures::load;
use anyhow::{Context, Result, ensure};
use glam::{Vec3, vec3};
use raykata::kit::{Kit, SolidQuery};
use raykata::mesh::Mesh;
use raykata::ray::Ray;
use raykata::shape::{Cone, Cylinder};
use raykata_cli::svg::{Drawing, End, Ink, Middle, Point, SMALL, Start, TEXT, View, offset, plane, polar};
use std::path::Path;

/// A line through a cylinder, and the intervals of `t` in its parts.
pub fn solid_intervals(kit: &dyn Kit) -> Result<String> {
    let cylinder = Cylinder { base: vec3(4.2, 0.0, 0.0), top: vec3(4.2, 2.4, 0.0), radius: 1.3 };
    let ray = Ray::new(vec3(0.3, 3.1, 0.0), vec3(1.0, -0.30, 0.0).normalize());
    let hit =
        kit.cylinder(&[SolidQuery { ray, solid: cylinder }])[0].context("the ray misses the cylinder")?;
    let mut drawing = Drawing::new("A line through a cylinder, and its intervals", 1000.0, 620.0);
    let (view, at) = plane([60.0, 400.0], 104.0);
    let [left, right] = [cylinder.base.x - cylinder.radius, cylinder.base.x + cylinder.radius];
    // The infinite cylinder, and the slab between the end planes.
    drawing.rectangle(view.at(f64::from(left), 3.6), view.at(f64::from(right), -0.4), Ink::Color(0), 0.12);
    drawing.rectangle(view.at(0.0, 2.4), view.at(8.8, 0.0), Ink::Color(3), 0.12);
    drawing.frame(view.at(f64::from(left), 2.4), view.at(f64::from(right), 0.0), Ink::Text.pen(4.0));
    drawing.text(view.at(f64::from(left) + 0.1, 3.35), Start, SMALL, Ink::Color(0), "infinite cylinder");
    drawing.text(view.at(7.0, 0.12), Start, SMALL, Ink::Color(3), "between ends");
    drawing.arrow(at(ray.origin), at(ray.at(8.9)), Ink::Text.pen(3.0));
    // The line is seen from the side, so it passes the side of the cylinder where its x is that of the outline.
    let t_of_x = |x: f32| (x - ray.origin.x) / ray.direction.x;
    let t_of_y = |y: f32| (y - ray.origin.y) / ray.direction.y;
    let in_cylinder = [t_of_x(left), t_of_x(right)];
    let in_slab = [t_of_y(cylinder.top.y), t_of_y(cylinder.base.y)];
    let in_both = [in_cylinder[0].max(in_slab[0]), in_cylinder[1].min(in_slab[1])];
    ensure!((hit.t - in_both[0]).abs() < 1e-4, "`cylinder` contradicts the intervals");
    let axis = |t: f32| 120.0 + 92.0 * f64::from(t);
    for (row, (name, [from, to], ink)) in [
        ("infinite cylinder", in_cylinder, Ink::Color(0)),
        ("between the ends", in_slab, Ink::Color(3)),
        ("both: the solid", in_both, Ink::Color(1)),
    ]
    .into_iter()
    .enumerate()
    {
        let y = 478.0 + 44.0 * row as f64;
        let end = axis(to.min(8.9));
        drawing.rectangle([axis(from), y - 12.0], [end, y + 12.0], ink, 0.75);
        drawing.text([axis(from) - 12.0, y + 7.0], End, SMALL, ink, name);
        for t in [from, to] {
            drawing.dot(at(ray.at(t.min(8.8))), if t > 8.9 { 0.0 } else { 8.0 }, ink);
        }
    }
    drawing.line([axis(0.0), 602.0], [axis(8.9), 602.0], Ink::Faint.pen(2.0));
    drawing.text([axis(8.9) + 14.0, 608.0], Start, TEXT, Ink::Text, "t");
    drawing.line([axis(hit.t), 445.0], [axis(hit.t), 602.0], Ink::Color(1).pen(3.0).dashed());
    let text = format!("cylinder: t = {:.2}", hit.t);
    drawing.text([axis(hit.t) + 10.0, 459.0], Start, SMALL, Ink::Color(1), &text);
    Ok(drawing.svg())
}

/// A double cone with three lines.
pub fn double_cone(kit: &dyn Kit) -> Result<String> {
    let cone = Cone { base: vec3(0.0, -1.5, 0.0), apex: Vec3::ZERO, radius: 1.0 };
    let mut drawing = Drawing::new("A double cone and three lines", 1000.0, 660.0);
    let (_, at) = plane([420.0, 340.0], 190.0);
    let corners = [cone.apex, vec3(-1.0, -1.5, 0.0), vec3(1.0, -1.5, 0.0)];
    drawing.area(&corners.map(at), Ink::Color(4), 0.35);
    drawing.polyline(&[at(corners[1]), at(corners[2])], Ink::Text.pen(5.0));
    for side in [-1.0, 1.0] {
        drawing.line(at(1.1 * vec3(side, 1.5, 0.0)), at(-1.1 * vec3(side, 1.5, 0.0)), Ink::Text.pen(3.0));
    }
    drawing.text(at(vec3(-0.42, -1.38, 0.0)), Middle, SMALL, Ink::Text, "the cone");
    drawing.text(at(vec3(0.0, 1.45, 0.0)), Middle, SMALL, Ink::Text, "the second cone");
    // k = r² / |A|², the squared slope of the side.
    let k = (cone.radius / cone.base.length()).powi(2);
    let lines = [
        (vec3(-1.9, -0.55, 0.0), vec3(1.0, -0.12, 0.0), Ink::Color(0), "flat"),
        (vec3(-0.62, 1.62, 0.0), vec3(0.42, -1.5, 0.0), Ink::Color(1), "steep"),
        (vec3(-1.9, 0.62, 0.0), vec3(1.0, 0.10, 0.0), Ink::Color(3), "above the apex"),
    ];
    for (row, (origin, direction, ink, name)) in lines.into_iter().enumerate() {
        let ray = Ray::new(origin, direction.normalize());
        let hit = kit.cone(&[SolidQuery { ray, solid: cone }])[0];
        // Points of the double cone satisfy x² ≤ k y²: a t² + 2 b t + c ≤ 0 here, with the sign of the slide for a.
        let d = ray.direction;
        let a = d.x * d.x - k * d.y * d.y;
        let b = origin.x * d.x - k * origin.y * d.y;
        let c = origin.x * origin.x - k * origin.y * origin.y;
        let root = (b * b - a * c).sqrt();
        let mut roots = [(-b - root) / a, (-b + root) / a];
        roots.sort_by(f32::total_cmp);
        let far = if row == 1 { 3.25 } else { 4.0 };
        let pen = ink.pen(3.0);
        drawing.line(at(ray.at(0.0)), at(ray.at(far)), if hit.is_some() { pen } else { pen.dashed() });
        // Inside between the roots, or beyond them.
        let inside: [[f32; 2]; 2] = if a > 0.0 { [roots, roots] } else { [[0.0, roots[0]], [roots[1], far]] };
        for [from, to] in inside {
            drawing.line(at(ray.at(from)), at(ray.at(to)), pen.ink.pen(9.0));
        }
        for root in roots {
            drawing.dot(at(ray.at(root)), 10.0, ink);
        }
        let sign = if a > 0.0 { "a > 0: between roots" } else { "a < 0: beyond roots" };
        let verdict = hit.map_or("no hit".to_owned(), |hit| format!("hit at t = {:.2}", hit.t));
        let y = 150.0 + 130.0 * row as f64;
        for (line, text) in [name, sign, &verdict].into_iter().enumerate() {
            let size = if line == 0 { TEXT } else { SMALL };
            drawing.text([650.0, y + 35.0 * line as f64], Start, size, ink, text);
        }
        if let Some(hit) = hit {
            drawing.circle(at(ray.at(hit.t)), 17.0, Ink::Text.pen(3.0));
        }
    }
    drawing.text([650.0, 560.0], Start, SMALL, Ink::Text, "circle: cone()");
    Ok(drawing.svg())
}

/// The mesh after 0, 1, 2 and 3 steps of Loop subdivision, and the masks.
pub fn loop_subdivision(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let mut drawing =
        Drawing::new("Loop subdivision: the masks, and a cube after 0 to 3 steps", 1000.0, 560.0);
    draw_masks(&mut drawing);
    let scene = load(root, "smooth_cube.toml")?;
    let cube = scene.meshes.iter().find(|one| one.mesh.triangles.len() == 12);
    let cube = cube.context("the scene has no cube of twelve triangles")?;
    // Only positions and triangles matter.
    let mut mesh = Mesh {
        positions: cube.mesh.positions.clone(),
        triangles: cube.mesh.triangles.clone(),
        ..Mesh::default()
    };
    for (step, center) in
        [[480.0, 140.0], [800.0, 140.0], [480.0, 410.0], [800.0, 410.0]].into_iter().enumerate()
    {
        if step > 0 {
            mesh = kit.loop_subdivide(&[mesh]).remove(0);
        }
        draw_mesh(&mut drawing, &mesh, center);
        let text = format!("{step} steps: {} triangles", mesh.triangles.len());
        let text = text.replace("1 steps", "1 step");
        drawing.text(offset(center, [0.0, 138.0]), Middle, SMALL, Ink::Text, &text);
    }
    Ok(drawing.svg().into_bytes())
}

/// The front of a mesh as lines, seen from above at one side.
fn draw_mesh(drawing: &mut Drawing, mesh: &Mesh, center: Point) {
    let to_viewer = vec3(0.5, 0.45, 0.75).normalize();
    let right = Vec3::Y.cross(to_viewer).normalize();
    let up = to_viewer.cross(right);
    let view = View { origin: center, scale: 140.0 };
    let at = |v: Vec3| view.at(f64::from(v.dot(right)), f64::from(v.dot(up)));
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|index| mesh.positions[index as usize]);
        if (b - a).cross(c - a).dot(to_viewer) <= 0.0 {
            continue;
        }
        drawing.area(&[at(a), at(b), at(c)], Ink::Color(4), 0.15);
        drawing.polyline(&[at(a), at(b), at(c), at(a)], Ink::Color(0).pen(1.2));
    }
}

fn draw_masks(drawing: &mut Drawing) {
    let pen = Ink::Faint.pen(2.0);
    let number = |drawing: &mut Drawing, at: Point, text: &str, ink: Ink| {
        drawing.dot(at, 6.0, ink);
        drawing.text(offset(at, [0.0, -12.0]), Middle, SMALL, ink, text);
    };
    // A new vertex of an inner edge.
    let [left, right, top, bottom] = [[60.0, 110.0], [260.0, 110.0], [160.0, 40.0], [160.0, 180.0]];
    drawing.polyline(&[left, top, right, bottom, left, right], pen);
    for (at, text) in [(left, "3/8"), (right, "3/8"), (top, "1/8"), (bottom, "1/8")] {
        number(drawing, at, text, Ink::Text);
    }
    drawing.dot([160.0, 110.0], 9.0, Ink::Color(1));
    drawing.text([160.0, 212.0], Middle, SMALL, Ink::Color(1), "new, on an edge");
    // An old vertex with six neighbours.
    let middle = [160.0, 330.0];
    let around: Vec<Point> = (0..6).map(|i| polar(middle, 78.0, 60.0 * f64::from(i))).collect();
    for (index, at) in around.iter().enumerate() {
        drawing.line(middle, *at, pen);
        drawing.line(*at, around[(index + 1) % 6], pen);
    }
    for (index, at) in around.into_iter().enumerate() {
        drawing.dot(at, 6.0, Ink::Text);
        let by: Point = match index {
            0 => [12.0, 7.0],
            3 => [-12.0, 7.0],
            1 | 2 => [0.0, -12.0],
            _ => [0.0, 28.0],
        };
        let anchor = match index {
            0 => Start,
            3 => End,
            _ => Middle,
        };
        drawing.text(offset(at, by), anchor, SMALL, Ink::Text, "1/16");
    }
    drawing.dot(middle, 9.0, Ink::Color(0));
    drawing.text(offset(middle, [0.0, 36.0]), Middle, SMALL, Ink::Color(0), "10/16");
    drawing.text([160.0, 462.0], Middle, SMALL, Ink::Color(0), "old: 1 - 6 β, β = 1/16");
    // A border.
    let [left, right] = [[60.0, 515.0], [260.0, 515.0]];
    drawing.line(left, right, Ink::Text.pen(2.0));
    number(drawing, left, "1/8", Ink::Text);
    number(drawing, right, "1/8", Ink::Text);
    drawing.dot([160.0, 515.0], 9.0, Ink::Color(2));
    drawing.text([160.0, 503.0], Middle, SMALL, Ink::Color(2), "3/4");
    drawing.text([160.0, 548.0], Middle, SMALL, Ink::Color(2), "old, on a border");
}

/// The nodes of scenes/graph.toml, from the roots to the shapes.
pub fn scene_graph(_kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let scene = load(root, "graph.toml")?;
    // The deepest way to each node is its level. The floor, which has no name, is left out.
    let nodes = &scene.nodes;
    let mut level = vec![0usize; nodes.len()];
    for _ in 0..nodes.len() {
        for (index, node) in nodes.iter().enumerate() {
            for &child in &node.children {
                level[child] = level[child].max(level[index] + 1);
            }
        }
    }
    let parents: Vec<usize> = (0..nodes.len())
        .map(|index| nodes.iter().filter(|node| node.children.contains(&index)).count())
        .collect();
    let is_drawn = |index: &usize| parents[*index] > 0 || !nodes[*index].children.is_empty();
    let mut drawing = Drawing::new("The nodes of scenes/graph.toml", 1000.0, 620.0);
    let deepest = level.iter().copied().max().context("the scene has no nodes")?;
    let place = |index: usize| -> Point {
        let row: Vec<usize> =
            (0..nodes.len()).filter(is_drawn).filter(|&one| level[one] == level[index]).collect();
        let column = row.iter().position(|&one| one == index).unwrap_or(0);
        let x = 1000.0 * (column as f64 + 0.5) / row.len() as f64;
        // A node between a node above and one below leaves the middle to the arrow between these.
        let aside = match row.len() {
            1 if parents[index] == 1 => 190.0,
            n if n > 1 && n % 2 == 1 => 110.0,
            _ => 0.0,
        };
        [x + aside, 60.0 + 440.0 * level[index] as f64 / deepest as f64]
    };
    let half = |index: usize| 6.5 * nodes[index].name.chars().count() as f64 + 12.0;
    for index in (0..nodes.len()).filter(is_drawn) {
        for &child in &nodes[index].children {
            let [from, to] = [offset(place(index), [0.0, 24.0]), offset(place(child), [0.0, -24.0])];
            drawing.arrow(from, to, Ink::Faint.pen(2.0));
        }
    }
    for index in (0..nodes.len()).filter(is_drawn) {
        let (center, half) = (place(index), half(index));
        let [from, to] = [offset(center, [-half, -22.0]), offset(center, [half, 22.0])];
        let ink = if parents[index] > 1 { Ink::Color(1) } else { Ink::Color(0) };
        if parents[index] > 1 {
            drawing.rectangle(from, to, ink, 0.18);
        }
        drawing.frame(from, to, ink.pen(3.0));
        drawing.text(offset(center, [0.0, 8.0]), Middle, SMALL, Ink::Text, &nodes[index].name);
    }
    // Count the nodes of the tree in which nothing is shared.
    fn unfolded(nodes: &[raykata::scene::Node], index: usize) -> usize {
        1 + nodes[index].children.iter().map(|&child| unfolded(nodes, child)).sum::<usize>()
    }
    let roots = (0..nodes.len()).filter(|&index| parents[index] == 0 && is_drawn(&index));
    let tree: usize = roots.map(|root| unfolded(nodes, root)).sum();
    let text = format!("{} nodes here; {tree} as a tree", (0..nodes.len()).filter(is_drawn).count());
    drawing.text([20.0, 590.0], Start, SMALL, Ink::Text, &text);
    drawing.text([980.0, 590.0], End, SMALL, Ink::Color(1), "shaded: several parents");
    Ok(drawing.svg().into_bytes())
}
