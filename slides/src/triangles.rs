//! Diagrams of triangles, and of the order in which boxes are searched.

use anyhow::{Context, Result, ensure};
use glam::{Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::kit::{InsideQuery, Kit, SlabQuery};
use raykata::ray::Ray;
use raykata::shape::Triangle;
use raykata_cli::svg::{Drawing, End, Ink, Middle, SMALL, Start, TEXT, View, offset, plane};

/// A triangle, and the signs of the barycentric coordinates in the seven regions of its plane.
pub fn barycentric(kit: &dyn Kit) -> Result<String> {
    let triangle = Triangle { a: Vec3::ZERO, b: vec3(3.4, -0.2, 0.0), c: vec3(1.3, 2.7, 0.0) };
    let Triangle { a, b, c } = triangle;
    let mut drawing = Drawing::new("Barycentric coordinates and their signs", 1000.0, 620.0);
    let (_, at) = plane([330.0, 420.0], 105.0);
    let remark = [40.0, 606.0];
    let point = |beta: f32, gamma: f32| a + beta * (b - a) + gamma * (c - a);
    let ray = Ray::new(Vec3::Z, -Vec3::Z);
    let ask = |point: Vec3| kit.inside_by_areas(&[InsideQuery { ray, point, triangle }])[0];
    // Draw the triangle.
    drawing.step();
    drawing.area(&[at(a), at(b), at(c)], Ink::Color(4), 0.2);
    drawing.polyline(&[at(a), at(b), at(c), at(a)], Ink::Text.pen(2.0));
    for (corner, name, by) in [(a, "a", [-4.0, 32.0]), (b, "b", [10.0, 34.0]), (c, "c", [26.0, 4.0])] {
        drawing.dot(at(corner), 8.0, Ink::Text);
        drawing.text(offset(at(corner), by), Middle, TEXT, Ink::Text, name);
    }
    // Draw the lines on which beta and gamma are constant, with the side that leads across them.
    for (name, ink, y, to, other) in [("β", Ink::Color(0), 92.0, b, c), ("γ", Ink::Color(1), 124.0, c, b)] {
        let text = format!("{name} grows from 0 to 1 along this side");
        drawing.step_with(remark, &text, |drawing| drawing.arrow(at(a), at(to), ink.pen(5.0)));
        for share in [0.25, 0.5, 0.75] {
            drawing.line(at(a.lerp(to, share)), at(other.lerp(to, share)), ink.pen(1.5));
        }
        drawing.text([700.0, y], Start, SMALL, ink, &format!("{name} = 0.25, 0.5, 0.75"));
    }
    // Go to one point by both sides, then divide the triangle at it.
    let inside = point(0.5, 0.25);
    let [alpha, beta, gamma] =
        ask(inside).context("`inside_by_areas` does not find the point inside")?.to_array();
    let text = format!("p = a + β (b - a) + γ (c - a) with β = {beta}, γ = {gamma}");
    drawing.step_with(remark, &text, |drawing| {
        drawing.arrow(at(a), at(point(beta, 0.0)), Ink::Color(0).pen(5.0));
        drawing.arrow(at(point(beta, 0.0)), at(inside), Ink::Color(1).pen(5.0));
        drawing.text(offset(at(inside), [14.0, 0.0]), Start, TEXT, Ink::Text, "p");
    });
    let parts = [(alpha, b, c, Ink::Color(2)), (beta, c, a, Ink::Color(0)), (gamma, a, b, Ink::Color(1))];
    drawing.step_with(remark, "the areas opposite a, b, c: α, β, γ of the whole", |drawing| {
        for (share, from, to, ink) in parts {
            drawing.area(&[at(from), at(to), at(inside)], ink, 0.45);
            let middle = offset(at((from + to + inside) / 3.0), [0.0, 10.0]);
            drawing.text(middle, Middle, TEXT, Ink::Text, &format!("{share:.2}"));
        }
    });
    // Extend the sides, one after the other: on the far side of each one coordinate is negative.
    let sides = [(b, c, -0.45, 1.65, "α"), (c, a, -0.45, 1.55, "β"), (a, b, -0.9, 1.85, "γ")];
    for (from, to, low, high, name) in sides {
        drawing.remark(remark, &format!("beyond this line: {name} < 0"));
        drawing.line(at(from.lerp(to, low)), at(from.lerp(to, high)), Ink::Text.pen(2.0));
    }
    // Ask whether one point of each region is inside.
    drawing.step();
    let places =
        [(0.375, 0.125), (0.95, 0.75), (-0.7, 0.7), (0.55, -0.42), (-0.5, -0.4), (1.75, -0.4), (-0.17, 1.35)];
    for (beta, gamma) in places {
        let point = point(beta, gamma);
        let answer = ask(point);
        let sign = |x: f32| if x < 0.0 { "-" } else { "+" };
        let [alpha, beta, gamma] = [1.0 - beta - gamma, beta, gamma].map(sign);
        let text = format!("({alpha} {beta} {gamma})");
        // The test of the kit must find the point inside exactly if no coordinate is negative.
        ensure!(answer.is_some() != text.contains('-'), "`inside_by_areas` contradicts {text}");
        drawing.text(offset(at(point), [0.0, 9.0]), Middle, TEXT, Ink::Text, &text);
    }
    drawing.text([700.0, 60.0], Start, SMALL, Ink::Text, "signs of (α β γ)");
    Ok(drawing.svg())
}

/// Two boxes that overlap, and the steps of a search for the closest hit.
pub fn traversal_order(kit: &dyn Kit) -> Result<String> {
    let ray = Ray::new(vec3(0.0, 1.5, 0.5), Vec3::X);
    let boxes = [
        ("A", Aabb::new(vec3(1.0, 0.0, 0.0), vec3(7.0, 2.4, 1.0)), 6.0, Ink::Color(0)),
        ("B", Aabb::new(vec3(3.0, 0.7, 0.0), vec3(5.0, 3.2, 1.0)), 4.0, Ink::Color(1)),
    ];
    let mut drawing = Drawing::new("Two boxes that overlap, and the closest hit", 1000.0, 560.0);
    let view = View { origin: [60.0, 380.0], scale: 112.0 };
    let at = |x: f32, y: f32| view.at(f64::from(x), f64::from(y));
    drawing.arrow(at(0.0, 1.5), at(7.9, 1.5), Ink::Text.pen(3.0));
    drawing.dot(at(0.0, 1.5), 7.0, Ink::Text);
    let mut entries = Vec::new();
    for (name, bounds, t, ink) in boxes {
        let (enter, _) = kit.slab(&[SlabQuery { ray, bounds }])[0].context("the ray misses the box")?;
        entries.push(enter);
        drawing.rectangle(at(bounds.min.x, bounds.min.y), at(bounds.max.x, bounds.max.y), ink, 0.1);
        drawing.frame(at(bounds.min.x, bounds.min.y), at(bounds.max.x, bounds.max.y), ink.pen(3.0));
        drawing.text(offset(at(bounds.min.x, bounds.max.y), [14.0, 34.0]), Start, TEXT, ink, name);
        drawing.dot(at(enter, 1.5), 7.0, ink);
        drawing.text(offset(at(enter, 1.5), [-10.0, -14.0]), End, SMALL, ink, &format!("t = {enter:.2}"));
        // The triangle is seen from its edge.
        drawing.line(at(t - 0.12, 1.05), at(t + 0.12, 1.95), ink.pen(7.0));
        drawing.dot(at(t, 1.5), 9.0, ink);
        drawing.text(offset(at(t, 1.5), [20.0, 32.0]), Start, SMALL, ink, &format!("hit t = {t}"));
    }
    let steps = [
        format!("1. A is entered first, at t = {:.2}.", entries[0]),
        "2. Its triangle is hit: t_max = 6.".to_owned(),
        format!("3. B is entered at t = {:.2}, before t_max: search it, too.", entries[1]),
        "4. Its triangle is hit at t = 4, which is closer.".to_owned(),
    ];
    drawing.lines([60.0, 424.0], 38.0, TEXT, Ink::Text, &steps);
    Ok(drawing.svg())
}
