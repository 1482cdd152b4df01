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
        ensure!(
            answer.is_some() != text.contains('-'),
            "`inside_by_areas` contradicts {text}: has the triangle an area?"
        );
        drawing.text(offset(at(point), [0.0, 9.0]), Middle, TEXT, Ink::Text, &text);
    }
    drawing.text([700.0, 60.0], Start, SMALL, Ink::Text, "signs of (α β γ)");
    drawing.text([700.0, 92.0], Start, SMALL, Ink::Color(0), "β = 0.25, 0.5, 0.75");
    drawing.text([700.0, 124.0], Start, SMALL, Ink::Color(1), "γ = 0.25, 0.5, 0.75");

    // Ask for the coordinates of the point.
    let weights = kit.inside_by_areas(&[InsideQuery { ray, point: p, triangle }])[0];
    for (axis, (name, corner)) in [("α", a), ("β", b), ("γ", c)].into_iter().enumerate() {
        touch.value(name, weights.map_or("p is outside".to_owned(), |weights| weights[axis].to_string()));
        if !touch.is_still {
            drawing.line(at(p), at(corner), Ink::Color(2).pen(2.0));
        }
    }
    Ok(drawing.svg())
}
