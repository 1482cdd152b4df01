//! Diagrams of the splits of a bounding volume hierarchy.

use anyhow::{Context, Result};
use glam::{Vec3, vec3};
use raykata::aabb::Aabb;
use raykata::bvh::PrimitiveRef;
use raykata::kit::{Kit, SplitAnswer};
use raykata_cli::svg::{Axis, Drawing, End, Ink, Middle, Plot, SMALL, Start, TEXT, View, offset};

fn references(kit: &dyn Kit, boxes: &[Aabb]) -> Vec<PrimitiveRef> {
    let one = |(id, (bounds, centroid)): (u32, (&Aabb, Vec3))| PrimitiveRef { id, bounds: *bounds, centroid };
    (0..).zip(boxes.iter().zip(kit.centroid(boxes))).map(one).collect()
}

/// The box around others, from `union`.
fn around(kit: &dyn Kit, boxes: &[Aabb]) -> Aabb {
    boxes[1..].iter().fold(boxes[0], |all, one| kit.union(&[(all, *one)])[0])
}

fn area(kit: &dyn Kit, boxes: &[Aabb]) -> f32 {
    kit.surface_area(&[around(kit, boxes)])[0]
}

/// The boxes of both sides of a split.
fn sides(boxes: &[Aabb], answer: &SplitAnswer) -> Result<[Vec<Aabb>; 2]> {
    let middle = answer.middle.context("this split makes a leaf")?;
    let take = |ids: &[u32]| ids.iter().map(|&id| boxes[id as usize]).collect();
    Ok([take(&answer.order[..middle]), take(&answer.order[middle..])])
}

/// Eight boxes on a line, and the cost of each of their seven cuts.
pub fn sah_cuts(kit: &dyn Kit) -> Result<String> {
    // These are the boxes of the check `trees_of_eight_boxes`.
    let places = [1.0, 2.0, 3.0, 4.0, 10.0, 20.0, 40.0, 80.0];
    let boxes = places.map(|x| Aabb::new(vec3(x, 0.0, 0.0), vec3(x + 0.5, 1.0, 1.0)));
    let n = boxes.len();
    let cost =
        |cut: usize| area(kit, &boxes[..cut]) * cut as f32 + area(kit, &boxes[cut..]) * (n - cut) as f32;
    let costs: Vec<f32> = (1..n).map(cost).collect();
    let whole = area(kit, &boxes);
    // The cost of a leaf, less that of one step of the traversal.
    let leaf = whole * n as f32 - whole;
    let primitives = references(kit, &boxes);
    let cut = |answers: Vec<SplitAnswer>| answers[0].middle.context("this split makes a leaf");
    let object = cut(kit.split_object_median(std::slice::from_ref(&primitives)))?;
    let spatial = cut(kit.split_spatial_median(std::slice::from_ref(&primitives)))?;
    let chosen = cut(kit.split_surface_area(&[primitives]))?;

    let mut drawing = Drawing::new("The cost of each cut by the surface area heuristic", 1000.0, 660.0);
    let plot =
        Plot::new(Axis::logarithmic(0.9, 90.0), Axis::linear(0.0, 2600.0), [60.0, 490.0], [900.0, 400.0]);
    drawing.line(plot.at(0.9, 0.0), plot.at(90.0, 0.0), Ink::Text.pen(2.0));
    // Draw the boxes under the axis.
    for bounds in &boxes {
        let corners = [bounds.min.x, bounds.max.x].map(|x| plot.at(f64::from(x), 0.0));
        let (a, b) = (offset(corners[0], [0.0, 40.0]), offset(corners[1], [0.0, 80.0]));
        drawing.rectangle(a, b, Ink::Faint, 0.35);
        drawing.frame(a, b, Ink::Text.pen(2.0));
        let below = [(a[0] + b[0]) / 2.0, b[1] + 26.0];
        drawing.text(below, Middle, SMALL, Ink::Text, &format!("{}", bounds.min.x));
    }
    drawing.text([962.0, 646.0], End, SMALL, Ink::Text, "x of each box, logarithmic");
    // Draw a bar above the gap of each cut.
    let marks = [
        (object, "object", "median", Ink::Color(2)),
        (spatial, "spatial", "median", Ink::Color(3)),
        (chosen, "surface", "area", Ink::Color(1)),
    ];
    for (cut, &cost) in (1..).zip(&costs) {
        let gap = f64::from(boxes[cut - 1].max.x * boxes[cut].min.x).sqrt();
        let top = plot.at(gap, f64::from(cost));
        let mark = marks.iter().find(|mark| mark.0 == cut);
        let ink = mark.map_or(Ink::Color(0), |mark| mark.3);
        drawing.rectangle(offset(top, [-17.0, 0.0]), offset(plot.at(gap, 0.0), [17.0, 0.0]), ink, 0.9);
        // The number of a bar that ends just under the dashed line stands beside the bar.
        let is_high = (0.9 * leaf..leaf).contains(&cost);
        let (anchor, by) = if is_high { (End, [-24.0, 28.0]) } else { (Middle, [0.0, -9.0]) };
        drawing.text(offset(top, by), anchor, SMALL, ink, &format!("{cost:.0}"));
        if let Some((_, first, second, _)) = mark {
            drawing.text(offset(top, [0.0, -72.0]), Middle, SMALL, ink, first);
            drawing.text(offset(top, [0.0, -40.0]), Middle, SMALL, ink, second);
        }
    }
    let y = plot.at(1.0, f64::from(leaf));
    drawing.line([60.0, y[1]], [960.0, y[1]], Ink::Text.pen(2.0).dashed());
    let text = format!("a leaf, less the traversal: {:.0} - {whole:.0} = {leaf:.0}", whole * n as f32);
    drawing.text([960.0, y[1] - 12.0], End, SMALL, Ink::Text, &text);
    drawing.text([60.0, 36.0], Start, TEXT, Ink::Text, "A(L) n(L) + A(R) n(R) for each cut");
    Ok(drawing.svg())
}

