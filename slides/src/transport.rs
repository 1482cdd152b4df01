//! Diagrams of light transport: cosine-weighted directions, solid angles, the corner, and the light that short paths miss.

use crate::pictures::{load, render};
use anyhow::{Context, Result};
use glam::{Vec2, Vec2Swizzles, Vec3, vec3};
use raykata::emitter::{AreaEmitter, EmitterShape};
use raykata::kit::{EmitterPdfQuery, Kit};
use raykata_cli::svg::{
    Axis, Drawing, End, Ink, Middle, Plot, Point, SMALL, Start, TEXT, View, offset, plane, polar, steps,
};
use std::path::Path;

/// `2 n` directions of `cosine_direction` in a plane through the normal: the sine and the cosine of each with the normal. On
/// both sides the first random number is the middle of one of `n` equal intervals.
fn directions_in_plane(kit: &dyn Kit, n: u32) -> Vec<[f64; 2]> {
    let queries: Vec<(Vec3, Vec2)> =
        (0..n).map(|i| (Vec3::Y, Vec2::new((i as f32 + 0.5) / n as f32, 0.0))).collect();
    let cosines = kit.cosine_direction(&queries).into_iter().map(|direction| f64::from(direction.y));
    cosines.flat_map(|cos| [-1.0, 1.0].map(|side| [side * (1.0 - cos * cos).sqrt(), cos])).collect()
}

/// Points of a disk, projected up to the hemisphere.
pub fn malley(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("Uniform points of a disk, projected up to the hemisphere", 1000.0, 560.0);
    let view = View { origin: [500.0, 470.0], scale: 400.0 };
    drawing.arc(view.origin, view.scale, [0.0, 180.0], Ink::Text.pen(3.0));
    drawing.line(view.at(-1.0, 0.0), view.at(1.0, 0.0), Ink::Text.pen(5.0));
    for [x, y] in directions_in_plane(kit, 12) {
        drawing.line(view.at(x, 0.0), view.at(x, y), Ink::Faint.pen(1.5).dashed());
        drawing.line(view.origin, view.at(x, y), Ink::Color(0).pen(2.0));
        drawing.dot(view.at(x, 0.0), 6.0, Ink::Color(1));
        drawing.dot(view.at(x, y), 6.0, Ink::Color(0));
    }
    // Half of the directions are within 45 degrees, because sin² 45° = 1/2.
    for degrees in [45.0, 135.0] {
        let [from, to] = [330.0, 440.0].map(|radius| polar(view.origin, radius, degrees));
        drawing.line(from, to, Ink::Color(3).pen(4.0));
    }
    drawing.text(polar(view.origin, 462.0, 45.0), Start, TEXT, Ink::Color(3), "45°");
    let within = directions_in_plane(kit, 12).iter().filter(|[x, y]| x.abs() < *y).count();
    let text = format!("{within} of 24 within 45°");
    drawing.text([990.0, 60.0], End, SMALL, Ink::Color(3), &text);
    drawing.arrow(view.origin, view.at(0.0, 1.12), Ink::Text.pen(3.0));
    drawing.text(offset(view.at(0.0, 1.12), [14.0, 18.0]), Start, TEXT, Ink::Text, "n");
    let below = offset(view.origin, [0.0, 50.0]);
    let text = "points of the disk, uniform in its area";
    drawing.text(below, Middle, TEXT, Ink::Color(1), text);
    drawing.text([20.0, 120.0], Start, TEXT, Ink::Color(0), "cosine_direction");
    Ok(drawing.svg())
}

