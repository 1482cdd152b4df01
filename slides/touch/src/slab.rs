//! Diagrams of rays and boxes.

use crate::Touch;
use crate::svg::{Drawing, End, Ink, Middle, SMALL, Start, TEXT, offset, plane};
use anyhow::Result;
use glam::Vec3;
use raykata::aabb::Aabb;
use raykata::kit::{Kit, SlabQuery};
use raykata::ray::Ray;

/// Larger than everything in a diagram.
const FAR: f32 = 1000.0;

/// The `t` at the end of the ray that is drawn.
const END: f32 = 7.4;

/// A ray through a box in the plane: the two slabs, where the ray enters and leaves each, and their common interval.
pub fn draw(kit: &dyn Kit, touch: &mut Touch) -> Result<String> {
    let (view, at) = plane([40.0, 370.0], 105.0);
    // Ask the slab test about the box, and about each slab alone: a box that is long in all other directions.
    let mut place = |name| touch.point(view, name, [0.0, 0.0], [8.9, 3.45]);
    let [origin, through] = ["origin of the ray", "end of the ray"].map(&mut place);
    let corners = ["a corner of the box", "the opposite corner"].map(place);
    let ray = Ray::new(origin, (through - origin) / END);
    let (low, high) = (corners[0].min(corners[1]).with_z(-1.0), corners[0].max(corners[1]).with_z(1.0));
    let slab = |axis: usize| {
        let axis = Vec3::AXES[axis];
        Aabb::new(axis * low - FAR * (Vec3::ONE - axis), axis * high + FAR * (Vec3::ONE - axis))
    };
    let queries = [slab(0), slab(1), Aabb::new(low, high)].map(|bounds| SlabQuery { ray, bounds });
    let intervals = kit.slab(&queries);

    let mut drawing = Drawing::new("Two slabs, and the interval that both have in common", 1000.0, 620.0);
    let point = |t: f32| at(ray.at(t));
    let (x_slab, y_slab, both) = (Ink::Color(4), Ink::Color(1), Ink::Color(2));

    // Draw the ray and the box.
    drawing.step();
    let (left, right, bottom, top) = (0.0, 8.9, 0.0, 3.4);
    let [x0, x1, y0, y1] = [low.x, high.x, low.y, high.y].map(f64::from);
    drawing.frame(at(low), at(high), Ink::Text.pen(3.0));
    drawing.arrow(at(ray.origin), point(END), Ink::Text.pen(3.0));
    drawing.dot(at(ray.origin), 7.0, Ink::Text);
    drawing.text(offset(at(ray.origin), [4.0, 34.0]), Start, TEXT, Ink::Text, "o");

    // Draw each slab as a band, where the ray enters and leaves it, and its interval of t.
    let axis = |t: f32| 130.0 + 105.0 * f64::from(t.min(7.8));
    let rows = [("x", 440.0, x_slab), ("y", 495.0, y_slab), ("box", 550.0, both)];
    let row = |drawing: &mut Drawing, row: usize| {
        let (name, y, ink) = rows[row];
        drawing.text([40.0, y + 9.0], Start, TEXT, ink, name);
        drawing.text([axis(7.8) + 8.0, y + 9.0], Start, TEXT, Ink::Text, "t");
        drawing.line([axis(0.0), y], [axis(7.8), y], Ink::Faint.pen(1.5));
        let Some((enter, leave)) = intervals[row].filter(|(enter, _)| *enter < 7.8) else { return };
        drawing.line([axis(enter), y], [axis(leave), y], ink.pen(14.0));
        for t in [enter, leave].into_iter().filter(|t| *t < 7.8) {
            drawing.text([axis(t), y - 14.0], Middle, SMALL, ink, &format!("{t:.2}"));
        }
    };
    for (slab, interval) in intervals[..2].iter().enumerate() {
        let ink = rows[slab].2;
        drawing.step();
        if slab == 0 {
            drawing.rectangle(view.at(x0, bottom), view.at(x1, top), ink, 0.16);
            drawing.text(view.at(x1 + 0.1, top - 0.28), Start, TEXT, ink, "slab of x");
        } else {
            drawing.rectangle(view.at(left, y0), view.at(right, y1), ink, 0.16);
            drawing.text(view.at(right, y0 + 0.12), End, TEXT, ink, "slab of y");
        }
        for t in interval.iter().flat_map(|(enter, leave)| [*enter, *leave]).filter(|t| *t <= END) {
            drawing.dot(point(t), 8.0, ink);
        }
        drawing.step();
        row(&mut drawing, slab);
    }

    // Draw the interval that both have in common, from the last entry to the first exit.
    let ends = intervals[2].map(|(enter, leave)| [(enter, "the last entry"), (leave, "and the first exit")]);
    for (t, text) in ends.into_iter().flatten() {
        drawing.remark([axis(0.0), 605.0], &format!("{text}: {t:.2}"));
        drawing.line([axis(t), 430.0], [axis(t), 575.0], both.pen(2.0).dashed());
    }
    drawing.step();
    row(&mut drawing, 2);
    let text = match intervals[2] {
        Some(_) => "the last entry and the first exit: the ray meets the box",
        None => "no common interval: the ray misses the box",
    };
    drawing.text([axis(0.0), 605.0], Start, SMALL, Ink::Text, text);
    for (interval, (name, ..)) in intervals.iter().zip(rows) {
        touch.value(
            name,
            interval.map_or("missed".to_owned(), |(enter, leave)| format!("{enter} to {leave}")),
        );
    }
    Ok(drawing.svg())
}