/// A cluster of boxes and three distant ones, divided at the object median and by the surface area heuristic.
pub fn object_median_problem(kit: &dyn Kit) -> Result<String> {
    let cluster = (0..9).map(|i| (0.58 * i as f32, [0.3, 1.5, 0.9][i % 3]));
    let far = [(14.0, 0.5), (18.0, 1.6), (22.0, 0.8)];
    let square = |(x, y): (f32, f32)| Aabb::new(vec3(x, y, 0.0), vec3(x + 0.5, y + 0.5, 0.5));
    let boxes: Vec<Aabb> = cluster.chain(far).map(square).collect();
    let primitives = references(kit, &boxes);
    let rows = [
        ("object median", kit.split_object_median(std::slice::from_ref(&primitives)).remove(0)),
        ("surface area", kit.split_surface_area(&[primitives]).remove(0)),
    ];
    let mut drawing = Drawing::new("The object median and the surface area heuristic", 1000.0, 520.0);
    for ((name, answer), y) in rows.into_iter().zip([190.0, 440.0]) {
        let view = View { origin: [50.0, y], scale: 40.0 };
        let at = |x: f32, y: f32| view.at(f64::from(x), f64::from(y));
        let sides = sides(&boxes, &answer)?;
        let mut cost = 0.0;
        for (side, ink) in sides.iter().zip([Ink::Color(0), Ink::Color(1)]) {
            let whole = around(kit, side);
            cost += area(kit, side) * side.len() as f32;
            drawing.rectangle(at(whole.min.x, whole.min.y), at(whole.max.x, whole.max.y), ink, 0.14);
            drawing.frame(at(whole.min.x, whole.min.y), at(whole.max.x, whole.max.y), ink.pen(3.0));
            for one in side {
                drawing.rectangle(at(one.min.x, one.min.y), at(one.max.x, one.max.y), ink, 0.8);
            }
            let label = offset(at((whole.min.x + whole.max.x) / 2.0, whole.min.y), [0.0, 28.0]);
            drawing.text(label, Middle, SMALL, ink, &format!("{} boxes", side.len()));
        }
        let text = format!("{name}: A(L) n(L) + A(R) n(R) = {cost:.0}");
        drawing.text([50.0, y - 110.0], Start, TEXT, Ink::Text, &text);
    }
    Ok(drawing.svg())
}

