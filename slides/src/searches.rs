//! Diagrams of searches: in two boxes that overlap, and in a node with eight children.

use anyhow::{Context, Result};
use glam::{Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::kit::{Kit, SlabQuery, WideBoxesQuery};
use raykata::ray::Ray;
use raykata::wide::{Child, WideNode};
use touch::svg::{Drawing, End, Ink, Middle, SMALL, Start, TEXT, View, offset, plane};

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

/// The boxes of a node with eight children: for each two opposite corners, and the x of a triangle within, or 99, which is outside.
const EIGHT: [f32; 40] = [
    5.9, 1.6, 7.4, 3.0, 6.5, 0.6, 3.2, 1.8, 4.4, 1.2, 1.2, 1.4, 3.0, 2.8, 99.0, 3.3, 0.2, 4.6, 1.5, 4.0, 3.6,
    1.9, 5.2, 3.4, 4.8, 6.0, 3.6, 7.6, 4.6, 7.0, 2.6, 1.8, 4.2, 4.0, 4.0, 5.2, 0.2, 7.8, 1.0, 6.0,
];

/// A node with eight children: all boxes are tested at once, the entered ones are sorted, and the farther ones wait on a stack.
pub fn wide_search(kit: &dyn Kit) -> Result<String> {
    let ray = Ray::new(vec3(0.0, 2.3, 0.5), vec3(1.0, 0.0, 0.0));
    let mut node = WideNode::EMPTY;
    let corner = |child: usize, x: usize, z: f32| vec3(EIGHT[5 * child + x], EIGHT[5 * child + x + 1], z);
    for child in 0..8 {
        let bounds = Aabb::new(corner(child, 0, 0.0), corner(child, 2, 1.0));
        node.set(child, &bounds, Child::leaf(child as u32, 1));
    }
    let entered = kit.enter_boxes(&[WideBoxesQuery { node: Box::new(node), ray }]).remove(0);
    let mut order: Vec<usize> = (0..8).filter(|child| entered.mask >> child & 1 == 1).collect();
    order.sort_by(|&p, &q| entered.t[p].total_cmp(&entered.t[q]));

    let mut drawing = Drawing::new("The search in a node with eight children", 1000.0, 620.0);
    let (_, at) = plane([110.0, 425.0], 88.0);
    let fill = |drawing: &mut Drawing, child: usize, ink: Ink, opacity: f64| {
        let (low, high) = (at(corner(child, 0, 0.0)), at(corner(child, 2, 0.0)));
        drawing.rectangle(low, high, ink, opacity);
        drawing.frame(low, high, ink.pen(3.0));
        drawing.text([low[0] + 8.0, high[1] + 28.0], Start, SMALL, ink, &child.to_string());
    };
    let caption = [20.0, 600.0];
    let lane = |child: usize, x: f64, y: f64| [x + 120.0 * child as f64, y];
    // Draw the boxes, and one lane of a register for each.
    drawing.remark(caption, "eight boxes in one node, one lane of a register each");
    drawing.arrow(at(ray.origin), at(ray.at(8.4)), Ink::Text.pen(3.0));
    for child in 0..8 {
        fill(&mut drawing, child, Ink::Faint, 0.0);
        drawing.frame(lane(child, 20.0, 500.0), lane(child, 140.0, 560.0), Ink::Text.pen(2.0));
        drawing.text(lane(child, 80.0, 490.0), Middle, SMALL, Ink::Faint, &child.to_string());
    }
    // Test all boxes at once, and sort the entered ones.
    drawing.remark(caption, &format!("one test: the ray enters {} of eight boxes", order.len()));
    for child in 0..8 {
        let (text, ink, opacity) = match order.contains(&child) {
            true => (format!("{:.2}", entered.t[child]), Ink::Color(0), 0.1),
            false => ("miss".into(), Ink::Faint, 0.0),
        };
        drawing.text(lane(child, 80.0, 540.0), Middle, SMALL, ink, &text);
        fill(&mut drawing, child, ink, opacity);
    }
    drawing.remark(caption, &format!("sorted by t: {order:?}; the farther ones wait on a stack"));
    // Open one after the other.
    let mut t_max = f32::INFINITY;
    for (place, &child) in order.iter().enumerate() {
        let (enter, t, stack) = (entered.t[child], EIGHT[5 * child + 4], &order[place + 1..]);
        if enter >= t_max {
            drawing.remark(caption, &format!("{child} is dropped: {enter:.2} is behind t = {t_max:.2}"));
            continue;
        }
        t_max = if t < 9.0 { t_max.min(t) } else { t_max };
        drawing.remark(caption, &format!("{child} is opened; t_max = {t_max:.2}, stack: {stack:?}"));
        fill(&mut drawing, child, Ink::Color(1), 0.15);
        let [x, y] = at(ray.at(t));
        drawing.line([x - 9.0, y + 31.0], [x + 9.0, y - 31.0], Ink::Color(1).pen(7.0));
    }
    drawing.step();
    drawing.dot(at(ray.at(t_max)), 10.0, Ink::Color(1));
    drawing.text(caption, Start, SMALL, Ink::Text, &format!("the closest hit: t = {t_max:.2}"));
    Ok(drawing.svg())
}
