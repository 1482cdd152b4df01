//! Diagrams of the rays of one pixel.

use crate::pictures::{job, load, render};
use anyhow::Result;
use raykata::kit::{Kit, RayKind, TracedRay};
use raykata::scene::Accelerator;
use raykata_cli::svg::{Axis, Drawing, End, Ink, Middle, Pen, Plot, Point, SMALL, Start, TEXT, offset};
use std::path::Path;

const KINDS: [(RayKind, &str, Ink); 4] = [
    (RayKind::Primary, "primary", Ink::Text),
    (RayKind::Reflection, "reflected", Ink::Color(1)),
    (RayKind::Transmission, "refracted", Ink::Color(0)),
    (RayKind::Shadow, "shadow", Ink::Color(3)),
];

fn ink_of(kind: RayKind) -> Ink {
    KINDS.iter().find(|one| one.0 == kind).map_or(Ink::Faint, |one| one.2)
}

/// The rays of a pixel of scenes/stage5.toml as a tree, with their weights.
pub fn ray_tree(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let rays = kit.trace(&job(&load(root, "stage5.toml")?), 430, 240);
    let mut drawing = Drawing::new("The rays of one pixel as a tree", 1000.0, 620.0);
    drawing.text([60.0, 50.0], Start, TEXT, Ink::Text, "pixel 430, 240");
    // Give each ray without successors a column, and each other ray the middle of its successors.
    let mut columns = vec![0.0; rays.len()];
    let mut free = 0.0;
    place(&rays, 0, &mut columns, &mut free);
    let depth = |ray: usize| std::iter::successors(Some(ray), |&ray| rays[ray].parent).count() as f64;
    let deepest = (0..rays.len()).map(depth).fold(1.0, f64::max);
    let at = |ray: usize| -> Point {
        [60.0 + 880.0 * (columns[ray] + 0.5) / free, 90.0 + 440.0 * (depth(ray) - 1.0) / (deepest - 1.0)]
    };
    for (column, (kind, name, ink)) in (0..).zip(KINDS) {
        let x = 60.0 + 230.0 * f64::from(column);
        drawing.line([x, 592.0], [x + 40.0, 592.0], ink.pen(5.0));
        let n = rays.iter().filter(|ray| ray.kind == kind).count();
        drawing.text([x + 50.0, 599.0], Start, SMALL, ink, &format!("{n} {name}"));
    }
    // Draw the rays bounce by bounce.
    for level in 1..=deepest as usize {
        let of_level: Vec<(usize, &TracedRay)> =
            rays.iter().enumerate().filter(|&(index, _)| depth(index) as usize == level).collect();
        drawing.remark([360.0, 50.0], &format!("level {level}; rays: {}", of_level.len()));
        for &(index, ray) in &of_level {
            let Some(parent) = ray.parent else { continue };
            // The width shows the weight: the square root, so that small weights are still seen.
            let width = 1.5 + 9.0 * f64::from(ray.weight.max_element()).clamp(0.0, 1.0).sqrt();
            let shadow = ray.kind == RayKind::Shadow;
            let pen = ink_of(ray.kind).pen(if shadow { 2.0 } else { width });
            drawing.line(at(parent), at(index), if shadow { pen.dashed() } else { pen });
            drawing.dot(at(parent), 10.0, ink_of(rays[parent].kind));
        }
        for (index, ray) in of_level {
            let (place, ink) = (at(index), ink_of(ray.kind));
            if ray.kind == RayKind::Shadow {
                drawing.dot(place, 7.0, ink);
                continue;
            }
            drawing.dot(place, 10.0, ink);
            // The line to the parent is on the other side.
            let is_left = ray.parent.is_some_and(|parent| columns[parent] > columns[index]);
            let (anchor, x) = if is_left { (End, -15.0) } else { (Start, 15.0) };
            // A ray at whose hit the tree ends has its label below.
            let is_last = !rays.iter().any(|one| one.parent == Some(index));
            let (anchor, by) = if is_last { (Middle, [0.0, 34.0]) } else { (anchor, [x, -8.0]) };
            drawing.text(offset(place, by), anchor, SMALL, ink, &format!("{:.3}", ray.weight.max_element()));
        }
    }
    Ok(drawing.svg().into_bytes())
}

/// Gives `ray` and all rays below it their columns.
fn place(rays: &[TracedRay], ray: usize, columns: &mut [f64], free: &mut f64) {
    let below: Vec<usize> = (0..rays.len()).filter(|&one| rays[one].parent == Some(ray)).collect();
    for &one in &below {
        place(rays, one, columns, free);
    }
    columns[ray] = match (below.first(), below.last()) {
        (Some(&first), Some(&last)) => (columns[first] + columns[last]) / 2.0,
        _ => {
            *free += 1.0;
            *free - 1.0
        }
    };
}

