//! A diagram of the order in which boxes are searched.

use anyhow::{Context, Result};
use glam::{Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::kit::{Kit, SlabQuery};
use raykata::ray::Ray;
use raykata_cli::svg::{Drawing, End, Ink, SMALL, Start, TEXT, View, offset};

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
