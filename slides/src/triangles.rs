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
    drawing.area(&[at(a), at(b), at(c)], Ink::Color(4), 0.2);
    // Draw the lines on which beta and gamma are constant.
    for share in [0.25, 0.5, 0.75] {
        let beta = [a.lerp(b, share), c.lerp(b, share)];
        let gamma = [a.lerp(c, share), b.lerp(c, share)];
        drawing.line(at(beta[0]), at(beta[1]), Ink::Color(0).pen(1.5));
        drawing.line(at(gamma[0]), at(gamma[1]), Ink::Color(1).pen(1.5));
    }
    for (from, to, low, high) in [(a, b, -0.9, 1.85), (b, c, -0.45, 1.65), (c, a, -0.45, 1.55)] {
        drawing.line(at(from.lerp(to, low)), at(from.lerp(to, high)), Ink::Text.pen(2.0));
    }
    for (corner, name, by) in [(a, "a", [-4.0, 32.0]), (b, "b", [10.0, 34.0]), (c, "c", [26.0, 4.0])] {
        drawing.dot(at(corner), 8.0, Ink::Text);
        drawing.text(offset(at(corner), by), Middle, TEXT, Ink::Text, name);
    }
    // Ask whether one point of each region is inside.
    let point = |beta: f32, gamma: f32| a + beta * (b - a) + gamma * (c - a);
    let ray = Ray::new(Vec3::Z, -Vec3::Z);
    let places =
        [(0.375, 0.125), (0.95, 0.75), (-0.7, 0.7), (0.55, -0.42), (-0.5, -0.4), (1.75, -0.4), (-0.17, 1.35)];
    for (beta, gamma) in places {
        let point = point(beta, gamma);
        let answer = kit.inside_by_areas(&[InsideQuery { ray, point, triangle }])[0];
        let sign = |x: f32| if x < 0.0 { "-" } else { "+" };
        let [alpha, beta, gamma] = [1.0 - beta - gamma, beta, gamma].map(sign);
        let text = format!("({alpha} {beta} {gamma})");
        // The test of the kit must find the point inside exactly if no coordinate is negative.
        ensure!(answer.is_some() != text.contains('-'), "`inside_by_areas` contradicts {text}");
        drawing.text(offset(at(point), [0.0, 9.0]), Middle, TEXT, Ink::Text, &text);
    }
    drawing.text([700.0, 60.0], Start, SMALL, Ink::Text, "signs of (α β γ)");
    drawing.text([700.0, 92.0], Start, SMALL, Ink::Color(0), "β = 0.25, 0.5, 0.75");
    drawing.text([700.0, 124.0], Start, SMALL, Ink::Color(1), "γ = 0.25, 0.5, 0.75");
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