/// A piece of a light, and the solid angle that it fills as seen from a point.
pub fn light_solid_angle(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("The solid angle of a piece of a light", 1000.0, 600.0);
    let (view, at) = plane([330.0, 520.0], 150.0);
    // The light is a parallelogram seen from its edge; its depth is 1.
    let [from, to] = [vec3(0.6, 2.9, 0.0), vec3(3.1, 2.5, 0.0)];
    let corner = from - 0.5 * Vec3::Z;
    let shape = EmitterShape::Parallelogram { corner, edges: (Vec3::Z, to - from) };
    let emitter = AreaEmitter { shape, radiance: Vec3::ONE, two_sided: true };
    let middle = from.lerp(to, 0.5);
    let [low, high] = [from.lerp(to, 0.42), from.lerp(to, 0.58)];
    let normal = vec3(-(to - from).y, (to - from).x, 0.0).normalize() * -1.0;
    // The cone to the piece, and the arc that it cuts from the unit circle.
    drawing.area(&[view.origin, at(low), at(high)], Ink::Color(3), 0.25);
    drawing.arc(view.origin, view.scale, [0.0, 180.0], Ink::Faint.pen(3.0));
    let degrees = |v: Vec3| f64::from(v.y.atan2(v.x)).to_degrees();
    drawing.arc(view.origin, view.scale, [degrees(high), degrees(low)], Ink::Color(1).pen(10.0));
    drawing.rectangle([60.0, 520.0], [640.0, 552.0], Ink::Faint, 0.3);
    drawing.line([60.0, 520.0], [640.0, 520.0], Ink::Text.pen(3.0));
    drawing.arrow(view.origin, view.at(0.0, 1.7), Ink::Text.pen(3.0));
    drawing.text(offset(view.at(0.0, 1.7), [-14.0, 14.0]), End, TEXT, Ink::Text, "n");
    drawing.line(view.origin, at(middle), Ink::Color(0).pen(3.0).dashed());
    drawing.line(at(from), at(to), Ink::Color(3).pen(6.0));
    drawing.line(at(low), at(high), Ink::Color(1).pen(10.0));
    drawing.arrow(at(middle), at(middle + 0.9 * normal), Ink::Text.pen(3.0));
    drawing.text(offset(at(middle + 0.9 * normal), [14.0, 0.0]), Start, TEXT, Ink::Text, "n of the light");
    // The angle at the light, between its normal and the direction to the point.
    let back = [degrees(normal), degrees(-middle)];
    let back = [back[0].rem_euclid(360.0), back[1].rem_euclid(360.0)];
    drawing.arc(at(middle), 74.0, back, Ink::Color(0).pen(2.0));
    let label = offset(polar(at(middle), 98.0, (back[0] + back[1]) / 2.0), [0.0, 9.0]);
    drawing.text(label, Middle, TEXT, Ink::Color(0), "θ");
    drawing.text(offset(at(0.55 * middle), [18.0, 20.0]), Start, TEXT, Ink::Color(0), "d");
    drawing.text(offset(at(high), [0.0, -18.0]), Start, TEXT, Ink::Color(1), "dA");
    let label = offset(polar(view.origin, view.scale, degrees(middle)), [34.0, 18.0]);
    drawing.text(label, Start, TEXT, Ink::Color(1), "dω");
    drawing.text(offset(at(to), [12.0, -8.0]), Start, TEXT, Ink::Color(3), "light, area A");
    drawing.text([60.0, 590.0], Start, SMALL, Ink::Text, "the half circle has radius 1");
    // The density at the middle, by the formula and by the kit.
    let direction = middle.normalize();
    let pdf = kit.light_pdf(&[EmitterPdfQuery { emitter, from: Vec3::ZERO, direction }])[0];
    let (d, area, cos) = (middle.length(), (to - from).length(), -direction.dot(normal));
    let lines = [
        "dω = dA cos θ / d²".to_owned(),
        "pdf = d² / (A cos θ)".to_owned(),
        format!("= {d:.2}² / ({area:.2} · {cos:.2})"),
        format!("= {:.2}", d * d / (area * cos)),
        format!("light_pdf: {pdf:.2}"),
    ];
    drawing.lines([650.0, 400.0], 42.0, TEXT, Ink::Text, &lines);
    Ok(drawing.svg())
}