/// Tests and visited cells per ray over the resolution of a grid.
pub fn grid_resolution(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let mut scene = load(root, "showcase.toml")?;
    (scene.film.width, scene.film.height) = (96, 60);
    scene.quality.samples_per_pixel = 1;
    scene.quality.accelerator = Accelerator::Grid;
    let mut measure = |resolution: u32| -> Result<[f64; 2]> {
        scene.quality.grid_resolution = resolution;
        let counts = render(kit, &scene)?.counts;
        Ok([counts.primitive_tests, counts.node_visits].map(|n| n as f64 / counts.rays() as f64))
    };
    let resolutions = [8u32, 16, 32, 64, 128, 256];
    let measured: Vec<[f64; 2]> = resolutions.iter().map(|&n| measure(n)).collect::<Result<_>>()?;
    let formula = measure(0)?;

    let mut drawing = Drawing::new("Tests and visited cells over the resolution of a grid", 1000.0, 620.0);
    let (x, y) = (Axis::logarithmic(8.0, 256.0), Axis::logarithmic(1.0, 2000.0));
    let plot = Plot::new(x, y, [100.0, 530.0], [580.0, 450.0]);
    let x = [(8.0, "8"), (16.0, "16"), (32.0, "32"), (64.0, "64"), (128.0, "128"), (256.0, "256")];
    let y = [(1.0, "1"), (10.0, "10"), (100.0, "100"), (1000.0, "1,000")];
    plot.draw_axes(&mut drawing, &x, &y, ["cells along the longest side", "per ray"]);
    type Value<'a> = &'a dyn Fn(&[f64; 2]) -> f64;
    let curves: [(Value<'_>, &str, Pen, f64); 3] = [
        (&|one| one[0] + one[1], "their sum", Ink::Text.pen(2.0), -24.0),
        (&|one| one[0], "primitive tests", Ink::Color(0).pen(4.0), 8.0),
        (&|one| one[1], "visited cells", Ink::Color(1).pen(4.0), 20.0),
    ];
    for (value, name, pen, by) in curves {
        let points: Vec<[f64; 2]> =
            resolutions.iter().zip(&measured).map(|(&n, one)| [f64::from(n), value(one)]).collect();
        plot.draw_curve(&mut drawing, points.iter().copied(), pen);
        for [x, y] in &points {
            drawing.dot(plot.at(*x, *y), 6.0, pen.ink);
        }
        let [x, y] = points[points.len() - 1];
        let text = format!("{name}, {y:.1}");
        drawing.text(offset(plot.at(x, y), [14.0, by]), Start, SMALL, pen.ink, &text);
    }
    // The number of cells that the formula chooses lies where the falling curve has its number of tests.
    let text = format!("the formula: {:.1} tests and {:.1} cells", formula[0], formula[1]);
    drawing.text([960.0, 110.0], End, SMALL, Ink::Text, &text);
    Ok(drawing.svg().into_bytes())
}

/// The largest tree of rays with one reflected and one refracted ray per hit and two bounces.
pub fn ray_tree_bound(_kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The largest tree of rays with two bounces", 900.0, 500.0);
    let at = |level: u32, index: u32| -> Point {
        let n = f64::from(1 << level);
        [30.0 + 600.0 * (f64::from(index) + 0.5) / n, 130.0 + 140.0 * f64::from(level)]
    };
    drawing.arrow([at(0, 0)[0], 30.0], offset(at(0, 0), [0.0, -12.0]), Ink::Text.pen(3.0));
    drawing.text([at(0, 0)[0] + 14.0, 60.0], Start, SMALL, Ink::Text, "camera ray");
    let mut total = 0;
    for level in 0..3 {
        for index in 0..1u32 << level {
            let hit = at(level, index);
            for shadow in 0..3 {
                let end = offset(hit, [44.0, -26.0 + 18.0 * f64::from(shadow)]);
                drawing.line(hit, end, Ink::Color(3).pen(2.0));
            }
            if level < 2 {
                drawing.line(hit, at(level + 1, 2 * index), Ink::Color(1).pen(3.0));
                drawing.line(hit, at(level + 1, 2 * index + 1), Ink::Color(0).pen(3.0).dashed());
            }
            drawing.dot(hit, 12.0, Ink::Text);
        }
        total += 1 << level;
        let [_, y] = at(level, 0);
        let hits = if level == 0 { "1 hit".into() } else { format!("{} hits", 1 << level) };
        drawing.text([690.0, y + 8.0], Start, TEXT, Ink::Text, &hits);
    }
    drawing.text([690.0, 470.0], Start, TEXT, Ink::Text, &format!("sum: {total} hits"));
    let words = [
        ("reflected", Ink::Color(1)),
        ("refracted", Ink::Color(0)),
        ("three shadow rays each", Ink::Color(3)),
    ];
    for ((word, ink), x) in words.into_iter().zip([30.0, 180.0, 330.0]) {
        drawing.text([x, 476.0], Start, SMALL, ink, word);
    }
    Ok(drawing.svg())
}
