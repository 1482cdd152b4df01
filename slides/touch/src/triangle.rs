//! Barycentric coordinates.

use crate::Touch;
use crate::svg::{Drawing, Ink, Middle, SMALL, Start, TEXT, offset, plane};
use anyhow::{Result, ensure};
use glam::Vec3;
use raykata::kit::{InsideQuery, Kit};
use raykata::ray::Ray;
use raykata::shape::Triangle;

/// A triangle, and the signs of the barycentric coordinates in the seven regions of its plane.
pub fn draw(kit: &dyn Kit, touch: &mut Touch) -> Result<String> {
    let (view, at) = plane([330.0, 420.0], 105.0);
    let mut corner = |name| touch.point(view, name, [-2.9, -1.7], [6.0, 3.8]);
    let [a, b, c, p] = ["corner a", "corner b", "corner c", "point p"].map(&mut corner);
    let triangle = Triangle { a, b, c };
    let mut drawing = Drawing::new("Barycentric coordinates and their signs", 1000.0, 620.0);
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
    // Go to the point by both sides, then divide the triangle at it.
    let weights = ask(p);
    if let Some(Vec3 { x: alpha, y: beta, z: gamma }) = weights {
        let text = format!("p = a + β (b - a) + γ (c - a) with β = {beta:.2}, γ = {gamma:.2}");
        drawing.step_with(remark, &text, |drawing| {
            drawing.arrow(at(a), at(point(beta, 0.0)), Ink::Color(0).pen(5.0));
            drawing.arrow(at(point(beta, 0.0)), at(p), Ink::Color(1).pen(5.0));
            drawing.text(offset(at(p), [14.0, 0.0]), Start, TEXT, Ink::Text, "p");
        });
        let parts = [(alpha, b, c, Ink::Color(2)), (beta, c, a, Ink::Color(0)), (gamma, a, b, Ink::Color(1))];
        drawing.step_with(remark, "the areas opposite a, b, c: α, β, γ of the whole", |drawing| {
            for (share, from, to, ink) in parts {
                drawing.area(&[at(from), at(to), at(p)], ink, 0.45);
                let middle = offset(at((from + to + p) / 3.0), [0.0, 10.0]);
                drawing.text(middle, Middle, TEXT, Ink::Text, &format!("{share:.2}"));
            }
        });
    }
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
        ensure!(
            answer.is_some() != text.contains('-'),
            "`inside_by_areas` contradicts {text}: has the triangle an area?"
        );
        drawing.text(offset(at(point), [0.0, 9.0]), Middle, TEXT, Ink::Text, &text);
    }
    drawing.text([700.0, 60.0], Start, SMALL, Ink::Text, "signs of (α β γ)");

    // Show the coordinates of the point.
    for (axis, (name, corner)) in [("α", a), ("β", b), ("γ", c)].into_iter().enumerate() {
        touch.value(name, weights.map_or("p is outside".to_owned(), |weights| weights[axis].to_string()));
        if !touch.is_still {
            drawing.line(at(p), at(corner), Ink::Color(2).pen(2.0));
        }
    }
    Ok(drawing.svg())
}