/// The densities of two ways to sample a direction at a surface below a long light, and the weights of both.
pub fn mis_weights(kit: &dyn Kit) -> Result<String> {
    // The light is seen from its edge, and it is eight units deep.
    let [from, to] = [vec3(0.1, 1.0, 0.0), vec3(1.6, 0.7, 0.0)];
    let (corner, edges) = (from - 4.0 * Vec3::Z, (8.0 * Vec3::Z, to - from));
    let shape = EmitterShape::Parallelogram { corner, edges };
    let emitter = AreaEmitter { shape, radiance: Vec3::ONE, two_sided: true };
    let densities = |degrees: f64| {
        let direction = Vec3::from((Vec2::from_angle(degrees.to_radians() as f32).yx(), 0.0));
        let light = kit.light_pdf(&[EmitterPdfQuery { emitter, from: Vec3::ZERO, direction }])[0];
        [light, kit.cosine_pdf(&[(Vec3::Y, direction)])[0]]
    };
    let weight = |own: f32, other: f32| f64::from(kit.mis_weight(&[(own, other)])[0]);
    let curve = |value: &dyn Fn([f32; 2]) -> f64| -> Vec<[f64; 2]> {
        steps(-90.0, 90.0, 360).map(|degrees| [degrees, value(densities(degrees))]).collect()
    };

    let mut drawing = Drawing::new("The densities of two ways to sample, and their weights", 1000.0, 640.0);
    let x = Axis::linear(-90.0, 90.0);
    let above = Plot::new(x, Axis::linear(0.0, 0.5), [100.0, 280.0], [860.0, 220.0]);
    let below = Plot::new(x, Axis::linear(0.0, 1.0), [100.0, 560.0], [860.0, 170.0]);
    // Draw the axes, and the directions that meet the light.
    drawing.step();
    let ticks = [(-90.0, "-90°"), (-45.0, "-45°"), (0.0, "0°"), (45.0, "45°"), (90.0, "90°")];
    above.draw_axes(&mut drawing, &ticks, &[(0.0, "0"), (0.4, "0.4")], ["", "density per steradian"]);
    below.draw_axes(&mut drawing, &ticks, &[(0.0, "0"), (1.0, "1")], ["angle with the normal", "mis_weight"]);
    let [first, last] = [from, to].map(|end| f64::from(end.x.atan2(end.y).to_degrees()));
    drawing.rectangle(above.at(first, 0.0), above.at(last, 0.5), Ink::Color(3), 0.15);
    drawing.text(above.at(last, 0.53), End, SMALL, Ink::Color(3), "directions to the light");
    // Draw both densities.
    drawing.step();
    above.draw_curve(&mut drawing, curve(&|both| f64::from(both[0])), Ink::Color(0).pen(4.0));
    drawing.text(above.at(first + 4.0, 0.42), Start, SMALL, Ink::Color(0), "light_pdf");
    drawing.step();
    above.draw_curve(&mut drawing, curve(&|both| f64::from(both[1])), Ink::Color(1).pen(4.0));
    drawing.text(above.at(-40.0, 0.3), End, SMALL, Ink::Color(1), "cosine_pdf");
    // Draw the weight of each from its side, so that both fill the height of 1.
    let light = curve(&|both| weight(both[0], both[1]));
    let bsdf = curve(&|both| 1.0 - weight(both[1], both[0]));
    for (share, base, ink, name, x, y) in [
        (light, 0.0, Ink::Color(0), "of the light's samples", 61.0, 0.15),
        (bsdf, 1.0, Ink::Color(1), "of the BSDF's samples", -8.0, 0.65),
    ] {
        drawing.step();
        let corners = share.into_iter().chain([[90.0, base], [-90.0, base]]).map(|[x, y]| below.at(x, y));
        drawing.area(&corners.collect::<Vec<Point>>(), ink, 0.4);
        drawing.text(below.at(x, y), End, SMALL, Ink::Text, name);
    }
    // Compute both weights of one direction.
    drawing.step();
    let [light, bsdf] = densities(45.0);
    let (one, other) = (weight(light, bsdf), weight(bsdf, light));
    drawing.line(above.at(45.0, 0.5), below.at(45.0, 0.0), Ink::Text.pen(2.0).dashed());
    let text = format!("45°: {one:.2} + {other:.2} = {:.2}", one + other);
    drawing.text(below.at(43.0, 1.1), End, SMALL, Ink::Text, &text);
    Ok(drawing.svg())
}