/// Boxes for which a cut in the middle has all centroids on one side.
pub fn spatial_median_corner(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("A corner case of the spatial median", 1000.0, 500.0);
    let pen = Ink::Text.pen(2.0);
    // Left: concentric boxes, all of whose centroids lie on the cut.
    let concentric: Vec<Aabb> =
        (1..=6).map(|size| size as f32 * vec3(0.5, 0.35, 0.2)).map(|half| Aabb::new(-half, half)).collect();
    let view = View { origin: [240.0, 240.0], scale: 68.0 };
    for bounds in &concentric {
        let [a, b] = [bounds.min, bounds.max].map(|v| view.at(f64::from(v.x), f64::from(v.y)));
        drawing.rectangle(a, b, Ink::Color(0), 0.1);
        drawing.frame(a, b, pen);
    }
    cut(kit, &mut drawing, &concentric, view.at(0.0, 0.0)[0], 240.0);
    // Right: seven small boxes and a very long one, whose centroid alone lies on the cut. The long box is drawn shortened.
    let mut skewed: Vec<Aabb> =
        (0..7).map(|row| Aabb::new(vec3(0.0, row as f32, 0.0), vec3(1.0, row as f32 + 0.6, 1.0))).collect();
    skewed.push(Aabb::new(vec3(0.0, 7.0, 0.0), vec3(1000.0, 7.6, 1.0)));
    for (row, bounds) in skewed.iter().enumerate() {
        let y = 385.0 - 42.0 * row as f64;
        let right = if bounds.max.x > 1.0 { 950.0 } else { 565.0 };
        drawing.rectangle([530.0, y], [right, y - 26.0], Ink::Color(0), 0.25);
        drawing.frame([530.0, y], [right, y - 26.0], pen);
    }
    drawing.text([530.0, 415.0], Middle, SMALL, Ink::Text, "0");
    drawing.text([565.0, 415.0], Middle, SMALL, Ink::Text, "1");
    drawing.text([950.0, 415.0], Middle, SMALL, Ink::Text, "1000");
    cut(kit, &mut drawing, &skewed, 740.0, 740.0);
    Ok(drawing.svg())
}

/// Draws the cut in the middle of all boxes at `x`, and writes how many centroids lie on its sides, and what the split of the
/// kit does.
fn cut(kit: &dyn Kit, drawing: &mut Drawing, boxes: &[Aabb], x: f64, middle: f64) {
    let whole = around(kit, boxes);
    let at = kit.centroid(&[whole])[0].x;
    let centroids = kit.centroid(boxes);
    let below = centroids.iter().filter(|centroid| centroid.x < at).count();
    let on = centroids.iter().filter(|centroid| centroid.x == at).count();
    let above = centroids.len() - below - on;
    drawing.line([x, 26.0], [x, 420.0], Ink::Color(1).pen(4.0).dashed());
    let counts = format!("{below} left, {on} on the cut, {above} right");
    drawing.text([middle, 454.0], Middle, SMALL, Ink::Color(1), &counts);
    let answer = kit.split_spatial_median(&[references(kit, boxes)]).remove(0);
    if let Some(left) = answer.middle {
        let text = format!("the split returns {left} and {}", boxes.len() - left);
        drawing.text([middle, 486.0], Middle, SMALL, Ink::Text, &text);
    }
}