/// A corner of two planes under a sky, with a fan of cosine-weighted directions.
pub fn corner(kit: &dyn Kit) -> Result<String> {
    let mut drawing = Drawing::new("A corner of two planes under a sky", 1000.0, 600.0);
    let (left, floor) = (150.0, 520.0);
    drawing.rectangle([left - 36.0, 40.0], [left, floor + 36.0], Ink::Faint, 0.35);
    drawing.rectangle([left, floor], [960.0, floor + 36.0], Ink::Faint, 0.35);
    drawing.polyline(&[[left, 40.0], [left, floor], [960.0, floor]], Ink::Text.pen(4.0));
    let view = View { origin: [430.0, floor], scale: 420.0 };
    for [x, y] in directions_in_plane(kit, 8) {
        // A direction to the left meets the wall at some height.
        let wall = (x < 0.0).then(|| (view.origin[0] - left) / (-x * view.scale));
        let reach = wall.map_or(1.0, |reach| reach.min(430.0 / (y * view.scale)));
        let ink = if x < 0.0 { Ink::Color(1) } else { Ink::Color(0) };
        let end = view.at(reach * x, reach * y);
        match x < 0.0 && end[0] < left + 1.0 {
            true => {
                drawing.line(view.origin, end, ink.pen(3.0));
                drawing.dot(end, 6.0, ink);
            }
            // Beyond the end of the drawing the wall goes on.
            false => drawing.arrow(view.origin, end, ink.pen(3.0)),
        }
    }
    drawing.dot(view.origin, 9.0, Ink::Text);
    let square: [Point; 3] = [[left, floor - 40.0], [left + 40.0, floor - 40.0], [left + 40.0, floor]];
    drawing.polyline(&square, Ink::Text.pen(2.0));
    drawing.text([left + 8.0, floor - 9.0], Start, TEXT, Ink::Text, "β");
    drawing.text([left + 30.0, 40.0], Start, TEXT, Ink::Color(1), "F: meets the wall");
    drawing.text([600.0, 40.0], Start, TEXT, Ink::Color(0), "1 - F: meets the sky, L");
    drawing.text([left - 50.0, 290.0], End, TEXT, Ink::Text, "B₂");
    drawing.text([900.0, floor + 29.0], Middle, TEXT, Ink::Text, "B₁");
    let all = directions_in_plane(kit, 8);
    let (meet, n) = (all.iter().filter(|[x, _]| *x < 0.0).count(), all.len());
    let text = format!("{meet} of {n} directions meet the wall: F = (1 + cos 90°) / 2 = 1/2");
    drawing.text([left, floor + 72.0], Start, SMALL, Ink::Text, &text);
    Ok(drawing.svg())
}

/// The light that paths of limited length miss in a furnace: measured, and by `cut_off`.
pub fn furnace_bias(kit: &dyn Kit, root: &Path) -> Result<Vec<u8>> {
    let mut scene = load(root, "furnace.toml")?;
    (scene.film.width, scene.film.height) = (32, 24);
    scene.quality.samples_per_pixel = 256;
    // All surfaces emit Le and reflect ρ of the light, so each point sends out Le / (1 - ρ).
    let material = scene.materials.iter().find(|material| material.emission != Vec3::ZERO);
    let material = material.context("the furnace emits no light")?;
    let albedo = material.diffuse.x;
    let whole = f64::from(material.emission.x / (1.0 - albedo));
    let depths = [1u32, 2, 3, 4, 5];
    let mut measured = Vec::new();
    for depth in depths {
        scene.quality.max_depth = depth;
        let film = render(kit, &scene)?.film;
        let sum: f64 = film.pixels.iter().map(|pixel| f64::from(pixel.x)).sum();
        measured.push([f64::from(depth), whole - sum / film.pixels.len() as f64]);
    }
    let mut drawing = Drawing::new("The light that paths of limited length miss in a furnace", 1000.0, 560.0);
    let plot =
        Plot::new(Axis::linear(0.5, 5.5), Axis::logarithmic(0.01, 0.4), [110.0, 470.0], [620.0, 400.0]);
    let x = [(1.0, "1"), (2.0, "2"), (3.0, "3"), (4.0, "4"), (5.0, "5")];
    let y = [(0.01, "0.01"), (0.03, "0.03"), (0.1, "0.1"), (0.3, "0.3")];
    let titles = ["largest depth of paths", "missing radiance, of 0.8"];
    plot.draw_axes(&mut drawing, &x, &y, titles);
    // `cut_off` takes whole numbers of bounces; its values lie on a straight line.
    let queries: Vec<(f32, u32)> = depths.iter().map(|&depth| (albedo, depth)).collect();
    let missing = kit.cut_off(&queries);
    let line = depths.iter().zip(missing).map(|(&depth, share)| [f64::from(depth), whole * f64::from(share)]);
    plot.draw_curve(&mut drawing, line, Ink::Color(0).pen(4.0));
    for [depth, bias] in &measured {
        drawing.dot(plot.at(*depth, *bias), 9.0, Ink::Color(1));
        let label = offset(plot.at(*depth, *bias), [16.0, -8.0]);
        drawing.text(label, Start, SMALL, Ink::Color(1), &format!("{bias:.4}"));
    }
    drawing.text([600.0, 120.0], Start, SMALL, Ink::Color(1), "measured in the furnace");
    drawing.text([600.0, 164.0], Start, SMALL, Ink::Color(0), "0.8 · cut_off(0.5, depth)");
    drawing.text([600.0, 202.0], Start, SMALL, Ink::Color(0), "= 0.8 · 0.5^(depth + 1)");
    Ok(drawing.svg().into_bytes())
}
